//! Items: where they truly are, which one the gripper holds, and how.
//!
//! An item that is taken and given back with the joints at the same values, bit for bit, lies again
//! exactly where it lay: the pose it was taken from is kept with the grip and not computed again,
//! and a grip that explains exactly how an item lies under the gripper is used again. What moved in
//! the gripper falls back to where it was taken from if it is given back there: what held it before
//! holds it again. Knows nothing of contact.

use crate::cell::{GripperSpec, ItemSpec, OffsetSpec};
use crate::kinematics::forward;
use crate::random::Stream;
use crate::world::drawn_offset;
use obverse_geometry::tolerance::pose_distance;
use obverse_geometry::{JointConfiguration, Pose};

/// How many grips of an item are remembered.
const GRIPS_MAX: usize = 16;
/// The gripper is where it was if no joint is farther away than this, in radians: a tenth of a
/// millimetre at the tool.
const SAME_PLACE_RAD: f64 = 1e-4;

/// How an item sits in the gripper.
#[derive(Clone, Copy, Debug)]
struct Grip {
    /// The item in the frame of the tool mount.
    in_mount: Pose,
    /// Where the joints were when the item was taken from `origin`.
    taken_at: JointConfiguration,
    /// The pose it was taken from.
    origin: Pose,
    /// By how much it moved in the gripper, in the frame of the tool centre point; none if it is
    /// held as it lay.
    moved: Option<Moved>,
}

/// How an item moved in the gripper.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved {
    /// When it was taken.
    pub(crate) by_grasp: Pose,
    /// Since then.
    pub(crate) by_slip: Pose,
}

impl Grip {
    /// Where the item is with the joints there.
    fn pose(&self, joints: &JointConfiguration) -> Pose {
        if self.moved.is_none() && joints.same_bits(&self.taken_at) {
            return self.origin;
        }
        forward(joints).compose(&self.in_mount)
    }

    /// Whether what is let go there falls back to where it was taken from.
    fn falls_back(&self, joints: &JointConfiguration, gripper: &GripperSpec) -> bool {
        if self.moved.is_none() || joints.largest_difference_rad(&self.taken_at) > SAME_PLACE_RAD {
            return false;
        }
        let (far_m, turned_rad) = pose_distance(&self.pose(joints), &self.origin);
        far_m <= gripper.near_m && turned_rad <= gripper.near_rad
    }
}

/// Whether an item can be taken and met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rest {
    /// It is where it was put.
    Standing,
    /// It was knocked over, and lies there.
    Knocked,
    /// It was dropped, and lies there.
    Dropped,
    /// It is not in the cell.
    Absent,
}

#[derive(Clone, Debug)]
struct Item {
    /// Where it lies while it is not held.
    pose: Pose,
    rest: Rest,
    /// Whether a feeder presented it askew.
    is_askew: bool,
    /// How it was held, the present or last grip at the end.
    grips: Vec<Grip>,
}

impl Item {
    fn can_be_taken(&self) -> bool {
        self.rest == Rest::Standing
    }

    /// Take it as it was held before, if it lies exactly as that grip would have left it here.
    fn take_again(&mut self, joints: &JointConfiguration) -> bool {
        let Some(index) = self.grips.iter().rposition(|grip| grip.pose(joints) == self.pose) else {
            return false;
        };
        let grip = self.grips.remove(index);
        self.grips.push(grip);
        true
    }

    fn take(&mut self, joints: &JointConfiguration) -> &mut Grip {
        let in_mount = forward(joints).inverse().compose(&self.pose);
        if self.grips.len() == GRIPS_MAX {
            self.grips.remove(0);
        }
        self.grips.push(Grip { in_mount, taken_at: *joints, origin: self.pose, moved: None });
        let last = self.grips.len() - 1;
        &mut self.grips[last]
    }
}

/// The gripper of a cell, and what its grasps do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hand<'a> {
    pub(crate) gripper: &'a GripperSpec,
    /// The tool centre point in the frame of the tool mount.
    pub(crate) tcp: Pose,
    pub(crate) seed: u64,
}

impl Hand<'_> {
    /// A displacement in the frame of the tool centre point, in that of the tool mount.
    fn in_mount(&self, by: &Pose) -> Pose {
        self.tcp.compose(by).compose(&self.tcp.inverse())
    }
}

/// All items and the one that is held.
#[derive(Clone, Debug)]
pub(crate) struct Inventory {
    items: Vec<Item>,
    held: Option<usize>,
    /// How many new grasps there were.
    grasps: u64,
}

impl Inventory {
    pub(crate) fn new(poses: impl Iterator<Item = Pose>) -> Self {
        let item = |pose| Item { pose, rest: Rest::Standing, is_askew: false, grips: Vec::new() };
        Self { items: poses.map(item).collect(), held: None, grasps: 0 }
    }

    pub(crate) fn held(&self) -> Option<usize> {
        self.held
    }

