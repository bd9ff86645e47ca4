//! The one place that turns what the parser could not take into diagnostics. It reads the tokens
//! around the place again, and looks for the mistake behind the token.

use crate::advice::Unexpected;
use crate::codes::Code;
use crate::diagnostic::{Diagnostic, Label, Suggestion};
use crate::expectation::Expectation;
use crate::nearest::nearest;
use crate::sink::{MAX_MISTAKES, SyntaxError};
use crate::span::Span;
use crate::surroundings::{Surroundings, shortened};
use crate::token::{FREE_WORDS, Token};
use crate::tree;

/// Farther apart than this, in bytes, two mistakes are not taken for one.
const LONG_LINE: usize = 1000;

/// All diagnostics of the text that begins at an offset, by place: those that have
/// been worded, and those of syntax errors.
pub(crate) fn explain(
    source: &str,
    start: usize,
    mut diagnostics: Vec<Diagnostic>,
    errors: &[SyntaxError],
) -> Vec<Diagnostic> {
    let worded = diagnostics.len();
    if !errors.is_empty() {
        let surroundings = Surroundings::new(source, start);
        let unclosed = diagnostics.iter().find(|one| one.code == Code::UnclosedBracket);
        let unclosed = unclosed.map(|one| one.primary.span);
        for error in errors.iter().filter(|error| !follows_from(unclosed, error)) {
            let mistake = Mistake {
                error,
                expectation: Expectation::new(&error.expected),
                surroundings: &surroundings,
            };
            diagnostics.push(mistake.explain());
        }
    }
    leave_out_consequences(source, &mut diagnostics, worded, errors);
    name_arguments(source, start, &mut diagnostics);
    blame_one_brace(&mut diagnostics);
    blame_brace_too_many(source, start, &mut diagnostics);
    diagnostics.sort_by_key(|diagnostic| diagnostic.primary.span);
    say_once(source, &mut diagnostics);
    if diagnostics.len() >= MAX_MISTAKES
        && let Some(last) = diagnostics.last_mut()
    {
        last.notes.push(format!("no more than {MAX_MISTAKES} mistakes are shown"));
    }
    diagnostics
}

/// Whether a token that cannot stand here could, were a block closed before it.
fn follows_from(unclosed: Option<Span>, error: &SyntaxError) -> bool {
    let goes_on = matches!(
        error.found,
        Some(Token::CloseBrace | Token::In | Token::Else | Token::Ending | Token::Reverse)
    );
    goes_on && unclosed.is_some_and(|opening| opening < error.span)
}

/// What the lexer says of signs behind a token that the parser could not take, on its line, is left
/// out: of the first `worded` diagnostics, since the others are the parser's.
fn leave_out_consequences(
    source: &str,
    diagnostics: &mut Vec<Diagnostic>,
    worded: usize,
    errors: &[SyntaxError],
) {
    let is_of_lexer = |code| {
        matches!(code, Code::ForeignOperator | Code::UnexpectedCharacter | Code::ForeignWord)
    };
    let mut index = 0;
    diagnostics.retain(|diagnostic| {
        index += 1;
        let start = diagnostic.primary.span.start;
        let is_behind = |error: &&SyntaxError| {
            let between = error.span.start as usize..start as usize;
            between.len() < LONG_LINE
                && source
                    .get(between)
                    .is_some_and(|text| !text.is_empty() && !text.contains(['\n', '\r']))
        };
        index > worded || !is_of_lexer(diagnostic.code) || !errors.iter().any(|e| is_behind(&e))
    });
}

/// `call place(what = vial)`: what assigns there was meant to name an argument.
fn name_arguments(source: &str, start: usize, diagnostics: &mut [Diagnostic]) {
    let is_assigned = |one: &&mut Diagnostic| one.code == Code::AssignmentAsComparison;
    let mut assigned = diagnostics.iter_mut().filter(is_assigned).peekable();
    if assigned.peek().is_none() {
        return;
    }
    let surroundings = Surroundings::new(source, start);
    for diagnostic in assigned {
        let sign = diagnostic.primary.span;
        let Some(name) = surroundings.named_argument(sign.start) else { continue };
        diagnostic.message = "an argument is not given by `=`".to_owned();
        diagnostic.primary.text = "assigns".to_owned();
        diagnostic.help = Some(format!("write `{}: ..`", shortened(surroundings.text(name))));
        diagnostic.suggestion =
            Some(Suggestion { span: Span::new(name.end, sign.end), text: ":".to_owned() });
    }
}

/// A brace too many ends a sequence early, and what follows stands outside: what is reported is the
/// brace that is indented otherwise than what it closes, and nothing of what follows from it.
fn blame_brace_too_many(source: &str, start: usize, diagnostics: &mut Vec<Diagnostic>) {
    let is_missing = |one: &&Diagnostic| one.code == Code::MissingBlock;
    let missing = diagnostics.iter().filter(is_missing).map(|one| one.primary.span).min();
    if let Some(missing) = missing {
        // Its closing brace may be there.
        diagnostics.retain(|one| {
            let follows = matches!(one.code, Code::UnmatchedBracket | Code::StatementOutside);
            !follows || one.primary.span < missing
        });
    }
    let is_unmatched = |one: &Diagnostic| one.code == Code::UnmatchedBracket;
    let Some(unmatched) = diagnostics.iter().position(is_unmatched) else { return };
    let place = diagnostics[unmatched].primary.span;
    let Some(suspect) = Surroundings::new(source, start).likely_too_many(place.start) else {
        return;
    };
    diagnostics[unmatched].primary.span = suspect;
    diagnostics[unmatched].primary.text = "this may be the one too many".to_owned();
    diagnostics[unmatched].labels =
        vec![Label { span: place, text: "no bracket is open here".to_owned() }];
    diagnostics.retain(|one| one.code != Code::StatementOutside || one.primary.span < suspect);
}

