//! Whose turn it is: the order in which the branches of a fork command the workcell, who is held
//! while an error is pending, and how long what tasks wait for takes together.

use obverse_bytecode::{Verified, assemble, verify};
use obverse_testkit::logged::{Command, Logged};
use obverse_vm::{Direction, Limits, Machine, Stop};
use obverse_workcell::{Clock, Safety};

fn program(body: &str) -> Verified {
    let text = format!(
        "obvasm 1\n.error jam recoverable\n.joints away 1.1 -0.2 0.3 -0.4 0.5 -0.6\n\
         .function main start\n.local n int\nenter\n{body}\nhalt"
    );
    let module = assemble(&text).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"));
    verify(module).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"))
}

/// An output that is set at once.
fn set(bit: u16) -> String {
    format!("push.const 0.0\noutput.set {bit}, high\n")
}

/// The outputs that were commanded on the way to where a run stops, and why it stops.
fn outputs(machine: &mut Machine<'_>, cell: &mut Logged, direction: Direction) -> (Vec<u16>, Stop) {
    cell.log.clear();
    let stop = machine.run(direction, Limits::NONE, cell, &mut ());
    let bit = |command: &Command| match command {
        Command::Output(bit, _) => Some(*bit),
        _ => None,
    };
    (cell.log.iter().filter_map(bit).collect(), stop)
}

#[test]
fn branches_act_in_turns_and_go_back_in_the_opposite_order() {
    let three = format!(
        "f: fork j\n{}{}{}fork.next\n{}fork.next\n{}{}j: fork.join f",
        set(0),
        set(1),
        set(2),
        set(3),
        set(4),
        set(5)
    );
    let program = program(&three);
    let mut cell = Logged::new(1);
    let mut machine = Machine::new(&program, &cell).expect("it links");
    let (forward, stop) = outputs(&mut machine, &mut cell, Direction::Forward);
    assert_eq!((&forward[..], stop), (&[0, 3, 4, 1, 5, 2][..], Stop::Finished));
    let (mut back, stop) = outputs(&mut machine, &mut cell, Direction::Reverse);
    back.reverse();
    assert_eq!((back, stop), (forward, Stop::AtStart));
}

#[test]
fn while_an_error_is_pending_the_others_are_held() {
    let clearing = format!("error.raise jam\n{}{}error.clear jam\n{}", set(0), set(1), set(2));
    let both = format!("f: fork j\n{clearing}fork.next\n{}{}j: fork.join f", set(3), set(4));
    let program = program(&both);
    let mut cell = Logged::new(1);
    let mut machine = Machine::new(&program, &cell).expect("it links");
    let (before, stop) = outputs(&mut machine, &mut cell, Direction::Forward);
    assert!(
        before.is_empty() && matches!(stop, Stop::Raised { .. } | Stop::Due { .. }),
        "{before:?}, {stop:?}"
    );
    let (after, stop) = outputs(&mut machine, &mut cell, Direction::Forward);
    assert_eq!((&after[..], stop), (&[0, 1, 2, 3, 4][..], Stop::Finished));
}

#[test]
fn a_fork_in_a_branch_holds_the_other_until_it_is_done() {
    let inner = format!("g: fork k\n{}fork.next\n{}{}k: fork.join g\n", set(0), set(1), set(2));
    let outer =
        format!("f: fork j\n{inner}{}fork.next\n{}{}j: fork.join f", set(3), set(4), set(5));
    let program = program(&outer);
    let mut cell = Logged::new(1);
    let mut machine = Machine::new(&program, &cell).expect("it links");
    let (forward, stop) = outputs(&mut machine, &mut cell, Direction::Forward);
    assert_eq!((&forward[..], stop), (&[0, 1, 2, 3, 4, 5][..], Stop::Finished));
}

/// A wait of so many seconds.
fn wait(duration_s: f64) -> String {
    format!("push.const {duration_s:?}\nwait\n")
}

/// An output that settles for so many seconds.
fn settle(bit: u16, settle_s: f64) -> String {
    format!("push.const {settle_s:?}\noutput.set {bit}, high\n")
}

/// A motion: every one takes this workcell a second.
const MOVE: &str = "push.joints away\nmove.joint\n";

/// The way out of a fork.
const LEAVE: &str = "push.bool true\nstay: jump.unless on\nfork.leave end\non: land stay\n";

fn fork(begin: &str, end: &str, branches: &[String]) -> String {
    let branches = branches.join("fork.next\n");
    format!("{begin}: fork {end}\n{branches}{end}: fork.join {begin}\n")
}

/// How many seconds a body takes forward and back, and what is commanded on the way there.
fn times(body: &str) -> ([f64; 2], String) {
    let program = program(body);
    let mut cell = Logged::new(1);
    let mut machine = Machine::new(&program, &cell).expect("it links");
    let there = machine.run(Direction::Forward, Limits::NONE, &mut cell, &mut ());
    assert_eq!(there, Stop::Finished, "{body}");
    let (forward_s, told) = (cell.now_s(), told(&cell.log));
    let back = machine.run(Direction::Reverse, Limits::NONE, &mut cell, &mut ());
    assert_eq!(back, Stop::AtStart, "{body}");
    ([forward_s, cell.now_s() - forward_s], told)
}

