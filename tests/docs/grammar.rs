//! Which parts of the grammar an example uses: every alternative, option and repetition that it is
//! parsed by. It reads the rules of GRAMMAR.md, and knows nothing of the parser that ships.

use obverse_syntax::{RESERVED_WORDS, UNITS};
use std::collections::{BTreeMap, BTreeSet};

/// A part of the grammar that a text may use or not, by its number.
type Part = usize;

/// A rule's right side.
enum Rule {
    Word(String),
    Named(String),
    All(Vec<Rule>),
    Any(Vec<(Part, Rule)>),
    Maybe(Part, Box<Rule>),
    Many(Part, Box<Rule>),
}

/// The rules of a grammar.
pub(crate) struct Grammar {
    rules: BTreeMap<String, Rule>,
    /// What each part is called: its rule, and the part as it is written there.
    pub(crate) parts: Vec<String>,
}

impl Grammar {
    /// The rules of a page, which stand in its first block of the language `ebnf`.
    pub(crate) fn of_page(page: &str) -> Self {
        let text = page.split("```ebnf").nth(1).and_then(|rest| rest.split("```").next());
        let tokens: Vec<&str> = text.expect("the page has rules").split_whitespace().collect();
        let mut reader = Reader { tokens: &tokens, at: 0, name: "", parts: Vec::new() };
        let mut rules = BTreeMap::new();
        while reader.at < tokens.len() {
            reader.name = reader.next();
            assert_eq!(reader.next(), "=", "after {}", reader.name);
            rules.insert(reader.name.to_owned(), reader.any());
            assert_eq!(reader.next(), ".", "after the rule {}", reader.name);
        }
        Self { rules, parts: reader.parts }
    }

    /// The parts that a text uses which is a row of what this rule says, with or without
    /// `;` between.
    ///
    /// # Errors
    /// Where the text is something else.
    pub(crate) fn used(&self, rule: &str, text: &str) -> Result<BTreeSet<Part>, String> {
        let tokens = tokens(text);
        let mut used = BTreeSet::new();
        let mut at = 0;
        while at < tokens.len() {
            let mut parser = Parser { grammar: self, tokens: &tokens, trail: Vec::new(), far: at };
            let mut end = at;
            let is_whole = parser.named(rule, at, &mut |_, after| {
                end = after;
                true
            });
            if !is_whole && tokens[at].text == ";" {
                at += 1;
                continue;
            }
            if !is_whole || end == at {
                let rest = tokens[at..=parser.far.min(tokens.len() - 1)].iter();
                return Err(rest.map(|token| token.text).collect::<Vec<_>>().join(" "));
            }
            used.extend(parser.trail);
            at = end;
        }
        Ok(used)
    }
}

/// Reads rules.
struct Reader<'t> {
    tokens: &'t [&'t str],
    at: usize,
    /// The rule in hand.
    name: &'t str,
    parts: Vec<String>,
}

impl<'t> Reader<'t> {
    fn next(&mut self) -> &'t str {
        self.at += 1;
        self.tokens.get(self.at - 1).copied().unwrap_or_default()
    }

    fn next_if(&mut self, is_meant: impl Fn(&str) -> bool) -> Option<&'t str> {
        let token = self.tokens.get(self.at).copied().filter(|token| is_meant(token))?;
        self.at += 1;
        Some(token)
    }

    /// A part that ends before the token in hand.
    fn part(&mut self, from: usize) -> Part {
        self.parts.push(format!("{}: {}", self.name, self.tokens[from..self.at].join(" ")));
        self.parts.len() - 1
    }

    fn any(&mut self) -> Rule {
        let mut choices = Vec::new();
        loop {
            let from = self.at;
            let all = self.all();
            choices.push((self.part(from), all));
            if self.next_if(|token| token == "|").is_none() {
                return Rule::Any(choices);
            }
        }
    }

    fn all(&mut self) -> Rule {
        let mut parts = Vec::new();
        while let Some(token) = self.next_if(|token| !["|", ".", ")", "]", "}"].contains(&token)) {
            let from = self.at - 1;
            parts.push(match token {
                "(" => self.until(")"),
                "[" => {
                    let inner = Box::new(self.until("]"));
                    Rule::Maybe(self.part(from), inner)
                }
                "{" => {
                    let inner = Box::new(self.until("}"));
                    Rule::Many(self.part(from), inner)
                }
                _ if token.starts_with('"') => Rule::Word(token.trim_matches('"').to_owned()),
                _ => Rule::Named(token.to_owned()),
            });
        }
        Rule::All(parts)
    }

    fn until(&mut self, closing: &str) -> Rule {
        let rule = self.any();
        assert_eq!(self.next(), closing);
        rule
    }
}

/// Goes on behind what has been parsed; whether the rest fits.
type Then<'a, 'g> = &'a mut dyn FnMut(&mut Parser<'g>, usize) -> bool;

/// Tries what fits, and the next where what follows does not.
struct Parser<'g> {
    grammar: &'g Grammar,
    tokens: &'g [Token<'g>],
    /// The parts that have been used on the way here.
    trail: Vec<Part>,
    /// The farthest token that was looked at.
    far: usize,
}

