//! Random programs as source text. Every one compiles without an error and comes to an end.
//!
//! The text is made from the choices of an [`Unstructured`], so that the same bytes give the same
//! program and fewer bytes a smaller one. Loops and recursion are bounded by construction, and a
//! program runs a few thousand statements at the most unless errors have it begin again. Names are
//! unique in a program. Nothing here knows what a program does, only what it may contain.

mod control;
mod declaration;
mod expression;
mod fork;
mod motion;
mod scope;
mod statement;
mod word;

use arbitrary::{Result, Unstructured};
use scope::{Frame, Type, Variable};
pub use word::{BLOCK, Pair, Word, pair};

/// What a program may contain.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Barriers and irreversible blocks.
    pub allow_never: bool,
    /// What leaves the law of going back by the programmer's word: blocks that are skipped,
    /// replaced or kept in reverse, and I/O operations and advanced moves with a counterpart.
    pub allow_overrides: bool,
    /// Errors.
    pub allow_errors: bool,
    /// What may trap: divisions by something that may be zero, assertions that may be wrong.
    pub allow_traps: bool,
    /// Forks; their branches never raise an error nor trap, so that they could as well run one
    /// after the other.
    pub allow_forks: bool,
    /// How many statements the text may have.
    pub max_statements: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            allow_never: true,
            allow_overrides: true,
            allow_errors: true,
            allow_traps: true,
            allow_forks: true,
            max_statements: 80,
        }
    }
}

/// The largest number of statements that a call of a sequence may come to.
const MAX_COST: u64 = 2_000;

/// The source text of a random program.
///
/// # Errors
/// Only those of the randomness; when it runs out, the text is ended.
pub fn generate(u: &mut Unstructured<'_>, options: Options) -> Result<String> {
    Ok(declarations(u, options)?.concat())
}

/// The declarations of a random program, in their order.
///
/// # Errors
/// As [`generate`].
pub fn declarations(u: &mut Unstructured<'_>, options: Options) -> Result<Vec<String>> {
    Generator::new(u, options).program()
}

/// A parameter of something that can be called.
#[derive(Clone, Debug)]
struct Parameter {
    name: String,
    of_type: Type,
    range: Option<(&'static str, &'static str)>,
    has_default: bool,
}

/// Something that can be called.
#[derive(Clone, Debug)]
struct Callee {
    name: String,
    parameters: Vec<Parameter>,
    /// Whether the first parameter bounds a recursion.
    is_recursive: bool,
    /// How many statements a call comes to at the most.
    cost: u64,
    /// Whether it passes a barrier.
    has_barrier: bool,
}

struct Generator<'g, 'u> {
    u: &'g mut Unstructured<'u>,
    options: Options,
    /// The text of the declaration in hand.
    text: String,
    depth: usize,
    /// How many statements there may still be.
    budget: usize,
    names: usize,
    globals: Vec<Variable>,
    joints: Vec<String>,
    items: Vec<String>,
    outputs: Vec<String>,
    inputs: Vec<String>,
    io: Vec<String>,
    errors: Vec<String>,
    moves: Vec<String>,
    /// The advanced moves that throw nothing.
    calm_moves: Vec<String>,
    callees: Vec<Callee>,
    /// Whether this program has forks.
    has_forks: bool,
    /// The sequences that a branch alone calls.
    of_branches: Vec<String>,
    frame: Frame,
}

impl<'g, 'u> Generator<'g, 'u> {
    fn new(u: &'g mut Unstructured<'u>, options: Options) -> Self {
        Self {
            u,
            options,
            text: String::new(),
            depth: 0,
            budget: options.max_statements,
            names: 0,
            globals: Vec::new(),
            joints: Vec::new(),
            items: Vec::new(),
            outputs: Vec::new(),
            inputs: Vec::new(),
            io: Vec::new(),
            errors: Vec::new(),
            moves: Vec::new(),
            calm_moves: Vec::new(),
            callees: Vec::new(),
            has_forks: false,
            of_branches: Vec::new(),
            frame: Frame::default(),
        }
    }

    fn program(&mut self) -> Result<Vec<String>> {
        let mut items = self.data()?;
        self.has_forks = self.options.allow_forks && self.one_in(4)?;
        items.extend(self.sequences()?);
        items.push(self.main()?);
        if self.options.allow_errors && self.one_in(4)? {
            items.push(self.cleanup()?);
        }
        items.extend(self.error_declarations()?);
        items.append(&mut self.of_branches);
        // Declarations see each other in any order.
        let turn = self.below(items.len())?;
        items.rotate_left(turn);
        // A line between them.
        items.iter_mut().for_each(|item| item.push('\n'));
        Ok(items)
    }

    fn sequences(&mut self) -> Result<Vec<String>> {
        let mut items = Vec::new();
        for index in 0..self.below(4)? {
            let is_recursive = self.one_in(3)?;
            let word = if self.one_in(2)? { "action" } else { "sequence" };
            let parameters = if index == 0 { 0 } else { self.below(4)? };
            items.push(self.sequence(word, parameters, is_recursive)?);
        }
        Ok(items)
    }

    /// A number below a bound, small where randomness has run out.
    fn below(&mut self, bound: usize) -> Result<usize> {
        self.u.int_in_range(0..=bound.max(1) - 1)
    }

    /// Whether something that happens once in so many times does.
    fn one_in(&mut self, times: usize) -> Result<bool> {
        Ok(self.below(times)? == times - 1)
    }

    fn choose<T: Clone>(&mut self, choices: &[T]) -> Result<T> {
        Ok(self.u.choose(choices)?.clone())
    }

    /// A new name.
    fn name(&mut self, kind: &str) -> String {
        self.names += 1;
        format!("{kind}{}", self.names)
    }

    /// A line of the declaration in hand.
    fn line(&mut self, line: &str) {
        self.text.push_str(&"  ".repeat(self.depth));
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// A line that opens a block.
    fn open(&mut self, line: &str) {
        self.line(&format!("{line} {{"));
        self.depth += 1;
    }

    /// A line that closes a block, with what follows the brace.
    fn close(&mut self, rest: &str) {
        self.depth -= 1;
        self.line(&format!("}}{rest}"));
    }
}
