//! What the lexer makes of words, variables, loops and comments that are written as in another
//! language: reported, and left out or replaced. It knows the line that they stand on.

use super::Lexer;
use crate::ahead::{ascii_word_length, is_before_assignment};
use crate::codes::Code;
use crate::diagnostic::{Diagnostic, Suggestion};
use crate::elsewhere::{Then, value_elsewhere};
use crate::habits::{self, Habit};
use crate::span::Span;
use crate::surroundings::Surroundings;
use crate::token::Token;
use logos::Logos;

/// Lines that are longer, in bytes, are not written by a person.
const LONG_LINE: usize = 1000;

impl<'s> Lexer<'s, '_> {
    /// A name where a statement may begin: an assignment, or what another language begins one with.
    pub(super) fn first_word(&mut self) -> Option<Token> {
        let (word, rest) = (self.tokens.slice(), self.rest());
        let is_of_controller = word.starts_with('$');
        if !is_of_controller && is_before_assignment(rest) {
            let line = self.short_line();
            return match line.and_then(|line| Some((line, habits::of_assigned(code(line))?))) {
                Some((line, (told, habit))) => self.leave_out(line, Some((told, &habit))),
                None => Some(self.word(Token::Name)),
            };
        }
        if !is_of_controller && rest.starts_with(|c: char| !c.is_ascii()) {
            return Some(self.word(Token::Name));
        }
        let line = self.line();
        let goes_on = self.foreign_blocks > 0 && word.eq_ignore_ascii_case("else");
        if goes_on || habits::ends_block(word) {
            let is_awaited = self.foreign_blocks > 0;
            self.foreign_blocks -= u32::from(is_awaited && !goes_on);
            let habit = habits::end_of_block(word);
            return self.leave_out(line, (!is_awaited).then_some((word, &habit)));
        }
        let habit = habits::of(word, code(line)).filter(|_| !self.is_declared(word));
        let Some(habit) = habit else {
            // It can only be a mistake; after an earlier one the parser goes on here.
            if !std::mem::replace(&mut self.has_stray_word, true) {
                return Some(self.word(Token::Name));
            }
            self.pending = Some(Token::Name);
            return Some(Token::Semicolon);
        };
        match habit.then {
            Then::NextLine => self.leave_out(line, Some((word, &habit))),
            Then::InBlock => {
                self.foreign_blocks += 1;
                self.leave_out(line, Some((word, &habit)))
            }
            Then::As(first, second) => {
                self.report_habit(word, word.len(), &habit);
                self.pending = second;
                Some(first)
            }
        }
    }

    /// Whether a word of the language begins a statement as in another one, which is then left out.
    pub(super) fn is_of_another_language(&mut self) -> bool {
        if !self.begins_statement() {
            return false;
        }
        let Some(line) = self.short_line() else { return false };
        let Some((word, habit)) = habits::of_own(self.tokens.slice(), code(line)) else {
            return false;
        };
        self.foreign_blocks += u32::from(habit.then == Then::InBlock);
        self.leave_out(line, Some((word, &habit)));
        true
    }

    /// What is behind the token on its line, unless that is long. Of a program without mistakes no
    /// more is looked at for words of other languages.
    fn short_line(&self) -> Option<&'s str> {
        let rest = self.rest();
        let ahead = &rest.as_bytes()[..rest.len().min(LONG_LINE)];
        let end = ahead.iter().position(|byte| matches!(byte, b'\r' | b'\n'));
        let end = end.or_else(|| (ahead.len() < LONG_LINE).then_some(ahead.len()))?;
        rest.get(..end)
    }

    /// Whether the program gives something this name.
    fn is_declared(&self, name: &str) -> bool {
        Surroundings::new(self.source, self.start).declared_by(name).is_some()
    }

    /// Leave the rest of a line out, as far as a brace or a comment; reported is what is made of a
    /// word in it, if anything.
    pub(super) fn leave_out(&mut self, line: &str, told: Option<(&str, &Habit)>) -> Option<Token> {
        let code = code(line);
        // `PTP {X 10, Y 20}` is of a piece.
        let is_of_a_piece = code.matches('{').count() == code.matches('}').count()
            && told.is_some_and(|(_, habit)| habit.then == Then::NextLine);
        let brace = code.find(['{', '}']).filter(|_| !is_of_a_piece);
        let end = brace.unwrap_or(code.len());
        if let Some((word, habit)) = told {
            let written = line[..end].trim_end().trim_end_matches(';');
            self.report_habit(word, self.tokens.slice().len() + written.len(), habit);
        }
        self.tokens.bump(end);
        if line[end..].is_empty() || line[end..].starts_with("//") {
            self.sink.line_ends();
        }
        self.previous = Token::Semicolon;
        self.previous_end = self.tokens.span().end;
        None
    }

    /// A word of another language, in so many bytes from the token on.
    fn report_habit(&self, word: &str, length: usize, habit: &Habit) {
        let start = self.span().start;
        let span = Span::new(start, start + length as u32);
        let is_capital =
            habit.instead.as_ref().is_some_and(|instead| word.eq_ignore_ascii_case(instead));
        let message = match is_capital {
            true => format!("`{word}` is not written with capitals here"),
            false => format!("`{word}` is a word of another language"),
        };
        let at = "not a statement of this language";
        let mut diagnostic = Diagnostic::error(Code::ForeignWord, span, message, at);
        diagnostic.help = Some(habit.help.clone());
        diagnostic.suggestion = habit.instead.clone().map(|text| Suggestion { span, text });
        self.sink.report(diagnostic);
    }

    /// A variable of the controller: `$OUT[1] = TRUE`, or the `$IN[3]` of `if $IN[3] {`.
    pub(super) fn controller_variable(&mut self) -> Option<Token> {
        if self.begins_statement() {
            return self.first_word();
        }
        let word = self.tokens.slice();
        let index = match self.line().strip_prefix('[') {
            Some(index) => index.find(']').map_or(0, |end| end + "[]".len()),
            None => 0,
        };
        self.tokens.bump(index);
        let message = format!("`{word}` is a word of another language");
        let at = "not a value of this language";
        let diagnostic = Diagnostic::error(Code::ForeignWord, self.span(), message, at);
        let help = value_elsewhere(word).unwrap_or("variables with `$` are the controller's");
        self.sink.report(diagnostic.with_help(help));
        Some(Token::Absent)
    }

    /// Whether what stands before can be a whole statement.
    pub(super) fn is_over(&self) -> bool {
        self.begins_statement()
            || self.previous.ends_statement() && !self.nesting.is_in_expression()
    }

    /// Whether a `;` begins a line whose next word can be none of a program: a comment elsewhere.
    pub(super) fn is_comment(&self) -> bool {
        if self.previous_end != self.start && !self.between().contains(['\n', '\r']) {
            return false;
        }
        let line = self.line().trim_start_matches([' ', '\t']);
        let word = &line[..ascii_word_length(line)];
        let is_name = Token::lexer(word).next() == Some(Ok(Token::Name));
        // What is assigned may stand on a line of its own.
        let rest = self.rest().trim_start_matches([' ', '\t']);
        let behind = rest.get(word.len()..).unwrap_or("");
        let is_prose = is_name && !is_before_assignment(behind);
        is_prose || line.starts_with(['-', '*', '=', '#', '!', '&'])
    }

    /// A comment as another language writes it: left out.
    pub(super) fn comment_of_line(&mut self) -> Option<Token> {
        let sign = self.span();
        self.tokens.bump(self.line().trim_end().len());
        let message = "comments are not written like this";
        let at = Code::UnexpectedCharacter.page().title;
        self.sink.report(
            Diagnostic::error(Code::UnexpectedCharacter, self.span(), message, at)
                .with_help("a comment begins with `//`")
                .replacing(sign, "//"),
        );
        self.sink.line_ends();
        self.previous_end = self.tokens.span().end;
        None
    }

    /// `(i = 0; i < 10; i++)`: left out as far as its line goes.
    pub(super) fn foreign_loop(&mut self) {
        let mut depth = 1;
        let end = self.rest().find(|c: char| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            depth == 0 || matches!(c, '\r' | '\n' | '{' | '}')
        });
        let is_closed = end.is_some_and(|end| self.rest()[end..].starts_with(')'));
        let length = end.unwrap_or(self.rest().len());
        self.tokens.bump(length + usize::from(is_closed));
        self.report(Code::ForeignLoop, "a loop that counts is not written like this", |_| {
            Some("write `for i from 0 to 9 { .. }`; both ends are included".to_owned())
        });
    }

    pub(super) fn foreign_comment(&mut self) {
        let help = "a comment begins with `//` and ends with the line";
        self.report(Code::UnexpectedCharacter, "comments are not written like this", |_| {
            Some(help.to_owned())
        });
        let rest = self.rest();
        let line = rest.find(['\r', '\n']).unwrap_or(rest.len());
        self.tokens.bump(rest.find("*/").map_or(line, |end| end + "*/".len()));
    }
}

/// A line without the comment at its end.
fn code(line: &str) -> &str {
    &line[..line.find("//").unwrap_or(line.len())]
}
