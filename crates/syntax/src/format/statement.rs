//! Statements as pieces.

use super::piece::{Column, Glue};
use super::writer::{Style, Writer};
use crate::ast::{
    Argument, AssignOperator, Block, Expression, FrameWord, Heading, Primitive, ReverseParameter,
    Signal, SpeedWord, Statement, StatementKind, Target, VariableDeclaration,
};
use crate::span::{Span, Spanned};

impl<'s> Writer<'s> {
    /// A block of statements.
    pub(super) fn block(&mut self, block: &Block<'s>) {
        let is_broken = match block.statements.as_slice() {
            [] => false,
            [one] => has_block(&one.kind),
            _ => true,
        };
        self.body(block, is_broken);
    }

    /// The same, without a source on several lines if so asked.
    pub(super) fn body(&mut self, block: &Block<'s>, is_broken: bool) {
        let style = Style { is_broken, is_table: false };
        self.braces(&block.statements, style, Self::statement);
    }

    /// `depth: 12 mm`, or the value alone.
    fn argument(&mut self, argument: &Argument<'s>) {
        if let Some(name) = argument.name {
            self.text(name.value);
            self.tight(":");
        }
        self.expression(&argument.value);
    }

    fn statement(&mut self, statement: &Statement<'s>) {
        match &statement.kind {
            StatementKind::Move { target, linear, always } => {
                self.motion(target, *linear, *always);
            }
            StatementKind::Advance(name) => self.named("advance", name.value),
            StatementKind::Call { name, arguments } => {
                self.named("call", name.value);
                if !arguments.is_empty() || self.is_next("(") {
                    self.glue(Glue::Tight);
                    self.list(["(", ")"], arguments, Self::argument);
                }
            }
            StatementKind::Io(name) => self.named("io", name.value),
            StatementKind::Wait(time) => {
                self.word("wait");
                self.expression(time);
            }
            StatementKind::WaitUntil { input, high, timeout, otherwise } => {
                self.words(&["wait", "until", "input"]);
                self.signal(input.value);
                self.level(*high);
                self.words(&["for", "up", "to"]);
                self.expression(timeout);
                if let Some(otherwise) = otherwise {
                    self.word("else");
                    self.block(otherwise);
                }
            }
            StatementKind::Primitive(primitive) => self.primitive(primitive),
            StatementKind::Variable(variable) => self.variable(variable),
            StatementKind::Remember(name) => self.named("position", name.value),
            StatementKind::Assign { name, operator, value } => {
                self.text(name.value);
                self.word(match operator {
                    AssignOperator::Set => "=",
                    AssignOperator::Add => "+=",
                    AssignOperator::Subtract => "-=",
                });
                self.expression(value);
            }
            StatementKind::If { .. }
            | StatementKind::While { .. }
            | StatementKind::Repeat { .. }
            | StatementKind::For { .. }
            | StatementKind::Loop(_) => self.control(&statement.kind),
            StatementKind::Fork(branches) => self.fork(branches),
            StatementKind::Break => self.word("break"),
            StatementKind::Return => self.word("return"),
            StatementKind::Speed { speed, block } => {
                self.speed(speed.value);
                self.scope(block.as_ref());
            }
            StatementKind::Tool { name, block } => {
                self.named("tool", name.value);
                self.scope(block.as_ref());
            }
            StatementKind::Checkpoint(name) => self.named("checkpoint", name.value),
            StatementKind::Barrier(_)
            | StatementKind::Irreversible { .. }
            | StatementKind::SkipInReverse(_)
            | StatementKind::ReplaceInReverse { .. }
            | StatementKind::KeepInReverse(_)
            | StatementKind::WithInReverse { .. } => self.reversal(&statement.kind),
            StatementKind::Throw(name) => self.named("throw", name.value),
            StatementKind::Requires { condition, error } => self.requires(condition, Some(error)),
            StatementKind::Allow(allow) => self.allow(allow),
        }
    }

    /// A branch or a loop.
    fn control(&mut self, kind: &StatementKind<'s>) {
        match kind {
            StatementKind::If { condition, then, otherwise, ending_when } => {
                self.branch(condition, then, otherwise.as_ref());
                self.assertion("ending", ending_when.as_ref());
            }
            StatementKind::While { condition, entered_when, body } => {
                self.word("while");
                self.expression(condition);
                self.assertion("entered", entered_when.as_ref());
                self.block(body);
            }
            StatementKind::Repeat { times, body } => {
                self.word("repeat");
                self.expression(times);
                self.word("times");
                self.block(body);
            }
            StatementKind::For { name, first, down, last, body } => {
                self.named("for", name.value);
                self.word("from");
                self.expression(first);
                if *down {
                    self.word("down");
                }
                self.word("to");
                self.expression(last);
                self.block(body);
            }
            StatementKind::Loop(body) => {
                self.word("loop");
                self.block(body);
            }
            _ => {}
        }
    }

