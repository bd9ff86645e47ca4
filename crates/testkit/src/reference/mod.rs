//! A second opinion: an interpreter that walks the syntax tree forward and keeps a copy of the
//! whole state before every statement.
//!
//! It shares nothing with the compiler and the machine but the syntax tree and the workcell, and is
//! written to be obviously right, not fast. It takes programs that the compiler accepts: names and
//! types are not checked again. It knows nothing of going back: the copies say what a machine that
//! goes back has to find again.

mod cleanup;
mod control;
mod error;
mod expression;
mod guarded;
mod motion;
mod names;
mod statement;
mod value;

use names::Names;
use obverse_geometry::JointConfiguration;
use obverse_syntax::ast::Program;
use obverse_syntax::span::Span;
use obverse_workcell::{Fault, MotionReport, Speed, Workcell};
use std::collections::BTreeMap;
use value::Value;

/// The most calls that may be under way, the start of the program among them.
pub const MAX_CALLS: usize = 1024;

/// When a run ends at the latest.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// After so many statements and rounds of loops.
    pub steps: u64,
    /// With so many calls under way, at most [`MAX_CALLS`]: the interpreter recurses.
    pub calls: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { steps: 100_000, calls: MAX_CALLS }
    }
}

/// What came of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// How it ended.
    pub ending: Ending,
    /// The state before every statement, in the order of the run.
    pub history: Vec<StateCopy>,
    /// The state at the end.
    pub last: StateCopy,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The program ended, perhaps with errors pending.
    Finished,
    /// The statement could not be done, and nothing of it was.
    Trap(Trap),
    /// The workcell did not do as commanded.
    Fault(Fault),
    /// A limit of the interpreter was met: nothing can be said.
    Limit,
}

/// Why a statement could not be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trap {
    /// An integer was divided by zero, or a real is no integer of 64 bits.
    Arithmetic,
    /// An assertion was wrong.
    Assertion,
    /// What an advanced move requires did not hold.
    Required,
    /// Too many calls were under way.
    CallDepth,
}

/// All that the program can observe or command, at one time. Values are the bits that a machine
/// keeps: integers, doubles, 0 and 1, places among the declarations.
#[derive(Clone, Debug, PartialEq)]
pub struct StateCopy {
    /// The statement that is about to be done; the whole program at the end.
    pub span: Span,
    /// The sequence, action, I/O operation or advanced move it is of.
    pub function: String,
    /// How many calls are under way, the start of the program among them.
    pub calls: usize,
    /// The variables of the program, in the order of their declarations.
    pub globals: Vec<(String, u64)>,
    /// The variables of the call that have been declared so far, by name.
    pub locals: BTreeMap<String, u64>,
    /// The counters of the loops around, outermost first. A loop that counts down keeps the
    /// complements of its numbers.
    pub counters: Vec<i64>,
    /// The positions that the call remembers, by name.
    pub positions: BTreeMap<String, [u64; 6]>,
    /// Speed and tool by identity, and what motions that go back have instead: the speed by
    /// identity, 5 for none; the force limit in newtons, infinite for none; whether straight.
    pub settings: [u64; 5],
    /// The errors that are pending, oldest first.
    pub raised: Vec<String>,
    /// How many random numbers have been drawn.
    pub draws: u64,
    /// Where the arm is.
    pub joints: [u64; 6],
    /// The levels of the outputs.
    pub outputs: Vec<bool>,
    /// What the gripper holds.
    pub held: Option<u16>,
}

/// Run a program from its start on a workcell.
///
/// The program must be one that the compiler accepts; with another, the outcome means nothing.
pub fn run(program: &Program<'_>, cell: &mut dyn Workcell, limits: Limits) -> Outcome {
    let mut interpreter = Interpreter::new(program, cell, limits);
    let ending = match interpreter.program() {
        Ok(()) => Ending::Finished,
        Err(Halt(ending)) => ending,
    };
    let last = interpreter.copy(Span::default());
    Outcome { ending, history: interpreter.history, last }
}

/// The run ends here.
struct Halt(Ending);

impl From<Trap> for Halt {
    fn from(trap: Trap) -> Self {
        Self(Ending::Trap(trap))
    }
}

impl From<Fault> for Halt {
    fn from(fault: Fault) -> Self {
        Self(Ending::Fault(fault))
    }
}

