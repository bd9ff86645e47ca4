//! Words that begin a statement in other robot languages (RAPID, KRL, URScript and the like), and
//! what is written here instead. It knows words and the rest of their line; no grammar.

use crate::token::{FREE_WORDS, RESERVED_WORDS, Token};
use logos::Logos;

/// What is made of a word that begins a statement in another language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Habit {
    /// What to do, in a sentence.
    pub(crate) help: String,
    /// What to write in place of the word or line, if that is plain.
    pub(crate) instead: Option<String>,
    /// How reading goes on.
    pub(crate) then: Then,
}

/// How reading goes on after a word of another language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Then {
    /// With the next line.
    NextLine,
    /// With the next line, and a word that ends a block is to come.
    InBlock,
    /// As if this token had been read, and the other behind it.
    As(Token, Option<Token>),
}

/// Words of a kind, in small letters and without `_`, and what is said of them.
struct Row {
    words: &'static [&'static str],
    help: &'static str,
    then: Then,
}

const fn line(words: &'static [&'static str], help: &'static str) -> Row {
    Row { words, help, then: Then::NextLine }
}

const fn opens(words: &'static [&'static str], help: &'static str) -> Row {
    Row { words, help, then: Then::InBlock }
}

const JOINT_MOVES: &[&str] = &["movej", "ptp", "sptp", "moveabsj", "moveto", "movejoint", "ptprel"];
const LINEAR_MOVES: &[&str] = &["movel", "lin", "slin", "movelin", "linrel", "movep"];
const POSES: [&str; 7] = ["robtarget", "jointtarget", "e6pos", "e6axis", "frame", "pos", "pose"];
const ENDS: &[&str] = &[
    "end",
    "endif",
    "endfor",
    "endwhile",
    "endloop",
    "endproc",
    "endfunc",
    "endfct",
    "endmodule",
    "endswitch",
    "endtest",
    "endtrap",
    "done",
    "fi",
];

const ROWS: &[Row] = &[
    line(
        &["movec", "circ", "scirc"],
        "there are no circular moves: name points of the arc and write `move to NAME linearly`",
    ),
    line(
        &[
            "setdo",
            "setdigitalout",
            "setstandarddigitalout",
            "settooldigitalout",
            "setgo",
            "reset",
            "pulsedo",
        ],
        "name the output, `output gripper = 0`, and write `set gripper high` or `set gripper low`",
    ),
    line(
        &["waitdi", "waituntil", "waitdo", "waitinput"],
        "write `wait until input 3 high for up to 2 s`",
    ),
    line(&["waittime", "delay", "pause", "dwell"], "write `wait 0.5 s`, with the unit"),
    line(
        &["print", "tpwrite", "textmsg", "popup", "println", "printf", "msgnotify"],
        "nothing is printed by a program: the run itself tells what it does; `checkpoint NAME` \
         names a place",
    ),
    line(
        &["halt", "exit", "quit", "abort", "stopmove"],
        "`return` ends the sequence; to stop the program `throw` an error whose severity is fatal",
    ),
    line(
        &["goto", "jmp", "lbl", "label", "jump"],
        "there are no jumps: write `loop { .. }` with `break`, or `if .. { .. }`; to go to a place \
         write `move to NAME`",
    ),
    line(
        &["velset", "accset", "setspeed", "setvel", "overspeed"],
        "write `speed slow`, or another of very slow, slow, normal, fast, very fast",
    ),
    opens(
        &["switch", "case", "test", "select"],
        "write `if .. { .. } else if .. { .. } else { .. }`",
    ),
    opens(
        &["try", "catch", "except", "finally", "trap"],
        "what follows an error is declared with it: `error NAME { recover .. }`",
    ),
    opens(
        &[
            "proc",
            "def",
            "deffct",
            "func",
            "function",
            "fn",
            "void",
            "thread",
            "procedure",
            "main",
            "task",
        ],
        "write `sequence NAME { .. }`, or `action NAME(PARAMETER: TYPE) { .. }`",
    ),
    opens(&["module", "namespace", "package"], "a file is a program: leave this out"),
    Row {
        words: &["elif", "elsif", "elseif"],
        help: "write `else if`",
        then: Then::As(Token::Else, Some(Token::If)),
    },
    Row {
        words: &["raise", "raiseerror"],
        help: "write `throw`",
        then: Then::As(Token::Throw, None),
    },
    Row { words: &["let", "const"], help: "write `var`", then: Then::As(Token::Var, None) },
];

