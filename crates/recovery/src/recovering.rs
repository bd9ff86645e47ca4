//! Where a run stands between two looks at it, as plain data: forward, at an error that is due, on
//! its way back, at what has blocked that. So a run can be gone on with piece by piece, and looked
//! at in between. What is decided, and why, is not known here.

use crate::driven::Driven;
use crate::ending::{Ending, GiveUp};
use crate::fault::{self, error_of};
use crate::incident::{Incident, Search};
use crate::memory::Memory;
use crate::recover::{Recovery, Run};
use crate::tell::{Step, Teller, Unattended, Why};
use crate::trail::Trail;
use obverse_bytecode::Module;
use obverse_geometry::JointConfiguration;
use obverse_isa::{ErrorId, Instr};
use obverse_vm::{Alteration, Direction, Event, Machine, Observer, Stop};
use obverse_workcell::{Fault, Workcell};

/// A run under way, and what has been tried in it.
#[derive(Clone, Debug)]
pub struct Recovering<'p> {
    pub(crate) trail: Trail<'p>,
    pub(crate) phase: Phase,
    /// The incidents that are open, innermost last.
    pub(crate) open: Vec<Incident>,
    /// Incidents that the run got past on its way forward again for another that is open still. If
    /// that fails and leads back over them, the world being as it was, they were not got past.
    pub(crate) passed: Vec<Incident>,
    /// Errors that were given up where the run goes on without going back.
    pub(crate) given_up: Vec<GivenUp>,
    /// The most actions that the run has ever begun.
    pub(crate) furthest: u64,
    /// How many attempts there have been since it was last that far.
    pub(crate) attempts: u32,
    /// Whether the program has come to its end with errors pending.
    pub(crate) is_stopping: bool,
    /// How the run ended, where all was left for the cleanup.
    pub(crate) left: Option<Ending>,
    /// What was passed over in the cleanup first.
    pub(crate) amiss: Option<Ending>,
    /// Whether a fault has become an error that is not due yet.
    pub(crate) is_raised: bool,
    /// What was watched and came to hold, by the error's number, and how many instructions lay
    /// before that.
    pub(crate) noticed: Vec<(u64, u16)>,
}

/// An error that was given up where it was due. There is no going back for it until the run is past
/// it, wherever the program goes on.
#[derive(Clone, Debug)]
pub(crate) struct GivenUp {
    pub(crate) error: ErrorId,
    pub(crate) pc: u32,
    pub(crate) entry: u32,
    /// How many actions of the run lie before it.
    pub(crate) number: u64,
    /// What the trail knows by whether the run has got past it.
    pub(crate) passage: u64,
}

/// What comes next.
#[derive(Clone, Debug)]
pub(crate) enum Phase {
    /// The program goes on.
    Forward,
    /// An error is due.
    Due { error: ErrorId, pc: u32 },
    /// A fault is to become an error, or to be passed over, or the run leaves for its cleanup.
    Faulted { fault: Fault, pc: u32 },
    /// The run has ended in this, and its cleanup follows.
    Leaving(Ending),
    /// The run is taken back.
    Way(Way),
    /// It is over; who goes on all the same does so by hand.
    Ended,
}

/// A way back that is under way.
#[derive(Clone, Debug)]
pub(crate) struct Way {
    /// The incident, by its place among those that are open.
    pub(crate) index: usize,
    /// How many instructions lie before where it leads.
    pub(crate) mark: u64,
    /// How many actions there were on the trail.
    pub(crate) count: usize,
    /// How often it was tried again, since it was blocked.
    pub(crate) tries: u32,
    pub(crate) leg: Leg,
    pub(crate) trial: Trial,
}

/// What comes next on a way back.
#[derive(Clone, Debug)]
pub(crate) enum Leg {
    /// Back.
    Back,
    /// What a fault has stopped is to be tried again, or done again.
    Blocked { fault: Fault, pc: u32 },
    /// What is half undone is to be done again, so many actions having been taken back.
    Again { actions: usize },
    /// That was blocked too.
    Stuck { actions: usize, fault: Fault, pc: u32 },
}

