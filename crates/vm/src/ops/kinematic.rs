//! The family `kinematic`: motions, which go back to where they started.
//!
//! What is recorded is where the joints were: a pose would leave the turn of the wrist open. Goals
//! are absolute, counted from the recorded start, so that a motion that was interrupted can be
//! commanded again in either direction. A motion reverses along the path it took, at the speed it
//! had, unless the settings for going back say otherwise; one that was made aside, over both legs.

use super::acts::Acts;
use crate::alter::Alteration;
use crate::class::{AfterForward, Always, Failure};
use crate::convert::{axis, frame, path};
use crate::stop::TrapKind;
use obverse_geometry::{JointConfiguration, Pose};
use obverse_isa::{self as isa, op};
use obverse_tape::record::Joints;
use obverse_workcell::{Fault, Goal, Motion, MotionEnd, MotionReport, Path};

impl Acts<'_> {
    fn go(&mut self, goal: Goal, path: Path, force_limit_n: Option<f64>) -> Result<(), Failure> {
        let motion = Motion { goal, path, speed: self.speed()?, tool: self.tool(), force_limit_n };
        let motion = match self.alteration {
            Some(alteration) => self.altered(alteration, motion)?,
            None => motion,
        };
        let report = self.execute(&motion)?;
        self.moved(report);
        Ok(())
    }

    /// What is told of an effect that moves is the last motion, and how long all of them took.
    fn moved(&mut self, report: MotionReport) {
        let before_s = self.done.report.map_or(0.0, |before| before.duration_s);
        self.done.report =
            Some(MotionReport { duration_s: before_s + report.duration_s, ..report });
    }

    /// The motion to make instead, once what is done before it has been.
    fn altered(&mut self, alteration: &Alteration, motion: Motion) -> Result<Motion, Failure> {
        let (before, mut motion) = alteration.of(self.pc, motion);
        let Some(before) = before else { return Ok(motion) };
        let report = self.execute(&before)?;
        self.moved(report);
        self.done.aside = Some(self.cell.joints());
        if let Goal::Displaced { from, .. } | Goal::Turned { from, .. } = &mut motion.goal {
            *from = self.cell.joints();
        }
        Ok(motion)
    }

    /// Go back, as the settings for that say. Here a force that stops the motion is a fault: the
    /// arm is not where it was.
    fn go_back(&mut self, goal: Goal, path: Path, limit_n: Option<f64>) -> Result<(), Failure> {
        let force_limit_n = match (limit_n, self.reverse_force_limit_n()) {
            (Some(own), Some(set)) => Some(own.min(set)),
            (own, set) => own.or(set),
        };
        let motion = Motion {
            goal,
            path: if self.goes_back_straight() { Path::Linear } else { path },
            speed: self.reverse_speed()?,
            tool: self.tool(),
            force_limit_n,
        };
        let report = self.cell.execute(&motion)?;
        self.moved(report);
        match (report.end, force_limit_n) {
            (MotionEnd::StoppedByForce, Some(limit_n)) => {
                Err(Fault::ForceLimit { force_n: report.peak_force_n, limit_n }.into())
            }
            _ => Ok(()),
        }
    }

    /// Go back to where a motion began, and where it was made aside, by there: the way it came.
    fn go_back_from(
        &mut self,
        start: &Joints,
        goal: impl Fn(&Joints) -> Goal,
        path: Path,
        limit_n: Option<f64>,
    ) -> Result<(), Failure> {
        let Some(aside) = self.aside else { return self.go_back(goal(start), path, limit_n) };
        self.go_back(goal(&Joints(aside)), path, limit_n)?;
        self.go_back(Goal::Joints(start.0), Path::Linear, limit_n)
    }

    fn start(&self) -> Joints {
        Joints(self.cell.joints())
    }
}

/// Motions: which path they take, what their goal is, given where they started, and what force
/// stops them, going there and going back.
macro_rules! motions {
    ($($op:ident($this:ident, $acts:ident, $start:ident)
        $path:expr => $goal:expr, $limit:expr, $limit_back:expr;)*) => {$(
        impl AfterForward<Acts<'_>> for op::$op {
            type Saved = Joints;

            fn save(&self, acts: &Acts<'_>) -> Joints {
                acts.start()
            }

            fn forward(self, $acts: &mut Acts<'_>, $start: &Joints) -> Result<(), Failure> {
                let ($this, _) = (self, $start);
                let goal = $goal;
                let limit = $limit;
                $acts.go(goal, $path, limit)
            }

            fn reverse(self, $acts: &mut Acts<'_>, start: &Joints) -> Result<(), Failure> {
                let $this = self;
                let _ = $this;
                let limit_back = $limit_back;
                let goal = |from: &Joints| Goal::Joints(from.0);
                $acts.go_back_from(start, goal, $path, limit_back)
            }
        }
    )*};
}

