//! The reversible machine.
//!
//! Code is a row of statements: a pure prefix, which touches the operand stack alone, and one
//! effect. Going forward the machine saves what the effect needs in order to be undone, appends it
//! to the tape, and acts. Going in reverse it meets an effect from behind, reads its record, acts,
//! and only then drops the record; the prefix is skipped, or run forward once more where the
//! inverse needs its operands. A jump and the join it lands on are one step, so that at every
//! point between steps the way back is unambiguous.
//!
//! Reading order: [`class`], the traits that every effect implements; [`values`], what a pure
//! instruction sees; `ops`, every opcode by family, forward and reverse side by side; `state`;
//! `hot`, the loops over what needs no workcell, with `reversed` and `update`, the code as a run in
//! reverse meets it; `step`, everything else, and `block`, blocks with a reverse of
//! their own; [`machine`], the whole.
//! The machine knows nothing of source languages, of how a workcell does what it is told, or of
//! when going back is wise.

pub mod alter;
mod block;
pub mod branches;
pub mod class;
pub mod convert;
mod fault;
mod hot;
mod kept;
mod leave;
pub mod link;
pub mod machine;
pub mod observe;
mod ops;
pub mod pure;
mod reversed;
mod snapshot;
pub mod state;
mod step;
pub mod stop;
pub mod stops;
mod task;
mod update;
pub mod values;
mod written;

pub use alter::{Alteration, Aside};
pub use branches::{Branches, branches, is_turn_of_motion};
pub use kept::Kept;
pub use link::{LinkError, Links};
pub use machine::{Limits, Machine, Mark};
pub use observe::{Event, Observer};
pub use pure::Calculator;
pub use snapshot::SnapshotError;
pub use state::{Direction, Frame, Pending, State};
pub use stop::{Refusal, Stop, Trap, TrapKind};
pub use stops::{Stops, can_stop_at};
pub use task::MAX_FORKS;
