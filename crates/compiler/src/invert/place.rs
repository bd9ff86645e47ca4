//! Where the arm is, as far as the program names it: the place that it was moved to last, and the
//! relative moves since. It knows nothing of inverses.

use super::walk;
use obverse_syntax::ast::{Expression, ExpressionKind, FrameWord, Heading, Target};
use obverse_syntax::format::print_expression;
use obverse_syntax::span::Span;
use std::collections::HashMap;

/// The tool that a sequence has set; none where it is the one that it began with.
pub(super) type Tool<'s> = Option<&'s str>;

/// A place with a name.
#[derive(Clone, Debug)]
pub(super) struct Spot<'s> {
    /// What is written after `move to`.
    pub(super) target: Target<'s>,
    /// With which tool: a keyframe is where the tool's tip is.
    pub(super) tool: Tool<'s>,
}

impl<'s> Spot<'s> {
    /// The place that a move names, if it names one.
    pub(super) fn of(target: &Target<'s>, tool: Tool<'s>) -> Option<Self> {
        match target {
            Target::Named(_) | Target::Keyframe { .. } => {
                Some(Self { target: target.clone(), tool })
            }
            Target::Relative { .. } | Target::Turned(_) => None,
        }
    }

    /// As written.
    pub(super) fn text(&self) -> String {
        match &self.target {
            Target::Named(name) => name.value.to_owned(),
            Target::Keyframe { item, keyframe } => format!("{}.{}", item.value, keyframe.value),
            Target::Relative { .. } | Target::Turned(_) => String::new(),
        }
    }

    /// Whether a move there with this tool leads there.
    pub(super) fn is_reached_with(&self, tool: Tool<'s>) -> bool {
        !matches!(self.target, Target::Keyframe { .. }) || self.tool == tool
    }

    pub(super) fn is_same(&self, other: &Self) -> bool {
        self.text() == other.text() && self.is_reached_with(other.tool)
    }

    /// The same place for who calls with these arguments and this tool; none where it has no name.
    pub(super) fn outside(
        &self,
        arguments: &HashMap<&'s str, &Expression<'s>>,
        tool: Tool<'s>,
        is_global: impl Fn(&str) -> bool,
    ) -> Option<Self> {
        let mut target = self.target.clone();
        let (Target::Named(name) | Target::Keyframe { item: name, .. }) = &mut target else {
            return None;
        };
        match arguments.get(name.value) {
            Some(Expression { kind: ExpressionKind::Name(given), .. }) => name.value = given,
            None if is_global(name.value) => {}
            _ => return None,
        }
        Some(Self { target, tool: self.tool.or(tool) })
    }
}

/// Where the arm is.
#[derive(Clone, Debug)]
pub(super) struct Arm<'s> {
    pub(super) base: Base<'s>,
    /// The relative moves since, but for those that have been followed back.
    pub(super) shifts: Vec<Shift<'s>>,
}

/// Where relative moves begin.
#[derive(Clone, Debug)]
pub(super) enum Base<'s> {
    /// Where the sequence began.
    Start,
    /// At a place with a name.
    Named(Spot<'s>),
    /// Somewhere else, for this reason.
    Lost(&'static str, Span),
    /// Somewhere behind what has been refused: nothing more is said of it.
    Refused,
}

/// A way away from a place.
#[derive(Clone, Debug)]
pub(super) struct Shift<'s> {
    /// Which way; none where nothing can be said of it.
    pub(super) way: Option<Way<'s>>,
    /// Where it is commanded.
    pub(super) span: Span,
}

/// A straight way, or a turn.
#[derive(Clone, Debug)]
pub(super) struct Way<'s> {
    /// The distance; of a turn the angle, and how far it advances if that is said.
    pub(super) by: Vec<Expression<'s>>,
    pub(super) is_turn: bool,
    pub(super) heading: Heading,
    pub(super) frame: Option<FrameWord>,
    pub(super) tool: Tool<'s>,
}

