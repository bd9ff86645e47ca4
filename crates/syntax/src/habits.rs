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
const OUTPUTS: &[&str] =
    &["setdo", "setdigitalout", "setstandarddigitalout", "settooldigitalout", "reset"];
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
        &["setgo", "pulsedo"],
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
    Row {
        words: &["parallel", "par", "concurrent", "concurrently", "simultaneously", "cobegin"],
        help: "write `fork`, with `and` between its branches: `fork { .. } and { .. }`",
        then: Then::As(Token::Fork, None),
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
    if OUTPUTS.contains(&plain.as_str()) || plain == "set" && is_of_rapid(rest) {
        return Some(output(&plain, rest));
    }
    if let Some(habit) = numbered(&plain, rest) {
        return Some(habit);
    }
    if plain == "wait" && word != "wait" && matches!(next, "SEC" | "FOR" | "DI" | "RI") {
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

/// `SetDO grip, 1;`, `set_digital_out(0, True)`, `Set grip;`, `Reset grip;`
fn output(plain: &str, rest: &str) -> Habit {
    let mut words = rest
        .split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty() && *word != "SDelay");
    let name = words.next();
    let level = match plain {
        "set" => Some("high"),
        "reset" => Some("low"),
        _ => words.next().and_then(level),
    };
    let (Some(name), Some(level)) = (name, level) else {
        let help = "name the output, `output gripper = 0`, and write `set gripper high` or `set \
                    gripper low`";
        return said(help.to_owned(), Then::NextLine);
    };
    let instead = format!("set {name} {level}");
    let help = format!("write `{instead}`; an output gets its name by `output gripper = 0`");
    Habit { help, instead: Some(instead), then: Then::NextLine }
}

/// Whether what follows `Set` is one name and no level, as in RAPID.
fn is_of_rapid(rest: &str) -> bool {
    let name = first_word(rest);
    let goes_on = rest.trim_start().get(name.len()..).unwrap_or("").trim();
    !name.is_empty() && matches!(goes_on, "" | ";")
}

/// What a level is called elsewhere.
fn level(word: &str) -> Option<&'static str> {
    match word.to_lowercase().as_str() {
        "1" | "true" | "on" | "high" => Some("high"),
        "0" | "false" | "off" | "low" => Some("low"),
        _ => None,
    }
}

/// `DO[1]=ON`, `R[2]=R[2]+1`, `J P[1] 100% FINE`: signals, registers and positions by number.
fn numbered(plain: &str, rest: &str) -> Option<Habit> {
    let number = rest.strip_prefix('[').and_then(|rest| rest.split_once(']'));
    let help = match (plain, number) {
        ("do" | "ro", Some((number, rest))) => {
            let number = first_word(number);
            let value = rest.trim_start_matches([' ', '\t']).strip_prefix('=');
            if let Some(level) = value.map(first_word).and_then(level) {
                let instead = format!("set {number} {level}");
                let help = format!("write `{instead}`");
                return Some(Habit { help, instead: Some(instead), then: Then::NextLine });
            }
            format!("write `set {number} high` or `set {number} low`")
        }
        ("di" | "ri", Some((number, _))) => {
            let number = first_word(number);
            format!("an input is read by `input {number}`, as in `if input {number} {{ .. }}`")
        }
        ("r", Some(_)) => {
            "declare a variable: `var count = 0`, then `count = count + 1`".to_owned()
        }
        ("j" | "l" | "c", None) if rest.trim_start().starts_with("P[") => {
            let how = if plain == "j" { "" } else { " linearly" };
            format!("declare the position, `joints NAME = [..] deg`, and write `move to NAME{how}`")
        }
        _ => return None,
    };
    Some(said(help, Then::NextLine))
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
    fn an_output_is_written_out() {
        let instead = |word, rest| of(word, rest).and_then(|habit| habit.instead);
        assert_eq!(instead("SetDO", " grip, 1;").as_deref(), Some("set grip high"));
        assert_eq!(instead("set_digital_out", "(0, False)").as_deref(), Some("set 0 low"));
        assert_eq!(instead("Set", " grip;").as_deref(), Some("set grip high"));
        assert_eq!(instead("Reset", " grip;").as_deref(), Some("set grip low"));
        assert_eq!(instead("SetDO", ""), None);
        assert_eq!(instead("Set", " grip high").as_deref(), Some("set"), "it is of this language");
        assert_eq!(instead("DO", "[1]=ON").as_deref(), Some("set 1 high"));
        assert_eq!(instead("RO", "[2] = OFF ;").as_deref(), Some("set 2 low"));
        assert!(help("DO", "[1]=R[3]").is_some_and(|help| help.contains("`set 1 high`")));
        assert!(help("DI", "[4]=ON").is_some_and(|help| help.contains("`input 4`")));
        assert!(help("L", " P[1] 100mm/sec FINE").is_some_and(|help| help.contains("linearly")));
        assert!(help("R", "[1]=R[1]+1").is_some_and(|help| help.contains("var count")));
        assert_eq!(help("r", " = 3"), None);
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
