//! What of a text is not in its tree, as words: a name that stands there may have been declared
//! there, so that it is not known to be unknown. It knows places and words, and no grammar.

use crate::ast::{Item, Program};
use crate::codes::Code;
use crate::diagnostic::Diagnostic;
use crate::span::Span;
use std::collections::BTreeSet;

/// What the parser left out in order to go on.
#[derive(Debug, Default)]
pub(crate) struct GivenUp {
    /// Where.
    pub(crate) spans: Vec<Span>,
    /// Whether a block has no end, though declarations stand in it.
    pub(crate) is_unclosed: bool,
}

/// The words that a name follows which is declared.
const DECLARING: [&str; 11] = [
    "io", "output", "input", "joints", "item", "error", "sequence", "action", "var", "for",
    "position",
];

/// The words of clauses that such a word may follow without declaring: `then return to sequence`,
/// or, by mistake, `severity error`.
const IN_CLAUSES: [&str; 4] = ["severity", "to", "current", "up"];

/// The words of what a tree lacks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    words: BTreeSet<String>,
    is_endless: bool,
}

impl LeftOut {
    /// Of a text that is not read to its end, or cannot be read: it may have any word.
    #[must_use]
    pub fn endless() -> Self {
        Self { words: BTreeSet::new(), is_endless: true }
    }

    /// Of the tree of what stands in a source from an offset on, and has mistakes: the lines of
    /// these, the spans that the parser gave up, and what stands outside of all declarations.
    pub(crate) fn of(
        source: &str,
        start: usize,
        program: &Program<'_>,
        diagnostics: &[Diagnostic],
        found: &GivenUp,
    ) -> Self {
        if diagnostics.iter().any(|one| is_of_name(source, one)) {
            return Self::endless();
        }
        let mut left_out = Self::default();
        let lines = diagnostics.iter().map(|one| lines_of(source, one.primary.span));
        for span in lines.chain(found.spans.iter().copied()) {
            left_out.take(source, span);
        }
        let mut declared: Vec<Span> = program.items.iter().filter_map(span_of).collect();
        declared.sort_by_key(|span| span.start);
        let mut end = start as u32;
        for span in declared {
            left_out.take(source, Span::new(end, span.start.max(end)));
            end = end.max(span.end);
        }
        left_out.take(source, Span::new(end, source.len() as u32));
        if found.is_unclosed {
            left_out.take_variables(source.get(start..).unwrap_or(""));
        }
        left_out
    }

    fn take(&mut self, source: &str, span: Span) {
        let text = source.get(span.start as usize..span.end as usize).unwrap_or("");
        let mut before = "";
        for (word, behind) in words_of(text) {
            self.words.insert(word.to_owned());
            self.is_endless |= !IN_CLAUSES.contains(&before) && lacks_name(word, behind);
            before = word;
        }
    }

    /// A variable of the program that stands in a block without end is taken for one of the block.
    fn take_variables(&mut self, text: &str) {
        let variables = words_of(text).filter(|(word, _)| *word == "var");
        let names = variables.filter_map(|(_, behind)| words_of(behind).next());
        self.words.extend(names.map(|(name, _)| name.to_owned()));
    }

    /// What several texts lack.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.words.extend(other.words);
        self.is_endless |= other.is_endless;
        self
    }

    /// Whether this name may have been declared in what is left out.
    #[must_use]
    pub fn may_declare(&self, name: &str) -> bool {
        self.is_endless || self.words.contains(name)
    }
}

/// The words of a text, each with what is behind it.
fn words_of(text: &str) -> impl Iterator<Item = (&str, &str)> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let from_word = &rest[rest.find(is_word_part)?..];
        let end = from_word.find(|c| !is_word_part(c)).unwrap_or(from_word.len());
        let (word, behind) = from_word.split_at(end);
        rest = behind;
        Some((word, behind))
    })
}

/// Whether a word declares and is given no name, which may have been any, or imports.
fn lacks_name(word: &str, behind: &str) -> bool {
    let behind = behind.trim_start_matches([' ', '\t']);
    match word {
        "import" => true,
        "move" => behind.starts_with('{'),
        _ => DECLARING.contains(&word) && !behind.starts_with(is_word_part),
    }
}

