//! Advanced moves: their clauses, what stops them, what they do afterwards.

use super::Checker;
use super::errors::once;
use super::expression::Need;
use super::frame::Readings;
use super::function::last_byte;
use super::motion::direction;
use super::names::Meaning;
use super::operators::binary;
use super::statement::speed;
use crate::report::warning;
use crate::tree::{
    Aftermath, Body, Expression, ExpressionKind, Function, GuardedMove, MoveResults, MoveSpans,
    Prepared, Retry, Unmet,
};
use crate::types::ValueType;
use obverse_bytecode::FunctionKind;
use obverse_isa::{FunctionId, Instr, SlotId, Type};
use obverse_syntax::ast::{
    self, AdvancedMove, Behaviour, BinaryOperator, FrameWord, Heading, MoveClause, SpeedWord, Turn,
};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::format::print_expression;
use obverse_syntax::span::{Span, Spanned};

/// A move that came closer than this to its distance has come all the way, in metres.
const SHORTFALL_M: f64 = 1e-6;
/// The sideways offset of a repeated move where none is given, in metres.
const PERTURBATION_M: f64 = 1e-3;
/// How often a move is tried again at the most.
const MAX_TIMES: u64 = 1_000_000;

/// The clause `distance …` or `turn …`.
struct WayClause<'a, 's> {
    angle: Option<&'a ast::Expression<'s>>,
    /// Of a turn, how far it advances.
    distance: Option<&'a ast::Expression<'s>>,
    heading: Heading,
    frame: Option<Spanned<FrameWord>>,
}

/// The clauses of an advanced move by kind, with their places.
#[derive(Default)]
struct Clauses<'a, 's> {
    requires: Option<((&'a ast::Expression<'s>, Option<ast::Name<'s>>), Span)>,
    way: Option<(WayClause<'a, 's>, Span)>,
    stop_if: Option<(&'a ast::Expression<'s>, Span)>,
    speed: Option<(SpeedWord, Span)>,
    succeeds_if: Option<(&'a ast::Expression<'s>, Span)>,
    on_success: Option<(&'a [Spanned<Behaviour<'s>>], Span)>,
    on_failure: Option<(&'a [Spanned<Behaviour<'s>>], Span)>,
    opposite: Option<((), Span)>,
}

impl<'s> Checker<'s> {
    /// `advanced move insert_peg { … }`
    pub(super) fn check_guarded(
        &mut self,
        id: FunctionId,
        written: &AdvancedMove<'s>,
    ) -> Option<Function> {
        let mut clauses = self.gather_move_clauses(&written.clauses);
        let Some((way, motion)) = clauses.way.take() else {
            let message =
                format!("the advanced move `{}` does not say how far it goes", written.name.value);
            let diagnostic = Diagnostic::error(
                Code::MissingClause,
                written.name.span,
                message,
                "`distance` is missing",
            )
            .with_help("write for example `distance 300 mm forward in tcp`");
            self.reports.add(diagnostic);
            return None;
        };
        let check = |checker: &mut Self| {
            let end = last_byte(written.span);
            Body::Guarded(Box::new(checker.guarded(&clauses, &way, motion, end)))
        };
        Some(self.function(id, written.name, FunctionKind::AdvancedMove, check))
    }