impl<'g> Parser<'g> {
    fn named(&mut self, name: &str, at: usize, then: Then<'_, 'g>) -> bool {
        if let Some(rule) = self.grammar.rules.get(name) {
            return self.rule(rule, at, then);
        }
        self.far = self.far.max(at);
        let fits = self.tokens.get(at).is_some_and(|token| match name {
            "NAME" => token.kind == "WORD" && !RESERVED_WORDS.contains(&token.text),
            _ => token.kind == name,
        });
        fits && then(self, at + 1)
    }

    fn rule(&mut self, rule: &'g Rule, at: usize, then: Then<'_, 'g>) -> bool {
        match rule {
            Rule::Word(word) => {
                self.far = self.far.max(at);
                let fits = |token: &Token<'_>| {
                    ["WORD", "SIGN"].contains(&token.kind) && token.text == word
                };
                self.tokens.get(at).is_some_and(fits) && then(self, at + 1)
            }
            Rule::Named(name) => self.named(name, at, then),
            Rule::All(parts) => self.all(parts, at, then),
            Rule::Any(choices) => choices
                .iter()
                .any(|(part, choice)| self.using(*part, |parser| parser.rule(choice, at, then))),
            Rule::Maybe(part, inner) => {
                self.using(*part, |parser| parser.rule(inner, at, then)) || then(self, at)
            }
            Rule::Many(part, inner) => {
                let again = |parser: &mut Self| {
                    parser.rule(inner, at, &mut |parser, after| {
                        after > at && parser.rule(rule, after, then)
                    })
                };
                self.using(*part, again) || then(self, at)
            }
        }
    }

    fn all(&mut self, parts: &'g [Rule], at: usize, then: Then<'_, 'g>) -> bool {
        match parts {
            [] => then(self, at),
            [first, rest @ ..] => {
                self.rule(first, at, &mut |parser, after| parser.all(rest, after, then))
            }
        }
    }

    /// Tries something with this part, and takes it back if it does not fit.
    fn using(&mut self, part: Part, parse: impl FnOnce(&mut Self) -> bool) -> bool {
        let before = self.trail.len();
        self.trail.push(part);
        let fits = parse(self);
        if !fits {
            self.trail.truncate(before);
        }
        fits
    }
}

/// A token, by the name that the grammar has for its kind, or `WORD` or `SIGN`.
struct Token<'t> {
    kind: &'static str,
    text: &'t str,
}

fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut brackets = 0;
    for line in text.lines() {
        let mut rest = line.trim_start();
        while !rest.is_empty() && !rest.starts_with("//") {
            let is_after_bracket = tokens.last().is_some_and(|token: &Token<'_>| token.text == "]");
            let has_bracket_before = is_after_bracket && rest.len() < line.trim_start().len();
            let (kind, length) = token(rest, has_bracket_before, brackets > 0);
            let (text, after) = rest.split_at(length);
            brackets += i32::from(text == "(") - i32::from(text == ")");
            tokens.push(Token { kind, text });
            rest = after.trim_start();
        }
    }
    tokens
}

/// The kind and the length of the token that a text begins with.
fn token(text: &str, may_be_unit: bool, in_brackets: bool) -> (&'static str, usize) {
    let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let span = |text: &str, is_part: &dyn Fn(char) -> bool| {
        text.find(|c: char| !is_part(c)).unwrap_or(text.len())
    };
    if let Some(inner) = text.strip_prefix('"') {
        return ("TEXT", 2 + inner.find('"').expect("a text ends on its line"));
    }
    if text.starts_with(|c: char| c.is_ascii_digit()) {
        let (length, is_real) = number(text);
        let after = &text[length..];
        let blanks = after.len() - after.trim_start().len();
        return match unit(after.trim_start(), in_brackets) {
            Some(unit) => ("QUANTITY", length + blanks + unit),
            None if is_real => ("REAL", length),
            None => ("INTEGER", length),
        };
    }
    if let Some(length) = unit(text, in_brackets).filter(|_| may_be_unit) {
        return ("UNIT", length);
    }
    if text.starts_with(is_of_word) {
        return ("WORD", span(text, &is_of_word));
    }
    let is_double = ["==", "!=", "<=", ">=", "+=", "-="].iter().any(|sign| text.starts_with(sign));
    ("SIGN", if is_double { 2 } else { 1 })
}

/// The length of a number, and whether it is a real.
fn number(text: &str) -> (usize, bool) {
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let mut length = digits(text);
    let mut is_real = false;
    if let Some(after) = text[length..].strip_prefix('.') {
        (length, is_real) = (length + 1 + digits(after), true);
    }
    if let Some(after) = text[length..].strip_prefix(['e', 'E']) {
        let sign = usize::from(after.starts_with(['+', '-']));
        if digits(&after[sign..]) > 0 {
            (length, is_real) = (length + 1 + sign + digits(&after[sign..]), true);
        }
    }
    (length, is_real)
}

/// The length of the unit that a text begins with.
fn unit(text: &str, in_brackets: bool) -> Option<usize> {
    let ends = |unit: &&&str| {
        let after = text.strip_prefix(**unit);
        after.is_some_and(|after| {
            !after.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_')
        })
    };
    let found = UNITS.iter().filter(ends).map(|unit| unit.len()).max()?;
    // Before these a unit is a name, where a statement can begin.
    let after = text[found..].trim_start();
    let is_name = after.starts_with('=') && !after.starts_with("==")
        || after.starts_with("+=")
        || after.starts_with("-=");
    (in_brackets || !is_name).then_some(found)
}
