//! What the tests of this crate share: modules that hold everything, and arbitrary ones. None of
//! them need verify.

use arbitrary::{Result, Unstructured};
use obverse_bytecode::{
    ActionKind, Bounds, Constant, Continuation, Depth, ErrorDeclaration, Extent, FaultName,
    Function, FunctionKind, Item, Keyframe, LoopName, Mention, Mentioned, Module, Otherwise,
    Pattern, Perturbation, Recovery, Respond, Reversal, Severity, SourceEntry, SourceFile,
    Variable, Watched,
};
use obverse_isa::{Instr, OPS, Opcode, OperandError, OperandKind, Type};

/// An instruction of an opcode with operands of `next`, which gets the kind and the width in bytes.
pub(crate) fn instr(opcode: Opcode, next: &mut dyn FnMut(OperandKind, usize) -> i64) -> Instr {
    let made: std::result::Result<_, OperandError> =
        Instr::from_operands(opcode, &mut |kind, width| Ok(next(kind, width)));
    made.unwrap_or_else(|error| panic!("{opcode:?}: {error:?}"))
}

/// How many values an operand of a kind and a width can have, from 0.
pub(crate) fn choices(kind: OperandKind, width: usize) -> i64 {
    match kind {
        OperandKind::Level | OperandKind::Setting | OperandKind::Path => 2,
        OperandKind::Frame => 3,
        OperandKind::Speed => 5,
        OperandKind::Axis => 6,
        _ => 1 << (8 * width as u32),
    }
}

/// Every opcode, once with the least operands, once with some, once with the greatest.
pub(crate) fn every_instruction() -> Vec<Instr> {
    let mut code = Vec::new();
    for row in OPS {
        code.push(instr(row.opcode, &mut |_, _| 0));
        code.push(instr(row.opcode, &mut |kind, width| 3 % choices(kind, width)));
        code.push(instr(row.opcode, &mut |kind, width| match kind {
            OperandKind::Integer => -1,
            _ => choices(kind, width) - 1,
        }));
        code.push(instr(row.opcode, &mut |kind, width| match kind {
            OperandKind::Integer => -choices(kind, width) / 2,
            _ => 1,
        }));
    }
    code.dedup();
    code
}

fn variables(names: &[&str]) -> Vec<Variable> {
    let types = Type::ALL.iter().cycle();
    let variable = |(name, of_type): (&&str, &Type)| Variable {
        name: (*name).to_owned(),
        of_type: *of_type,
        measures: (*of_type == Type::Real).then_some([1, 0, -2, i8::MIN]),
    };
    names.iter().zip(types).map(variable).collect()
}

/// A function with a bit of everything.
pub(crate) fn function(name: &str, kind: FunctionKind, first: u32, end: u32) -> Function {
    Function {
        name: name.to_owned(),
        kind,
        parameters: 2,
        locals: variables(&["a", "b", "$hidden", "a", "with space", "\u{1b}[31m", "", "x#1"]),
        counters: 2,
        slots: vec!["initial".to_owned(), "initial".to_owned(), "third one".to_owned()],
        first,
        end,
    }
}

