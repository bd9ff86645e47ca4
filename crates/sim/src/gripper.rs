//! Items: where they truly are, which one the gripper holds, and how.
//!
//! An item that is taken and given back with the joints at the same values, bit for bit, lies again
//! exactly where it lay: the pose it was taken from is kept with the grip and not computed again.
//! Knows nothing of contact.

use crate::cell::{GripperSpec, ItemSpec};
use crate::kinematics::forward;
use obverse_geometry::tolerance::pose_distance;
use obverse_geometry::{JointConfiguration, Pose};

/// How an item sits in the gripper.
#[derive(Clone, Copy, Debug)]
struct Grip {
    /// The item in the frame of the tool mount.
    in_mount: Pose,
    /// Where the joints were when the item was taken from `origin`.
    taken_at: JointConfiguration,
    /// The pose it was taken from.
    origin: Pose,
    /// Where the joints were when it was let go last.
    left_at: Option<JointConfiguration>,
}

impl Grip {
    fn pose(&self, joints: &JointConfiguration) -> Pose {
        if joints.same_bits(&self.taken_at) {
            return self.origin;
        }
        forward(joints).compose(&self.in_mount)
    }
}

#[derive(Clone, Copy, Debug)]
struct Item {
    /// Where it lies while it is not held.
    pose: Pose,
    /// How it was held last.
    grip: Option<Grip>,
}

/// All items and the one that is held.
#[derive(Clone, Debug)]
pub(crate) struct Inventory {
    items: Vec<Item>,
    held: Option<usize>,
}

impl Inventory {
    pub(crate) fn new(poses: impl Iterator<Item = Pose>) -> Self {
        Self { items: poses.map(|pose| Item { pose, grip: None }).collect(), held: None }
    }

    pub(crate) fn held(&self) -> Option<usize> {
        self.held
    }

    /// The held item in the frame of the tool mount.
    pub(crate) fn held_in_mount(&self) -> Option<(usize, Pose)> {
        let index = self.held?;
        self.items[index].grip.map(|grip| (index, grip.in_mount))
    }

    /// Where an item is while the joints are at `joints`.
    pub(crate) fn pose(&self, index: usize, joints: &JointConfiguration) -> Option<Pose> {
        let item = self.items.get(index)?;
        match item.grip {
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
        let left_here = |item: &Item| {
            item.grip.and_then(|grip| grip.left_at).is_some_and(|left| left.same_bits(joints))
        };
        if let Some(index) = self.items.iter().position(left_here) {
            self.held = Some(index);
            return;
        }
        let mount = forward(joints);
        let here = mount.compose(tcp);
        let mut best: Option<(f64, usize)> = None;
        for (index, (item, spec)) in self.items.iter().zip(specs).enumerate() {
            let (far_m, turned_rad) = pose_distance(&item.pose.compose(&spec.grasp), &here);
            let near = far_m <= gripper.near_m && turned_rad <= gripper.near_rad;
            if near && best.is_none_or(|(best_m, _)| far_m < best_m) {
                best = Some((far_m, index));
            }
        }
        let Some((_, index)) = best else { return };
        let origin = self.items[index].pose;
        let in_mount = mount.inverse().compose(&origin);
        self.items[index].grip = Some(Grip { in_mount, taken_at: *joints, origin, left_at: None });
        self.held = Some(index);
    }

    /// Open the gripper: what it held stays where it is.
    pub(crate) fn open(&mut self, joints: &JointConfiguration) {
        let Some(index) = self.held.take() else { return };
        let item = &mut self.items[index];
        if let Some(grip) = &mut item.grip {
            item.pose = grip.pose(joints);
            grip.left_at = Some(*joints);
        }
    }
}
