//! Source text to the tokens that the grammar reads: numbers joined with their units, assigned
//! words told from others, what is foreign reported and replaced, what is too deep refused. It
//! knows the text around a token, and nothing of the grammar. What is written as in another
//! language is in `elsewhere`.

mod elsewhere;

use crate::ahead::{ascii_word_length, degree_sign, is_before_assignment, unit_length};
use crate::codes::Code;
use crate::diagnostic::Diagnostic;
use crate::foreign;
use crate::nesting::{Nesting, Refusal};
use crate::sink::{MAX_IDLE_TOKENS, Sink, Stopped};
use crate::span::Span;
use crate::surroundings::Surroundings;
use crate::token::{RESERVED_WORDS, Token};
use crate::tree;
use crate::{MAX_NESTING, MAX_OPERATORS};
use logos::Logos;

/// The tokens of a source text.
pub(crate) struct Lexer<'s, 'k> {
    source: &'s str,
    /// Where the text begins in the source.
    start: usize,
    /// Whether the text ends with [`Token::END`], and blocks that are open there stay so.
    is_unended: bool,
    tokens: logos::Lexer<'s, Token>,
    sink: &'k Sink<'s>,
    nesting: Nesting,
    before_previous: Token,
    previous: Token,
    previous_end: usize,
    /// Whether the text has ended with blocks open.
    has_ended: bool,
    /// A token that follows the one in hand and is not written: the `if` of `elif`.
    pending: Option<Token>,
    /// Blocks of another language that are open.
    foreign_blocks: u32,
    /// Whether a name has stood where only a statement can.
    has_stray_word: bool,
    /// The word of the declaration whose clauses are being read, and the braces open in it.
    clauses: Option<(Token, u32)>,
}

impl<'s, 'k> Lexer<'s, 'k> {
    /// Reads the text that begins at an offset, after its byte order mark if it has one.
    pub(crate) fn new(source: &'s str, start: usize, sink: &'k Sink<'s>) -> Self {
        let mut tokens = Token::lexer(source);
        let has_mark = source.get(start..).is_some_and(|text| text.starts_with('\u{FEFF}'));
        tokens.bump(start + if has_mark { '\u{FEFF}'.len_utf8() } else { 0 });
        let nesting = Nesting::default();
        Self {
            source,
            start,
            is_unended: false,
            tokens,
            sink,
            nesting,
            before_previous: Token::Semicolon,
            previous: Token::Semicolon,
            previous_end: start,
            has_ended: false,
            pending: None,
            foreign_blocks: 0,
            has_stray_word: false,
            clauses: None,
        }
    }

    /// The same of a text that somebody is writing: it ends where it ends, within its blocks.
    pub(crate) fn unended(source: &'s str, sink: &'k Sink<'s>) -> Self {
        Self { is_unended: true, ..Self::new(source, 0, sink) }
    }

    /// The next token as the grammar knows it; none where what was read is left out.
    fn refine(&mut self, raw: Result<Token, ()>) -> Option<Token> {
        let Ok(token) = raw else { return self.foreign_character() };
        match token {
            Token::Integer | Token::Real => Some(self.number(token)),
            Token::MalformedNumber => Some(self.malformed_number()),
            Token::Name if self.begins_statement() => self.first_word(),
            Token::Name if self.is_step() => self.step(),
            _ if self.is_astray(token) => Some(Token::Name),
            _ if token.begins_statement() => self.statement_word(token),
            _ if token.is_word() => Some(self.word(token)),
            Token::UnclosedText => {
                self.report(Code::UnterminatedString, "this text is not closed", |_| {
                    Some("a text ends with `\"` on the line it begins on".to_owned())
                });
                Some(Token::Text)
            }
            Token::ForeignText => {
                self.report(Code::UnexpectedCharacter, "a text stands in double quotes", |text| {
                    Some(format!("write \"{}\"", text.trim_matches('\'')))
                });
                Some(Token::Text)
            }
            Token::OpenParenthesis if self.previous == Token::For => {
                self.foreign_loop();
                None
            }
            Token::ForeignComment => {
                self.foreign_comment();
                None
            }
            Token::ForeignNot if self.is_over() => self.comment_of_line(),
            Token::Semicolon if self.is_comment() => self.comment_of_line(),
            _ => Some(self.sign(token)),
        }
    }