    fn gather_move_clauses<'a>(
        &mut self,
        written: &'a [Spanned<MoveClause<'s>>],
    ) -> Clauses<'a, 's> {
        let mut clauses = Clauses::default();
        for Spanned { value, span } in written {
            let span = *span;
            let first = match value {
                MoveClause::Requires { condition, otherwise } => {
                    let clause = (condition, *otherwise);
                    ("requires", once(&mut clauses.requires, clause, span))
                }
                MoveClause::Distance { distance, heading, frame } => {
                    let (heading, frame) = (heading.value, *frame);
                    let way = WayClause { angle: None, distance: Some(distance), heading, frame };
                    ("distance", once(&mut clauses.way, way, span))
                }
                MoveClause::Turn(Turn { angle, advance, heading, frame }) => {
                    let (angle, distance) = (Some(angle), advance.as_ref());
                    let (heading, frame) = (heading.value, *frame);
                    let way = WayClause { angle, distance, heading, frame };
                    ("turn", once(&mut clauses.way, way, span))
                }
                MoveClause::StopIf(condition) => {
                    ("stop if", once(&mut clauses.stop_if, condition, span))
                }
                MoveClause::Speed(word) => ("speed", once(&mut clauses.speed, *word, span)),
                MoveClause::SucceedsIf(condition) => {
                    ("succeeds if", once(&mut clauses.succeeds_if, condition, span))
                }
                MoveClause::OnSuccess(behaviours) => {
                    ("on success", once(&mut clauses.on_success, behaviours.as_slice(), span))
                }
                MoveClause::OnFailure(behaviours) => {
                    ("on failure", once(&mut clauses.on_failure, behaviours.as_slice(), span))
                }
                MoveClause::OppositeForce => {
                    ("opposite force", once(&mut clauses.opposite, (), span))
                }
            };
            if let (word, Some(first)) = first {
                self.report_twice(word, span, first);
            }
        }
        clauses
    }

    fn guarded(
        &mut self,
        clauses: &Clauses<'_, 's>,
        way: &WayClause<'_, 's>,
        motion: Span,
        end: Span,
    ) -> GuardedMove {
        let requires = clauses.requires.map(|(requires, span)| self.move_requires(requires, span));
        let (angle, distance) = self.move_amounts(way, motion);
        let (axis, frame) = direction(way.heading, way.frame);
        let limit = clauses.stop_if.map(|(condition, span)| self.force_limit(condition, span));
        if limit.as_ref().is_some_and(|limit| !limit.value.of_type.is_unknown()) {
            self.warn_of_silent_stop(clauses);
        }
        if let (Some(((), span)), None) = (clauses.opposite, &limit) {
            self.report_nothing_opposed(span);
        }
        let speed = clauses
            .speed
            .map(|(word, span)| (speed(word), self.hidden("speed", Type::Speed, span)));
        let results = MoveResults {
            distance: self.hidden("distance", Type::Real, motion),
            force: self.hidden("force", Type::Real, motion),
        };
        let (succeeds, succeeds_span) = match clauses.succeeds_if {
            Some((condition, span)) => (self.succeeds(condition, results), span),
            None if angle.is_some() => (was_not_stopped(limit.as_ref(), results, motion), motion),
            None => (came_all_the_way(&distance.value, results, motion), motion),
        };
        let (on_success, repeat) = self.aftermath(clauses.on_success);
        if let Some((_, span)) = repeat {
            self.report_misplaced_repeat(span, "`on success` has nothing to try again");
        }
        let (on_failure, repeat) = self.aftermath(clauses.on_failure);
        let repeat = repeat.map(|(repeat, span)| self.retry(repeat, span));
        let returns = on_success.returns.or(on_failure.returns).is_some();
        let initial = (returns || repeat.is_some()).then(|| {
            self.frame.layout.slots.push("$initial".to_owned());
            SlotId(0)
        });
        if angle.is_some() {
            let returns = [&on_success, &on_failure].map(|aftermath| aftermath.returns);
            let opposite = clauses.opposite.map(|((), span)| span);
            let unturned = returns.into_iter().chain([repeat.as_ref().map(|repeat| repeat.span)]);
            let first = unturned.chain([opposite]).flatten().next();
            first.into_iter().for_each(|span| self.report_not_of_a_turn(span, motion));
        }
        let spans = MoveSpans { motion, succeeds: succeeds_span, end };
        GuardedMove {
            requires,
            angle,
            distance,
            axis,
            frame,
            limit,
            is_opposed: clauses.opposite.is_some(),
            speed,
            results,
            succeeds,
            on_success,
            on_failure,
            repeat,
            initial,
            spans,
        }
    }

    /// Where a turn began may be whole turns away, and only reversing turns the tool back.
    fn report_not_of_a_turn(&mut self, span: Span, motion: Span) {
        let message = "a turn is taken back by reversing alone";
        let diagnostic =
            Diagnostic::error(Code::MisplacedBehaviour, span, message, "cannot stand here")
                .with_label(motion, "the turn")
                .with_help("throw an error that recovers `by reversing`, or leave this out");
        self.reports.add(diagnostic);
    }

    fn report_nothing_opposed(&mut self, span: Span) {
        let message = format!("no force stops `{}`, so that none has an opposite", self.frame.name);
        let diagnostic =
            Diagnostic::error(Code::MissingClause, span, message, "`stop if` is missing")
                .with_help("write for example `stop if force > 5 N`, or leave this out");
        self.reports.add(diagnostic);
    }

    /// A move that is stopped has failed, and here nobody would know.
    fn warn_of_silent_stop(&mut self, clauses: &Clauses<'_, 's>) {
        let Some((_, span)) = clauses.stop_if else { return };
        if clauses.succeeds_if.is_some() || clauses.on_failure.is_some() {
            return;
        }
        let message = format!(
            "`{}` fails when this stops it, and the program goes on all the same",
            self.frame.name
        );
        self.reports.add(
            warning(Code::SilentStop, span, message, "being stopped counts as failure").with_help(
                "say what is to follow by `on failure { .. }`, or what success is by `succeeds if`",
            ),
        );
    }

    fn move_requires(
        &mut self,
        (condition, otherwise): (&ast::Expression<'s>, Option<ast::Name<'s>>),
        span: Span,
    ) -> (Prepared, Unmet) {
        let is_error = |meaning| matches!(meaning, Meaning::Error(_));
        let thrown = otherwise.and_then(|name| self.resolve(name, "an error", is_error));
        let reason = format!("{} requires {}", self.frame.name, print_expression(condition));
        let reason = self.reason(Spanned::new(&reason, span));
        let condition = self.prepared(condition, &Need::new(ValueType::Bool, "`requires`"));
        self.warn_of_constant(&condition.value, "leave the clause out, or ask for a reading");
        let unmet = match thrown {
            Some(Meaning::Error(error)) => Unmet::Throws(error),
            _ => Unmet::Fails(reason),
        };
        (condition, unmet)
    }

    /// How far it is turned, if it is, and how far it goes.
    fn move_amounts(
        &mut self,
        way: &WayClause<'_, 's>,
        motion: Span,
    ) -> (Option<Prepared>, Prepared) {
        let Some(angle) = way.angle else {
            let nowhere = || alone(Expression::missing(motion));
            return (None, way.distance.map_or_else(nowhere, |far| self.move_distance(far)));
        };
        let angle = self.stored(angle, &Need::new(ValueType::ANGLE, "`turn`"));
        let advance = match way.distance {
            Some(advance) => self.stored(advance, &Need::new(ValueType::LENGTH, "`advancing`")),
            None => alone(Expression::real(0.0, ValueType::LENGTH, motion)),
        };
        (Some(angle), advance)
    }

    fn move_distance(&mut self, written: &ast::Expression<'s>) -> Prepared {
        let distance = self.stored(written, &Need::new(ValueType::LENGTH, "`distance`"));
        if matches!(distance.value.kind, ExpressionKind::Real(metres) if metres <= 0.0) {
            let message = "an advanced move goes some way; where to, its heading says".to_owned();
            self.reports.error(Code::OutOfRange, written.span, message, "not more than zero");
        }
        distance
    }

    /// `stop if force > 5 N`: the force.
    fn force_limit(&mut self, condition: &ast::Expression<'s>, span: Span) -> Prepared {
        use BinaryOperator::{Greater, GreaterOrEqual, Less, LessOrEqual};
        use ast::ExpressionKind::{Binary, Force, Missing};
        let limit = match &condition.kind {
            Binary { operator: Greater | GreaterOrEqual, left, right }
                if matches!(left.kind, Force) =>
            {
                right
            }
            Binary { operator: Less | LessOrEqual, left, right } if matches!(right.kind, Force) => {
                left
            }
            Missing => return alone(Expression::missing(condition.span)),
            _ => {
                let message = "a move is stopped by its contact force alone".to_owned();
                let diagnostic = Diagnostic::error(
                    Code::StopCondition,
                    condition.span,
                    message,
                    "not a limit of force",
                )
                .with_help("write `stop if force > 5 N`; how far it goes is its `distance`");
                self.reports.add(diagnostic);
                return alone(Expression::missing(condition.span));
            }
        };
        let limit = self.stored(limit, &Need::new(ValueType::FORCE, "`stop if force >`"));
        if matches!(limit.value.kind, ExpressionKind::Real(newtons) if newtons < 0.0) {
            let message = "a force is not negative".to_owned();
            self.reports.error(Code::OutOfRange, span, message, "stops before it begins");
        }
        limit
    }

    /// A value that is computed once, before the attempts.
    fn stored(&mut self, written: &ast::Expression<'s>, need: &Need) -> Prepared {
        let Prepared { hoists, value } = self.prepared(written, need);
        hoists.into_iter().for_each(|hoist| self.frame.hoist(hoist));
        let value = self.twice(value);
        Prepared { hoists: self.frame.take_hoists(), value }
    }

    fn succeeds(&mut self, condition: &ast::Expression<'s>, results: MoveResults) -> Prepared {
        self.frame.readings = Readings::OfMove(results);
        let prepared = self.prepared(condition, &Need::new(ValueType::Bool, "`succeeds if`"));
        self.frame.readings = Readings::Taken;
        prepared
    }

    /// What follows success or failure, and the repetition among it.
    #[expect(clippy::type_complexity, reason = "a pair of optional parts of the tree")]
    fn aftermath<'a>(
        &mut self,
        behaviours: Option<(&'a [Spanned<Behaviour<'s>>], Span)>,
    ) -> (Aftermath, Option<((Option<&'a ast::Expression<'s>>, Spanned<u64>), Span)>) {
        let mut aftermath = Aftermath::default();
        let mut repeat = None;
        let behaviours = behaviours.map_or(&[][..], |(behaviours, _)| behaviours);
        for (index, Spanned { value, span }) in behaviours.iter().enumerate() {
            match value {
                Behaviour::ReturnToInitialPosition => aftermath.returns = Some(*span),
                Behaviour::RepeatWithPerturbation { within, times } => {
                    if repeat.is_some() {
                        self.report_misplaced_repeat(*span, "the move is tried again already");
                    }
                    repeat = Some(((within.as_ref(), *times), *span));
                }
                Behaviour::Throw(name) => {
                    let is_error = |meaning| matches!(meaning, Meaning::Error(_));
                    if let Some(Meaning::Error(error)) = self.resolve(*name, "an error", is_error) {
                        aftermath.throws = Some((error, *span));
                    }
                    self.warn_after_throw(&behaviours[index + 1..]);
                    break;
                }
            }
        }
        (aftermath, repeat)
    }

    fn warn_after_throw(&mut self, rest: &[Spanned<Behaviour<'s>>]) {
        if let (Some(first), Some(last)) = (rest.first(), rest.last()) {
            let span = first.span.to(last.span);
            let message = "what follows `throw` is never reached";
            self.reports.add(
                warning(Code::Unreachable, span, message, "never reached")
                    .with_help("put it before `throw`"),
            );
        }
    }

    fn report_misplaced_repeat(&mut self, span: Span, why: &str) {
        let message = format!("the move cannot be repeated here: {why}");
        let diagnostic =
            Diagnostic::error(Code::MisplacedBehaviour, span, message, "cannot stand here")
                .with_help("`repeat with perturbation` stands once, in `on failure`");
        self.reports.add(diagnostic);
    }

    fn retry(
        &mut self,
        (within, times): (Option<&ast::Expression<'s>>, Spanned<u64>),
        span: Span,
    ) -> Retry {
        let within = match within {
            Some(within) => {
                self.stored(within, &Need::new(ValueType::LENGTH, "`repeat with perturbation`"))
            }
            None => alone(Expression::real(PERTURBATION_M, ValueType::LENGTH, span)),
        };
        if !(1..=MAX_TIMES).contains(&times.value) {
            let message = format!("a move is tried again 1 to {MAX_TIMES} times");
            let at = format!("{} times", times.value);
            self.reports.error(Code::OutOfRange, times.span, message, &at);
        }
        self.frame.layout.counters = 1;
        let draws =
            [self.hidden("aside", Type::Real, span), self.hidden("aside", Type::Real, span)];
        Retry { times: i32::try_from(times.value).unwrap_or(1), within, draws, span }
    }
}

/// A value for which nothing is read.
fn alone(value: Expression) -> Prepared {
    Prepared { hoists: Vec::new(), value }
}

/// Whether a move came as far as it should.
fn came_all_the_way(distance: &Expression, results: MoveResults, span: Span) -> Prepared {
    if distance.of_type.is_unknown() {
        return alone(Expression::missing(span));
    }
    let shortfall = Expression::real(SHORTFALL_M, ValueType::LENGTH, span);
    let needed = binary(Instr::RealSub {}, distance.clone(), shortfall, ValueType::LENGTH, span);
    let came = Expression::local(results.distance, ValueType::LENGTH, span);
    alone(binary(Instr::RealLe {}, needed, came, ValueType::Bool, span))
}

/// Whether a turn was not stopped by its force.
fn was_not_stopped(limit: Option<&Prepared>, results: MoveResults, span: Span) -> Prepared {
    let Some(limit) = limit else {
        let kind = ExpressionKind::Bool(true);
        return alone(Expression { kind, of_type: ValueType::Bool, span });
    };
    if limit.value.of_type.is_unknown() {
        return alone(Expression::missing(span));
    }
    let felt = Expression::local(results.force, ValueType::FORCE, span);
    alone(binary(Instr::RealLe {}, felt, limit.value.clone(), ValueType::Bool, span))
}
