//! Motions and calls: the way back goes to the place that the program named before.

use super::block::{Emitted, FirstMove, Inverter, Summary};
use super::effect::Declared;
use super::place::{Arm, Base, Spot, Way, opposite};
use super::refusal::refusal;
use super::walk;
use obverse_syntax::ast::{Argument, Expression, Heading, Name, StatementKind, Target, Turn};
use obverse_syntax::span::Span;
use std::collections::HashMap;

impl<'p> Inverter<'p> {
    /// `move …`
    pub(super) fn motion(
        &mut self,
        target: &'p Target<'p>,
        linear: bool,
        always: Option<Span>,
        span: Span,
    ) -> Vec<Emitted<'p>> {
        if let Target::Relative { heading, .. } | Target::Turned(Turn { heading, .. }) = target {
            self.shift(target, heading.value, span);
            let target = opposite_of(target);
            return vec![Emitted::new(StatementKind::Move { target, linear, always }, span)];
        }
        let Some(spot) = Spot::of(target, self.tool) else { return Vec::new() };
        let back = self.way_back(span);
        self.arm = Arm::at(spot);
        let back = back.map(|target| StatementKind::Move { target, linear, always });
        back.map(|kind| Emitted::new(kind, span)).into_iter().collect()
    }

    /// The arm is led away from a place, straight or by a turn.
    fn shift(&mut self, target: &'p Target<'p>, heading: Heading, span: Span) {
        let (by, frame): (Vec<&Expression<'p>>, _) = match target {
            Target::Relative { distance, frame, .. } => (vec![distance], frame),
            Target::Turned(turn) => (turn.amounts().collect(), &turn.frame),
            Target::Named(_) | Target::Keyframe { .. } => return,
        };
        by.iter().for_each(|amount| self.require_pure(amount));
        let way = Way {
            by: by.into_iter().cloned().collect(),
            is_turn: matches!(target, Target::Turned(_)),
            heading,
            frame: frame.map(|frame| frame.value),
            tool: self.tool,
        };
        self.arm.go(way, span);
    }

    /// Where a move that begins here leads back to; refused where that has no name.
    fn way_back(&mut self, span: Span) -> Option<Target<'p>> {
        match self.arm.spot().filter(|spot| spot.is_reached_with(self.tool)) {
            Some(spot) => Some(spot.target.clone()),
            None => {
                self.refuse_unnamed(span, "the way back from here is not known");
                None
            }
        }
    }

    /// Says why the place where the arm is has no name, unless that follows from another refusal.
    pub(super) fn refuse_unnamed(&mut self, span: Span, why: &str) {
        let message = "the arm leaves a place without a name here";
        let diagnostic = refusal(span, message, why);
        let named = "name the place by `joints` or a keyframe, and move there before this";
        self.refuse(match (self.arm.shifts.last(), &self.arm.base) {
            (_, Base::Refused) => return,
            (Some(shift), _) => diagnostic
                .with_label(shift.span, "this leads to a place without a name")
                .with_help(format!("{named}; or move back by the same distance")),
            (None, Base::Start) => diagnostic
                .with_note("where the arm is when a sequence begins, the sequence does not know")
                .with_help("begin the sequence with a move to a place with a name"),
            (None, Base::Named(spot)) => diagnostic
                .with_note(format!("the arm came to `{}` with another tool", spot.text()))
                .with_help("name the place by `joints`, or move there with this tool before this"),
            (None, Base::Lost(why, lost)) => diagnostic.with_label(*lost, *why).with_help(named),
        });
    }

    /// `call f(…)`: the inverse is called with the same arguments. It ends where the sequence
    /// begins, and the move that led there is taken back here.
    pub(super) fn call(
        &mut self,
        name: Name<'p>,
        arguments: &'p [Argument<'p>],
        span: Span,
    ) -> Vec<Emitted<'p>> {
        arguments.iter().for_each(|argument| self.require_pure(&argument.value));
        if !matches!(self.summaries.get(name.value), Some(Summary::Refused)) {
            self.require_kept_arguments(name, arguments, span);
        }
        let call = StatementKind::Call {
            name: self.plan.inverse_name(name),
            arguments: arguments.to_vec(),
        };
        let mut call = Emitted::new(call, span);
        let (first, last) = match self.summaries.get(name.value) {
            Some(Summary::Goes(first, last)) => (FirstMove::clone(first), last.clone()),
            Some(Summary::Strays) => {
                self.arm.stray(span);
                return vec![call];
            }
            Some(Summary::Refused) => {
                self.arm = Arm::refused();
                return Vec::new();
            }
            Some(Summary::Stays) | None => return vec![call],
        };
        let (Some(begin), Some(end)) =
            (self.outside(name, arguments, &first.spot), self.outside(name, arguments, &last))
        else {
            let message = "where this call begins or ends has no name here";
            let why = "its places are named by its own variables";
            self.refuse(refusal(span, message, why).with_help("name them by parameters"));
            return Vec::new();
        };
        call.first_move = Some(FirstMove { spot: end.clone(), is_linear: first.is_linear });
        let mut inverse = vec![call];
        if self.first_call == Some(span) {
            let spot = begin;
            self.first_move = Some(FirstMove { spot, is_linear: first.is_linear });
        } else if !self.arm.spot().is_some_and(|spot| spot.is_same(&begin)) {
            let target = self.way_back(span);
            let linear = first.is_linear;
            let back = target.map(|target| StatementKind::Move { target, linear, always: None });
            inverse.extend(back.map(|kind| Emitted::new(kind, span)));
        }
        self.arm = Arm::at(end);
        inverse
    }

    /// A place of what is called, as it is named here.
    fn outside(
        &self,
        name: Name<'p>,
        arguments: &'p [Argument<'p>],
        spot: &Spot<'p>,
    ) -> Option<Spot<'p>> {
        let parameters = &self.plan.sequence(name.value)?.parameters;
        let given = arguments.iter().enumerate().filter_map(|(position, argument)| {
            let name = argument.name.or(parameters.get(position).map(|known| known.name))?;
            Some((name.value, &argument.value))
        });
        let given: HashMap<_, _> = given.collect();
        spot.outside(&given, self.tool, |name| self.plan.is_of_program(name))
    }

    /// The inverse is called with the same values only if the call does not change them.
    fn require_kept_arguments(
        &mut self,
        name: Name<'p>,
        arguments: &'p [Argument<'p>],
        span: Span,
    ) {
        let effect = self.plan.effect_of_call(name.value);
        for argument in arguments {
            let names = walk::names_of(&argument.value);
            let variables: Vec<&str> =
                names.into_iter().filter(|name| !self.plan.is_constant(name)).collect();
            if effect.changes_any(&variables) {
                let message = "a call that changes what it is given has no inverse";
                let why = "this is something else after the call";
                self.refuse(
                    refusal(argument.value.span, message, why)
                        .with_label(span, "the call may change it")
                        .with_help("give it a variable that the call does not change"),
                );
            }
        }
    }
}

/// The same, the other way: what turns about the opposite axis turns and goes back.
fn opposite_of<'s>(target: &Target<'s>) -> Target<'s> {
    let mut target = target.clone();
    if let Target::Relative { heading, .. } | Target::Turned(Turn { heading, .. }) = &mut target {
        heading.value = opposite(heading.value);
    }
    target
}
