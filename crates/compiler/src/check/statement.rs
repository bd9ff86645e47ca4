//! Statements but for motions: what each needs, and whether what follows it is reached.

use super::Checker;
use super::expression::{MAX_COMPUTED, Need};
use super::frame::{Around, NamedPosition};
use super::names::{Found, Meaning, Symbol};
use super::operators::binary;
use crate::tree::{
    Block, Expression, ExpressionKind, Place, SettingValue, Statement, StatementKind,
};
use crate::types::ValueType;
use obverse_bytecode::Mentioned;
use obverse_isa::{Instr, Level, LocalId, ReasonId, SlotId, SpeedId, ToolId, Type};
use obverse_syntax::ast::{self, AssignOperator, Name, Primitive, Signal, SpeedWord};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::{Span, Spanned};

/// How large a settling time may become by adding up `sleep`s; further ones are waited for.
const MAX_SETTLE: usize = 20;

/// A statement, and whether what follows it is reached; none if it has a mistake.
pub(super) type Checked = Option<(Statement, bool)>;

impl<'s> Checker<'s> {
    /// Any statement; `before` is the one before it in the same block.
    pub(super) fn statement(
        &mut self,
        written: &ast::Statement<'s>,
        before: Option<&mut Statement>,
    ) -> Checked {
        use ast::StatementKind as Written;
        let span = written.span;
        let kind = match &written.kind {
            Written::Move { target, linear, always } => {
                self.motion(target, *linear, *always, span)?
            }
            Written::Advance(name) => self.advance(*name, span)?,
            Written::Call { name, arguments } => self.call(*name, arguments, span)?,
            Written::Io(name) => self.io(*name)?,
            Written::Wait(time) => StatementKind::Wait(self.duration(time, "`wait`")),
            Written::WaitUntil { input, high, timeout, otherwise } => {
                return self.wait_until(*input, *high, timeout, otherwise.as_ref(), span);
            }
            Written::Primitive(primitive) => {
                return self.primitive(primitive, before).map(|statement| (statement, true));
            }
            Written::Variable(declaration) => self.variable(declaration),
            Written::Remember(name) => self.remember(*name)?,
            Written::Assign { name, operator, value } => self.assign(*name, *operator, value)?,
            Written::If { .. }
            | Written::While { .. }
            | Written::Repeat { .. }
            | Written::For { .. }
            | Written::Loop(_) => return self.control(written),
            Written::Fork(branches) => return self.fork(branches, span.start),
            Written::Break => return self.leave_loop(span),
            Written::Return => return self.leave_sequence(span),
            Written::Speed { speed, block } => {
                return self.setting(speed_setting(*speed), block.as_ref(), span);
            }
            Written::Tool { name, block } => {
                let tool = self.tool(*name);
                return self.setting(SettingValue::Tool(tool), block.as_ref(), span);
            }
            Written::Checkpoint(name) => {
                self.set_checkpoints.insert(name.value);
                StatementKind::Checkpoint(self.checkpoint(*name))
            }
            Written::Barrier(reason) => StatementKind::Barrier(self.reason(*reason)),
            Written::Irreversible { .. }
            | Written::SkipInReverse(_)
            | Written::ReplaceInReverse { .. }
            | Written::KeepInReverse(_) => return Some(self.block_with_reverse(written)),
            Written::WithInReverse { parameters, block } => {
                return self.with_in_reverse(parameters, block, span);
            }
            Written::Throw(name) => return self.throw(*name, span),
            Written::Requires { condition, error } => self.requires(condition, *error, span)?,
            // What it says has been heard before.
            Written::Allow(_) => return None,
        };
        Some((self.done(kind, span), true))
    }

    /// A statement with what its expressions read before it.
    pub(super) fn done(&mut self, kind: StatementKind, span: Span) -> Statement {
        Statement { hoists: self.frame.take_hoists(), kind, span }
    }

    /// The position named last is not known after this.
    pub(super) fn lose_position(&mut self, why: &'static str, span: Span) {
        self.frame.named = NamedPosition::Lost(why, span);
    }