/// What is made of a word that ends a block, where none of another language is open.
pub(crate) fn end_of_block() -> Habit {
    said("a block ends with `}`".to_owned(), Then::NextLine)
}

/// Whether a word ends a block in another language.
pub(crate) fn ends_block(word: &str) -> bool {
    ENDS.contains(&plain(word).as_str())
}

/// What is made of a word that begins a statement and is none of the language; `rest` is what
/// follows it on its line.
pub(crate) fn of(word: &str, rest: &str) -> Option<Habit> {
    let plain = plain(word);
    let next = first_word(rest);
    if let Some(habit) = declaration(&plain, word, next, rest) {
        return Some(habit);
    }
    if JOINT_MOVES.contains(&plain.as_str()) {
        return Some(motion(rest, ""));
    }
    if LINEAR_MOVES.contains(&plain.as_str()) {
        return Some(motion(rest, " linearly"));
    }
    if plain == "wait" && word != "wait" && matches!(next, "SEC" | "FOR") {
        let instead = if next == "SEC" { "0.5 s" } else { "until input 3 high for up to 2 s" };
        return Some(said(format!("write `wait {instead}`"), Then::NextLine));
    }
    let row = ROWS.iter().find(|row| row.words.contains(&plain.as_str()));
    if let Some(row) = row {
        let instead = match row.then {
            Then::As(..) => row.help.split('`').nth(1).map(str::to_owned),
            _ => None,
        };
        return Some(Habit { help: row.help.to_owned(), instead, then: row.then });
    }
    capital(word, rest)
}

/// `VAR num n := 3;`, `int n = 3`, `CONST robtarget p10 := ..`
fn declaration(plain: &str, word: &str, next: &str, rest: &str) -> Option<Habit> {
    const TYPES: [&str; 10] =
        ["int", "num", "dnum", "float", "double", "bool", "boolean", "string", "real", "integer"];
    let qualifies = matches!(plain, "const" | "pers" | "decl" | "local" | "global" | "signal")
        || plain == "var" && word != "var";
    let name = if qualifies { first_word(rest.trim_start().get(next.len()..)?) } else { next };
    if name.is_empty() || !qualifies && !TYPES.contains(&plain) && !POSES.contains(&plain) {
        return None;
    }
    let of_type = if qualifies { next } else { word };
    Some(match POSES.contains(&of_type.to_lowercase().as_str()) {
        true => said(
            format!("a position is declared by its joints: `joints {name} = [..] deg`"),
            Then::NextLine,
        ),
        false => {
            said(format!("write `var {name} = ..`; the type is that of its value"), Then::NextLine)
        }
    })
}

/// `MoveJ p10, v100, z10, tool0;`, `movej(p10)`
fn motion(rest: &str, how: &str) -> Habit {
    let name = first_word(rest.trim_start_matches([' ', '\t', '(']));
    let goes_on = rest.trim_start_matches([' ', '\t', '(']).get(name.len()..).unwrap_or("");
    if name.is_empty() || goes_on.starts_with(['[', '{', '.']) {
        let help = format!(
            "declare the position, `joints NAME = [..] deg`, and write `move to NAME{how}`"
        );
        return said(help, Then::NextLine);
    }
    if goes_on.starts_with('(') {
        let help = format!(
            "an offset is a move of its own: `move to NAME{how}`, and before or after it `move 50 \
             mm up in base`"
        );
        return said(help, Then::NextLine);
    }
    let instead = format!("move to {name}{how}");
    let help = format!("write `{instead}`; speed and tool are settings: `speed slow`, `tool NAME`");
    Habit { help, instead: Some(instead), then: Then::NextLine }
}

