//! A session: what is shown of a run, and how one moves in it.
//!
//! *Reverse* and *rewind* are told apart. A session is live where its run has come to: going on
//! there commands the workcell, forward and in reverse, and reverse obeys the classes. Anywhere
//! else it is rewound: it shows what was, commands nothing, and passes what cannot be taken back.
//! From a rewound moment of a simulated run one may go on otherwise, in a run of its own.
//!
//! How one moves is in `travel`, what is done about errors in `recover`, how one finds a moment in
//! `search` and `changes`, what is told of a moment in `tell`. A session prints nothing: fronts do.

mod changes;
mod declined;
mod recover;
mod search;
mod tell;
mod travel;

pub use changes::Change;
pub use declined::Declined;
pub use recover::Policy;
pub use tell::{Action, Around, FrameView, Variable, Why};
pub use travel::{Grain, Halt, Walk};

use crate::breakpoint::{Breakpoint, stops};
use crate::place::{Mode, Position, source_place};
use crate::recording::{Moment, Order, Recording, World};
use crate::replay::Cursor;
use crate::retrace::is_altered;
use crate::rewound::Rewound;
use crate::run::Run;
use crate::subject::{Look, Seen, Subject, Value, bits_for};
use obverse_bytecode::{Module, Verified};
use obverse_recovery::{Memory, Teller};
use obverse_vm::{Direction, LinkError, Machine, Stops};
use obverse_workcell::{ItemId, Workcell};
use recover::Standing;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// After how many instructions it is seen at the latest that somebody interrupts.
const PIECE: u64 = 1 << 20;

/// How many jumps can be undone.
const MAX_JUMPS: usize = 100;

/// A session over a run.
pub struct Session<'p, C> {
    run: Run<'p, C>,
    /// How the run stands with its errors.
    standing: Standing<'p>,
    /// The runs that what is tried left, outermost first.
    left: Vec<Left<'p, C>>,
    /// What is shown, if it is not the run where it has come to.
    view: Option<Rewound<'p>>,
    breakpoints: Vec<Breakpoint>,
    next_id: u32,
    /// What the breakpoints need, until they change.
    stops: Option<Option<Stops>>,
    jumps: Vec<Option<Moment>>,
    bookmarks: BTreeMap<String, Moment>,
    /// What breakpoints have told, each with its number.
    told: Vec<(u32, String)>,
    teller: Box<dyn Teller + Send + 'p>,
    policy: Policy,
    /// What is known of how far to go back.
    memory: Memory,
    /// The same, as the run learned it last.
    noted: Memory,
    /// What was known until the run learned more, and when that was, oldest first.
    known_until: Vec<(Moment, Memory)>,
    interrupt: Arc<AtomicBool>,
    /// The most instructions that one command runs.
    limit: u64,
}

/// A run that was left for what is tried.
struct Left<'p, C> {
    run: Run<'p, C>,
    standing: Standing<'p>,
    /// The moment of it that was shown.
    shown: Option<Moment>,
    bookmarks: BTreeMap<String, Moment>,
    memory: Memory,
}

impl<'p, C: Workcell> Session<'p, C> {
    /// A live session at the start of a program.
    ///
    /// # Errors
    /// All that the program needs and the workcell lacks.
    pub fn live(program: &'p Verified, cell: C) -> Result<Self, Vec<LinkError>> {
        Run::new(program, cell).map(Self::over)
    }

    /// A session over a run, at its end.
    #[must_use]
    pub fn over(run: Run<'p, C>) -> Self {
        let view = run.cell().is_none().then(|| run.rewound());
        Self {
            standing: Standing::of(&run),
            run,
            left: Vec::new(),
            view,
            breakpoints: Vec::new(),
            next_id: 1,
            stops: None,
            jumps: Vec::new(),
            bookmarks: BTreeMap::new(),
            told: Vec::new(),
            teller: Box::new(()),
            policy: Policy::declared(0),
            memory: Memory::default(),
            noted: Memory::default(),
            known_until: Vec::new(),
            interrupt: Arc::default(),
            limit: u64::MAX,
        }
    }

    /// Tell somebody what the machine does while it is live, and what is done about errors.
    pub fn tell_to(&mut self, teller: Box<dyn Teller + Send + 'p>) {
        self.teller = teller;
    }

    /// Let no command run more than about so many instructions.
    pub fn limit(&mut self, instructions: u64) {
        self.limit = instructions;
    }

