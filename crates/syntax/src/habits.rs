//! What is meant by a line of another robot language, and what is written here instead. It knows
//! the word that the line begins with and the rest of it; no grammar. The words are in `elsewhere`.

use crate::elsewhere::{self, Then, UNTIL, plain, value_elsewhere};
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

const JOINT_MOVES: &[&str] = &["movej", "ptp", "sptp", "moveabsj", "moveto", "movejoint", "ptprel"];
const LINEAR_MOVES: &[&str] = &["movel", "lin", "slin", "movelin", "linrel", "movep"];
const OUTPUTS: &[&str] = &[
    "setdo",
    "setdigitalout",
    "setstandarddigitalout",
    "setconfigurabledigitalout",
    "settooldigitalout",
    "reset",
];
const QUALIFIERS: [&str; 7] = ["const", "pers", "decl", "local", "global", "static", "var"];
const TYPES: [&str; 10] =
    ["int", "num", "dnum", "float", "double", "bool", "boolean", "string", "real", "integer"];
const JOINTS: [&str; 3] = ["jointtarget", "e6axis", "axis"];
const POSES: [&str; 5] = ["robtarget", "e6pos", "frame", "pos", "pose"];
const OTHER_TYPES: [&str; 4] = ["errnum", "tooldata", "wobjdata", "speeddata"];
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

/// What is made of a word that ends a block, where none of another language is open.
pub(crate) fn end_of_block(word: &str) -> Habit {
    let help = if is_until(word) { UNTIL } else { "a block ends with `}`" };
    said(help.to_owned(), Then::NextLine)
}

/// Whether a word ends a block in another language.
pub(crate) fn ends_block(word: &str) -> bool {
    ENDS.contains(&plain(word).as_str()) || is_until(word)
}

fn is_until(word: &str) -> bool {
    word.eq_ignore_ascii_case("until")
}

/// What is made of a word that begins a statement and is none of the language; `rest` is what
/// follows it on its line.
pub(crate) fn of(word: &str, rest: &str) -> Option<Habit> {
    let plain = plain(word);
    if let Some(habit) = declaration(word, rest) {
        return Some(habit);
    }
    if let Some(instead) = offset(rest.trim_start()).filter(|_| plain.ends_with("rel")) {
        let help = format!("write `{instead}`");
        return Some(Habit { help, instead: Some(instead), then: Then::NextLine });
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
    if let Some(habit) = numbered(&plain, rest).or_else(|| wait(word, rest)) {
        return Some(habit);
    }
    // In capitals: `Error lost {` is of this language.
    let is_own = is_word_of_language(&plain) && rest.contains('{');
    if let Some(row) = elsewhere::statement(word).filter(|_| !is_own) {
        let name = first_word(rest);
        let instead = match (row.then, plain.as_str()) {
            (Then::As(..), _) => row.help.split('`').nth(1).map(str::to_owned),
            (_, "invertdo") if !name.is_empty() => Some(format!("toggle {name}")),
            (_, "incr") if !name.is_empty() => Some(format!("{name} += 1")),
            (_, "decr") if !name.is_empty() => Some(format!("{name} -= 1")),
            _ => None,
        };
        let help = match (&instead, row.then) {
            (Some(instead), Then::NextLine) => format!("write `{instead}`"),
            _ => row.help.to_owned(),
        };
        return Some(Habit { help, instead, then: row.then });
    }
    if word.starts_with('$') {
        let help = "variables with `$` are the controller's: write `set 1 high` for an output, and \
                    `input 1` for an input";
        return Some(said(help.to_owned(), Then::NextLine));
    }
    capital(word, rest)
}

/// What is made of what is assigned, if it is a place of another language, and which word tells:
/// the `CRobT` of `p2 := CRobT();`. `rest` is what follows the name.
pub(crate) fn of_assigned(rest: &str) -> Option<(&str, Habit)> {
    let value = rest.trim_start_matches([' ', '\t', ':']).strip_prefix('=')?;
    let word = first_word(value);
    let (_, behind) = value.split_once(word)?;
    let is_place = match word {
        "p" => behind.starts_with('['),
        _ => word.starts_with('$') || behind.trim_start_matches(' ').starts_with('('),
    };
    let help = if is_place { elsewhere::place(word)? } else { return None };
    Some((word, said(help.to_owned(), Then::NextLine)))
}

/// What is made of a word of the language that begins a statement as in another one, and which word
/// tells: `while True:`, `if get_digital_in(3):`, `wait sec 0.5`.
pub(crate) fn of_own<'r>(word: &str, rest: &'r str) -> Option<(&'r str, Habit)> {
    let of_controller = words(rest).find(|word| word.starts_with('$'));
    if let Some(habit) = wait(word, rest)
        && (habit.instead.is_some() || of_controller.is_some())
    {
        return Some((of_controller.unwrap_or(first_word(rest)), habit));
    }
    if !matches!(word, "if" | "while") || rest.contains('{') {
        return None;
    }
    let condition = first_word(rest);
    let ends_as = |end: &str| rest.trim_end().ends_with(end);
    let is_open = ends_as(":") || ends_as(" do") || ends_as(" DO");
    if word == "while" && is_open && matches!(condition, "True" | "TRUE") {
        return Some((condition, said("write `loop { .. }`".to_owned(), Then::InBlock)));
    }
    let (told, value) = value_in(rest, true)?;
    let help = format!("write `{word} CONDITION {{ .. }}`; {value}");
    Some((told, said(help, Then::InBlock)))
}

