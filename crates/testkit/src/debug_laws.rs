//! The laws of the debugger over generated programs: a recording shows every state of its run, bit
//! for bit, whichever way one comes to it; and whoever only looks commands nothing.

use crate::Ledger;
use crate::code::{self, Options as CodeOptions};
use crate::programs::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{Verified, verify};
use obverse_compiler::compile;
use obverse_debugger::drive::Pace;
use obverse_debugger::recording::{Moment, Order};
use obverse_debugger::rewound::Halted;
use obverse_debugger::{
    Breakpoint, Expression, Grain, Halt, Places, Run, Session, Subject, Value, Walk, What,
};
use obverse_isa::{ErrorId, GlobalId, LocalId};
use obverse_recovery::{Step, Teller};
use obverse_vm::{Alteration, Direction, Event, Observer, Stop};
use obverse_workcell::Workcell;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The longest run, in instructions.
const MAX_TICKS: u64 = 4_000;

/// Some program: of random instructions, or of the language, with forks.
fn program(u: &mut Unstructured<'_>) -> Result<Verified> {
    let module = if u.ratio(1, 2)? {
        code::module(u, CodeOptions { never: true, blocks: true })?
    } else {
        let source = programs::generate(u, Options::default())?;
        match compile("program.obv", &source).module {
            Some(module) => module,
            None => panic!("it does not compile\n{source}"),
        }
    };
    match verify(module) {
        Ok(program) => Ok(program),
        Err(errors) => panic!("the generator made a module that does not verify: {errors:?}"),
    }
}

/// Something that a driver does.
#[derive(Clone, Copy, Debug)]
enum Does {
    Drives(Order, u64),
    Releases,
}

fn deeds(u: &mut Unstructured<'_>) -> Result<Vec<Does>> {
    let mut deeds = Vec::new();
    for _ in 0..u.int_in_range(1..=12_u8)? {
        let most = u64::from(u.int_in_range(1..=400_u16)?);
        deeds.push(match u.int_in_range(0..=9_u8)? {
            0..=4 => Does::Drives(Order::Forward, 3 * most),
            5 | 6 => Does::Drives(Order::Reverse, most),
            7 => Does::Drives(Order::Unwind, most / 8),
            8 => {
                let alteration = Alteration { slower: 1, ..Alteration::default() };
                Does::Drives(Order::Alter(u.ratio(1, 2)?.then_some(alteration)), 1)
            }
            _ => Does::Releases,
        });
    }
    Ok(deeds)
}

/// A run that was driven by these deeds, at once or step by step, with the digests of the moments
/// at which it was looked at.
fn driven<'p>(
    program: &'p Verified,
    cell: Ledger,
    deeds: &[Does],
    by_steps: bool,
) -> Option<(Run<'p, Ledger>, BTreeMap<Moment, u64>)> {
    let mut run = Run::new(program, cell).ok()?;
    let mut digests = BTreeMap::new();
    for deed in deeds {
        let Does::Drives(order, most) = *deed else {
            run.release();
            continue;
        };
        let until = run.recording().end.after(most);
        while run.recording().end < until {
            let left = until.0 - run.recording().end.0;
            let pace = if by_steps { Pace::Step } else { Pace::Run(left) };
            let done = run.drive(order, pace, &mut ())?;
            if let Some(cell) = run.cell() {
                let digest = run.machine().digest(cell);
                let before = digests.insert(run.recording().end, digest);
                let is_one = before.is_none_or(|before| before == digest);
                assert!(is_one, "{} has two states: {order:?}, {done:?}", run.recording().end);
            }
            let is_over = !matches!(done.stop, None | Some(Stop::Raised { .. } | Stop::Due { .. }));
            if is_over || done.ticks == 0 {
                break;
            }
        }
        if run.recording().end.0 > MAX_TICKS {
            break;
        }
    }
    Some((run, digests))
}

/// Every moment that a recording shows is as it was in the run, whichever is shown before, and
/// though the run was driven at once and is shown step by step, or the other way round. The
/// workcell is as it was left.
///
/// # Errors
/// Those of the randomness.
pub fn shows_what_was(u: &mut Unstructured<'_>) -> Result<bool> {
    let (deeds, by_steps) = (deeds(u)?, u.ratio(1, 2)?);
    let fraction = f64::from(u.int_in_range(0_u8..=10)?) / 10.0;
    let mut cell = Ledger::new(u.arbitrary()?).stopping_at(u.int_in_range(0..=60)?, fraction);
    cell.comes_at = Some((u.int_in_range(0..=20)?, 0.5));
    let program = program(u)?;
    let Some((run, digests)) = driven(&program, cell, &deeds, by_steps) else { return Ok(false) };
    let acts = run.cell().map(|cell| cell.acts);
    let moments: Vec<Moment> = digests.keys().copied().collect();
    let mut shown = run.rewound();
    for number in 0..moments.len().min(40) {
        let moment = moments[number * 7919 % moments.len()];
        shown.go_to(run.recording(), run.timeline(), moment);
        let what = format!("{deeds:?}, by steps: {by_steps}");
        assert_eq!(shown.moment(), moment, "{what}");
        assert_eq!(Some(&shown.digest(run.recording())), digests.get(&moment), "{moment} {what}");
    }
    assert_eq!(run.cell().map(|cell| cell.acts), acts, "whoever looks commands nothing");
    Ok(moments.len() > 1)
}

