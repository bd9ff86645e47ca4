//! The trace tape: what a machine writes going forward so that it can go back.
//!
//! A stream a kind of record, each popped by the opcodes that pushed it, so that nothing is stored
//! that the code already implies: no program counters, no tags, no lengths. [`record`] has the
//! kinds of record, [`stream`] the chunked storage, [`tape`] the tape, [`mod@note`] what it keeps
//! of recoveries, [`snapshot`] the state that it keeps where all was left. Knows nothing of when a
//! record is written or used: that is the machine's step loop.

pub mod note;
pub mod record;
pub mod snapshot;
pub mod stream;
pub mod tape;

pub use note::{Note, Noted, Notes};
pub use record::Record;
pub use snapshot::{ForkSnapshot, FrameSnapshot, Snapshot, TaskSnapshot};
pub use tape::{NoTape, Place, Recorder, Streams, Tape};