motions! {
    MoveJoint(_op, acts, start) Path::Joint => Goal::Joints(acts.joints(0)?), None, None;
    MoveLinear(_op, acts, start) Path::Linear => Goal::Joints(acts.joints(0)?), None, None;
    MoveItem(op, acts, start) path(op.path) => {
        Goal::Pose(keyframe_pose(acts, op.keyframe)?)
    }, None, None;
    MoveRelative(op, acts, start) Path::Linear => {
        displaced(acts, start, op.axis, op.frame)
    }, None, None;
    MoveOffset(op, acts, start) Path::Linear => Goal::Offset {
        from: start.0,
        by_m: [acts.real(0), acts.real(1), acts.real(2)],
        frame: frame(op.frame),
    }, None, None;
    MoveGuarded(op, acts, start) Path::Linear => {
        displaced(acts, start, op.axis, op.frame)
    }, Some(acts.real(1)), None;
    MoveGuardedOpposite(op, acts, start) Path::Linear => {
        displaced(acts, start, op.axis, op.frame)
    }, Some(acts.real(1)), Some(acts.real(1));
    MoveSlot(op, acts, start) path(op.path) => Goal::Joints(*acts.position(op.slot)), None, None;
}

/// Turns: what force stops them going there. Going back they are turned back, since where they
/// began may be whole turns away.
macro_rules! turns {
    ($($op:ident($acts:ident) $limit:expr;)*) => {$(
        impl AfterForward<Acts<'_>> for op::$op {
            type Saved = Joints;

            fn save(&self, acts: &Acts<'_>) -> Joints {
                acts.start()
            }

            fn forward(self, $acts: &mut Acts<'_>, start: &Joints) -> Result<(), Failure> {
                let by = [$acts.real(0), $acts.real(1)];
                let limit = $limit;
                $acts.go(turned(start, by, self.axis, self.frame), Path::Linear, limit)
            }

            fn reverse(self, acts: &mut Acts<'_>, start: &Joints) -> Result<(), Failure> {
                let goal = |from: &Joints| turned(from, [0.0; 2], self.axis, self.frame);
                acts.go_back_from(start, goal, Path::Linear, None)
            }
        }
    )*};
}

turns! {
    MoveTurn(acts) None;
    MoveTurnGuarded(acts) Some(acts.real(2));
}

/// A turn by an angle in radians, and on by metres.
fn turned(start: &Joints, by: [f64; 2], about: isa::Axis, of: isa::Frame) -> Goal {
    let [angle_rad, advance_m] = by;
    Goal::Turned { from: start.0, angle_rad, advance_m, axis: axis(about), frame: frame(of) }
}

fn displaced(acts: &Acts<'_>, start: &Joints, along: isa::Axis, of: isa::Frame) -> Goal {
    Goal::Displaced { from: start.0, distance_m: acts.real(0), axis: axis(along), frame: frame(of) }
}

fn keyframe_pose(acts: &Acts<'_>, keyframe: isa::KeyframeId) -> Result<Pose, Failure> {
    let index = acts.operand(0) as usize;
    let item = acts.module.items.get(index).ok_or(TrapKind::Foreign)?;
    let found = item.keyframes.iter().find(|candidate| candidate.name == keyframe.0);
    let keyframe = found.ok_or(TrapKind::NoKeyframe)?;
    let nominal = acts.cell.nominal_pose(acts.links.items[index]).ok_or(TrapKind::NoKeyframe)?;
    Ok(nominal.compose(&Pose::from_rotation_vector(keyframe.position_m, keyframe.rotation_rad)))
}

impl Always<Acts<'_>> for op::MoveAlways {
    fn forward(self, acts: &mut Acts<'_>) -> Result<(), Failure> {
        let goal: JointConfiguration = acts.joints(1)?;
        acts.go(Goal::Joints(goal), path(self.path), None)
    }

    fn reverse(self, acts: &mut Acts<'_>) -> Result<(), Failure> {
        let goal: JointConfiguration = acts.joints(0)?;
        acts.go_back(Goal::Joints(goal), path(self.path), None)
    }
}
