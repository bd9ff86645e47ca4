//! What to do about a token that cannot stand where it stands: the help of a syntax error, and the
//! change of the text where one is plain. It knows what is expected and what stands around.

use crate::diagnostic::Suggestion;
use crate::expectation::Expectation;
use crate::nearest::nearest;
use crate::sink::SyntaxError;
use crate::span::Span;
use crate::surroundings::{Placed, Surroundings, shortened};
use crate::token::Token;

/// The words for a direction that could be taken for the name of a distance.
const DIRECTIONS: [&str; 7] = ["forward", "backward", "backwards", "left", "right", "up", "down"];

/// Operators in words, which nobody means at the beginning of a statement.
const OPERATORS: [&str; 4] = ["and", "or", "not", "mod"];

/// The names of types, one of which other languages write before a parameter.
const TYPES: [&str; 10] =
    ["int", "number", "length", "angle", "time", "force", "speed", "bool", "joints", "item"];

/// What to do, and the change that does it.
pub(crate) struct Advice {
    /// In a sentence.
    pub(crate) help: String,
    /// As a change of the text.
    pub(crate) suggestion: Option<Suggestion>,
}

/// A token that cannot stand where it stands.
pub(crate) struct Unexpected<'e> {
    /// Its place.
    pub(crate) error: &'e SyntaxError,
    /// What it is.
    pub(crate) found: Token,
    /// What could stand there.
    pub(crate) expectation: &'e Expectation<'e>,
    /// The tokens around it.
    pub(crate) surroundings: &'e Surroundings<'e>,
}