/// A word of the language in capitals: of the block of another language, or just so.
fn capital(word: &str, rest: &str) -> Option<Habit> {
    let small = word.to_lowercase();
    let is_word = |words: &[&str]| words.contains(&small.as_str());
    if small == word || !is_word(RESERVED_WORDS) && !is_word(FREE_WORDS) {
        return None;
    }
    let is_block = ["if", "for", "while", "loop", "repeat"].contains(&small.as_str());
    if is_block && !rest.contains('{') {
        let written = match small.as_str() {
            "for" => "for i from 1 to 10 { .. }",
            "repeat" => "repeat 3 times { .. }",
            "loop" => "loop { .. }",
            "if" => "if CONDITION { .. }",
            _ => "while CONDITION { .. }",
        };
        return Some(said(format!("write `{written}`"), Then::InBlock));
    }
    let help = format!("the words of the language are written in small letters: `{small}`");
    let token = Token::lexer(&small).next()?.ok()?;
    Some(Habit { help, instead: Some(small), then: Then::As(token, None) })
}

fn said(help: String, then: Then) -> Habit {
    Habit { help, instead: None, then }
}

fn plain(word: &str) -> String {
    word.chars().filter(|c| *c != '_').map(|c| c.to_ascii_lowercase()).collect()
}

/// The word that a text begins with, after blanks.
fn first_word(text: &str) -> &str {
    let text = text.trim_start_matches([' ', '\t']);
    let end = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(text.len());
    &text[..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn help(word: &str, rest: &str) -> Option<String> {
        of(word, rest).map(|habit| habit.help)
    }

    #[test]
    fn rows_are_found_by_their_words_alone() {
        for row in ROWS {
            for word in row.words {
                assert_eq!(*word, plain(word), "in small letters and without `_`");
                assert!(!RESERVED_WORDS.contains(word) && !FREE_WORDS.contains(word), "{word}");
            }
        }
        assert_eq!(help("gripper", " open"), None);
        assert_eq!(help("part", ""), None);
    }

    #[test]
    fn a_motion_is_written_out() {
        let instead = |word, rest| of(word, rest).and_then(|habit| habit.instead);
        assert_eq!(instead("MoveJ", " p10, v100").as_deref(), Some("move to p10"));
        assert_eq!(instead("movel", "(p10)").as_deref(), Some("move to p10 linearly"));
        assert_eq!(instead("movel", "(p[0.1, 0.2])"), None);
        assert_eq!(instead("PTP", " {X 10}"), None);
        assert_eq!(instead("MoveL", " Offs(p10, 0, 0, 50)"), None);
        assert_eq!(instead("GOTO", " again"), None, "a jump goes to no place of the arm");
    }

    #[test]
    fn a_declaration_names_what_it_declares() {
        assert!(help("VAR", " num n := 3;").is_some_and(|help| help.contains("`var n = ..`")));
        assert!(help("int", " n = 3").is_some_and(|help| help.contains("`var n = ..`")));
        let pose = help("CONST", " robtarget p10 := [1];");
        assert!(pose.is_some_and(|help| help.contains("`joints p10 = [..] deg`")));
    }

    #[test]
    fn capitals_are_small_letters_or_blocks() {
        assert_eq!(of("Wait", " 1 s").map(|habit| habit.then), Some(Then::As(Token::Wait, None)));
        assert_eq!(of("IF", " holding THEN").map(|habit| habit.then), Some(Then::InBlock));
        let braces = of("IF", " holding {").map(|habit| habit.then);
        assert_eq!(braces, Some(Then::As(Token::If, None)));
    }
}
