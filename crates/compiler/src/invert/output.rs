//! Outputs: each goes back to the level that it had, and I/O operations to their counterparts.

use super::block::{Emitted, Inverter};
use super::effect::{Declared, Effect};
use super::refusal::refusal;
use obverse_syntax::ast::{
    IoOperation, Item, Name, Primitive, Program, Signal, Statement, StatementKind,
};
use obverse_syntax::format::print;
use obverse_syntax::span::{Span, Spanned};

impl<'p> Inverter<'p> {
    /// `set 0 high`, `toggle 3`, with the settling times after them; or a wait by `sleep`.
    pub(super) fn output(
        &mut self,
        primitive: &'p Primitive<'p>,
        settling: &'p [Statement<'p>],
        span: Span,
    ) -> Vec<Emitted<'p>> {
        for statement in settling {
            if let StatementKind::Primitive(Primitive::Sleep { duration, .. }) = &statement.kind {
                self.require_pure(duration);
            }
        }
        let kind = match primitive {
            // It must not become the settling time of an output that comes to stand before it.
            Primitive::Sleep { duration, .. } => {
                self.require_pure(duration);
                return vec![Emitted::new(StatementKind::Wait(duration.clone()), span)];
            }
            Primitive::Toggle { .. } => primitive.clone(),
            Primitive::Set { bit, .. } => match self.facts.level(bit.value, self.plan) {
                Some(high) => Primitive::Set { bit: *bit, high, span },
                None => {
                    self.refuse_unknown_level(bit.value, span, span);
                    return Vec::new();
                }
            },
        };
        let mut unit = vec![Emitted::new(StatementKind::Primitive(kind), span)];
        unit.extend(settling.iter().map(|one| Emitted::new(one.kind.clone(), one.span)));
        unit
    }

    fn refuse_unknown_level(&mut self, output: Signal<'_>, set: Span, place: Span) {
        let name = match output {
            Signal::Number(number) => number.to_string(),
            Signal::Name(name) => format!("`{name}`"),
        };
        let message = format!("which level output {name} had before is not known");
        let why = "the inverse would set it to its former level";
        let mut diagnostic = refusal(place, &message, why);
        if set != place {
            diagnostic = diagnostic.with_label(set, "set here");
        }
        self.refuse(diagnostic.with_help(
            "set it before the first move of the sequence, or give it a counterpart: `io NAME { \
             .. } reverse OTHER`",
        ));
    }

    /// `io gripper_close`
    pub(super) fn io_operation(&mut self, name: Name<'p>, span: Span) -> Option<Emitted<'p>> {
        let io = self.plan.io(name.value)?;
        let inverse = match io.counterpart {
            Some(counterpart) => {
                for io in [Some(io), self.plan.io(counterpart.value)] {
                    self.opaque.push((Effect::of_io(io, self.plan), span));
                }
                self.counterpart(name, counterpart, span)?
            }
            None => {
                let primitives = self.undone(io, span)?;
                self.io_of(io, primitives, span)?
            }
        };
        Some(Emitted::new(StatementKind::Io(inverse), span))
    }

    /// The counterpart, if each is that of the other.
    fn counterpart(
        &mut self,
        name: Name<'p>,
        counterpart: Name<'p>,
        span: Span,
    ) -> Option<Name<'p>> {
        let other = self.plan.io(counterpart.value)?;
        let (other_name, back) = (other.name, other.counterpart);
        if back.is_some_and(|back| back.value == name.value) {
            return Some(Spanned::new(counterpart.value, span));
        }
        let message = format!("`{}` is not the counterpart of its counterpart", name.value);
        let (at, why) = match back {
            Some(back) => (back.span, "its own counterpart is this"),
            None => (other_name.span, "this has no counterpart"),
        };
        self.refuse(
            refusal(span, &message, "the inverse of its inverse would be another")
                .with_label(at, why)
                .with_help(format!("end `{}` with `reverse {}`", counterpart.value, name.value)),
        );
        None
    }

    /// The primitives of an I/O operation in reverse order, each to the level before it.
    fn undone(&mut self, io: &IoOperation<'p>, span: Span) -> Option<Vec<Primitive<'p>>> {
        let mut facts = self.facts.clone();
        let mut units: Vec<Vec<Primitive<'p>>> = vec![Vec::new()];
        for primitive in &io.primitives {
            let undone = match primitive {
                Primitive::Sleep { duration, .. } => {
                    self.require_pure(duration);
                    // What is slept before any output stays in front; the rest settles an output.
                    if let Some(unit) = units.last_mut() {
                        unit.push(primitive.clone());
                    }
                    continue;
                }
                Primitive::Toggle { .. } => primitive.clone(),
                Primitive::Set { bit, span: set, .. } => match facts.level(bit.value, self.plan) {
                    Some(high) => Primitive::Set { bit: *bit, high, span: *set },
                    None => {
                        self.refuse_unknown_level(bit.value, *set, span);
                        return None;
                    }
                },
            };
            units.push(vec![undone]);
            facts.after_primitive(primitive, self.plan);
        }
        units[1..].reverse();
        Some(units.concat())
    }

    /// The name of an I/O operation that consists of these primitives and stands for another in an
    /// inverse: that one itself, one that the program has for the purpose, or a new one.
    pub(super) fn io_of(
        &mut self,
        io: &IoOperation<'p>,
        primitives: Vec<Primitive<'p>>,
        span: Span,
    ) -> Option<Name<'p>> {
        let (own, wanted) = (body_text(&io.primitives), body_text(&primitives));
        if own == wanted {
            return Some(Spanned::new(io.name.value, span));
        }
        let like = |text: &str| self.io.known.get(text).map_or(&[][..], Vec::as_slice);
        if let ([_], [other]) = (like(&own), like(&wanted)) {
            let name = Spanned::new(other.name.value, span);
            // One that has the name of an inverse would be made again.
            if self.plan.inverse_name(other.name).value != io.name.value {
                self.io.kept.insert(io.name.value);
            }
            return Some(name);
        }
        let name = self.plan.inverse_name(io.name);
        let known = self.plan.io(name.value).filter(|known| known.counterpart.is_none());
        if known.is_some_and(|known| body_text(&known.primitives) == wanted) {
            return Some(Spanned::new(name.value, span));
        }
        let made = self.io.made.get(io.name.value).map(|made| body_text(&made.primitives));
        let is_taken = self.plan.io(name.value).is_some();
        if is_taken || made.is_some_and(|made| made != wanted) {
            let message = format!("`{}` would have two inverses", io.name.value);
            let why = "the levels before this are not those before another use of it";
            self.refuse(
                refusal(span, &message, why)
                    .with_label(io.name.span, "declared here")
                    .with_help("give it a counterpart: `io NAME { .. } reverse OTHER`"),
            );
            return None;
        }
        let inverse = IoOperation { name, primitives, counterpart: None, span: io.span };
        // Its key lives as long as the program.
        let key = self.plan.io_name(io.name.value)?;
        self.io.made.insert(key, inverse);
        Some(Spanned::new(name.value, span))
    }
}

/// What an I/O operation does, as text.
pub(super) fn body_text(primitives: &[Primitive<'_>]) -> String {
    let name = Spanned::new("_", Span::default());
    let primitives = primitives.to_vec();
    let io = IoOperation { name, primitives, counterpart: None, span: Span::default() };
    print(&Program { items: vec![Item::Io(io)] })
}
