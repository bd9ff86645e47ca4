//! What is truly wrong in a workcell now: for observers, reports, and a strategy that knows the
//! cause and shows what could be had. Programs and strategies that run on hardware cannot ask.

use crate::gripper::Rest;
use crate::sim::Sim;
use obverse_geometry::Pose;
use obverse_geometry::tolerance::pose_distance;
use std::fmt;

/// Less than this is not off, in metres and radians.
const ON: f64 = 1e-9;

/// Something that is not as the workcell file says that it should be.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// What is wrong.
    pub kind: CauseKind,
    /// With what: the name of an item, a fixture or a feeder, or the number of a line.
    pub of: String,
    /// How far it is off, in metres, where that is what is wrong.
    pub by_m: f64,
    /// How far it is turned, in radians, where that is what is wrong.
    pub by_rad: f64,
}

/// What can be wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CauseKind {
    /// A fixture does not stand where it should.
    FixtureShift,
    /// An item that has not been taken lies not where it should.
    ItemShift,
    /// An item was presented askew, and is still the same part.
    Askew,
    /// Taking the held item moved it in the gripper.
    GraspOffset,
    /// The held item has slipped in the gripper.
    Slipped,
    /// An item was knocked over.
    Knocked,
    /// An item fell.
    Dropped,
    /// An item is not in the cell: a feeder has not brought it yet, or it fell out of reach.
    Absent,
    /// A feeder had nothing when it was asked last.
    Empty,
    /// An output is not at the level it was set to.
    OutputStuck,
    /// An input does not show the level that it should.
    InputStuck,
    /// An input flickers.
    InputFlickers,
    /// A stop holds the arm.
    Stopped,
}

impl CauseKind {
    /// The stable code of this kind, as machines read it.
    #[must_use]
    pub fn code(self) -> &'static str {
        match self {
            Self::FixtureShift => "fixture_shift",
            Self::ItemShift => "item_shift",
            Self::Askew => "askew",
            Self::GraspOffset => "grasp_offset",
            Self::Slipped => "slipped",
            Self::Knocked => "knocked",
            Self::Dropped => "dropped",
            Self::Absent => "absent",
            Self::Empty => "empty",
            Self::OutputStuck => "output_stuck",
            Self::InputStuck => "input_stuck",
            Self::InputFlickers => "input_flickers",
            Self::Stopped => "stopped",
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.kind.code(), self.of)?;
        if self.by_m > 0.0 || self.by_rad > 0.0 {
            write!(f, " by {:.3} mm, {:.3} deg", self.by_m * 1e3, self.by_rad.to_degrees())?;
        }
        Ok(())
    }
}

impl Cause {
    fn new(kind: CauseKind, of: impl Into<String>) -> Self {
        Self { kind, of: of.into(), by_m: 0.0, by_rad: 0.0 }
    }

    /// What is off from where it should be, if it is.
    fn off(kind: CauseKind, of: &str, should: &Pose, is: &Pose) -> Option<Self> {
        let (by_m, by_rad) = pose_distance(should, is);
        (by_m > ON || by_rad > ON).then(|| Self { kind, of: of.to_owned(), by_m, by_rad })
    }
}

impl Sim {
    /// Everything that is not as it should be now, fixtures first. An item that a program has put
    /// somewhere is no cause.
    #[must_use]
    pub fn truth(&self) -> Vec<Cause> {
        let mut causes = Vec::new();
        for (fixture, pose) in self.world.cell.fixtures.iter().zip(&self.world.fixtures) {
            causes.extend(Cause::off(CauseKind::FixtureShift, &fixture.name, &fixture.pose, pose));
        }
        for index in 0..self.items.count() {
            self.truth_of_item(index, &mut causes);
        }
        let feeders = self.world.cell.feeders.iter().zip(&self.feeders);
        let empty = feeders.filter(|(_, feeder)| feeder.is_empty);
        causes.extend(empty.map(|(spec, _)| Cause::new(CauseKind::Empty, &spec.name)));
        for (bit, output) in self.outputs.iter().enumerate() {
            if output.is_stuck() {
                causes.push(Cause::new(CauseKind::OutputStuck, bit.to_string()));
            }
        }
        for (bit, wire) in self.wires.iter().enumerate() {
            if wire.is_stuck() {
                causes.push(Cause::new(CauseKind::InputStuck, bit.to_string()));
            }
            if wire.is_flickering(self.now_s) {
                causes.push(Cause::new(CauseKind::InputFlickers, bit.to_string()));
            }
        }
        if self.stopped {
            causes.push(Cause::new(CauseKind::Stopped, "arm"));
        }
        causes
    }

    fn truth_of_item(&self, index: usize, causes: &mut Vec<Cause>) {
        let name = &self.world.cell.items[index].name;
        if self.items.is_askew(index) {
            causes.push(Cause::new(CauseKind::Askew, name));
        }
        match self.items.rest(index) {
            Rest::Knocked => causes.push(Cause::new(CauseKind::Knocked, name)),
            Rest::Dropped => causes.push(Cause::new(CauseKind::Dropped, name)),
            Rest::Absent => causes.push(Cause::new(CauseKind::Absent, name)),
            Rest::Standing => {}
        }
        if self.items.held() == Some(index) {
            if let Some(moved) = self.items.held_moved() {
                let still = Pose::identity();
                let (grasp, slip) = (CauseKind::GraspOffset, CauseKind::Slipped);
                causes.extend(Cause::off(grasp, name, &still, &moved.by_grasp));
                causes.extend(Cause::off(slip, name, &still, &moved.by_slip));
            }
        } else if self.items.is_untouched(index)
            && let Some(pose) = self.items.pose(index, &self.joints)
        {
            let place = self.world.item_place(index);
            causes.extend(Cause::off(CauseKind::ItemShift, name, &place, &pose));
        }
    }
}
