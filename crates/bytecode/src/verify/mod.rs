//! The verifier: what a machine may rely on.
//!
//! A verified module keeps these rules, and the machine checks none of them again:
//!
//! 1. *Tables*: every table fits its index type, joint configurations and keyframes are finite,
//!    keyframes name keyframes, errors name functions, a variable whose type is an index into a
//!    table has a table to index.
//! 2. *Functions*: they cover the code without gaps, in order; the first is the start; each begins
//!    with `enter` and ends with `return`, the start with `halt`, and has neither elsewhere; locals
//!    and three words a counter fit 256 slots.
//! 3. *Operands*: every index is in range; a called function has the parameters that are passed,
//!    and is not the start.
//! 4. *Statements*: a pure prefix and one effect, which knows the prefix's length; the operand
//!    stack is empty between statements; heights and types fit; no more than [`MAX_OPERANDS`] at
//!    once.
//! 5. *Joins*: each jump names a join of its function that names it, and each join a jump; the loop
//!    instructions of one counter name each other. `land` follows what never falls through, and
//!    nothing else does.
//! 6. *Counted loops*: `for.enter`, `for.top` … `for.next`, `for.exit`, in this order, the pairs
//!    side
//!    by side; nothing jumps in from outside; loops that overlap have different counters.
//! 7. *Updates*: the operand of an update does not read what is updated.
//! 8. *Blocks*: `block.begin` and its end nest, and nothing jumps in or out; a function that takes
//!    a block's place has for parameters the first locals of the function around the block.
//! 9. *Source map*: ascending, within the files; so are mentions and the names of loops.
//! 10. *Tasks*: `fork`, `fork.next` and `fork.join` nest; a fork has at most [`MAX_BRANCHES`]
//!     branches; nothing jumps into or out of one; `fork.leave` names the join of the innermost
//!     fork that holds it, from within no block of its own; counted loops of different branches
//!     have different counters, since the frame is theirs together.
//!
//! What remains possible at run time is a trap that depends on values: a division by zero, a real
//! that is no integer, an assertion or a requirement that does not hold, calls too deep, a missing
//! keyframe, a tape that is full. Whether a workcell has what the module names is for linking.
//! Termination is not promised. Read `code`, then `flow`, then
//! `nesting`, then `tables`.

mod code;
mod flow;
mod nesting;
mod tables;

use crate::code::ModuleCode;
use crate::module::Module;
use std::fmt;

/// The most branches of a fork.
pub const MAX_BRANCHES: usize = 16;

/// The most operands on the stack at once.
pub const MAX_OPERANDS: usize = 128;
/// The most errors that are reported of one module.
pub const MAX_ERRORS: usize = 32;
/// The longest reason of an error, in characters; a longer one is cut short.
const MAX_WHY_CHARS: usize = 512;

/// A module that has been verified.
#[derive(Clone, Debug)]
pub struct Verified(Module);

impl Verified {
    /// The module.
    #[must_use]
    pub fn module(&self) -> &Module {
        &self.0
    }
}

/// The rules, by the numbers above.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// Rule 1.
    Tables,
    /// Rule 2.
    Functions,
    /// Rule 3.
    Operands,
    /// Rule 4.
    Statements,
    /// Rule 5.
    Joins,
    /// Rule 6.
    Loops,
    /// Rule 7.
    Updates,
    /// Rule 8.
    Blocks,
    /// Rule 9.
    SourceMap,
    /// Rule 10.
    Tasks,
}

impl Rule {
    /// The code of what breaks it.
    #[must_use]
    pub fn code(self) -> ModuleCode {
        match self {
            Self::Tables => ModuleCode::Tables,
            Self::Functions => ModuleCode::Functions,
            Self::Operands => ModuleCode::Operands,
            Self::Statements => ModuleCode::Statements,
            Self::Joins => ModuleCode::Joins,
            Self::Loops => ModuleCode::Loops,
            Self::Updates => ModuleCode::Updates,
            Self::Blocks => ModuleCode::Blocks,
            Self::SourceMap => ModuleCode::SourceMap,
            Self::Tasks => ModuleCode::Tasks,
        }
    }
}

/// Why a module is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VerifyError {
    /// The instruction, if it is one.
    pub pc: Option<u32>,
    /// The rule that is broken.
    pub rule: Rule,
    /// How.
    pub why: String,
}

impl fmt::Display for VerifyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.pc {
            Some(pc) => write!(f, "instruction {pc}: {}", self.why),
            None => f.write_str(&self.why),
        }
    }
}

impl std::error::Error for VerifyError {}

/// What has been found wrong so far.
#[derive(Debug, Default)]
struct Findings(Vec<VerifyError>);

impl Findings {
    fn at(&mut self, pc: usize, rule: Rule, why: impl Into<String>) {
        self.add(Some(pc as u32), rule, why.into());
    }

    fn of_module(&mut self, rule: Rule, why: impl Into<String>) {
        self.add(None, rule, why.into());
    }

    fn add(&mut self, pc: Option<u32>, rule: Rule, why: String) {
        if self.0.len() < MAX_ERRORS {
            // A name in it may be as long as the module.
            let why = why.chars().take(MAX_WHY_CHARS).collect();
            self.0.push(VerifyError { pc, rule, why });
        }
    }
}

/// Verify a module, in time and memory linear in it.
///
/// # Errors
/// What is wrong with it, at most [`MAX_ERRORS`].
pub fn verify(module: Module) -> Result<Verified, Vec<VerifyError>> {
    let mut findings = Findings::default();
    tables::check(&module, &mut findings);
    if findings.0.is_empty() {
        // Whatever follows may index by what the tables and functions say.
        for function in &module.functions {
            code::check(&module, function, &mut findings);
        }
    }
    if findings.0.is_empty() {
        for function in &module.functions {
            flow::check(&module, function, &mut findings);
        }
    }
    if findings.0.is_empty() { Ok(Verified(module)) } else { Err(findings.0) }
}