    /// A sign, or what is meant by one of another language.
    fn sign(&self, token: Token) -> Token {
        let meant = match token {
            Token::ForeignAnd => Token::And,
            Token::ForeignOr => Token::Or,
            Token::ForeignNot => Token::Not,
            Token::ForeignRemainder => Token::Mod,
            Token::ForeignAssign => Token::Assign,
            Token::ForeignNotEqual => Token::NotEqual,
            _ => return token,
        };
        let meant_text = meant.text().unwrap_or_default();
        let message = format!("`{}` is not an operator here", self.tokens.slice());
        let diagnostic = Diagnostic::error(
            Code::ForeignOperator,
            self.span(),
            message,
            Code::ForeignOperator.page().title,
        );
        let after = if token == Token::ForeignNot { " " } else { "" };
        self.sink.report(
            diagnostic
                .with_help(format!("write `{meant_text}`"))
                .replacing(self.span(), format!("{meant_text}{after}")),
        );
        meant
    }

    /// A word that begins a statement, which clauses are none.
    fn statement_word(&mut self, token: Token) -> Option<Token> {
        use Token::{Distance, If, Io, Move, Set, Sleep, Toggle, Wait, While};
        if matches!(token, If | Wait | While) && self.is_of_another_language() {
            return None;
        }
        let Some((of, 1)) = self.clauses.filter(|_| self.begins_statement()) else {
            return Some(self.word(token));
        };
        let (meant, why) = match (of, token) {
            (Io, Set | Toggle | Sleep) => return Some(token),
            (Io, Wait) => (Some(Sleep), "an I/O operation waits by `sleep`"),
            (Io, _) => (None, "an I/O operation has `set`, `toggle` and `sleep`"),
            (Move, Move) => (Some(Distance), "an advanced move says its motion by `distance`"),
            (Move, _) => (
                None,
                "what an advanced move does afterwards stands in `on success { .. }` \
                                 and `on failure { .. }`",
            ),
            _ => (None, "what the robot does stands in a sequence"),
        };
        let message = format!("`{}` is no clause", self.tokens.slice());
        let span = self.span();
        let error = Diagnostic::error(Code::UnexpectedToken, span, message, "not a clause");
        if let Some(meant) = meant {
            let instead = meant.text().unwrap_or_default();
            self.sink.report(error.with_note(why).write_instead(span, instead));
            return Some(meant);
        }
        self.sink.report(error.with_help(why));
        self.leave_out(self.line(), None)
    }

    /// Whether a word that begins a declaration or a statement stands in a clause where it can only
    /// be a mistake. As a name it lets the parser go on with the next clause.
    fn is_astray(&self, token: Token) -> bool {
        use Token::{Advanced, Cell, Cleanup, Error, Import, Item, Joints};
        self.clauses.is_some()
            && match token {
                Token::Input | Token::Output => self.previous == Token::Name,
                // No declaration begins there.
                Advanced | Cell | Cleanup | Error | Import | Item | Joints => {
                    self.is_same_line() && !self.follows_brace()
                }
                Token::With => self.previous != Token::Repeat,
                _ => false,
            }
    }

    /// Takes note of the braces of declarations that have clauses.
    fn follow_clauses(&mut self, token: Token) {
        self.clauses = match (token, self.clauses) {
            (Token::OpenBrace, Some((of, open))) => Some((of, open + 1)),
            (Token::OpenBrace, None) => match self.before_previous {
                // What is called `error` may be counted: `repeat error times {`. What is called
                // `item` may stand before a declaration: `reverse item cleanup {`.
                of @ (Token::Error | Token::Move | Token::Item | Token::Io)
                    if self.previous.is_word()
                        && !self.previous.is_reserved()
                        && !matches!(self.previous, Token::Times | Token::Cleanup) =>
                {
                    Some((of, 1))
                }
                _ => None,
            },
            (Token::CloseBrace, Some((of, open))) if open > 1 => Some((of, open - 1)),
            (Token::CloseBrace, _) => None,
            (_, clauses) => clauses,
        };
    }