    /// The held item in the frame of the tool mount.
    pub(crate) fn held_in_mount(&self) -> Option<(usize, Pose)> {
        let index = self.held?;
        self.items[index].grips.last().map(|grip| (index, grip.in_mount))
    }

    /// How the held item has moved in the gripper, if it has.
    pub(crate) fn held_moved(&self) -> Option<Moved> {
        self.items[self.held?].grips.last()?.moved
    }

    /// Where an item is while the joints are at `joints`, if it is in the cell.
    pub(crate) fn pose(&self, index: usize, joints: &JointConfiguration) -> Option<Pose> {
        let item = self.items.get(index)?;
        match item.grips.last() {
            Some(grip) if self.held == Some(index) => Some(grip.pose(joints)),
            _ => (item.rest != Rest::Absent).then_some(item.pose),
        }
    }

    /// Where each item lies that is in the cell and not held.
    pub(crate) fn lying(&self) -> impl Iterator<Item = (usize, &Pose)> {
        let held = self.held;
        let there = self.items.iter().enumerate().filter(|(_, item)| item.rest != Rest::Absent);
        let all = there.map(|(index, item)| (index, &item.pose));
        all.filter(move |(index, _)| Some(*index) != held)
    }

    pub(crate) fn count(&self) -> usize {
        self.items.len()
    }

    /// How an item rests, or did before it was taken.
    pub(crate) fn rest(&self, index: usize) -> Rest {
        self.items.get(index).map_or(Rest::Absent, |item| item.rest)
    }

    /// Whether an item was presented askew.
    pub(crate) fn is_askew(&self, index: usize) -> bool {
        self.items.get(index).is_some_and(|item| item.is_askew)
    }

    /// Whether an item lies where it was at first, and was never taken.
    pub(crate) fn is_untouched(&self, index: usize) -> bool {
        let item = self.items.get(index);
        item.is_some_and(|item| item.rest == Rest::Standing && item.grips.is_empty())
    }

    /// There are no items any more.
    pub(crate) fn clear(&mut self) {
        self.items.clear();
        self.held = None;
    }

    /// Take an item out of the cell.
    pub(crate) fn remove(&mut self, index: usize) {
        if let Some(item) = self.items.get_mut(index) {
            item.rest = Rest::Absent;
            item.grips.clear();
        }
    }

    /// Put an item somewhere, as new.
    pub(crate) fn present(&mut self, index: usize, pose: Pose, is_askew: bool) {
        if let Some(item) = self.items.get_mut(index) {
            *item = Item { pose, rest: Rest::Standing, is_askew, grips: Vec::new() };
        }
    }

    /// An item that is not held comes to lie elsewhere, and can no longer be taken.
    pub(crate) fn lay(&mut self, index: usize, pose: Pose, rest: Rest) {
        if let Some(item) = self.items.get_mut(index) {
            (item.pose, item.rest) = (pose, rest);
            item.grips.clear();
        }
    }

    /// What is held and how, and where everything else lies, as numbers.
    pub(crate) fn each_number(&self, sink: &mut dyn FnMut(u64)) {
        let mut pose = |pose: &Pose| {
            pose.rotation.iter().chain(pose.translation_m.iter()).for_each(|x| sink(x.to_bits()));
        };
        self.lying().for_each(|(_, lies)| pose(lies));
        if let Some((index, in_mount)) = self.held_in_mount() {
            pose(&in_mount);
            sink(index as u64);
        }
    }

    /// Close the gripper: take the item that was let go right here, else the one whose grasp is
    /// nearest to the tool centre point and near enough.
    pub(crate) fn close(
        &mut self,
        specs: &[ItemSpec],
        hand: &Hand<'_>,
        joints: &JointConfiguration,
    ) {
        if self.held.is_some() {
            return;
        }
        let again = |item: &mut Item| item.can_be_taken() && item.take_again(joints);
        self.held = self.items.iter_mut().position(again);
        if self.held.is_some() {
            return;
        }
        let here = forward(joints).compose(&hand.tcp);
        let mut best: Option<(f64, usize)> = None;
        for (index, (item, spec)) in self.items.iter().zip(specs).enumerate() {
            let (far_m, turned_rad) = pose_distance(&item.pose.compose(&spec.grasp), &here);
            let near = far_m <= hand.gripper.near_m && turned_rad <= hand.gripper.near_rad;
            if near && item.can_be_taken() && best.is_none_or(|(best_m, _)| far_m < best_m) {
                best = Some((far_m, index));
            }
        }
        if let Some((_, index)) = best {
            self.grasp(index, &specs[index], hand, joints);
        }
    }

