//! The program as a whole: in which order its parts are checked, and what can be said of it only
//! when all of them have been.

use super::frame::FrameScope;
use super::names::{Found, Meaning, Names};
use super::still::Movers;
use super::{Checker, Interned, Parameter, Signature};
use crate::faults;
use crate::keyframes::KeyframeFlow;
use crate::parameters::{Action, Defaults};
use crate::path;
use crate::reached;
use crate::report::Reports;
use crate::tree;
use crate::types::{TYPE_NAMES, ValueType};
use obverse_bytecode::{Mentioned, Module, SourceFile};
use obverse_isa::{ErrorId, FunctionId, GlobalId, ItemId, JointsId};
use obverse_syntax::ast::{Item, Name, Program, Sequence};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::sources::Sources;
use obverse_syntax::span::Span;
use std::collections::{BTreeSet, HashMap};

/// What became of the check of a program.
pub(crate) struct Checked {
    /// The checked tree; with mistakes it lacks what has them.
    pub(crate) program: Option<tree::Program>,
    /// The actions with their parameters.
    pub(crate) actions: Vec<Action>,
    /// Of which type values are that have a name, by where the name is given.
    pub(crate) types: Vec<(Span, ValueType)>,
    /// What is wrong.
    pub(crate) reports: Reports,
}

/// Check a program. There is a checked tree unless the program has nothing to begin with, or too
/// much of something.
pub(crate) fn check<'s>(
    sources: &'s Sources,
    program: &Program<'s>,
    defaults: &'s Defaults,
    reports: Reports,
) -> Checked {
    let mut checker = Checker::new(sources, defaults, reports);
    checker.declare_items(program);
    checker.check_declarations(program);
    checker.check_bodies(program);
    let main = checker.main(program);
    checker.check_checkpoints();
    let unnamed = checker.warn_of_unused(main);
    let actions = checker.actions(program);
    let types = checker.names.types();
    let flow = std::mem::take(&mut checker.keyframes);
    flow.check(&checker.module, &mut checker.reports);
    let Checker { reports, functions, module, first_values, named_faults, full, .. } = checker;
    let mut reports = reports;
    let can_be_followed =
        full.is_empty() && (reports.has_errors() || functions.iter().all(Option::is_some));
    let absent = |function: Option<_>| function.unwrap_or_else(tree::Function::absent);
    let functions: Vec<tree::Function> = functions.into_iter().map(absent).collect();
    let program = match main {
        Some(main) if can_be_followed => {
            let cleanup = module.cleanup.map(FunctionId);
            let checked = tree::Program { module, first_values, functions, main, cleanup };
            if !reports.has_errors() {
                reached::check(&checked, sources, &unnamed, &mut reports);
                faults::check(&checked, &named_faults, &mut reports);
            }
            Some(checked)
        }
        _ => None,
    };
    Checked { program, actions, types, reports }
}

/// How many functions a module has at the most; replacements and the start are among them.
const MAX_FUNCTIONS: usize = 65_535;

impl<'s> Checker<'s> {
    fn new(sources: &'s Sources, defaults: &'s Defaults, reports: Reports) -> Self {
        let file = |index| SourceFile {
            name: sources.name(index).to_owned(),
            text: sources.text(index).to_owned(),
        };
        let files = (0..sources.len()).map(file).collect();
        Self {
            sources,
            defaults,
            reports,
            names: Names::default(),
            module: Module { sources: files, ..Module::default() },
            interned: Interned::default(),
            signals: HashMap::new(),
            signatures: vec![Signature::default()],
            functions: Vec::new(),
            first_values: Vec::new(),
            wanted_checkpoints: Vec::new(),
            set_checkpoints: BTreeSet::new(),
            named_faults: Vec::new(),
            faults: HashMap::new(),
            keyframes: KeyframeFlow::default(),
            movers: Movers::default(),
            frame: FrameScope::new(FunctionId(0), "", Span::default()),
            full: Vec::new(),
        }
    }

