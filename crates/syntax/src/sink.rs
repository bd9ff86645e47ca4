//! Where lexer, grammar and tree building put what they find wrong, and how one mistake is kept
//! from being reported many times. How it is worded is said elsewhere.

use crate::ast::Item;
use crate::codes::Code;
use crate::diagnostic::Diagnostic;
use crate::left_out::GivenUp;
use crate::span::Span;
use crate::token::Token;
use lalrpop_util::{ErrorRecovery, ParseError};
use std::cell::{Cell, RefCell};

/// How many mistakes are reported of one text; reading ends there.
pub(crate) const MAX_MISTAKES: usize = 20;

/// How often the parser goes on after a mistake or a consequence of one; reading ends there.
const MAX_RECOVERIES: usize = 100;

/// How many tokens may come in which nothing is built; reading ends there. A program has far fewer:
/// at most a deep nest of brackets or a row of `-` before an operand.
pub(crate) const MAX_IDLE_TOKENS: u32 = 2000;

/// The lexer's word that reading ends here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stopped;

/// What the parser says of a token that it could not take.
pub(crate) type Failure = ParseError<u32, Token, Stopped>;

/// The same, with the tokens that it left out.
pub(crate) type Recovery = ErrorRecovery<u32, Token, Stopped>;

/// A token that the grammar does not allow where it stands.
#[derive(Debug)]
pub(crate) struct SyntaxError {
    /// The token; at the end of the text an empty span.
    pub(crate) span: Span,
    /// None at the end of the text.
    pub(crate) found: Option<Token>,
    /// What the grammar allows, as lalrpop names it: `"\"move\""`.
    pub(crate) expected: Vec<String>,
}

/// What has been found so far. Shared by the lexer and the parser that reads from it.
#[derive(Debug, Default)]
pub(crate) struct Sink<'s> {
    diagnostics: RefCell<Vec<Diagnostic>>,
    syntax_errors: RefCell<Vec<SyntaxError>>,
    misplaced: RefCell<Vec<Item<'s>>>,
    /// What the grammar allows at the end of an unended text.
    at_end: RefCell<Vec<String>>,
    given_up: RefCell<Vec<Span>>,
    /// The end of what has been read whole last.
    settled: Cell<u32>,
    has_ended_early: Cell<bool>,
    count: Cell<usize>,
    recoveries: Cell<usize>,
    idle_tokens: Cell<u32>,
    /// The end of the last mistake, while nothing whole has been read since: a further mistake of
    /// grammar is then taken for a consequence.
    aftermath: Cell<Option<u32>>,
    /// The same of what the parser could not take, alone: what the lexer, which is ahead, finds in
    /// the meantime does not change that.
    amiss: Cell<Option<u32>>,
    /// Whether that mistake was the lexer's, which has put something right in its place.
    is_lexical: Cell<bool>,
    /// Where the mistake begins that was found last.
    newest: Cell<u32>,
    /// The end of the mistake that reaches furthest.
    furthest: Cell<u32>,
    block: Cell<BlockKind>,
    is_outside: Cell<bool>,
}

/// All that was found.
#[derive(Debug)]
pub(crate) struct Findings<'s> {
    /// What has been worded.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// What has not.
    pub(crate) syntax_errors: Vec<SyntaxError>,
    /// Declarations that stand in a block.
    pub(crate) misplaced: Vec<Item<'s>>,
    /// What the parser left out in order to go on.
    pub(crate) given_up: GivenUp,
    /// Whether the text seems to lack its end. A block with a declaration in it lacks its brace.
    pub(crate) is_cut: bool,
}

/// What is known of the block that is being read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum BlockKind {
    /// It stands where it belongs, or there is none.
    #[default]
    Expected,
    /// It follows a mistake; whether it has statements in it is not yet known.
    Unknown,
    /// It follows a mistake and has no statements: nothing more is said of what is in it.
    Foreign,
}

