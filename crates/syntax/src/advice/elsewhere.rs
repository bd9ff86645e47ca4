//! What is meant by an expression, or by the path of an import, that is written as in another
//! language.

use super::{Advice, Unexpected, said};
use crate::elsewhere::{place, value_elsewhere};
use crate::span::Span;
use crate::surroundings::shortened;
use crate::token::{RESERVED_WORDS, Token};

impl Unexpected<'_> {
    /// About operators, calls and paths of other languages.
    pub(super) fn of_another_language(&self) -> Option<Advice> {
        self.turned_comparison()
            .or_else(|| self.operator_in_capitals())
            .or_else(|| self.reading_as_call())
            .or_else(|| self.value_of_another_language())
            .or_else(|| self.bare_path())
    }

    /// `force => 3 N`
    fn turned_comparison(&self) -> Option<Advice> {
        let equal = self.surroundings.before(self.span().start)?;
        let is_turned = equal.token == Token::Assign && equal.span.end == self.span().start;
        let instead = match self.found {
            Token::Greater if is_turned => ">=",
            Token::Less if is_turned => "<=",
            _ => return None,
        };
        let whole = equal.span.to(self.span());
        Some(said(format!("write `{instead}`")).replacing(whole, instead))
    }

    /// `if NOT input 2`
    fn operator_in_capitals(&self) -> Option<Advice> {
        let word = self.surroundings.before(self.span().start)?;
        let text = self.surroundings.text(word.span);
        let small = text.to_lowercase();
        let is_operator = matches!(small.as_str(), "not" | "and" | "or" | "mod");
        if !is_operator || small == text || self.begins_line() {
            return None;
        }
        Some(said(format!("write `{small}`")).replacing(word.span, &small))
    }

    /// `force()`
    fn reading_as_call(&self) -> Option<Advice> {
        let reading = self.surroundings.before(self.span().start)?;
        let is_reading = matches!(reading.token, Token::Force | Token::Distance | Token::Holding);
        if !is_reading || self.found != Token::OpenParenthesis {
            return None;
        }
        let word = self.surroundings.text(reading.span);
        let help = match value_elsewhere(word) {
            Some(help) => help.to_owned(),
            None => format!("write `{word}`"),
        };
        let closing = self.surroundings.after(self.span().end)?;
        let is_empty = closing.token == Token::CloseParenthesis;
        Some(match is_empty {
            true => said(help).replacing(self.span().to(closing.span), ""),
            false => said(help),
        })
    }

    /// `var p2 = pose_trans(p1, p[0, 0, 0.1, 0, 0, 0])`
    fn value_of_another_language(&self) -> Option<Advice> {
        let line = self.surroundings.line_before(self.span().start);
        let is_bracket = |token| matches!(token, Token::OpenParenthesis | Token::OpenBracket);
        let behind = line.iter().skip(1).map(|one| one.token).chain([self.found]);
        let called = line.iter().zip(behind).filter(|(_, behind)| is_bracket(*behind));
        let mut words = called.map(|(one, behind)| (self.surroundings.text(one.span), behind));
        let is_own = |word: &&str| RESERVED_WORDS.contains(word);
        words
            .find_map(|(word, behind)| match (word, behind) {
                _ if is_own(&word) => None,
                ("p", Token::OpenBracket) => place(word),
                (_, Token::OpenParenthesis) => value_elsewhere(word),
                _ => None,
            })
            .map(said)
    }

    /// `import poses.obv`
    fn bare_path(&self) -> Option<Advice> {
        let is_path = self.found.is_word() && matches!(self.before(), "import" | "cell");
        if !is_path || !self.expectation.allows("TEXT") || self.begins_line() {
            return None;
        }
        let line = self.surroundings.line_behind(self.span().start);
        let path = &line[..line.find([' ', '\t', ';']).unwrap_or(line.len())];
        let span = Span::new(self.span().start, self.span().start + path.len() as u32);
        let help = format!("a path stands in quotes: `{} \"{}\"`", self.before(), shortened(path));
        Some(said(help).replacing(span, &format!("\"{path}\"")))
    }
}
