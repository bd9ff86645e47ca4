//! What the grammar allows at a place, in words for people: categories in place of the list of
//! tokens, and at most three of them. It knows lalrpop's names of tokens, and no source text.

use crate::token::{FREE_WORDS, RESERVED_WORDS};
use std::collections::BTreeSet;

/// How many categories are named.
const MOST: usize = 3;

/// The tokens that are allowed, as the grammar names them.
#[derive(Clone, Debug)]
pub(crate) struct Expectation<'e> {
    tokens: BTreeSet<&'e str>,
}

impl<'e> Expectation<'e> {
    /// Of lalrpop's list, which has the names in quotes.
    pub(crate) fn new(expected: &'e [String]) -> Self {
        Self { tokens: expected.iter().map(|token| token.trim_matches('"')).collect() }
    }

    /// Whether this token is allowed.
    pub(crate) fn allows(&self, token: &str) -> bool {
        self.tokens.contains(token)
    }

    /// Whether this word of the language is allowed as what it is: where a name or a value can
    /// stand, every free word is allowed, and none is meant.
    pub(crate) fn wants(&self, word: &str) -> bool {
        self.allows(word) && !(FREE_WORDS.contains(&word) && self.allows("NAME"))
    }

    /// Whether nothing but this token is allowed.
    pub(crate) fn is_only(&self, token: &str) -> bool {
        self.tokens.len() == 1 && self.allows(token)
    }

    /// Whether a statement can begin here: in a block, and at the top in order to say that it
    /// cannot.
    pub(crate) fn allows_statement(&self) -> bool {
        self.wants("cell")
    }

    /// Whether an expression can begin here.
    pub(crate) fn allows_value(&self) -> bool {
        self.allows("true")
    }

    /// Whether a name can stand here and an expression cannot.
    pub(crate) fn is_name(&self) -> bool {
        self.allows("NAME") && !self.allows_value()
    }

    /// The words of the language that are allowed, other than as names.
    pub(crate) fn words(&self) -> impl Iterator<Item = &'e str> {
        let free_are_names = self.allows("NAME");
        self.tokens.iter().copied().filter(move |token| {
            RESERVED_WORDS.contains(token) || !free_are_names && FREE_WORDS.contains(token)
        })
    }

    /// At the top of a file a statement can begin as well, but is not what is expected.
    fn name_of(&self, category: &Category) -> &'static str {
        let is_at_top = category.sign == "cell" && !self.allows("}");
        if is_at_top { "a declaration" } else { category.name }
    }

    /// At most three categories: `a statement or `}``.
    pub(crate) fn describe(&self) -> String {
        let mut rest = self.tokens.clone();
        let mut named: Vec<String> = Vec::new();
        for category in CATEGORIES {
            if category.applies(self) {
                rest.retain(|token| !category.covers(token));
                named.push(self.name_of(category).to_owned());
            }
        }
        let has_operators = rest.contains("*") || rest.contains("or");
        if has_operators {
            // `(` as well: that of a call, after a name.
            rest.retain(|token| !OPERATORS.contains(token) && *token != "(");
        }
        if self.allows_statement() {
            // What else could go on with the statement before is beside the point.
            rest.retain(|token| *token == "}");
        }
        if rest.len() + named.len() > 1 {
            rest.remove(";");
        }
        let is_bracket = |token: &&str| ["{", "}", "(", ")", "[", "]"].contains(token);
        let (brackets, others): (Vec<&str>, Vec<&str>) = rest.into_iter().partition(is_bracket);
        named.extend(brackets.iter().chain(&others).map(|token| format!("`{token}`")));
        if has_operators {
            named.push("an operator".to_owned());
        }
        named.truncate(MOST);
        join(&named)
    }
}