    /// Give every declaration its index and its meaning, so that they can name one another.
    fn declare_items(&mut self, program: &Program<'s>) {
        let mut cell: Option<Span> = None;
        let mut cleanup: Option<Span> = None;
        for item in &program.items {
            match item {
                Item::Cell(file) => {
                    if let Some(first) = cell {
                        self.report_twice("cell", file.span, first);
                    }
                    cell = Some(file.span);
                    self.declare_cell(*file);
                }
                // What it stands for is there in its place.
                Item::Import(_) => {}
                Item::Signal(entry) => self.declare_signal(entry),
                Item::Io(io) => _ = self.declare_function(io.name, Meaning::Io),
                Item::AdvancedMove(guarded) => {
                    _ = self.declare_function(guarded.name, Meaning::Guarded);
                }
                Item::Sequence(sequence) => self.declare_sequence(sequence),
                Item::Cleanup(declared) => {
                    if let Some(first) = cleanup.replace(declared.word) {
                        self.report_twice("cleanup", declared.word, first);
                    }
                    let FunctionId(id) = self.new_function(declared.word);
                    self.module.cleanup = Some(id);
                }
                Item::Allow(_) => {}
                Item::Joints(joints) => {
                    let entries = self.module.joints.len();
                    let id = self.index(entries, "joint configurations", joints.name.span);
                    self.module.joints.push((joints.name.value.to_owned(), [0.0; 6]));
                    self.declare(joints.name, Meaning::Joints(JointsId(id)));
                }
                Item::ItemDeclaration(item) => self.declare_item(item.name),
                Item::Error(error) => self.declare_error(error.name),
                Item::Variable(variable) => {
                    let id = self.index(self.module.globals.len(), "variables", variable.span);
                    self.module.globals.push(obverse_bytecode::Variable {
                        name: variable.name.value.to_owned(),
                        of_type: obverse_isa::Type::Int,
                        measures: None,
                    });
                    self.declare(variable.name, Meaning::Global(GlobalId(id), ValueType::Unknown));
                }
            }
        }
    }

    /// `cell "peg_in_hole.toml"`: relative to the file that it is written in.
    fn declare_cell(&mut self, file: Name<'s>) {
        let importer = self.sources.name(self.sources.locate(file.span).file);
        self.module.cell = Some(path::beside(importer, file.value));
        self.mention(Mentioned::Cell, file.span);
    }

    fn declare_item(&mut self, name: Name<'s>) {
        let id = self.index(self.module.items.len(), "items", name.span);
        let item = obverse_bytecode::Item { name: name.value.to_owned(), keyframes: Vec::new() };
        self.module.items.push(item);
        self.mention(Mentioned::Item(id), name.span);
        self.keyframes.declare(name.span);
        self.declare(name, Meaning::Item(ItemId(id)));
    }

    fn declare_error(&mut self, name: Name<'s>) {
        let id = self.index(self.module.errors.len(), "errors", name.span);
        self.module.errors.push(super::errors::undefined(name.value));
        self.declare(name, Meaning::Error(ErrorId(id)));
    }

    fn declare_sequence(&mut self, sequence: &Sequence<'s>) {
        let kind = if sequence.is_action { Meaning::Action } else { Meaning::Sequence };
        let id = self.declare_function(sequence.name, kind);
        let parameters = sequence.parameters.iter().map(|parameter| {
            let of_type = self.type_named(parameter.type_name);
            Parameter {
                name: parameter.name.value.to_owned(),
                of_type,
                span: parameter.name.span,
                range: None,
                default: None,
                is_left_to_default: false,
            }
        });
        let parameters: Vec<_> = parameters.collect();
        self.signatures[id.index()].parameters = parameters;
    }

    fn declare_function(
        &mut self,
        name: Name<'s>,
        meaning: fn(FunctionId) -> Meaning,
    ) -> FunctionId {
        let id = self.new_function(name.span);
        self.declare(name, meaning(id));
        id
    }

    /// A further function, named here; if there are too many, the start in its place.
    pub(super) fn new_function(&mut self, named: Span) -> FunctionId {
        let entries = self.signatures.len();
        let id = self.index(entries, "sequences, moves and blocks in reverse", named);
        if entries < MAX_FUNCTIONS {
            self.signatures.push(Signature { named, ..Signature::default() });
            self.functions.push(None);
        }
        FunctionId(id)
    }

    /// The type of this name; a mistake is reported.
    pub(super) fn type_named(&mut self, name: Name<'s>) -> ValueType {
        ValueType::of_name(name.value).unwrap_or_else(|| {
            let names = TYPE_NAMES.map(|(name, _)| name);
            let message = format!("there is no type `{}`", name.value);
            let mut diagnostic =
                Diagnostic::error(Code::UnknownType, name.span, message, "not a type")
                    .with_note(format!("the types are {}", names.join(", ")));
            if let Some(meant) = foreign_type(name.value) {
                diagnostic = diagnostic.write_instead(name.span, meant);
            } else if let Some(meant) = self.reports.meant(name.value, names.into_iter()) {
                diagnostic = diagnostic.did_you_mean(name.span, meant);
            }
            self.reports.add(diagnostic);
            ValueType::Unknown
        })
    }

    /// A clause that is there already.
    pub(super) fn report_twice(&mut self, clause: &str, again: Span, first: Span) {
        let message = format!("`{clause}` is written twice");
        let diagnostic =
            Diagnostic::error(Code::DuplicateClause, again, message, "written again here")
                .with_label(first, "the first is here")
                .with_help("leave one of them out");
        self.reports.add(diagnostic);
    }

    fn check_declarations(&mut self, program: &Program<'s>) {
        for item in &program.items {
            match item {
                Item::Joints(joints) => self.check_joints(joints),
                Item::ItemDeclaration(item) => self.check_item(item),
                Item::Variable(variable) => self.check_global(variable),
                Item::Io(io) => self.check_counterpart(io),
                Item::Error(error) => self.check_error(error),
                Item::AdvancedMove(guarded) => self.check_opposite_move(guarded),
                Item::Sequence(sequence) => self.check_parameters(sequence),
                Item::Cell(_)
                | Item::Import(_)
                | Item::Signal(_)
                | Item::Cleanup(_)
                | Item::Allow(_) => {}
            }
        }
    }

