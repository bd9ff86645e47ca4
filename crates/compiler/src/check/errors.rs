//! Errors as the program declares them: defaults, and clauses that exclude one another.

use super::Checker;
use super::expression::Need;
use super::names::{Found, Meaning};
use crate::tree::ExpressionKind;
use crate::types::ValueType;
use obverse_bytecode::{
    Bounds, Continuation, Depth, Extent, Otherwise, Pattern, Perturbation, Recovery, Respond,
    Reversal, Severity,
};
use obverse_isa::{CheckpointId, FunctionId};
use obverse_syntax::ast::{self, Bound, Cause, Change, ErrorClause, Name};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::{Span, Spanned};

/// The clauses of an error by kind, with their places.
#[derive(Default)]
struct Clauses<'a, 's> {
    severity: Option<(ast::Severity, Span)>,
    recover: Option<(&'a ast::Recovery<'s>, Span)>,
    otherwise: Option<(&'a ast::Otherwise<'s>, Span)>,
    respond: Option<(ast::Respond, Span)>,
    then: Option<(ast::Continuation, Span)>,
    on: Option<(&'a [Cause<'s>], Span)>,
    give_up: Option<(&'a [Bound<'s>], Span)>,
}

/// An error of which only the name is known.
pub(super) fn undefined(name: &str) -> obverse_bytecode::ErrorDeclaration {
    obverse_bytecode::ErrorDeclaration {
        name: name.to_owned(),
        severity: Severity::Recoverable,
        faults: Vec::new(),
        watches: Vec::new(),
        bounds: Bounds::default(),
        recovery: Recovery::None,
        otherwise: Otherwise::Stop,
        respond: Respond::AfterAction,
        continuation: Continuation::Stop,
    }
}

impl<'s> Checker<'s> {
    /// `error peg_not_inserted { … }`
    pub(super) fn check_error(&mut self, declaration: &ast::ErrorDeclaration<'s>) {
        let clauses = self.gather_error_clauses(&declaration.clauses);
        self.check_contradictions(&clauses);
        let recovery = match clauses.recover {
            Some((recovery, _)) => self.recovery(recovery),
            None => Recovery::None,
        };
        let otherwise = match clauses.otherwise {
            Some((ast::Otherwise::Using(name), _)) => {
                self.recovery_sequence(*name).map_or(Otherwise::Stop, Otherwise::Using)
            }
            Some((ast::Otherwise::Operator, _)) => Otherwise::Operator,
            Some((ast::Otherwise::Stop, _)) | None => Otherwise::Stop,
        };
        let severity = match clauses.severity.map(|(severity, _)| severity) {
            Some(ast::Severity::Warning) => Severity::Warning,
            Some(ast::Severity::Fatal) => Severity::Fatal,
            Some(ast::Severity::Recoverable) | None => Severity::Recoverable,
        };
        let has_recovery = recovery != Recovery::None || matches!(otherwise, Otherwise::Using(_));
        let continuation = match clauses.then.map(|(then, _)| then) {
            Some(then) => continuation(then),
            None => match severity {
                Severity::Warning => Continuation::NextAction,
                Severity::Recoverable if has_recovery => Continuation::Sequence,
                Severity::Recoverable | Severity::Fatal => Continuation::Stop,
            },
        };
        let respond = match clauses.respond.map(|(respond, _)| respond) {
            Some(ast::Respond::AtOnce) => Respond::AtOnce,
            Some(ast::Respond::AfterSequence) => Respond::AfterSequence,
            Some(ast::Respond::AfterAction) | None => Respond::AfterAction,
        };
        let causes = clauses.on.map_or(&[][..], |(causes, _)| causes);
        let (faults, watches) = (self.faults(causes), self.watches(causes));
        if !causes.is_empty() {
            self.names.mark_used(declaration.name.value);
        }
        let bounds = clauses.give_up.map_or(Bounds::default(), |(bounds, _)| self.bounds(bounds));
        if let Found::Here(symbol) = self.names.find(declaration.name.value)
            && let Meaning::Error(id) = symbol.meaning
            && let Some(error) = self.module.errors.get_mut(id.index())
        {
            let name = std::mem::take(&mut error.name);
            *error = obverse_bytecode::ErrorDeclaration {
                name,
                severity,
                faults,
                watches,
                bounds,
                recovery,
                otherwise,
                respond,
                continuation,
            };
        }
    }

