//! The hardware boundary: one trait a capability, and the data that crosses it.
//!
//! A machine commands a [`Workcell`]; a simulation and a controller's driver implement it. Nothing
//! here knows programs, tapes or directions: a reversed motion is a motion like any other. Acts are
//! absolute (go there, set this level), so that repeating one that was interrupted is safe.
//! Only implementations know time and randomness. Read [`motion`], then [`capability`], then
//! [`fault`], with [`mod@watch`], what is looked at meanwhile. [`shadow`] is a workcell that moves
//! nothing.

pub mod capability;
pub mod fault;
pub mod motion;
pub mod shadow;
pub mod watch;

pub use capability::{
    Arm, Clock, Dice, DigitalIo, ForceTorque, Gripper, Items, Safety, Watching, Workcell,
};
pub use fault::{Fault, FaultKind};
pub use motion::{Goal, ItemId, Motion, MotionEnd, MotionReport, Path, Speed, ToolId};
pub use shadow::Shadow;
pub use watch::{Condition, Watch};
