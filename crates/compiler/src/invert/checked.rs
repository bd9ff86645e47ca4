//! What inversion asks of the checked program that cannot be seen in its syntax: which variables
//! are integers, and which forks depend on whose turn it is.

use super::refusal::refusal;
use crate::Defaults;
use crate::allow::Allows;
use crate::check;
use crate::effects::Effects;
use crate::forks;
use crate::report::Reports;
use obverse_bytecode::{Module, Variable};
use obverse_isa::Type;
use obverse_syntax::ast::Program;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::sources::Sources;
use obverse_syntax::span::Span;
use std::collections::{HashMap, HashSet};

/// What is known of a program that compiles.
pub(super) struct Checked<'m> {
    /// The variables of the program that are integers.
    globals: HashSet<&'m str>,
    /// The variables of each function.
    locals: HashMap<&'m str, &'m [Variable]>,
    /// By where a fork begins: that one of its branches reads what another assigns.
    crossed: HashMap<u32, Diagnostic>,
    /// Whether there may be more such forks than are kept.
    may_be_more: bool,
}

impl<'m> Checked<'m> {
    /// What is known of a program that compiles to this module.
    pub(super) fn of(sources: &Sources, program: &Program<'_>, module: &'m Module) -> Self {
        let integers = module.globals.iter().filter(|global| global.of_type == Type::Int);
        let functions = module.functions.iter();
        let mut checked = Self {
            globals: integers.map(|global| global.name.as_str()).collect(),
            locals: functions.map(|one| (one.name.as_str(), &one.locals[..])).collect(),
            crossed: HashMap::new(),
            may_be_more: false,
        };
        let reports = Reports::new(None, Allows::default());
        let tree = check::check(sources, program, &Defaults::new(), reports).program;
        if let Some(tree) = tree {
            // What a program allows is warned about here, too.
            let mut reports = Reports::new(None, Allows::default());
            forks::check(&tree, &Effects::of(&tree), &mut reports);
            checked.may_be_more = reports.drops_warnings();
            for found in reports.into_diagnostics() {
                if found.code == Code::ReadsOtherBranch
                    && let Some(fork) = found.labels.last()
                {
                    checked.crossed.entry(fork.span.start).or_insert(found);
                }
            }
        }
        checked
    }

    /// Whether a variable that a sequence sees is an integer.
    pub(super) fn is_integer(&self, sequence: &str, variable: &str) -> bool {
        let locals = self.locals.get(sequence).copied().unwrap_or_default();
        match locals.iter().find(|local| local.name == variable) {
            Some(local) => local.of_type == Type::Int,
            None => self.globals.contains(variable),
        }
    }

    /// Why a fork has no inverse, if that is so: in which order a branch reads a variable and
    /// another assigns it follows from the turns, and an inverse takes its own.
    pub(super) fn refusal_of_fork(&self, fork: Span) -> Option<Diagnostic> {
        let message = "a fork whose branches read what others assign has no inverse";
        let Some(found) = self.crossed.get(&fork.start) else {
            let why = "more such forks are in this program than are looked at";
            return self.may_be_more.then(|| refusal(fork, message, why));
        };
        let mut refused = refusal(found.primary.span, message, &found.primary.text);
        refused.labels.clone_from(&found.labels);
        Some(
            refused
                .with_note("the turns of the inverse are others")
                .with_help("have one branch do both, or read it before the fork or after it"),
        )
    }
}
