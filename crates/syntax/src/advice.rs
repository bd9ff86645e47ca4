//! What to do about a token that cannot stand where it stands: the help of a syntax error, and the
//! change of the text where one is plain. It knows what is expected and what stands around.

mod elsewhere;
mod reversal;

use crate::diagnostic::Suggestion;
use crate::elsewhere::{END, UNTIL};
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
        self.of_reversal()
            .or_else(|| self.of_another_language())
            .or_else(|| self.given())
            .or_else(|| self.as_statement())
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
        if self.found.can_be_name() && self.next() == Some(Token::OpenParenthesis) {
            return Some(self.called_like_a_function());
        }
        if self.found.can_be_name()
            && let Some(statement) = self.statement_with(text)
        {
            return Some(self.instead(&statement));
        }
        let is_end_of_return = self.before() == "return" && !self.begins_line();
        Some(said(match self.found {
            _ if is_end_of_return => "a sequence has no value: `return` stands alone",
            Token::Stop => END,
            Token::Until => UNTIL,
            Token::Continue => "there is no `continue`: put what follows into `if .. { .. }`",
            Token::Program => "write `sequence main { .. }`",
            _ => return None,
        }))
    }

    /// `pick(vial)`, `grip()`
    fn called_like_a_function(&self) -> Advice {
        let text = self.text();
        let call = format!("call {}", shortened(text));
        match self.statement_with(text) {
            Some(statement) if statement != call => {
                let help = said(format!("write `{statement}`"));
                let [open, close] = match self.surroundings.two_after(self.span().end) {
                    Some(brackets) => brackets,
                    None => return help,
                };
                let is_empty =
                    (open.token, close.token) == (Token::OpenParenthesis, Token::CloseParenthesis);
                match is_empty {
                    true => help.replacing(self.span().to(close.span), &statement),
                    false => help,
                }
            }
            _ => {
                said(format!("to call an action write `{call}(..)`")).replacing(self.span(), &call)
            }
        }
    }

    /// What a word is given: `call put vial`, `io grip()`.
    fn given(&self) -> Option<Advice> {
        let name = self.surroundings.before(self.span().start)?;
        let verb = self.surroundings.before(name.span.start)?.token;
        if !self.expectation.allows_statement() || self.begins_line() || !name.token.is_word() {
            return None;
        }
        let text = shortened(self.surroundings.text(name.span));
        let closing = self.surroundings.after(self.span().end);
        let is_empty = closing.filter(|closing| closing.token == Token::CloseParenthesis);
        match (verb, self.found) {
            (Token::Io | Token::Advance | Token::Throw, Token::OpenParenthesis) => {
                let verb = verb.text().unwrap_or_default();
                let help = said(format!("nothing is given to it: write `{verb} {text}`"));
                Some(match is_empty {
                    Some(closing) => help.replacing(self.span().to(closing.span), ""),
                    None => help,
                })
            }
            (Token::Call, found) if found.can_be_name() || is_number(found) => {
                let given = self.text();
                let help = format!(
                    "what is given stands in parentheses: `call {text}({})`",
                    shortened(given)
                );
                let span = Span::new(name.span.end, self.span().end);
                Some(match self.goes_on() {
                    true => said(help),
                    false => said(help).replacing(span, &format!("({given})")),
                })
            }
            _ => None,
        }
    }

    /// Whether something follows on its line.
    fn goes_on(&self) -> bool {
        let next = self.surroundings.after(self.span().end);
        next.is_some_and(|token| !self.surroundings.begins_line(token.span.start))
    }

    fn begins_line(&self) -> bool {
        self.surroundings.begins_line(self.span().start)
    }

    /// What stands for `high` and `low` elsewhere.
    fn level(&self) -> Option<Advice> {
        if !self.expectation.wants("high") {
            return None;
        }
        if self.begins_line() || matches!(self.found, Token::CloseBrace | Token::Semicolon) {
            return self.no_level();
        }
        let text = self.text().to_lowercase();
        match text.as_str() {
            // The `=` behind it is what is wrong.
            _ if self.found == Token::Assigned => None,
            "1" | "true" | "on" | "high" => Some(self.instead("high")),
            "0" | "false" | "off" | "low" => Some(self.instead("low")),
            "for" => {
                let help = "say which level: `wait until input 3 high for up to 2 s`";
                Some(said(help).replacing(self.here(), "high "))
            }
            "to" | "=" | "==" | "is" | ":" | "," if self.goes_on() => {
                let help = format!("leave out the `{}`", self.text());
                Some(said(help).replacing(self.span(), ""))
            }
            _ => None,
        }
    }

    /// `set lamp`, and nothing on its line.
    fn no_level(&self) -> Option<Advice> {
        let signal = self.surroundings.before(self.span().start)?;
        let verb = self.surroundings.before(signal.span.start)?;
        let name = shortened(self.surroundings.text(signal.span));
        let help = format!("say which level: `set {name} high` or `set {name} low`");
        (verb.token == Token::Set).then(|| said(help))
    }

    /// By the word before.
    fn after_word(&self) -> Option<Advice> {
        let has_number = is_number(self.found);
        let before = self.before();
        Some(said(match before {
            "for" if has_number && self.expectation.wants("up") => {
                format!("write `for up to {}`", shortened(self.text()))
            }
            "loop" | "for" if has_number => {
                format!("write `repeat {} times {{ .. }}`", shortened(self.text()))
            }
            "wait" if self.found == Token::For && self.next().is_some_and(is_number) => {
                return self.wait_for_time();
            }
            "wait" if self.found == Token::For => {
                "write `wait until input 3 high for up to 2 s`".to_owned()
            }
            "repeat" if self.found == Token::Until => UNTIL.to_owned(),
            "until" if self.expectation.is_only("input") => return Some(self.wait_for_value()),
            "speed" if has_number => {
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

    /// `wait for 3 s`
    fn wait_for_time(&self) -> Option<Advice> {
        let time = self.surroundings.after(self.span().end)?;
        let line = self.surroundings.line_behind(time.span.start);
        let help = format!("write `wait {}`", shortened(line.trim_end_matches([' ', ';'])));
        Some(said(help).replacing(Span::new(self.span().start, time.span.start), ""))
    }

    /// `wait until x > 3`
    fn wait_for_value(&self) -> Advice {
        if self.surroundings.declared_by(self.text()) == Some(Token::Input) {
            let help = format!("write `input {}`", shortened(self.text()));
            return said(help).replacing(self.here(), "input ");
        }
        said(
            "an input is waited for, `wait until input 3 high for up to 2 s`; for a value write \
             `while not (CONDITION) { wait 0.1 s }`",
        )
    }

    /// A word that is left out.
    fn left_out(&self) -> Option<Advice> {
        if self.expectation.wants("times") && self.found == Token::OpenBrace {
            return Some(said("write `repeat 3 times { .. }`").replacing(self.here(), "times "));
        }
        if self.found == Token::OpenBracket && self.expectation.is_only("=") {
            return Some(said("put `=` before it").replacing(self.here(), "= "));
        }
        let is_wait = self.expectation.wants("for") && !self.expectation.allows_statement();
        if is_wait {
            return Some(said("say how long it waits at the most: `for up to 2 s`"));
        }
        if self.expectation.allows("TEXT") && self.expectation.wants("in") {
            return Some(said("say why: `allow W0001 \"..\"`, or `allow W0001 in file \"..\"`"));
        }
        if self.found == Token::Sequence && self.expectation.allows("{") {
            return Some(said("clauses stand in braces, which may be empty: `{ }`"));
        }
        None
    }

    /// In the clauses of a declaration.
    fn in_clause(&self) -> Option<Advice> {
        let wants = |token| self.expectation.wants(token);
        let text = shortened(self.text());
        let instead = match self.found {
            Token::Fatal | Token::Recoverable | Token::Warning if wants("severity") => {
                format!("severity {text}")
            }
            Token::When | Token::Until | Token::While
                if wants("if") && !self.expectation.allows_statement() =>
            {
                "if".to_owned()
            }
            Token::Until if wants("succeeds") => "stop if".to_owned(),
            Token::Name if wants("using") && text == "with" => "using".to_owned(),
            Token::Name if wants("move") && self.before() == "advanced" => format!("move {text}"),
            Token::Name
                if wants("throw")
                    && wants("repeat")
                    && matches!(text.as_str(), "again" | "redo") =>
            {
                "repeat with perturbation".to_owned()
            }
            _ if wants("keyframe") && self.found.can_be_name() => format!("keyframe {text}"),
            Token::Assign | Token::Colon if self.wants_word() && self.goes_on() => {
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
        let wants = |token| self.expectation.wants(token);
        let (text, before) = (shortened(self.text()), self.before());
        Some(match self.found {
            Token::Name | Token::Assigned if wants(":") && TYPES.contains(&before) => {
                let span = self.surroundings.before(self.span().start)?.span;
                let turned = format!("{text}: {before}");
                said(format!("write `{turned}`")).replacing(span.to(self.span()), &turned)
            }
            Token::OpenParenthesis | Token::OpenBrace | Token::OpenBracket
                if before == "to" && self.expectation.is_name() =>
            {
                said("declare the position, `joints NAME = [..] deg`, and write `move to NAME`")
            }
            Token::Comma | Token::CloseParenthesis if wants(":") => {
                said(format!("say its type: `{before}: length`"))
            }
            Token::OpenParenthesis | Token::OpenBrace if wants("[") && !wants("=") => {
                said("the numbers stand in square brackets: `[1, 2, 3] mm`")
            }
            Token::OpenBracket if self.expectation.allows_value() => {
                said("joint configurations are declared at the top: `joints NAME = [..] deg`")
            }
            _ if wants("actions") && !self.found.is_word() => {
                said("say of what: `3 actions`").replacing(self.here(), "actions ")
            }
            Token::Name if wants("checkpoint") && wants("start") => {
                self.instead(&format!("checkpoint {text}"))
            }
            _ if wants("restart") => match text.as_str() {
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
        match (self.expectation.wants("severity"), self.expectation.wants("succeeds")) {
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
        if !self.expectation.wants("forward") {
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
        if name == "linearly" {
            return Some(self.linearly_first(placed));
        }
        if DIRECTIONS.contains(&name) {
            return Some(said(format!("say how far before the direction: `move 20 mm {name}`")));
        }
        if self.surroundings.declared_by(name) == Some(Token::Move) {
            let verb = self.surroundings.before(placed.span.start)?;
            let instead = format!("advance {name}");
            let help = format!("write `{}`", shortened(&instead));
            return Some(said(help).replacing(verb.span.to(placed.span), &instead));
        }
        let help = format!("to go to a position write `move to {}`", shortened(name));
        Some(said(help).replacing(placed.span, &format!("to {name}")))
    }

    /// `move linearly to start`
    fn linearly_first(&self, linearly: Placed) -> Advice {
        let help = said("the way comes last: `move to NAME linearly`");
        let behind = self.surroundings.after(self.span().end);
        let target = behind.filter(|target| target.token.can_be_name() && self.goes_on());
        let Some(mut last) = target.filter(|_| self.found == Token::To) else { return help };
        if let Some([dot, keyframe]) = self.surroundings.two_after(last.span.end)
            && dot.token == Token::Dot
        {
            last = keyframe;
        }
        let turned = format!("{} linearly", self.surroundings.text(self.span().to(last.span)));
        said(format!("the way comes last: `move {}`", shortened(&turned)))
            .replacing(linearly.span.to(last.span), &turned)
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

fn is_number(token: Token) -> bool {
    matches!(token, Token::Integer | Token::Quantity | Token::Real)
}

fn said(help: impl Into<String>) -> Advice {
    Advice { help: help.into(), suggestion: None }
}
