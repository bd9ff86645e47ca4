//! Syntax tree to checked tree: names, types, units, structure.
//!
//! Declarations come first, in an order that lets each see what it needs; then the bodies. Nothing
//! is reported twice: what has a mistake is of unknown type, which says nothing more.

mod control;
mod declarations;
mod errors;
mod expression;
mod fork;
mod frame;
mod function;
mod guarded;
mod incident;
mod levels;
mod motion;
mod names;
mod operators;
mod parameters;
mod program;
mod raise;
mod reverse;
mod signals;
mod statement;
mod still;
mod unused;

use crate::faults::NamedFault;
use crate::keyframes::KeyframeFlow;
use crate::parameters::Defaults;
use crate::report::Reports;
use crate::tree::{Expression, Function, MAX_SLOTS};
use crate::types::ValueType;
use frame::FrameScope;
use names::{Found, Meaning, Names};
use obverse_bytecode::Module;
use obverse_isa::{FunctionId, LocalId, Type};
use obverse_syntax::ast::{FaultWord, Name, SignalKind};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::sources::Sources;
use obverse_syntax::span::Span;
use obverse_syntax::value_elsewhere;
use parameters::Range;
use std::collections::{BTreeSet, HashMap};
use still::Movers;

pub(crate) use operators::FUNCTIONS;
pub(crate) use program::{Checked, check};

/// More names than these are not listed where none of them is near the one that is written.
const MAX_LISTED: usize = 6;

/// What is needed where an expression names something, in words.
const A_VALUE: &str = "a value";

/// What a caller knows of a function.
#[derive(Clone, Debug, Default)]
struct Signature {
    named: Span,
    parameters: Vec<Parameter>,
    counterpart: Option<FunctionId>,
}

/// A parameter of a function.
#[derive(Clone, Debug)]
struct Parameter {
    name: String,
    of_type: ValueType,
    span: Span,
    range: Option<Range>,
    default: Option<Expression>,
    /// Whether some call leaves it to its default.
    is_left_to_default: bool,
}

/// The tables whose entries come into being when they are named.
#[derive(Debug, Default)]
struct Interned<'s> {
    keyframes: HashMap<&'s str, u16>,
    tools: HashMap<&'s str, u16>,
    checkpoints: HashMap<&'s str, u16>,
    reasons: HashMap<String, u16>,
}

/// What has been found out so far.
struct Checker<'s> {
    sources: &'s Sources,
    /// What is put in the place of defaults.
    defaults: &'s Defaults,
    reports: Reports,
    names: Names<'s>,
    module: Module,
    interned: Interned<'s>,
    /// The names of outputs and inputs, by number.
    signals: HashMap<(SignalKind, u16), Name<'s>>,
    /// By function; the start has none.
    signatures: Vec<Signature>,
    /// By function; those of replacements come at the end.
    functions: Vec<Option<Function>>,
    first_values: Vec<Expression>,
    wanted_checkpoints: Vec<Name<'s>>,
    set_checkpoints: BTreeSet<&'s str>,
    /// Where each fault is named first.
    faults: HashMap<FaultWord, Span>,
    named_faults: Vec<NamedFault>,
    keyframes: KeyframeFlow,
    movers: Movers<'s>,
    frame: FrameScope,
    /// The kinds of thing there are too many of, so that each is reported once.
    full: Vec<&'static str>,
}

impl<'s> Checker<'s> {
    /// The index of a further entry of a table that has so many: 65535 at the most.
    fn index(&mut self, entries: usize, what: &'static str, span: Span) -> u16 {
        u16::try_from(entries).ok().filter(|index| *index < u16::MAX).unwrap_or_else(|| {
            if !self.full.contains(&what) {
                self.full.push(what);
                let message = format!("a module has at most 65535 {what}");
                self.reports.error(Code::TooMany, span, message, "this one is too many");
            }
            0
        })
    }

    /// Declare a name, and report that it has a meaning already.
    fn declare(&mut self, name: Name<'s>, meaning: Meaning) {
        let before = self.names.find(name.value);
        // What is meant by a use of it is not known, so that neither is called unused.
        self.names.mark_used(name.value);
        let is_again = !matches!(before, Found::Nothing);
        // Of which type it is meant to be is not known.
        let meaning = if is_again { meaning.of_unknown_type() } else { meaning };
        if let Some(first) = self.names.declare(name, meaning) {
            let kind = match before {
                Found::Here(symbol) | Found::Outside(symbol) => symbol.meaning.kind(),
                Found::Nothing => "a thing",
            };
            let message = format!("the name `{}` is given twice", name.value);
            let diagnostic =
                Diagnostic::error(Code::DuplicateName, name.span, message, "given again here")
                    .with_label(first, format!("it is {kind} already, named here"))
                    .with_help("give one of them another name");
            self.reports.add(diagnostic);
            self.names.mark_used(name.value);
        }
    }

    /// What a name means where `wanted` is needed; a mistake is reported. The name is then used.
    fn resolve(
        &mut self,
        name: Name<'s>,
        needed: &str,
        wanted: fn(Meaning) -> bool,
    ) -> Option<Meaning> {
        match self.names.find(name.value) {
            Found::Here(symbol) | Found::Outside(symbol) => {
                self.names.mark_used(name.value);
                if wanted(symbol.meaning) {
                    return Some(symbol.meaning);
                }
                let (kind, place) = (symbol.meaning.kind(), symbol.name.span);
                self.report_wrong_kind(name, kind, place, needed, symbol.meaning);
            }
            Found::Nothing => self.report_unknown(name, needed, wanted),
        }
        None
    }

