//! Each kind of seat against what it is meant to feel like.

use super::*;

const GIVE: f64 = 50_000.0;
const AROUND: Around = Around { give_n_per_m: GIVE, throat_m: 1.5e-3, bottom_m: 20e-3 };
const SNAP: Snap = Snap { at_m: 10e-3, travel_m: 2e-3, peak_n: 15.0, hold_n: 25.0 };
const PRESS: Press = Press { force_n_per_m: 4_000.0, hold_n: 30.0 };
const THREAD: Thread = Thread {
    at_m: 2e-3,
    pitch_m: 1e-3,
    turns_rad: 4.0 * TAU,
    catch_m: 0.3e-3,
    catch_rad: 0.02,
    cross_rad: 0.25 * TAU,
    tighten_n_per_rad: 100.0,
    give_n_per_m: None,
};

/// An item that was at a depth, in millimetres, and is held at another.
fn moved(seat: Seat, from_mm: f64, to_mm: f64) -> Seated {
    let start = Start { depth_m: from_mm * 1e-3, turned_rad: 0.0, crossed: false };
    seat.seated(&AROUND, &start, &Hand { depth_m: to_mm * 1e-3, turned_rad: 0.0 })
}

/// On the beginning of a thread, pressed by 0.1 mm, turned so often, the hand following the pitch.
fn turned(thread: Thread, turns: f64, crossed: bool) -> Seated {
    let start = Start { depth_m: 2.1e-3, turned_rad: 0.0, crossed };
    let depth_m = 2.1e-3 + thread.pitch_m * turns;
    Seat::Thread(thread).seated(&AROUND, &start, &Hand { depth_m, turned_rad: turns * TAU })
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
}

#[test]
fn a_snap_rises_to_its_peak_drops_and_stays_in() {
    let snap = Seat::Snap(SNAP);
    assert_eq!(moved(snap, 0.0, 7.9).axial_n, 0.0);
    let forces: Vec<f64> =
        (0..=23).map(|step| moved(snap, 0.0, 8.0 + 0.1 * f64::from(step)).axial_n).collect();
    assert!(forces.windows(2).all(|pair| pair[0] < pair[1]), "{forces:?}");
    // At the top the lip is at 10 mm and the hand 15 N of give further.
    near(moved(snap, 0.0, 10.3 - 1e-9).axial_n, 15.0);
    assert_eq!(moved(snap, 0.0, 10.3 + 1e-6).axial_n, 0.0);
    assert_eq!(moved(snap, 0.0, 12.0), Seated { depth_m: 12e-3, ..moved(snap, 12.0, 12.0) });
}

#[test]
fn a_snapped_item_comes_out_beyond_the_pull_that_holds_it() {
    let snap = Seat::Snap(SNAP);
    assert_eq!(moved(snap, 12.0, 10.5).axial_n, 0.0);
    let pulled = moved(snap, 12.0, 9.6);
    near(pulled.axial_n, -20.0);
    near(pulled.depth_m, 10e-3);
    // However often it is pulled below that.
    near(moved(snap, pulled.depth_m * 1e3, 9.51).depth_m, 10e-3);
    assert_eq!(moved(snap, 10.0, 9.49), Seated { depth_m: 9.49e-3, ..moved(snap, 0.0, 1.0) });
}

#[test]
fn a_snap_that_was_not_reached_lets_the_item_go_back() {
    let pushed = moved(Seat::Snap(SNAP), 0.0, 9.5);
    assert!(pushed.axial_n > 5.0 && pushed.depth_m < SNAP.at_m);
    assert_eq!(moved(Seat::Snap(SNAP), pushed.depth_m * 1e3, 7.0).axial_n, 0.0);
}

#[test]
fn a_press_takes_force_in_proportion_to_the_depth() {
    let press = Seat::Press(PRESS);
    assert_eq!(moved(press, 0.0, 1.5).axial_n, 0.0);
    for mm in [3.0, 6.0, 11.5] {
        let pressed = moved(press, 0.0, mm);
        // What the hand gives way by, the item has not gone.
        near(pressed.axial_n, PRESS.force_n_per_m * (pressed.depth_m - 1.5e-3));
        near(pressed.axial_n, GIVE * (mm * 1e-3 - pressed.depth_m));
    }
}

