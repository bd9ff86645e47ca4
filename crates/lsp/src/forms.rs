//! How the commands of the language are written: their forms, what each part of one may be, and at
//! which part somebody is who is writing one. The forms are held against the grammar by a test.

use crate::before::Before;
use obverse_syntax::highlight::{Piece, PieceKind};
use std::ops::Range;

/// The forms, the words of the language as they are and what is to be filled in as `<part>`. What
/// may be left out stands in brackets. Of forms that begin with the same word, the one counts whose
/// second word is written too, and else the last.
const FORMS: [&str; 26] = [
    "move to <place> [linearly] [reversible always]",
    "move <distance> <direction> [in <frame>] [linearly] [reversible always]",
    "turn <angle> [advancing <distance>] <direction> [in <frame>]",
    "wait until input <input> <level> for up to <time> [else {…}]",
    "wait <time>",
    "set <output> <level>",
    "toggle <output>",
    "sleep <time>",
    "for <name> from <number> [down] to <number> {…}",
    "repeat with perturbation [<distance>] <count> times",
    "repeat <count> times {…}",
    "speed <speed> [{…}]",
    "tool <tool> [{…}]",
    "requires <condition> else throw <error>",
    "with force limit <force> in reverse {…}",
    "with speed <speed> in reverse {…}",
    "distance <distance> <direction> [in <frame>]",
    "stop if <condition>",
    "succeeds if <condition>",
    "severity <severity>",
    "recover using <sequence>",
    "recover by reversing [<depth>] [up to] <count> actions [, perturbed <distance>]",
    "otherwise using <sequence>",
    "respond after current <step>",
    "then return to <step>",
    "give up after <count> times [, <time>]",
];

/// A part of a form that is to be filled in.
struct Part {
    name: &'static str,
    /// The words that it may be; none where it is a value or a name.
    words: &'static [&'static str],
    /// Whether its number has a unit.
    has_unit: bool,
    /// What may be written for it.
    says: &'static str,
}

/// A value or a name.
const fn part(name: &'static str, says: &'static str) -> Part {
    Part { name, words: &[], has_unit: false, says }
}

/// A number with a unit.
const fn quantity(name: &'static str, says: &'static str) -> Part {
    Part { has_unit: true, ..part(name, says) }
}