    /// Words about reversal.
    fn reversal(&mut self, kind: &StatementKind<'s>) {
        match kind {
            StatementKind::Barrier(reason) => {
                self.word("barrier");
                self.quoted(reason.value);
            }
            StatementKind::Irreversible { reason, block } => {
                self.word("irreversible");
                self.quoted(reason.value);
                self.block(block);
            }
            StatementKind::SkipInReverse(block) => {
                self.words(&["skip", "in", "reverse"]);
                self.block(block);
            }
            StatementKind::ReplaceInReverse { block, replacement } => {
                self.word("do");
                self.block(block);
                self.link();
                self.words(&["in", "reverse"]);
                self.block(replacement);
            }
            StatementKind::KeepInReverse(block) => {
                self.words(&["keep", "in", "reverse"]);
                self.block(block);
            }
            StatementKind::WithInReverse { parameters, block } => {
                self.word("with");
                for (index, parameter) in parameters.iter().enumerate() {
                    if index > 0 {
                        self.tight(",");
                        self.glue(Glue::Break(0));
                    }
                    self.reverse_parameter(&parameter.value);
                }
                self.words(&["in", "reverse"]);
                self.block(block);
            }
            _ => {}
        }
    }

    fn reverse_parameter(&mut self, parameter: &ReverseParameter<'s>) {
        match parameter {
            ReverseParameter::Speed(speed) => self.speed(*speed),
            ReverseParameter::ForceLimit(limit) => {
                self.words(&["force", "limit"]);
                self.expression(limit);
            }
            ReverseParameter::StraightMoves => self.words(&["straight", "moves"]),
        }
    }