    /// Whether a statement may begin with a name here, seen from the text alone: after a brace or
    /// `;`, or on a new line after what can end a statement and wants no name.
    fn begins_statement(&self) -> bool {
        let is_new = self.follows_brace();
        let is_name = self.previous.is_free() && self.before_previous.wants_name();
        // `++` is of no expression here.
        let is_step = (self.before_previous, self.previous) == (Token::Plus, Token::Plus);
        let is_over = is_name || is_step || self.previous.ends_statement();
        is_new || is_over && !self.is_same_line() && !self.nesting.is_in_expression()
    }

    /// Whether what is behind a brace or `;` begins here.
    fn follows_brace(&self) -> bool {
        matches!(self.previous, Token::OpenBrace | Token::CloseBrace | Token::Semicolon)
    }

    /// `for i from 0 to last step 2 {`: left out as far as the block.
    fn step(&mut self) -> Option<Token> {
        self.sink.report(tree::step(self.span()));
        let rest = self.rest();
        let end = rest.find(['{', '\r', '\n']).unwrap_or(rest.len());
        self.tokens.bump(end);
        self.sink.line_ends();
        None
    }

    /// Whether a name cannot be what another language gives a loop's step by.
    fn is_step(&self) -> bool {
        let follows =
            matches!(self.previous, Token::Name | Token::Integer | Token::CloseParenthesis);
        self.tokens.slice() == "step"
            && follows
            && self.is_same_line()
            && !is_before_assignment(self.rest())
    }

    fn word(&mut self, token: Token) -> Token {
        if self.next_byte().is_some_and(|byte| !byte.is_ascii()) {
            let rest = self.rest();
            let length = foreign::word_length(rest);
            if length > 0 {
                self.tokens.bump(length);
                self.sink.report(foreign::foreign_word(self.tokens.slice(), self.span()));
                return Token::Name;
            }
        }
        if token.is_reserved() {
            return token;
        }
        if is_before_assignment(self.rest()) && self.clauses.is_none() {
            let is_operand = self.nesting.is_in_expression()
                || self.previous.wants_operand(self.before_previous) && self.is_same_line();
            return if is_operand { token } else { Token::Assigned };
        }
        if self.previous == Token::CloseBracket && token == Token::Name && self.is_same_line() {
            return self.unit();
        }
        token
    }

    /// A word after `]`.
    fn unit(&mut self) -> Token {
        let from_word = self.source.get(self.tokens.span().start..).unwrap_or("");
        match unit_length(from_word) {
            Some(length) => {
                self.tokens.bump(length - self.tokens.slice().len());
                Token::Unit
            }
            // No name can follow a vector on its line.
            None => {
                self.sink.report(tree::unknown_unit(self.tokens.slice(), self.span(), &[]));
                Token::Unit
            }
        }
    }

    /// A number, with the unit or the wrong unit after it.
    fn number(&mut self, token: Token) -> Token {
        if token == Token::Integer && self.is_decimal_comma() {
            return self.decimal_comma();
        }
        let rest = self.rest();
        let word_and_on = rest.trim_start_matches([' ', '\t']);
        let blanks = rest.len() - word_and_on.len();
        let word = &word_and_on[..ascii_word_length(word_and_on)];
        if let Some(blanks_and_sign) = degree_sign(rest) {
            self.tokens.bump(blanks_and_sign);
            return Token::BadQuantity;
        }
        // In brackets no statement begins, and what follows is the default of a parameter.
        let is_assigned =
            !self.nesting.is_in_expression() && is_before_assignment(&word_and_on[word.len()..]);
        if word.is_empty() || is_assigned {
            return token;
        }
        if let Some(length) = unit_length(word_and_on) {
            self.tokens.bump(blanks + length);
            return Token::Quantity;
        }
        let is_own_in_capitals = RESERVED_WORDS.contains(&word.to_lowercase().as_str())
            || word.eq_ignore_ascii_case("then");
        if Token::lexer(word).next() == Some(Ok(Token::Name)) && !is_own_in_capitals {
            self.tokens.bump(blanks + word.len());
            return Token::BadQuantity;
        }
        token
    }