/// Commands, in short.
fn told(log: &[Command]) -> String {
    let short = |command: &Command| match command {
        Command::Execute(_) => "move".to_owned(),
        Command::Output(bit, _) => bit.to_string(),
        Command::Wait(duration_s) => format!("wait {duration_s}"),
    };
    log.iter().map(short).collect::<Vec<_>>().join(", ")
}

/// What one branch waits for, the others use; going back, each settling is waited for by itself.
#[test]
fn waits_overlap() {
    let two_moves = MOVE.repeat(2);
    let inner = fork("g", "k", &[wait(1.0), wait(1.5)]);
    let beside_moves: String = (1..4).map(|bit| settle(bit, 0.5)).collect();
    let cases = [
        (vec![wait(2.0), settle(1, 1.0)], [2.0, 1.0]),
        // Two seconds of moving are two seconds with what settles meanwhile, not three.
        (vec![settle(1, 1.0), two_moves.clone()], [2.0, 3.0]),
        (vec![two_moves.clone(), settle(1, 1.0)], [2.0, 3.0]),
        (vec![two_moves, settle(1, 2.5)], [2.5, 4.5]),
        (vec![settle(1, 1.0), MOVE.to_owned(), settle(2, 1.0)], [1.0, 3.0]),
        (vec![wait(0.25) + &wait(0.5), wait(1.0)], [1.0, 0.0]),
        (vec![wait(3.0), set(1)], [3.0, 0.0]),
        (vec![MOVE.repeat(3), beside_moves], [3.0, 4.5]),
        // What a fork in a branch takes is time of the other branch.
        (vec![wait(2.0), inner + &wait(0.0)], [2.0, 0.0]),
    ];
    for (branches, expected) in cases {
        assert_eq!(times(&fork("f", "j", &branches)).0, expected, "{branches:#?}");
    }
}

/// Outside forks, in the last branch that goes on, and in what is done in one turn, a wait is
/// commanded where it is written.
#[test]
fn who_is_alone_waits_at_once() {
    let block = format!("b: block.begin\n{}{}block.skip b\n", wait(1.0), set(1));
    let last = set(3) + &settle(4, 0.5) + &set(1);
    for (body, commands) in [
        (wait(1.0) + &set(1), "wait 1, 1"),
        (fork("f", "j", &[set(2), last]), "2, 3, 4, wait 0.5, 1"),
        (fork("f", "j", &[block, settle(2, 0.5)]), "wait 1, 1, 2, wait 0.5"),
    ] {
        assert_eq!(times(&body).1, commands, "{body}");
    }
}

/// The workcell waits until the first task is ready, and that one goes on.
#[test]
fn the_shortest_remainder_is_waited_for() {
    let branches = [wait(0.5) + &set(1), wait(0.25) + &set(2) + &wait(1.0), set(3)];
    let commands = "3, wait 0.25, 2, wait 0.25, 1, wait 0.75";
    assert_eq!(times(&fork("f", "j", &branches)).1, commands);
}

/// What the others commanded has settled when one of them leaves the fork.
#[test]
fn who_leaves_a_fork_waits_for_the_others() {
    let leaving = fork("f", "end", &[settle(1, 1.0) + &set(4), set(2) + LEAVE]);
    let (times_s, commands) = times(&(leaving + &set(3)));
    assert_eq!(commands, "1, 2, wait 1, 3");
    assert_eq!(times_s, [1.0, 1.0]);
}

/// A run that is stopped in the midst of a common wait goes on from there, and back from there: in
/// an act, at the end of a branch, and where a fork is left.
#[test]
fn a_common_wait_can_be_stopped() {
    for branches in [
        [wait(0.5) + &set(1), wait(0.25)],
        [settle(1, 0.5), set(2)],
        [settle(1, 0.5) + &set(4), set(2) + LEAVE],
    ] {
        let body = fork("f", "end", &branches);
        let program = program(&body);
        let mut stopped = 0;
        for act in 0.. {
            let mut stops = 0;
            for direction in [Direction::Forward, Direction::Reverse] {
                let mut cell = Logged::new(1);
                cell.ledger = cell.ledger.stopping_at(act, 0.5);
                let mut machine = Machine::new(&program, &cell).expect("it links");
                let start = machine.digest(&cell);
                match machine.run(Direction::Forward, Limits::NONE, &mut cell, &mut ()) {
                    Stop::Fault { .. } => stops += 1,
                    stop => assert_eq!(stop, Stop::Finished),
                }
                cell.release();
                cell.ledger.stop_at = None;
                machine.run(direction, Limits::NONE, &mut cell, &mut ());
                machine.run(Direction::Reverse, Limits::NONE, &mut cell, &mut ());
                assert_eq!(machine.digest(&cell), start, "act {act} of {body}");
            }
            stopped += stops;
            if stops == 0 {
                break;
            }
        }
        assert!(stopped >= 6, "{stopped} stops of {body}");
    }
}
