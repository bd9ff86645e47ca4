//! The search against brute force: looking at every pair at many places of a route.

use super::*;
use crate::cell::Cell;
use crate::random::{Stream, unit};
use obverse_geometry::JointConfiguration;
use obverse_workcell::{Goal, Motion, Path, Speed, ToolId};
use std::sync::Arc;

/// How many places of a route brute force looks at.
const PLACES: u32 = 200;

fn world() -> World {
    let text = include_str!("../../../../programs/bench_cell.toml");
    World::new(Arc::new(Cell::parse(text).unwrap()), 1)
}

fn route(world: &World, from: &JointConfiguration, to: Goal, path: Path) -> Option<Route> {
    let motion =
        Motion { goal: to, path, speed: Speed::Normal, tool: ToolId(0), force_limit_n: None };
    Route::plan(&world.cell, from, &motion).ok()
}

/// Near the table, the elbow mostly up.
fn random_joints(number: u64) -> JointConfiguration {
    let draw = |axis| unit(31, Stream::Dice, number * 6 + axis);
    JointConfiguration([
        2.2 + 1.8 * draw(0),
        -2.4 + 1.8 * draw(1),
        0.4 + 1.8 * draw(2),
        -2.2 + 1.4 * draw(3),
        -2.0 + draw(4),
        draw(5),
    ])
}

/// The greatest force between any two bodies at a place, by how much it exceeds what stops them.
fn worst_excess_n(sweep: &Sweep<'_>, fraction: f64) -> f64 {
    let mut place = Place::at(sweep.route, fraction);
    let mut worst = f64::NEG_INFINITY;
    for (moving, body) in sweep.moving.iter().enumerate() {
        for standing in 0..sweep.world.fixed.len() + sweep.resting.len() {
            if sweep.apart_mm(moving, standing, &mut place) > 1.0 {
                continue;
            }
            let mut pair = Pair::new(moving, standing);
            sweep.look_at(&mut pair, &mut place);
            worst = worst.max(pair.force_n.norm() - body.stop_n);
        }
    }
    worst
}

/// Compare one route; whether it ended in a collision, or none if it starts in one.
fn compare(world: &World, route: &Route) -> Option<bool> {
    let items = Inventory::new(world.item_poses());
    let tool = &world.cell.tools[0];
    // All bodies, also those that the search does not pair up.
    let all = Sweep::new(world, route, &items, tool, None);
    if worst_excess_n(&all, 0.0) > -10.0 {
        return None;
    }
    let outcome = Sweep::new(world, route, &items, tool, None).run(1.0, 0.0, 0.0, None);
    for step in 0..=PLACES {
        let fraction = f64::from(step) / f64::from(PLACES) * outcome.fraction;
        // What is pressed exactly to the limit at the end may round to beyond it.
        let excess_n = worst_excess_n(&all, fraction.min(outcome.fraction - 1e-9));
        assert!(excess_n <= 1e-3, "{excess_n} N too much at {fraction} of {outcome:?}");
    }
    match outcome.end {
        End::Collision { .. } => {
            assert!(worst_excess_n(&all, outcome.fraction + 1e-6) > 0.0, "{outcome:?}");
            Some(true)
        }
        End::Reached => Some(false),
        End::Force | End::GivenUp => panic!("a motion without a limit was stopped by one"),
    }
}

#[test]
fn joint_moves_stop_where_brute_force_finds_the_first_collision() {
    let world = world();
    let (mut hits, mut free) = (0, 0);
    for number in 0..24 {
        let from = random_joints(2 * number);
        let to = Goal::Joints(random_joints(2 * number + 1));
        let route = route(&world, &from, to, Path::Joint).unwrap();
        match compare(&world, &route) {
            Some(true) => hits += 1,
            Some(false) => free += 1,
            None => {}
        }
    }
    assert!(hits > 2 && free > 2, "{hits} hits, {free} free");
}

#[test]
fn lines_stop_where_brute_force_finds_the_first_collision() {
    let world = world();
    let (mut hits, mut free) = (0, 0);
    for number in 0..30 {
        let from = random_joints(1_000 + number);
        let axis = |axis| unit(32, Stream::Dice, number * 3 + axis) - 0.5;
        let by_m = [axis(0), axis(1), axis(2) - 0.2];
        let to = Goal::Offset { from, by_m, frame: obverse_geometry::Frame::Base };
        let Some(route) = route(&world, &from, to, Path::Linear) else { continue };
        match compare(&world, &route) {
            Some(true) => hits += 1,
            Some(false) => free += 1,
            None => {}
        }
    }
    assert!(hits > 2 && free > 2, "{hits} hits, {free} free");
}
