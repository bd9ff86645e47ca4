//! How a session is driven for a request: in pieces, so that it can be halted for a message and go
//! on afterwards as if it had not been.

use obverse_bytecode::{FunctionKind, Module, SourceEntry};
use obverse_debugger::place::prepared;
use obverse_debugger::{Grain, Halt, Session, Walk};
use obverse_sim::Sim;
use obverse_vm::{Direction, State, Stop, can_stop_at};

/// Where a way leads beside where its walk does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Aim {
    /// Nowhere else.
    Walked,
    /// Into the first sequence, or back into it from the end of the program: what calls it is
    /// written nowhere, so that there is nothing to step over.
    Sequence,
    /// To the beginning of the call that it leaves, whatever it comes to on its way.
    Begin,
}

/// What is under way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Going {
    pub(crate) direction: Direction,
    walk: Walk,
    /// How many calls were under way where it began, or are to be where it ends.
    depth: usize,
    aim: Aim,
    /// The statement that it began at, if that was where one is prepared.
    from: Option<Span>,
}

/// What a statement is told from others by: its file, and its first and last byte there.
type Span = (u16, u32, u32);

impl Going {
    pub(crate) fn new(session: &Session<'_, Sim>, direction: Direction, walk: Walk) -> Self {
        let is_statement = match (walk, direction) {
            (Walk::Next(grain), _) | (Walk::Step(grain), Direction::Forward) => {
                grain == Grain::Statement
            }
            _ => false,
        };
        let from = prepared_here(session).filter(|_| direction == Direction::Forward);
        match is_statement && is_in_start(session) {
            true => Self { direction, walk, depth: SEQUENCE_DEPTH, aim: Aim::Sequence, from },
            false => Self { direction, walk, depth: depth(session), aim: Aim::Walked, from },
        }
    }

    /// Back to the beginning of a call, counted from the outermost, from 1.
    pub(crate) fn to_begin_of(frame: usize) -> Self {
        let (direction, walk) = (Direction::Reverse, Walk::Finish);
        Self { direction, walk, depth: frame, aim: Aim::Begin, from: None }
    }

    /// Whether it goes to the beginning of a call.
    pub(crate) fn is_restart(self) -> bool {
        self.aim == Aim::Begin
    }

    /// Go on until it is where it was to go, or something stops it.
    pub(crate) fn go(self, session: &mut Session<'_, Sim>) -> Halt {
        loop {
            let walk = self.piece(session);
            match session.go(self.direction, walk) {
                Halt::Done if self.is_there(session, walk) => break,
                Halt::Done => {}
                // It was asked for the beginning, and nothing between.
                Halt::Hits(_) if self.is_restart() => {
                    if self.is_there(session, walk) {
                        break;
                    }
                }
                halt => return halt,
            }
        }
        // Before a call may be what it is given.
        while self.is_restart() && depth(session) < self.depth {
            match session.go(Direction::Forward, Walk::Step(Grain::Instruction)) {
                Halt::Done | Halt::Hits(_) => {}
                halt => return halt,
            }
        }
        Halt::Done
    }

    /// How it goes on from where it is.
    fn piece(self, session: &Session<'_, Sim>) -> Walk {
        match self.walk {
            Walk::Next(_) | Walk::Step(_) if self.aim == Aim::Sequence && is_in_start(session) => {
                match self.direction {
                    Direction::Forward => Walk::Step(Grain::Statement),
                    Direction::Reverse => Walk::Step(Grain::Instruction),
                }
            }
            Walk::Next(_) if depth(session) > self.depth => Walk::Finish,
            walk => walk,
        }
    }

    /// Whether a piece of it, that was done, has led to where it was to go.
    fn is_there(self, session: &Session<'_, Sim>, walked: Walk) -> bool {
        let is_begin = || is_begin(session.module(), session.machine().state());
        match self.walk {
            _ if self.aim == Aim::Sequence => {
                depth(session) <= self.depth && !is_in_start(session) && is_begin()
            }
            Walk::Finish => depth(session) < self.depth,
            Walk::Next(Grain::Statement) | Walk::Step(Grain::Statement)
                if self.is_between(session) =>
            {
                false
            }
            Walk::Next(_) if walked == self.walk => true,
            Walk::Next(grain) => {
                depth(session) <= self.depth && (grain == Grain::Instruction || is_begin())
            }
            Walk::Step(_) | Walk::Continue | Walk::Recover => true,
        }
    }

    /// Whether a session stands at a part of a statement that is none by itself.
    fn is_between(self, session: &Session<'_, Sim>) -> bool {
        let pc = session.machine().state().pc();
        let span = session.module().source_at(pc).map(span);
        prepared_here(session).is_some() || self.from.is_some() && self.from == span
    }

    /// The first instruction of it, which shows whether it can be begun: if not, nothing has
    /// changed. None if there is more to do.
    pub(crate) fn begin(self, session: &mut Session<'_, Sim>) -> Begun {
        let before = session.moment();
        session.limit(1);
        let mut halt = self.go(session);
        // Whoever says something meanwhile is heard when it has begun.
        for _ in 0..PATIENCE {
            if halt != Halt::Interrupted || session.moment() != before {
                break;
            }
            halt = self.go(session);
        }
        session.limit(u64::MAX);
        let is_still = session.moment() == before;
        match halt {
            Halt::Limit | Halt::Interrupted => Begun::GoesOn,
            Halt::Stopped(_) | Halt::Changed | Halt::StartOfRecording if is_still => {
                Begun::Refused(halt)
            }
            Halt::EndOfRecording | Halt::Held if is_still => Begun::Refused(halt),
            halt => Begun::Halted(halt),
        }
    }
}

/// What came of beginning to go.
pub(crate) enum Begun {
    /// There is more to do.
    GoesOn,
    /// It has come to its end.
    Halted(Halt),
    /// It cannot go that way, and has not moved.
    Refused(Halt),
}

/// How often a beginning that was interrupted is begun again.
const PATIENCE: usize = 10;

/// How many calls are under way in the first sequence.
pub(crate) const SEQUENCE_DEPTH: usize = 2;

/// Whether a session stands before the first sequence, or behind it.
fn is_in_start(session: &Session<'_, Sim>) -> bool {
    let module = session.module();
    let function = module.function_at(session.machine().state().pc());
    let function = function.and_then(|function| module.functions.get(function));
    function.is_some_and(|function| function.kind == FunctionKind::Start)
}

fn depth(session: &Session<'_, Sim>) -> usize {
    session.machine().state().frames().len()
}

fn span(entry: &SourceEntry) -> Span {
    (entry.file, entry.start, entry.end)
}

/// The statement that is prepared where a session stands, before it begins.
fn prepared_here(session: &Session<'_, Sim>) -> Option<Span> {
    prepared(session.module(), session.machine().state().pc())
}

/// Whether a machine stands where a statement of the source begins.
fn is_begin(module: &Module, state: &State) -> bool {
    let pc = state.pc();
    let first = module.source_at(pc).map(|entry| entry.first);
    let begin = first.and_then(|first| (first..=pc).find(|pc| can_stop_at(module, *pc)));
    begin == Some(pc) && state.operands().is_empty() && state.pending().is_none()
}

/// Whether a halt is the end of the program.
pub(crate) fn is_end(halt: &Halt) -> bool {
    matches!(halt, Halt::Stopped(Stop::Finished))
}
