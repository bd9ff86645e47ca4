//! What a run does otherwise than the program says, while it tries again what went wrong.
//!
//! Applied to motions going forward alone: what is recorded is where the arm stood, so that the way
//! back needs to know nothing of it. When and how much is not known here.

use obverse_geometry::{Axis, Frame, Pose};
use obverse_workcell::{Goal, Motion, Path, Speed};

/// A change of the motions that the machine commands going forward.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Alteration {
    /// Every motion at a speed so many names lower, down to the lowest.
    pub slower: u8,
    /// Every force limit by this factor, if there is one.
    pub force_factor: Option<f64>,
    /// One motion to the side.
    pub aside: Option<Aside>,
}

/// A motion to the side of where the program says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aside {
    /// The instruction of the motion.
    pub pc: u32,
    /// How far along the two axes across its direction, in metres; across the tool's own z, where a
    /// motion has none.
    pub by_m: [f64; 2],
}

impl Alteration {
    /// The motions to make instead of one: one before it, if one is needed, and the one that
    /// counts, whose displacement counts from where the first has led.
    pub(crate) fn of(&self, pc: u32, motion: Motion) -> (Option<Motion>, Motion) {
        let mut altered = motion;
        let place = Speed::ALL.iter().position(|speed| *speed == motion.speed).unwrap_or(0);
        altered.speed = Speed::ALL[place.saturating_sub(usize::from(self.slower))];
        if let (Some(limit_n), Some(factor)) = (motion.force_limit_n, self.force_factor) {
            altered.force_limit_n = Some(limit_n * factor);
        }
        match self.aside {
            Some(aside) if aside.pc == pc => aside.of(altered),
            _ => (None, altered),
        }
    }
}

impl Aside {
    fn of(self, motion: Motion) -> (Option<Motion>, Motion) {
        let [first, second] = self.by_m;
        match motion.goal {
            Goal::Displaced { from, axis, frame, .. } | Goal::Turned { from, axis, frame, .. } => {
                let by_m = across(axis, first, second);
                let goal = Goal::Offset { from, by_m, frame };
                let before = Motion { goal, path: Path::Linear, ..motion };
                (Some(Motion { force_limit_n: None, ..before }), motion)
            }
            Goal::Joints(from) => {
                let by_m = [first, second, 0.0];
                let goal = Goal::Offset { from, by_m, frame: Frame::Tcp };
                (None, Motion { goal, ..motion })
            }
            Goal::Pose(pose) => {
                let aside = Pose::from_rotation_vector([first, second, 0.0], [0.0; 3]);
                (None, Motion { goal: Goal::Pose(pose.compose(&aside)), ..motion })
            }
            Goal::Offset { from, by_m: [x, y, z], frame } => {
                let by_m = [x + first, y + second, z];
                (None, Motion { goal: Goal::Offset { from, by_m, frame }, ..motion })
            }
        }
    }
}

/// So far along the two axes across one, in metres.
fn across(axis: Axis, first: f64, second: f64) -> [f64; 3] {
    let along = axis.unit();
    if along.x != 0.0 {
        [0.0, first, second]
    } else if along.y != 0.0 {
        [first, 0.0, second]
    } else {
        [first, second, 0.0]
    }
}
