//! Operands of motions in the words of the workcell, and its times as whole numbers. Knows nothing
//! of machines.

use obverse_geometry as geometry;
use obverse_isa as isa;
use obverse_workcell::Path;

/// The path of a motion.
#[must_use]
pub fn path(path: isa::Path) -> Path {
    match path {
        isa::Path::Joint => Path::Joint,
        isa::Path::Linear => Path::Linear,
    }
}

/// The frame of a direction.
#[must_use]
pub fn frame(frame: isa::Frame) -> geometry::Frame {
    match frame {
        isa::Frame::Tcp => geometry::Frame::Tcp,
        isa::Frame::ToolMount => geometry::Frame::ToolMount,
        isa::Frame::Base => geometry::Frame::Base,
    }
}

/// A signed axis.
#[must_use]
pub fn axis(axis: isa::Axis) -> geometry::Axis {
    match axis {
        isa::Axis::PlusX => geometry::Axis::PlusX,
        isa::Axis::MinusX => geometry::Axis::MinusX,
        isa::Axis::PlusY => geometry::Axis::PlusY,
        isa::Axis::MinusY => geometry::Axis::MinusY,
        isa::Axis::PlusZ => geometry::Axis::PlusZ,
        isa::Axis::MinusZ => geometry::Axis::MinusZ,
    }
}

/// A time in seconds as the nearest number of nanoseconds; none for what is no time.
#[must_use]
pub fn nanoseconds(duration_s: f64) -> u64 {
    (duration_s * 1e9).round() as u64
}

/// So many nanoseconds in seconds.
#[must_use]
pub fn seconds(duration_ns: u64) -> f64 {
    duration_ns as f64 / 1e9
}
