//! What waits in forks promise: nobody goes on before what was waited for is over, however the
//! turns fall and however often the run turned round.

use crate::code::{self, Options};
use crate::{Ledger, fork_code};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::{Constant, Module, verify};
use obverse_isa::Family;
use obverse_vm::{Direction, Machine, Stop};
use obverse_workcell::Clock;
use std::collections::BTreeMap;

/// The longest run, in steps of either direction.
const MAX_STEPS: u32 = 2_000;
/// Longer than some motions together.
const LONG_S: f64 = 2.75;

/// A task goes on no sooner after an output or a wait than that has settled, and what is behind a
/// fork no sooner than all of it: by the workcell's clock, in random modules.
///
/// # Errors
/// Those of the randomness.
pub fn waits_are_waited(u: &mut Unstructured<'_>) -> Result<bool> {
    let mut module = match u.ratio(1_u8, 2)? {
        true => code::module(u, Options::default())?,
        false => fork_code::module(u)?,
    };
    for constant in &mut module.constants {
        if let Constant::Real(0.25 | 0.5) = constant {
            *constant = Constant::Real(LONG_S);
        }
    }
    let program = match verify(module) {
        Ok(program) => program,
        Err(errors) => panic!("{errors:?}"),
    };
    let mut cell = Ledger::new(u.arbitrary()?);
    let mut machine = match Machine::new(&program, &cell) {
        Ok(machine) => machine,
        Err(errors) => panic!("{errors:?}"),
    };
    let mut watch = Watch { settled_s: BTreeMap::new(), compared: 0 };
    let mut left = MAX_STEPS;
    while left > 0 {
        let turns_round = (u.int_in_range(1..=60_u32)?, u.int_in_range(0..=20_u32)?);
        for _ in 0..turns_round.0 {
            watch.forward(program.module(), &machine, &cell);
            if !goes_on(&machine.step(Direction::Forward, &mut cell, &mut ())) {
                return Ok(watch.compared > 0);
            }
        }
        for _ in 0..turns_round.1 {
            if !goes_on(&machine.step(Direction::Reverse, &mut cell, &mut ())) {
                break;
            }
            watch.forget(&machine.state().branches());
        }
        left = left.saturating_sub(turns_round.0 + turns_round.1);
    }
    Ok(watch.compared > 0)
}

fn goes_on(stepped: &std::result::Result<(), Stop>) -> bool {
    matches!(stepped, Ok(()) | Err(Stop::Raised { .. }))
}

/// Knows of each task when the last that it commanded has settled, by its branch of each fork.
struct Watch {
    settled_s: BTreeMap<Vec<usize>, f64>,
    compared: u32,
}

impl Watch {
    /// A task that goes on, or stands where it is after a step in reverse, has nothing to wait for
    /// there, nor has what it forked.
    fn forget(&mut self, task: &[usize]) {
        self.settled_s.retain(|other, _| !other.starts_with(task));
    }

    /// Before a step forward.
    fn forward(&mut self, module: &Module, machine: &Machine<'_>, cell: &Ledger) {
        let (state, now_s) = (machine.state(), cell.now_s());
        if state.is_compensating() {
            // Forward is back here.
            self.settled_s.clear();
            return;
        }
        let task = state.branches();
        for (_, settled_s) in self.settled_s.iter().filter(|(other, _)| other.starts_with(&task)) {
            self.compared += 1;
            // The machine counts in whole nanoseconds.
            let is_early = now_s + 1e-6 < *settled_s;
            assert!(!is_early, "{task:?} goes on at {now_s} s, and not at {settled_s} s");
        }
        self.forget(&task);
        let instr = module.code[state.pc() as usize];
        if instr.info().family == Family::Io && !task.is_empty() {
            let duration_s = state.operands().first().copied().map_or(0.0, f64::from_bits);
            self.settled_s.insert(task, now_s + duration_s);
        }
    }
}
