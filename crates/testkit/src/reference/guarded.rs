//! Advanced moves: a motion that a force may stop, what success is, and what follows.

use super::value::Value;
use super::{Frame, Interpreter, Run, Trap};
use crate::reference::motion::across;
use crate::reference::statement::speed;
use obverse_geometry::JointConfiguration;
use obverse_syntax::ast::{
    AdvancedMove, Behaviour, Expression, ExpressionKind, FrameWord, Heading, MoveClause, SpeedWord,
};
use obverse_syntax::span::Spanned;
use obverse_workcell::{Goal, Path};

/// A move that came closer than this to its distance has come all the way, in metres.
const SHORTFALL_M: f64 = 1e-6;
/// How far to the side a move is tried again where nothing is said, in metres.
const PERTURBATION_M: f64 = 1e-3;

/// What an advanced move says.
#[derive(Default)]
struct Clauses<'p> {
    requires: Option<(&'p Expression<'p>, Option<&'p str>)>,
    way: Option<Way<'p>>,
    limit: Option<&'p Expression<'p>>,
    speed: Option<SpeedWord>,
    succeeds: Option<&'p Expression<'p>>,
    on_success: Aftermath<'p>,
    on_failure: Aftermath<'p>,
}

impl Clauses<'_> {
    /// Whether anything follows from success or failure; otherwise it is not asked which it was.
    fn matters(&self) -> bool {
        [self.on_success, self.on_failure].iter().any(|aftermath| {
            aftermath.returns || aftermath.repeats.is_some() || aftermath.throws.is_some()
        })
    }
}

/// How far, and in which direction.
#[derive(Clone, Copy)]
struct Way<'p> {
    /// If it is a turn, by what angle.
    angle: Option<&'p Expression<'p>>,
    /// None of a turn that does not advance.
    distance: Option<&'p Expression<'p>>,
    heading: Heading,
    frame: Option<Spanned<FrameWord>>,
}

/// What is done afterwards.
#[derive(Clone, Copy, Default)]
struct Aftermath<'p> {
    returns: bool,
    repeats: Option<(Option<&'p Expression<'p>>, u64)>,
    throws: Option<&'p str>,
}

/// The values that hold for all attempts.
struct Numbers {
    angle_rad: Option<f64>,
    distance_m: f64,
    /// None where no force stops the move: contact is a collision then.
    limit_n: Option<f64>,
}

