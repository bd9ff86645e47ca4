//! Branches and loops.

use super::block::{Emitted, Inverter};
use super::effect::Effect;
use super::place::Arm;
use super::pure;
use super::refusal::refusal;
use super::walk;
use obverse_syntax::ast::{Block, Expression, Statement, StatementKind, Target};
use obverse_syntax::span::Span;

impl<'p> Inverter<'p> {
    /// A branch or a loop.
    pub(super) fn control(&mut self, statement: &'p Statement<'p>) -> Option<Emitted<'p>> {
        let span = statement.span;
        walk::expressions(statement).into_iter().for_each(|one| self.require_pure(one));
        let kind = match &statement.kind {
            StatementKind::If { condition, then, otherwise, ending_when } => {
                self.branch(condition, (then, otherwise.as_ref()), ending_when.as_ref(), span)
            }
            StatementKind::While { condition, entered_when, body } => {
                let entered = entered_when.as_ref();
                let Some(entered) = entered else {
                    self.refuse_open_loop(condition.span);
                    return None;
                };
                StatementKind::While {
                    condition: pure::opposite(entered),
                    entered_when: Some(pure::opposite(condition)),
                    body: self.body(body, statement),
                }
            }
            StatementKind::Repeat { times, body } => {
                self.require_kept_bounds(&[times], body);
                StatementKind::Repeat { times: times.clone(), body: self.body(body, statement) }
            }
            StatementKind::For { name, first, down, last, body } => {
                self.require_kept_bounds(&[first, last], body);
                StatementKind::For {
                    name: *name,
                    first: last.clone(),
                    down: !down,
                    last: first.clone(),
                    body: self.body(body, statement),
                }
            }
            _ => return None,
        };
        Some(Emitted::new(kind, span))
    }

    fn refuse_open_loop(&mut self, condition: Span) {
        let message = "a loop without `entered when` has no inverse";
        let why = "an inverse would not know how often it went round";
        self.refuse(refusal(condition, message, why).with_help(
            "say what holds when it is first entered alone: `while n != 3 entered when n == 0`",
        ));
    }

    fn branch(
        &mut self,
        condition: &'p Expression<'p>,
        (then, otherwise): (&'p Block<'p>, Option<&'p Block<'p>>),
        ending_when: Option<&'p Expression<'p>>,
        span: Span,
    ) -> StatementKind<'p> {
        if ending_when.is_none() {
            let blocks = std::iter::once(then).chain(otherwise);
            blocks.for_each(|block| self.require_kept(condition, block));
        }
        let (facts, arm) = (self.facts.clone(), self.arm.clone());
        let then = self.block(then);
        self.facts = facts;
        let after_then = std::mem::replace(&mut self.arm, arm);
        let otherwise = otherwise.map(|block| self.block(block));
        if after_then.is_refused() {
            self.arm = after_then;
        } else if !self.arm.is_refused() && !after_then.is_same(&self.arm) {
            self.arm = Arm::lost("two ways that end in different places join after this", span);
        }
        let (condition, ending_when) = match ending_when {
            Some(assertion) => (assertion, Some(condition.clone())),
            None => (condition, None),
        };
        StatementKind::If { condition: condition.clone(), then, otherwise, ending_when }
    }

    /// A condition must say the same when the block is over.
    fn require_kept(&mut self, condition: &Expression<'p>, block: &Block<'p>) {
        let names = walk::names_of(condition);
        let changes = |statement: &&Statement<'p>| {
            Effect::of_statement(statement, self.plan).changes_any(&names)
        };
        if let Some(changing) = block.statements.iter().find(changes) {
            let message = "a branch that changes its own condition has no inverse";
            let why = "this may say something else when the branch is over";
            self.refuse(
                refusal(condition.span, message, why)
                    .with_label(changing.span, "changed here")
                    .with_help("say what tells the branches apart then: `ending when ..`"),
            );
        }
    }

    /// How often a loop goes round must be known at its end, too.
    fn require_kept_bounds(&mut self, bounds: &[&Expression<'p>], body: &Block<'p>) {
        for bound in bounds {
            let names = walk::names_of(bound);
            let effect = Effect::of_block(body, self.plan);
            if effect.changes_any(&names) {
                let message = "a loop that changes its own bound has no inverse";
                let why = "this is something else when the loop is over";
                self.refuse(
                    refusal(bound.span, message, why)
                        .with_label(body.span, "its body may change it")
                        .with_help("keep the bound in a variable of its own"),
                );
            }
        }
    }

    /// The body of a loop: it must end where it begins.
    fn body(&mut self, body: &'p Block<'p>, statement: &Statement<'p>) -> Block<'p> {
        let before = self.arm.clone();
        self.facts.at_head(statement, self.plan);
        let inverse = self.block(body);
        if self.arm.is_same(&before) {
            return inverse;
        }
        match first_to_place(body) {
            Some(first) => {
                let message = "a loop that ends elsewhere than it begins has no inverse";
                let why = "each time round this comes from another place";
                self.refuse(refusal(first, message, why).with_help(
                    "move to where its body ends before the loop, so that it begins there each \
                     time",
                ));
            }
            None => {
                self.arm = before;
                self.arm.stray(body.span);
            }
        }
        inverse
    }
}

/// The first statement in a block that may go to a place with a name.
fn first_to_place(block: &Block<'_>) -> Option<Span> {
    let mut first = None;
    walk::each_in(block, &mut |statement| {
        let goes = match &statement.kind {
            StatementKind::Move { target, .. } => {
                !matches!(target, Target::Relative { .. } | Target::Turned(_))
            }
            StatementKind::Call { .. } => true,
            _ => false,
        };
        if goes && first.is_none() {
            first = Some(statement.span);
        }
    });
    first
}