impl Way<'_> {
    /// Whether one leads back over the other.
    fn is_opposite(&self, other: &Self) -> bool {
        let frame = |way: &Self| way.frame.unwrap_or(FrameWord::Tcp);
        self.heading == opposite(other.heading)
            && frame(self) == frame(other)
            && self.tool == other.tool
            && self.is_turn == other.is_turn
            && self.by.iter().map(print_expression).eq(other.by.iter().map(print_expression))
    }

    fn is_same(&self, other: &Self) -> bool {
        self.is_opposite(&Self { heading: opposite(other.heading), ..other.clone() })
    }
}

impl<'s> Arm<'s> {
    /// At the beginning of a sequence.
    pub(super) fn new() -> Self {
        Self { base: Base::Start, shifts: Vec::new() }
    }

    pub(super) fn at(spot: Spot<'s>) -> Self {
        Self { base: Base::Named(spot), shifts: Vec::new() }
    }

    pub(super) fn lost(why: &'static str, span: Span) -> Self {
        Self { base: Base::Lost(why, span), shifts: Vec::new() }
    }

    /// Behind what has been refused.
    pub(super) fn refused() -> Self {
        Self { base: Base::Refused, shifts: Vec::new() }
    }

    pub(super) fn is_refused(&self) -> bool {
        matches!(self.base, Base::Refused)
    }

    /// The place where it is, if that has a name.
    pub(super) fn spot(&self) -> Option<&Spot<'s>> {
        match &self.base {
            Base::Named(spot) if self.shifts.is_empty() => Some(spot),
            _ => None,
        }
    }

    /// After a relative move.
    pub(super) fn go(&mut self, way: Way<'s>, span: Span) {
        let last = self.shifts.last().and_then(|shift| shift.way.as_ref());
        match last.is_some_and(|last| last.is_opposite(&way)) {
            true => _ = self.shifts.pop(),
            false => self.shifts.push(Shift { way: Some(way), span }),
        }
    }

    /// After some way of which nothing is known.
    pub(super) fn stray(&mut self, span: Span) {
        self.shifts.push(Shift { way: None, span });
    }

    /// After a variable has changed: what was named by it is so no more.
    pub(super) fn forget(&mut self, changed: &str, span: Span) {
        self.forget_all(|name| name != changed, span);
    }

    /// After all has changed but what these names stand for.
    pub(super) fn forget_all(&mut self, is_kept: impl Fn(&str) -> bool, span: Span) {
        if let Base::Named(spot) = &self.base
            && !walk::names_of_target(&spot.target).into_iter().all(&is_kept)
        {
            self.base = Base::Lost("the variable that names the place is changed here", span);
        }
        for shift in &mut self.shifts {
            let is_known = |way: &Way<'_>| way.by.iter().flat_map(walk::names_of).all(&is_kept);
            shift.way = shift.way.take().filter(is_known);
        }
    }

    pub(super) fn is_same(&self, other: &Self) -> bool {
        let same_base = match (&self.base, &other.base) {
            (Base::Start, Base::Start) | (Base::Refused, Base::Refused) => true,
            (Base::Named(a), Base::Named(b)) => a.is_same(b),
            (Base::Lost(_, a), Base::Lost(_, b)) => a == b,
            _ => false,
        };
        let same_way = |(a, b): (&Shift<'_>, &Shift<'_>)| match (&a.way, &b.way) {
            (Some(a), Some(b)) => a.is_same(b),
            _ => a.span == b.span && a.way.is_none() == b.way.is_none(),
        };
        same_base
            && self.shifts.len() == other.shifts.len()
            && self.shifts.iter().zip(&other.shifts).all(same_way)
    }
}

/// The heading that leads back.
pub(super) fn opposite(heading: Heading) -> Heading {
    match heading {
        Heading::Forward => Heading::Backward,
        Heading::Backward => Heading::Forward,
        Heading::Left => Heading::Right,
        Heading::Right => Heading::Left,
        Heading::Up => Heading::Down,
        Heading::Down => Heading::Up,
        Heading::X => Heading::MinusX,
        Heading::MinusX => Heading::X,
        Heading::Y => Heading::MinusY,
        Heading::MinusY => Heading::Y,
        Heading::Z => Heading::MinusZ,
        Heading::MinusZ => Heading::Z,
    }
}
