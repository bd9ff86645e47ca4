//! The ranges of the joints: what is refused because of them, and which turn of a joint fits.
//!
//! Nothing is ever clipped to a range. Knows nothing of poses.

use obverse_geometry::{JOINT_COUNT, JointConfiguration};
use obverse_workcell::Fault;
use std::f64::consts::TAU;

/// The range of each joint, in radians.
pub(crate) type Ranges = [(f64, f64); JOINT_COUNT];

/// Refuse a configuration with a joint outside its range.
pub(crate) fn check(joints: &JointConfiguration, ranges: &Ranges) -> Result<(), Fault> {
    for (number, (&value_rad, &range_rad)) in (1..).zip(joints.0.iter().zip(ranges)) {
        if !(range_rad.0..=range_rad.1).contains(&value_rad) {
            return Err(Fault::JointLimit { joint: number, value_rad, range_rad });
        }
    }
    Ok(())
}

/// The same configuration with joints turned by whole turns into their ranges: `joints` as they
/// are where they fit, otherwise as near to `reference` as fits.
pub(crate) fn turned_into(
    joints: &JointConfiguration,
    ranges: &Ranges,
    reference: &JointConfiguration,
) -> JointConfiguration {
    let mut turned = joints.0;
    for ((joint, (low, high)), near) in turned.iter_mut().zip(ranges).zip(reference.0) {
        if (*low..=*high).contains(joint) {
            continue;
        }
        let candidates = (-4..=4).map(|turns| *joint + f64::from(turns) * TAU);
        let fitting = candidates.filter(|value| (*low..=*high).contains(value));
        let nearest = fitting.min_by(|a, b| (a - near).abs().total_cmp(&(b - near).abs()));
        *joint = nearest.unwrap_or(*joint);
    }
    JointConfiguration(turned)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANGES: Ranges = [(-TAU, TAU); JOINT_COUNT];

    #[test]
    fn a_joint_outside_its_range_is_named_with_its_value() {
        let mut joints = JointConfiguration::ZERO;
        joints.0[3] = 6.5;
        let fault = check(&joints, &RANGES).unwrap_err();
        assert_eq!(fault, Fault::JointLimit { joint: 4, value_rad: 6.5, range_rad: (-TAU, TAU) });
        joints.0[3] = TAU;
        assert_eq!(check(&joints, &RANGES), Ok(()));
    }

    #[test]
    fn a_joint_beyond_its_range_is_turned_back_into_it() {
        let mut joints = JointConfiguration::ZERO;
        joints.0[0] = 6.5;
        let turned = turned_into(&joints, &RANGES, &joints);
        assert!((turned.0[0] - (6.5 - TAU)).abs() < 1e-12);
        let narrow = [(1.0, 2.0); JOINT_COUNT];
        assert_eq!(turned_into(&JointConfiguration::ZERO, &narrow, &joints).0[1], 0.0);
    }
}
