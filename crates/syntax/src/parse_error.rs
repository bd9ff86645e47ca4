//! The one place that turns what the parser could not take into diagnostics. It reads the tokens
//! around the place again, and looks for the mistake behind the token.

use crate::codes::Code;
use crate::diagnostic::{Diagnostic, Label};
use crate::expectation::Expectation;
use crate::nearest::nearest;
use crate::sink::{MAX_MISTAKES, SyntaxError};
use crate::span::Span;
use crate::surroundings::Surroundings;
use crate::token::{FREE_WORDS, Token};
use crate::tree;

/// The words for a direction that could be taken for the name of a distance.
const DIRECTIONS: [&str; 7] = ["forward", "backward", "backwards", "left", "right", "up", "down"];

/// All diagnostics of the text that begins at an offset, by place: those that have
/// been worded, and those of syntax errors.
pub(crate) fn explain(
    source: &str,
    start: usize,
    mut diagnostics: Vec<Diagnostic>,
    errors: &[SyntaxError],
) -> Vec<Diagnostic> {
    if !errors.is_empty() {
        let surroundings = Surroundings::new(source, start);
        for error in errors {
            let mistake = Mistake {
                error,
                expectation: Expectation::new(&error.expected),
                surroundings: &surroundings,
            };
            diagnostics.push(mistake.explain());
        }
    }
    blame_one_brace(&mut diagnostics);
    diagnostics.sort_by_key(|diagnostic| diagnostic.primary.span);
    if diagnostics.len() >= MAX_MISTAKES
        && let Some(last) = diagnostics.last_mut()
    {
        last.notes.push(format!("no more than {MAX_MISTAKES} mistakes are shown"));
    }
    diagnostics
}

/// A declaration in a block that is never closed is a consequence of that: what is reported is the
/// bracket, with the first such declaration as the place where it was noticed.
fn blame_one_brace(diagnostics: &mut Vec<Diagnostic>) {
    let unclosed =
        diagnostics.iter().position(|diagnostic| diagnostic.code == Code::UnclosedBracket);
    let Some(unclosed) = unclosed else { return };
    let opening = diagnostics[unclosed].primary.span;
    let is_inside = |diagnostic: &Diagnostic| {
        diagnostic.code == Code::DeclarationInside && diagnostic.primary.span > opening
    };
    let first = diagnostics.iter().filter(|one| is_inside(one)).map(|one| one.primary.span).min();
    if let Some(span) = first {
        let text = "this declaration stands in it".to_owned();
        diagnostics[unclosed].labels = vec![Label { span, text }];
        diagnostics.retain(|diagnostic| !is_inside(diagnostic));
    }
}

/// A syntax error with what is known of its place.
struct Mistake<'e> {
    error: &'e SyntaxError,
    expectation: Expectation<'e>,
    surroundings: &'e Surroundings<'e>,
}