    fn gather_error_clauses<'a>(
        &mut self,
        written: &'a [Spanned<ErrorClause<'s>>],
    ) -> Clauses<'a, 's> {
        let mut clauses = Clauses::default();
        for Spanned { value, span } in written {
            let first = match value {
                ErrorClause::Severity(severity) => {
                    ("severity", once(&mut clauses.severity, *severity, *span))
                }
                ErrorClause::Recover(recovery) => {
                    ("recover", once(&mut clauses.recover, recovery, *span))
                }
                ErrorClause::Otherwise(otherwise) => {
                    ("otherwise", once(&mut clauses.otherwise, otherwise, *span))
                }
                ErrorClause::Respond(respond) => {
                    ("respond", once(&mut clauses.respond, *respond, *span))
                }
                ErrorClause::Then(then) => ("then", once(&mut clauses.then, *then, *span)),
                ErrorClause::On(causes) => ("on", once(&mut clauses.on, causes.as_slice(), *span)),
                ErrorClause::GiveUp(bounds) => {
                    ("give up", once(&mut clauses.give_up, bounds.as_slice(), *span))
                }
            };
            if let (word, Some(first)) = first {
                self.report_twice(word, *span, first);
            }
        }
        clauses
    }

    /// What a severity says is not said otherwise by another clause.
    fn check_contradictions(&mut self, clauses: &Clauses<'_, 's>) {
        use ast::Severity::{Fatal, Recoverable, Warning};
        let recover = clauses.recover.map(|(_, span)| span);
        let otherwise = clauses.otherwise.map(|(_, span)| span);
        if let (Some((ast::Recovery::Using(_), first)), Some((ast::Otherwise::Using(_), second))) =
            (clauses.recover, clauses.otherwise)
        {
            let message = "`recover using` names the sequence that is run; `otherwise using` names \
                           one for when reversing has been given up";
            self.report_contradiction(message, second, first);
        }
        self.check_costs(clauses);
        let Some((severity, place)) = clauses.severity else { return };
        let message = match severity {
            Recoverable => return,
            Fatal => "a fatal error stops the program",
            Warning => "a warning is noted, and the program goes on",
        };
        let expected = match severity {
            Warning => ast::Continuation::NextAction,
            _ => ast::Continuation::Stop,
        };
        let then = clauses.then.filter(|(then, _)| *then != expected).map(|(_, span)| span);
        // A fatal error may say how it stops.
        let otherwise = match clauses.otherwise {
            Some((ast::Otherwise::Using(_), _)) => otherwise,
            _ if severity == Fatal => None,
            _ => otherwise,
        };
        let give_up = clauses.give_up.map(|(_, span)| span);
        for clause in [recover, otherwise, then, give_up].into_iter().flatten() {
            self.report_contradiction(message, clause, place);
        }
    }

    /// Time and distance are counted by whoever goes back; the code counts how often it tries.
    fn check_costs(&mut self, clauses: &Clauses<'_, 's>) {
        let (Some((bounds, _)), Some((ast::Recovery::Using(_), first))) =
            (clauses.give_up, clauses.recover)
        else {
            return;
        };
        for bound in bounds {
            if let Bound::Cost(cost) = bound {
                let message = "a sequence is run so many times; time and distance are bounds of \
                               recovering by reversing";
                self.report_contradiction(message, cost.span, first);
            }
        }
    }

    fn report_contradiction(&mut self, message: &str, clause: Span, first: Span) {
        let diagnostic =
            Diagnostic::error(Code::ContradictoryError, clause, message, "says otherwise")
                .with_label(first, "says this")
                .with_help("leave out one of the two");
        self.reports.add(diagnostic);
    }

    fn recovery(&mut self, recovery: &ast::Recovery<'s>) -> Recovery {
        match recovery {
            ast::Recovery::Using(name) => {
                self.recovery_sequence(*name).map_or(Recovery::None, Recovery::Using)
            }
            ast::Recovery::Reversing { depth, extent, changes } => {
                let depth = match depth {
                    ast::Depth::Fixed => Depth::Fixed,
                    ast::Depth::Escalating => Depth::Escalating { doubling: false },
                    ast::Depth::Doubling => Depth::Escalating { doubling: true },
                    ast::Depth::Learned => Depth::Learned,
                };
                let extent = self.extent(extent);
                Recovery::Reversing(self.changes(
                    Reversal { depth, extent, perturbation: None, slower: false, lighter: false },
                    changes,
                ))
            }
        }
    }

    fn extent(&mut self, extent: &ast::Extent<'s>) -> Extent {
        match extent {
            ast::Extent::Sequence => Extent::Sequence,
            ast::Extent::Checkpoint(name) => {
                self.wanted_checkpoints.push(*name);
                let CheckpointId(id) = self.checkpoint(*name);
                Extent::Checkpoint(id)
            }
            ast::Extent::Actions(count) => {
                let actions = u32::try_from(count.value).ok().filter(|actions| *actions > 0);
                Extent::Actions(actions.unwrap_or_else(|| {
                    let message = "a recovery reverses 1 to 4294967295 actions".to_owned();
                    let at = format!("{} actions", count.value);
                    self.reports.error(Code::OutOfRange, count.span, message, &at);
                    1
                }))
            }
        }
    }

    fn changes(&mut self, plain: Reversal, changes: &[Spanned<Change<'s>>]) -> Reversal {
        let mut reversal = plain;
        let mut places: [Option<((), Span)>; 3] = [None; 3];
        for Spanned { value, span } in changes {
            let (word, place) = match value {
                Change::Perturbed { .. } => ("perturbed", 0),
                Change::Slower => ("slower", 1),
                Change::Lighter => ("lighter", 2),
            };
            if let Some(first) = once(&mut places[place], (), *span) {
                self.report_twice(word, *span, first);
            }
            match value {
                Change::Slower => reversal.slower = true,
                Change::Lighter => reversal.lighter = true,
                Change::Perturbed { within, at_random } => {
                    let value = self.constant(within);
                    let need = Need::new(ValueType::LENGTH, "`perturbed`");
                    if let ExpressionKind::Real(within_m) = self.fit(value, &need).kind {
                        if within_m < 0.0 {
                            let message = "a perturbation is not negative".to_owned();
                            self.reports.error(Code::OutOfRange, *span, message, "negative");
                        }
                        let pattern = if *at_random { Pattern::Random } else { Pattern::Spiral };
                        reversal.perturbation = Some(Perturbation { limit_m: within_m, pattern });
                    }
                }
            }
        }
        reversal
    }

    /// A sequence that is run to recover.
    fn recovery_sequence(&mut self, name: Name<'s>) -> Option<u16> {
        let is_callable = |meaning| matches!(meaning, Meaning::Sequence(_) | Meaning::Action(_));
        let meaning = self.resolve(name, "a sequence", is_callable)?;
        let (Meaning::Sequence(FunctionId(id)) | Meaning::Action(FunctionId(id))) = meaning else {
            return None;
        };
        let signature = &self.signatures[usize::from(id)];
        if let Some(parameter) = signature.parameters.first() {
            let message = format!("`{}` has parameters, and a recovery is given none", name.value);
            let diagnostic =
                Diagnostic::error(Code::RecoveryParameters, name.span, message, "a recovery")
                    .with_label(parameter.span, "a parameter");
            self.reports.add(diagnostic);
            return None;
        }
        Some(id)
    }

    /// The checkpoint of this name.
    pub(super) fn checkpoint(&mut self, name: Name<'s>) -> CheckpointId {
        if let Some(&known) = self.interned.checkpoints.get(name.value) {
            return CheckpointId(known);
        }
        let index = self.index(self.module.checkpoints.len(), "checkpoints", name.span);
        self.module.checkpoints.push(name.value.to_owned());
        self.interned.checkpoints.insert(name.value, index);
        CheckpointId(index)
    }
}

/// Keep what a clause says; the place of the one before, if there is one.
pub(super) fn once<T>(kept: &mut Option<(T, Span)>, value: T, span: Span) -> Option<Span> {
    kept.replace((value, span)).map(|(_, first)| first)
}

fn continuation(then: ast::Continuation) -> Continuation {
    match then {
        ast::Continuation::Action => Continuation::Action,
        ast::Continuation::NextAction => Continuation::NextAction,
        ast::Continuation::Sequence => Continuation::Sequence,
        ast::Continuation::Program => Continuation::Program,
        ast::Continuation::Stop => Continuation::Stop,
    }
}
