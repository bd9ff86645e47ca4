//! What an error says of incidents: the faults that raise it, and what recovering may cost; and
//! what must hold lest one is thrown.

use super::Checker;
use super::errors::once;
use super::expression::Need;
use super::names::Meaning;
use crate::faults::{NamedFault, named};
use crate::tree::{ExpressionKind, StatementKind};
use crate::types::ValueType;
use obverse_bytecode::{Bounds, FaultName, Watched};
use obverse_syntax::ast::{self, Bound, Cause, FaultWord, Name};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::{Span, Spanned};

/// How many attempts an incident may have at the most: as many as a jump can compare with.
const MAX_ATTEMPTS: u64 = i16::MAX as u64;
/// How many conditions an error may have watched, as a module may.
const MAX_WATCHES: usize = 64;

impl<'s> Checker<'s> {
    /// `on protective stop, collision`; each fault raises one error.
    pub(super) fn faults(&mut self, causes: &[Cause<'s>]) -> Vec<FaultName> {
        let mut faults = Vec::new();
        for cause in causes {
            let Cause::Fault(Spanned { value: word, span }) = cause else { continue };
            match self.faults.get(word).copied() {
                Some(first) => self.report_fault_twice(*word, *span, first),
                None => {
                    self.faults.insert(*word, *span);
                    self.named_faults.push(NamedFault { word: *word, span: *span });
                    faults.push(named(*word));
                }
            }
        }
        faults.sort_unstable();
        faults
    }

    /// `on input door_closed low, force > 30 N`
    pub(super) fn watches(&mut self, causes: &[Cause<'s>]) -> Vec<Watched> {
        let mut watches = Vec::new();
        for cause in causes {
            let (watched, span) = match cause {
                Cause::Fault(_) => continue,
                Cause::Input { input, high, span } => {
                    (Watched::Input { bit: self.input(*input).0, level: *high }, *span)
                }
                Cause::Force(above) => {
                    (Watched::Force { above_n: self.force_above(above) }, above.span)
                }
            };
            if watches.len() == MAX_WATCHES {
                let message = format!("an error watches {MAX_WATCHES} conditions at the most");
                self.reports.error(Code::OutOfRange, span, message, "one too many");
                break;
            }
            watches.push(watched);
        }
        watches
    }

    /// A force in newtons, above nothing.
    fn force_above(&mut self, written: &ast::Expression<'s>) -> f64 {
        let value = self.constant(written);
        match self.fit(value, &Need::new(ValueType::FORCE, "`on force >`")).kind {
            ExpressionKind::Real(above_n) if above_n > 0.0 => above_n,
            ExpressionKind::Real(_) => {
                let message = "a force that is watched is more than nothing".to_owned();
                self.reports.error(Code::OutOfRange, written.span, message, "not more than zero");
                1.0
            }
            _ => 1.0,
        }
    }

    fn report_fault_twice(&mut self, word: FaultWord, again: Span, first: Span) {
        let message = format!("the fault {} raises an error already", word.text());
        let diagnostic = Diagnostic::error(Code::FaultTwice, again, message, "named again here")
            .with_label(first, "the first is here")
            .with_help("leave one of them out");
        self.reports.add(diagnostic);
    }

    /// `give up after 6 times, 90 s, 3 m`
    pub(super) fn bounds(&mut self, written: &[Bound<'s>]) -> Bounds {
        let mut places: [Option<((), Span)>; 3] = [None; 3];
        let mut bounds = Bounds::default();
        for bound in written {
            let (place, span) = match bound {
                Bound::Attempts(times) => {
                    bounds.attempts = self.attempts(*times);
                    (0, times.span)
                }
                Bound::Cost(cost) => match self.cost(cost) {
                    Some((ValueType::TIME, time_s)) => {
                        bounds.time_s = time_s;
                        (1, cost.span)
                    }
                    Some((_, distance_m)) => {
                        bounds.distance_m = distance_m;
                        (2, cost.span)
                    }
                    None => continue,
                },
            };
            if let Some(first) = once(&mut places[place], (), span) {
                self.report_twice("give up after", span, first);
            }
        }
        bounds
    }

    fn attempts(&mut self, times: Spanned<u64>) -> Option<u32> {
        if (1..=MAX_ATTEMPTS).contains(&times.value) {
            return u32::try_from(times.value).ok();
        }
        let message = format!("recovering is tried 1 to {MAX_ATTEMPTS} times");
        self.reports.error(Code::OutOfRange, times.span, message, "one cannot be tried so often");
        None
    }

    /// A time or a length, and how much; none where it is neither.
    fn cost(&mut self, written: &ast::Expression<'s>) -> Option<(ValueType, Option<f64>)> {
        let value = self.constant(written);
        if !matches!(value.of_type, ValueType::TIME | ValueType::LENGTH) {
            if !value.of_type.is_unknown() {
                let message = "recovering is bounded by a number of times, a time or a length";
                let at = value.of_type.to_string();
                let diagnostic = Diagnostic::error(Code::TypeMismatch, written.span, message, at)
                    .with_help("write for example `give up after 6 times, 90 s, 3 m`");
                self.reports.add(diagnostic);
            }
            return None;
        }
        let amount = match value.kind {
            ExpressionKind::Real(amount) if amount > 0.0 => Some(amount),
            ExpressionKind::Real(_) => {
                let message = "a bound is more than nothing".to_owned();
                self.reports.error(Code::OutOfRange, written.span, message, "not more than zero");
                None
            }
            _ => None,
        };
        Some((value.of_type, amount))
    }

    /// `requires CONDITION else throw NAME`
    pub(super) fn requires(
        &mut self,
        condition: &ast::Expression<'s>,
        error: Name<'s>,
        span: Span,
    ) -> Option<StatementKind> {
        let condition = self.value(condition, &Need::new(ValueType::Bool, "`requires`"));
        self.warn_of_constant(&condition, "leave the statement out, or ask for a reading");
        self.lose_position("recovering from this error may move the arm", span);
        let is_error = |meaning| matches!(meaning, Meaning::Error(_));
        match self.resolve(error, "an error", is_error)? {
            Meaning::Error(id) => Some(StatementKind::Requires(condition, id)),
            _ => None,
        }
    }
}
