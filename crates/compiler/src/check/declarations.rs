//! Declarations that are data: joint configurations, items, variables of the program, and the
//! counterparts of I/O operations and of advanced moves.

use super::Checker;
use super::expression::Need;
use super::names::{Found, Meaning};
use crate::tree::{Expression, ExpressionKind};
use crate::types::ValueType;
use crate::units::{Dimension, Unit};
use obverse_bytecode::Keyframe;
use obverse_isa::{ItemId, KeyframeId};
use obverse_syntax::ast::{
    AdvancedMove, IoOperation, ItemDeclaration, JointsDeclaration, Name, VariableDeclaration,
    Vector,
};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::Span;

impl<'s> Checker<'s> {
    /// `joints start = [3.425, -1.0, 1.2, -1.8, -1.57, 0.3] rad`
    pub(super) fn check_joints(&mut self, declaration: &JointsDeclaration<'s>) {
        let values = self.vector(&declaration.values, Dimension::ANGLE, "a joint configuration");
        if let Found::Here(symbol) = self.names.find(declaration.name.value)
            && let Meaning::Joints(id) = symbol.meaning
            && let Some(entry) = self.module.joints.get_mut(id.index())
        {
            entry.1 = values;
        }
    }

    /// `item peg { keyframe grasp = [0, 0, 20] mm [0, 180, 0] deg }`
    pub(super) fn check_item(&mut self, declaration: &ItemDeclaration<'s>) {
        let mut keyframes: Vec<(Keyframe, Span)> = Vec::new();
        for written in &declaration.keyframes {
            let position_m = self.vector(&written.position, Dimension::LENGTH, "a position");
            let rotation = written.rotation.as_ref();
            let rotation_rad = rotation
                .map_or([0.0; 3], |rotation| self.vector(rotation, Dimension::ANGLE, "a rotation"));
            let KeyframeId(name) = self.keyframe(written.name);
            if let Some((_, first)) = keyframes.iter().find(|(known, _)| known.name == name) {
                let message = format!("the keyframe `{}` is given twice", written.name.value);
                let diagnostic = Diagnostic::error(
                    Code::DuplicateName,
                    written.name.span,
                    message,
                    "given again here",
                )
                .with_label(*first, "the first is here");
                self.reports.add(diagnostic);
                continue;
            }
            keyframes.push((Keyframe { name, position_m, rotation_rad }, written.name.span));
        }
        if let Found::Here(symbol) = self.names.find(declaration.name.value)
            && let Meaning::Item(ItemId(id)) = symbol.meaning
            && let Some(item) = self.module.items.get_mut(usize::from(id))
        {
            item.keyframes = keyframes.into_iter().map(|(keyframe, _)| keyframe).collect();
        }
    }

    /// The keyframe of this name, of whatever item.
    pub(super) fn keyframe(&mut self, name: Name<'s>) -> KeyframeId {
        if let Some(&known) = self.interned.keyframes.get(name.value) {
            return KeyframeId(known);
        }
        let index = self.index(self.module.keyframes.len(), "names of keyframes", name.span);
        self.module.keyframes.push(name.value.to_owned());
        self.interned.keyframes.insert(name.value, index);
        KeyframeId(index)
    }

    /// So many numbers of a dimension, in SI units.
    fn vector<const COUNT: usize>(
        &mut self,
        vector: &Vector<'s>,
        dimension: Dimension,
        what: &str,
    ) -> [f64; COUNT] {
        let unit = vector.unit.map(|unit| self.vector_unit(unit, dimension, what));
        let elements: Vec<Expression> =
            vector.elements.iter().map(|element| self.constant(element)).collect();
        if unit.is_none() && elements.iter().any(is_plain_number) {
            self.report_no_unit(vector.span, dimension, what);
            return [0.0; COUNT];
        }
        let values: Vec<f64> = elements
            .into_iter()
            .map(|element| match unit {
                Some(unit) => self.element_of_unit(element, unit, vector.unit),
                None => self.element_alone(element, dimension, what),
            })
            .collect();
        let count = values.len();
        values.try_into().unwrap_or_else(|_| {
            let message = format!("{what} has {COUNT} numbers, and this has {count}");
            let at = format!("{count} numbers");
            self.reports.error(Code::VectorLength, vector.span, message, &at);
            [0.0; COUNT]
        })
    }

    fn report_no_unit(&mut self, vector: Span, dimension: Dimension, what: &str) {
        let message = format!("each number of {what} is {dimension}, and here is no unit");
        let diagnostic = Diagnostic::error(Code::MissingUnit, vector, message, "without a unit")
            .with_help(format!("write the unit after the bracket: {}", dimension.examples()));
        let behind = Span::new(vector.end, vector.end);
        let units = dimension.units().into_iter().map(|unit| format!(" {unit}"));
        self.reports.add(diagnostic.with_choices(behind, units));
    }

