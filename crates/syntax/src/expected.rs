//! What may be written next, for whoever is writing: the words that the grammar allows at the end
//! of a text, and whether a name or a value can stand there. Which names there are is not known
//! here.

use crate::expectation::Expectation;
use crate::grammar;
use crate::lexer::Lexer;
use crate::sink::Sink;
use crate::token::{FREE_WORDS, RESERVED_WORDS};

/// What the grammar allows at the end of a text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Expected {
    /// The words of the language, in alphabetical order. Where a name can stand, those that can be
    /// names are not among them.
    pub words: Vec<&'static str>,
    /// Whether a name can stand here.
    pub is_name: bool,
    /// Whether an expression can begin here.
    pub is_value: bool,
    /// Whether a statement or a declaration can begin here.
    pub is_statement: bool,
    /// Whether this is outside of all declarations.
    pub is_top: bool,
}

/// The words that declarations begin with, those of statements that also do apart.
const DECLARATIONS: [&str; 11] = [
    "action", "advanced", "cell", "cleanup", "error", "import", "input", "item", "joints",
    "output", "sequence",
];

/// The words that declarations and statements begin with.
const BOTH: [&str; 3] = ["allow", "io", "var"];

/// What may follow a text that is being written. None where that cannot be said: what was left out
/// because of a mistake reaches to the end.
#[must_use]
pub fn expected_after(text: &str) -> Option<Expected> {
    if text.len() > crate::MAX_SOURCE_BYTES {
        return None;
    }
    let sink = Sink::default();
    let result = grammar::ProgramParser::new().parse(text, &sink, Lexer::unended(text, &sink));
    if let Err(error) = result {
        sink.unexpected(error, text.len() as u32);
    }
    let tokens = sink.into_expected_at_end();
    (!tokens.is_empty()).then(|| of(&Expectation::new(&tokens)))
}

fn of(expectation: &Expectation<'_>) -> Expected {
    let is_statement = expectation.allows_statement();
    let is_top = is_statement && !expectation.allows("}");
    // In a block a declaration is read in order to say that it does not belong there, and at the
    // top a statement.
    let belongs = |word: &str| {
        !is_statement || BOTH.contains(&word) || DECLARATIONS.contains(&word) == is_top
    };
    let allowed: Vec<&str> = expectation.words().filter(|word| belongs(word)).collect();
    let all = RESERVED_WORDS.iter().chain(FREE_WORDS);
    let mut words: Vec<&'static str> = all.copied().filter(|word| allowed.contains(word)).collect();
    words.sort_unstable();
    Expected {
        words,
        is_name: expectation.allows("NAME"),
        is_value: expectation.allows_value(),
        is_statement,
        is_top,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<&'static str> {
        expected_after(text).expect("something is expected").words
    }

    #[test]
    fn a_statement_or_a_declaration_begins_where_it_belongs() {
        assert!(words("").contains(&"sequence") && !words("").contains(&"move"));
        let top = words("var a = 1\n");
        assert!(top.contains(&"joints") && !top.contains(&"wait"), "{top:?}");
        let block = words("sequence main {\n  wait 1 s\n");
        assert!(block.contains(&"move") && block.contains(&"io"), "{block:?}");
        assert!(!block.contains(&"joints") && !block.contains(&"sequence"), "{block:?}");
    }

    #[test]
    fn clauses_and_words_within_a_statement_are_their_own() {
        assert_eq!(words("sequence main { speed "), ["fast", "normal", "slow", "very"]);
        assert_eq!(words("error e { severity "), ["fatal", "recoverable", "warning"]);
        assert_eq!(words("error e { then return to "), ["action", "sequence"]);
        assert_eq!(words("sequence main { skip in "), ["reverse"]);
        let clauses = words("error e { severity fatal\n");
        assert!(clauses.contains(&"recover") && !clauses.contains(&"move"), "{clauses:?}");
        assert_eq!(words("sequence main { set 3 "), ["high", "low"]);
    }

    #[test]
    fn names_and_values_are_told_apart() {
        let expected = |text: &str| expected_after(text).expect("something is expected");
        let name = expected("sequence main { advance ");
        assert!(name.is_name && !name.is_value && name.words.is_empty(), "{name:?}");
        let value = expected("sequence main { wait until_ + ");
        assert!(value.is_name && value.is_value && value.words.contains(&"holding"), "{value:?}");
        assert!(!expected("sequence main { set 3 ").is_name);
    }

    #[test]
    fn a_mistake_before_does_not_matter() {
        let block = words("sequence a { move move }\nsequence main {\n  wait 1 s\n  ");
        assert!(block.contains(&"move"), "{block:?}");
    }
}
