//! The words of other robot languages (RAPID, KRL, URScript and the like), and what is written here
//! in their place: the one table of them. It knows words; how they are met in a text, `habits`.

use crate::token::Token;

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
pub(crate) struct Row {
    pub(crate) words: &'static [&'static str],
    pub(crate) help: &'static str,
    pub(crate) then: Then,
}

const fn line(words: &'static [&'static str], help: &'static str) -> Row {
    Row { words, help, then: Then::NextLine }
}

const fn opens(words: &'static [&'static str], help: &'static str) -> Row {
    Row { words, help, then: Then::InBlock }
}

const fn read_as(words: &'static [&'static str], help: &'static str, token: Token) -> Row {
    Row { words, help, then: Then::As(token, None) }
}

/// How a program is ended.
pub(crate) const END: &str = "`return` ends the sequence; to stop the program `throw` an error \
                              that has `severity fatal`";

/// How a loop is left whose condition stands at its end.
pub(crate) const UNTIL: &str =
    "write `while not (CONDITION) { .. }`, or `loop { .. if CONDITION { break } }`";

const AFTER_ERROR: &str = "what follows an error is declared with it: `error NAME { recover using \
                           SEQUENCE }`";
pub(crate) const OUTPUT: &str =
    "name the output, `output gripper = 0`, and write `set gripper high` or `set gripper low`";
const INPUT: &str = "an input is read by its number or name: `input 3`";
pub(crate) const TOOL: &str =
    "tools stand in the workcell file, and one is chosen by its name: `tool gripper`";
const REMEMBER: &str = "to remember where the arm is write `position here`, then `move to here`";
const OFFSET: &str = "poses are not computed: a move goes so far from here, `move 20 mm up in \
                      base` or `move 20 mm forward in tcp`, and a place relative to something is a \
                      `keyframe` of the item";
pub(crate) const PLACE: &str = "a place in space is a `keyframe` of an item; one of the arm is \
                                declared by its joints, `joints NAME = [..] deg`";
pub(crate) const ITEM: &str =
    "a place is relative to an item, as a `keyframe` of the item: `move to ITEM.KEYFRAME`";
const STOP_MOTION: &str = "what stops a motion stands in an `advanced move`: `stop if force > 5 N`";
pub(crate) const SPEED: &str =
    "write `speed slow`, or another of very slow, slow, normal, fast, very fast";
const INTERRUPT: &str = "nothing comes between two statements: contact ends a motion by `stop if \
                         force > 5 N`, and an input is waited for, `wait until input 3 high for up \
                         to 2 s else { .. }`";
pub(crate) const FILE: &str = "what another file declares is had by `import \"poses.obv\"`";

