//! GRAMMAR.md is what the parser accepts: programs are generated from its rules and parsed.

use obverse_syntax::ast::{Item, Program};
use obverse_syntax::format::{format, print};
use obverse_syntax::{FREE_WORDS, RESERVED_WORDS, UNITS, parse};
use std::collections::BTreeMap;

const PAGE: &str = include_str!("../GRAMMAR.md");

/// A rule's right side.
#[derive(Clone, Debug)]
enum Rule {
    Word(String),
    Named(String),
    All(Vec<Rule>),
    Any(Vec<Rule>),
    Maybe(Box<Rule>),
    Many(Box<Rule>),
}

struct Reader<'t> {
    tokens: std::iter::Peekable<std::str::SplitWhitespace<'t>>,
}

impl Reader<'_> {
    fn rules(&mut self) -> BTreeMap<String, Rule> {
        let mut rules = BTreeMap::new();
        while let Some(name) = self.tokens.next() {
            assert_eq!(self.tokens.next(), Some("="), "after {name}");
            rules.insert(name.to_owned(), self.any());
            assert_eq!(self.tokens.next(), Some("."), "after the rule {name}");
        }
        rules
    }

    fn any(&mut self) -> Rule {
        let mut choices = vec![self.all()];
        while self.tokens.next_if_eq(&"|").is_some() {
            choices.push(self.all());
        }
        Rule::Any(choices)
    }

    fn all(&mut self) -> Rule {
        let mut parts = Vec::new();
        while let Some(token) =
            self.tokens.next_if(|token| !["|", ".", ")", "]", "}"].contains(token))
        {
            parts.push(match token {
                "(" => self.until(")"),
                "[" => Rule::Maybe(Box::new(self.until("]"))),
                "{" => Rule::Many(Box::new(self.until("}"))),
                _ if token.starts_with('"') => Rule::Word(token.trim_matches('"').to_owned()),
                _ => Rule::Named(token.to_owned()),
            });
        }
        Rule::All(parts)
    }

    fn until(&mut self, closing: &str) -> Rule {
        let rule = self.any();
        assert_eq!(self.tokens.next(), Some(closing));
        rule
    }
}

fn rules() -> BTreeMap<String, Rule> {
    let text = PAGE.split("```ebnf").nth(1).and_then(|rest| rest.split("```").next());
    Reader { tokens: text.expect("the page has rules").split_whitespace().peekable() }.rules()
}

/// Writes programs by choosing at random, the same for the same seed.
struct Writer<'r> {
    rules: &'r BTreeMap<String, Rule>,
    state: u64,
    text: String,
    /// How much more may be chosen freely; afterwards what is short is chosen.
    budget: u32,
    depth: u32,
}

impl Writer<'_> {
    fn write_many(&mut self, name: &str, times: usize) {
        for _ in 0..times {
            self.budget = 40;
            self.write_named(name);
        }
    }

    fn below(&mut self, bound: usize) -> usize {
        self.state = self.state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.state >> 33) as usize % bound
    }

    fn is_free(&self) -> bool {
        self.budget > 0 && self.depth < 60
    }

    fn write(&mut self, rule: &Rule) {
        self.depth += 1;
        match rule {
            Rule::Word(word) => self.put(word),
            Rule::Named(name) => self.write_named(name),
            Rule::All(parts) => parts.iter().for_each(|part| self.write(part)),
            Rule::Any(choices) => {
                let index = if self.is_free() { self.below(choices.len()) } else { 0 };
                self.write(&choices[index]);
            }
            Rule::Maybe(part) => {
                if self.is_free() && self.below(2) == 0 {
                    self.write(part);
                }
            }
            Rule::Many(part) => {
                while self.is_free() && self.below(3) > 0 {
                    self.write(part);
                }
            }
        }
        self.depth -= 1;
    }

    fn write_named(&mut self, name: &str) {
        self.budget = self.budget.saturating_sub(1);
        let names = ["peg", "m", "s", "min", "N", "_1"];
        match name {
            "NAME" => {
                let index = self.below(FREE_WORDS.len() + names.len());
                let word =
                    FREE_WORDS.get(index).unwrap_or_else(|| &names[index - FREE_WORDS.len()]);
                self.put(word);
            }
            "INTEGER" => self.put("7"),
            "REAL" => self.put("0.5e-3"),
            "TEXT" => self.put("\"why { not\""),
            "QUANTITY" => {
                let unit = UNITS[self.below(UNITS.len())];
                self.put(&format!("20 {unit}"));
            }
            "UNIT" => {
                let unit = UNITS[self.below(UNITS.len())];
                self.text.push_str(unit);
            }
            _ => {
                let rule = self.rules.get(name).unwrap_or_else(|| panic!("no rule {name}"));
                self.write(&rule.clone());
            }
        }
    }

    fn put(&mut self, token: &str) {
        // A unit follows `]` on its line.
        let is_before_unit = self.text.ends_with(']');
        let blank = if is_before_unit || self.below(8) > 0 { " " } else { " // a comment\n" };
        self.text.push_str(blank);
        self.text.push_str(token);
    }
}

