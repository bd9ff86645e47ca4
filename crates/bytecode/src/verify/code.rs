//! Rules 3, 4 and 7: operands, statements with their heights and types, updates. Follows the code
//! of one function from top to bottom; needs no knowledge of where control goes, since the operand
//! stack is empty between statements.

use super::{Findings, MAX_OPERANDS, Rule};
use crate::module::{Function, Module};
use obverse_isa::{Instr, OperandKind, Setting, StackItem, Type};

pub(super) fn check(module: &Module, function: &Function, findings: &mut Findings) {
    let mut stack: Vec<Type> = Vec::new();
    let mut start = function.first as usize;
    for at in function.first as usize..function.end as usize {
        let instr = module.code[at];
        if !operands(module, function, at, findings) {
            return;
        }
        if !apply(module, function, at, &mut stack, findings) {
            return;
        }
        if instr.info().family.is_pure() {
            continue;
        }
        if usize::from(instr.prefix()) != at - start {
            let why = format!(
                "{} says that its prefix has {} instructions, and it has {}",
                instr.info().mnemonic,
                instr.prefix(),
                at - start
            );
            findings.at(at, Rule::Statements, why);
        }
        if !stack.is_empty() {
            let why = format!("{} operands are left after the statement", stack.len());
            findings.at(at, Rule::Statements, why);
            return;
        }
        update(module, start, at, findings);
        start = at + 1;
    }
}

/// How many of what an operand of a kind indexes there are; `None` if it is no index.
fn table_length(module: &Module, function: &Function, kind: OperandKind) -> Option<usize> {
    Some(match kind {
        OperandKind::Constant => module.constants.len(),
        OperandKind::Local => function.locals.len(),
        OperandKind::Global => module.globals.len(),
        OperandKind::Counter => usize::from(function.counters),
        OperandKind::Slot => function.slots.len(),
        OperandKind::Joints => module.joints.len(),
        OperandKind::Item => module.items.len(),
        OperandKind::Keyframe => module.keyframes.len(),
        OperandKind::Tool => module.tools.len(),
        OperandKind::Error => module.errors.len(),
        OperandKind::Checkpoint => module.checkpoints.len(),
        OperandKind::Reason => module.reasons.len(),
        OperandKind::Function => module.functions.len(),
        OperandKind::Label => module.code.len(),
        OperandKind::Prefix
        | OperandKind::Integer
        | OperandKind::Bit
        | OperandKind::Level
        | OperandKind::Speed
        | OperandKind::Setting
        | OperandKind::Axis
        | OperandKind::Frame
        | OperandKind::Path => return None,
    })
}

fn operands(module: &Module, function: &Function, at: usize, findings: &mut Findings) -> bool {
    let mut is_right = true;
    module.code[at].each_operand(&mut |kind, _, value| {
        let length = table_length(module, function, kind);
        if length.is_some_and(|length| usize::try_from(value).map_or(true, |value| value >= length))
        {
            let why = format!("there is no {} {value}", format!("{kind:?}").to_lowercase());
            findings.at(at, Rule::Operands, why);
            is_right = false;
        }
    });
    let called = match module.code[at] {
        Instr::Call { function, .. } | Instr::BlockReplace { function, .. } => Some(function),
        _ => None,
    };
    if is_right && called.is_some_and(|called| called.index() == 0) {
        findings.at(at, Rule::Operands, "the start is no function to call: it never returns");
        is_right = false;
    }
    is_right
}

/// Pop and push what the stack picture says.
fn apply(
    module: &Module,
    function: &Function,
    at: usize,
    stack: &mut Vec<Type>,
    findings: &mut Findings,
) -> bool {
    let instr = module.code[at];
    let info = instr.info();
    let mut wanted = Vec::new();
    for item in info.pops {
        types_of(module, function, &instr, *item, &mut wanted);
    }
    for expected in wanted.into_iter().rev() {
        let found = stack.pop();
        if found != Some(expected) {
            let found = found.map_or("nothing", Type::name);
            let why = format!("{} takes {expected}, and there is {found}", info.mnemonic);
            findings.at(at, Rule::Statements, why);
            return false;
        }
    }
    for item in info.pushes {
        types_of(module, function, &instr, *item, stack);
    }
    if stack.len() > MAX_OPERANDS {
        let why = format!("more than {MAX_OPERANDS} operands at once");
        findings.at(at, Rule::Statements, why);
        return false;
    }
    read_types(module, function, at, findings)
}

