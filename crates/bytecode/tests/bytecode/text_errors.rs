//! What the assembler says of texts that are wrong: where, what, and what to do.

use obverse_bytecode::text::MAX_ERRORS;
use obverse_bytecode::{ModuleCode, assemble, verify};

/// Above every text that is not about its beginning.
const HEAD: &str = "\
obvasm 1
.joints home 0 0 0 0 0 0
.joints twice 0 0 0 0 0 0
.joints twice 0 0 0 0 0 0
.reason \"wet\"
.function main start
.local count int
.local \"two words\" int
";

/// The errors of a line below [`HEAD`], each with its column.
#[track_caller]
fn errors(line: &str) -> Vec<String> {
    let text = format!("{HEAD}{line}\n");
    let errors = assemble(&text).expect_err(line);
    let first = HEAD.lines().count() + 1;
    assert!(errors.iter().all(|error| error.line >= first), "{errors:?}");
    errors.iter().map(|error| format!("{}: {}", error.column, error.message)).collect()
}

#[track_caller]
fn says(line: &str, expected: &str) {
    assert_eq!(errors(line), [expected], "{line}");
}

#[test]
fn instructions() {
    says("pus.int 3", "1: there is no instruction `pus.int`; the nearest is `push.int`");
    says("  frobnicate", "3: there is no instruction `frobnicate`");
    says("push.int", "9: the operand `value` is missing: `push.int value`");
    says("push.int 3 4", "12: the line should end before `4`");
    says(
        "add.local.imm count 4",
        "21: a comma is missing before `4`: `add.local.imm local, value`",
    );
    says(
        "add.local.imm count,",
        "21: the operand `value` is missing: `add.local.imm local, value`",
    );
    says("add.local.imm count", "20: the operand `value` is missing: `add.local.imm local, value`");
    says("add.local.imm , 4", "15: `,` is no local");
    says(", halt", "1: a line does not begin with `,`");
    says("\"halt\"", "1: a line does not begin with `\"halt\"`");
}

#[test]
fn numbers() {
    says("push.int 2147483648", "10: 2147483648 does not fit into this operand");
    says("push.int three", "10: `three` is no number: it is a number");
    says("push.int 9223372036854775808", "10: 9223372036854775808 does not fit into this operand");
    says("push.counter 256", "14: 256 does not fit into this operand");
    says("push.counter -1", "14: -1 does not fit into this operand");
    says("sense.input count, low", "20: `low` is no line: it is a number");
    says("push.local #256", "12: 256 does not fit into this operand");
    says("push.local #x", "12: `#x` is no local");
    says("push.const 1e999", "12: `1e999` is no constant: it is a number or `#index`");
    says("push.const pi", "12: `pi` is no constant: it is a number or `#index`");
    says(
        ".const real 0xg",
        "13: `0xg` is no constant: a decimal number, or 0x and the bits of one",
    );
    says(
        ".const int 0.5",
        "12: `0.5` is no constant: a number from -9223372036854775808 to \
         9223372036854775807",
    );
    says(".const text 5", "8: a constant is int or real");
    says(".counters 256", "11: `256` is no number of counters: a number from 0 to 255");
    says(".joints x 1 2 3", "16: the joint angle is missing");
}

#[test]
fn names() {
    says("push.local cuont", "12: there is no local `cuont`; the nearest is `count`");
    says("push.local \"two word\"", "12: there is no local `two word`; the nearest is `two words`");
    says("push.joints away", "13: there is no joint configuration `away`");
    says(
        "push.joints twice",
        "13: there is more than one joint configuration `twice`; write `#` \
         and the index of the one that is meant",
    );
    says("push.joints home#1", "13: joint configuration 1 is not called `home`");
    says("barrier wet", "9: `wet` is no reason: it stands in quotes");
    says("push.int \"3\"", "10: `\"3\"` is no number");
    says("push.local", "11: the operand `local` is missing: `push.local local`");
    says("call man", "6: there is no function `man`; the nearest is `main`");
    says("move.slot initial, joint", "11: there is no slot `initial`");
}

#[test]
fn choices() {
    says("output.toggle 3, low", "16: the line should end before `,`");
    says("output.set 3, hi", "15: `hi` is no level; there are low, high");
    says(
        "push.speed quick",
        "12: `quick` is no speed; there are very_slow, slow, normal, fast, very_fast, unnamed",
    );
    says("move.relative x, tcp", "15: `x` is no axis; there are +x, -x, +y, -y, +z, -z");
    says(
        ".local x integer",
        "10: `integer` is no type; there are int, real, bool, joints, item, speed, tool",
    );
    says(".error e bad", "10: `bad` is no severity; there are warning, recoverable, fatal");
    says(
        ".function f block",
        "13: `block` is no kind of function; there are start, sequence, action, io, \
         advanced_move, replacement, cleanup",
    );
    says(
        "@ 0 0 0 jump",
        "9: `jump` is no kind of action; there are move, advance, call, io, primitive, wait",
    );
}

