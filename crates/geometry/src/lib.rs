//! Poses, frames, directions and joint configurations: the words every machine-side crate shares.
//!
//! The one home of float tolerance: everywhere else states compare bit for bit. Knows nothing of
//! robots, programs or time. Lengths are metres, angles radians; trigonometry is `libm`'s, so that
//! results are the same bits on every machine. Read [`joints`], then [`pose`], then [`frame`].

pub mod frame;
pub mod joints;
pub mod pose;
pub mod tolerance;

pub use frame::{Axis, Frame};
pub use joints::{JOINT_COUNT, JointConfiguration};
pub use pose::Pose;