/// What begins a statement elsewhere. Some are words of this language too, in capitals: there those
/// alone are meant, and only where no block of this language follows.
const STATEMENTS: &[Row] = &[
    line(
        &["movec", "circ", "scirc"],
        "there are no circular moves: name points of the arc and write `move to NAME linearly`",
    ),
    line(&["searchl", "searchc", "searchj"], STOP_MOTION),
    line(&["stopmove", "brake", "stopl", "stopj"], STOP_MOTION),
    line(
        &["forcemode", "endforcemode", "servoj", "servoc", "speedl", "speedj"],
        "no motion is steered while it runs: contact stops a motion, `stop if force > 5 N` in an \
         `advanced move`, and does not steer it",
    ),
    line(&["settcp", "setpayload", "$tool"], TOOL),
    line(&["$base", "setframe"], ITEM),
    line(&["$vel", "$velaxis", "$acc", "$accaxis", "$ovpro", "bas"], SPEED),
    line(&["velset", "accset", "setspeed", "setvel", "overspeed"], SPEED),
    line(&["$apo"], "each motion ends before the next begins: there is no rounding of corners"),
    line(&["invertdo"], "write `toggle gripper`"),
    line(&["setgo", "pulsedo", "pulse", "$out"], OUTPUT),
    line(
        &["setao", "$anout", "setanalogout", "setstandardanalogout", "settoolanalogout"],
        "an output is high or low: there is no analogue one",
    ),
    line(
        &["signal"],
        "a line gets its name by `output lamp = 1`, or by `input door = 3`, at the top of the file",
    ),
    line(
        &["waitdi", "waituntil", "waitdo", "waitinput"],
        "write `wait until input 3 high for up to 2 s`",
    ),
    line(&["waittime", "delay", "pause", "dwell"], "write `wait 0.5 s`, with the unit"),
    line(
        &["print", "tpwrite", "textmsg", "println", "printf", "msgnotify"],
        "nothing is printed by a program: the run itself tells what it does; `checkpoint NAME` \
         names a place",
    ),
    line(
        &["popup"],
        "declare what went wrong, `error NAME { severity fatal }`, and write `throw NAME`",
    ),
    line(&["halt", "stop", "quit", "abort"], END),
    line(
        &["exit"],
        "a loop is left by `break`; `return` ends the sequence; to stop the program `throw` an \
         error that has `severity fatal`",
    ),
    line(
        &["goto", "jmp", "lbl", "label", "jump"],
        "there are no jumps: write `loop { .. }` with `break`, or `if .. { .. }`; to go to a place \
         write `move to NAME`",
    ),
    line(&["load", "unload", "ext", "extfct"], FILE),
    line(
        &["bookerrno"],
        "an error is declared at the top of the file: `error NAME { severity recoverable }`",
    ),
    line(&["incr"], "write `n += 1`"),
    line(&["decr"], "write `n -= 1`"),
    line(
        &["retry"],
        "an error says how it goes on: `then return to action` does the same again, and an \
         advanced move says it by `on failure { repeat with perturbation 3 times }`",
    ),
    line(&["trynext"], "an error says how it goes on: `then continue` does the next action"),
    line(
        &["exitcycle", "resume"],
        "an error says how it goes on: `then return to sequence`, or `then restart program`",
    ),
    line(&["error"], AFTER_ERROR),
    line(&["default"], "what is left is written `else { .. }`"),
    line(
        &["run"],
        "a sequence is called by `call NAME`; several at once are `fork { .. } and { .. }`",
    ),
    line(&["join", "kill"], "a `fork { .. } and { .. }` ends when all of its branches have ended"),
    line(&["connect", "interrupt", "isignaldi", "isignaldo", "idelete", "itimer"], INTERRUPT),
    opens(&["trap"], INTERRUPT),
    opens(
        &["thread"],
        "what runs at the same time are the branches of `fork { .. } and { .. }`, in turns",
    ),
    opens(
        &["switch", "case", "test", "select"],
        "write `if .. { .. } else if .. { .. } else { .. }`",
    ),
    opens(&["try", "catch", "except", "finally"], AFTER_ERROR),
    opens(
        &["proc", "def", "deffct", "func", "function", "fn", "void", "procedure", "main", "task"],
        "write `sequence NAME { .. }`, or `action NAME(PARAMETER: TYPE) { .. }`; the program \
         begins with `sequence main`",
    ),
    opens(
        &["module", "namespace", "package"],
        "a file is a program: leave this out; what another file declares is had by `import \
         \"poses.obv\"`",
    ),
    Row {
        words: &["elif", "elsif", "elseif"],
        help: "write `else if`",
        then: Then::As(Token::Else, Some(Token::If)),
    },
    read_as(&["raise", "raiseerror"], "write `throw`", Token::Throw),
    read_as(
        &["parallel", "par", "concurrent", "concurrently", "simultaneously", "cobegin"],
        "write `fork`, with `and` between its branches: `fork { .. } and { .. }`",
        Token::Fork,
    ),
    read_as(&["let", "const"], "write `var`", Token::Var),
];

