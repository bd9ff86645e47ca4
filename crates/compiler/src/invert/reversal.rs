//! Blocks with a reverse of their own: what is forward in one is in reverse in the other.

use super::block::Inverter;
use super::effect::Effect;
use super::place::{Arm, Spot};
use super::refusal::refusal;
use super::walk;
use obverse_syntax::ast::{Block, Statement, StatementKind};
use obverse_syntax::span::Span;

impl<'p> Inverter<'p> {
    /// `skip in reverse { A }`: going back nothing is done, so that the inverse does nothing; and
    /// going back over the inverse does A.
    pub(super) fn skipped(&mut self, block: &'p Block<'p>, span: Span) -> StatementKind<'p> {
        self.require_no_assignment(block);
        self.opaque.push((Effect::of_block(block, self.plan), span));
        if let Some(motion) = first_motion(block) {
            let message = "a motion that is skipped in reverse has no inverse";
            let why = "what is before this block would begin elsewhere";
            self.refuse(refusal(motion, message, why).with_label(span, "the block"));
        }
        let nothing = Block { statements: Vec::new(), span: block.span };
        StatementKind::ReplaceInReverse { block: nothing, replacement: block.clone() }
    }

    /// `do { A } in reverse { B }`: the inverse is `do { B } in reverse { A }`.
    pub(super) fn replaced(
        &mut self,
        block: &'p Block<'p>,
        replacement: &'p Block<'p>,
        span: Span,
    ) -> StatementKind<'p> {
        self.require_no_assignment(block);
        self.require_no_assignment(replacement);
        if replacement.statements.is_empty() && !block.statements.is_empty() {
            let message = "a block that nothing replaces has no inverse in these words";
            self.refuse(
                refusal(span, message, "the inverse of its inverse would be another")
                    .with_help("write `skip in reverse { .. }`"),
            );
        }
        self.follow_replaced(block, replacement);
        for block in [block, replacement] {
            self.opaque.push((Effect::of_block(block, self.plan), span));
        }
        match block.statements.is_empty() {
            true => StatementKind::SkipInReverse(replacement.clone()),
            false => StatementKind::ReplaceInReverse {
                block: replacement.clone(),
                replacement: block.clone(),
            },
        }
    }

    /// `keep in reverse { A }`: going back does A too, and so does the inverse.
    pub(super) fn kept(&mut self, block: &'p Block<'p>, span: Span) -> StatementKind<'p> {
        self.require_no_assignment(block);
        self.follow_replaced(block, block);
        self.opaque.push((Effect::of_block(block, self.plan), span));
        StatementKind::KeepInReverse(block.clone())
    }

    /// Where blocks move the arm, the first must end at a place with a name, and the second must
    /// lead back to where it began.
    fn follow_replaced(&mut self, block: &'p Block<'p>, replacement: &'p Block<'p>) {
        let Some(motion) = first_motion(block).or(first_motion(replacement)) else { return };
        let (there, back) = (last_spot(block, self), last_spot(replacement, self));
        let leads_back = match (&back, self.arm.spot()) {
            (Some(back), Some(before)) => back.is_same(before),
            _ => false,
        };
        match there.filter(|_| leads_back) {
            Some(there) => self.arm = Arm::at(there),
            None => {
                let message = "where these blocks end has no name";
                let why = "this moves the arm";
                self.refuse(
                    refusal(motion, message, why)
                        .with_label(replacement.span, "this does not end where the first begins")
                        .with_help(
                            "end the first block with a move to a place with a name, and the \
                             second with a move to the place before the blocks",
                        ),
                );
                self.arm = Arm::refused();
            }
        }
    }

    /// Going back, the variables of the program are restored whatever the block does; the inverse
    /// would have to do that itself.
    fn require_no_assignment(&mut self, block: &'p Block<'p>) {
        let declared = walk::declared_in(block);
        let mut first = None;
        for statement in &block.statements {
            walk::each_statement(statement, &mut |inner| {
                let assigns = match &inner.kind {
                    StatementKind::Assign { name, .. } => !declared.contains(name.value),
                    StatementKind::Call { name, .. } => self.plan.assigns(name.value),
                    _ => false,
                };
                if assigns && first.is_none() {
                    first = Some(inner.span);
                }
            });
        }
        if let Some(assignment) = first {
            let message =
                "a variable that is changed in a block with its own reverse has no inverse";
            let why = "going back restores the variable, and the inverse would not";
            let opening = Span::new(block.span.start, block.span.start + 1);
            self.refuse(
                refusal(assignment, message, why)
                    .with_label(opening, "the block begins here")
                    .with_help("change it outside of the block"),
            );
        }
    }
}

/// The place with a name that a block ends at.
fn last_spot<'p>(block: &'p Block<'p>, inverter: &Inverter<'p>) -> Option<Spot<'p>> {
    match block.statements.last() {
        Some(Statement { kind: StatementKind::Move { target, .. }, .. }) => {
            Spot::of(target, inverter.tool)
        }
        _ => None,
    }
}

/// The first statement in a block that may move the arm.
fn first_motion(block: &Block<'_>) -> Option<Span> {
    let mut first = None;
    walk::each_in(block, &mut |statement| {
        let moves = matches!(
            statement.kind,
            StatementKind::Move { .. } | StatementKind::Advance(_) | StatementKind::Call { .. }
        );
        if moves && first.is_none() {
            first = Some(statement.span);
        }
    });
    first
}
