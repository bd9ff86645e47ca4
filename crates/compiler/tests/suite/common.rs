//! What the tests of the compiler share: compiling with a verified result, code as compact text,
//! diagnostics with their lines.

use obverse_bytecode::{Constant, Function, Module, verify};
use obverse_compiler::compile;
use obverse_isa::{Axis, Frame, Instr, Level, OperandKind, Path, Setting, SpeedId};
use obverse_syntax::source::LineIndex;

/// The module of a program without errors. It is verified.
pub(crate) fn module(source: &str) -> Module {
    let compiled = compile("test.obv", source);
    let found: Vec<String> = findings(source);
    let Some(module) = compiled.module else { panic!("no module of:\n{source}\n{found:#?}") };
    if let Err(errors) = verify(module.clone()) {
        panic!("refused: {errors:#?}\n{}", listing(&module));
    }
    module
}

/// The diagnostics as `CODE line:column "text"`, the text being what the primary place covers.
pub(crate) fn findings(source: &str) -> Vec<String> {
    let index = LineIndex::new(source);
    let diagnostics = compile("test.obv", source).diagnostics;
    diagnostics
        .iter()
        .map(|diagnostic| {
            let span = diagnostic.primary.span;
            let position = index.position(span.start);
            let text = source.get(span.start as usize..span.end as usize).unwrap_or("?");
            format!("{} {}:{} {text:?}", diagnostic.code, position.line, position.column)
        })
        .collect()
}

/// The function of this name.
pub(crate) fn function<'m>(module: &'m Module, name: &str) -> &'m Function {
    let found = module.functions.iter().find(|function| function.name == name);
    found.unwrap_or_else(|| panic!("no function {name}"))
}

/// A function's code, an instruction a line; jumps as distances, prefixes left out.
fn code(module: &Module, name: &str) -> String {
    let function = function(module, name);
    let range = function.first as usize..function.end as usize;
    let lines = range.map(|at| instruction(module, function, at));
    lines.collect::<Vec<_>>().join("\n")
}

/// The code of a function of a program.
pub(crate) fn code_of(source: &str, name: &str) -> String {
    code(&module(source), name)
}

/// All code.
pub(crate) fn listing(module: &Module) -> String {
    let functions = module.functions.iter();
    functions
        .map(|function| format!("{}:\n{}\n", function.name, code(module, &function.name)))
        .collect()
}

fn instruction(module: &Module, function: &Function, at: usize) -> String {
    let instr: Instr = module.code[at];
    let mut text = instr.info().mnemonic.to_owned();
    instr.each_operand(&mut |kind, _, value| {
        let index = value as usize;
        let operand = match kind {
            OperandKind::Prefix => return,
            OperandKind::Label => format!("{:+}", value - at as i64),
            OperandKind::Local => function.locals[index].name.clone(),
            OperandKind::Global => module.globals[index].name.clone(),
            OperandKind::Constant => match module.constants[index] {
                Constant::Int(value) => value.to_string(),
                Constant::Real(value) => format!("{value:?}"),
            },
            OperandKind::Joints => module.joints[index].0.clone(),
            OperandKind::Item => module.items[index].name.clone(),
            OperandKind::Keyframe => module.keyframes[index].clone(),
            OperandKind::Tool => module.tools[index].clone(),
            OperandKind::Error => module.errors[index].name.clone(),
            OperandKind::Checkpoint => module.checkpoints[index].clone(),
            OperandKind::Reason => module.reasons[index].clone(),
            OperandKind::Function => module.functions[index].name.clone(),
            OperandKind::Slot => function.slots[index].clone(),
            OperandKind::Level => Level::ALL[index].name().to_owned(),
            OperandKind::Speed => SpeedId::ALL[index].name().to_owned(),
            OperandKind::Setting => Setting::ALL[index].name().to_owned(),
            OperandKind::Axis => Axis::ALL[index].name().to_owned(),
            OperandKind::Frame => Frame::ALL[index].name().to_owned(),
            OperandKind::Path => Path::ALL[index].name().to_owned(),
            _ => value.to_string(),
        };
        text.push(' ');
        text.push_str(&operand);
    });
    text
}

/// That a function of a program becomes this code.
pub(crate) fn check_code(source: &str, function: &str, expected: &str) {
    assert_eq!(code(&module(source), function), lines(expected));
}

/// Lines with their indentation taken off, for comparison.
fn lines(text: &str) -> String {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join("\n")
}
