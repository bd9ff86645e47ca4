//! A fault of the workcell that becomes an error of the program.

use crate::driven::Driven;
use crate::trail::Trail;
use obverse_bytecode::{FaultName, Module};
use obverse_isa::ErrorId;
use obverse_vm::{Direction, Event, Machine};
use obverse_workcell::{Fault, Workcell};

/// The error that a program says a fault is.
pub(crate) fn error_of(module: &Module, fault: &Fault) -> Option<ErrorId> {
    if let Fault::Watched { watch, .. } = fault {
        let error = module.errors.get(usize::from(watch.number));
        return error.filter(|error| !error.watches.is_empty()).map(|_| ErrorId(watch.number));
    }
    let name = FaultName::from_code(fault.kind().code())?;
    let index = module.errors.iter().position(|error| error.faults.contains(&name))?;
    u16::try_from(index).ok().map(ErrorId)
}

/// Let the fault that stopped the act at an instruction be an error of the program. Whether it
/// could be. The machine does not tell of an act that a fault has ended; it is an action all the
/// same.
pub(crate) fn raise<C: Workcell>(
    driven: &mut dyn Driven<'_, C>,
    error: ErrorId,
    pc: u32,
    trail: &mut Trail<'_>,
) -> bool {
    let is_raised = driven.raise(error);
    if is_raised {
        note_raised(driven.machine(), pc, trail, driven.cell());
    }
    is_raised
}

/// The act at an instruction, that a fault has ended, counts as done as far as it came.
pub(crate) fn note_raised(
    machine: &Machine<'_>,
    pc: u32,
    trail: &mut Trail<'_>,
    cell: &dyn Workcell,
) {
    let instr = machine.program().module().code.get(pc as usize);
    if let Some(instr) = instr {
        let state = machine.state();
        let event = Event {
            direction: Direction::Forward,
            pc,
            instr: *instr,
            report: None,
            steps: state.steps(),
            executed: machine.executed().saturating_sub(1),
            open_blocks: state.open_blocks(),
            frames: state.frames().len(),
            branches: state.branches(),
        };
        trail.note(&event, cell);
    }
}

#[cfg(test)]
mod tests {
    use obverse_bytecode::FaultName;
    use obverse_workcell::FaultKind;

    /// Modules and workcells know nothing of each other, and mean the same by the same codes. What
    /// is watched has no name: its fault says whose it is.
    #[test]
    fn what_a_module_can_name_is_what_a_workcell_can_do() {
        let named: Vec<&str> = FaultName::ALL.iter().map(|name| name.code()).collect();
        let kinds = FaultKind::ALL.iter().filter(|kind| **kind != FaultKind::Watched);
        let done: Vec<&str> = kinds.map(|kind| kind.code()).collect();
        assert_eq!(named, done);
    }
}