#[test]
fn labels() {
    says(
        "loop: jump lop",
        "12: there is no label `lop`; the nearest is `loop`; labels are of their function",
    );
    says("a: halt\na: halt", "1: label `a` is there twice in this function");
    says("1st: halt", "1: `1st` is no label; a label is a word");
    says(
        "jump there\n.function f action\nthere: return",
        "6: there is no label `there`; labels \
         are of their function",
    );
    says("here: land", "11: no jump goes to this join; name the one that it is of");
    says(
        "jump a\njump a\na: land",
        "8: more than one jump goes to this join; name the one that it is of",
    );
}

#[test]
fn directives() {
    says(".joint x", "1: there is no directive `.joint`; the nearest is `.joints`");
    says(".at home 0 0 0 0 0 0", "1: `.at` follows its `.item`");
    says(".item i\nhalt\n.at home", "1: `.at` follows its `.item`");
    says(".item i\n.at grasp 0 0 0 0 0 0", "5: there is no keyframe `grasp`");
    says(".item i\n.at", "4: the keyframe is missing");
    says(".item i\n.at ,", "5: this is no keyframe");
    says(".item i\n.at #0 0 0", "11: the position in metres is missing");
    says(".item i\n.at #70000 0", "5: 70000 is no index: there are at most 65536");
    says(".item i\n.then stop", "1: what an error does follows its `.error`");
    let of_what = "a mention is of a cell, an item, a tool, an output or an input";
    says(".mention lamp 0 0 0", &format!("10: {of_what}"));
    says(
        ".mention output 7 0 0 0",
        "17: `7` is no name of the output; a name that is no word needs quotes",
    );
    says(".mention item 65536 0 0 0", "15: `65536` is no item: a number from 0 to 65535");
    says(".mention cell 0 0", "18: the end is missing");
    says(".tool", "6: the name of the tool is missing");
    says(".tool 7up", "7: `7up` is no name of the tool; a name that is no word needs quotes");
    says(".tool \"a", "7: the quote is not closed on this line");
    says(".tool \"a\\x\"", "9: this is no escape; there are \\\" \\\\ \\n \\r \\t and \\u{..}");
    says(".tool a b", "9: the line should end before `b`");
    says(
        ".parameter p int",
        "1: parameters come before other locals, and there are no more than 255",
    );
    says(".code\n.local x int", "1: `.local` follows its `.function`");
    says(".code 5", "7: the line should end before `5`");
    says(".prefix 256", "9: `256` is no prefix: a number from 0 to 255");
    says(".prefix 1\nenter", "6: enter takes no prefix");
    says(".range 0 x", "10: `x` is no end: a number from 0 to 4294967295");
    says(".map 0 0 0", "11: the end is missing");
    says("@ 0 0 0 move 5", "14: the line should end before `5`");
    says("@ 65536 0 0", "3: `65536` is no source file: a number from 0 to 65535");
}

#[test]
fn source_text() {
    says("| text", "1: source text follows its `.source`");
    says(".source s\nhalt\n| text", "1: source text follows its `.source`");
    says(".source s\n|\"a", "1: the quote is not closed on this line");
    says(".source s\n|\"a\" b", "1: nothing follows a quoted line of source text");
}

#[test]
fn errors_and_their_recoveries() {
    let clause = |line: &str, expected: &str| says(&format!(".error e fatal\n{line}"), expected);
    clause(".recover", "9: the recovery is missing");
    clause(".recover hope", "10: `hope` is no recovery; there are none, using, reversing");
    clause(".recover using nobody", "16: there is no function `nobody`");
    clause(
        ".recover reversing deep",
        "20: `deep` is no depth; there are fixed, escalating, doubling, learned",
    );
    clause(".recover reversing fixed", "25: the extent is missing");
    clause(
        ".recover reversing fixed far",
        "26: `far` is no extent; there are actions, checkpoint, sequence",
    );
    clause(
        ".recover reversing fixed actions -1",
        "34: `-1` is no number of actions: a number \
         from 0 to 4294967295",
    );
    clause(".recover reversing fixed checkpoint c", "37: there is no checkpoint `c`");
    clause(
        ".recover reversing fixed sequence loud",
        "35: `loud` is no change; there are perturbed, \
         slower, lighter",
    );
    clause(".recover reversing fixed sequence perturbed", "44: the pattern is missing");
    clause(
        ".recover reversing fixed sequence perturbed spiral",
        "51: the distance in metres is missing",
    );
    clause(
        ".on collision storm",
        "15: `storm` is no fault; there are joint_limit, out_of_reach, singular, \
         collision, force_limit, protective_stop, emergency_stop, stopped_short, stopped, \
         bad_command, missing",
    );
    clause(".watch", "7: the condition is missing");
    clause(".watch cat", "8: `cat` is no condition; there are input, force");
    clause(".watch input 3 up", "16: `up` is no level; there are low, high");
    clause(".watch force", "13: the force in newtons is missing");
    clause(".bounds patience 1", "9: `patience` is no bound; there are attempts, time, distance");
    clause(".bounds time", "13: the time in seconds is missing");
    clause(".recover reversing fixed sequence \"slower\"", "35: `\"slower\"` is no change");
    clause(".otherwise", "11: the last resort is missing");
    clause(".otherwise pray", "12: `pray` is no last resort; there are using, operator, stop");
    clause(
        ".respond later",
        "10: `later` is no time to respond; there are at_once, after_action, \
         after_sequence",
    );
    clause(
        ".then rest",
        "7: `rest` is no continuation; there are action, next_action, sequence, \
         program, stop",
    );
}