/// What stands elsewhere in the place of a statement that has no value here: of these the whole
/// line is written otherwise, `p2 := CRobT();` too.
const PLACES: &[(&[&str], &str)] = &[
    (
        &["crobt", "cjointt", "$posact", "$axisact", "getactualtcppose", "getactualjointpositions"],
        REMEMBER,
    ),
    (&["offs", "reltool", "posetrans", "poseadd", "posesub", "poseinv"], OFFSET),
];

/// What has a value elsewhere.
const VALUES: &[(&[&str], &str)] = &[
    (
        &[
            "getdigitalin",
            "getstandarddigitalin",
            "getconfigurabledigitalin",
            "gettooldigitalin",
            "di",
            "dinput",
            "testdi",
            "$in",
        ],
        INPUT,
    ),
    (
        &["getdigitalout", "getstandarddigitalout", "doutput", "$out"],
        "an output is not read: `toggle gripper` gives it the other level",
    ),
    (
        &["force", "gettcpforce", "getforce"],
        "the contact force is read by `force`; a motion is ended by it with `stop if force > 5 N`",
    ),
    (&["rand", "rnd"], "write `random(low, high)`"),
    (&["float", "double", "number"], "write `real(n)`"),
    (&["round", "trunc", "floor", "integer"], "write `int(x)`, which rounds towards zero"),
    (&["mod", "fmod"], "write `a mod b`"),
    (&["pow", "power"], "multiply: `a * a`"),
    (
        &["sin", "cos", "tan", "asin", "acos", "atan", "atan2"],
        "no places are computed: a move goes so far along an axis, `move 20 mm up in base`",
    ),
];

/// What is said of a word that begins a statement elsewhere, if it is one.
pub(crate) fn statement(word: &str) -> Option<&'static Row> {
    let plain = plain(word);
    STATEMENTS.iter().find(|row| row.words.contains(&plain.as_str()))
}

/// What is said of a word that stands for a place elsewhere, if it is one.
pub(crate) fn place(word: &str) -> Option<&'static str> {
    help(PLACES, word).or((word == "p").then_some(PLACE))
}

/// What is said of a word that has a value elsewhere, if it is one: of `Offs`, `DI3`, `$IN`.
#[must_use]
pub fn value_elsewhere(word: &str) -> Option<&'static str> {
    let numbered = word.trim_end_matches(|c: char| c.is_ascii_digit());
    help(PLACES, word).or_else(|| help(VALUES, word)).or_else(|| help(VALUES, numbered))
}

fn help(rows: &[(&[&str], &'static str)], word: &str) -> Option<&'static str> {
    let plain = plain(word);
    rows.iter().find(|(words, _)| words.contains(&plain.as_str())).map(|(_, help)| *help)
}

/// A word in small letters and without `_`: RAPID and KRL make no difference.
pub(crate) fn plain(word: &str) -> String {
    word.chars().filter(|c| *c != '_').map(|c| c.to_ascii_lowercase()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_written_plainly_and_once_a_table() {
        let statements: Vec<&str> = STATEMENTS.iter().flat_map(|row| row.words).copied().collect();
        let values = PLACES.iter().chain(VALUES).flat_map(|(words, _)| *words).copied();
        for words in [statements, values.collect()] {
            for (index, word) in words.iter().enumerate() {
                assert_eq!(*word, plain(word), "in small letters and without `_`");
                assert!(!words[..index].contains(word), "{word} twice");
            }
        }
    }

    #[test]
    fn words_are_found_in_any_letters_and_with_a_number() {
        assert_eq!(value_elsewhere("DI3"), Some(INPUT));
        assert_eq!(value_elsewhere("get_standard_digital_in"), Some(INPUT));
        assert_eq!(value_elsewhere("atan2"), value_elsewhere("atan"));
        assert_eq!(value_elsewhere("part"), None);
        assert_eq!(place("CRobT"), Some(REMEMBER));
        assert!(statement("ExitCycle").is_some() && statement("gripper").is_none());
    }
}