/// `VAR num n := 3;`, `int n = 3`, `CONST robtarget p10 := ..`, `GLOBAL DEF pick()`
fn declaration(word: &str, rest: &str) -> Option<Habit> {
    let is_qualifier = |word: &str| QUALIFIERS.contains(&word.to_lowercase().as_str());
    let qualifies = is_qualifier(word);
    let (mut of_type, mut rest) = (word, rest);
    while is_qualifier(of_type) {
        of_type = first_word(rest);
        rest = rest.trim_start_matches([' ', '\t']).get(of_type.len()..)?;
    }
    let known = of_type.to_lowercase();
    let is_type = |types: &[&str]| types.contains(&known.as_str());
    let is_known = is_type(&TYPES) || is_type(&JOINTS) || is_type(&POSES) || is_type(&OTHER_TYPES);
    let name = first_word(rest);
    if name.is_empty() || !qualifies && !is_known {
        return None;
    }
    let of_sequence = || elsewhere::statement(of_type).filter(|row| row.then == Then::InBlock);
    if let Some(row) = of_sequence().filter(|_| !is_known) {
        return Some(said(row.help.to_owned(), Then::InBlock));
    }
    let help = match known.as_str() {
        _ if is_type(&JOINTS) => {
            format!("a position is declared by its joints: `joints {name} = [..] deg`")
        }
        _ if is_type(&POSES) => elsewhere::PLACE.replace("NAME", name),
        "errnum" => {
            format!("an error is declared at the top: `error {name} {{ severity recoverable }}`")
        }
        "tooldata" => elsewhere::TOOL.to_owned(),
        "wobjdata" => elsewhere::ITEM.to_owned(),
        "speeddata" => elsewhere::SPEED.to_owned(),
        _ => format!("write `var {name} = ..`; the type is that of its value"),
    };
    let is_global = word.eq_ignore_ascii_case("global");
    let help = if is_global { format!("{help}; {}", elsewhere::FILE) } else { help };
    Some(said(help, Then::NextLine))
}

/// `MoveJ p10, v100, z10, tool0;`, `movej(p10)`
fn motion(rest: &str, how: &str) -> Habit {
    let target = rest.trim_start_matches([' ', '\t', '(']);
    let name = first_word(target);
    let goes_on = target.get(name.len()..).unwrap_or("");
    if let Some(help) = elsewhere::place(name).filter(|_| goes_on.starts_with('(')) {
        return said(help.to_owned(), Then::NextLine);
    }
    if name.is_empty() || goes_on.starts_with(['[', '{', '.', '(']) {
        let help = format!(
            "declare the position, `joints NAME = [..] deg`, and write `move to NAME{how}`"
        );
        return said(help, Then::NextLine);
    }
    let instead = format!("move to {name}{how}");
    let mut help =
        format!("write `{instead}`; speed and tool are settings: `speed slow`, `tool NAME`");
    if words(goes_on).any(is_blend) {
        help += "; each motion ends before the next begins";
    }
    Habit { help, instead: Some(instead), then: Then::NextLine }
}

/// Whether a word behind a motion says how it goes over into the next: `z10`, `C_DIS`, `r` of
/// `r=0.05`.
fn is_blend(word: &str) -> bool {
    let zone = word.strip_prefix(['z', 'Z']);
    let is_zone = |size: &str| !size.is_empty() && size.bytes().all(|byte| byte.is_ascii_digit());
    word == "r" || zone.is_some_and(is_zone) || plain(word).starts_with("cdis") || word == "C_PTP"
}

