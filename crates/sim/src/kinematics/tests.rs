//! Forward against the table of links, inverse against forward, on random configurations.

use super::*;
use crate::random::{Stream, signed, unit};
use obverse_geometry::tolerance::{pose_distance, same_pose};
use std::f64::consts::FRAC_PI_2;

fn random_joints(seed: u64, number: u64) -> JointConfiguration {
    let mut joints = [0.0; 6];
    for (index, joint) in (0..).zip(&mut joints) {
        *joint = TAU * signed(seed, Stream::Dice, number * 6 + index);
    }
    JointConfiguration(joints)
}

/// Denavit and Hartenberg's product, row by row as the maker writes it.
fn forward_by_table(joints: &JointConfiguration) -> Pose {
    let rows = [
        (D1_M, 0.0, FRAC_PI_2),
        (0.0, A2_M, 0.0),
        (0.0, A3_M, 0.0),
        (D4_M, 0.0, FRAC_PI_2),
        (D5_M, 0.0, -FRAC_PI_2),
        (D6_M, 0.0, 0.0),
    ];
    let mut pose = Pose::identity();
    for ((d, a, alpha), theta) in rows.into_iter().zip(joints.0) {
        let turn = Pose::from_rotation_vector([0.0, 0.0, d], [0.0, 0.0, theta]);
        let twist = Pose::from_rotation_vector([a, 0.0, 0.0], [alpha, 0.0, 0.0]);
        pose = pose.compose(&turn).compose(&twist);
    }
    pose
}

#[test]
fn forward_is_the_product_of_the_table() {
    for number in 0..2_000 {
        let joints = random_joints(1, number);
        let (position_m, angle_rad) = pose_distance(&forward(&joints), &forward_by_table(&joints));
        assert!(position_m < 1e-14 && angle_rad < 1e-14, "{joints:?}: {position_m} {angle_rad}");
    }
}

#[test]
fn all_zero_stretches_the_arm_along_minus_x() {
    let mount = forward(&JointConfiguration::ZERO);
    let expected = Vector3::new(A2_M + A3_M, -D4_M - D6_M, D1_M - D5_M);
    assert!((mount.translation_m - expected).norm() < 1e-15);
}

#[test]
fn every_inverse_solution_reaches_the_pose() {
    let mut most = 0;
    for number in 0..5_000 {
        let joints = random_joints(2, number);
        let mount = forward(&joints);
        let solutions = inverse(&mount, &joints);
        assert!(!solutions.as_slice().is_empty(), "{joints:?}");
        for solution in solutions.as_slice() {
            let (position_m, angle_rad) = pose_distance(&forward(solution), &mount);
            assert!(position_m < 1e-9 && angle_rad < 1e-9, "{solution:?} for {joints:?}");
        }
        most = most.max(solutions.as_slice().len());
    }
    assert_eq!(most, 8);
}

#[test]
fn the_inverse_finds_the_configuration_it_came_from() {
    for number in 0..5_000 {
        let joints = random_joints(3, number);
        let nearest = inverse(&forward(&joints), &joints)
            .as_slice()
            .iter()
            .map(|solution| solution.largest_difference_rad(&joints))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-6, "{joints:?}: nearest solution is {nearest} rad away");
        let branch = Branch::of(&joints);
        let same = inverse_on_branch(&forward(&joints), branch, &joints).unwrap();
        assert!(same.largest_difference_rad(&joints) < 1e-6, "{joints:?} {branch:?}");
    }
}

#[test]
fn solutions_stay_within_half_a_turn_of_the_reference() {
    for number in 0..500 {
        let reference = random_joints(4, number);
        let mount = forward(&random_joints(5, number));
        for solution in inverse(&mount, &reference).as_slice() {
            assert!(solution.largest_difference_rad(&reference) <= PI + 1e-12);
        }
    }
}

#[test]
fn near_singularities_solutions_still_reach_the_pose() {
    // The wrist, the stretched and the folded elbow, each at and around the singular angle.
    for number in 0..200 {
        let base = random_joints(6, number);
        let tiny = libm::pow(10.0, -16.0 * unit(7, Stream::Dice, number));
        for (joint, angle) in [(4, 0.0), (4, PI), (2, 0.0), (2, PI)] {
            for offset in [0.0, tiny, -tiny] {
                let mut joints = base;
                joints.0[joint] = angle + offset;
                let mount = forward(&joints);
                let solutions = inverse(&mount, &joints);
                assert!(!solutions.as_slice().is_empty(), "{joints:?}");
                for solution in solutions.as_slice() {
                    assert!(same_pose(&forward(solution), &mount), "{solution:?} of {joints:?}");
                }
            }
        }
    }
}

#[test]
fn a_singular_wrist_keeps_joint_6_of_the_reference() {
    let joints = JointConfiguration([0.4, -1.1, 1.3, -1.0, 0.0, 0.7]);
    let mount = forward(&joints);
    let mut reference = joints;
    reference.0[5] = 0.25;
    let solutions = inverse(&mount, &reference);
    assert!(solutions.as_slice().iter().any(|solution| solution.0[5] == 0.25));
}

#[test]
fn poses_beyond_the_arm_or_in_its_column_have_no_solution() {
    let rotation = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    let far = Pose { rotation, translation_m: Vector3::new(1.2, 0.0, 0.2) };
    let column = Pose { rotation, translation_m: Vector3::new(0.02, 0.03, 0.4) };
    assert!(inverse(&far, &JointConfiguration::ZERO).as_slice().is_empty());
    assert!(inverse(&column, &JointConfiguration::ZERO).as_slice().is_empty());
}