#[test]
fn a_pressed_item_never_comes_out_below_its_pull() {
    let press = Seat::Press(PRESS);
    let mut depth_mm = moved(press, 0.0, 10.0).depth_m * 1e3;
    let inserted_mm = depth_mm;
    for _ in 0..100 {
        // A pull of 29.9 N, and back.
        depth_mm = moved(press, depth_mm, depth_mm - 0.598).depth_m * 1e3;
        depth_mm = moved(press, depth_mm, depth_mm).depth_m * 1e3;
    }
    near(depth_mm, inserted_mm);
    // Beyond that it slides, and holds with as much wherever it is, until it is out.
    let sliding = moved(press, depth_mm, 5.0);
    near(sliding.axial_n, -30.0);
    near(sliding.depth_m, 5.6e-3);
    assert_eq!(moved(press, depth_mm, 0.8).axial_n, 0.0);
}

#[test]
fn where_a_press_was_left_it_takes_up_the_force_again() {
    let press = Seat::Press(PRESS);
    let first = moved(press, 0.0, 8.0);
    let at_mm = first.depth_m * 1e3;
    assert_eq!(moved(press, at_mm, at_mm).axial_n, 0.0);
    // In pieces as in one.
    near(moved(press, at_mm, 9.0).axial_n, moved(press, 0.0, 9.0).axial_n);
}

#[test]
fn the_bottom_ends_every_insertion() {
    for seat in [Seat::Snap(SNAP), Seat::Press(PRESS)] {
        let pushed = moved(seat, 0.0, 25.0);
        near(pushed.depth_m, AROUND.bottom_m);
        near(pushed.axial_n, GIVE * 5e-3);
    }
}

#[test]
fn without_a_turn_an_item_sits_on_the_thread() {
    let pushed = moved(Seat::Thread(THREAD), 0.0, 2.2);
    near(pushed.axial_n, GIVE * 0.2e-3);
    near(pushed.depth_m, THREAD.at_m);
    assert_eq!(moved(Seat::Thread(THREAD), 2.0, 1.0).axial_n, 0.0);
}

#[test]
fn a_thread_leads_by_its_pitch_and_is_tight_at_its_end() {
    for turns in [0.5, 1.0, 3.9] {
        let seated = turned(THREAD, turns, false);
        near(seated.depth_m, 2e-3 + turns * 1e-3);
        // The light press stays what it was.
        near(seated.axial_n, 5.0);
        assert_eq!(seated.twist_n, 0.0);
    }
    let tight = turned(THREAD, 4.1, false);
    near(tight.turned_rad, THREAD.turns_rad);
    near(tight.twist_n, 100.0 * 0.1 * TAU);
    near(tight.axial_n, 5.0 + GIVE * 0.1e-3);
}

#[test]
fn an_item_that_has_caught_across_is_tight_early() {
    assert!(THREAD.is_crossed(0.31e-3, 0.0) && THREAD.is_crossed(0.0, 0.021));
    assert!(!THREAD.is_crossed(0.29e-3, 0.019));
    assert_eq!(turned(THREAD, 0.2, true).twist_n, 0.0);
    let crossed = turned(THREAD, 0.5, true);
    near(crossed.depth_m, 2.25e-3);
    assert!(crossed.twist_n > 100.0 && crossed.axial_n > 15.0, "{crossed:?}");
}

#[test]
fn what_has_caught_is_held_until_it_is_turned_back() {
    let start = Start { depth_m: 4e-3, turned_rad: 2.0 * TAU, crossed: false };
    let hand = |depth_m, turns| Hand { depth_m, turned_rad: turns * TAU };
    let seat = Seat::Thread(THREAD);
    near(seat.seated(&AROUND, &start, &hand(3.5e-3, 0.0)).axial_n, -25.0);
    near(seat.seated(&AROUND, &start, &hand(3e-3, -1.0)).axial_n, 0.0);
    assert_eq!(seat.seated(&AROUND, &start, &hand(1e-3, -2.0)).axial_n, 0.0);
}

#[test]
fn a_bayonet_locks_without_going_deeper() {
    let bayonet = Thread { pitch_m: 0.0, turns_rad: 0.125 * TAU, ..THREAD };
    let locked = turned(bayonet, 0.125, false);
    near(locked.depth_m, bayonet.at_m);
    assert_eq!(locked.twist_n, 0.0);
    assert!(turned(bayonet, 0.2, false).twist_n > 10.0);
    let start = Start { depth_m: 2e-3, turned_rad: 0.125 * TAU, crossed: false };
    let pulled = Hand { depth_m: 1e-3, turned_rad: 0.0 };
    near(Seat::Thread(bayonet).seated(&AROUND, &start, &pulled).axial_n, -50.0);
}

#[test]
fn a_softer_tool_presses_more_lightly() {
    let soft = Thread { give_n_per_m: Some(2_000.0), ..THREAD };
    near(moved(Seat::Thread(soft), 0.0, 3.0).axial_n, 2.0);
}