impl<'p> Interpreter<'p, '_> {
    /// `advance NAME`; what it throws is pending afterwards.
    pub(super) fn advance(&mut self, name: &str) -> Run<()> {
        let Some(guarded) = self.names.moves.get(name) else { return Ok(()) };
        let clauses = gather(guarded);
        let Some(way) = clauses.way else { return Ok(()) };
        let frame = Frame { function: guarded.name.value, ..Frame::default() };
        self.within(frame, |interpreter| interpreter.guarded(&clauses, way))
    }

    fn guarded(&mut self, clauses: &Clauses<'p>, way: Way<'p>) -> Run<()> {
        let initial = self.cell.joints();
        if let Some((condition, otherwise)) = clauses.requires
            && !self.value(condition)?.holds()
        {
            let error = otherwise.or(clauses.on_failure.throws).ok_or(Trap::Required)?;
            self.raise(error);
            return Ok(());
        }
        let numbers = self.numbers(clauses, way)?;
        let succeeded = self.attempts(clauses, way, &numbers, initial)?;
        let aftermath = if succeeded { clauses.on_success } else { clauses.on_failure };
        if aftermath.returns {
            self.go(Goal::Joints(initial), Path::Linear, None)?;
        }
        aftermath.throws.into_iter().for_each(|error| self.raise(error));
        Ok(())
    }

    fn numbers(&mut self, clauses: &Clauses<'p>, way: Way<'p>) -> Run<Numbers> {
        let written = [way.angle, way.distance, clauses.limit];
        let all: Vec<&Expression<'p>> = written.into_iter().flatten().collect();
        let mut values = self.all_values(&all)?.into_iter();
        let mut next = |written: Option<_>| written.and_then(|_| values.next()).map(Value::real);
        Ok(Numbers {
            angle_rad: next(way.angle),
            distance_m: next(way.distance).unwrap_or(0.0),
            limit_n: next(clauses.limit),
        })
    }

    /// Attempts until one succeeds, all but the first from somewhat aside; whether one did.
    fn attempts(
        &mut self,
        clauses: &Clauses<'p>,
        way: Way<'p>,
        numbers: &Numbers,
        initial: JointConfiguration,
    ) -> Run<bool> {
        let Some((within, times)) = clauses.on_failure.repeats else {
            return self.attempt(clauses, way, numbers);
        };
        let within_m = match within {
            Some(within) => self.value(within)?.real(),
            None => PERTURBATION_M,
        };
        for attempt in 0..=times {
            self.step()?;
            if attempt > 0 {
                self.perturb(way, within_m, initial)?;
            }
            if self.attempt(clauses, way, numbers)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Back to where the move began, and from there to the side.
    fn perturb(&mut self, way: Way<'p>, within_m: f64, initial: JointConfiguration) -> Run<()> {
        let mut aside = || {
            let drawn = self.cell.draw(self.draws);
            self.draws = self.draws.wrapping_add(1);
            (2.0 * drawn - 1.0) * within_m
        };
        let (first, second) = (aside(), aside());
        self.go(Goal::Joints(initial), Path::Linear, None)?;
        let (by_m, frame) = across(way.heading, way.frame, first, second);
        let from = self.cell.joints();
        self.go(Goal::Offset { from, by_m, frame }, Path::Linear, None)?;
        Ok(())
    }

    fn attempt(&mut self, clauses: &Clauses<'p>, way: Way<'p>, numbers: &Numbers) -> Run<bool> {
        let before = self.speed;
        self.speed = clauses.speed.map_or(before, speed);
        let by_m = numbers.distance_m;
        let goal = match numbers.angle_rad {
            Some(angle_rad) => self.turned([angle_rad, by_m], way.heading, way.frame),
            None => self.displaced(by_m, way.heading, way.frame),
        };
        let report = self.go(goal, Path::Linear, numbers.limit_n)?;
        self.speed = before;
        if !clauses.matters() {
            return Ok(true);
        }
        let Some(condition) = clauses.succeeds else {
            if way.angle.is_some() {
                return Ok(numbers.limit_n.is_none_or(|limit_n| report.peak_force_n <= limit_n));
            }
            return Ok(numbers.distance_m - SHORTFALL_M <= report.distance_m);
        };
        self.judged = Some(report);
        let succeeded = self.value(condition)? == Value::Bool(true);
        self.judged = None;
        Ok(succeeded)
    }
}

fn gather<'p>(guarded: &'p AdvancedMove<'p>) -> Clauses<'p> {
    let mut clauses = Clauses::default();
    for clause in &guarded.clauses {
        match &clause.value {
            MoveClause::Requires { condition, otherwise } => {
                let otherwise = otherwise.map(|error| error.value);
                clauses.requires = Some((condition, otherwise));
            }
            MoveClause::Distance { distance, heading, frame } => {
                let (distance, heading) = (Some(distance), heading.value);
                clauses.way = Some(Way { angle: None, distance, heading, frame: *frame });
            }
            MoveClause::Turn(turn) => {
                clauses.way = Some(Way {
                    angle: Some(&turn.angle),
                    distance: turn.advance.as_ref(),
                    heading: turn.heading.value,
                    frame: turn.frame,
                });
            }
            MoveClause::StopIf(condition) => clauses.limit = limit(condition),
            MoveClause::Speed(word) => clauses.speed = Some(*word),
            MoveClause::SucceedsIf(condition) => clauses.succeeds = Some(condition),
            MoveClause::OnSuccess(behaviours) => clauses.on_success = aftermath(behaviours),
            MoveClause::OnFailure(behaviours) => clauses.on_failure = aftermath(behaviours),
            // Of the way back alone.
            MoveClause::OppositeForce => {}
        }
    }
    clauses
}

/// What a force is compared with.
fn limit<'p>(condition: &'p Expression<'p>) -> Option<&'p Expression<'p>> {
    match &condition.kind {
        ExpressionKind::Binary { left, right, .. } => match left.kind {
            ExpressionKind::Force => Some(right),
            _ => Some(left),
        },
        _ => None,
    }
}

/// What follows; behind a `throw` nothing does.
fn aftermath<'p>(behaviours: &'p [Spanned<Behaviour<'p>>]) -> Aftermath<'p> {
    let mut aftermath = Aftermath::default();
    for behaviour in behaviours {
        match &behaviour.value {
            Behaviour::ReturnToInitialPosition => aftermath.returns = true,
            Behaviour::RepeatWithPerturbation { within, times } => {
                aftermath.repeats = Some((within.as_ref(), times.value));
            }
            Behaviour::Throw(name) => {
                aftermath.throws = Some(name.value);
                break;
            }
        }
    }
    aftermath
}
