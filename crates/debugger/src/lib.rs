//! The debugger: a session over a machine, with the whole run that led there.
//!
//! A run records what it depends on that is outside the machine. From that every moment of it can
//! be shown again, bit for bit, by a machine that commands nothing; copies of the machine along the
//! run make any of them near. So one can go back in two ways that are never confused: in *reverse*,
//! live, which commands the workcell and obeys the classes; and *rewound*, which shows what was.
//!
//! Reading order: [`recording`], what is recorded; [`file`](mod@file), its file (`wire`), and
//! [`taped`], a run that is written to one as it goes; [`recorder`] and [`replay`], the workcells
//! that write and read it; [`mod@drive`], the clock; [`timeline`], the copies; [`rewound`], a
//! moment shown; [`run`], one line of history, and how a recovery drives it (`hops`) and would
//! know it (`retrace`); [`notes`], what it did; [`subject`] and [`condition`], what can be asked,
//! and [`unit`](mod@unit), what it measures; `writers`, what can change that; [`breakpoint`];
//! [`place`]; [`session`], what fronts use.
//! It knows modules and machines, and neither source languages nor how anything is shown.

pub mod breakpoint;
pub mod condition;
pub mod drive;
pub mod file;
mod hops;
pub mod notes;
pub mod place;
pub mod recorder;
pub mod recording;
pub mod replay;
mod retrace;
pub mod rewound;
pub mod run;
pub mod session;
pub mod subject;
pub mod taped;
pub mod timeline;
pub mod unit;
mod wire;
mod writers;

pub use breakpoint::{Breakpoint, Counts, Hit, Piece, PlaceError, Places, What};
pub use condition::{ConditionError, Expression};
pub use file::{Before, CellFile, Head, TapeFile, Writer};
pub use place::{Mode, Position, SourcePlace};
pub use recording::{Moment, Recording};
pub use run::{NoFork, Run};
pub use session::{Change, Declined, Grain, Halt, Policy, Session, Walk, Why};
pub use subject::{Look, Subject, Value, Wrong};
pub use taped::Taped;
pub use unit::Unit;