    /// Take an item anew, which moves it in the gripper: to the middle, and then off by chance.
    fn grasp(
        &mut self,
        index: usize,
        spec: &ItemSpec,
        hand: &Hand<'_>,
        joints: &JointConfiguration,
    ) {
        let grip = self.items[index].take(joints);
        self.held = Some(index);
        let number = self.grasps;
        self.grasps += 1;
        let GripperSpec { centres, grasp_offset: offset, .. } = hand.gripper;
        if *centres == [false; 2] && *offset == OffsetSpec::default() {
            return;
        }
        let off = hand.tcp.inverse().compose(&grip.in_mount).compose(&spec.grasp).translation_m;
        let [x, y] = std::array::from_fn(|axis| if centres[axis] { -off[axis] } else { 0.0 });
        let to_middle = Pose::from_rotation_vector([x, y, 0.0], [0.0; 3]);
        let streams = (Stream::GraspUniform, Stream::GraspNormal);
        let by_grasp = drawn_offset(offset, hand.seed, streams, number);
        grip.in_mount = hand.in_mount(&by_grasp.compose(&to_middle)).compose(&grip.in_mount);
        grip.moved = Some(Moved { by_grasp, by_slip: Pose::identity() });
    }

    /// The held item moves in the gripper, in the frame of the tool centre point.
    pub(crate) fn slip(&mut self, hand: &Hand<'_>, by: &Pose) {
        let Some(index) = self.held else { return };
        let Some(grip) = self.items[index].grips.last_mut() else { return };
        grip.in_mount = hand.in_mount(by).compose(&grip.in_mount);
        let moved = grip
            .moved
            .get_or_insert(Moved { by_grasp: Pose::identity(), by_slip: Pose::identity() });
        moved.by_slip = by.compose(&moved.by_slip);
    }

    /// Open the gripper: what it held stays where it is, or falls back to where it was taken from.
    /// The item that was let go, and whether it fell back.
    pub(crate) fn open(
        &mut self,
        gripper: &GripperSpec,
        joints: &JointConfiguration,
    ) -> Option<(usize, bool)> {
        let index = self.held.take()?;
        let item = &mut self.items[index];
        let grip = *item.grips.last()?;
        let falls_back = grip.falls_back(joints, gripper);
        item.pose = if falls_back { grip.origin } else { grip.pose(joints) };
        Some((index, falls_back || joints.same_bits(&grip.taken_at)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::Cell;

    struct Hand {
        cell: Cell,
        items: Inventory,
    }

    impl Hand {
        fn new() -> Self {
            let cell = Cell::bare();
            let items = Inventory::new(cell.items.iter().map(|item| item.pose));
            Self { cell, items }
        }

        fn close(&mut self, joints: &JointConfiguration) -> Option<usize> {
            let gripper = self.cell.gripper.unwrap();
            let hand = super::Hand { gripper: &gripper, tcp: Pose::identity(), seed: 1 };
            self.items.close(&self.cell.items, &hand, joints);
            self.items.held()
        }

        fn open(&mut self, joints: &JointConfiguration) -> Pose {
            self.items.open(&self.cell.gripper.unwrap(), joints);
            self.items.pose(0, joints).unwrap()
        }
    }

    fn moved(joints: &JointConfiguration, by: f64) -> JointConfiguration {
        JointConfiguration(joints.0.map(|joint| joint + by))
    }

    #[test]
    fn only_what_is_near_is_taken() {
        let mut hand = Hand::new();
        let home = hand.cell.arm.home;
        assert_eq!(hand.close(&moved(&home, 0.1)), None);
        // A fraction of a millimetre and of a degree.
        assert_eq!(hand.close(&moved(&home, 0.0005)), Some(0));
    }

    #[test]
    fn every_grip_on_the_way_is_undone_exactly() {
        let mut hand = Hand::new();
        let home = hand.cell.arm.home;
        let (away, near) = (moved(&home, 0.3), moved(&home, 0.300_5));
        let first = hand.items.pose(0, &home).unwrap();
        // Taken at home and left; taken again a little aside of that, and left elsewhere.
        hand.close(&home);
        let second = hand.open(&away);
        hand.close(&near);
        let third = hand.open(&moved(&home, -0.4));
        assert!(first != second && second != third);
        // Backwards: each time where it was, bit for bit.
        assert_eq!(hand.close(&moved(&home, -0.4)), Some(0));
        assert_eq!(hand.open(&near), second);
        assert_eq!(hand.close(&away), Some(0));
        assert_eq!(hand.open(&home), first);
        // And forwards again.
        assert_eq!(hand.close(&home), Some(0));
        assert_eq!(hand.open(&away), second);
    }

    #[test]
    fn grips_are_not_remembered_without_bound() {
        let mut hand = Hand::new();
        let mut joints = hand.cell.arm.home;
        for _ in 0..100 {
            assert_eq!(hand.close(&moved(&joints, 1e-6)), Some(0));
            joints = moved(&joints, 0.01);
            hand.open(&joints);
        }
        assert!(hand.items.items[0].grips.len() <= GRIPS_MAX);
    }
}
