//! Checked tree to module: statements with their prefixes, jumps paired with joins, the source map.
//!
//! Functions are lowered one after another into one row of code. What is known of the function in
//! hand is in `frame`; the rest is of the module. Fails at the limits of a module only.

mod errors;
mod expression;
mod flow;
mod fork;
mod frame;
mod function;
mod guarded;
mod kept;
mod leave;
mod start;
mod statement;
mod test;

use crate::effects::Effects;
use crate::report::Reports;
use crate::tree::Program;
use frame::Frame;
use kept::Changed;
use obverse_bytecode::{
    ActionKind, CodeBuilder, Constant, LoopName, Module, SourceEntry, Variable,
};
use obverse_isa::{ConstantId, FunctionId, GlobalId, Instr, LocalId, Type};
use obverse_syntax::codes::Code;
use obverse_syntax::sources::Sources;
use obverse_syntax::span::Span;
use std::collections::HashMap;

/// How many instructions a module has at the most: 32 MiB of them.
const MAX_INSTRUCTIONS: u32 = 1 << 22;

/// The module of a program; none if a limit is reached, which is reported.
pub(crate) fn lower(
    program: Program,
    sources: &Sources,
    effects: &Effects,
    reports: &mut Reports,
) -> Option<Module> {
    let mut lower = Lower::new(&program, sources, effects, reports);
    lower.start();
    for (id, function) in program.numbered() {
        lower.function(id, function);
    }
    let Lower { code, constants, source_map, loops, functions, globals, .. } = lower;
    if reports.has_errors() {
        return None;
    }
    let mut module = program.module;
    module.globals.extend(globals.variables);
    module.constants = constants.values;
    module.code = code.finish();
    module.source_map = source_map;
    module.loops = loops;
    module.functions = functions;
    Some(module)
}

/// What a lowering is under way with.
struct Lower<'p> {
    program: &'p Program,
    sources: &'p Sources,
    effects: &'p Effects,
    reports: &'p mut Reports,
    code: CodeBuilder,
    constants: Constants,
    source_map: Vec<SourceEntry>,
    loops: Vec<LoopName>,
    functions: Vec<obverse_bytecode::Function>,
    globals: HiddenGlobals,
    /// For each block that keeps its order in reverse: what it changes, and where that is kept.
    kept: HashMap<FunctionId, Vec<(Changed, LocalId)>>,
    frame: Frame<'p>,
}

/// The numbers of a module, each once.
#[derive(Default)]
struct Constants {
    values: Vec<Constant>,
    known: HashMap<(Type, u64), u16>,
}

/// The variables that tell callers of what goes on beyond a call.
struct HiddenGlobals {
    variables: Vec<Variable>,
    /// Whether the sequences under way are being left.
    leaving: Option<GlobalId>,
    /// Whether the program begins again once they are.
    restart: Option<GlobalId>,
    /// Whether an error is being recovered from.
    recovering: Option<GlobalId>,
}

impl HiddenGlobals {
    fn of(program: &Program, effects: &Effects) -> Self {
        let mut variables = Vec::new();
        let known = program.module.globals.len();
        let mut add = |is_needed: bool, name: &str| {
            is_needed.then(|| {
                let index = known + variables.len();
                variables.push(Variable {
                    name: name.to_owned(),
                    of_type: Type::Bool,
                    measures: None,
                });
                GlobalId(u16::try_from(index).unwrap_or(u16::MAX))
            })
        };
        let leaving = add(effects.any_leaves(), "$leaving");
        let restart = add(!start::restarting_errors(program, effects).is_empty(), "$restart");
        let recovers = program.numbered().any(|(id, _)| effects.recovers_in_recovery(id));
        let recovering = add(recovers, "$recovering");
        Self { variables, leaving, restart, recovering }
    }
}

impl<'p> Lower<'p> {
    fn new(
        program: &'p Program,
        sources: &'p Sources,
        effects: &'p Effects,
        reports: &'p mut Reports,
    ) -> Self {
        let globals = HiddenGlobals::of(program, effects);
        let global_count = program.module.globals.len() + globals.variables.len();
        let mut lower = Self {
            program,
            sources,
            effects,
            reports,
            code: CodeBuilder::new(),
            constants: Constants::default(),
            source_map: Vec::new(),
            loops: Vec::new(),
            functions: Vec::new(),
            globals,
            kept: HashMap::new(),
            frame: Frame::default(),
        };
        if global_count > usize::from(u16::MAX) {
            lower.too_many("a module has at most 65535 variables, with three for its errors");
        }
        lower
    }

    /// What follows is of this place in the source.
    fn at(&mut self, span: Span, action: Option<ActionKind>) {
        let place = self.sources.locate(span);
        let (first, Span { start, end }) = (self.code.here(), place.span);
        // There are far fewer files than an index can say.
        let file = u16::try_from(place.file).unwrap_or(u16::MAX);
        let entry = SourceEntry { first, file, start, end, action };
        match self.source_map.last_mut() {
            Some(last) if last.first == first => *last = entry,
            Some(last)
                if (last.file, last.start, last.end) == (file, start, end) && action.is_none() => {}
            _ => self.source_map.push(entry),
        }
    }

    /// The constant of this value.
    fn constant(&mut self, value: Constant) -> ConstantId {
        let next = self.constants.values.len();
        let key = (value.of_type(), value.bits());
        if let Some(known) = self.constants.known.get(&key) {
            return ConstantId(*known);
        }
        let Some(index) = u16::try_from(next).ok().filter(|index| *index < u16::MAX) else {
            self.too_many("a module has at most 65535 different numbers");
            return ConstantId(0);
        };
        self.constants.values.push(value);
        self.constants.known.insert(key, index);
        ConstantId(index)
    }

    /// Whether there is room for more instructions; if not, it is reported.
    fn has_room(&mut self) -> bool {
        let has_room = self.code.here() < MAX_INSTRUCTIONS;
        if !has_room {
            self.too_many("a program has at most four million instructions");
        }
        has_room && !self.reports.has_errors()
    }

    /// A limit that has been reached; the first is reported.
    fn too_many(&mut self, message: &str) {
        if !self.reports.has_errors() {
            let span = self.frame.named;
            let at = "reached in this sequence";
            self.reports.error(Code::TooMany, span, message.to_owned(), at);
        }
    }

    fn push(&mut self, instr: Instr) {
        self.code.push(instr);
    }
}
