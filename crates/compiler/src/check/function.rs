//! Functions: sequences and actions, I/O operations, blocks in reverse; and the blocks they are of.

use super::Checker;
use super::frame::FrameScope;
use super::names::Meaning;
use crate::report::warning;
use crate::response::{Response, response};
use crate::tree::{Block, Body, Function, Layout, MAX_SLOTS, Statement, StatementKind};
use crate::types::ValueType;
use obverse_bytecode::{Continuation, ErrorDeclaration, FunctionKind, Recovery, Severity};
use obverse_isa::{FunctionId, LocalId, Type};
use obverse_syntax::ast::{self, IoOperation, Name, Sequence};
use obverse_syntax::codes::Code;
use obverse_syntax::span::Span;

impl<'s> Checker<'s> {
    /// `sequence main { … }`, `action pick(part: item) { … }`
    pub(super) fn check_sequence(
        &mut self,
        id: FunctionId,
        sequence: &Sequence<'s>,
    ) -> Option<Function> {
        let kind = if sequence.is_action { FunctionKind::Action } else { FunctionKind::Sequence };
        let check = |checker: &mut Self| {
            checker.declare_parameters(id, sequence);
            let mut statements = checker.require_ranges(id);
            let mut body = checker.block(&sequence.body);
            statements.append(&mut body.statements);
            Body::Block(Block { statements, ..body })
        };
        Some(self.function(id, sequence.name, kind, check))
    }

    fn declare_parameters(&mut self, id: FunctionId, sequence: &Sequence<'s>) {
        let signature = &self.signatures[id.index()];
        let types: Vec<_> = signature.parameters.iter().map(|known| known.of_type).collect();
        for (parameter, of_type) in sequence.parameters.iter().zip(types) {
            self.check_passable(parameter.type_name, of_type);
            self.declare_local(parameter.name, of_type);
            self.names.mark_parameter(parameter.name.value);
        }
        match u8::try_from(sequence.parameters.len()) {
            Ok(parameters) => self.frame.layout.parameters = parameters,
            Err(_) => {
                let message = "a sequence has at most 255 parameters".to_owned();
                let at = "this one has more";
                self.reports.error(Code::TooMany, sequence.name.span, message, at);
            }
        }
    }

    /// A parameter of a type that has no values could never be given one.
    fn check_passable(&mut self, type_name: Name<'s>, of_type: ValueType) {
        let missing = match of_type {
            // It may be among what the parser has left out.
            _ if !self.reports.is_whole() => return,
            ValueType::Item if self.module.items.is_empty() => "item",
            ValueType::Joints if self.module.joints.is_empty() => "joint configuration",
            _ => return,
        };
        let message = format!("the file declares no {missing} that could be passed here");
        self.reports.error(Code::UnknownType, type_name.span, message, "a type without values");
    }

    /// `cleanup { … }`
    pub(super) fn check_cleanup(
        &mut self,
        id: FunctionId,
        cleanup: &ast::Cleanup<'s>,
    ) -> Option<Function> {
        let name = Name::new("cleanup", cleanup.word);
        let check = |checker: &mut Self| Body::Block(checker.block(&cleanup.body));
        Some(self.function(id, name, FunctionKind::Cleanup, check))
    }

    /// `io gripper_open { set 0 low; sleep 0.5 s }`
    pub(super) fn check_io(&mut self, id: FunctionId, io: &IoOperation<'s>) -> Option<Function> {
        let check = |checker: &mut Self| {
            let mut statements: Vec<Statement> = Vec::new();
            for primitive in &io.primitives {
                checker.frame.begin_statement();
                let statement = checker.primitive(primitive, statements.last_mut());
                statements.extend(statement);
            }
            Body::Block(Block { statements, falls_through: true, end: last_byte(io.span) })
        };
        Some(self.function(id, io.name, FunctionKind::Io, check))
    }

    /// The block after `in reverse`, as a function of its own.
    pub(super) fn replacement(&mut self, block: &ast::Block<'s>, span: Span) -> FunctionId {
        let id = self.new_function(span);
        let name = self.name_in_reverse();
        let (layout, counters) = (self.frame.layout.clone(), self.frame.counters);
        let around = self.frame.function;
        let outer = self.enter_function(id, &name, span);
        self.share_frame(around, layout, counters, span);
        let body = Body::Block(self.block(block));
        let function = self.leave_function(outer, FunctionKind::Replacement, span, body);
        self.keep_function(id, function);
        id
    }

    /// A block that is run in reverse begins with the frame around it.
    fn share_frame(&mut self, around: FunctionId, layout: Layout, counters: u8, span: Span) {
        for (local, variable) in (0..=u8::MAX).map(LocalId).zip(&layout.locals) {
            if variable.of_type == Type::Item {
                self.keyframes.pass((around, local), (self.frame.function, local));
            }
        }
        match u8::try_from(layout.locals.len()) {
            Ok(parameters) => self.frame.layout = Layout { parameters, counters, ..layout },
            Err(_) => self.report_full(span),
        }
        self.frame.counters = counters;
    }

    /// The name of a further block that is run in reverse.
    pub(super) fn name_in_reverse(&mut self) -> String {
        let name = format!("{}$reverse{}", self.frame.name, self.frame.replacements);
        self.frame.replacements += 1;
        name
    }

    /// Keep a block that is run in reverse with the functions.
    pub(super) fn keep_function(&mut self, id: FunctionId, function: Function) {
        if let Some(slot) = id.index().checked_sub(1).and_then(|at| self.functions.get_mut(at)) {
            *slot = Some(function);
        }
    }

