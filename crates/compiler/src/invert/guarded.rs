//! Advanced moves: where one ends depends on what it meets, unless it goes back to where it began.

use super::block::Inverter;
use super::place::Spot;
use super::refusal::refusal;
use obverse_syntax::ast::{AdvancedMove, Behaviour, MoveClause, Name};
use obverse_syntax::span::{Span, Spanned};

impl<'p> Inverter<'p> {
    /// `advance press`: going back its counterpart is done, and so it is by the inverse. That the
    /// inverse ends where the sequence begins is certain only of moves that end where they begin.
    pub(super) fn advanced_move(&mut self, name: Name<'p>, span: Span) -> Option<Name<'p>> {
        let guarded = self.plan.advanced_move(name.value)?;
        let counterpart = guarded.counterpart.and_then(|name| self.plan.advanced_move(name.value));
        let is_mutual = |other: &&AdvancedMove<'_>| {
            other.counterpart.is_some_and(|back| back.value == name.value)
        };
        if let Some(other) = counterpart.filter(is_mutual)
            && returns(guarded)
            && returns(other)
        {
            return Some(Spanned::new(other.name.value, span));
        }
        self.refuse_advanced_move(counterpart, span);
        None
    }

    /// Says what leads back, in words that have an inverse.
    fn refuse_advanced_move(&mut self, counterpart: Option<&AdvancedMove<'p>>, span: Span) {
        let back = counterpart.map_or("OTHER", |other| other.name.value);
        let here = self.arm.spot().map_or("HERE".to_owned(), Spot::text);
        let written = format!(
            "do {{ advance ..; move to THERE }} in reverse {{ advance {back}; move to {here} }}"
        );
        let message = "an advanced move has no inverse";
        let mut diagnostic = refusal(span, message, "where it ends depends on what it meets")
            .with_help(format!("say what leads there and back, by places with names: `{written}`"));
        if let Some(other) = counterpart {
            let note = format!(
                "`{}` would take it back if both said `return to initial position` on success and \
                 on failure, each were the other's counterpart, and neither threw an error",
                other.name.value
            );
            diagnostic = diagnostic.with_note(note);
        }
        self.refuse(diagnostic);
    }
}

/// Whether a move ends where it begins, whatever it meets, and does nothing else.
fn returns(guarded: &AdvancedMove<'_>) -> bool {
    let goes_back = |behaviours: &[Spanned<Behaviour<'_>>]| {
        let returns =
            |one: &Spanned<Behaviour<'_>>| one.value == Behaviour::ReturnToInitialPosition;
        !behaviours.is_empty() && behaviours.iter().all(returns)
    };
    let (mut on_success, mut on_failure, mut is_certain) = (false, false, true);
    for clause in &guarded.clauses {
        match &clause.value {
            MoveClause::OnSuccess(behaviours) => on_success = goes_back(behaviours),
            MoveClause::OnFailure(behaviours) => on_failure = goes_back(behaviours),
            MoveClause::Requires { .. } => is_certain = false,
            _ => {}
        }
    }
    on_success && on_failure && is_certain
}
