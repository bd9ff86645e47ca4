//! Items: where they truly are, which one the gripper holds, and how.
//!
//! An item that is taken and given back with the joints at the same values, bit for bit, lies again
//! exactly where it lay: the pose it was taken from is kept with the grip and not computed again,
//! and a grip that explains exactly how an item lies under the gripper is used again. Knows nothing
//! of contact.

use crate::cell::{GripperSpec, ItemSpec};
use crate::kinematics::forward;
use obverse_geometry::tolerance::pose_distance;
use obverse_geometry::{JointConfiguration, Pose};

/// How many grips of an item are remembered.
const GRIPS_MAX: usize = 16;

/// How an item sits in the gripper.
#[derive(Clone, Copy, Debug)]
struct Grip {
    /// The item in the frame of the tool mount.
    in_mount: Pose,
    /// Where the joints were when the item was taken from `origin`.
    taken_at: JointConfiguration,
    /// The pose it was taken from.
    origin: Pose,
}

impl Grip {
    /// Where the item is with the joints there.
    fn pose(&self, joints: &JointConfiguration) -> Pose {
        if joints.same_bits(&self.taken_at) {
            return self.origin;
        }
        forward(joints).compose(&self.in_mount)
    }
}

#[derive(Clone, Debug)]
struct Item {
    /// Where it lies while it is not held.
    pose: Pose,
    /// How it was held, the present or last grip at the end.
    grips: Vec<Grip>,
}

impl Item {
    /// Take it as it was held before, if it lies exactly as that grip would have left it here.
    fn take_again(&mut self, joints: &JointConfiguration) -> bool {
        let Some(index) = self.grips.iter().rposition(|grip| grip.pose(joints) == self.pose) else {
            return false;
        };
        let grip = self.grips.remove(index);
        self.grips.push(grip);
        true
    }

    fn take(&mut self, joints: &JointConfiguration) {
        let in_mount = forward(joints).inverse().compose(&self.pose);
        if self.grips.len() == GRIPS_MAX {
            self.grips.remove(0);
        }
        self.grips.push(Grip { in_mount, taken_at: *joints, origin: self.pose });
    }
}

/// All items and the one that is held.
#[derive(Clone, Debug)]
pub(crate) struct Inventory {
    items: Vec<Item>,
    held: Option<usize>,
}

impl Inventory {
    pub(crate) fn new(poses: impl Iterator<Item = Pose>) -> Self {
        Self { items: poses.map(|pose| Item { pose, grips: Vec::new() }).collect(), held: None }
    }

    pub(crate) fn held(&self) -> Option<usize> {
        self.held
    }

    /// The held item in the frame of the tool mount.
    pub(crate) fn held_in_mount(&self) -> Option<(usize, Pose)> {
        let index = self.held?;
        self.items[index].grips.last().map(|grip| (index, grip.in_mount))
    }

    /// Where an item is while the joints are at `joints`.
    pub(crate) fn pose(&self, index: usize, joints: &JointConfiguration) -> Option<Pose> {
        let item = self.items.get(index)?;
        match item.grips.last() {
            Some(grip) if self.held == Some(index) => Some(grip.pose(joints)),
            _ => Some(item.pose),
        }
    }

    /// Where each item lies that is not held.
    pub(crate) fn lying(&self) -> impl Iterator<Item = (usize, &Pose)> {
        let held = self.held;
        let all = self.items.iter().enumerate().map(|(index, item)| (index, &item.pose));
        all.filter(move |(index, _)| Some(*index) != held)
    }

    pub(crate) fn count(&self) -> usize {
        self.items.len()
    }

    /// There are no items any more.
    pub(crate) fn clear(&mut self) {
        self.items.clear();
        self.held = None;
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
        gripper: &GripperSpec,
        tcp: &Pose,
        joints: &JointConfiguration,
    ) {
        if self.held.is_some() {
            return;
        }
        self.held = self.items.iter_mut().position(|item| item.take_again(joints));
        if self.held.is_some() {
            return;
        }
        let here = forward(joints).compose(tcp);
        let mut best: Option<(f64, usize)> = None;
        for (index, (item, spec)) in self.items.iter().zip(specs).enumerate() {
            let (far_m, turned_rad) = pose_distance(&item.pose.compose(&spec.grasp), &here);
            let near = far_m <= gripper.near_m && turned_rad <= gripper.near_rad;
            if near && best.is_none_or(|(best_m, _)| far_m < best_m) {
                best = Some((far_m, index));
            }
        }
        if let Some((_, index)) = best {
            self.items[index].take(joints);
            self.held = Some(index);
        }
    }

    /// Open the gripper: what it held stays where it is.
    pub(crate) fn open(&mut self, joints: &JointConfiguration) {
        let Some(index) = self.held.take() else { return };
        let item = &mut self.items[index];
        if let Some(grip) = item.grips.last() {
            item.pose = grip.pose(joints);
        }
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
            self.items.close(&self.cell.items, &gripper, &Pose::identity(), joints);
            self.items.held()
        }

        fn open(&mut self, joints: &JointConfiguration) -> Pose {
            self.items.open(joints);
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