    fn report_wrong_kind(
        &mut self,
        name: Name<'s>,
        kind: &str,
        declared: Span,
        needed: &str,
        meaning: Meaning,
    ) {
        let message = format!("`{}` is {kind}, and {needed} is needed here", name.value);
        let mut diagnostic =
            Diagnostic::error(Code::WrongKind, name.span, message, format!("not {needed}"))
                .with_label(declared, format!("{kind}, declared here"));
        if let Some(usual) = meaning.use_of(name.value) {
            diagnostic = diagnostic.with_help(format!("{kind} is used by {usual}"));
        }
        self.reports.add(diagnostic);
    }

    /// A name of the sequence around that a block in reverse would change.
    fn report_outer(&mut self, name: Name<'s>, declared: Span) {
        self.names.mark_used(name.value);
        let message = format!(
            "`{}` is of the sequence around, and a block that is run in reverse does not change it",
            name.value
        );
        let at = "changed here";
        let diagnostic = Diagnostic::error(Code::OuterVariableInReverse, name.span, message, at)
            .with_label(declared, "declared in the sequence")
            .with_help("the block may read it; what it changes, declare within the block");
        self.reports.add(diagnostic);
    }

    fn report_unknown(&mut self, name: Name<'s>, needed: &str, wanted: fn(Meaning) -> bool) {
        let message = format!("there is no `{}`; {needed} is needed here", name.value);
        let mut diagnostic =
            Diagnostic::error(Code::UnknownName, name.span, message, "declared nowhere");
        let meant = self.reports.meant(name.value, self.names.candidates(wanted));
        let small = name.value.to_lowercase();
        if needed == A_VALUE && matches!(small.as_str(), "true" | "false" | "holding") {
            diagnostic = diagnostic.write_instead(name.span, &small);
        } else if let Some(meant) = meant {
            diagnostic = diagnostic.did_you_mean(name.span, meant);
            self.names.mark_used(meant);
        } else if let Some(help) = value_elsewhere(name.value).filter(|_| needed == A_VALUE) {
            diagnostic = diagnostic.with_help(help);
        } else if !self.reports.is_full() {
            let there = self.names.candidates(wanted).take(MAX_LISTED + 1);
            let there: Vec<String> = there.map(|name| format!("`{name}`")).collect();
            if (1..=MAX_LISTED).contains(&there.len()) {
                let verb = if there.len() == 1 { "is" } else { "are" };
                diagnostic = diagnostic.with_note(format!("there {verb} {}", there.join(", ")));
            }
        }
        self.reports.add_unknown(name.value, diagnostic);
    }

    /// An assignment to a name that nothing has: a variable that was not declared, or a setting.
    fn report_undeclared(&mut self, name: Name<'s>) {
        let message = format!("there is no `{}`; a variable is needed here", name.value);
        let diagnostic =
            Diagnostic::error(Code::UnknownName, name.span, message, "declared nowhere");
        let meant = self.reports.meant(name.value, self.names.candidates(is_variable));
        let diagnostic = match (name.value, meant) {
            ("speed", _) => diagnostic.with_help("a speed is set without `=`: `speed slow`"),
            ("tool", _) => diagnostic.with_help("a tool is set without `=`: `tool NAME`"),
            (_, Some(meant)) => {
                self.names.mark_used(meant);
                diagnostic.did_you_mean(name.span, meant)
            }
            (_, None) => {
                let at = Span::new(name.span.start, name.span.start);
                diagnostic
                    .with_help(format!(
                        "declare it where it is first set: `var {} = ..`",
                        name.value
                    ))
                    .replacing(at, "var ")
            }
        };
        self.reports.add_unknown(name.value, diagnostic);
    }

    /// A local that there may be no room for.
    fn room_for(&mut self, local: Option<LocalId>, span: Span) -> LocalId {
        local.unwrap_or_else(|| {
            self.report_full(span);
            LocalId(0)
        })
    }

    /// A frame that is too small, once.
    fn report_full(&mut self, span: Span) {
        if std::mem::replace(&mut self.frame.is_full, true) {
            return;
        }
        let message = format!(
            "a sequence has room for {MAX_SLOTS} variables, hidden ones among them; the counter of \
             a loop counts as three"
        );
        let diagnostic = Diagnostic::error(Code::TooMany, span, message, "this needs one too many")
            .with_help("name a sequence for a part of it and call that");
        self.reports.add(diagnostic);
    }

    /// A hidden local for the statement in hand.
    fn temporary(&mut self, of_type: Type, span: Span) -> LocalId {
        let local = self.frame.temporary(of_type);
        self.room_for(local, span)
    }

    /// A hidden local until it is given back.
    fn hidden(&mut self, name: &str, of_type: Type, span: Span) -> LocalId {
        let local = self.frame.hidden(name, of_type);
        self.room_for(local, span)
    }
}

fn is_variable(meaning: Meaning) -> bool {
    matches!(meaning, Meaning::Global(..) | Meaning::Local(..))
}