    /// A function whose body is checked by `check`.
    pub(super) fn function(
        &mut self,
        id: FunctionId,
        name: Name<'s>,
        kind: FunctionKind,
        check: impl FnOnce(&mut Self) -> Body,
    ) -> Function {
        let outer = self.enter_function(id, name.value, name.span);
        let body = check(self);
        self.leave_function(outer, kind, name.span, body)
    }

    fn enter_function(&mut self, id: FunctionId, name: &str, named: Span) -> Outer {
        let frame = std::mem::replace(&mut self.frame, FrameScope::new(id, name, named));
        Outer { frame, names: self.names.open_frame(), scope: self.names.open() }
    }

    fn leave_function(
        &mut self,
        outer: Outer,
        kind: FunctionKind,
        named: Span,
        body: Body,
    ) -> Function {
        if self.frame.layout.slots() > MAX_SLOTS {
            self.report_full(named);
        }
        self.names.close(&outer.scope);
        self.names.close_frame(&outer.names);
        let inner = std::mem::replace(&mut self.frame, outer.frame);
        let (name, layout, modal) = (inner.name, inner.layout, inner.modal);
        Function { name, kind, named, layout, modal, kept: None, body }
    }

    /// Statements in braces; those that are never reached are checked, warned about and left out.
    pub(super) fn block(&mut self, block: &ast::Block<'s>) -> Block {
        let scope = self.names.open();
        let was_dead = self.frame.is_dead;
        let mut checked =
            Block { statements: Vec::new(), falls_through: true, end: last_byte(block.span) };
        let mut unreached: Option<Span> = None;
        for written in &block.statements {
            if !checked.falls_through && written.allow().is_none() {
                self.frame.is_dead = true;
                unreached = unreached.or(Some(written.span));
            }
            self.frame.begin_statement();
            let before = if unreached.is_none() { checked.statements.last_mut() } else { None };
            let statement = self.statement(written, before);
            if let Some((statement, falls_through)) = statement
                && unreached.is_none()
            {
                checked.statements.push(statement);
                checked.falls_through = falls_through;
            }
        }
        self.frame.is_dead = was_dead;
        self.names.close(&scope);
        if let (Some(unreached), false) = (unreached, was_dead) {
            self.warn_unreached(unreached, &checked);
        }
        checked
    }

    fn warn_unreached(&mut self, unreached: Span, block: &Block) {
        let message = "this and what follows it in the block is never reached";
        let diagnostic = warning(Code::Unreachable, unreached, message, "never reached");
        self.reports.add(match block.statements.last() {
            Some(last) => {
                let (why, help) = self.why_it_ends(&last.kind);
                diagnostic.with_label(last.span, why).with_help(help)
            }
            None => diagnostic.with_help("leave it out"),
        });
    }

    /// What happens in place of the next statement, and what to do about that.
    fn why_it_ends(&self, last: &StatementKind) -> (&'static str, &'static str) {
        let leave_out = "leave it out";
        match last {
            StatementKind::Return => ("the sequence ends here", leave_out),
            StatementKind::Break => ("the loop is left here", leave_out),
            StatementKind::Loop(_) => {
                let help = "leave it out, or leave the loop by `break`";
                ("no `break` leads out of this loop", help)
            }
            StatementKind::Throw(error) => {
                let declared = self.module.errors.get(error.index());
                let why = declared.map_or("an error is raised here", after_throw);
                match declared.map(response) {
                    Some(Response::Recover { .. }) => {
                        (why, "leave it out, or let the error say `then continue`")
                    }
                    _ => (why, leave_out),
                }
            }
            _ => ("no way through this leads on", leave_out),
        }
    }

    /// What stands before a block.
    pub(super) fn header(&self, start: u32, block: Span) -> Span {
        let text =
            self.sources.whole().get(start as usize..block.start as usize).unwrap_or_default();
        let length = u32::try_from(text.trim_end().len()).unwrap_or(0);
        Span::new(start, start + length)
    }

    /// The parameter of the function in hand that a local is.
    pub(super) fn parameter(&self, local: LocalId) -> crate::keyframes::Parameter {
        (self.frame.function, local)
    }

    /// What is called as a sequence.
    pub(super) fn callee(&mut self, name: Name<'s>) -> Option<FunctionId> {
        let is_callable = |meaning| matches!(meaning, Meaning::Sequence(_) | Meaning::Action(_));
        match self.resolve(name, "a sequence", is_callable)? {
            Meaning::Sequence(id) | Meaning::Action(id) => Some(id),
            _ => None,
        }
    }
}

/// What a `throw` leads to, where that is not the next statement.
fn after_throw(error: &ErrorDeclaration) -> &'static str {
    match response(error) {
        _ if error.severity == Severity::Fatal => "the program stops here",
        _ if matches!(error.recovery, Recovery::Reversing(_)) => {
            "from here the program goes back, and on again from there"
        }
        Response::Recover { then: Continuation::Action, .. } => {
            "once recovered from, this is thrown again: it is the action that failed"
        }
        Response::Recover { then: Continuation::Sequence, .. } => {
            "once this is recovered from, the sequence begins again"
        }
        Response::Recover { then: Continuation::Program, .. } => {
            "once this is recovered from, the program begins again"
        }
        Response::Recover { .. } | Response::Stop | Response::Ignore => "the program stops here",
    }
}

/// What stood around a function while it was checked.
struct Outer {
    frame: FrameScope,
    names: super::names::OuterFrame,
    scope: super::names::Scope,
}

/// The closing brace.
pub(super) fn last_byte(span: Span) -> Span {
    Span::new(span.end.saturating_sub(1).max(span.start), span.end)
}