/// `a, b or c`.
fn join(parts: &[String]) -> String {
    match parts {
        [] => "something else".to_owned(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// A group of tokens with a name.
struct Category {
    name: &'static str,
    /// The token that tells that the group is allowed.
    sign: &'static str,
    /// The token that tells that it is another group.
    unless: &'static str,
    members: &'static [&'static str],
    has_free_words: bool,
}

impl Category {
    fn applies(&self, expectation: &Expectation<'_>) -> bool {
        expectation.allows(self.sign) && !expectation.allows(self.unless)
    }

    fn covers(&self, token: &str) -> bool {
        self.members.contains(&token) || self.has_free_words && FREE_WORDS.contains(&token)
    }
}

const OPERATORS: [&str; 14] =
    ["+", "-", "*", "/", "mod", "and", "or", "==", "!=", "<", "<=", ">", ">=", "="];

const STATEMENTS: &[&str] = &[
    "advance",
    "barrier",
    "break",
    "call",
    "checkpoint",
    "do",
    "for",
    "fork",
    "if",
    "io",
    "irreversible",
    "keep",
    "loop",
    "move",
    "repeat",
    "return",
    "set",
    "skip",
    "sleep",
    "throw",
    "toggle",
    "var",
    "wait",
    "while",
    "with",
    "position",
    "allow",
    "speed",
    "tool",
    "ASSIGNED",
    "cell",
    "joints",
    "item",
    "error",
    "advanced",
    "sequence",
    "action",
    "cleanup",
    "requires",
    "import",
    "output",
    "input",
    ";",
];

const VALUES: &[&str] = &[
    "NAME",
    "ASSIGNED",
    "INTEGER",
    "REAL",
    "QUANTITY",
    "BAD QUANTITY",
    "ABSENT",
    "true",
    "false",
    "not",
    "-",
    "(",
    "input",
    "force",
    "distance",
    "holding",
];

const fn category(
    name: &'static str,
    sign: &'static str,
    unless: &'static str,
    members: &'static [&'static str],
) -> Category {
    Category { name, sign, unless, members, has_free_words: false }
}

/// In the order in which they are named.
const CATEGORIES: &[Category] = &[
    category("a statement", "cell", "NAME", STATEMENTS),
    Category { has_free_words: true, ..category("a value", "true", "", VALUES) },
    Category { has_free_words: true, ..category("a name", "NAME", "true", &["NAME", "ASSIGNED"]) },
    category(
        "a clause",
        "severity",
        "NAME",
        &["severity", "recover", "otherwise", "respond", "then", "on", "give"],
    ),
    category(
        "a clause",
        "succeeds",
        "NAME",
        &["requires", "distance", "stop", "speed", "succeeds", "on", "opposite"],
    ),
    category("a behaviour", "throw", "cell", &["return", "repeat", "throw"]),
    category("a primitive", "toggle", "cell", &["set", "toggle", "sleep"]),
    category(
        "a direction",
        "forward",
        "NAME",
        &["forward", "backward", "backwards", "left", "right", "up", "down", "x", "y", "z", "-"],
    ),
    category("a speed", "very", "NAME", &["very", "slow", "normal", "fast"]),
    category("a whole number", "INTEGER", "true", &["INTEGER"]),
    category("a unit", "UNIT", "", &["UNIT"]),
    category("a text in quotes", "TEXT", "", &["TEXT"]),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn describe(tokens: &[&str]) -> String {
        let quoted: Vec<String> = tokens.iter().map(|token| format!("\"{token}\"")).collect();
        Expectation::new(&quoted).describe()
    }

    #[test]
    fn groups_are_named_once() {
        assert_eq!(describe(&["move", "cell", "wait", "speed", ";", "}"]), "a statement or `}`");
        assert_eq!(describe(&["move", "cell", "wait", "speed", ";"]), "a declaration");
        assert_eq!(describe(&["NAME", "x", "start"]), "a name");
        assert_eq!(describe(&["true", "NAME", "(", "x", "INTEGER"]), "a value");
        assert_eq!(describe(&["+", "*", "{"]), "`{` or an operator");
        assert_eq!(describe(&["low", "high"]), "`high` or `low`");
        assert_eq!(describe(&[]), "something else");
    }

    #[test]
    fn at_most_three_are_named() {
        assert_eq!(describe(&["by", "fast", "once", "with"]), "`by`, `fast` or `once`");
    }

    #[test]
    fn ways_to_go_on_with_the_statement_before_are_not_named() {
        let text = describe(&["cell", "move", "else", ".", "linearly", "*", "}"]);
        assert_eq!(text, "a statement, `}` or an operator");
    }
}