    /// Two ways come together after this, of which the other one ends here.
    pub(super) fn join_position(&mut self, other: NamedPosition, span: Span) {
        if self.frame.named != other {
            self.lose_position("two ways join after this", span);
        }
    }

    fn advance(&mut self, name: Name<'s>, span: Span) -> Option<StatementKind> {
        let is_guarded = |meaning| matches!(meaning, Meaning::Guarded(_));
        self.lose_position("this advanced move ends where it ends", span);
        match self.resolve(name, "an advanced move", is_guarded)? {
            Meaning::Guarded(id) => {
                Some(StatementKind::Advance(id, self.signatures[id.index()].counterpart))
            }
            _ => None,
        }
    }

    fn call(
        &mut self,
        name: Name<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<StatementKind> {
        if self.movers.may_move_in(name.value) {
            self.lose_position("what is called here may move the arm", span);
        }
        let Some(callee) = self.callee(name) else {
            arguments.iter().for_each(|argument| _ = self.any_value(&argument.value));
            return None;
        };
        let values = self.bind(name, callee, arguments, span)?;
        let mut computed = 0;
        for (index, value) in values.iter().enumerate() {
            computed += value.size().0;
            let to = (callee, LocalId(u8::try_from(index).unwrap_or(u8::MAX)));
            match value.kind {
                ExpressionKind::Item(item) => self.keyframes.give(item, to, value.span),
                ExpressionKind::Local(local) if value.of_type == ValueType::Item => {
                    self.keyframes.pass(self.parameter(local), to);
                }
                _ => {}
            }
        }
        if computed > MAX_COMPUTED || values.len() > super::expression::MAX_HELD {
            self.report_too_large(span, computed, values.len());
            return None;
        }
        Some(StatementKind::Call(callee, values))
    }

    fn io(&mut self, name: Name<'s>) -> Option<StatementKind> {
        let is_io = |meaning| matches!(meaning, Meaning::Io(_));
        match self.resolve(name, "an I/O operation", is_io)? {
            Meaning::Io(id) => Some(StatementKind::Io(id, self.signatures[id.index()].counterpart)),
            _ => None,
        }
    }

    /// A time that is not negative.
    pub(super) fn duration(&mut self, written: &ast::Expression<'s>, what: &str) -> Expression {
        let value = self.value(written, &Need::new(ValueType::TIME, what));
        if matches!(value.kind, ExpressionKind::Real(seconds) if seconds < 0.0) {
            let message = "a time to wait is not negative".to_owned();
            self.reports.error(Code::OutOfRange, written.span, message, "negative");
        }
        value
    }

    fn wait_until(
        &mut self,
        input: Spanned<Signal<'s>>,
        high: bool,
        timeout: &ast::Expression<'s>,
        otherwise: Option<&ast::Block<'s>>,
        span: Span,
    ) -> Checked {
        let bit = self.input(input);
        let header = Span::new(span.start, timeout.span.end);
        let timeout = self.duration(timeout, "`wait until`");
        let came = self.temporary(Type::Bool, header);
        let hoists = self.frame.take_hoists();
        let otherwise = otherwise.map(|block| {
            let named = self.frame.named;
            let block = self.block(block);
            match block.falls_through {
                true => self.join_position(named, header),
                false => self.frame.named = named,
            }
            block
        });
        let kind = StatementKind::WaitInput { bit, level: level(high), timeout, came, otherwise };
        Some((Statement { hoists, kind, span: header }, true))
    }

    /// A primitive; `sleep` right after an output is its settling time, and no statement.
    pub(super) fn primitive(
        &mut self,
        written: &Primitive<'s>,
        before: Option<&mut Statement>,
    ) -> Option<Statement> {
        let output = |checker: &mut Self, bit, level, span| {
            let bit = checker.output(bit);
            let settle = Expression::real(0.0, ValueType::TIME, span);
            Some(checker.done(StatementKind::Output { bit, level, settle }, span))
        };
        match written {
            Primitive::Set { bit, high, span } => output(self, *bit, Some(level(*high)), *span),
            Primitive::Toggle { bit, span } => output(self, *bit, None, *span),
            Primitive::Sleep { duration, span } => {
                let time = self.duration(duration, "`sleep`");
                let statement = self.done(StatementKind::Wait(time), *span);
                match before {
                    Some(before) => settle(before, statement),
                    None => Some(statement),
                }
            }
        }
    }

    fn variable(&mut self, declaration: &ast::VariableDeclaration<'s>) -> StatementKind {
        let value = self.any_value(&declaration.value);
        let value = self.first_value(declaration, value);
        match self.declare_local(declaration.name, value.of_type) {
            Meaning::Local(local, _) => StatementKind::Store(Place::Local(local), value),
            _ => StatementKind::Store(Place::Local(LocalId(0)), value),
        }
    }

    fn remember(&mut self, name: Name<'s>) -> Option<StatementKind> {
        match self.names.find(name.value) {
            Found::Here(Symbol { meaning: Meaning::Position(slot), name: first, .. }) => {
                if slot.index() < self.frame.kept_positions {
                    self.report_outer(name, first.span);
                    return None;
                }
                return Some(StatementKind::Remember(slot));
            }
            Found::Outside(Symbol { meaning: Meaning::Position(_), name: first, .. }) => {
                self.report_outer(name, first.span);
                return None;
            }
            _ => {}
        }
        let Ok(slot) = u8::try_from(self.frame.layout.slots.len()) else {
            let message = "a sequence remembers at most 256 positions".to_owned();
            self.reports.error(Code::TooMany, name.span, message, "one too many");
            return None;
        };
        self.frame.layout.slots.push(name.value.to_owned());
        self.declare(name, Meaning::Position(SlotId(slot)));
        Some(StatementKind::Remember(SlotId(slot)))
    }

    fn assign(
        &mut self,
        name: Name<'s>,
        operator: AssignOperator,
        written: &ast::Expression<'s>,
    ) -> Option<StatementKind> {
        if self.is_output_assigned(name, written) {
            return None;
        }
        let Some((place, of_type)) = self.assigned(name) else {
            // `speed = slow` is one mistake.
            if !matches!(name.value, "speed" | "tool") {
                self.any_value(written);
            }
            return None;
        };
        let what = format!("the variable `{}`", name.value);
        let value = self.value(written, &Need::new(of_type, what));
        let subtracts = match operator {
            AssignOperator::Set => return Some(StatementKind::Store(place, value)),
            AssignOperator::Add => false,
            AssignOperator::Subtract => true,
        };
        let (int, real) = match subtracts {
            true => (Instr::IntSub {}, Instr::RealSub {}),
            false => (Instr::IntAdd {}, Instr::RealAdd {}),
        };
        let instr = match of_type {
            ValueType::Int if !value.reads(place) => {
                return Some(StatementKind::Update { place, subtracts, value });
            }
            ValueType::Int => int,
            ValueType::Real(_) => real,
            ValueType::Unknown => return None,
            _ => {
                let message = format!("only a number can be added to, and this is {of_type}");
                let at = of_type.to_string();
                self.reports.error(Code::TypeMismatch, name.span, message, &at);
                return None;
            }
        };
        // A sum of reals has no exact inverse: the former value is recorded.
        let kind = match place {
            Place::Local(local) => ExpressionKind::Local(local),
            Place::Global(global) => ExpressionKind::Global(global),
        };
        let former = Expression { kind, of_type, span: name.span };
        let span = name.span.to(written.span);
        Some(StatementKind::Store(place, binary(instr, former, value, of_type, span)))
    }

    /// The variable that is assigned; that is no use of it.
    fn assigned(&mut self, name: Name<'s>) -> Option<(Place, ValueType)> {
        let found = match self.names.find(name.value) {
            Found::Here(symbol) => symbol,
            Found::Nothing => {
                self.report_undeclared(name);
                return None;
            }
            Found::Outside(Symbol { meaning: Meaning::Local(..), name: first, .. }) => {
                self.report_outer(name, first.span);
                return None;
            }
            Found::Outside(symbol) => symbol,
        };
        self.names.mark_assigned(name.value);
        let reason = match found.meaning {
            Meaning::Global(global, of_type) => return Some((Place::Global(global), of_type)),
            Meaning::Local(local, of_type) if of_type != ValueType::Item => {
                return Some((Place::Local(local), of_type));
            }
            meaning => meaning.kind(),
        };
        let message = format!("`{}` is {reason} and cannot be assigned", name.value);
        let diagnostic =
            Diagnostic::error(Code::NotAssignable, name.span, message, "assigned here")
                .with_label(found.name.span, format!("{reason}, declared here"));
        self.reports.add(diagnostic);
        None
    }

    fn leave_loop(&mut self, span: Span) -> Checked {
        let is_dead = self.frame.is_dead;
        match self.frame.around.last_mut() {
            Some(Around::Loop { breaks }) => {
                *breaks |= !is_dead;
                return Some((self.done(StatementKind::Break, span), false));
            }
            Some(Around::Reversed(block)) => {
                let block = *block;
                if self.leave_all_loops() {
                    self.report_leaves_reversed("break", span, block);
                    return None;
                }
            }
            Some(Around::Branch(fork)) => {
                let fork = *fork;
                if self.leave_all_loops() {
                    self.report_leaves_fork("break", span, fork);
                    return None;
                }
            }
            None => {}
        }
        let message = "`break` stands in no loop".to_owned();
        self.reports.error(Code::BreakOutsideLoop, span, message, "nothing to leave");
        None
    }

    /// Take the loops around for left, so that nothing follows from a `break` that cannot be;
    /// whether there are any.
    fn leave_all_loops(&mut self) -> bool {
        let mut any = false;
        for around in &mut self.frame.around {
            if let Around::Loop { breaks } = around {
                *breaks = true;
                any = true;
            }
        }
        any
    }

    fn leave_sequence(&mut self, span: Span) -> Checked {
        let is_loop = |around: &&Around| matches!(around, Around::Loop { .. });
        match self.frame.around.iter().rev().find(|around| !is_loop(around)).copied() {
            Some(Around::Reversed(block)) => self.report_leaves_reversed("return", span, block),
            Some(Around::Branch(fork)) => self.report_leaves_fork("return", span, fork),
            _ => return Some((self.done(StatementKind::Return, span), false)),
        }
        None
    }

    fn report_leaves_reversed(&mut self, word: &str, span: Span, block: Span) {
        let message = format!("`{word}` leaves a block that is passed over in reverse as one");
        let diagnostic =
            Diagnostic::error(Code::LeavesReversedBlock, span, message, "leaves the block")
                .with_label(block, "the block begins here")
                .with_help("leave it by a condition that is tested after the block");
        self.reports.add(diagnostic);
    }

    fn setting(
        &mut self,
        value: SettingValue,
        block: Option<&ast::Block<'s>>,
        span: Span,
    ) -> Checked {
        let name = value.setting().name();
        let of_type = value.setting().of_type();
        let Some(block) = block else {
            let setting = value.setting();
            if self.frame.modal.iter().all(|(known, _)| *known != setting) {
                // Written when the sequence begins, so that no scope before may have it too.
                let former = self.hidden(&format!("initial_{name}"), of_type, span);
                self.frame.modal.push((setting, former));
            }
            return Some((self.done(StatementKind::Set(value), span), true));
        };
        let header = self.header(span.start, block.span);
        let former = self.hidden(name, of_type, span);
        let block = self.block(block);
        self.frame.give_back(former);
        let falls_through = block.falls_through;
        let kind = StatementKind::SetFor { value, former, block };
        Some((self.done(kind, header), falls_through))
    }

    fn tool(&mut self, name: Name<'s>) -> ToolId {
        if let Some(&known) = self.interned.tools.get(name.value) {
            return ToolId(known);
        }
        let index = self.index(self.module.tools.len(), "tools", name.span);
        self.module.tools.push(name.value.to_owned());
        self.mention(Mentioned::Tool(index), name.span);
        self.interned.tools.insert(name.value, index);
        ToolId(index)
    }

    /// A reason in the programmer's words.
    pub(super) fn reason(&mut self, reason: Spanned<&str>) -> ReasonId {
        if let Some(&known) = self.interned.reasons.get(reason.value) {
            return ReasonId(known);
        }
        let index = self.index(self.module.reasons.len(), "reasons", reason.span);
        self.module.reasons.push(reason.value.to_owned());
        self.interned.reasons.insert(reason.value.to_owned(), index);
        ReasonId(index)
    }

    /// A block that is irreversible, or has a reverse of its own.
    fn block_with_reverse(&mut self, written: &ast::Statement<'s>) -> (Statement, bool) {
        use ast::StatementKind as Written;
        let (kind, inner, falls_through) = match &written.kind {
            Written::Irreversible { reason, block } => {
                let reason = self.reason(*reason);
                let checked = self.block(block);
                let falls_through = checked.falls_through;
                (StatementKind::Irreversible(reason, checked), block.span, falls_through)
            }
            Written::SkipInReverse(block) => {
                let checked = self.reversed_block(block, written.span);
                let falls_through = checked.falls_through;
                (StatementKind::Reversed(checked, None), block.span, falls_through)
            }
            Written::ReplaceInReverse { block, replacement } => {
                let checked = self.reversed_block(block, written.span);
                let falls_through = checked.falls_through;
                let function = self.replacement(replacement, replacement.span);
                (StatementKind::Reversed(checked, Some(function)), block.span, falls_through)
            }
            Written::KeepInReverse(block) => {
                let (function, falls_through) = self.kept(block, written.span);
                (StatementKind::Kept(function), block.span, falls_through)
            }
            _ => (StatementKind::Return, written.span, false),
        };
        let header = self.header(written.span.start, inner);
        (self.done(kind, header), falls_through)
    }

    /// A block that is passed as one in reverse.
    pub(super) fn reversed_block(&mut self, block: &ast::Block<'s>, span: Span) -> Block {
        let header = self.header(span.start, block.span);
        self.frame.around.push(Around::Reversed(header));
        let checked = self.block(block);
        self.frame.around.pop();
        if self.movers.may_move(block) {
            self.lose_position("this block has a reverse of its own", header);
        }
        checked
    }
}

/// Add a wait to the settling time of the output before it; the wait, if it is none.
fn settle(before: &mut Statement, wait: Statement) -> Option<Statement> {
    let (StatementKind::Output { settle, .. }, StatementKind::Wait(time)) =
        (&mut before.kind, &wait.kind)
    else {
        return Some(wait);
    };
    let is_large = settle.size().0 + time.size().0 > MAX_SETTLE;
    if !wait.hoists.is_empty() || is_large || time.of_type.is_unknown() {
        return Some(wait);
    }
    let is_none = matches!(settle.kind, ExpressionKind::Real(seconds) if seconds == 0.0);
    *settle = match is_none {
        true => time.clone(),
        false => {
            let span = settle.span.to(time.span);
            binary(Instr::RealAdd {}, settle.clone(), time.clone(), ValueType::TIME, span)
        }
    };
    before.span = before.span.to(wait.span);
    None
}

fn level(high: bool) -> Level {
    if high { Level::High } else { Level::Low }
}

/// The speed of a word.
pub(super) fn speed(word: SpeedWord) -> SpeedId {
    match word {
        SpeedWord::VerySlow => SpeedId::VerySlow,
        SpeedWord::Slow => SpeedId::Slow,
        SpeedWord::Normal => SpeedId::Normal,
        SpeedWord::Fast => SpeedId::Fast,
        SpeedWord::VeryFast => SpeedId::VeryFast,
    }
}

fn speed_setting(word: Spanned<SpeedWord>) -> SettingValue {
    SettingValue::Speed(speed(word.value))
}
