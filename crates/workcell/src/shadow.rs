//! A workcell that moves nothing: commands are believed and noted. For looking at recordings, where
//! a machine walks back over a tape with no robot there.

use crate::{
    Arm, Clock, Dice, DigitalIo, Fault, ForceTorque, Goal, Gripper, ItemId, Items, Motion,
    MotionEnd, MotionReport, Safety, ToolId, Watch, Watching, Workcell,
};
use obverse_geometry::{JointConfiguration, Pose};

/// Where a robot would be if it had done as commanded.
#[derive(Clone, Debug)]
pub struct Shadow {
    joints: JointConfiguration,
    outputs: Vec<bool>,
}

const NO_MOTION: MotionReport =
    MotionReport { end: MotionEnd::Reached, distance_m: 0.0, peak_force_n: 0.0, duration_s: 0.0 };

impl Shadow {
    /// The shadow of a robot that stands at these joints, with these levels at its outputs.
    #[must_use]
    pub fn new(joints: JointConfiguration, outputs: Vec<bool>) -> Self {
        Self { joints, outputs }
    }
}

impl Arm for Shadow {
    fn joints(&self) -> JointConfiguration {
        self.joints
    }

    fn execute(&mut self, motion: &Motion) -> Result<MotionReport, Fault> {
        // Going back is always to recorded joints; of anything else there is nothing to know.
        if let Goal::Joints(joints) = motion.goal {
            self.joints = joints;
        }
        Ok(NO_MOTION)
    }

    fn last_motion(&self) -> MotionReport {
        NO_MOTION
    }

    fn way_m(&self) -> f64 {
        0.0
    }
}

impl Safety for Shadow {
    fn is_stopped(&self) -> bool {
        false
    }

    fn release(&mut self) {}
}

impl DigitalIo for Shadow {
    fn output_count(&self) -> u16 {
        u16::MAX
    }

    fn output(&self, bit: u16) -> bool {
        self.outputs.get(usize::from(bit)).copied().unwrap_or(false)
    }

    fn set_output(&mut self, bit: u16, level: bool) -> Result<(), Fault> {
        let index = usize::from(bit);
        if self.outputs.len() <= index {
            self.outputs.resize(index + 1, false);
        }
        self.outputs[index] = level;
        Ok(())
    }

    fn input_count(&self) -> u16 {
        u16::MAX
    }

    fn input(&self, _: u16) -> Result<bool, Fault> {
        Ok(false)
    }
}

impl Gripper for Shadow {
    fn held(&self) -> Option<ItemId> {
        None
    }
}

impl ForceTorque for Shadow {
    fn force_n(&self) -> f64 {
        0.0
    }
}

impl Clock for Shadow {
    fn now_s(&self) -> f64 {
        0.0
    }

    fn wait(&mut self, _: f64) -> Result<(), Fault> {
        Ok(())
    }
}

impl Watching for Shadow {
    fn watch(&mut self, _: &[Watch]) {}

    fn watch_again(&mut self, _: u16) {}
}

impl Dice for Shadow {
    fn draw(&self, _: u64) -> f64 {
        0.0
    }
}

impl Items for Shadow {
    fn item(&self, _: &str) -> Option<ItemId> {
        Some(ItemId(0))
    }

    fn nominal_pose(&self, _: ItemId) -> Option<Pose> {
        Some(Pose::identity())
    }

    fn tool(&self, _: &str) -> Option<ToolId> {
        Some(ToolId(0))
    }

    fn initial_tool(&self) -> ToolId {
        ToolId(0)
    }
}

impl Workcell for Shadow {
    fn commanded_state(&self, sink: &mut dyn FnMut(u64)) {
        self.joints.bits().into_iter().for_each(&mut *sink);
        self.outputs.iter().map(|&level| u64::from(level)).for_each(sink);
    }
}
