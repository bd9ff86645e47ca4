//! Which instructions can change what is watched, so that nothing else needs to be looked at.

use crate::condition::Expression;
use crate::subject::Subject;
use obverse_bytecode::Module;
use obverse_isa::{Family, GlobalId, Instr, LocalId};

/// The instructions of a module behind each of which an expression may be another; none if that is
/// every one.
pub(crate) fn writers(module: &Module, expression: &Expression) -> Option<Vec<u32>> {
    let is_of_steps = expression.subjects().contains(&&Subject::Steps);
    (!is_of_steps).then(|| writers_beside_steps(module, expression))
}

/// The instructions behind each of which an expression may be another because of something else
/// than how many steps there were.
pub(crate) fn writers_beside_steps(module: &Module, expression: &Expression) -> Vec<u32> {
    let mut all = Vec::new();
    for subject in expression.subjects() {
        let writes = |(pc, instr): &(u32, &Instr)| writes(module, subject, *pc, instr);
        all.extend((0..).zip(&module.code).filter(writes).map(|(pc, _)| pc));
    }
    all
}

fn writes(module: &Module, subject: &Subject, pc: u32, instr: &Instr) -> bool {
    match *subject {
        Subject::Global(global) => written_global(instr) == Some(global),
        Subject::Local(function, _) | Subject::Counter(function, _) => match instr {
            // Another call of the function has a variable of its own, and so has another task.
            Instr::Call { function: called, .. } => called.0 == function,
            Instr::Return {} => module.function_at(pc) == Some(usize::from(function)),
            _ if instr.info().family == Family::Task || instr.ends_turn() => true,
            _ => {
                let is_there = module.function_at(pc) == Some(usize::from(function));
                is_there
                    && match *subject {
                        Subject::Local(_, local) => written_local(instr) == Some(local),
                        // Any jump may lead out of the loop.
                        _ => instr.info().family == Family::Flow,
                    }
            }
        },
        Subject::Input(bit) => match instr {
            Instr::SenseInput { bit: read, .. } | Instr::WaitInput { bit: read, .. } => {
                read.0 == bit
            }
            _ => false,
        },
        Subject::Setting(setting) => {
            matches!(instr, Instr::SettingSet { setting: set, .. } if *set == setting)
        }
        Subject::Error(error) => match instr {
            Instr::ErrorRaise { error: of } | Instr::ErrorClear { error: of } => *of == error,
            _ => false,
        },
        Subject::Output(_)
        | Subject::Joint(_)
        | Subject::Joints
        | Subject::Force
        | Subject::Held
        | Subject::Time => commands(instr),
        Subject::Steps => false,
    }
}

/// Whether an instruction may command the workcell.
pub(crate) fn commands(instr: &Instr) -> bool {
    let family = instr.info().family;
    family.commands_workcell() || family == Family::Task || matches!(instr, Instr::WaitInput { .. })
}

fn written_global(instr: &Instr) -> Option<GlobalId> {
    match *instr {
        Instr::StoreGlobal { global, .. }
        | Instr::AddGlobal { global, .. }
        | Instr::SubGlobal { global, .. } => Some(global),
        _ => None,
    }
}

fn written_local(instr: &Instr) -> Option<LocalId> {
    match *instr {
        Instr::StoreLocal { local, .. }
        | Instr::AddLocal { local, .. }
        | Instr::SubLocal { local, .. }
        | Instr::AddLocalImmediate { local, .. }
        | Instr::AddLocalLocal { local, .. }
        | Instr::AddLocalCounter { local, .. }
        | Instr::SubLocalLocal { local, .. }
        | Instr::SubLocalCounter { local, .. }
        | Instr::SenseInput { local, .. }
        | Instr::SenseForce { local }
        | Instr::SenseDistance { local }
        | Instr::SensePeakForce { local }
        | Instr::SenseHolding { local }
        | Instr::Draw { local }
        | Instr::WaitInput { local, .. } => Some(local),
        _ => None,
    }
}
