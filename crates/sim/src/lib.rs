//! The kinematic workcell: arm, tool, items, fixtures, contact, noise, from one seed.
//!
//! [`Sim`] implements the capabilities of `obverse-workcell` for a cell that a TOML file describes.
//! It is geometry and time, not dynamics: bodies have no weight, so that what is let go stays where
//! it is; the arm goes exactly where it is commanded; contact gives way a little, like a spring.
//! One seed fixes everything: where things truly are, the noise of the sensor, and the numbers that
//! programs draw. Knows nothing of programs, tapes or directions.
//!
//! Read [`cell`], then [`kinematics`], `route`, `sweep` and [`peg`]; `travel` puts them together.
//! Metres, radians, seconds and newtons, but for contact (`collision`, `sweep`, `peg`), which is in
//! millimetres: its suffixes say so. `collision` alone knows parry.

mod bodies;
pub mod cell;
mod collision;
mod fall;
mod faults;
mod feeders;
mod goals;
mod gripper;
mod inputs;
mod insertion;
pub mod kinematics;
mod limits;
mod line;
mod mishaps;
pub mod peg;
pub mod plan;
pub mod profile;
pub mod random;
mod reader;
mod robot;
mod route;
pub mod seat;
mod seating;
mod sensor;
mod sim;
mod sweep;
mod travel;
mod truth;
mod turned;
mod watching;
mod world;

pub use cell::{Cell, CellCode, CellError, CellPlaces};
pub use faults::{FaultPlan, StopKind};
pub use goals::{Miss, Missed};
pub use plan::Plan;
pub use seating::Seating;
pub use sim::Sim;
pub use truth::{Cause, CauseKind};