/// One of a few words.
const fn word(name: &'static str, words: &'static [&'static str], says: &'static str) -> Part {
    Part { words, ..part(name, says) }
}

const PARTS: [Part; 21] = [
    part("place", "joints, a position, or a keyframe of an item: `peg.above`"),
    quantity("distance", "a length, in um, mm, cm or m; a sum in parentheses"),
    word(
        "direction",
        &["forward", "backward", "backwards", "left", "right", "up", "down", "x", "y", "z"],
        "`forward`, `backward`, `left`, `right`, `up`, `down`, `x`, `-x` and so on",
    ),
    word(
        "frame",
        &["tcp", "toolmount", "base"],
        "`tcp`, `toolmount` or `base`; the TCP's, where none is named",
    ),
    quantity("angle", "an angle, in deg or rad"),
    quantity("time", "a time, in ms, s or min"),
    part("input", "an input: its number in the workcell, or its name"),
    part("output", "an output: its number in the workcell, or its name"),
    word("level", &["low", "high"], "`low` or `high`"),
    part("name", "a name for the counter"),
    part("number", "a whole number"),
    part("count", "how many: a whole number"),
    word(
        "speed",
        &["very", "slow", "normal", "fast"],
        "`very slow`, `slow`, `normal`, `fast` or `very fast`",
    ),
    part("tool", "a tool of the workcell file"),
    part("condition", "true or false: `force > 5 N`, `distance > 50 mm`, `holding`"),
    part("error", "an error that is declared"),
    quantity("force", "a force, in N"),
    word("severity", &["warning", "recoverable", "fatal"], "`warning`, `recoverable` or `fatal`"),
    part("sequence", "a sequence without parameters"),
    word(
        "depth",
        &["escalating", "doubling", "learned"],
        "further each time (`escalating`, `escalating doubling`), or `learned`",
    ),
    word("step", &["action", "sequence"], "`action` or `sequence`"),
];

/// A command that is being written.
pub(crate) struct Command {
    /// Its form.
    pub(crate) label: String,
    /// The parts of that to be filled in: where they stand in it, in characters, and what is said
    /// of them.
    pub(crate) parts: Vec<(Range<usize>, &'static str)>,
    /// The part at hand; one more than there are, if none is.
    pub(crate) active: usize,
}

/// A word of a form, or a part to be filled in.
#[derive(Clone, Copy)]
enum Token {
    Word(&'static str),
    Part(&'static Part),
}

/// The command that a text ends in, if it ends in one.
pub(crate) fn command(before: &Before<'_>) -> Option<Command> {
    let begin = begin(before)?;
    let first = before.at(begin);
    let begins = |form: &&&str| form.split(' ').next() == Some(first);
    let forms: Vec<&'static str> = FORMS.iter().filter(begins).copied().collect();
    let second = before.at(begin + 1);
    let is_meant = |form: &&&str| form.split(' ').nth(1) == Some(second);
    let form = forms.iter().find(is_meant).or(forms.last())?;
    let active = active(before, begin + 1, form);
    let (label, parts) = label(form);
    Some(Command { label, parts, active })
}

/// The piece that the last command begins with: the last that begins a line, or that follows a
/// brace or a semicolon, but for lines that go on with a command.
fn begin(before: &Before<'_>) -> Option<usize> {
    for index in (0..before.pieces.len()).rev() {
        let text = before.at(index);
        if matches!(text, "{" | "}" | ";") {
            return None;
        }
        let follows = index.checked_sub(1).map_or("{", |previous| before.at(previous));
        let is_first = matches!(follows, "{" | "}" | ";");
        if !is_first && !before.gap_before(index).contains(['\n', '\r']) {
            continue;
        }
        let is_command = FORMS.iter().any(|form| form.split(' ').next() == Some(text));
        if is_command {
            return Some(index);
        }
        let goes_on = |piece: &Piece| {
            matches!(piece.kind, PieceKind::Free | PieceKind::Number | PieceKind::Operator)
        };
        if is_first || !goes_on(&before.pieces[index]) {
            return None;
        }
    }
    None
}

fn tokens(form: &'static str) -> Vec<Token> {
    let token = |text: &'static str| {
        let text = text.trim_matches(|c| matches!(c, '[' | ']' | ','));
        match text.strip_prefix('<').and_then(|text| text.strip_suffix('>')) {
            Some(name) => PARTS.iter().find(|part| part.name == name).map(Token::Part),
            None if text.is_empty() || text == "{…}" => None,
            None => Some(Token::Word(text)),
        }
    };
    form.split(' ').filter_map(token).collect()
}

/// Which of the parts of a form is at hand, when what follows its first word is written.
fn active(before: &Before<'_>, from: usize, form: &'static str) -> usize {
    let tokens = tokens(form);
    let next_part = |from: usize| {
        let found = tokens[from.min(tokens.len())..].iter();
        let is_part = |token: &Token| matches!(token, Token::Part(_));
        found.clone().position(is_part).map_or(tokens.len(), |more| from + more)
    };
    // The token that is next, and whether something of a value is written there.
    let (mut at, mut is_begun, mut depth) = (1, false, 0_usize);
    for index in from..before.pieces.len() {
        let text = before.at(index);
        match text {
            "(" | "[" => depth += 1,
            ")" | "]" => depth = depth.saturating_sub(1),
            _ => {}
        }
        let is_it = |token: &Token| match token {
            Token::Word(word) => *word == text,
            Token::Part(part) => part.words.contains(&text),
        };
        let rest = tokens.get(at..).unwrap_or(&[]);
        match rest.iter().position(is_it).filter(|_| depth == 0) {
            // `very` has another word behind it.
            Some(more) => (at, is_begun) = (at + more + usize::from(text != "very"), false),
            None => (at, is_begun) = (next_part(at), true),
        }
    }
    let mut part = next_part(at);
    let is_whole = |part: &Part| {
        let last = before.pieces.last().map(|piece| piece.kind);
        let is_apart = !before.rest().is_empty();
        is_apart
            && depth == 0
            && match last {
                Some(PieceKind::Number) => !part.has_unit,
                Some(PieceKind::Operator) => false,
                _ => before.ago(1) != ".",
            }
    };
    if let (true, Some(Token::Part(begun))) = (is_begun, tokens.get(part))
        && is_whole(begun)
    {
        part = next_part(part + 1);
    }
    let is_part = |token: &&Token| matches!(token, Token::Part(_));
    tokens[..part.min(tokens.len())].iter().filter(is_part).count()
}

/// A form as it is shown, and its parts.
fn label(form: &'static str) -> (String, Vec<(Range<usize>, &'static str)>) {
    let (mut label, mut parts, mut open) = (String::new(), Vec::new(), 0);
    for c in form.chars() {
        let length = label.chars().count();
        match c {
            '<' => open = length,
            '>' => {
                let name: String = label.chars().skip(open).collect();
                let says = PARTS.iter().find(|part| part.name == name).map_or("", |part| part.says);
                parts.push((open..length, says));
            }
            c => label.push(c),
        }
    }
    (label, parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use obverse_syntax::parse;

    /// What parts may be.
    const EXAMPLES: [(&str, &str); PARTS.len()] = [
        ("place", "home"),
        ("distance", "20 mm"),
        ("direction", "up"),
        ("frame", "base"),
        ("angle", "90 deg"),
        ("time", "2 s"),
        ("input", "1"),
        ("output", "1"),
        ("level", "high"),
        ("name", "index"),
        ("number", "3"),
        ("count", "3"),
        ("speed", "very slow"),
        ("tool", "probe"),
        ("condition", "force > 5 N"),
        ("error", "jam"),
        ("force", "20 N"),
        ("severity", "fatal"),
        ("sequence", "put_right"),
        ("depth", "learned"),
        ("step", "action"),
    ];

    /// A form with an example in every part.
    fn example(form: &str) -> String {
        let mut text = form.replace("{…}", "{}").replace(['[', ']'], "");
        for (name, example) in EXAMPLES {
            text = text.replace(&format!("<{name}>"), example);
        }
        text
    }

    #[test]
    fn every_form_is_one_of_the_grammar_and_has_known_parts() {
        for form in FORMS {
            assert_eq!(label(form).1.len(), form.matches('<').count(), "{form}");
            assert!(label(form).1.iter().all(|(_, says)| !says.is_empty()), "{form}");
            let text = example(form);
            let places = [
                format!("sequence main {{ {text} }}"),
                format!("io act {{ {text} }}"),
                format!("advanced move insert {{ {text} }}"),
                format!("advanced move insert {{ on failure {{ {text} }} }}"),
                format!("error jam {{ {text} }}"),
            ];
            let is_read = |text: &String| parse(text).diagnostics.is_empty();
            assert!(places.iter().any(is_read), "{text}");
        }
    }
}