/// What a recording shows at a moment, found by going through all of it.
struct Shown {
    moment: Moment,
    digest: u64,
    value: Value,
    pc: u32,
    depth: usize,
    is_plain: bool,
}

/// Every moment of a run.
fn all_of(run: &Run<'_, Ledger>, expression: &Expression) -> Vec<Shown> {
    let mut shown = run.rewound();
    shown.go_to(run.recording(), run.timeline(), Moment(0));
    let mut all = Vec::new();
    loop {
        let state = shown.machine().state();
        all.push(Shown {
            moment: shown.moment(),
            digest: shown.digest(run.recording()),
            value: shown.look(run.recording(), |look| expression.value(look)),
            pc: state.pc(),
            depth: state.frames().len(),
            is_plain: state.pending().is_none(),
        });
        match shown.walk_on(run.recording(), run.recording().end, None) {
            Halted::There if all.last().is_some_and(|last| last.moment == shown.moment()) => {
                return all;
            }
            Halted::Lost => panic!("the recording does not fit its own run"),
            _ if shown.moment() > run.recording().end => return all,
            _ => {}
        }
    }
}

/// Something to ask about that occurs in a program: of one thing, or of what it is at a count of
/// steps.
fn expression(u: &mut Unstructured<'_>, program: &Verified) -> Result<Expression> {
    let module = program.module();
    let one = subject(u, program)?;
    let name = one.name(module);
    let of = match one {
        Subject::Local(function, _) | Subject::Counter(function, _) => usize::from(function),
        _ => 0,
    };
    let (steps, value) = (u.int_in_range(0..=900_u16)?, u.int_in_range(-2..=9_i8)?);
    let text = match u.int_in_range(0..=7_u8)? {
        0 => format!("steps > {steps}"),
        1 => format!("{name} == {value} or steps * 3 - 7 < {steps}"),
        2 => format!("{name} != {value} and not (steps <= {steps} + {value})"),
        3 => format!("{name} == {value}"),
        4 => format!("steps / 7 == {name}"),
        _ => return Ok(Expression::of(module, one)),
    };
    Ok(Expression::parse(module, of, &text).unwrap_or_else(|_| Expression::of(module, one)))
}

fn subject(u: &mut Unstructured<'_>, program: &Verified) -> Result<Subject> {
    let module = program.module();
    let mut subjects = vec![Subject::Output(u.int_in_range(0..=3)?), Subject::Joint(1)];
    subjects.extend((0..module.globals.len()).map(|at| Subject::Global(GlobalId(at as u16))));
    for (index, function) in module.functions.iter().enumerate() {
        let locals = 0..function.locals.len() as u8;
        subjects.extend(locals.map(|local| Subject::Local(index as u16, LocalId(local))));
    }
    for (index, around) in module.loops.iter().enumerate() {
        let function = module.function_at(around.enter).unwrap_or_default();
        subjects.push(Subject::Counter(function as u16, index as u16));
    }
    subjects.extend((0..module.errors.len()).map(|at| Subject::Error(ErrorId(at as u16))));
    Ok(u.choose(&subjects)?.clone())
}