/// The same slip again and again on a line, `[0°, 90°]`, is said once.
fn say_once(source: &str, diagnostics: &mut Vec<Diagnostic>) {
    diagnostics.dedup_by(|again, first| {
        let between = first.primary.span.end as usize..again.primary.span.start as usize;
        let is_same_line = between.len() < LONG_LINE
            && source.get(between).is_some_and(|text| !text.contains(['\n', '\r']));
        let is_slip = matches!(again.code, Code::UnknownUnit | Code::UnexpectedCharacter);
        let is_again = is_slip && is_same_line && again.message == first.message;
        if is_again {
            first.primary.text = format!("{}, here and on", again.primary.text);
            // One change does not mend them all.
            first.suggestion = None;
        }
        is_again
    });
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
        let instead = match word {
            "steps" | "moves" | "statements" => Some("actions"),
            "off" if self.expectation.wants("high") => Some("low"),
            "on" if self.expectation.wants("high") => Some("high"),
            _ => nearest(word, self.expectation.words().chain(FREE_WORDS.iter().copied())),
        };
        Some(match instead {
            Some(meant) => diagnostic.did_you_mean(span, meant),
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
        let help = format!("choose another name, such as `{word}_1`");
        Some(diagnostic.with_help(help).replacing(self.error.span, format!("{word}_1")))
    }

    fn missing_block(&self, found: Token) -> Option<Diagnostic> {
        let wants_block = self.expectation.allows("{") && !self.expectation.allows_statement();
        let is_statement = found.begins_statement()
            || matches!(found, Token::Assigned | Token::Speed | Token::Tool | Token::Position)
            || found == Token::Requires
            || matches!(found, Token::Then | Token::Colon) && self.expectation.allows("or");
        if !wants_block || !is_statement {
            return None;
        }
        let message = format!("`{{` is missing before {}", self.found());
        let diagnostic = self.error(Code::MissingBlock, message, "expected `{` before this");
        Some(diagnostic.with_help("put the statements into braces: `{ .. }`"))
    }

    /// `i++`, `x *= 2`.
    fn foreign_assignment(&self, found: Token) -> Option<Diagnostic> {
        if !found.can_be_name() || !self.expectation.allows_statement() {
            return None;
        }
        let name = shortened(self.surroundings.text(self.error.span));
        let [first, second] = self.surroundings.two_after(self.error.span.end)?;
        let is_one_sign = first.span.end == second.span.start;
        let step = |sign| (format!("{name} {sign} 1"), Some(format!(" {sign} 1")));
        let (instead, change) = match (first.token, second.token) {
            (Token::Plus, Token::Plus) => step("+="),
            (Token::Minus, Token::Minus) => step("-="),
            // In place of the sign alone it would take the first factor of what follows.
            (Token::Star, Token::Assign) => (format!("{name} = {name} * .."), None),
            (Token::Slash, Token::Assign) => (format!("{name} = {name} / .."), None),
            _ => return None,
        };
        let span = first.span.to(second.span);
        let sign = self.surroundings.text(span);
        let message = format!("`{sign}` is not an assignment here");
        let diagnostic = Diagnostic::error(Code::ForeignOperator, span, message, "unknown");
        let diagnostic = diagnostic.with_help(format!("write `{instead}`"));
        is_one_sign.then(|| match change {
            Some(text) => diagnostic.replacing(span, text),
            None => diagnostic,
        })
    }

    /// `requires x = 3`; but an assignment on a line of its own is the next statement.
    fn comparison_as_assignment(&self, found: Token) -> Option<Diagnostic> {
        let is_operand = found == Token::Assigned
            && self.expectation.allows("not")
            && !self.surroundings.begins_line(self.error.span.start);
        let sign = self.surroundings.after(self.error.span.end).filter(|_| is_operand)?;
        Some(tree::assigns(sign.span))
    }

    fn unexpected(&self, found: Token) -> Diagnostic {
        let expected = self.expectation.describe();
        let message = format!("expected {expected}, found {}", self.found());
        let mut diagnostic = match self.end_before() {
            Some(end) => {
                let at = format!("expected {expected} after this");
                Diagnostic::error(Code::UnexpectedToken, end, message, at)
            }
            None => self.error(Code::UnexpectedToken, message, format!("expected {expected}")),
        };
        if let Some(opening) = self.opening_that_matters() {
            diagnostic = diagnostic.with_label(opening, "opened here");
        }
        let unexpected = Unexpected {
            error: self.error,
            found,
            expectation: &self.expectation,
            surroundings: self.surroundings,
        };
        if let Some(advice) = unexpected.advice() {
            diagnostic.help = Some(advice.help);
            diagnostic.suggestion = advice.suggestion;
        }
        diagnostic
    }

    /// The token before, if what is missing is missing behind it, at the end of its line.
    fn end_before(&self) -> Option<Span> {
        let start = self.error.span.start;
        let may_end = self.expectation.allows_statement() || self.expectation.allows("}");
        let is_next = self.surroundings.begins_line(start) && !may_end;
        self.surroundings.before(start).filter(|_| is_next).map(|token| token.span)
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
}

fn is_closing(token: Token) -> bool {
    matches!(token, Token::CloseBrace | Token::CloseParenthesis | Token::CloseBracket)
}