    fn fork(&mut self, branches: &[Block<'s>]) {
        self.word("fork");
        for (index, branch) in branches.iter().enumerate() {
            if index > 0 {
                self.link();
                self.word("and");
            }
            self.block(branch);
        }
    }

    fn motion(&mut self, target: &Target<'s>, linear: bool, always: Option<Span>) {
        self.word("move");
        match target {
            Target::Named(name) => self.named("to", name.value),
            Target::Keyframe { item, keyframe } => {
                self.named("to", item.value);
                self.tight(".");
                self.glue(Glue::Tight);
                self.text(keyframe.value);
            }
            Target::Relative { distance, heading, frame } => {
                self.way(distance, heading.value, *frame);
            }
        }
        if linear {
            self.word("linearly");
        }
        if always.is_some() {
            self.column(Column::Reversal);
            self.words(&["reversible", "always"]);
        }
    }

    /// `20 mm up in base`
    pub(super) fn way(
        &mut self,
        distance: &Expression<'s>,
        heading: Heading,
        frame: Option<Spanned<FrameWord>>,
    ) {
        self.product(distance);
        match heading {
            Heading::Forward => self.word("forward"),
            Heading::Backward => self.text("backward"),
            Heading::Left => self.word("left"),
            Heading::Right => self.word("right"),
            Heading::Up => self.word("up"),
            Heading::Down => self.word("down"),
            Heading::X => self.word("x"),
            Heading::Y => self.word("y"),
            Heading::Z => self.word("z"),
            Heading::MinusX => self.minus("x"),
            Heading::MinusY => self.minus("y"),
            Heading::MinusZ => self.minus("z"),
        }
        if let Some(frame) = frame {
            self.word("in");
            self.word(match frame.value {
                FrameWord::Tcp => "tcp",
                FrameWord::ToolMount => "toolmount",
                FrameWord::Base => "base",
            });
        }
    }

    fn minus(&mut self, axis: &'static str) {
        self.word("-");
        self.tight(axis);
    }

    /// `set 0 high`, `toggle 3`, `sleep 0.5 s`
    pub(super) fn primitive(&mut self, primitive: &Primitive<'s>) {
        match primitive {
            Primitive::Set { bit, high, .. } => {
                self.word("set");
                self.signal(bit.value);
                self.level(*high);
            }
            Primitive::Toggle { bit, .. } => {
                self.word("toggle");
                self.signal(bit.value);
            }
            Primitive::Sleep { duration, .. } => {
                self.word("sleep");
                self.expression(duration);
            }
        }
    }

    /// `var x: length = 3 mm`
    pub(super) fn variable(&mut self, variable: &VariableDeclaration<'s>) {
        self.named("var", variable.name.value);
        if let Some(type_name) = variable.type_name {
            self.tight(":");
            self.text(type_name.value);
        }
        self.column(Column::Value);
        self.word("=");
        self.expression(&variable.value);
    }

    /// `speed very slow`
    pub(super) fn speed(&mut self, speed: SpeedWord) {
        self.word("speed");
        self.words(match speed {
            SpeedWord::VerySlow => &["very", "slow"],
            SpeedWord::Slow => &["slow"],
            SpeedWord::Normal => &["normal"],
            SpeedWord::Fast => &["fast"],
            SpeedWord::VeryFast => &["very", "fast"],
        });
    }

    /// A word of the language and a name.
    pub(super) fn named(&mut self, word: &'static str, name: &'s str) {
        self.word(word);
        self.text(name);
    }

    /// A text in quotes.
    pub(super) fn quoted(&mut self, text: &str) {
        self.text(format!("\"{text}\""));
    }

    /// A whole number.
    pub(super) fn index(&mut self, index: Spanned<u64>) {
        self.text(index.value.to_string());
    }

    /// An output or input, by number or by name.
    pub(super) fn signal(&mut self, signal: Signal<'s>) {
        match signal {
            Signal::Number(number) => self.text(number.to_string()),
            Signal::Name(name) => self.text(name),
        }
    }

    fn level(&mut self, high: bool) {
        self.word(if high { "high" } else { "low" });
    }

    /// The block of a setting, if it has one.
    fn scope(&mut self, block: Option<&Block<'s>>) {
        if let Some(block) = block {
            self.block(block);
        }
    }

    /// An `if` and all the links of its chain.
    fn branch(
        &mut self,
        condition: &Expression<'s>,
        then: &Block<'s>,
        otherwise: Option<&Block<'s>>,
    ) {
        self.word("if");
        self.expression(condition);
        self.block(then);
        let Some(otherwise) = otherwise else { return };
        self.link();
        self.word("else");
        match chained(otherwise) {
            Some(StatementKind::If { condition, then, otherwise, .. }) => {
                self.branch(condition, then, otherwise.as_ref());
            }
            _ => self.block(otherwise),
        }
    }

    /// `ending when p`, `entered when p`
    fn assertion(&mut self, word: &'static str, assertion: Option<&Expression<'s>>) {
        if let Some(assertion) = assertion {
            self.glue(Glue::Break(0));
            self.words(&[word, "when"]);
            self.expression(assertion);
        }
    }
}

/// The `if` that a block of an `else if` consists of: one at the place of the block, since it has
/// no braces of its own.
fn chained<'b, 's>(block: &'b Block<'s>) -> Option<&'b StatementKind<'s>> {
    match block.statements.as_slice() {
        [one] if one.span == block.span => {
            let is_link = matches!(one.kind, StatementKind::If { ending_when: None, .. });
            is_link.then_some(&one.kind)
        }
        _ => None,
    }
}

/// Whether a statement has a block in it, and so is not short.
fn has_block(kind: &StatementKind<'_>) -> bool {
    match kind {
        StatementKind::Speed { block, .. } | StatementKind::Tool { block, .. } => block.is_some(),
        StatementKind::WaitUntil { otherwise, .. } => otherwise.is_some(),
        StatementKind::If { .. }
        | StatementKind::While { .. }
        | StatementKind::Repeat { .. }
        | StatementKind::For { .. }
        | StatementKind::Loop(_)
        | StatementKind::Irreversible { .. }
        | StatementKind::SkipInReverse(_)
        | StatementKind::ReplaceInReverse { .. }
        | StatementKind::KeepInReverse(_)
        | StatementKind::WithInReverse { .. }
        | StatementKind::Fork(_) => true,
        StatementKind::Move { .. }
        | StatementKind::Advance(_)
        | StatementKind::Call { .. }
        | StatementKind::Io(_)
        | StatementKind::Wait(_)
        | StatementKind::Primitive(_)
        | StatementKind::Variable(_)
        | StatementKind::Remember(_)
        | StatementKind::Assign { .. }
        | StatementKind::Break
        | StatementKind::Return
        | StatementKind::Checkpoint(_)
        | StatementKind::Barrier(_)
        | StatementKind::Throw(_)
        | StatementKind::Requires { .. }
        | StatementKind::Allow(_) => false,
    }
}