    fn check_bodies(&mut self, program: &Program<'s>) {
        self.movers = Movers::of(program, &self.module.errors);
        let declared = u16::try_from(self.signatures.len()).unwrap_or(u16::MAX);
        let mut ids = (1..declared).map(FunctionId);
        for item in &program.items {
            let is_function = matches!(
                item,
                Item::Io(_) | Item::AdvancedMove(_) | Item::Sequence(_) | Item::Cleanup(_)
            );
            let Some(id) = is_function.then(|| ids.next()).flatten() else { continue };
            let function = match item {
                Item::Io(io) => self.check_io(id, io),
                Item::AdvancedMove(guarded) => self.check_guarded(id, guarded),
                Item::Sequence(sequence) => self.check_sequence(id, sequence),
                Item::Cleanup(cleanup) => self.check_cleanup(id, cleanup),
                _ => None,
            };
            if let Some(slot) = self.functions.get_mut(id.index() - 1) {
                *slot = function;
            }
        }
    }

    /// The sequence that the program begins with.
    fn main(&mut self, program: &Program<'s>) -> Option<FunctionId> {
        if let Found::Here(symbol) = self.names.find("main") {
            match symbol.meaning {
                Meaning::Sequence(id) if self.signatures[id.index()].parameters.is_empty() => {
                    return Some(id);
                }
                Meaning::Sequence(_) | Meaning::Action(_) => {
                    let message = "`main` is where the program begins: a sequence without \
                                   parameters"
                        .to_owned();
                    let at = match symbol.meaning {
                        Meaning::Action(_) => "an action",
                        _ => "it has parameters",
                    };
                    self.reports.error(Code::MainParameters, symbol.name.span, message, at);
                    return None;
                }
                _ => {}
            }
        }
        // Of the file that was asked for: what it imports serves other programs as well.
        let sequences = program.items.iter().rev().filter_map(|item| match item {
            Item::Sequence(sequence) if self.is_own(sequence.span) => Some(sequence),
            _ => None,
        });
        let mut candidates =
            sequences.filter(|sequence| !sequence.is_action && sequence.parameters.is_empty());
        if let Some(last) = candidates.next()
            && let Found::Here(symbol) = self.names.find(last.name.value)
            && let Meaning::Sequence(id) = symbol.meaning
        {
            return Some(id);
        }
        self.report_no_main(program);
        None
    }

    fn report_no_main(&mut self, program: &Program<'s>) {
        let end = u32::try_from(self.sources.text(0).trim_end().len()).unwrap_or(u32::MAX);
        let message = "there is no sequence that the program could begin with".to_owned();
        let mut diagnostic = Diagnostic::error(
            Code::NoMain,
            Span::new(end, end),
            message,
            "the file ends without one",
        )
        .with_help("write `sequence main { .. }`");
        if !program.items.is_empty() {
            let why = "a file that others import is checked with the program that imports it";
            diagnostic = diagnostic.with_note(why);
        }
        self.reports.add(diagnostic);
    }

    /// Whether something stands in the file that was asked for, not in one that it imports.
    pub(super) fn is_own(&self, span: Span) -> bool {
        self.sources.locate(span).file == 0
    }

    /// A recovery can only go back to a checkpoint that is set somewhere.
    fn check_checkpoints(&mut self) {
        for wanted in std::mem::take(&mut self.wanted_checkpoints) {
            if self.set_checkpoints.contains(wanted.value) {
                continue;
            }
            let message = format!("the program sets no checkpoint `{}`", wanted.value);
            let mut diagnostic =
                Diagnostic::error(Code::UnknownCheckpoint, wanted.span, message, "set nowhere");
            let known = self.set_checkpoints.iter().copied();
            diagnostic = match self.reports.meant(wanted.value, known) {
                Some(meant) => diagnostic.did_you_mean(wanted.span, meant),
                None => {
                    diagnostic.with_help(format!("write `checkpoint {}` where it is", wanted.value))
                }
            };
            self.reports.add(diagnostic);
        }
    }
}

/// The type that is meant by the name that another language has for it.
fn foreign_type(name: &str) -> Option<&'static str> {
    Some(match name.to_lowercase().as_str() {
        "integer" | "long" | "i64" | "i32" => "int",
        "float" | "double" | "real" | "num" | "f64" | "f32" => "number",
        "boolean" | "flag" => "bool",
        "distance" | "metres" | "meters" | "mm" => "length",
        "duration" | "seconds" => "time",
        "degrees" | "radians" => "angle",
        "newtons" => "force",
        "robtarget" | "jointtarget" | "position" | "pose" | "configuration" => "joints",
        _ => return None,
    })
}