    /// Whether `,5` follows where no list is.
    fn is_decimal_comma(&self) -> bool {
        let bytes = self.rest().as_bytes();
        let is_in_list = matches!(self.previous, Token::OpenBrace | Token::Comma);
        !self.nesting.is_in_expression()
            && !is_in_list
            && matches!(bytes, [b',', digit, ..] if digit.is_ascii_digit())
    }

    /// `0,5`
    fn decimal_comma(&mut self) -> Token {
        let comma = self.span().end;
        let digits = self.rest()[1..].bytes().take_while(u8::is_ascii_digit).count();
        self.tokens.bump(1 + digits);
        let message = "a number has a point, and no comma";
        let instead = self.tokens.slice().replace(',', ".");
        self.sink.report(
            Diagnostic::error(Code::MalformedNumber, self.span(), message, "a decimal comma")
                .with_help(format!("write `{instead}`"))
                .replacing(Span::new(comma, comma + 1), "."),
        );
        self.number(Token::Real)
    }

    /// `5.`, `.5` or, as in other languages, the range `0..9`.
    fn malformed_number(&mut self) -> Token {
        let rest = self.rest();
        if rest.starts_with('.') {
            let is_range_byte = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'=');
            self.tokens.bump(rest.bytes().take_while(is_range_byte).count());
            self.report(Code::MalformedNumber, "this is not a number", |_| {
                Some("a loop counts `for i from 0 to 9`".to_owned())
            });
            return Token::Real;
        }
        let text = self.tokens.slice();
        let instead = if text.starts_with('.') { format!("0{text}") } else { format!("{text}0") };
        let message = "a digit is missing beside the point";
        let at = Code::MalformedNumber.page().title;
        self.sink.report(
            Diagnostic::error(Code::MalformedNumber, self.span(), message, at)
                .write_instead(self.span(), &instead),
        );
        self.number(Token::Real)
    }

    /// A character that no token begins with.
    fn foreign_character(&mut self) -> Option<Token> {
        if self.tokens.slice() == "°" && self.previous == Token::CloseBracket {
            return Some(self.unit());
        }
        let length = ascii_word_length(self.rest());
        if self.tokens.slice() == "$" && length > 0 {
            self.tokens.bump(length);
            return self.controller_variable();
        }
        let foreign = foreign::read(self.tokens.slice(), self.rest());
        self.tokens.bump(foreign.length);
        self.sink.report(foreign::diagnostic(self.tokens.slice(), self.span()));
        foreign.meant
    }

    fn report(&self, code: Code, message: &str, help: impl FnOnce(&str) -> Option<String>) {
        let slice = self.tokens.slice();
        let mut span = self.span();
        span.end = span.start + slice.trim_end().len() as u32;
        let mut diagnostic = Diagnostic::error(code, span, message, code.page().title);
        diagnostic.help = help(slice);
        self.sink.report(diagnostic);
    }

    fn refuse(&self, refusal: Refusal) {
        let span = self.span();
        let sign = self.tokens.slice();
        self.sink.report(match refusal {
            Refusal::Unmatched => {
                let message = format!("`{sign}` closes nothing");
                Diagnostic::error(Code::UnmatchedBracket, span, message, "no bracket is open")
                    .with_help("remove it, or look for one too many before it")
            }
            Refusal::TooDeep => {
                let message = "blocks and brackets are too deep in one another";
                let at = format!("this would be level {}", MAX_NESTING + 1);
                Diagnostic::error(Code::NestingTooDeep, span, message, at)
                    .with_note(format!("the limit is {MAX_NESTING}; reading ends here"))
                    .with_help("put the inner part into a sequence and call it")
            }
            Refusal::TooManyOperators => {
                let message = "this expression has too many operators";
                let at = format!("this would be number {}", MAX_OPERATORS + 1);
                Diagnostic::error(Code::ExpressionTooLong, span, message, at)
                    .with_note(format!("the limit is {MAX_OPERATORS}; reading ends here"))
                    .with_help("name a part of it with `var`")
            }
        });
    }

    /// The parser leaves out one token after the other, and reports nothing before it finds a
    /// place to go on.
    fn give_up(&self) {
        let message = "this is not a program";
        self.sink.report(
            Diagnostic::error(Code::UnexpectedToken, self.span(), message, "reading ends here")
                .with_note(format!("none of the {MAX_IDLE_TOKENS} tokens before it makes sense")),
        );
    }

    /// The text has ended: a brace for each that is still open, so that what was read in the block
    /// is kept. Reported once. Of an unended text, its end.
    fn missing_brace(&mut self) -> Option<(u32, Token, u32)> {
        let end = self.source.len() as u32;
        if self.is_unended {
            let is_told = std::mem::replace(&mut self.has_ended, true);
            return (!is_told).then_some((end, Token::END, end));
        }
        if !self.nesting.close_block() {
            return None;
        }
        if !std::mem::replace(&mut self.has_ended, true)
            && let Some(diagnostic) = Surroundings::new(self.source, self.start).unclosed_at(end)
        {
            self.sink.ends_early(diagnostic, end);
        }
        Some((end, Token::CloseBrace, end))
    }

    fn span(&self) -> Span {
        let range = self.tokens.span();
        Span::new(range.start as u32, range.end as u32)
    }

    fn rest(&self) -> &'s str {
        self.tokens.remainder()
    }

    /// What is behind the token on its line.
    fn line(&self) -> &'s str {
        let rest = self.rest();
        &rest[..rest.find(['\r', '\n']).unwrap_or(rest.len())]
    }

    fn next_byte(&self) -> Option<u8> {
        self.source.as_bytes().get(self.tokens.span().end).copied()
    }

    /// Whether only blanks stand between this token and the one before.
    fn is_same_line(&self) -> bool {
        self.between().bytes().all(|byte| byte == b' ' || byte == b'\t')
    }

    /// What stands between this token and the one before.
    fn between(&self) -> &'s str {
        self.source.get(self.previous_end..self.tokens.span().start).unwrap_or("")
    }
}