/// The move of `LIN_REL {Z -20}`: one axis, in millimetres.
fn offset(target: &str) -> Option<String> {
    let inner = target.strip_prefix('{')?.split('}').next()?.trim();
    let axis = inner.chars().next().filter(|axis| matches!(axis, 'X' | 'Y' | 'Z'))?;
    let number: f64 = inner.get(1..)?.trim().parse().ok().filter(|n: &f64| n.is_finite())?;
    let sign = if number < 0.0 { "-" } else { "" };
    Some(format!("move {} mm {sign}{} in base", number.abs(), axis.to_ascii_lowercase()))
}

/// `WAIT SEC 0.5`, `WAIT FOR $IN[3]`
fn wait(word: &str, rest: &str) -> Option<Habit> {
    if !word.eq_ignore_ascii_case("wait") {
        return None;
    }
    let (next, behind) = rest.trim_start().split_once([' ', '\t', '['])?;
    let instead = match next.to_uppercase().as_str() {
        "SEC" => {
            let time = behind.trim_matches([' ', '\t', ';']);
            let is_number = time.parse().is_ok_and(|time: f64| time.is_finite());
            let instead = format!("wait {} s", if is_number { time } else { "0.5" });
            let help = format!("write `{instead}`");
            let instead = is_number.then_some(instead);
            return Some(Habit { help, instead, then: Then::NextLine });
        }
        "FOR" | "DI" | "RI" => "wait until input 3 high for up to 2 s",
        _ => return None,
    };
    Some(said(format!("write `{instead}`"), Then::NextLine))
}

/// `SetDO grip, 1;`, `set_digital_out(0, True)`, `Set grip;`, `Reset grip;`
fn output(plain: &str, rest: &str) -> Habit {
    let mut words = words(rest).filter(|word| *word != "SDelay");
    let name = words.next();
    let level = match plain {
        "set" => Some("high"),
        "reset" => Some("low"),
        _ => words.next().and_then(level),
    };
    match (name, level) {
        (Some(name), Some(level)) => {
            let instead = commanded(name, level);
            let help =
                format!("write `{instead}`; an output gets its name by `output gripper = 0`");
            Habit { help, instead: Some(instead), then: Then::NextLine }
        }
        _ => said(elsewhere::OUTPUT.to_owned(), Then::NextLine),
    }
}

/// The statement that gives an output a level, as [`level`] calls it.
fn commanded(output: &str, level: &str) -> String {
    match level {
        "toggle" => format!("toggle {output}"),
        _ => format!("set {output} {level}"),
    }
}

/// Whether what follows `Set` is one name and no level, as in RAPID.
fn is_of_rapid(rest: &str) -> bool {
    let name = first_word(rest);
    let goes_on = rest.trim_start().get(name.len()..).unwrap_or("").trim();
    !name.is_empty() && matches!(goes_on, "" | ";")
}

/// What is to be done with an output that is given this elsewhere.
fn level(word: &str) -> Option<&'static str> {
    match word.to_lowercase().as_str() {
        "1" | "true" | "on" | "high" => Some("high"),
        "0" | "false" | "off" | "low" => Some("low"),
        "not" => Some("toggle"),
        _ => None,
    }
}

