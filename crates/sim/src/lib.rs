//! The kinematic workcell: arm, tool, items, fixtures, contact, noise, from one seed.

mod bodies;
pub mod cell;
mod collision;
mod faults;
mod gripper;
mod inputs;
mod insertion;
pub mod kinematics;
mod limits;
mod line;
pub mod peg;
pub mod profile;
pub mod random;
mod reader;
mod robot;
mod route;
mod sensor;
mod sim;
mod sweep;
mod travel;
mod world;

pub use cell::{Cell, CellError};
pub use faults::FaultPlan;
pub use sim::Sim;
