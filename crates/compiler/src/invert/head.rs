//! The head of a sequence: what it binds before its first statement proper. Settings hold to its
//! end; the first move says where the arm begins; and in the sequence that is asked for, what is
//! set before the first move says how outputs and variables begin. The head of the inverse binds
//! the same to what it is in the end.

use super::block::{Emitted, FirstMove, Inverter, Summary};
use super::effect::{Declared, Effect, constant};
use super::place::{Arm, Spot};
use super::program::Plan;
use super::refusal::refusal;
use obverse_syntax::ast::{
    AssignOperator, Expression, Primitive, Sequence, Statement, StatementKind,
};
use obverse_syntax::span::Span;
use std::collections::BTreeSet;

/// The head of a sequence.
pub(super) struct Head<'p> {
    /// How many statements it has.
    pub(super) len: usize,
    statements: &'p [Statement<'p>],
}

impl<'p> Inverter<'p> {
    /// Finds and follows the head of a sequence.
    pub(super) fn head(&mut self, sequence: &'p Sequence<'p>) -> Head<'p> {
        let statements = sequence.body.statements.as_slice();
        let is_root = sequence.name.value == self.plan.root;
        let len = self.head_length(statements, is_root);
        let head = &statements[..len];
        for statement in head {
            match &statement.kind {
                StatementKind::Tool { name, .. } => self.tool = Some(name.value),
                StatementKind::Move { target, linear, .. } => {
                    if let Some(spot) = Spot::of(target, self.tool) {
                        let is_linear = *linear;
                        self.first_move = Some(FirstMove { spot: spot.clone(), is_linear });
                        self.arm = Arm::at(spot);
                    }
                }
                _ => {}
            }
            self.facts.after(statement, self.plan);
        }
        let next = statements.get(len);
        if let Some(Statement { kind: StatementKind::Call { .. }, span }) = next
            && self.first_move.is_none()
        {
            self.first_call = Some(*span);
        }
        Head { len, statements: head }
    }

    /// How many statements of a sequence are its head. Without a first move, only its settings.
    fn head_length(&self, statements: &[Statement<'p>], is_root: bool) -> usize {
        let mut bound = Bound::default();
        let mut settings = 0;
        for (index, statement) in statements.iter().enumerate() {
            match &statement.kind {
                StatementKind::Speed { block: None, .. } if bound.once("speed") => {}
                StatementKind::Tool { block: None, .. } if bound.once("tool") => {}
                StatementKind::Move { target, always: None, .. } => {
                    let is_place = Spot::of(target, None).is_some();
                    return if is_place { index + 1 } else { settings };
                }
                StatementKind::Call { name, .. } => {
                    let goes = matches!(
                        self.summaries.get(name.value),
                        Some(Summary::Goes(..) | Summary::Refused)
                    );
                    return if goes { index } else { settings };
                }
                _ if is_root && self.binds(statement, &mut bound) => continue,
                _ => return settings,
            }
            if settings == index {
                settings = index + 1;
            }
        }
        settings
    }

    /// Whether a statement gives outputs or a variable that nothing before has given one a value.
    fn binds(&self, statement: &Statement<'p>, bound: &mut Bound<'p>) -> bool {
        match &statement.kind {
            StatementKind::Primitive(primitive) => bound.primitive(primitive, self.plan),
            StatementKind::Io(name) => self.plan.io(name.value).is_some_and(|io| {
                io.counterpart.is_none()
                    && io.primitives.iter().all(|primitive| bound.primitive(primitive, self.plan))
            }),
            StatementKind::Assign { name, operator: AssignOperator::Set, value } => {
                constant(value, self.plan).is_some() && bound.once(name.value)
            }
            _ => false,
        }
    }

    /// The head of the inverse, now that the end of the sequence is known; `is_refused` if
    /// something in it has no inverse.
    pub(super) fn head_of_inverse(
        &mut self,
        head: &Head<'p>,
        sequence: &'p Sequence<'p>,
        is_refused: bool,
    ) -> Vec<Emitted<'p>> {
        let mut emitted = Vec::new();
        for statement in head.statements {
            if !is_refused {
                self.require_restored(statement);
            }
            let kind = match &statement.kind {
                StatementKind::Move { .. } => self.first_move_of_inverse(sequence),
                StatementKind::Primitive(Primitive::Set { bit, span, .. }) => {
                    self.facts.level(bit.value, self.plan).map(|high| {
                        StatementKind::Primitive(Primitive::Set { bit: *bit, high, span: *span })
                    })
                }
                StatementKind::Io(name) => self.plan.io(name.value).cloned().and_then(|io| {
                    let last = |primitive: &Primitive<'p>| self.in_the_end(primitive);
                    let primitives: Option<Vec<_>> = io.primitives.iter().map(last).collect();
                    self.io_of(&io, primitives?, statement.span).map(StatementKind::Io)
                }),
                StatementKind::Assign { name, operator, .. } => {
                    let last = self.facts.constant(name.value).cloned();
                    last.map(|value| StatementKind::Assign {
                        name: *name,
                        operator: *operator,
                        value,
                    })
                }
                _ => Some(statement.kind.clone()),
            };
            match (kind, &statement.kind) {
                (Some(kind), _) => emitted.push(Emitted::new(kind, statement.span)),
                (None, StatementKind::Move { .. }) => {}
                // What is not known may follow from what has been refused.
                (None, _) if is_refused => {}
                (None, _) => self.refuse_open_end(statement.span),
            }
        }
        if self.first_call.is_some() && self.first_move.is_some() {
            let kind = self.first_move_of_inverse(sequence);
            emitted.extend(kind.map(|kind| Emitted::new(kind, sequence.name.span)));
        }
        emitted
    }

    /// A primitive with the level that its output has in the end.
    fn in_the_end(&self, primitive: &Primitive<'p>) -> Option<Primitive<'p>> {
        match primitive {
            Primitive::Set { bit, span, .. } => {
                let high = self.facts.level(bit.value, self.plan)?;
                Some(Primitive::Set { bit: *bit, high, span: *span })
            }
            Primitive::Toggle { .. } => None,
            Primitive::Sleep { .. } => Some(primitive.clone()),
        }
    }

    /// The move to where the sequence ends.
    fn first_move_of_inverse(&mut self, sequence: &'p Sequence<'p>) -> Option<StatementKind<'p>> {
        let first = self.first_move.clone()?;
        let end = self.arm.spot().filter(|spot| spot.is_reached_with(self.tool)).cloned();
        match end {
            Some(end) => Some(StatementKind::Move {
                target: end.target,
                linear: first.is_linear,
                always: None,
            }),
            None => {
                let brace = sequence.body.span.end;
                let place = Span::new(brace.saturating_sub(1), brace);
                let why = "the inverse would begin here";
                self.refuse_unnamed(place, why);
                None
            }
        }
    }

    /// An output that the head sets must be back at its level when the inverse ends.
    fn require_restored(&mut self, statement: &Statement<'p>) {
        let bits: Vec<u64> = match &statement.kind {
            StatementKind::Primitive(primitive) => {
                output_of(primitive, self.plan).into_iter().collect()
            }
            StatementKind::Io(name) => {
                let io = self.plan.io(name.value);
                io.iter()
                    .flat_map(|io| &io.primitives)
                    .filter_map(|one| output_of(one, self.plan))
                    .collect()
            }
            _ => return,
        };
        let sets = |effect: &Effect<'p>| bits.iter().any(|bit| effect.sets(*bit));
        let found = self.opaque.iter().find(|(effect, _)| sets(effect)).map(|(_, span)| *span);
        if let Some(place) = found {
            let message = "an output does not come back to the level that it begins with";
            let why = "what leads back here says by itself to which level";
            self.refuse(
                refusal(place, message, why)
                    .with_label(statement.span, "the sequence begins with this level")
                    .with_help("leave the output out of one of the two"),
            );
        }
    }

    fn refuse_open_end(&mut self, place: Span) {
        let message = "what this begins with is not known in the end";
        let why = "the inverse begins with what it is in the end";
        self.refuse(refusal(place, message, why).with_help(
            "set it to a known value before the sequence ends, or move before setting it",
        ));
    }
}

/// What has been given a value in a head.
#[derive(Default)]
struct Bound<'p> {
    names: BTreeSet<&'p str>,
    outputs: BTreeSet<u64>,
}

impl<'p> Bound<'p> {
    fn once(&mut self, name: &'p str) -> bool {
        self.names.insert(name)
    }

    fn primitive(&mut self, primitive: &Primitive<'p>, plan: &Plan<'p>) -> bool {
        match primitive {
            Primitive::Set { bit, .. } => self.outputs.insert(plan.number(bit.value)),
            Primitive::Toggle { .. } => false,
            Primitive::Sleep { duration, .. } => is_constant_time(duration),
        }
    }
}

fn output_of<'p>(primitive: &Primitive<'p>, plan: &Plan<'p>) -> Option<u64> {
    match primitive {
        Primitive::Set { bit, .. } | Primitive::Toggle { bit, .. } => Some(plan.number(bit.value)),
        Primitive::Sleep { .. } => None,
    }
}

fn is_constant_time(duration: &Expression<'_>) -> bool {
    super::walk::names_of(duration).is_empty() && super::pure::reading(duration).is_none()
}
