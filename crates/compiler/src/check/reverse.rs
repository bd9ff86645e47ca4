//! Blocks that are otherwise in reverse: those that keep their order, and those over which the arm
//! goes back in another manner. What is skipped or replaced is in `statement`.

use super::Checker;
use super::expression::Need;
use super::function::last_byte;
use super::statement::{Checked, speed};
use crate::tree::{
    Block, Body, ExpressionKind, Function, Hoist, Kept, Layout, SettingValue, Statement,
    StatementKind,
};
use crate::types::ValueType;
use obverse_bytecode::FunctionKind;
use obverse_isa::{FunctionId, LocalId};
use obverse_syntax::ast::{self, ReverseParameter};
use obverse_syntax::codes::Code;
use obverse_syntax::span::{Span, Spanned};

impl<'s> Checker<'s> {
    /// `keep in reverse { … }`: the block is a function too, with the frame of the one around; and
    /// whether what follows it is reached.
    pub(super) fn kept(&mut self, block: &ast::Block<'s>, span: Span) -> (FunctionId, bool) {
        let named = self.header(span.start, block.span);
        if self.movers.may_move(block) {
            self.lose_position("going back, this block begins where it ended", named);
        }
        let id = self.new_function(named);
        let name = self.name_in_reverse();
        let locals_before = self.frame.layout.locals.len();
        let positions = self.frame.layout.slots.len();
        let before = std::mem::replace(&mut self.frame.kept_positions, positions);
        let block = self.reversed_block(block, span);
        self.frame.kept_positions = before;
        let falls_through = block.falls_through;
        let function = Function {
            name,
            kind: FunctionKind::Replacement,
            named,
            layout: Layout::default(),
            modal: Vec::new(),
            kept: Some(Kept { around: self.frame.function, locals_before }),
            body: Body::Block(block),
        };
        self.keep_function(id, function);
        (id, falls_through)
    }

    /// `with speed slow, force limit 20 N in reverse { … }`: a setting for the block each.
    pub(super) fn with_in_reverse(
        &mut self,
        parameters: &[Spanned<ReverseParameter<'s>>],
        block: &ast::Block<'s>,
        span: Span,
    ) -> Checked {
        let mut settings: Vec<(SettingValue, Vec<Hoist>, Span)> = Vec::new();
        for parameter in parameters {
            let (word, value) = self.reverse_parameter(parameter);
            let hoists = self.frame.take_hoists();
            let first = settings.iter().find(|(known, ..)| known.setting() == value.setting());
            match first.map(|(.., first)| *first) {
                Some(first) => self.report_twice(word, parameter.span, first),
                None => settings.push((value, hoists, parameter.span)),
            }
        }
        let header = self.header(span.start, block.span);
        let formers: Vec<LocalId> = settings
            .iter()
            .map(|(value, ..)| {
                let setting = value.setting();
                self.hidden(&setting.name().replace('.', "_"), setting.of_type(), span)
            })
            .collect();
        let end = last_byte(block.span);
        let mut block = self.block(block);
        let falls_through = block.falls_through;
        for ((value, hoists, _), former) in settings.into_iter().zip(formers).rev() {
            self.frame.give_back(former);
            let kind = StatementKind::SetFor { value, former, block };
            let statements = vec![Statement { hoists, kind, span: header }];
            block = Block { statements, falls_through, end };
        }
        block.statements.pop().map(|outermost| (outermost, falls_through))
    }

    /// What is otherwise going back, and the words for it.
    fn reverse_parameter(
        &mut self,
        parameter: &Spanned<ReverseParameter<'s>>,
    ) -> (&'static str, SettingValue) {
        match &parameter.value {
            ReverseParameter::Speed(word) => ("speed", SettingValue::ReverseSpeed(speed(*word))),
            ReverseParameter::StraightMoves => ("straight moves", SettingValue::ReverseStraight),
            ReverseParameter::ForceLimit(limit) => {
                let value = self.value(limit, &Need::new(ValueType::FORCE, "`force limit`"));
                if matches!(value.kind, ExpressionKind::Real(newtons) if newtons <= 0.0) {
                    let message = "the limit of a force is above zero".to_owned();
                    self.reports.error(Code::OutOfRange, limit.span, message, "not above zero");
                }
                ("force limit", SettingValue::ReverseForceLimit(value))
            }
        }
    }
}
