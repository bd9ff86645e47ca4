//! How deep the text goes: what is checked of a token before the parser sees it, so that no tree is
//! ever deep. It knows brackets and counts; what is built from them it does not know.

use crate::token::Token;
use crate::{MAX_NESTING, MAX_OPERATORS};

/// The brackets that are open, and what has been counted in them.
#[derive(Debug, Default)]
pub(crate) struct Nesting {
    open: Vec<Open>,
    /// Levels that trees built from here on have above them: brackets, and links of `else if`.
    depth: usize,
    /// Operators since the last token that cannot stand in an expression.
    operators: usize,
    after_else: bool,
}

#[derive(Debug)]
struct Open {
    closing: Token,
    /// The depth outside of it.
    outside: usize,
}

/// Why a token is not handed on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// A closing bracket that closes nothing: left out.
    Unmatched,
    /// More than [`MAX_NESTING`]: reading ends.
    TooDeep,
    /// More than [`MAX_OPERATORS`]: reading ends.
    TooManyOperators,
}

impl Nesting {
    /// Whether the innermost open bracket is round or square.
    pub(crate) fn is_in_expression(&self) -> bool {
        self.open.last().is_some_and(|open| open.closing != Token::CloseBrace)
    }

    /// The text ends: gives up brackets of expressions, and closes the innermost block if one is
    /// open. Whether one was.
    pub(crate) fn close_block(&mut self) -> bool {
        self.give_up_brackets();
        self.open.pop().is_some()
    }

    /// Takes note of the next token.
    pub(crate) fn observe(&mut self, token: Token) -> Result<(), Refusal> {
        let after_else = std::mem::replace(&mut self.after_else, token == Token::Else);
        match token {
            Token::OpenBrace => {
                self.give_up_brackets();
                self.open(Token::CloseBrace)?;
            }
            Token::OpenParenthesis => self.open(Token::CloseParenthesis)?,
            Token::OpenBracket => self.open(Token::CloseBracket)?,
            Token::CloseBrace | Token::CloseParenthesis | Token::CloseBracket => {
                self.close(token)?;
            }
            Token::If if after_else => self.deepen()?,
            Token::Else => {}
            _ if token.begins_statement() => {
                self.give_up_brackets();
                self.depth = self.level();
            }
            _ => {}
        }
        self.count_operator(token)
    }

    /// The depth of the innermost bracket, without links of `else if`.
    fn level(&self) -> usize {
        self.open.last().map_or(0, |open| open.outside + 1)
    }

    fn deepen(&mut self) -> Result<(), Refusal> {
        if self.depth >= MAX_NESTING {
            return Err(Refusal::TooDeep);
        }
        self.depth += 1;
        Ok(())
    }

    fn open(&mut self, closing: Token) -> Result<(), Refusal> {
        let outside = self.depth;
        self.deepen()?;
        self.open.push(Open { closing, outside });
        Ok(())
    }

    /// Round and square brackets that are open where none can be are a mistake that the parser
    /// finds; what follows is not in them.
    fn give_up_brackets(&mut self) {
        while self.is_in_expression() {
            self.depth = self.open.pop().map_or(0, |open| open.outside);
        }
    }

    /// Closes the nearest bracket of the kind, with all in it that is still open; but a `)` or `]`
    /// does not close a block.
    fn close(&mut self, closing: Token) -> Result<(), Refusal> {
        let candidates = self
            .open
            .iter()
            .rposition(|open| open.closing == closing || open.closing == Token::CloseBrace);
        match candidates {
            Some(index) if self.open[index].closing == closing => {
                self.depth = self.open[index].outside;
                self.open.truncate(index);
                Ok(())
            }
            _ => Err(Refusal::Unmatched),
        }
    }

    fn count_operator(&mut self, token: Token) -> Result<(), Refusal> {
        let ends_expressions = token.begins_statement()
            || matches!(
                token,
                Token::OpenBrace
                    | Token::CloseBrace
                    | Token::Semicolon
                    | Token::Assign
                    | Token::AddAssign
                    | Token::SubtractAssign
            );
        if ends_expressions {
            self.operators = 0;
        } else if token.is_operator() {
            self.operators += 1;
        }
        if self.operators > MAX_OPERATORS { Err(Refusal::TooManyOperators) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Token::*;

    fn observe_all(tokens: impl IntoIterator<Item = Token>) -> Result<(), Refusal> {
        let mut nesting = Nesting::default();
        tokens.into_iter().try_for_each(|token| nesting.observe(token))
    }

    #[test]
    fn brackets_may_be_as_deep_as_the_limit() {
        for bracket in [OpenBrace, OpenParenthesis, OpenBracket] {
            assert_eq!(observe_all([bracket; MAX_NESTING]), Ok(()));
            assert_eq!(observe_all([bracket; MAX_NESTING + 1]), Err(Refusal::TooDeep));
        }
    }

    #[test]
    fn brackets_beside_each_other_are_not_deep() {
        let pairs = [OpenBrace, CloseBrace].into_iter().cycle().take(1000);
        assert_eq!(observe_all(pairs), Ok(()));
    }

    #[test]
    fn links_of_else_if_count_until_the_next_statement() {
        let link = [Else, If, OpenBrace, CloseBrace];
        let chain = |links: usize| link.into_iter().cycle().take(4 * links);
        assert_eq!(observe_all(chain(MAX_NESTING - 1)), Ok(()));
        assert_eq!(observe_all(chain(MAX_NESTING)), Err(Refusal::TooDeep));
        let two = chain(MAX_NESTING - 1).chain([If, OpenBrace, CloseBrace]);
        assert_eq!(observe_all(two.chain(chain(MAX_NESTING - 1))), Ok(()));
    }

    #[test]
    fn operators_are_counted_by_statement() {
        assert_eq!(observe_all([Minus; MAX_OPERATORS]), Ok(()));
        assert_eq!(observe_all([Minus; MAX_OPERATORS + 1]), Err(Refusal::TooManyOperators));
        let two = [Minus; MAX_OPERATORS].into_iter().chain([Wait]).chain([Minus; MAX_OPERATORS]);
        assert_eq!(observe_all(two), Ok(()));
    }

    #[test]
    fn a_closing_bracket_needs_one_of_its_kind_in_the_block() {
        assert_eq!(observe_all([CloseBrace]), Err(Refusal::Unmatched));
        assert_eq!(
            observe_all([OpenParenthesis, OpenBrace, CloseParenthesis]),
            Err(Refusal::Unmatched)
        );
        assert_eq!(observe_all([OpenParenthesis, Wait, CloseParenthesis]), Err(Refusal::Unmatched));
        assert_eq!(observe_all([OpenBrace, OpenParenthesis, CloseBrace]), Ok(()));
    }
}
