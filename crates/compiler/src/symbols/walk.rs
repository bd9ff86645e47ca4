//! The names of declarations: what each gives, and what it names. Bodies are `body`'s.

use super::scopes::{EVERYWHERE, Scopes};
use super::{Role, SymbolId, SymbolKind, Symbols};
use crate::types::ValueType;
use obverse_syntax::ast::{
    AdvancedMove, Behaviour, Bound, Cause, Change, ErrorClause, ErrorDeclaration, Extent,
    IoOperation, Item, ItemDeclaration, MoveClause, Name, Otherwise, Program, Recovery, Sequence,
    SignalKind, VariableDeclaration, Vector,
};
use obverse_syntax::span::Span;
use std::collections::HashMap;

/// Goes through a tree.
pub(super) struct Walk<'s> {
    source: &'s str,
    pub(super) scopes: Scopes<'s>,
    /// The parameters of what can be called.
    pub(super) parameters: HashMap<SymbolId, Vec<(&'s str, SymbolId)>>,
    /// The declaration in hand.
    pub(super) parent: Option<SymbolId>,
}

/// All names of a tree of a source. Recurses no deeper than blocks and expressions are in one
/// another.
pub(super) fn walk<'s>(source: &'s str, program: &Program<'s>) -> Symbols {
    let scopes = Scopes::default();
    let mut walk = Walk { source, scopes, parameters: HashMap::new(), parent: None };
    // Declarations see each other in any order.
    let declared: Vec<Option<SymbolId>> =
        program.items.iter().map(|item| walk.declare(item)).collect();
    for (item, symbol) in program.items.iter().zip(&declared) {
        walk.declare_parts(item, *symbol);
    }
    for (item, symbol) in program.items.iter().zip(declared) {
        walk.parent = symbol;
        walk.item(item, symbol);
    }
    walk.scopes.finish()
}

impl<'s> Walk<'s> {
    /// What a declaration gives a name to.
    fn declare(&mut self, item: &Item<'s>) -> Option<SymbolId> {
        let (kind, whole) = match item {
            Item::Cell(_) | Item::Import(_) | Item::Cleanup(_) | Item::Allow(_) => return None,
            Item::Signal(signal) => match signal.kind {
                SignalKind::Output => (SymbolKind::Output, signal.span),
                SignalKind::Input => (SymbolKind::Input, signal.span),
            },
            Item::Io(io) => (SymbolKind::Io, io.span),
            Item::Joints(joints) => (SymbolKind::Joints, joints.span),
            Item::ItemDeclaration(item) => (SymbolKind::Item, item.span),
            Item::Error(error) => (SymbolKind::Error, error.span),
            Item::AdvancedMove(advanced) => (SymbolKind::AdvancedMove, advanced.span),
            Item::Variable(variable) => (SymbolKind::Variable, variable.span),
            Item::Sequence(sequence) if sequence.is_action => (SymbolKind::Action, sequence.span),
            Item::Sequence(sequence) => (SymbolKind::Sequence, sequence.span),
        };
        let name = item.name()?;
        let id = self.scopes.add(name, kind, whole, EVERYWHERE, None);
        self.scopes.show(name.value, id);
        Some(id)
    }

    /// What belongs to a declaration and is named elsewhere: keyframes and parameters.
    fn declare_parts(&mut self, item: &Item<'s>, symbol: Option<SymbolId>) {
        match (item, symbol) {
            (Item::ItemDeclaration(ItemDeclaration { keyframes, .. }), Some(symbol)) => {
                for keyframe in keyframes {
                    self.scopes.declare_keyframe(keyframe.name, keyframe.span, symbol);
                }
            }
            (Item::Sequence(sequence), Some(symbol)) => {
                let of_sequence = sequence.parameters.iter().map(|parameter| {
                    let name = parameter.name;
                    let whole = name.span.to(parameter.type_name.span);
                    let scope = sequence.body.span;
                    let kind = SymbolKind::Parameter;
                    (name.value, self.scopes.add(name, kind, whole, scope, Some(symbol)))
                });
                let parameters = of_sequence.collect();
                self.parameters.insert(symbol, parameters);
            }
            _ => {}
        }
    }

    /// What a declaration names.
    fn item(&mut self, item: &Item<'s>, symbol: Option<SymbolId>) {
        match item {
            Item::Cell(_) | Item::Import(_) | Item::Signal(_) | Item::Allow(_) => {}
            Item::Io(io) => self.io(io),
            Item::Joints(joints) => self.vector(&joints.values),
            Item::ItemDeclaration(item) => {
                for keyframe in &item.keyframes {
                    self.vector(&keyframe.position);
                    keyframe.rotation.iter().for_each(|rotation| self.vector(rotation));
                }
            }
            Item::Error(error) => self.error(error),
            Item::AdvancedMove(advanced) => self.advanced(advanced),
            Item::Variable(variable) => self.first_value(variable),
            Item::Sequence(sequence) => self.sequence(sequence, symbol),
            Item::Cleanup(cleanup) => self.block(&cleanup.body),
        }
    }