impl<'s> Sink<'s> {
    /// A mistake that its finder has worded.
    pub(crate) fn report(&self, diagnostic: Diagnostic) {
        self.is_lexical.set(is_put_right(diagnostic.code));
        self.newest.set(diagnostic.primary.span.start);
        self.unsettle(diagnostic.primary.span.end);
        if self.count_one() {
            self.diagnostics.borrow_mut().push(diagnostic);
        }
    }

    /// A mistake that reaches to the end of the text: of grammar nothing more is said there.
    pub(crate) fn ends_early(&self, diagnostic: Diagnostic, end: u32) {
        if self.aftermath.get().is_none() {
            self.report(diagnostic);
        }
        self.has_ended_early.set(true);
        self.unsettle(end);
    }

    /// Whether the end of the line matters: a mistake of the lexer reaches no further.
    pub(crate) fn awaits_line_end(&self) -> bool {
        self.is_lexical.get()
    }

    /// The line ends on which a mistake was found that reaches no further.
    pub(crate) fn line_ends(&self) {
        self.is_lexical.set(false);
        self.aftermath.set(None);
    }

    /// A token that the parser could not take, and the tokens it left out in order to go on at
    /// `end`, after which comes `rest`.
    pub(crate) fn recovered(&self, recovery: Recovery, end: u32, rest: &str) {
        self.recoveries.set(self.recoveries.get() + 1);
        // What had been read of it is given up as well.
        let start = self.settled.get().min(end);
        self.given_up.borrow_mut().push(Span::new(start, end));
        self.unexpected(recovery.error, end);
        if begins_anew(rest) {
            self.settle_mistake();
        }
    }

    /// A token that the parser could not take, the mistake reaching to `end`.
    pub(crate) fn unexpected(&self, error: Failure, end: u32) {
        let (span, found, expected) = match error {
            ParseError::UnrecognizedToken { token: (start, token, end), expected } => {
                if token == Token::END {
                    self.at_end.replace(expected.clone());
                }
                (Span::new(start, end), Some(token), expected)
            }
            ParseError::UnrecognizedEof { location, expected } => {
                (Span::new(location, location), None, expected)
            }
            ParseError::ExtraToken { token: (start, token, end) } => {
                (Span::new(start, end), Some(token), Vec::new())
            }
            ParseError::InvalidToken { location } => {
                (Span::new(location, location), None, Vec::new())
            }
            ParseError::User { error: Stopped } => return,
        };
        if self.block.get() == BlockKind::Unknown {
            self.block.set(BlockKind::Foreign);
        }
        // The lexer is ahead of the parser: what it found behind the token is no cause.
        let is_after = match self.newest.get() <= span.start {
            true => self.aftermath.get().is_some(),
            false => self.amiss.get().is_some(),
        };
        let is_consequence = is_after || self.block.get() == BlockKind::Foreign;
        self.unsettle(end.max(span.start));
        self.is_lexical.set(false);
        self.amiss.set(self.aftermath.get());
        if !is_consequence && self.count_one() {
            self.syntax_errors.borrow_mut().push(SyntaxError { span, found, expected });
        }
    }

    /// The lexer gives a token: whether nothing has been built of too many by now.
    pub(crate) fn is_idle(&self) -> bool {
        self.idle_tokens.set(self.idle_tokens.get() + 1);
        self.idle_tokens.get() > MAX_IDLE_TOKENS
    }

    /// A part of the tree has been built, or a separator read.
    pub(crate) fn built(&self) {
        self.idle_tokens.set(0);
    }

    /// Something whole that ends at this place has been read.
    pub(crate) fn settle(&self, end: u32) {
        self.built();
        self.settled.set(end);
        let is_behind = |mistake: Option<u32>| mistake.is_some_and(|mistake| end > mistake);
        if is_behind(self.aftermath.get()) {
            self.aftermath.set(None);
        }
        if is_behind(self.amiss.get()) {
            self.amiss.set(None);
        }
        if self.block.get() == BlockKind::Unknown {
            self.block.set(BlockKind::Expected);
        }
    }

    /// A block begins that follows a mistake; gives what [`Sink::leave_block`] needs.
    pub(crate) fn enter_block(&self) -> BlockKind {
        let outer = self.block.get();
        if outer == BlockKind::Expected {
            self.block.set(BlockKind::Unknown);
        }
        outer
    }

