//! Motions: what the workcell is told for each.

use super::value::Value;
use super::{Interpreter, Run};
use obverse_geometry::{Axis, Frame, JointConfiguration};
use obverse_syntax::ast::{FrameWord, Heading, Target};
use obverse_syntax::span::Spanned;
use obverse_workcell::{Fault, Goal, Motion, MotionReport, Path, ToolId};

impl<'p> Interpreter<'p, '_> {
    /// `move …`
    pub(super) fn motion(&mut self, target: &'p Target<'p>, is_linear: bool) -> Run<()> {
        let path = if is_linear { Path::Linear } else { Path::Joint };
        match target {
            Target::Named(name) => {
                let joints = self.named_joints(name.value)?;
                self.go(Goal::Joints(joints), path, None)?;
            }
            Target::Keyframe { item, keyframe } => {
                let goal = self.keyframe_goal(item.value, keyframe.value)?;
                self.go(goal, path, None)?;
            }
            Target::Relative { distance, heading, frame } => {
                let distance_m = self.value(distance)?.real();
                let goal = self.displaced(distance_m, heading.value, *frame);
                self.go(goal, Path::Linear, None)?;
            }
            Target::Turned(turn) => {
                let amounts: Vec<_> = turn.amounts().collect();
                let mut by = [0.0; 2];
                for (number, value) in by.iter_mut().zip(self.all_values(&amounts)?) {
                    *number = value.real();
                }
                let goal = self.turned(by, turn.heading.value, turn.frame);
                self.go(goal, Path::Linear, None)?;
            }
        }
        Ok(())
    }

    /// Move with the settings that hold now.
    pub(super) fn go(
        &mut self,
        goal: Goal,
        path: Path,
        force_limit_n: Option<f64>,
    ) -> Run<MotionReport> {
        let tool = ToolId(self.tool);
        let motion = Motion { goal, path, speed: self.speed, tool, force_limit_n };
        Ok(self.cell.execute(&motion)?)
    }

    /// A displacement from where the arm is.
    pub(super) fn displaced(
        &self,
        distance_m: f64,
        heading: Heading,
        frame: Option<Spanned<FrameWord>>,
    ) -> Goal {
        let frame = frame.map_or(FrameWord::Tcp, |frame| frame.value);
        let axis = axis(heading, frame);
        Goal::Displaced { from: self.cell.joints(), distance_m, axis, frame: of_word(frame) }
    }

    /// A turn from where the arm is, by radians and metres.
    pub(super) fn turned(
        &self,
        [angle_rad, advance_m]: [f64; 2],
        heading: Heading,
        frame: Option<Spanned<FrameWord>>,
    ) -> Goal {
        let frame = frame.map_or(FrameWord::Tcp, |frame| frame.value);
        let (axis, frame) = (axis(heading, frame), of_word(frame));
        Goal::Turned { from: self.cell.joints(), angle_rad, advance_m, axis, frame }
    }

    fn named_joints(&mut self, name: &str) -> Run<JointConfiguration> {
        if let Some(position) = self.frame().positions.get(name) {
            return Ok(*position);
        }
        let joints = match self.variable(name) {
            Some(Value::Joints(index)) => self.names.joints.get(usize::from(index)),
            _ => None,
        };
        Ok(joints.ok_or_else(|| missing(name))?.1)
    }

    fn keyframe_goal(&mut self, item: &str, keyframe: &str) -> Run<Goal> {
        let Some(Value::Item(index)) = self.variable(item) else {
            return Err(missing(item).into());
        };
        let declared = self.names.items.get(usize::from(index)).ok_or_else(|| missing(item))?;
        let pose = self.names.keyframe(index, keyframe).ok_or_else(|| missing(keyframe))?;
        let id = self.cell.item(declared.name.value).ok_or_else(|| missing(item))?;
        let nominal = self.cell.nominal_pose(id).ok_or_else(|| missing(item))?;
        Ok(Goal::Pose(nominal.compose(&pose)))
    }
}

fn missing(name: &str) -> Fault {
    Fault::Missing { what: name.to_owned() }
}

fn of_word(frame: FrameWord) -> Frame {
    match frame {
        FrameWord::Tcp => Frame::Tcp,
        FrameWord::ToolMount => Frame::ToolMount,
        FrameWord::Base => Frame::Base,
    }
}

/// A displacement by two numbers across a heading: x, y and z in a frame.
pub(super) fn across(
    heading: Heading,
    frame: Option<Spanned<FrameWord>>,
    first: f64,
    second: f64,
) -> ([f64; 3], Frame) {
    let frame = frame.map_or(FrameWord::Tcp, |frame| frame.value);
    let by = match axis(heading, frame) {
        Axis::PlusX | Axis::MinusX => [0.0, first, second],
        Axis::PlusY | Axis::MinusY => [first, 0.0, second],
        Axis::PlusZ | Axis::MinusZ => [first, second, 0.0],
    };
    (by, of_word(frame))
}

/// What a heading means in a frame. The tool looks along its z axis, with x to the right and y
/// downwards; the base looks along x, with y to the left and z upwards.
fn axis(heading: Heading, frame: FrameWord) -> Axis {
    let (of_base, of_tool) = match heading {
        Heading::X => (Axis::PlusX, Axis::PlusX),
        Heading::Y => (Axis::PlusY, Axis::PlusY),
        Heading::Z => (Axis::PlusZ, Axis::PlusZ),
        Heading::MinusX => (Axis::MinusX, Axis::MinusX),
        Heading::MinusY => (Axis::MinusY, Axis::MinusY),
        Heading::MinusZ => (Axis::MinusZ, Axis::MinusZ),
        Heading::Forward => (Axis::PlusX, Axis::PlusZ),
        Heading::Backward => (Axis::MinusX, Axis::MinusZ),
        Heading::Left => (Axis::PlusY, Axis::MinusX),
        Heading::Right => (Axis::MinusY, Axis::PlusX),
        Heading::Up => (Axis::PlusZ, Axis::MinusY),
        Heading::Down => (Axis::MinusZ, Axis::PlusY),
    };
    if frame == FrameWord::Base { of_base } else { of_tool }
}