impl Unexpected<'_> {
    /// What to do about it, if that can be said.
    pub(crate) fn advice(&self) -> Option<Advice> {
        self.as_statement()
            .or_else(|| self.level())
            .or_else(|| self.after_word())
            .or_else(|| self.left_out())
            .or_else(|| self.in_clause())
            .or_else(|| self.of_declaration())
            .or_else(|| self.misspelt())
            .or_else(|| self.way())
            .or_else(|| self.clauses())
    }

    fn span(&self) -> Span {
        self.error.span
    }

    fn text(&self) -> &str {
        self.surroundings.text(self.span())
    }

    /// The text of the token before.
    fn before(&self) -> &str {
        let before = self.surroundings.before(self.span().start);
        before.map_or("", |token| self.surroundings.text(token.span))
    }

    fn instead(&self, text: &str) -> Advice {
        said(format!("write `{text}`")).replacing(self.span(), text)
    }

    /// A name, or another word, where a statement begins.
    fn as_statement(&self) -> Option<Advice> {
        if !self.expectation.allows_statement() {
            return None;
        }
        let text = self.text();
        let next = self.surroundings.after(self.span().end).map(|token| token.token);
        if self.found == Token::Name && next == Some(Token::OpenParenthesis) {
            let call = format!("call {}", shortened(text));
            let help = format!("to call an action write `{call}(..)`");
            return Some(said(help).replacing(self.span(), &call));
        }
        if self.found == Token::Name
            && let Some(statement) = self.statement_with(text)
        {
            return Some(self.instead(&statement));
        }
        let is_end_of_return = self.before() == "return" && !self.begins_line();
        Some(said(match self.found {
            _ if is_end_of_return => "a sequence has no value: `return` stands alone",
            Token::Stop => {
                "`return` ends the sequence; to stop the program `throw` an error whose severity \
                 is fatal"
            }
            Token::Continue => "there is no `continue`: put what follows into `if .. { .. }`",
            Token::Program => "write `sequence main { .. }`",
            _ => return None,
        }))
    }

    fn begins_line(&self) -> bool {
        self.surroundings.begins_line(self.span().start)
    }

    /// What stands for `high` and `low` elsewhere.
    fn level(&self) -> Option<Advice> {
        if !self.expectation.allows("high") {
            return None;
        }
        match self.text().to_lowercase().as_str() {
            "1" | "true" | "on" | "high" => Some(self.instead("high")),
            "0" | "false" | "off" | "low" => Some(self.instead("low")),
            "to" | "=" | "==" | "is" | ":" | "," => {
                let help = format!("leave out the `{}`", self.text());
                Some(said(help).replacing(self.span(), ""))
            }
            _ => None,
        }
    }

    /// By the word before.
    fn after_word(&self) -> Option<Advice> {
        let is_number = matches!(self.found, Token::Integer | Token::Quantity | Token::Real);
        let before = self.before();
        Some(said(match before {
            "loop" | "for" if is_number => {
                format!("write `repeat {} times {{ .. }}`", shortened(self.text()))
            }
            "wait" if self.found == Token::For => {
                "write `wait until input 3 high for up to 2 s`".to_owned()
            }
            "speed" if is_number => {
                "a speed is a word: very slow, slow, normal, fast, very fast".to_owned()
            }
            "set" if self.found == Token::Speed => {
                return Some(said("write `speed slow`"));
            }
            "set" | "toggle" | "input" | "io" | "advance" | "throw"
                if self.found == Token::OpenParenthesis =>
            {
                format!("what follows `{before}` stands without parentheses")
            }
            "throw" if self.found == Token::Text => {
                "declare the error, `error NAME { .. }`, and throw it by its name".to_owned()
            }
            _ => return None,
        }))
    }

    /// A word that is left out.
    fn left_out(&self) -> Option<Advice> {
        if self.expectation.allows("times") && self.found == Token::OpenBrace {
            let here = Span::new(self.span().start, self.span().start);
            return Some(said("write `repeat 3 times { .. }`").replacing(here, "times "));
        }
        if self.found == Token::OpenBracket && self.expectation.is_only("=") {
            let here = Span::new(self.span().start, self.span().start);
            return Some(said("put `=` before it").replacing(here, "= "));
        }
        let is_wait = self.expectation.allows("for") && !self.expectation.allows_statement();
        if is_wait {
            return Some(said("say how long it waits at the most: `for up to 2 s`"));
        }
        if self.expectation.allows("TEXT") && self.expectation.allows("in") {
            return Some(said("say why: `allow W0001 \"..\"`, or `allow W0001 in file \"..\"`"));
        }
        if self.found == Token::Sequence && self.expectation.allows("{") {
            return Some(said("clauses stand in braces, which may be empty: `{ }`"));
        }
        None
    }

    /// In the clauses of a declaration.
    fn in_clause(&self) -> Option<Advice> {
        let allows = |token| self.expectation.allows(token);
        let text = shortened(self.text());
        let instead = match self.found {
            Token::Fatal | Token::Recoverable | Token::Warning if allows("severity") => {
                format!("severity {text}")
            }
            Token::When | Token::Until | Token::While
                if allows("if") && !self.expectation.allows_statement() =>
            {
                "if".to_owned()
            }
            Token::Until if allows("succeeds") => "stop if".to_owned(),
            Token::Name if allows("using") && text == "with" => "using".to_owned(),
            Token::Name if allows("move") && self.before() == "advanced" => format!("move {text}"),
            _ if allows("keyframe") && self.found.is_word() => format!("keyframe {text}"),
            Token::Assign | Token::Colon if self.wants_word() => {
                let help = format!("leave out the `{text}`");
                return Some(said(help).replacing(self.span(), ""));
            }
            _ => return None,
        };
        Some(self.instead(&instead))
    }

    /// Whether a word of the language is expected, and neither a value nor a sign.
    fn wants_word(&self) -> bool {
        let signs = ["true", "=", ":", "{", "[", "}"];
        !signs.iter().any(|sign| self.expectation.allows(sign))
    }

    /// In what a declaration consists of: parameters, numbers, how far a recovery goes.
    fn of_declaration(&self) -> Option<Advice> {
        let allows = |token| self.expectation.allows(token);
        let (text, before) = (shortened(self.text()), self.before());
        Some(match self.found {
            Token::Name | Token::Assigned if allows(":") && TYPES.contains(&before) => {
                let span = self.surroundings.before(self.span().start)?.span;
                let turned = format!("{text}: {before}");
                said(format!("write `{turned}`")).replacing(span.to(self.span()), &turned)
            }
            Token::Comma | Token::CloseParenthesis if allows(":") => {
                said(format!("say its type: `{before}: length`"))
            }
            Token::OpenParenthesis | Token::OpenBrace if allows("[") && !allows("=") => {
                said("the numbers stand in square brackets: `[1, 2, 3] mm`")
            }
            Token::OpenBracket if self.expectation.allows_value() => {
                said("joint configurations are declared at the top: `joints NAME = [..] deg`")
            }
            _ if allows("actions") && !self.found.is_word() => {
                let here = Span::new(self.span().start, self.span().start);
                said("say of what: `3 actions`").replacing(here, "actions ")
            }
            Token::Name if allows("checkpoint") && allows("start") => {
                self.instead(&format!("checkpoint {text}"))
            }
            _ if allows("restart") => match text.as_str() {
                "retry" | "again" | "repeat" | "action" => self.instead("return to action"),
                "resume" | "proceed" | "next" => self.instead("continue"),
                "abort" | "halt" | "end" => self.instead("stop"),
                _ => return None,
            },
            _ => return None,
        })
    }

    /// Which clauses there are.
    fn clauses(&self) -> Option<Advice> {
        let is_of_error = self.expectation.allows("severity") && !self.expectation.is_name();
        let is_of_move = self.expectation.allows("succeeds") && !self.expectation.is_name();
        match (is_of_error, is_of_move) {
            (true, _) => Some(said(
                "the clauses of an error are severity, recover, otherwise, respond and then",
            )),
            (_, true) => Some(said(
                "the clauses of an advanced move are requires, distance, stop if, speed, succeeds \
                 if, on success, on failure and opposite force in reverse",
            )),
            _ => None,
        }
    }

    fn misspelt(&self) -> Option<Advice> {
        if !self.found.is_word() {
            return None;
        }
        let begins = self.expectation.allows_statement() && self.begins_line();
        let is_meant = |word: &&str| !begins || !OPERATORS.contains(word);
        let meant = nearest(self.text(), self.expectation.words().filter(is_meant))?;
        if meant == self.text() {
            return None;
        }
        Some(said(format!("did you mean `{meant}`?")).replacing(self.span(), meant))
    }

    /// About the words of a move.
    fn way(&self) -> Option<Advice> {
        let wants_direction = self.expectation.allows("forward")
            && !self.expectation.is_name()
            && !self.expectation.allows_value();
        if !wants_direction {
            return None;
        }
        if self.found == Token::Plus {
            return Some(said("put a sum in parentheses: `move (a + b) up`"));
        }
        let placed = self.name_after_move()?;
        let name = self.surroundings.text(placed.span);
        let is_length = matches!(self.found, Token::Integer | Token::Real | Token::Quantity);
        if is_length && matches!(name, "by" | "relative" | "rel") {
            let whole = placed.span.to(self.span());
            let help = format!("leave out `{name}`");
            return Some(Advice { help, suggestion: None }.replacing(whole, self.text()));
        }
        if is_length {
            let turned = format!("{} {name}", shortened(self.text()));
            let help = format!("the distance comes first: `move {turned}`");
            return Some(said(help).replacing(placed.span.to(self.span()), &turned));
        }
        if DIRECTIONS.contains(&name) {
            return Some(said(format!("say how far before the direction: `move 20 mm {name}`")));
        }
        let help = format!("to go to a position write `move to {}`", shortened(name));
        Some(said(help).replacing(placed.span, &format!("to {name}")))
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
    fn name_after_move(&self) -> Option<Placed> {
        let name = self.surroundings.before(self.span().start)?;
        let verb = self.surroundings.before(name.span.start)?;
        (name.token.is_word() && verb.token == Token::Move).then_some(name)
    }
}

impl Advice {
    fn replacing(self, span: Span, text: &str) -> Self {
        Self { suggestion: Some(Suggestion { span, text: text.to_owned() }), ..self }
    }
}

fn said(help: impl Into<String>) -> Advice {
    Advice { help: help.into(), suggestion: None }
}