/// What an attempt is to be.
#[derive(Clone, Debug)]
pub(crate) struct Trial {
    /// How many actions it was to go back; 0 where the arm stays.
    pub(crate) planned: usize,
    /// When it began, in seconds of the workcell's clock.
    pub(crate) began_s: f64,
    pub(crate) search: Search,
    /// Whether the world is another behind it than it was.
    pub(crate) is_anew: bool,
    pub(crate) change: Option<Alteration>,
}

/// What came of going on with a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Advance {
    /// It went on, and goes on.
    On,
    /// An error is due, the workcell did not do as commanded, or the machine refused: what the
    /// program wants done about that comes next.
    Stopped(Stop),
    /// It is over.
    Ended(Ending),
}

/// What will be done about an error that is due.
#[derive(Clone, Debug, PartialEq)]
pub struct Intent {
    /// The error and what has been tried.
    pub incident: Incident,
    /// What will be done.
    pub what: Intended,
    /// Whether the program goes on where it is given up; else a person is called.
    pub goes_on: bool,
}

/// What will be done about an error that is due.
#[derive(Clone, Debug, PartialEq)]
pub enum Intended {
    /// The run goes back, and forward again.
    Back {
        /// How many actions.
        actions: usize,
        /// The instruction that the way back leads to.
        to: u32,
        /// Why so far.
        why: Why,
        /// What is done otherwise on the way forward again.
        change: Option<Alteration>,
    },
    /// The arm stays, and the program alone goes back.
    InPlace,
    /// Nothing is tried, or nothing more.
    GiveUp(GiveUp),
}

impl<'p> Recovering<'p> {
    /// A run at its start, with the arm there.
    #[must_use]
    pub fn new(module: &'p Module, joints: JointConfiguration) -> Self {
        Self {
            trail: Trail::new(module, joints),
            phase: Phase::Forward,
            open: Vec::new(),
            passed: Vec::new(),
            given_up: Vec::new(),
            furthest: 0,
            attempts: 0,
            is_stopping: false,
            left: None,
            amiss: None,
            is_raised: false,
            noticed: Vec::new(),
        }
    }

    /// Go on with a run, for about so many instructions where it goes forward, which ends it where
    /// they are none. It comes back wherever what it drives does.
    pub fn advance<C: Workcell>(
        &mut self,
        driven: &mut dyn Driven<'p, C>,
        most: u64,
        recovery: &mut Recovery<'_, C>,
        teller: &mut dyn Teller,
    ) -> Advance {
        Run { driven, recovery, teller, at: self }.advance(most)
    }

    /// Which way the run goes next.
    #[must_use]
    pub fn direction(&self) -> Direction {
        match &self.phase {
            Phase::Way(Way { leg: Leg::Back | Leg::Blocked { .. }, .. }) => Direction::Reverse,
            _ => Direction::Forward,
        }
    }

    /// Whether an error is due that nothing was done about yet.
    #[must_use]
    pub fn is_due(&self) -> bool {
        matches!(self.phase, Phase::Due { .. })
    }

    /// Whether the run is over; who goes on all the same does so by hand.
    #[must_use]
    pub fn is_over(&self) -> bool {
        matches!(self.phase, Phase::Ended)
    }

    /// Whether an error is due, or a fault is to be one, or the run is not past one yet.
    #[must_use]
    pub fn is_under_way(&self) -> bool {
        let is_met = match &self.phase {
            Phase::Due { .. } | Phase::Way(_) => true,
            Phase::Faulted { fault, .. } => error_of(self.trail.module(), fault).is_some(),
            _ => false,
        };
        is_met || self.is_raised || !self.open.is_empty()
    }