fn strings(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

fn errors() -> Vec<ErrorDeclaration> {
    let within = |limit_m, pattern| Some(Perturbation { limit_m, pattern });
    let reversal = |depth, extent, perturbation, changes: bool| {
        Recovery::Reversing(Reversal {
            depth,
            extent,
            perturbation,
            slower: changes,
            lighter: !changes,
        })
    };
    let recoveries = [
        Recovery::None,
        Recovery::Using(1),
        Recovery::Using(99),
        reversal(Depth::Fixed, Extent::Actions(u32::MAX), None, true),
        reversal(
            Depth::Escalating { doubling: false },
            Extent::Checkpoint(0),
            within(0.001, Pattern::Spiral),
            false,
        ),
        reversal(Depth::Escalating { doubling: true }, Extent::Sequence, None, false),
        reversal(Depth::Learned, Extent::Checkpoint(9), within(-0.0, Pattern::Random), true),
        reversal(Depth::Learned, Extent::Sequence, within(f64::INFINITY, Pattern::Spiral), false),
    ];
    let declaration = |(at, recovery): (usize, Recovery)| ErrorDeclaration {
        name: format!("error {at}"),
        severity: [Severity::Warning, Severity::Recoverable, Severity::Fatal][at % 3],
        faults: FaultName::ALL.into_iter().rev().take(at).collect(),
        watches: [
            Watched::Input { bit: u16::MAX, level: at % 2 == 0 },
            Watched::Force { above_n: f64::NEG_INFINITY },
        ]
        .into_iter()
        .take(at % 3)
        .collect(),
        bounds: Bounds {
            attempts: (at % 2 == 1).then_some(u32::MAX),
            time_s: (at % 3 == 1).then_some(f64::NAN),
            distance_m: (at > 3).then_some(0.25),
        },
        recovery,
        otherwise: [Otherwise::Using(0), Otherwise::Operator, Otherwise::Stop][at % 3],
        respond: [Respond::AtOnce, Respond::AfterAction, Respond::AfterSequence][at % 3],
        continuation: [
            Continuation::Action,
            Continuation::NextAction,
            Continuation::Sequence,
            Continuation::Program,
            Continuation::Stop,
        ][at % 5],
    };
    recoveries.into_iter().enumerate().map(declaration).collect()
}

fn mentions() -> [Mention; 5] {
    let (lamp, part) = ("the \"lamp\"".to_owned(), "part".to_owned());
    [
        Mentioned::Cell,
        Mentioned::Item(1),
        Mentioned::Tool(u16::MAX),
        Mentioned::Output { name: lamp, bit: 2 },
        Mentioned::Input { name: part, bit: 0 },
    ]
    .map(|what| Mention { what, file: 2, start: 1, end: 0 })
}

/// A module with something in every table, and names that are hard to write.
pub(crate) fn everything() -> Module {
    let code = every_instruction();
    let (half, end) = (code.len() as u32 / 2, code.len() as u32);
    let source = "cell \"peg.toml\"\r\n\tmove to start ; not a comment\n\n| bar\n\u{202e}\u{fc}";
    let entry = |first, start, action| SourceEntry { first, file: 0, start, end: start, action };
    Module {
        sources: vec![
            SourceFile { name: "peg in hole.obv".to_owned(), text: source.to_owned() },
            SourceFile { name: String::new(), text: String::new() },
            SourceFile { name: "b".to_owned(), text: "\n".to_owned() },
        ],
        cell: Some("peg \"1\".toml".to_owned()),
        constants: vec![
            Constant::Int(i64::MIN),
            Constant::Int(5),
            Constant::Real(5.0),
            Constant::Real(-0.0),
            Constant::Real(f64::from_bits(0x7ff8_0000_0000_beef)),
            Constant::Real(f64::NEG_INFINITY),
            Constant::Int(5),
        ],
        joints: vec![
            ("start".to_owned(), [3.425, -1.0, 1.2, -1.8, -1.57, 0.3]),
            ("start".to_owned(), [-0.0, 1e-300, f64::MAX, 0.1, 5e-324, 1.0]),
            ("a, b; c".to_owned(), [0.0; 6]),
        ],
        items: vec![
            Item { name: "peg".to_owned(), keyframes: Vec::new() },
            Item {
                name: "hole".to_owned(),
                keyframes: vec![
                    Keyframe { name: 1, position_m: [0.1, 0.2, 0.3], rotation_rad: [0.0; 3] },
                    Keyframe { name: 77, position_m: [1.0; 3], rotation_rad: [-0.0, 2.0, 3.0] },
                ],
            },
        ],
        keyframes: strings(&["grasp", "\u{e9}", "grasp#0"]),
        tools: strings(&["gripper", "7", "#3", "\n"]),
        errors: errors(),
        checkpoints: strings(&["before", "\"quoted\""]),
        reasons: strings(&["the glue is wet", "once", "", "once", &"long ".repeat(50)]),
        globals: variables(&["count", "top", "low", "true", "halt"]),
        functions: vec![
            function("start", FunctionKind::Start, 0, half),
            function("empty", FunctionKind::Replacement, half, half),
            function("start", FunctionKind::AdvancedMove, half, end),
        ],
        cleanup: Some(1),
        code,
        source_map: vec![
            entry(0, 0, None),
            entry(1, 17, Some(ActionKind::Move)),
            entry(1, 1000, Some(ActionKind::Wait)),
            SourceEntry { first: end, file: 9, start: 7, end: 3, action: Some(ActionKind::Io) },
        ],
        mentions: mentions().to_vec(),
        loops: vec![
            LoopName { enter: 7, name: "round \"x\"".to_owned(), is_down: true },
            LoopName { enter: 2, name: "i".to_owned(), is_down: false },
        ],
    }
}

/// Some of what `make` makes.
fn some<T>(
    u: &mut Unstructured,
    most: usize,
    mut make: impl FnMut(&mut Unstructured) -> Result<T>,
) -> Result<Vec<T>> {
    let count = u.int_in_range(0..=most)?;
    (0..count).map(|_| make(u)).collect()
}

fn text(u: &mut Unstructured) -> Result<String> {
    const PLAIN: [&str; 8] = ["a", "b", "grasp", "main", "L3", "high", "", "a b"];
    if u.ratio(3, 4)? { Ok((*u.choose(&PLAIN)?).to_owned()) } else { u.arbitrary() }
}

fn pick<T: Copy>(u: &mut Unstructured, of: &[T]) -> Result<T> {
    u.choose(of).copied()
}

fn index(u: &mut Unstructured) -> Result<u16> {
    if u.ratio(3, 4)? { u.int_in_range(0..=4) } else { u.arbitrary() }
}

fn variable(u: &mut Unstructured) -> Result<Variable> {
    Ok(Variable { name: text(u)?, of_type: pick(u, &Type::ALL)?, measures: u.arbitrary()? })
}

fn arbitrary_error(u: &mut Unstructured) -> Result<ErrorDeclaration> {
    let extents =
        [Extent::Actions(u.arbitrary()?), Extent::Checkpoint(index(u)?), Extent::Sequence];
    let depths = [Depth::Fixed, Depth::Escalating { doubling: u.arbitrary()? }, Depth::Learned];
    let pattern = pick(u, &[Pattern::Spiral, Pattern::Random])?;
    let limit_m: Option<f64> = u.arbitrary()?;
    let reversal = Reversal {
        depth: pick(u, &depths)?,
        extent: pick(u, &extents)?,
        perturbation: limit_m.map(|limit_m| Perturbation { limit_m, pattern }),
        slower: u.arbitrary()?,
        lighter: u.arbitrary()?,
    };
    let using = index(u)?;
    Ok(ErrorDeclaration {
        name: text(u)?,
        severity: pick(u, &[Severity::Warning, Severity::Recoverable, Severity::Fatal])?,
        faults: some(u, 3, |u| pick(u, &FaultName::ALL))?,
        watches: some(u, 3, |u| {
            let input = Watched::Input { bit: u.arbitrary()?, level: u.arbitrary()? };
            let force = Watched::Force { above_n: u.arbitrary()? };
            pick(u, &[input, force])
        })?,
        bounds: Bounds {
            attempts: u.arbitrary()?,
            time_s: u.arbitrary()?,
            distance_m: u.arbitrary()?,
        },
        recovery: match u.int_in_range(0..=2)? {
            0 => Recovery::None,
            1 => Recovery::Using(using),
            _ => Recovery::Reversing(reversal),
        },
        otherwise: pick(u, &[Otherwise::Using(using), Otherwise::Operator, Otherwise::Stop])?,
        respond: pick(u, &[Respond::AtOnce, Respond::AfterAction, Respond::AfterSequence])?,
        continuation: pick(
            u,
            &[
                Continuation::Action,
                Continuation::NextAction,
                Continuation::Sequence,
                Continuation::Program,
                Continuation::Stop,
            ],
        )?,
    })
}

fn arbitrary_instr(u: &mut Unstructured, code: i64) -> Result<Instr> {
    let row = u.choose(OPS)?;
    let is_small: bool = u.ratio(3, 4)?;
    let mut failed = None;
    let made = instr(row.opcode, &mut |kind, width| {
        let drawn = match kind {
            OperandKind::Integer => u.arbitrary::<i16>().map(i64::from),
            _ if is_small => u.int_in_range(0..=choices(kind, width).min(code.max(4)) - 1),
            _ => u.int_in_range(0..=choices(kind, width) - 1),
        };
        drawn.unwrap_or_else(|error| {
            failed = Some(error);
            0
        })
    });
    failed.map_or(Ok(made), Err)
}

/// Functions that cover the code in order, or that do not.
fn functions(u: &mut Unstructured, code: u32) -> Result<Vec<Function>> {
    const KINDS: [FunctionKind; 7] = [
        FunctionKind::Start,
        FunctionKind::Sequence,
        FunctionKind::Action,
        FunctionKind::Io,
        FunctionKind::AdvancedMove,
        FunctionKind::Replacement,
        FunctionKind::Cleanup,
    ];
    let is_regular = u.ratio(3, 4)?;
    let mut next = 0;
    some(u, 4, |u| {
        let first = if is_regular { next } else { u.arbitrary()? };
        next = u.int_in_range(next..=code)?;
        Ok(Function {
            name: text(u)?,
            kind: pick(u, &KINDS)?,
            parameters: if is_regular { u.int_in_range(0..=3)? } else { u.arbitrary()? },
            locals: some(u, 4, variable)?,
            counters: u.arbitrary()?,
            slots: some(u, 2, text)?,
            first,
            end: if is_regular { next } else { u.arbitrary()? },
        })
    })
}

fn arbitrary_map(u: &mut Unstructured, code: u32) -> Result<Vec<SourceEntry>> {
    const KINDS: [ActionKind; 6] = [
        ActionKind::Move,
        ActionKind::Advance,
        ActionKind::Call,
        ActionKind::Io,
        ActionKind::Primitive,
        ActionKind::Wait,
    ];
    let is_sorted = u.ratio(3, 4)?;
    let mut map = some(u, 8, |u| {
        Ok(SourceEntry {
            first: u.int_in_range(0..=code.saturating_add(u32::from(!is_sorted)))?,
            file: index(u)?,
            start: u.int_in_range(0..=20)?,
            end: u.arbitrary()?,
            action: if u.arbitrary()? { Some(pick(u, &KINDS)?) } else { None },
        })
    })?;
    if is_sorted {
        map.sort_by_key(|entry| entry.first);
    }
    Ok(map)
}

/// Any module at all.
pub(crate) fn arbitrary_module(u: &mut Unstructured) -> Result<Module> {
    let length = u.int_in_range(0..=24)?;
    let code = (0..length).map(|_| arbitrary_instr(u, length)).collect::<Result<Vec<_>>>()?;
    let end = code.len() as u32;
    Ok(Module {
        sources: some(u, 2, |u| Ok(SourceFile { name: text(u)?, text: u.arbitrary()? }))?,
        cell: u.arbitrary()?,
        constants: some(u, 4, |u| {
            Ok(if u.arbitrary()? {
                Constant::Int(u.arbitrary()?)
            } else {
                Constant::Real(u.arbitrary()?)
            })
        })?,
        joints: some(u, 3, |u| Ok((text(u)?, u.arbitrary()?)))?,
        items: some(u, 3, |u| {
            let keyframe = |u: &mut Unstructured| {
                Ok(Keyframe {
                    name: index(u)?,
                    position_m: u.arbitrary()?,
                    rotation_rad: u.arbitrary()?,
                })
            };
            Ok(Item { name: text(u)?, keyframes: some(u, 3, keyframe)? })
        })?,
        keyframes: some(u, 4, text)?,
        tools: some(u, 3, text)?,
        errors: some(u, 3, arbitrary_error)?,
        checkpoints: some(u, 3, text)?,
        reasons: some(u, 3, text)?,
        globals: some(u, 4, variable)?,
        functions: functions(u, end)?,
        cleanup: if u.arbitrary()? { Some(index(u)?) } else { None },
        code,
        source_map: arbitrary_map(u, end)?,
        mentions: some(u, 4, |u| {
            let what = u.choose(&mentions())?.what.clone();
            Ok(Mention { what, file: index(u)?, start: u.arbitrary()?, end: u.arbitrary()? })
        })?,
        loops: some(u, 3, |u| {
            Ok(LoopName { enter: u.arbitrary()?, name: text(u)?, is_down: u.arbitrary()? })
        })?,
    })
}
