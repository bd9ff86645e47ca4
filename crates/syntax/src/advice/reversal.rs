//! What is meant by a word of reversal, or of branches, that is not written whole, or by one of
//! another language: the form as it is written here.

use super::{Advice, Unexpected, said};
use crate::span::Span;
use crate::token::Token;

/// What is thought to begin a block that is run in reverse.
const REVERSES: [&str; 9] = [
    "undo",
    "reverse",
    "reversed",
    "backwards",
    "backward",
    "rollback",
    "rewind",
    "revert",
    "compensate",
];

const REPLACED: &str = "what is run in reverse in place of a block stands behind it: `do { .. } in \
                        reverse { .. }`";

impl Unexpected<'_> {
    /// About the words that say how something is reversed, and about `fork`.
    pub(super) fn of_reversal(&self) -> Option<Advice> {
        self.without_in_reverse()
            .or_else(|| self.without_reason())
            .or_else(|| self.second_branch())
            .or_else(|| self.reverse_as_statement())
    }

    /// `skip {`, `do { .. } reverse {`, `with speed slow {`.
    fn without_in_reverse(&self) -> Option<Advice> {
        let form = match self.before() {
            "skip" => "skip in reverse { .. }",
            "keep" => "keep in reverse { .. }",
            "}" if self.expectation.is_only("in") => "do { .. } in reverse { .. }",
            "in" if self.expectation.is_only("reverse") => {
                return Some(said("write `in reverse`"));
            }
            _ if self.expectation.allows(",") && !self.expectation.allows_statement() => {
                "with .. in reverse { .. }"
            }
            _ => return None,
        };
        if !self.expectation.wants("in") {
            return None;
        }
        let help = said(format!("write `{form}`"));
        Some(match self.found {
            Token::OpenBrace => help.replacing(self.here(), "in reverse "),
            Token::Reverse => help.replacing(self.here(), "in "),
            Token::On | Token::When if self.next() == Some(Token::Reverse) => {
                help.replacing(self.span(), "in")
            }
            found if found.is_word() && self.next() == Some(Token::OpenBrace) => {
                match REVERSES.contains(&self.text()) {
                    true => help.replacing(self.span(), "in reverse"),
                    false => help,
                }
            }
            _ => help,
        })
    }

    /// `irreversible {`, `barrier`.
    fn without_reason(&self) -> Option<Advice> {
        if !self.expectation.is_only("TEXT") {
            return None;
        }
        match self.before() {
            "irreversible" => Some(said("say why: `irreversible \"the glue sets\" { .. }`")),
            "barrier" => Some(said("say why: `barrier \"the part has left the cell\"`")),
            _ => None,
        }
    }

    /// `fork { .. } { .. }`
    fn second_branch(&self) -> Option<Advice> {
        if self.found != Token::OpenBrace || !self.expectation.allows_statement() {
            return None;
        }
        let closing = self.surroundings.before(self.span().start)?;
        let opening = self.surroundings.opening_of(closing.span)?;
        let verb = self.surroundings.before(opening.span.start)?;
        let is_branch = matches!(verb.token, Token::Fork | Token::And);
        is_branch.then(|| said("write `fork { .. } and { .. }`").replacing(self.here(), "and "))
    }

    /// `undo {`, `reverse 2`.
    fn reverse_as_statement(&self) -> Option<Advice> {
        if !self.expectation.allows_statement() {
            return None;
        }
        let is_block = self.next() == Some(Token::OpenBrace);
        match self.text() {
            "in" | "on" if self.next() == Some(Token::Reverse) => Some(said(REPLACED)),
            word if is_block && REVERSES.contains(&word) => Some(said(REPLACED)),
            word if REVERSES.contains(&word) => Some(said(
                "a program goes back when an error says so: `error NAME { recover by reversing up \
                 to 3 actions }`",
            )),
            _ => None,
        }
    }

    /// The place before the token.
    pub(super) fn here(&self) -> Span {
        Span::new(self.span().start, self.span().start)
    }

    /// The token behind it.
    pub(super) fn next(&self) -> Option<Token> {
        self.surroundings.after(self.span().end).map(|placed| placed.token)
    }
}