#[test]
fn programs_by_the_rules_are_accepted() {
    let rules = rules();
    for seed in 0..500 {
        let mut writer =
            Writer { rules: &rules, state: seed, text: String::new(), budget: 0, depth: 0 };
        writer.write_many("declaration", 10);
        writer.write_many("program", 1);
        let before = parse(&writer.text).program.items.len();
        writer.text.push_str(" sequence main {");
        writer.write_many("statement", 20);
        writer.text.push('}');
        let parsed = parse(&writer.text);
        assert_eq!(parsed.diagnostics, [], "seed {seed}:\n{}", writer.text);
        let Some(Item::Sequence(main)) = parsed.program.items.get(before) else {
            panic!("seed {seed}: the sequence is not item {before}:\n{}", writer.text);
        };
        assert!(before >= 10, "seed {seed}: {before} declarations");
        assert_eq!(main.body.statements.len(), 20, "seed {seed}:\n{}", writer.text);
    }
}

/// A tree without its places.
fn form(program: &Program<'_>) -> String {
    let text = format!("{program:?}");
    let mut form = String::with_capacity(text.len());
    for (index, part) in text.split("Span { start: ").enumerate() {
        let after = if index == 0 { Some(part) } else { part.split_once('}').map(|pair| pair.1) };
        form.push_str(after.unwrap_or_default());
    }
    form
}

#[test]
fn programs_by_the_rules_are_formatted() {
    let rules = rules();
    for seed in 0..500 {
        let mut writer =
            Writer { rules: &rules, state: seed, text: String::new(), budget: 0, depth: 0 };
        writer.write_many("program", 3);
        writer.text.push_str(" sequence main {");
        writer.write_many("statement", 20);
        writer.text.push('}');
        let before = parse(&writer.text).program;
        let text = format(&writer.text).expect("a program");
        assert_eq!(form(&parse(&text).program), form(&before), "seed {seed}:\n{text}");
        assert_eq!(format(&text).as_ref(), Ok(&text), "seed {seed}: a second time");
        let comments = |text: &str| text.matches("// a comment\n").count();
        assert_eq!(comments(&text), comments(&writer.text), "seed {seed}:\n{text}");
        let printed = print(&before);
        assert_eq!(form(&parse(&printed).program), form(&before), "seed {seed}:\n{printed}");
        assert_eq!(format(&printed), Ok(printed), "seed {seed}: what is printed is formatted");
    }
}

#[test]
fn the_words_on_the_page_are_those_of_the_lexer() {
    for words in [RESERVED_WORDS, FREE_WORDS] {
        let first = format!("    {} {}", words[0], words[1]);
        let start = PAGE.find(&first).expect("the words are on the page");
        let block = PAGE[start..].split("\n\n").next().unwrap_or_default();
        assert_eq!(block.split_whitespace().collect::<Vec<_>>(), words);
    }
}

#[test]
fn the_units_on_the_page_are_those_of_the_lexer() {
    let sentence = PAGE.split("The units are").nth(1).and_then(|rest| rest.split(". ").next());
    let units: Vec<&str> = sentence.unwrap_or_default().split('`').skip(1).step_by(2).collect();
    assert_eq!(units, UNITS);
}

#[test]
fn every_word_of_the_rules_is_a_word_of_the_lexer_and_the_other_way_round() {
    fn collect<'r>(rule: &'r Rule, words: &mut Vec<&'r str>) {
        match rule {
            Rule::Word(word) if word.starts_with(|c: char| c.is_ascii_lowercase()) => {
                words.push(word);
            }
            Rule::Word(_) | Rule::Named(_) => {}
            Rule::All(parts) | Rule::Any(parts) => {
                parts.iter().for_each(|part| collect(part, words));
            }
            Rule::Maybe(part) | Rule::Many(part) => collect(part, words),
        }
    }
    let rules = rules();
    let mut words = Vec::new();
    rules.values().for_each(|rule| collect(rule, &mut words));
    words.sort_unstable();
    words.dedup();
    let mut known = [RESERVED_WORDS, FREE_WORDS].concat();
    known.sort_unstable();
    assert_eq!(words, known);
}