    /// The unit after a bracket, if it can be meant.
    fn vector_unit(&mut self, unit: Name<'s>, dimension: Dimension, what: &str) -> Option<Unit> {
        let known = Unit::of_name(unit.value);
        match known {
            // The parser has said so.
            None => {}
            Some(known) if known.dimension != dimension => {
                let found = known.dimension;
                let message =
                    format!("each number of {what} is {dimension}, and this unit makes it {found}");
                let diagnostic = Diagnostic::error(
                    Code::UnitMismatch,
                    unit.span,
                    message,
                    format!("the unit of {found}"),
                )
                .with_help(format!("write {}", dimension.examples()));
                self.reports.add(diagnostic);
                return None;
            }
            Some(_) => {}
        }
        known
    }

    /// A number whose unit stands after the bracket.
    fn element_of_unit(
        &mut self,
        value: Expression,
        unit: Option<Unit>,
        written: Option<Name<'s>>,
    ) -> f64 {
        let span = value.span;
        if let (ValueType::Real(dimension), Some(written)) = (value.of_type, written)
            && !dimension.is_none()
        {
            let message = "this number has a unit of its own, and the bracket has one as well";
            let diagnostic = Diagnostic::error(Code::DoubleUnit, span, message, "its own unit")
                .with_label(written.span, "the unit of each number")
                .with_help("leave out one of the two");
            self.reports.add(diagnostic);
            return 0.0;
        }
        let value = self.fit(value, &Need::new(ValueType::NUMBER, "an element"));
        let (ExpressionKind::Real(value), Some(unit)) = (value.kind, unit) else { return 0.0 };
        let si = unit.to_si(value);
        if !si.is_finite() {
            self.not_finite(span);
        }
        si
    }

    /// A number with a unit of its own.
    fn element_alone(&mut self, value: Expression, dimension: Dimension, what: &str) -> f64 {
        let value = self.fit(value, &Need::new(ValueType::Real(dimension), what));
        match value.kind {
            ExpressionKind::Real(value) => value,
            _ => 0.0,
        }
    }

    /// `var count = 0` at the top of the file.
    pub(super) fn check_global(&mut self, declaration: &VariableDeclaration<'s>) {
        let value = self.constant(&declaration.value);
        let value = self.first_value(declaration, value);
        let of_type = value.of_type;
        if let Found::Here(symbol) = self.names.find(declaration.name.value)
            && let Meaning::Global(id, _) = symbol.meaning
            && let Some(variable) = self.module.globals.get_mut(id.index())
        {
            variable.of_type = of_type.machine();
            variable.measures = of_type.measures();
            self.names.set_global_type(declaration.name.value, of_type);
        }
        self.first_values.push(value);
    }

    /// The first value of a variable, of the type that is declared for it.
    pub(super) fn first_value(
        &mut self,
        declaration: &VariableDeclaration<'s>,
        value: Expression,
    ) -> Expression {
        let declared = declaration.type_name.map(|name| (self.type_named(name), name.span));
        let is_item = value.of_type == ValueType::Item
            || declared.is_some_and(|(of_type, _)| of_type == ValueType::Item);
        if is_item {
            let message = format!("the variable `{}` cannot hold an item", declaration.name.value);
            let at = "only a parameter stands for an item";
            self.reports.error(Code::ItemVariable, declaration.name.span, message, at);
            return Expression::missing(value.span);
        }
        let Some((of_type, place)) = declared else { return value };
        let what = format!("the variable `{}`", declaration.name.value);
        let fitted = self.fit(value, &Need::new(of_type, what).declared(place));
        // Its type is known, whatever became of its value.
        Expression { of_type, ..fitted }
    }

    /// `reverse gripper_open` after an I/O operation.
    pub(super) fn check_counterpart(&mut self, io: &IoOperation<'s>) {
        let Some(name) = io.counterpart else { return };
        let is_io = |meaning| matches!(meaning, Meaning::Io(_));
        let counterpart = self.resolve(name, "an I/O operation", is_io);
        self.set_counterpart(io.name, counterpart);
    }

    /// `reverse pull_peg` after an advanced move.
    pub(super) fn check_opposite_move(&mut self, guarded: &AdvancedMove<'s>) {
        let Some(name) = guarded.counterpart else { return };
        let is_guarded = |meaning| matches!(meaning, Meaning::Guarded(_));
        let counterpart = self.resolve(name, "an advanced move", is_guarded);
        self.set_counterpart(guarded.name, counterpart);
    }

    fn set_counterpart(&mut self, of: Name<'s>, counterpart: Option<Meaning>) {
        if let Found::Here(symbol) = self.names.find(of.value)
            && let (
                Meaning::Io(id) | Meaning::Guarded(id),
                Some(Meaning::Io(counterpart) | Meaning::Guarded(counterpart)),
            ) = (symbol.meaning, counterpart)
        {
            self.signatures[id.index()].counterpart = Some(counterpart);
        }
    }

    /// A variable of a function, of its own name.
    pub(super) fn declare_local(&mut self, name: Name<'s>, of_type: ValueType) -> Meaning {
        let local = self.frame.layout.add_typed(name.value, of_type);
        let local = self.room_for(local, name.span);
        let meaning = Meaning::Local(local, of_type);
        self.declare(name, meaning);
        meaning
    }
}

fn is_plain_number(value: &Expression) -> bool {
    matches!(value.of_type, ValueType::Int | ValueType::NUMBER)
}