    /// A command begins: what was interrupted before was another one.
    pub fn begin_command(&self) {
        self.interrupt.store(false, Ordering::Relaxed);
    }

    /// Whether the command under way was interrupted; who is told so has heard it.
    #[must_use]
    pub fn take_interrupt(&self) -> bool {
        self.interrupt.swap(false, Ordering::Relaxed)
    }

    /// Raised from anywhere, it halts the command under way, between instructions.
    #[must_use]
    pub fn interrupter(&self) -> Arc<AtomicBool> {
        self.interrupt.clone()
    }

    /// The run.
    #[must_use]
    pub fn run(&self) -> &Run<'p, C> {
        &self.run
    }

    /// The program.
    #[must_use]
    pub fn module(&self) -> &'p Module {
        self.run.machine().program().module()
    }

    /// The recording of the run.
    #[must_use]
    pub fn recording(&self) -> &Recording {
        self.run.recording()
    }

    /// What holds of what is shown.
    #[must_use]
    pub fn mode(&self) -> Mode {
        match (&self.view, self.left.is_empty()) {
            (Some(_), _) => Mode::Rewound,
            (None, true) => Mode::Live,
            (None, false) => Mode::WhatIf,
        }
    }

    /// Whether what would have been can be tried: a copy of the workcell is kept.
    #[must_use]
    pub fn can_try(&self) -> bool {
        self.run.is_simulated()
    }

    /// How many runs were left for what is tried.
    #[must_use]
    pub fn tries(&self) -> usize {
        self.left.len()
    }

    /// The machine as it is shown.
    #[must_use]
    pub fn machine(&self) -> &Machine<'p> {
        self.view.as_ref().map_or(self.run.machine(), Rewound::machine)
    }

    /// When that is.
    #[must_use]
    pub fn moment(&self) -> Moment {
        self.view.as_ref().map_or(self.run.recording().end, Rewound::moment)
    }

    /// A digest of the whole state that is shown: the machine's part, and what it commands of the
    /// workcell.
    #[must_use]
    pub fn digest(&self) -> u64 {
        match (&self.view, self.run.cell()) {
            (None, Some(cell)) => self.run.machine().digest(cell),
            (Some(view), _) => view.digest(self.run.recording()),
            (None, None) => self.run.rewound().digest(self.run.recording()),
        }
    }

    /// Look at what is shown.
    pub fn look<T>(&self, look: impl FnOnce(&Look<'_>) -> T) -> T {
        match &self.view {
            Some(view) => look_at(self.module(), self.run.recording(), view, look),
            None => look_live(self.module(), &self.run, look),
        }
    }

    /// Where the session stands.
    #[must_use]
    pub fn position(&self) -> Position {
        let module = self.module();
        let recording = self.run.recording();
        let state = self.machine().state();
        let pc = state.pc();
        let direction = match &self.view {
            Some(view) => view.direction(recording),
            None => match recording.stretches.last().map(|stretch| stretch.order) {
                Some(Order::Reverse | Order::Unwind) => Direction::Reverse,
                _ => Direction::Forward,
            },
        };
        let function = module.function_at(pc).map(|index| module.functions[index].name.clone());
        Position {
            mode: self.mode(),
            moment: self.moment(),
            end: recording.end,
            steps: state.steps(),
            pc,
            place: source_place(module, pc),
            function: function.unwrap_or_default(),
            action: module.source_at(pc).and_then(|entry| entry.action),
            depth: state.frames().len(),
            branches: state.branches(),
            direction,
            now_s: self.look(|look| look.world.now_s()),
            pending: state.pending().map(|pending| pending.direction),
        }
    }

    /// The breakpoints.
    #[must_use]
    pub fn breakpoints(&self) -> &[Breakpoint] {
        &self.breakpoints
    }

    /// Add a breakpoint, which is given a number.
    pub fn add_breakpoint(&mut self, breakpoint: Breakpoint) -> u32 {
        let id = self.next_id;
        self.next_id += 1;
        self.breakpoints.push(Breakpoint { id, ..breakpoint });
        self.stops = None;
        id
    }

    /// Change a breakpoint.
    ///
    /// # Errors
    /// If there is none of this number.
    pub fn change_breakpoint(
        &mut self,
        id: u32,
        change: impl FnOnce(&mut Breakpoint),
    ) -> Result<(), Declined> {
        let found = self.breakpoints.iter_mut().find(|breakpoint| breakpoint.id == id);
        change(found.ok_or(Declined::NoBreakpoint(id))?);
        self.stops = None;
        Ok(())
    }

    /// Drop a breakpoint.
    ///
    /// # Errors
    /// If there is none of this number.
    pub fn drop_breakpoint(&mut self, id: u32) -> Result<(), Declined> {
        let before = self.breakpoints.len();
        self.breakpoints.retain(|breakpoint| breakpoint.id != id);
        self.stops = None;
        if self.breakpoints.len() < before { Ok(()) } else { Err(Declined::NoBreakpoint(id)) }
    }

    /// The places that the breakpoints need a run to stop at; none if that is every one.
    fn stops(&mut self) -> Option<Stops> {
        let module = self.module();
        let breakpoints = &self.breakpoints;
        self.stops.get_or_insert_with(|| stops(module, breakpoints)).clone()
    }

    /// The bookmarks by name.
    #[must_use]
    pub fn bookmarks(&self) -> &BTreeMap<String, Moment> {
        &self.bookmarks
    }

    /// Remember the moment that is shown.
    pub fn bookmark(&mut self, name: &str) {
        self.bookmarks.insert(name.to_owned(), self.moment());
    }

    fn require_live(&self) -> Result<(), Declined> {
        let is_live = self.view.is_none() && self.run.cell().is_some();
        if is_live { Ok(()) } else { Err(Declined::NotLive) }
    }

    /// Go on otherwise from what is shown, in a run of its own in a simulated workcell; what was
    /// recorded stays as it is. What is other is for the caller to change.
    ///
    /// # Errors
    /// If the workcell of that moment cannot be had.
    pub fn what_if(&mut self) -> Result<(), Declined> {
        let at = self.view.clone().unwrap_or_else(|| self.run.rewound());
        let mut run = self.run.fork(&at).map_err(Declined::NoFork)?;
        let is_elsewhere = self.view.is_some();
        let standing = self.standing_at(&at);
        if is_elsewhere && is_altered(&self.run, &at) {
            // What was tried by then is put aside, and what it had changed with it.
            run.drive(Order::Alter(None), crate::drive::Pace::Step, &mut ());
        }
        let shown = self.view.take().map(|view| view.moment());
        let (run, standing) = (
            std::mem::replace(&mut self.run, run),
            std::mem::replace(&mut self.standing, standing),
        );
        let bookmarks = self.bookmarks.clone();
        // What came later comes no more.
        let end = self.run.recording().end;
        self.bookmarks.retain(|_, moment| *moment <= end);
        let known = self.known_at(at.moment());
        let memory = std::mem::replace(&mut self.memory, known);
        self.left.push(Left { run, standing, shown, bookmarks, memory });
        self.jumps.clear();
        Ok(())
    }

    /// Back to the run that was left for what is tried, and to the moment that was shown of it.
    ///
    /// # Errors
    /// If nothing is tried.
    pub fn leave_what_if(&mut self) -> Result<(), Declined> {
        let left = self.left.pop().ok_or(Declined::NoWhatIf)?;
        let Left { run, standing, shown, bookmarks, memory } = left;
        (self.run, self.standing, self.bookmarks) = (run, standing, bookmarks);
        self.memory = memory;
        self.view = None;
        self.jumps.clear();
        self.show(shown);
        Ok(())
    }

    /// Change the workcell of what is tried by hand, its seed for one.
    ///
    /// # Errors
    /// If nothing is tried.
    pub fn change_workcell(&mut self, change: impl FnOnce(&mut C)) -> Result<(), Declined> {
        if self.mode() != Mode::WhatIf {
            return Err(Declined::NoWhatIf);
        }
        self.run.change_cell(change).ok_or(Declined::NoWhatIf)
    }

    /// In what is tried, read an input as this level from here on, or as what it is.
    ///
    /// # Errors
    /// If nothing is tried.
    pub fn force_input(&mut self, bit: u16, level: Option<bool>) -> Result<(), Declined> {
        if self.mode() != Mode::WhatIf {
            return Err(Declined::NoWhatIf);
        }
        self.run.force_input(bit, level);
        Ok(())
    }

    /// In what is tried, give a variable a value. Going back ends here then, since nothing recorded
    /// what was before.
    ///
    /// # Errors
    /// If nothing is tried, or it is no variable of such a type.
    pub fn assign(&mut self, subject: &Subject, value: &Value) -> Result<(), Declined> {
        if self.mode() != Mode::WhatIf {
            return Err(Declined::NoWhatIf);
        }
        let order = self.assignment(subject, value).ok_or(Declined::NotAssignable)?;
        self.run.drive(order, crate::drive::Pace::Step, &mut ());
        self.note_assigned();
        Ok(())
    }

    fn assignment(&self, subject: &Subject, value: &Value) -> Option<Order> {
        let module = self.module();
        match *subject {
            Subject::Global(global) => {
                let declared = module.globals.get(global.index())?;
                Some(Order::SetGlobal(global, bits_for(module, declared, value)?))
            }
            Subject::Local(function, local) => {
                let declared = module.functions.get(usize::from(function))?;
                let declared = declared.locals.get(local.index())?;
                let frames = self.machine().state().frames();
                let frame = frames.iter().rposition(|frame| frame.function == function)?;
                let bits = bits_for(module, declared, value)?;
                Some(Order::SetLocal(u32::try_from(frame).ok()?, local, bits))
            }
            _ => None,
        }
    }
}

