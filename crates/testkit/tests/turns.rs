//! Whose turn it is: the order in which the branches of a fork command the workcell, and who is
//! held while an error is pending.

use obverse_bytecode::{Verified, assemble, verify};
use obverse_testkit::logged::{Command, Logged};
use obverse_vm::{Direction, Limits, Machine, Stop};

fn program(body: &str) -> Verified {
    let text = format!(
        "obvasm 1\n.error jam recoverable\n.function main start\n.local n int\nenter\n{body}\nhalt"
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