    /// The block in hand begins with a word that only statements begin with.
    pub(crate) fn block_has_statements(&self) {
        if self.block.get() == BlockKind::Unknown {
            self.block.set(BlockKind::Expected);
            self.settle_mistake();
        }
    }

    /// That block ends, and with it what followed from the mistake, unless its line goes on.
    pub(crate) fn leave_block(&self, outer: BlockKind, rest: &str) {
        self.block.set(outer);
        let rest = rest.trim_start_matches([' ', '\t']);
        if !rest.starts_with(|c: char| c.is_ascii_alphanumeric()) {
            self.settle_mistake();
        }
    }

    /// What was left out was a declaration, so that statements that follow it may be its own.
    pub(crate) fn leave_out_item(&self) {
        self.is_outside.set(true);
    }

    /// A declaration that was found in a block: it is kept as if it stood at the top.
    pub(crate) fn misplaced(&self, item: Item<'s>, diagnostic: Diagnostic) {
        self.report(diagnostic);
        self.settle_mistake();
        self.misplaced.borrow_mut().push(item);
    }

    /// A statement that was found at the top of the file: the first of a row is reported, but not
    /// where a mistake before has put it there.
    pub(crate) fn outside(&self, span: Span, rest: &str, diagnostic: impl FnOnce() -> Diagnostic) {
        let is_consequence = self.aftermath.get().is_some() || self.furthest.get() > span.start;
        if !self.is_outside.replace(true) && !is_consequence {
            self.report(diagnostic());
        }
        if begins_anew(rest) {
            self.settle_mistake();
        }
    }

    /// A declaration that ends at this place has been read where it belongs.
    pub(crate) fn settle_item(&self, end: u32) {
        self.is_outside.set(false);
        self.settle(end);
    }

    /// Whether reading ends, since enough mistakes have been found.
    pub(crate) fn is_full(&self) -> bool {
        self.count.get() >= MAX_MISTAKES || self.recoveries.get() >= MAX_RECOVERIES
    }

    /// What the grammar allows at the end of the text, as lalrpop names it.
    pub(crate) fn into_expected_at_end(self) -> Vec<String> {
        self.at_end.into_inner()
    }

    /// All that was found.
    pub(crate) fn into_findings(self) -> Findings<'s> {
        let is_unclosed = self.has_ended_early.get();
        let misplaced = self.misplaced.into_inner();
        let syntax_errors = self.syntax_errors.into_inner();
        let is_at_end = |error: &SyntaxError| error.found.is_none();
        Findings {
            diagnostics: self.diagnostics.into_inner(),
            is_cut: is_unclosed && misplaced.is_empty() || syntax_errors.iter().any(is_at_end),
            given_up: GivenUp { spans: self.given_up.into_inner(), is_unclosed },
            syntax_errors,
            misplaced,
        }
    }

    /// What follows is no consequence of a mistake.
    fn settle_mistake(&self) {
        self.aftermath.set(None);
        self.amiss.set(None);
    }

    fn unsettle(&self, end: u32) {
        self.furthest.set(self.furthest.get().max(end));
        self.aftermath.set(Some(self.furthest.get()));
    }

    fn count_one(&self) -> bool {
        let has_room = self.count.get() < MAX_MISTAKES;
        self.count.set(self.count.get() + usize::from(has_room));
        has_room
    }
}

/// Whether the lexer puts something that fits in the place of what is wrong.
fn is_put_right(code: Code) -> bool {
    matches!(
        code,
        Code::UnexpectedCharacter
            | Code::MalformedNumber
            | Code::UnknownUnit
            | Code::ForeignOperator
            | Code::ForeignWord
    )
}

/// Whether something new begins with what follows: on a new line, or after `;`.
fn begins_anew(rest: &str) -> bool {
    let rest = rest.trim_start_matches([' ', '\t']);
    rest.starts_with(['\r', '\n', ';']) || rest.starts_with("//")
}
