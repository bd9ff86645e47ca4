//! How a session is driven for a request: in pieces, so that it can be halted for a message and go
//! on afterwards as if it had not been.

use obverse_bytecode::Module;
use obverse_debugger::{Grain, Halt, Session, Walk};
use obverse_sim::Sim;
use obverse_vm::{Direction, State, Stop, can_stop_at};

/// What is under way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Going {
    pub(crate) direction: Direction,
    pub(crate) walk: Walk,
    /// How many calls were under way where it began.
    depth: usize,
    /// Whether the call that this leaves is entered again.
    pub(crate) enters: bool,
}

impl Going {
    pub(crate) fn new(session: &Session<'_, Sim>, direction: Direction, walk: Walk) -> Self {
        Self { direction, walk, depth: depth(session), enters: false }
    }

    /// Back to the beginning of a call, counted from the outermost, from 1.
    pub(crate) fn to_begin_of(frame: usize) -> Self {
        let (direction, walk) = (Direction::Reverse, Walk::Finish);
        Self { direction, walk, depth: frame, enters: true }
    }

    /// Go on until it is where it was to go, or something stops it.
    pub(crate) fn go(self, session: &mut Session<'_, Sim>) -> Halt {
        loop {
            let walk = match self.walk {
                Walk::Next(_) if depth(session) > self.depth => Walk::Finish,
                walk => walk,
            };
            let halt = session.go(self.direction, walk);
            if halt != Halt::Done {
                return halt;
            }
            if self.is_there(session, walk) {
                break;
            }
        }
        if self.enters {
            return session.go(Direction::Forward, Walk::Step(Grain::Instruction));
        }
        Halt::Done
    }

    /// Whether a piece of it, that was done, has led to where it was to go.
    fn is_there(self, session: &Session<'_, Sim>, walked: Walk) -> bool {
        match self.walk {
            Walk::Finish => depth(session) < self.depth,
            Walk::Next(_) if walked == self.walk => true,
            Walk::Next(grain) => {
                let is_begin = || is_begin(session.module(), session.machine().state());
                depth(session) <= self.depth && (grain == Grain::Instruction || is_begin())
            }
            Walk::Step(_) | Walk::Continue | Walk::Recover => true,
        }
    }

    /// The first instruction of it, which shows whether it can be begun: if not, nothing has
    /// changed. None if there is more to do.
    pub(crate) fn begin(self, session: &mut Session<'_, Sim>) -> Begun {
        let before = session.moment();
        session.limit(1);
        let halt = self.go(session);
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

fn depth(session: &Session<'_, Sim>) -> usize {
    session.machine().state().frames().len()
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