/// Any commands of a session lead to the moments that they are to lead to, found by going through
/// all of the recording; and at each the state is as it was. Rewound nothing is commanded, and
/// nobody is told anything.
///
/// # Errors
/// Those of the randomness.
pub fn moves_lead_where_they_say(u: &mut Unstructured<'_>) -> Result<bool> {
    let deeds = deeds(u)?;
    let choices: [u8; 12] = u.arbitrary()?;
    let cell = Ledger::new(u.arbitrary()?).stopping_at(u.int_in_range(0..=60)?, 0.5);
    let program = program(u)?;
    let Some((run, _)) = driven(&program, cell, &deeds, false) else { return Ok(false) };
    let expression = expression(u, &program)?;
    let all = all_of(&run, &expression);
    let end = run.recording().end;
    let acts = run.cell().map(|cell| cell.acts);
    let told = Arc::new(AtomicU64::new(0));
    let mut session = Session::over(run);
    session.tell_to(Box::new(Told(told.clone())));
    let at = u.choose(&all)?.pc;
    if let Ok(places) = Places::of_instruction(program.module(), at) {
        session.add_breakpoint(Breakpoint::at(places));
    }
    session.add_breakpoint(Breakpoint::on_change(expression.clone()));
    let mut now = *u.choose(&all.iter().map(|shown| shown.moment).collect::<Vec<_>>())?;
    assert_eq!(session.go_to(now), Ok(()));
    for choice in choices.map(|choice| choice % 8) {
        let expected = expected(choice, now, &all, &session, end);
        let hits = carry_out(choice, &mut session, &expression);
        let found = session.moment();
        let what = || format!("choice {choice} from {now}, {}, {deeds:?}", expression.text());
        if let Some(expected) = expected {
            assert_eq!(found, expected, "{}", what());
        }
        let was = all.iter().find(|shown| shown.moment == found);
        if let (2 | 3, Some(hits)) = (choice, hits) {
            assert_eq!(hits, all_hits(found, &all, &session), "{}", what());
        }
        assert_eq!(Some(session.digest()), was.map(|was| was.digest), "{}", what());
        now = found;
    }
    assert_eq!(session.run().cell().map(|cell| cell.acts), acts, "nothing is commanded");
    assert_eq!(told.load(Ordering::Relaxed), 0, "nobody is told");
    session.go_to_end();
    assert_eq!(Some(session.digest()), all.last().map(|last| last.digest));
    Ok(all.len() > 20)
}

/// The breakpoints at which that ended, if it ended at some.
fn carry_out(
    choice: u8,
    session: &mut Session<'_, Ledger>,
    expression: &Expression,
) -> Option<Vec<u32>> {
    use Direction::{Forward, Reverse};
    let halt = match choice {
        0 => session.go(Forward, Walk::Step(Grain::Instruction)),
        1 => session.go(Reverse, Walk::Step(Grain::Instruction)),
        2 => session.go(Forward, Walk::Continue),
        3 => session.go(Reverse, Walk::Continue),
        4 => {
            let _none_is_fine = session.go_to_last_change(expression);
            return None;
        }
        5 => session.go(Reverse, Walk::Next(Grain::Instruction)),
        6 => session.go(Forward, Walk::Finish),
        _ => session.go(Reverse, Walk::Step(Grain::Statement)),
    };
    match halt {
        Halt::Hits(hits) => Some(hits.iter().map(|hit| hit.id).collect()),
        _ => None,
    }
}

/// Every breakpoint that a run comes to at a moment, whichever way and from wherever.
fn all_hits(moment: Moment, all: &[Shown], session: &Session<'_, Ledger>) -> Vec<u32> {
    let Some(at) = all.iter().position(|shown| shown.moment == moment) else { return Vec::new() };
    let is_hit = |breakpoint: &Breakpoint| match &breakpoint.what {
        What::Places { pcs, .. } => pcs.contains(&all[at].pc) && all[at].is_plain,
        What::Change(_) => at > 0 && all[at - 1].value != all[at].value,
    };
    session.breakpoints().iter().filter(|it| is_hit(it)).map(|it| it.id).collect()
}

/// Where a command is to lead, if that is said here.
fn expected(
    choice: u8,
    now: Moment,
    all: &[Shown],
    session: &Session<'_, Ledger>,
    end: Moment,
) -> Option<Moment> {
    let here = all.iter().position(|shown| shown.moment == now)?;
    let depth = all[here].depth;
    let breakpoint = session.breakpoints().iter().find_map(|it| match &it.what {
        What::Places { pcs, .. } => Some(pcs.clone()),
        What::Change(_) => None,
    });
    let stops = |at: &usize| {
        let shown = &all[*at];
        let is_place = breakpoint.as_ref().is_some_and(|pcs| pcs.contains(&shown.pc));
        let is_change = *at > 0 && all[at - 1].value != shown.value;
        is_place && shown.is_plain || is_change
    };
    let moment = |at: Option<usize>| at.map(|at| all[at].moment);
    match choice {
        0 => moment((here + 1 < all.len()).then_some(here + 1)).or(Some(end)),
        1 => moment(here.checked_sub(1)).or(Some(Moment(0))),
        2 => moment((here + 1..all.len()).find(stops)).or(Some(end)),
        3 => moment((0..here).rev().find(stops)).or(Some(Moment(0))),
        4 => {
            let changes = |at: &usize| all[*at].value != all[at + 1].value;
            moment((0..here).rev().find(changes)).or(Some(now))
        }
        5 => {
            let is_there = |at: &usize| all[*at].depth <= depth || stops(at);
            moment((0..here).rev().find(is_there)).or(Some(Moment(0)))
        }
        _ => None,
    }
}

/// Counts what it is told.
struct Told(Arc<AtomicU64>);

impl Observer for Told {
    fn on_event(&mut self, _: &Event, _: &dyn Workcell) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

impl Teller for Told {
    fn on_step(&mut self, _: &Step<'_>, _: &dyn Workcell) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}