fn is_word_part(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Whether a name is refused, in whose place the program may use any other.
fn is_of_name(source: &str, diagnostic: &Diagnostic) -> bool {
    let Span { start, end } = diagnostic.primary.span;
    let text = source.get(start as usize..end as usize).unwrap_or("");
    let is_foreign = diagnostic.code == Code::UnexpectedCharacter;
    diagnostic.code == Code::ReservedWord
        || is_foreign && text.chars().any(|c| !c.is_ascii() && c.is_alphabetic())
}

/// The lines that a span is on.
fn lines_of(source: &str, span: Span) -> Span {
    let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
    let (before, behind) = source.as_bytes().split_at((span.start as usize).min(source.len()));
    let start = before.iter().rposition(is_end).map_or(0, |at| at + 1);
    let length = (span.end - span.start) as usize;
    let rest = behind.get(length..).unwrap_or_default();
    let end = source.len() - rest.len() + rest.iter().position(is_end).unwrap_or(rest.len());
    Span::new(start as u32, end as u32)
}

/// The place of a declaration that gives a name.
fn span_of(item: &Item<'_>) -> Option<Span> {
    Some(match item {
        Item::Signal(one) => one.span,
        Item::Io(one) => one.span,
        Item::Joints(one) => one.span,
        Item::ItemDeclaration(one) => one.span,
        Item::Error(one) => one.span,
        Item::AdvancedMove(one) => one.span,
        Item::Sequence(one) => one.span,
        Item::Cleanup(one) => one.span,
        Item::Variable(one) => one.span,
        Item::Cell(_) | Item::Import(_) | Item::Allow(_) => return None,
    })
}

#[cfg(test)]
mod tests {
    use crate::parse;

    fn may_declare(source: &str, name: &str) -> bool {
        parse(source).left_out.is_some_and(|left_out| left_out.may_declare(name))
    }

    #[test]
    fn what_is_left_out_may_declare_its_words_and_no_others() {
        let source = "sequnce helper { wait 1 s }\nsequence main {\n  call help\n  wiat 3 s\n}\n";
        assert!(may_declare(source, "helper"));
        assert!(may_declare(source, "wiat"));
        assert!(!may_declare(source, "help"));
    }

    #[test]
    fn a_word_in_a_clause_declares_nothing() {
        for clause in ["severity error", "then retrun to action", "respond aftr current sequence"] {
            let source = format!("error jam {{\n{clause}\n}}\nsequence main {{ call help }}\n");
            assert!(!may_declare(&source, "help"), "{clause}");
        }
    }

    #[test]
    fn what_is_cut_off_may_declare_anything() {
        assert!(may_declare("sequence main {\n  call help\n", "help"));
        assert!(may_declare("sequence main { call help }\nsequence", "help"));
        assert!(!may_declare("sequence main { call help }\n", "help"), "it is whole");
    }

    #[test]
    fn a_declaration_that_is_given_up_behind_its_block_keeps_its_name() {
        assert!(may_declare(
            "io open {\n  set 1 high\n} reverse 3\nsequence main { io open }",
            "open"
        ));
        assert!(may_declare("sequence main {\n  var n =\n    )\n  n = 4\n}\n", "n"));
    }

    #[test]
    fn a_name_that_is_refused_may_have_any_other_in_its_place() {
        assert!(may_declare("joints = [0] deg\nsequence main { move to start }", "start"));
        assert!(may_declare("var wait = 3 s\nsequence main { sleep pause_s }", "pause_s"));
        assert!(may_declare("var gr\u{f6}\u{df}e = 3\nsequence main { groesse = 4 }", "groesse"));
        assert!(!may_declare("var a = 3 \u{d7} 4\nsequence main { b = 4 }", "b"));
    }

    #[test]
    fn a_brace_that_is_missing_before_a_declaration_is_no_end() {
        let source =
            "sequence main {\n  if true { wait 1 s\n  io grip\n}\nsequence b { wait 1 s }\n";
        assert!(!may_declare(source, "grip"));
    }
}