/// `DO[1]=ON`, `$OUT[1] = TRUE`, `R[2]=R[2]+1`, `J P[1] 100% FINE`: signals, registers and
/// positions by number.
fn numbered(plain: &str, rest: &str) -> Option<Habit> {
    let number = rest.strip_prefix('[').and_then(|rest| rest.split_once(']'));
    let help = match (plain, number) {
        ("do" | "ro" | "$out", Some((number, rest))) => {
            let number = first_word(number);
            let value = rest.trim_start_matches([' ', '\t']).strip_prefix('=');
            if let Some(level) = value.map(first_word).and_then(level) {
                let instead = commanded(number, level);
                let help = format!("write `{instead}`");
                return Some(Habit { help, instead: Some(instead), then: Then::NextLine });
            }
            format!("write `set {number} high` or `set {number} low`")
        }
        ("di" | "ri" | "$in", Some((number, _))) => {
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
    if small == word || !is_word_of_language(&small) {
        return None;
    }
    let is_block = ["if", "for", "while", "loop", "repeat"].contains(&small.as_str());
    if is_block && !rest.contains('{') {
        let is_for_ever = first_word(rest).eq_ignore_ascii_case("true");
        let written = match small.as_str() {
            "for" => "write `for i from 1 to 9 { .. }`",
            "repeat" => UNTIL,
            "loop" => "write `loop { .. }`",
            "if" => "write `if CONDITION { .. }`",
            _ if is_for_ever => "write `loop { .. }`",
            _ => "write `while CONDITION { .. }`",
        };
        let value = value_in(rest, false).map_or(String::new(), |(_, value)| format!("; {value}"));
        return Some(said(format!("{written}{value}"), Then::InBlock));
    }
    let help = format!("the words of the language are written in small letters: `{small}`");
    let token = Token::lexer(&small).next()?.ok()?;
    Some(Habit { help, instead: Some(small), then: Then::As(token, None) })
}

fn is_word_of_language(small: &str) -> bool {
    RESERVED_WORDS.contains(&small) || FREE_WORDS.contains(&small)
}

/// The first word of a text that has a value elsewhere, and what is said of it. Where variables may
/// have such a name, it is meant where it is called: nothing of that name can be here.
fn value_in(text: &str, is_called: bool) -> Option<(&str, &'static str)> {
    let mut behind = text;
    words(text).find_map(|word| {
        behind = behind.split_once(word)?.1;
        let help = value_elsewhere(word)?;
        let is_empty_call = behind.starts_with("()");
        let is_meant = match is_word_of_language(word) {
            true => is_empty_call,
            false => !is_called || word.starts_with('$') || behind.starts_with('('),
        };
        is_meant.then_some((word, help))
    })
}

fn said(help: String, then: Then) -> Habit {
    Habit { help, instead: None, then }
}

/// The word that a text begins with, after blanks.
fn first_word(text: &str) -> &str {
    let text = text.trim_start_matches([' ', '\t']);
    let is_word = |(index, c): &(usize, char)| is_word_part(*c) || *index == 0 && *c == '$';
    let end = text.char_indices().find(|one| !is_word(one)).map_or(text.len(), |(end, _)| end);
    &text[..end]
}

/// The words and numbers of a text.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !is_word_part(c) && c != '$').filter(|word| !word.is_empty())
}

fn is_word_part(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

#[cfg(test)]
mod tests {
    use super::*;

    fn help(word: &str, rest: &str) -> Option<String> {
        of(word, rest).map(|habit| habit.help)
    }

    #[test]
    fn names_are_no_words_of_other_languages() {
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
    fn what_has_a_number_is_written_out() {
        let instead = |word, rest| of(word, rest).and_then(|habit| habit.instead);
        assert_eq!(instead("LIN_REL", " {Z -20}").as_deref(), Some("move 20 mm -z in base"));
        assert_eq!(instead("LIN_REL", " {X 1.5}").as_deref(), Some("move 1.5 mm x in base"));
        assert_eq!(instead("LIN_REL", " {X 1, Y 2}"), None);
        assert_eq!(instead("WAIT", " SEC 0.25").as_deref(), Some("wait 0.25 s"));
        assert_eq!(instead("WAIT", " SEC pause_s"), None);
        assert_eq!(instead("$OUT", "[4] = NOT $OUT[4]").as_deref(), Some("toggle 4"));
        assert_eq!(instead("Incr", " n;").as_deref(), Some("n += 1"));
    }

    #[test]
    fn a_block_of_another_language_is_told_by_its_condition() {
        let told = |word, rest| of_own(word, rest).map(|(told, _)| told);
        assert_eq!(told("while", " True:"), Some("True"));
        assert_eq!(told("while", " True"), None, "a variable");
        assert_eq!(told("if", " power > 3 and di"), None, "variables");
        assert_eq!(told("if", " a mod (b) > 3"), None, "an operator");
        assert_eq!(told("if", " force() > 5:"), Some("force"));
        assert_eq!(told("if", " not get_digital_in(3):"), Some("get_digital_in"));
        assert_eq!(told("if", " get_digital_in(3) {"), None);
        assert_eq!(told("if", " force > 3 N"), None);
        assert_eq!(told("wait", " sec 0.5"), Some("sec"));
        assert_eq!(told("wait", " for $in[3]"), Some("$in"));
        assert_eq!(told("wait", " sec"), None, "a variable");
    }

    #[test]
    fn a_place_that_is_assigned_is_told_by_its_value() {
        let told = |rest| of_assigned(rest).map(|(told, _)| told);
        assert_eq!(told(" := CRobT();"), Some("CRobT"));
        assert_eq!(told(" = $POS_ACT"), Some("$POS_ACT"));
        assert_eq!(told(" = p[0.1, 0.2, 0.3, 0, 0, 0]"), Some("p"));
        assert_eq!(told(" = p + 1"), None);
        assert_eq!(told(" = offs"), None, "a name");
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