/// What something that may end the run comes to.
type Run<T> = Result<T, Halt>;

/// A call under way.
#[derive(Debug, Default)]
struct Frame<'p> {
    function: &'p str,
    locals: BTreeMap<&'p str, Value>,
    positions: BTreeMap<&'p str, JointConfiguration>,
    /// The loops that count around the statement in hand.
    counters: Vec<Counter<'p>>,
    /// How often its errors had the sequence begin again.
    rounds: u64,
}

/// What motions that go back have instead of what they had.
#[derive(Clone, Copy, Debug)]
struct GoingBack {
    speed: Option<Speed>,
    limit_n: f64,
    is_straight: bool,
}

/// A loop that counts.
#[derive(Debug)]
struct Counter<'p> {
    name: Option<&'p str>,
    count: i64,
    /// What a machine has in its place.
    kept: i64,
}

struct Interpreter<'p, 'c> {
    program: &'p Program<'p>,
    names: Names<'p>,
    cell: &'c mut dyn Workcell,
    limits: Limits,
    steps: u64,
    globals: Vec<(&'p str, Value)>,
    speed: Speed,
    tool: u16,
    going_back: GoingBack,
    raised: Vec<&'p str>,
    draws: u64,
    frames: Vec<Frame<'p>>,
    /// While it is judged whether an advanced move succeeded: what it came to.
    judged: Option<MotionReport>,
    /// Whether an error is being recovered from.
    is_recovering: bool,
    /// Whether an error wants the program to begin again.
    restarts: bool,
    history: Vec<StateCopy>,
}

impl<'p, 'c> Interpreter<'p, 'c> {
    fn new(program: &'p Program<'p>, cell: &'c mut dyn Workcell, limits: Limits) -> Self {
        let tool = cell.initial_tool().0;
        Self {
            program,
            names: Names::of(program),
            cell,
            limits,
            steps: 0,
            globals: Vec::new(),
            speed: Speed::Normal,
            tool,
            going_back: GoingBack { speed: None, limit_n: f64::INFINITY, is_straight: false },
            raised: Vec::new(),
            draws: 0,
            frames: vec![Frame::default()],
            judged: None,
            is_recovering: false,
            restarts: false,
            history: Vec::new(),
        }
    }

    /// Count a step.
    fn step(&mut self) -> Run<()> {
        self.steps += 1;
        if self.steps > self.limits.steps { Err(Halt(Ending::Limit)) } else { Ok(()) }
    }

    /// Keep the state as it is before a statement.
    fn remember_state(&mut self, span: Span) {
        let copy = self.copy(span);
        self.history.push(copy);
    }

    fn copy(&self, span: Span) -> StateCopy {
        let frame = self.frame();
        let cell = &*self.cell;
        StateCopy {
            span,
            function: frame.function.to_owned(),
            calls: self.frames.len(),
            globals: named(self.globals.iter().map(|(name, value)| (name, value.bits()))),
            locals: named(frame.locals.iter().map(|(name, value)| (name, value.bits()))),
            counters: frame.counters.iter().map(|counter| counter.kept).collect(),
            positions: named(frame.positions.iter().map(|(name, at)| (name, at.bits()))),
            settings: [
                self.speed as u64,
                u64::from(self.tool),
                self.going_back.speed.map_or(5, |speed| speed as u64),
                self.going_back.limit_n.to_bits(),
                u64::from(self.going_back.is_straight),
            ],
            raised: self.raised.iter().map(|&error| error.to_owned()).collect(),
            draws: self.draws,
            joints: cell.joints().bits(),
            outputs: (0..cell.output_count()).map(|bit| cell.output(bit)).collect(),
            held: cell.held().map(|item| item.0),
        }
    }

    fn frame(&self) -> &Frame<'p> {
        // The frame of the start is there from the beginning and never left.
        &self.frames[self.frames.len() - 1]
    }

    fn frame_mut(&mut self) -> &mut Frame<'p> {
        let last = self.frames.len() - 1;
        &mut self.frames[last]
    }
}

fn named<'a, T, C>(values: impl Iterator<Item = (&'a &'a str, T)>) -> C
where
    C: FromIterator<(String, T)>,
{
    values.map(|(name, value)| ((*name).to_owned(), value)).collect()
}