/// Look at a moment of a recording.
fn look_at<T>(
    module: &Module,
    recording: &Recording,
    view: &Rewound<'_>,
    look: impl FnOnce(&Look<'_>) -> T,
) -> T {
    let cursor = view.cursor();
    let world = SeenIn { recording, world: cursor.world(), cursor: Some(cursor) };
    look(&Look { module, state: view.machine().state(), world: &world })
}

impl Rewound<'_> {
    /// Look at what is shown of a recording.
    pub fn look<T>(&self, recording: &Recording, look: impl FnOnce(&Look<'_>) -> T) -> T {
        look_at(self.machine().program().module(), recording, self, look)
    }
}

/// Look at a run where it has come to.
fn look_live<C: Workcell, T>(
    module: &Module,
    run: &Run<'_, C>,
    look: impl FnOnce(&Look<'_>) -> T,
) -> T {
    match run.cell() {
        Some(cell) => {
            let world = SeenLive { cell, run };
            look(&Look { module, state: run.machine().state(), world: &world })
        }
        None => look_at(module, run.recording(), &run.rewound(), look),
    }
}

/// What is seen of the workcell of a live run.
struct SeenLive<'a, 'p, C> {
    cell: &'a C,
    run: &'a Run<'p, C>,
}

fn item_name(recording: &Recording, item: ItemId) -> Option<String> {
    let mut items = recording.facts.items.iter();
    items.find(|(_, id, _)| *id == item).map(|(name, ..)| name.clone())
}

impl<C: Workcell> Seen for SeenLive<'_, '_, C> {
    fn joints(&self) -> [f64; 6] {
        self.cell.joints().0
    }

    fn output(&self, bit: u16) -> Option<bool> {
        (bit < self.cell.output_count()).then(|| self.cell.output(bit))
    }

    fn input(&self, bit: u16) -> Option<bool> {
        self.run.input(bit)
    }

    fn force_n(&self) -> f64 {
        self.cell.force_n()
    }

    fn held(&self) -> Option<ItemId> {
        self.cell.held()
    }

    fn now_s(&self) -> f64 {
        self.cell.now_s()
    }

    fn item_name(&self, item: ItemId) -> Option<String> {
        item_name(self.run.recording(), item)
    }
}

/// What is seen of the workcell in a recording.
struct SeenIn<'a> {
    recording: &'a Recording,
    world: &'a World,
    /// Where in the recording, for what was read.
    cursor: Option<&'a Cursor>,
}

impl Seen for SeenIn<'_> {
    fn joints(&self) -> [f64; 6] {
        self.world.joints.0
    }

    fn output(&self, bit: u16) -> Option<bool> {
        self.world.output(bit)
    }

    fn input(&self, bit: u16) -> Option<bool> {
        self.cursor?.input(bit)
    }

    fn force_n(&self) -> f64 {
        self.world.force_n
    }

    fn held(&self) -> Option<ItemId> {
        self.world.held
    }

    fn now_s(&self) -> f64 {
        self.world.now_s
    }

    fn item_name(&self, item: ItemId) -> Option<String> {
        item_name(self.recording, item)
    }
}