/// Instructions that read variables without a stack picture of them read integers.
fn read_types(module: &Module, function: &Function, at: usize, findings: &mut Findings) -> bool {
    let instr = module.code[at];
    let info = instr.info();
    let in_picture = |item: &StackItem| matches!(item, StackItem::Local | StackItem::Global);
    if info.pops.iter().chain(info.pushes).any(in_picture) {
        return true;
    }
    let expected = match instr {
        Instr::SenseInput { .. } | Instr::SenseHolding { .. } | Instr::WaitInput { .. } => {
            Type::Bool
        }
        Instr::SenseForce { .. }
        | Instr::SenseDistance { .. }
        | Instr::SensePeakForce { .. }
        | Instr::Draw { .. } => Type::Real,
        _ => Type::Int,
    };
    let mut is_right = true;
    instr.each_operand(&mut |kind, _, value| {
        let variable = match kind {
            OperandKind::Local => &function.locals[value as usize],
            OperandKind::Global => &module.globals[value as usize],
            _ => return,
        };
        if variable.of_type != expected {
            let why = format!(
                "{} needs {expected}, and `{}` is {}",
                info.mnemonic, variable.name, variable.of_type
            );
            findings.at(at, Rule::Statements, why);
            is_right = false;
        }
    });
    is_right
}

/// The types that an entry of a stack picture stands for.
fn types_of(
    module: &Module,
    function: &Function,
    instr: &Instr,
    item: StackItem,
    types: &mut Vec<Type>,
) {
    match item {
        StackItem::Of(of_type) => types.push(of_type),
        StackItem::Local => types.extend(
            first_operand(instr, OperandKind::Local).map(|local| function.locals[local].of_type),
        ),
        StackItem::Global => types.extend(
            first_operand(instr, OperandKind::Global).map(|global| module.globals[global].of_type),
        ),
        StackItem::Constant => types.extend(
            first_operand(instr, OperandKind::Constant)
                .map(|constant| module.constants[constant].of_type()),
        ),
        StackItem::Setting => {
            let setting = first_operand(instr, OperandKind::Setting);
            types.extend(setting.and_then(|at| Setting::ALL.get(at)).map(|it| it.of_type()));
        }
        StackItem::Parameters => {
            if let Some(called) = first_operand(instr, OperandKind::Function) {
                let called = &module.functions[called];
                let parameters = &called.locals[..usize::from(called.parameters)];
                types.extend(parameters.iter().map(|parameter| parameter.of_type));
            }
        }
    }
}

fn first_operand(instr: &Instr, wanted: OperandKind) -> Option<usize> {
    let mut found = None;
    instr.each_operand(&mut |kind, _, value| {
        if kind == wanted && found.is_none() {
            found = usize::try_from(value).ok();
        }
    });
    found
}

/// Rule 7, for the statement from `start` to the effect `at`.
fn update(module: &Module, start: usize, at: usize, findings: &mut Findings) {
    let (kind, updated) = match module.code[at] {
        Instr::AddLocal { local, .. } | Instr::SubLocal { local, .. } => {
            (OperandKind::Local, local.index())
        }
        Instr::AddGlobal { global, .. } | Instr::SubGlobal { global, .. } => {
            (OperandKind::Global, global.index())
        }
        Instr::AddLocalLocal { local, value } | Instr::SubLocalLocal { local, value }
            if local == value =>
        {
            findings.at(at, Rule::Updates, "the update reads the variable that it changes");
            return;
        }
        _ => return,
    };
    for instr in &module.code[start..at] {
        let mut reads = false;
        instr.each_operand(&mut |found, _, value| {
            reads |= found == kind && usize::try_from(value) == Ok(updated);
        });
        if reads {
            findings.at(
                at,
                Rule::Updates,
                "the operand of the update reads the variable that it changes",
            );
            return;
        }
    }
}
