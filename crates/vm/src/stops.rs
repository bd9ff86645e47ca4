//! Places that a run stops at, at no cost to what lies between them.
//!
//! The loop runs a copy of the code in which such a place holds an instruction that it leaves to
//! the step loop, and everything else runs the code itself. Why a run is to stop somewhere is not
//! known here.

use crate::hot::Exit;
use crate::machine::{Limits, Machine};
use crate::observe::Observer;
use crate::state::Direction;
use crate::step::Host;
use crate::stop::Stop;
use obverse_bytecode::Module;
use obverse_isa::{Family, Instr};
use obverse_workcell::Workcell;

/// Places that a run stops at.
#[derive(Clone, Debug)]
pub struct Stops {
    code: Vec<Instr>,
    /// Whether there is one before an instruction.
    at: Vec<bool>,
}

impl Stops {
    /// Before instructions of a module. One that [`can_stop_at`] rules out is left out.
    #[must_use]
    pub fn new(module: &Module, at: impl IntoIterator<Item = u32>) -> Self {
        let mut stops = Self { code: module.code.clone(), at: vec![false; module.code.len()] };
        for pc in at.into_iter().filter(|&pc| can_stop_at(module, pc)) {
            stops.add(pc);
        }
        stops
    }

    /// The same and one more, that [`can_stop_at`] does not rule out.
    #[must_use]
    pub fn with(&self, pc: u32) -> Self {
        let mut stops = self.clone();
        stops.add(pc);
        stops
    }

    fn add(&mut self, pc: u32) {
        if let Some(instr) = self.code.get_mut(pc as usize) {
            *instr = Instr::Halt {};
            self.at[pc as usize] = true;
        }
    }

    /// Whether a run stops before an instruction.
    #[must_use]
    pub fn has(&self, pc: u32) -> bool {
        self.at.get(pc as usize).copied().unwrap_or(false)
    }
}

/// Whether a run can stop before an instruction of a module. A join, and what an asserted one asks,
/// belong to the step of the jump that lands there.
#[must_use]
pub fn can_stop_at(module: &Module, pc: u32) -> bool {
    let rest = module.code.get(pc as usize..).unwrap_or_default();
    let effect = rest.iter().find(|instr| !instr.info().family.is_pure());
    let is_join = matches!(
        effect,
        Some(
            Instr::Land { .. }
                | Instr::Join { .. }
                | Instr::JoinAssert { .. }
                | Instr::ForTop { .. }
                | Instr::ForExit { .. }
                | Instr::Enter {}
        )
    );
    effect.is_some() && !is_join
}

impl Machine<'_> {
    /// Run forward until the machine stands before one of the stops, which is none, or something
    /// else stops it. At least one step is made.
    pub fn run_to(
        &mut self,
        stops: &Stops,
        limits: Limits,
        cell: &mut dyn Workcell,
        observer: &mut dyn Observer,
    ) -> Option<Stop> {
        let allowed = self.executed.saturating_add(limits.instructions);
        // A statement that traps leads back to its beginning: not to before where this began.
        let mut is_begun = !stops.has(self.state.pc());
        loop {
            if self.executed >= allowed {
                return Some(Stop::Budget);
            }
            let left = allowed - self.executed;
            let is_plain = self.state.pending.is_none() && !self.state.is_compensating();
            let outcome = if is_begun && is_plain {
                let mut host = Host { cell, observer };
                self.net_of_traps(|machine| machine.burst_to(stops, left, &mut host))
            } else {
                self.step(Direction::Forward, cell, observer)
            };
            is_begun = true;
            if let Err(stop) = outcome {
                return Some(stop);
            }
            if stops.has(self.state.pc()) {
                return None;
            }
        }
    }

    /// Run forward past the stops, telling before and behind each of them, and no further than to
    /// one whose instruction asks or commands the workcell. Goes nowhere from in between: where an
    /// act is not done, or where something runs in place of a reversal.
    pub fn run_past(
        &mut self,
        stops: &Stops,
        limits: Limits,
        cell: &mut dyn Workcell,
        observer: &mut dyn Observer,
    ) -> Option<Stop> {
        let allowed = self.executed.saturating_add(limits.instructions);
        while self.executed < allowed {
            if self.state.pending.is_some() || self.state.is_compensating() {
                return None;
            }
            let left = allowed - self.executed;
            let mut host = Host { cell: &mut *cell, observer: &mut *observer };
            let outcome = if stops.has(self.state.pc()) {
                self.pass(&mut host)?
            } else {
                self.net_of_traps(|machine| machine.burst_to(stops, left, &mut host))
            };
            if let Err(stop) = outcome {
                return Some(stop);
            }
        }
        None
    }

    /// One step from a stop, told; none if its instruction is for the workcell.
    fn pass(&mut self, host: &mut Host<'_>) -> Option<crate::step::Outcome> {
        let family = self.program.module().code[self.state.place.pc].info().family;
        let is_its_own =
            matches!(family, Family::Value | Family::Variable | Family::Flow | Family::Frame);
        is_its_own.then(|| {
            host.observer.before_stop(&self.state, self.executed);
            let outcome = self.step(Direction::Forward, host.cell, host.observer);
            host.observer.behind_stop(&self.state, self.executed);
            outcome
        })
    }

    /// As far as the hot loop goes, and one step more unless it stands before a stop.
    fn burst_to(&mut self, stops: &Stops, left: u64, host: &mut Host<'_>) -> crate::step::Outcome {
        let limit = self.state.steps().saturating_add(left);
        let exit = self.count(|machine| machine.hot_forward::<false>(&stops.code, limit));
        if exit == Exit::Slow && stops.has(self.state.pc()) {
            return Ok(());
        }
        match exit {
            Exit::Trap(at, kind) => Err(self.trapped(at, kind)),
            Exit::Bound | Exit::One | Exit::Full => self.check_tape(),
            Exit::Slow => self.count_step(|machine| machine.slow_forward(host)),
        }
    }
}