    fn io(&mut self, io: &IoOperation<'s>) {
        io.primitives.iter().for_each(|primitive| self.primitive(primitive));
        self.uses(io.counterpart);
    }

    fn vector(&mut self, vector: &Vector<'s>) {
        vector.elements.iter().for_each(|element| self.expression(element));
    }

    /// The type and the first value of a variable, which it is not seen in itself.
    pub(super) fn first_value(&mut self, variable: &VariableDeclaration<'s>) {
        variable.type_name.iter().for_each(|name| self.type_name(*name));
        self.expression(&variable.value);
    }

    fn type_name(&mut self, name: Name<'s>) {
        match ValueType::of_name(name.value) {
            Some(_) => self.scopes.use_foreign(name, SymbolKind::Type),
            None => self.scopes.note(name.span, None, Role::Uses),
        }
    }

    /// A name with its place: it is a part of the source, and an expression may have parentheses
    /// around it.
    pub(super) fn placed(&self, name: &'s str, around: Span) -> Name<'s> {
        let start = name.as_ptr().addr().wrapping_sub(self.source.as_ptr().addr());
        let is_within = self.source.get(start..start.saturating_add(name.len())) == Some(name);
        match u32::try_from(start) {
            Ok(start) if is_within => Name::new(name, Span::new(start, start + name.len() as u32)),
            _ => Name::new(name, around),
        }
    }

    /// A name that leads to what can be seen.
    pub(super) fn uses(&mut self, name: impl IntoIterator<Item = Name<'s>>) {
        for name in name {
            self.scopes.use_name(name, Role::Uses);
        }
    }

    fn sequence(&mut self, sequence: &Sequence<'s>, symbol: Option<SymbolId>) {
        for parameter in &sequence.parameters {
            self.type_name(parameter.type_name);
            if let Some(range) = &parameter.range {
                self.expression(&range.least);
                self.expression(&range.most);
            }
            parameter.default.iter().for_each(|default| self.expression(default));
        }
        let scope = self.scopes.open();
        let parameters = symbol.and_then(|symbol| self.parameters.get(&symbol)).cloned();
        for (name, parameter) in parameters.unwrap_or_default() {
            self.scopes.show(name, parameter);
        }
        self.block(&sequence.body);
        self.scopes.close(&scope);
    }

    fn error(&mut self, error: &ErrorDeclaration<'s>) {
        for clause in &error.clauses {
            match &clause.value {
                ErrorClause::Recover(Recovery::Using(name))
                | ErrorClause::Otherwise(Otherwise::Using(name)) => self.uses([*name]),
                ErrorClause::Recover(Recovery::Reversing { extent, changes, .. }) => {
                    if let Extent::Checkpoint(name) = extent {
                        self.scopes.use_checkpoint(*name);
                    }
                    for change in changes {
                        if let Change::Perturbed { within, .. } = &change.value {
                            self.expression(within);
                        }
                    }
                }
                ErrorClause::GiveUp(bounds) => {
                    for bound in bounds {
                        if let Bound::Cost(cost) = bound {
                            self.expression(cost);
                        }
                    }
                }
                ErrorClause::Severity(_)
                | ErrorClause::Otherwise(Otherwise::Operator | Otherwise::Stop)
                | ErrorClause::Respond(_)
                | ErrorClause::Then(_) => {}
                ErrorClause::On(causes) => {
                    for cause in causes {
                        match cause {
                            Cause::Fault(_) => {}
                            Cause::Input { input, .. } => self.signal(*input),
                            Cause::Force(above) => self.expression(above),
                        }
                    }
                }
            }
        }
    }

    fn advanced(&mut self, advanced: &AdvancedMove<'s>) {
        for clause in &advanced.clauses {
            match &clause.value {
                MoveClause::Requires { condition, otherwise } => {
                    self.expression(condition);
                    self.uses(*otherwise);
                }
                MoveClause::Distance { distance, .. } => self.expression(distance),
                MoveClause::Turn(turn) => {
                    turn.amounts().for_each(|amount| self.expression(amount));
                }
                MoveClause::StopIf(condition) | MoveClause::SucceedsIf(condition) => {
                    self.expression(condition);
                }
                MoveClause::OnSuccess(behaviours) | MoveClause::OnFailure(behaviours) => {
                    behaviours.iter().for_each(|behaviour| self.behaviour(&behaviour.value));
                }
                MoveClause::Speed(_) | MoveClause::OppositeForce => {}
            }
        }
        self.uses(advanced.counterpart);
    }

    fn behaviour(&mut self, behaviour: &Behaviour<'s>) {
        match behaviour {
            Behaviour::ReturnToInitialPosition => {}
            Behaviour::RepeatWithPerturbation { within, .. } => {
                within.iter().for_each(|within| self.expression(within));
            }
            Behaviour::Throw(name) => self.uses([*name]),
        }
    }

    /// A name of a block, seen from one place to the end of the block.
    pub(super) fn declare_within(
        &mut self,
        name: Name<'s>,
        kind: SymbolKind,
        whole: Span,
        scope: Span,
    ) {
        let id = self.scopes.add(name, kind, whole, scope, self.parent);
        self.scopes.show(name.value, id);
    }
}