impl Mistake<'_> {
    fn explain(&self) -> Diagnostic {
        let Some(found) = self.error.found else { return self.at_end() };
        self.unclosed(found)
            .or_else(|| self.loop_of_another_language())
            .or_else(|| self.word_after_number(found))
            .or_else(|| self.reserved_word(found))
            .or_else(|| self.missing_block(found))
            .or_else(|| self.foreign_assignment(found))
            .or_else(|| self.comparison_as_assignment(found))
            .unwrap_or_else(|| self.unexpected(found))
    }

    /// What was found, as it is called in a message.
    fn found(&self) -> String {
        match self.error.found {
            None => "the end of the file".to_owned(),
            Some(Token::Text) => "a text in quotes".to_owned(),
            Some(_) => format!("`{}`", shortened(self.surroundings.text(self.error.span))),
        }
    }

    fn error(&self, code: Code, message: impl Into<String>, at: impl Into<String>) -> Diagnostic {
        Diagnostic::error(code, self.error.span, message, at)
    }

    fn at_end(&self) -> Diagnostic {
        self.surroundings.unclosed_at(self.error.span.end).unwrap_or_else(|| {
            let expected = self.expectation.describe();
            let message = format!("the file ends where {expected} was expected");
            self.error(Code::UnexpectedToken, message, format!("expected {expected}"))
        })
    }

    /// A bracket in an expression that is still open where the expression clearly is over.
    fn unclosed(&self, found: Token) -> Option<Diagnostic> {
        let is_over = found.begins_statement()
            || matches!(
                found,
                Token::OpenBrace | Token::CloseBrace | Token::Semicolon | Token::Sequence
            )
            || is_closing(found);
        let opening = self.surroundings.innermost_open(self.error.span.start)?;
        let (sign, closing) = match opening.token {
            Token::OpenParenthesis => ("(", ")"),
            Token::OpenBracket => ("[", "]"),
            _ => return None,
        };
        if !is_over || !self.expectation.allows(closing) || found.text() == Some(closing) {
            return None;
        }
        let message = format!("this `{sign}` is not closed");
        let expected = format!("`{closing}` was expected before this");
        let diagnostic =
            Diagnostic::error(Code::UnclosedBracket, opening.span, message, "opened here");
        Some(diagnostic.with_label(self.error.span, expected))
    }

    fn loop_of_another_language(&self) -> Option<Diagnostic> {
        if !self.expectation.allows("from") || self.expectation.allows("NAME") {
            return None;
        }
        let message = format!("a counting loop is not written with {} here", self.found());
        let diagnostic =
            self.error(Code::ForeignLoop, message, "expected `NAME from FIRST to LAST`");
        Some(diagnostic.with_help("write `for i from 0 to 9 { .. }`; both ends are included"))
    }

    /// `set 0 hgih`, `[1, 2] mmm`.
    fn word_after_number(&self, found: Token) -> Option<Diagnostic> {
        let text = self.surroundings.text(self.error.span);
        if found == Token::Name && self.expectation.allows("UNIT") {
            return Some(tree::unknown_unit(text, self.error.span, &[]));
        }
        if found != Token::BadQuantity {
            return None;
        }
        let word = &text[text.find(|c: char| c.is_ascii_alphabetic() || c == '_')?..];
        let span = Span::new(self.error.span.end - word.len() as u32, self.error.span.end);
        let message = format!("`{word}` cannot stand after this number");
        let diagnostic = Diagnostic::error(Code::UnexpectedToken, span, message, "unexpected");
        Some(match nearest(word, FREE_WORDS.iter().copied()) {
            Some(meant) => diagnostic.with_help(format!("did you mean `{meant}`?")),
            None => diagnostic,
        })
    }

    fn reserved_word(&self, found: Token) -> Option<Diagnostic> {
        let is_meant_as_name = found.is_reserved()
            && self.expectation.is_name()
            && !self.surroundings.begins_line(self.error.span.start);
        let word = found.text().filter(|_| is_meant_as_name)?;
        let message = format!("`{word}` cannot be a name");
        let diagnostic = self.error(Code::ReservedWord, message, "a word of the language");
        Some(diagnostic.with_help(format!("choose another name, such as `{word}_1`")))
    }

    fn missing_block(&self, found: Token) -> Option<Diagnostic> {
        let wants_block = self.expectation.allows("{") && !self.expectation.allows_statement();
        let is_statement = found.begins_statement()
            || matches!(found, Token::Assigned | Token::Speed | Token::Tool | Token::Position);
        if !wants_block || !is_statement {
            return None;
        }
        let message = format!("`{{` is missing before {}", self.found());
        let diagnostic = self.error(Code::MissingBlock, message, "expected `{` before this");
        Some(diagnostic.with_help("put the statements into braces: `{ .. }`"))
    }

    /// `i++`, `x *= 2`.
    fn foreign_assignment(&self, found: Token) -> Option<Diagnostic> {
        if found != Token::Name || !self.expectation.allows_statement() {
            return None;
        }
        let name = shortened(self.surroundings.text(self.error.span));
        let [first, second] = self.surroundings.two_after(self.error.span.end)?;
        let is_one_sign = first.span.end == second.span.start;
        let instead = match (first.token, second.token) {
            (Token::Plus, Token::Plus) => format!("{name} += 1"),
            (Token::Minus, Token::Minus) => format!("{name} -= 1"),
            (Token::Star, Token::Assign) => format!("{name} = {name} * .."),
            (Token::Slash, Token::Assign) => format!("{name} = {name} / .."),
            _ => return None,
        };
        let span = first.span.to(second.span);
        let sign = self.surroundings.text(span);
        let message = format!("`{sign}` is not an assignment here");
        let diagnostic = Diagnostic::error(Code::ForeignOperator, span, message, "unknown");
        is_one_sign.then(|| diagnostic.with_help(format!("write `{instead}`")))
    }

    /// `requires x = 3`; but an assignment on a line of its own is the next statement.
    fn comparison_as_assignment(&self, found: Token) -> Option<Diagnostic> {
        let is_operand = found == Token::Assigned
            && self.expectation.allows_value()
            && !self.surroundings.begins_line(self.error.span.start);
        let sign = self.surroundings.after(self.error.span.end).filter(|_| is_operand)?;
        Some(tree::assigns(sign.span))
    }

    fn unexpected(&self, found: Token) -> Diagnostic {
        let expected = self.expectation.describe();
        let message = format!("expected {expected}, found {}", self.found());
        let mut diagnostic =
            self.error(Code::UnexpectedToken, message, format!("expected {expected}"));
        if let Some(opening) = self.opening_that_matters() {
            diagnostic = diagnostic.with_label(opening, "opened here");
        }
        match self.help(found) {
            Some(help) => diagnostic.with_help(help),
            None => diagnostic,
        }
    }

    /// The bracket whose closing one is among what is expected, if it is of an expression.
    fn opening_that_matters(&self) -> Option<Span> {
        let opening = self.surroundings.innermost_open(self.error.span.start)?;
        let closing = match opening.token {
            Token::OpenParenthesis => ")",
            Token::OpenBracket => "]",
            _ => return None,
        };
        self.expectation.allows(closing).then_some(opening.span)
    }

    fn help(&self, found: Token) -> Option<String> {
        let text = self.surroundings.text(self.error.span);
        let begins_statement = self.expectation.allows_statement();
        let next = self.surroundings.after(self.error.span.end).map(|token| token.token);
        if begins_statement && found == Token::Name && next == Some(Token::OpenParenthesis) {
            return Some(format!("to call an action write `call {}(..)`", shortened(text)));
        }
        if begins_statement
            && found == Token::Name
            && let Some(statement) = self.statement_with(text)
        {
            return Some(format!("write `{statement}`"));
        }
        if found.is_word()
            && let Some(meant) = nearest(text, self.expectation.words())
        {
            return Some(format!("did you mean `{meant}`?"));
        }
        let wants_direction = self.expectation.allows("forward")
            && !self.expectation.is_name()
            && !self.expectation.allows_value();
        if wants_direction && found == Token::Plus {
            return Some("put a sum in parentheses: `move (a + b) up`".to_owned());
        }
        let name = self.name_after_move().filter(|_| wants_direction)?;
        let is_length = matches!(found, Token::Integer | Token::Real | Token::Quantity);
        Some(match name {
            _ if is_length => {
                format!("the distance comes first: `move {} {name}`", shortened(text))
            }
            _ if DIRECTIONS.contains(&name) => {
                format!("say how far before the direction: `move 20 mm {name}`")
            }
            _ => format!("to go to a position write `move to {}`", shortened(name)),
        })
    }

    /// What a declared name is used by, where it stands alone as a statement.
    fn statement_with(&self, name: &str) -> Option<String> {
        let verb = match self.surroundings.declared_by(name)? {
            Token::Io => "io",
            Token::Sequence | Token::Action => "call",
            // Of `advanced move NAME`: at the top of a file no other `move` stands.
            Token::Move => "advance",
            Token::Error => "throw",
            Token::Joints => "move to",
            Token::Output => return Some(format!("set {name} high")),
            _ => return None,
        };
        Some(format!("{verb} {name}"))
    }

    /// The word that stands where `move` has its distance: `start` of `move start`.
    fn name_after_move(&self) -> Option<&str> {
        let name = self.surroundings.before(self.error.span.start)?;
        let verb = self.surroundings.before(name.span.start)?;
        let is_name = name.token.is_word() && verb.token == Token::Move;
        is_name.then(|| self.surroundings.text(name.span))
    }
}

fn is_closing(token: Token) -> bool {
    matches!(token, Token::CloseBrace | Token::CloseParenthesis | Token::CloseBracket)
}

/// A piece of source for a message: its first line, and not too much of it.
fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    let line = text.lines().next().unwrap_or("");
    match line.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}..", &line[..end]),
        None => line.to_owned(),
    }
}
