//! A motion that was made aside goes back the way that it came: along its direction to where it
//! began, and then to where the program had it begin; also when it was stopped anywhere on the way.

use obverse_compiler::compile;
use obverse_geometry::JointConfiguration;
use obverse_testkit::logged::{Command, Logged};
use obverse_vm::{Alteration, Aside, Direction, Event, Limits, Machine, Mark, Observer, Stop};
use obverse_workcell::{Arm, Clock, Goal, Safety, Workcell};

const SOURCES: [&str; 3] = [
    "sequence main { move 40 mm forward wait 1 s }",
    "sequence main { move 40 mm left in base wait 1 s }",
    "sequence main { turn 90 deg advancing 2 mm forward in tcp wait 1 s }",
];
const ASIDE_M: [f64; 2] = [1e-3, -2e-3];

/// A machine before its motion, which is going to be made aside, and the workcell.
fn before(source: &str, run: impl FnOnce(&mut Machine<'_>, &mut Logged)) {
    let module = compile("program.obv", source).module.expect("a program");
    let program = obverse_bytecode::verify(module).expect("a module");
    let mut cell = Logged::new(1).steady();
    let mut machine = Machine::new(&program, &cell).expect("it links");
    let is_motion = |pc: &u32| program.module().code[*pc as usize].info().mnemonic.contains("move");
    let pc = (0..program.module().code.len() as u32).find(is_motion).expect("a motion");
    machine.alter(Some(Alteration {
        aside: Some(Aside { pc, by_m: ASIDE_M }),
        ..Alteration::default()
    }));
    run(&mut machine, &mut cell);
}

/// Where the arm was led, command by command.
fn goals(log: &[Command]) -> Vec<Goal> {
    let goal = |command: &Command| match command {
        Command::Execute(motion) => Some(motion.goal),
        _ => None,
    };
    log.iter().filter_map(goal).collect()
}

fn to_the_end(machine: &mut Machine<'_>, cell: &mut Logged) {
    let stop = machine.run(Direction::Forward, Limits::NONE, cell, &mut ());
    assert_eq!(stop, Stop::Finished);
}

#[test]
fn it_goes_back_by_where_it_began() {
    for source in SOURCES {
        before(source, |machine, cell| {
            let (start, digest) = (cell.joints(), machine.digest(cell));
            to_the_end(machine, cell);
            let there = goals(&cell.log);
            let [Goal::Offset { from, by_m, .. }, Goal::Displaced { .. } | Goal::Turned { .. }] =
                &there[..]
            else {
                panic!("{source}: {there:?}")
            };
            assert_eq!(
                (*from, by_m.iter().filter(|by| **by != 0.0).count()),
                (start, 2),
                "{source}"
            );
            let (Goal::Displaced { from: began, .. } | Goal::Turned { from: began, .. }) =
                &there[1]
            else {
                panic!("{source}")
            };
            assert_ne!(*began, start, "{source}: it began aside");
            cell.log.clear();
            machine.alter(None);
            let stop = machine.run(Direction::Reverse, Limits::NONE, cell, &mut ());
            assert_eq!(stop, Stop::AtStart, "{source}");
            let back = goals(&cell.log);
            let by = match &back[0] {
                Goal::Joints(joints) => *joints,
                Goal::Turned { from, angle_rad: 0.0, advance_m: 0.0, .. } => *from,
                other => panic!("{source}: {other:?}"),
            };
            assert_eq!((by, &back[1..]), (*began, &[Goal::Joints(start)][..]), "{source}");
            assert_eq!(machine.digest(cell), digest, "{source}");
        });
    }
}

#[test]
fn passed_over_it_leaves_nothing_behind() {
    before(SOURCES[0], |machine, cell| {
        let bits = machine.tape().expect("a tape").place();
        to_the_end(machine, cell);
        assert_eq!(machine.unwind_to(Mark::at(1), cell), Ok(()));
        assert_eq!(machine.tape().expect("a tape").place(), bits);
    });
}

/// Adds up how long the motions took that are told.
struct Durations(f64);

impl Observer for Durations {
    fn on_event(&mut self, event: &Event, _: &dyn Workcell) {
        self.0 += event.report.map_or(0.0, |report| report.duration_s);
    }
}

#[test]
fn what_is_told_of_it_is_how_long_both_of_its_ways_took() {
    before("sequence main { move 40 mm forward }", |machine, cell| {
        for direction in [Direction::Forward, Direction::Reverse] {
            let (began_s, mut told) = (cell.now_s(), Durations(0.0));
            machine.run(direction, Limits::NONE, cell, &mut told);
            machine.alter(None);
            let took_s = cell.now_s() - began_s;
            assert!(took_s > 0.0 && (told.0 - took_s).abs() < 1e-9, "{} of {took_s} s", told.0);
        }
    });
}

/// Stopped at each of its acts, so far into it, in either direction.
#[test]
fn stopped_anywhere_it_goes_on_to_the_same_end_or_back_to_the_start() {
    for (act, fraction) in (0..6).flat_map(|act| [0.0, 0.4, 1.0].map(|fraction| (act, fraction))) {
        before(SOURCES[0], |machine, cell| {
            let (start, digest) = (cell.joints(), machine.digest(cell));
            cell.ledger.stop_at = Some((act, fraction));
            let mut stops = 0;
            for direction in [Direction::Forward, Direction::Reverse, Direction::Forward] {
                loop {
                    match machine.run(direction, Limits::NONE, cell, &mut ()) {
                        Stop::Fault { .. } => cell.release(),
                        Stop::Finished | Stop::AtStart => break,
                        other => panic!("act {act} at {fraction}: {other:?}"),
                    }
                    stops += 1;
                    assert!(stops < 3, "act {act} at {fraction}");
                }
            }
            let end = cell.joints();
            machine.alter(None);
            let stop = machine.run(Direction::Reverse, Limits::NONE, cell, &mut ());
            assert_eq!(stop, Stop::AtStart, "act {act} at {fraction}");
            assert_eq!(machine.digest(cell), digest, "act {act} at {fraction}");
            let far = |joints: &JointConfiguration| joints.largest_difference_rad(&start);
            assert!(far(&end) > 0.03 && far(&cell.joints()) == 0.0, "act {act} at {fraction}");
        });
    }
}