    /// What will be done about the error that is due, if one is.
    pub fn intent<C: Workcell>(
        &self,
        driven: &mut dyn Driven<'p, C>,
        recovery: &Recovery<'_, C>,
    ) -> Option<Intent> {
        let Phase::Due { error, pc } = self.phase else { return None };
        let (mut at, mut memory): (Self, Memory) = (self.clone(), recovery.memory.clone());
        let mut recovery = Recovery {
            strategy: recovery.strategy,
            bounds: recovery.bounds,
            memory: &mut memory,
            remembers: false,
            person_s: recovery.person_s,
            seed: recovery.seed,
            operator: &mut Unattended,
            foresight: None,
            incidents: Vec::new(),
        };
        let mut run = Run { driven, recovery: &mut recovery, teller: &mut (), at: &mut at };
        Some(run.intent(error, pc))
    }

    /// Somebody gave the command without which nothing moves after a stop.
    pub fn released<C: Workcell>(
        &mut self,
        driven: &mut dyn Driven<'p, C>,
        recovery: &mut Recovery<'_, C>,
        teller: &mut dyn Teller,
    ) {
        driven.release();
        Run { driven, recovery, teller, at: self }.say(&Step::Released);
    }

    /// The run was taken back by hand to where it is now: what was tried is put aside, and an error
    /// that is due again begins anew.
    pub fn taken_back<C: Workcell>(
        &mut self,
        driven: &mut dyn Driven<'p, C>,
        recovery: &mut Recovery<'_, C>,
        teller: &mut dyn Teller,
    ) {
        let is_altered = !self.open.is_empty();
        (self.phase, self.is_raised) = (Phase::Forward, false);
        self.cut_to(driven.machine());
        let count = self.trail.count();
        self.given_up.retain(|old| old.number < count);
        let mut run = Run { driven, recovery, teller, at: self };
        run.notice_again(None);
        run.close_all(&Ending::AtStart);
        if is_altered {
            run.driven.alter(None);
        }
        if !run.driven.machine().is_cleaning_up() {
            (self.left, self.amiss) = (None, None);
        }
    }

    /// The trail ends where the machine stands, which may be within an action.
    pub fn cut_to(&mut self, machine: &Machine<'_>) {
        let state = machine.state();
        let (mut steps, pc) = (state.steps(), state.pc());
        if state.pending().is_some_and(|pending| pending.direction == Direction::Reverse) {
            let instr = machine.program().module().code.get(pc as usize);
            steps = steps.saturating_sub(1 + u64::from(instr.map_or(0, Instr::prefix)));
        }
        self.trail.cut_into(steps, pc);
    }

    /// Stand as a machine does of which only its state is known, and the fault of its last act: at
    /// an error that is due, at a fault that becomes one, or on its way.
    pub fn stand_as(&mut self, machine: &Machine<'_>, fault: Option<&Fault>) {
        let (state, module) = (machine.state(), self.trail.module());
        let pc = state.pc();
        let is_stopped =
            state.pending().is_some_and(|pending| pending.direction == Direction::Forward);
        let before = pc.checked_sub(1).and_then(|pc| module.code.get(pc as usize));
        self.phase = match (fault.filter(|_| is_stopped), before) {
            (Some(fault), _) if error_of(module, fault).is_some() => {
                Phase::Faulted { fault: fault.clone(), pc }
            }
            (None, Some(Instr::ErrorDue { error })) if state.raised().contains(error) => {
                Phase::Due { error: *error, pc: pc - 1 }
            }
            _ => Phase::Forward,
        };
    }

    /// Nothing leads back from here: what was before is not to be gone back to.
    pub fn begin_anew(&mut self) {
        self.trail.begin_anew();
    }

    /// A fault of an act became an error without going through this: as when it is shown again.
    pub fn note_raised(&mut self, machine: &Machine<'_>, pc: u32, cell: &dyn Workcell) {
        fault::note_raised(machine, pc, &mut self.trail, cell);
    }
}

impl Observer for Recovering<'_> {
    /// Something happened without going through this: as when it is shown again, or by hand.
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        self.trail.note(event, cell);
    }
}
