//! Forks: how many branches there are, what leaves one, and that branches share no hidden variable.
//!
//! All branches run in the frame of their sequence, in turns. What the compiler hides there for one
//! of them, another must not use meanwhile: counters, and variables for a statement. What two
//! branches command or assign is another matter, which calls are needed for.

use super::Checker;
use super::frame::{Around, NamedPosition};
use super::statement::Checked;
use crate::tree::{Block, StatementKind};
use obverse_isa::LocalId;
use obverse_syntax::ast;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::Span;

/// How many branches a fork has at the most.
const MAX_BRANCHES: usize = 16;

impl<'s> Checker<'s> {
    /// `fork { … } and { … }`
    pub(super) fn fork(&mut self, written: &[ast::Block<'s>], start: u32) -> Checked {
        let first = written.first()?;
        let header = self.header(start, first.span);
        self.check_branches(written, header);
        let named = self.frame.named;
        let mut after = named;
        let (counters, peak) = (self.frame.counters, self.frame.counter_peak);
        self.frame.counter_peak = counters;
        let mut free: Vec<LocalId> = Vec::new();
        let mut branches = Vec::new();
        for block in written {
            self.frame.named = named;
            branches.push(self.fork_branch(block, header));
            // The arm is one branch's alone.
            if self.frame.named != named {
                after = match after == named {
                    true => self.frame.named,
                    false => NamedPosition::Lost("the branches come together after this", header),
                };
            }
            free.append(&mut self.frame.free);
            self.frame.counters = self.frame.counter_peak;
        }
        self.frame.free = free;
        self.frame.free.sort_unstable();
        self.frame.counters = counters;
        self.frame.counter_peak = self.frame.counter_peak.max(peak);
        self.frame.named = after;
        let falls_through = branches.iter().all(|branch| branch.falls_through);
        Some((self.done(StatementKind::Fork(branches), header), falls_through))
    }

    fn fork_branch(&mut self, block: &ast::Block<'s>, header: Span) -> Block {
        self.frame.around.push(Around::Branch(header));
        let branch = self.block(block);
        self.frame.around.pop();
        // The hidden locals of the last statement are the branch's too.
        self.frame.begin_statement();
        branch
    }

    fn check_branches(&mut self, written: &[ast::Block<'s>], header: Span) {
        if let [only] = written {
            let message = "a fork of one branch forks nothing";
            let diagnostic =
                Diagnostic::error(Code::ForkBranches, header, message, "one branch alone")
                    .with_label(last(only), "`and { .. }` is missing after this")
                    .with_help("add a branch, or write its statements without `fork`");
            self.reports.add(diagnostic);
        }
        if let Some(surplus) = written.get(MAX_BRANCHES) {
            let count = written.len();
            let message =
                format!("a fork has at most {MAX_BRANCHES} branches, and this has {count}");
            let at = Span::new(surplus.span.start, surplus.span.start + 1);
            let diagnostic = Diagnostic::error(Code::ForkBranches, at, message, "one too many")
                .with_label(header, "branches of this fork")
                .with_help("put what need not overlap into one branch");
            self.reports.add(diagnostic);
        }
        for empty in written.iter().filter(|block| block.statements.is_empty()) {
            let message = "a branch of a fork does nothing";
            let diagnostic =
                Diagnostic::error(Code::ForkBranches, empty.span, message, "an empty branch")
                    .with_label(header, "a branch of this fork")
                    .with_help("leave it out");
            self.reports.add(diagnostic);
        }
    }

    /// A `break` or `return` whose goal lies outside of the fork.
    pub(super) fn report_leaves_fork(&mut self, word: &str, span: Span, fork: Span) {
        let message =
            format!("`{word}` cannot leave a fork, which ends when all its branches have");
        let diagnostic =
            Diagnostic::error(Code::LeavesFork, span, message, "would leave it half-way")
                .with_label(fork, "the fork begins here")
                .with_help(format!(
                    "note it in a variable, and `{word}` after the fork if that is set"
                ));
        self.reports.add(diagnostic);
    }
}

/// The closing brace.
fn last(block: &ast::Block<'_>) -> Span {
    super::function::last_byte(block.span)
}