impl Iterator for Lexer<'_, '_> {
    type Item = Result<(u32, Token, u32), Stopped>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if self.sink.is_full() {
                return Some(Err(Stopped));
            }
            let token = match self.pending.take() {
                Some(token) => token,
                None => {
                    let Some(raw) = self.tokens.next() else {
                        return self.missing_brace().map(Ok);
                    };
                    if self.sink.awaits_line_end() && self.between().contains(['\n', '\r']) {
                        self.sink.line_ends();
                    }
                    let Some(token) = self.refine(raw) else { continue };
                    token
                }
            };
            match self.nesting.observe(token) {
                Ok(()) => {}
                Err(refusal) => {
                    self.refuse(refusal);
                    if refusal == Refusal::Unmatched {
                        continue;
                    }
                    return Some(Err(Stopped));
                }
            }
            if self.sink.is_idle() {
                self.give_up();
                return Some(Err(Stopped));
            }
            self.follow_clauses(token);
            if self.previous == Token::OpenBrace && token.begins_statement() {
                self.sink.block_has_statements();
            }
            let Span { start, end } = self.span();
            (self.before_previous, self.previous) = (self.previous, token);
            self.previous_end = end as usize;
            return Some(Ok((start, token, end)));
        }
    }
}

#[cfg(test)]
#[path = "lexer_tests.rs"]
mod tests;
