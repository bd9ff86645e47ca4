//! Where the time of a run goes: counted as it happens, by sequence and by action, with what the
//! ways taken depended on.
//!
//! Knows no words and no columns: those are in `commands/dry.rs`.

use obverse_bytecode::Module;
use obverse_isa::{Family, Instr};
use obverse_vm::{Direction, Event, Observer};
use obverse_workcell::Workcell;
use std::collections::BTreeMap;

/// Times of one thing that was done, in seconds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Times {
    pub(crate) count: u64,
    pub(crate) total_s: f64,
    pub(crate) least_s: f64,
    pub(crate) most_s: f64,
}

impl Times {
    fn add(&mut self, time_s: f64) {
        self.least_s = if self.count == 0 { time_s } else { self.least_s.min(time_s) };
        self.most_s = self.most_s.max(time_s);
        self.total_s += time_s;
        self.count += 1;
    }

    pub(crate) fn mean_s(&self) -> f64 {
        self.total_s / self.count.max(1) as f64
    }
}

/// What a reading came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reading {
    /// An input; the level that was waited for, or that it had.
    Input { bit: u16, is_high: bool },
    /// Whether something is held.
    Holding(bool),
    /// How far the last motion came, in metres.
    Distance(f64),
    /// A force, in newtons.
    Force(f64),
    /// A random number.
    Drawn,
}

/// A call under way.
struct Call {
    function: usize,
    /// The branch of each open fork that it is made in, outermost first.
    branches: Vec<usize>,
    /// How long it has taken so far: what its own branch did, or what it forked.
    time_s: f64,
}

/// Counts the time of a run. The branches of a fork take turns in one cell: the time of a turn is
/// that of its branch alone, and what all of them wait for is that of the one who does something
/// next.
pub(crate) struct Cycle<'m> {
    module: &'m Module,
    /// The calls under way, of one branch in their order.
    calls: Vec<Call>,
    last_s: f64,
    /// By function.
    pub(crate) sequences: BTreeMap<usize, Times>,
    /// By the first instruction of what was written there.
    pub(crate) actions: BTreeMap<u32, Times>,
    /// By instruction.
    pub(crate) readings: BTreeMap<u32, Vec<Reading>>,
    /// Whether branches of a fork took turns.
    pub(crate) has_branches: bool,
    /// The guarded moves, and whether contact stopped them.
    pub(crate) guarded: (u64, u64),
}

/// No more readings of one place are kept.
const MAX_READINGS: usize = 1_000;

impl<'m> Cycle<'m> {
    /// Of a run that begins when the workcell's clock shows so many seconds.
    pub(crate) fn new(module: &'m Module, begin_s: f64) -> Self {
        Self {
            module,
            calls: Vec::new(),
            last_s: begin_s,
            sequences: BTreeMap::new(),
            actions: BTreeMap::new(),
            readings: BTreeMap::new(),
            has_branches: false,
            guarded: (0, 0),
        }
    }

    /// The run is over, and so are the calls that did not end.
    pub(crate) fn end(&mut self, now_s: f64) {
        let took_s = now_s - self.last_s;
        for call in std::mem::take(&mut self.calls) {
            self.count(&Call { time_s: call.time_s + took_s, ..call });
        }
    }

    fn count(&mut self, call: &Call) {
        self.sequences.entry(call.function).or_default().add(call.time_s);
    }

    /// A branch took so long: so did the calls around it. Those in forks within it, which were left
    /// without a return, are over.
    fn pass(&mut self, branches: &[usize], took_s: f64) {
        let is_within = |call: &mut Call| {
            call.branches.len() > branches.len() && call.branches.starts_with(branches)
        };
        let over: Vec<Call> = self.calls.extract_if(.., is_within).collect();
        over.iter().for_each(|call| self.count(call));
        let around = self.calls.iter_mut().filter(|call| branches.starts_with(&call.branches));
        around.for_each(|call| call.time_s += took_s);
    }

    /// The innermost call of a branch returned.
    fn leave(&mut self, branches: &[usize]) {
        if let Some(at) = self.calls.iter().rposition(|call| call.branches == branches) {
            let call = self.calls.remove(at);
            self.count(&call);
        }
    }

    fn read(&mut self, pc: u32, reading: Reading) {
        let readings = self.readings.entry(pc).or_default();
        if readings.len() < MAX_READINGS {
            readings.push(reading);
        }
    }
}

fn reading(instr: Instr, cell: &dyn Workcell) -> Option<Reading> {
    Some(match instr {
        Instr::SenseInput { bit, .. } | Instr::WaitInput { bit, .. } => {
            Reading::Input { bit: bit.0, is_high: cell.input(bit.0) == Ok(true) }
        }
        Instr::SenseHolding { .. } => Reading::Holding(cell.held().is_some()),
        Instr::SenseDistance { .. } => Reading::Distance(cell.last_motion().distance_m),
        Instr::SensePeakForce { .. } => Reading::Force(cell.last_motion().peak_force_n),
        Instr::SenseForce { .. } => Reading::Force(cell.force_n()),
        Instr::Draw { .. } => Reading::Drawn,
        _ => return None,
    })
}

impl Observer for Cycle<'_> {
    fn on_event(&mut self, event: &Event, cell: &dyn Workcell) {
        if event.direction == Direction::Reverse {
            return;
        }
        let now_s = cell.now_s();
        let took_s = now_s - self.last_s;
        self.last_s = now_s;
        self.has_branches |= !event.branches.is_empty();
        self.pass(&event.branches, took_s);
        match event.instr {
            Instr::Call { function, .. } => {
                let (function, branches) = (function.index(), event.branches.clone());
                self.calls.push(Call { function, branches, time_s: 0.0 });
            }
            Instr::Return {} => self.leave(&event.branches),
            instr => {
                let is_act = matches!(instr.info().family, Family::Kinematic | Family::Io);
                if is_act || took_s > 0.0 {
                    let entry = self.module.source_at(event.pc);
                    let entry = entry.filter(|_| instr.info().family != Family::Task);
                    let place = entry.map_or(event.pc, |entry| entry.first);
                    self.actions.entry(place).or_default().add(took_s);
                }
                if let Some(reading) = reading(instr, cell) {
                    self.read(event.pc, reading);
                }
                if let (true, Some(report)) = (instr.is_guarded(), event.report) {
                    use obverse_workcell::MotionEnd;
                    let is_stopped = report.end == MotionEnd::StoppedByForce;
                    self.guarded.0 += 1;
                    self.guarded.1 += u64::from(is_stopped);
                }
            }
        }
    }
}