#[test]
fn beginnings() {
    let expected = "line 1, column 1: assembly text begins with the line `obvasm 1`";
    for text in ["", "\n; nothing\n", "halt", "sequence main { }"] {
        let errors = assemble(text).unwrap_err();
        assert_eq!(errors.len(), 1);
        assert_eq!(errors[0].to_string(), expected);
    }
    let error = |text: &str| assemble(text).unwrap_err()[0].to_string();
    assert_eq!(error("obvasm 2"), "line 1, column 8: there is version 1, and this is `2`");
    assert_eq!(error("\nobvasm"), "line 2, column 7: the version is missing");
    assert_eq!(error("obvasm 1 x"), "line 1, column 10: the line should end before `x`");
    let code = "obvasm 1\nhalt\nhalt";
    assert_eq!(
        error(code),
        "line 2, column 1: code belongs to a function; begin one with `.function \"main\" start`"
    );
    assert_eq!(assemble(code).unwrap_err().len(), 1);
}

#[test]
fn all_errors_are_told_in_order() {
    let text = format!("{HEAD}push.local x\n.tool\nhlt\n push.int z\n");
    let errors = assemble(&text).unwrap_err();
    let places: Vec<_> = errors.iter().map(|error| (error.line - 8, error.column)).collect();
    assert_eq!(places, [(1, 12), (2, 6), (3, 1), (4, 11)]);
}

#[test]
fn of_many_errors_the_first_are_told() {
    for line in ["hlt\n", "push.local x\n"] {
        let errors = assemble(&format!("{HEAD}{}", line.repeat(1000))).unwrap_err();
        assert_eq!(errors.len(), MAX_ERRORS);
        assert_eq!(errors.last().map(|error| error.line), Some(8 + MAX_ERRORS));
    }
}

#[test]
fn a_declaration_that_is_wrong_is_told_once() {
    let text = "obvasm 1\n.joints home 0 0 x\n.function f bad\n.local i integer\n.counters 1\n\
                push.joints home\npush.local i\n.error e worse\n.then stop\nerror.raise e\n";
    let errors = assemble(text).unwrap_err();
    let lines: Vec<_> = errors.iter().map(|error| error.line).collect();
    assert_eq!(lines, [2, 3, 4, 8], "{errors:?}");
}

#[test]
fn a_long_word_is_not_repeated() {
    let word = "x".repeat(1_000_000);
    let errors = assemble(&format!("{HEAD}{word}\npush.local {word}\n{word}:\n")).unwrap_err();
    assert_eq!(errors.len(), 3);
    assert!(errors.iter().all(|error| error.message.len() < 300));
}

/// The codes of what is wrong with a text, by the assembler or else by the verifier.
fn codes(text: &str) -> Vec<ModuleCode> {
    match assemble(text).map(verify) {
        Err(errors) => errors.iter().map(|error| error.code).collect(),
        Ok(Err(errors)) => errors.iter().map(|error| error.rule.code()).collect(),
        Ok(Ok(_)) => Vec::new(),
    }
}

#[test]
fn the_examples_of_the_pages_are_what_they_say() {
    // Bytes that are no module cannot be shown as text.
    for code in ModuleCode::ALL.iter().filter(|code| **code != ModuleCode::Bytes) {
        assert_eq!(codes(code.page().right).first(), None, "{}", code.as_str());
        assert_eq!(codes(code.page().wrong).first(), Some(code), "{}", code.as_str());
    }
    assert!(ModuleCode::ALL.iter().map(|code| code.as_str()).is_sorted_by(|a, b| a < b));
}
