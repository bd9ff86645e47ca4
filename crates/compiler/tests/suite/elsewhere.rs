//! Words of other robot languages: each of the page for those who come from there, used as it is
//! used there, gets one message, which says what the page says.

use obverse_compiler::compile;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::source::LineIndex;

const PAGE: &str = include_str!("../../../../docs/from-other-languages.md");

/// Declared where a word is tried; none of them is meant by any.
const DECLARATIONS: &str = "action pick(part: item) { wait 1 s }\nitem peg { }\nvar k = 0\n";

/// A word as it stands on the page, a use of it whose line is the first that has its own words, and
/// what the page says, which the message says too.
struct Use {
    word: &'static str,
    written: &'static str,
    said: &'static str,
}

const fn of(word: &'static str, written: &'static str, said: &'static str) -> Use {
    Use { word, written, said }
}

const USES: &[Use] = &[
    of("MoveJ", "MoveJ p10, v100, fine, tool0;", "move to"),
    of("MoveAbsJ", "MoveAbsJ home\\NoEOffs, v100, fine, tool0;", "move to"),
    of("PTP", "PTP P1 Vel=100 % PDAT1", "move to"),
    of("SPTP", "SPTP P1", "move to"),
    of("movej", "movej(home, a=1.4, v=1.05)", "move to"),
    of("MoveL", "MoveL p10, v100, z10, tool0 \\WObj:=tray;", "linearly"),
    of("LIN", "LIN P1 Vel=0.3 m/s CPDAT1", "linearly"),
    of("SLIN", "SLIN P1", "linearly"),
    of("movel", "movel(home, a=1.2, v=0.25)", "linearly"),
    of("MoveL Offs(..)", "MoveL Offs(p10, 0, 0, 50), v100, fine, tool0;", "up in base"),
    of("RelTool(..)", "MoveL RelTool(p10, 0, 0, 50), v100, fine, tool0;", "forward in tcp"),
    of("RelTool(..)", "p20 := RelTool(p10, 0, 0, 50);", "forward in tcp"),
    of("LIN_REL", "LIN_REL {Z -20}", "in base"),
    of("pose_trans", "p2 = pose_trans(p1, p[0, 0, 0.05, 0, 0, 0])", "forward in tcp"),
    of("pose_trans", "movel(pose_trans(p1, p[0, 0, 0.05, 0, 0, 0]))", "forward in tcp"),
    of("pose_add", "var p2 = pose_add(p1, p[0, 0, 0.05, 0, 0, 0])", "up in base"),
    of("MoveC", "MoveC p10, p20, v100, z10, tool0;", "name points of the arc"),
    of("CIRC", "CIRC P1, P2", "name points of the arc"),
    of("SCIRC", "SCIRC P1, P2", "name points of the arc"),
    of("movec", "movec(via, target, a=1, v=0.1)", "name points of the arc"),
    of("z10", "MoveL p10, v100, z10, tool0;", "each motion ends before the next begins"),
    of("C_DIS", "LIN P1 C_DIS", "each motion ends before the next begins"),
    of("C_PTP", "PTP P1 C_PTP", "each motion ends before the next begins"),
    of("$APO", "$APO.CDIS = 20", "each motion ends before the next begins"),
    of("r", "movel(home, a=1.2, v=0.25, r=0.05)", "each motion ends before the next begins"),
    of("SearchL \\Stop", "SearchL \\Stop, di1, sp, p10, v10, tool0;", "stop if force > 5 N"),
    of("BRAKE", "BRAKE", "stop if force > 5 N"),
    of("force()", "if force() > 5:\n  k = 1\nend", "stop if force > 5 N"),
    of("stopl", "stopl(1.2)", "stop if force > 5 N"),
    of("force_mode", "force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], w, 2, l)", "does not steer it"),
    of("CRobT", "p20 := CRobT(\\Tool:=tool0);", "position here"),
    of("CJointT", "j1 := CJointT();", "position here"),
    of("$POS_ACT", "XP1 = $POS_ACT", "position here"),
    of("$AXIS_ACT", "XP1 = $AXIS_ACT", "position here"),
    of("get_actual_tcp_pose", "p1 = get_actual_tcp_pose()", "position here"),
    of("get_actual_joint_positions", "var q = get_actual_joint_positions()", "position here"),
    of("jointtarget", "CONST jointtarget home := [[0,0,0,0,90,0],[9E9]];", "joints"),
    of("AXIS", "AXIS HOME", "joints"),
    of("E6AXIS", "DECL E6AXIS HOME={A1 0,A2 -90}", "joints"),
    of("robtarget", "CONST robtarget p10 := [[600,0,400],[1,0,0,0]];", "keyframe"),
    of("POS", "DECL POS P1", "keyframe"),
    of("E6POS", "DECL E6POS P1={X 600,Y 0,Z 400}", "keyframe"),
    of("p[x, y, z, rx, ry, rz]", "p1 = p[0.6, 0, 0.4, 0, 0, 0]", "keyframe"),
    of("wobjdata", "PERS wobjdata tray := [FALSE,TRUE,\"\"];", "the item"),
    of("$BASE", "$BASE = BASE_DATA[1]", "the item"),
    of("pose_trans", "movel(pose_trans(tray, p[0, 0, 0.05, 0, 0, 0]))", "the item"),
    of("tooldata", "PERS tooldata t1 := [TRUE,[[0,0,0]]];", "tool gripper"),
    of("$TOOL", "$TOOL = TOOL_DATA[1]", "tool gripper"),
    of("set_tcp", "set_tcp(p[0, 0, 0.1, 0, 0, 0])", "tool gripper"),
    of("v100", "MoveL p10, v100, fine, tool0;", "speed slow"),
    of("$VEL.CP", "$VEL.CP = 0.05", "speed slow"),
    of("$VEL_AXIS[]", "$VEL_AXIS[1] = 50", "speed slow"),
    of("BAS", "BAS(#VEL_PTP, 50)", "speed slow"),
    of("v=", "movel(home, v=0.25)", "speed slow"),
    of("a=", "movel(home, a=1.2)", "speed slow"),
    of("SetDO do1, 1", "SetDO do1, 1;", "set "),
    of("Set", "Set do1;", "set "),
    of("Reset", "Reset do1;", "set "),
    of("$OUT[1] = TRUE", "$OUT[1] = TRUE", "set 1 high"),
    of("set_standard_digital_out(1, True)", "set_standard_digital_out(1, True)", "set 1 high"),
    of("InvertDO", "InvertDO lamp;", "toggle lamp"),
    of("$OUT[1] = NOT $OUT[1]", "$OUT[1] = NOT $OUT[1]", "toggle"),
    of(
        ".. not get_standard_digital_out(1)",
        "set_standard_digital_out(1, not get_standard_digital_out(1))",
        "toggle",
    ),
    of("SIGNAL LAMP $OUT[1]", "SIGNAL LAMP $OUT[1]", "output lamp = 1"),
    of("DI1 = 1", "IF DI1 = 1 THEN\n  k = 1;\nENDIF", "input "),
    of("DInput", "IF DInput(di1) = 1 THEN\n  k = 1;\nENDIF", "input "),
    of("$IN[3]", "if $IN[3] { wait 1 s }", "input "),
    of("$IN[3]", "IF $IN[3] THEN", "input "),
    of("get_standard_digital_in(3)", "if get_standard_digital_in(3):\n  wait 1 s\nend", "input "),
    of("get_standard_digital_in(3)", "if get_standard_digital_in(3) { wait 1 s }", "input "),
    of("WaitDI di1, 1 \\MaxTime:=2", "WaitDI di1, 1 \\MaxTime:=2;", "wait until input"),
    of("WAIT FOR $IN[3]", "WAIT FOR $IN[3]", "wait until input"),
    of("WAIT FOR $IN[3]", "wait for $in[3]", "wait until input"),
    of("WaitTime 0.5", "WaitTime 0.5;", "wait 0.5 s"),
    of("WAIT SEC 0.5", "WAIT SEC 0.5", "wait 0.5 s"),
    of("WAIT SEC 0.5", "wait sec 0.5", "wait 0.5 s"),
    of("sleep(0.5)", "sleep(0.5)", "0.5 s"),
    of("SetAO", "SetAO ao1, 5.0;", "an output is high or low"),
    of("$ANOUT[]", "$ANOUT[1] = 0.5", "an output is high or low"),
    of("set_standard_analog_out", "set_standard_analog_out(0, 0.5)", "an output is high or low"),
    of("PROC main()", "PROC main()", "sequence main"),
    of("DEF", "DEF pick()", "sequence"),
    of("PROC", "PROC pick()", "sequence"),
    of("PROC", "proc pick()", "sequence"),
    of("FUNC", "FUNC num area(num a)", "sequence"),
    of("DEFFCT", "DEFFCT REAL AREA(A:IN)", "sequence"),
    of("def f(): .. end", "def f():\n  k = 1\nend", "sequence"),
    of("pick peg;", "pick peg;", "call pick"),
    of("PICK(PEG)", "PICK(PEG)", "call "),
    of("pick(peg)", "pick(peg)", "call pick"),
    of("VAR num n := 0;", "VAR num n := 0;", "var n ="),
    of("DECL INT N", "DECL INT N", "var "),
    of("n = 0", "n = 0", "var n ="),
    of(":=", "k := 0;", "="),
    of("<>", "if k <> 1 { wait 1 s }", "!="),
    of("IF .. THEN .. ELSEIF", "IF k > 3 THEN", "if "),
    of("IF .. THEN .. ELSEIF", "ELSEIF k > 3 THEN", "else if"),
    of("IF .. THEN .. ENDIF", "IF k > 3 THEN\n  k = 1\nENDIF", "if "),
    of("if c: .. elif d:", "elif k > 3:", "else if"),
    of("TEST", "TEST k", "else if"),
    of("SWITCH", "SWITCH k", "else if"),
    of("elif", "elif k > 3:", "else if"),
    of("FOR i FROM 1 TO 9 DO", "FOR i FROM 1 TO 9 DO", "for i from 1 to 9 { .. }"),
    of("FOR I = 1 TO 9", "FOR I = 1 TO 9", "for i from 1 to 9 { .. }"),
    of("WHILE", "WHILE k < 3 DO", "while "),
    of("REPEAT .. UNTIL", "REPEAT\n  k = k + 1\nUNTIL k > 3", "while "),
    of("REPEAT .. UNTIL", "UNTIL k > 3", "while "),
    of("WHILE TRUE DO", "WHILE TRUE DO", "loop { .. }"),
    of("LOOP", "LOOP\n  k = k + 1\nENDLOOP", "loop { .. }"),
    of("EXIT", "EXIT", "break"),
    of("while True:", "while True:\n  k = k + 1\nend", "loop { .. }"),
    of("thread", "thread blink():\n  k = 1\nend", "fork { .. } and { .. }"),
    of("run", "run blink()", "fork { .. } and { .. }"),
    of("join", "join blinker", "fork { .. } and { .. }"),
    of("GOTO", "GOTO again;", "break"),
    of("MODULE", "MODULE Main", "import \"poses.obv\""),
    of("Load", "Load \\Dynamic, \"HOME:/poses.mod\";", "import \"poses.obv\""),
    of("GLOBAL", "GLOBAL INT N = 3", "import \"poses.obv\""),
    of("EXT", "EXT PICK()", "import \"poses.obv\""),
    of("!", "! close the gripper", "//"),
    of("!", "wait 1 s ! close the gripper", "//"),
    of(";", "; close the gripper", "//"),
    of("#", "# close the gripper", "//"),
    of("errnum", "VAR errnum no_part := -1;", "error no_part"),
    of("BookErrNo", "BookErrNo no_part;", "error "),
    of("RAISE no_part;", "RAISE no_part;", "throw"),
    of("popup", "popup(\"no part\", error=True)", "throw "),
    of("ERROR", "ERROR", "recover using "),
    of("RETRY", "RETRY;", "then return to action"),
    of("TRYNEXT", "TRYNEXT;", "then continue"),
    of("ExitCycle", "ExitCycle;", "then return to sequence"),
    of("RESUME", "RESUME", "then restart program"),
    of("EXIT", "EXIT;", "severity fatal"),
    of("Stop", "Stop;", "severity fatal"),
    of("HALT", "HALT", "severity fatal"),
    of("halt", "halt", "severity fatal"),
    of("TRAP", "TRAP door_open", "wait until input"),
    of("CONNECT", "CONNECT intno1 WITH door_open;", "wait until input"),
    of("ISignalDI", "ISignalDI di1, 1, intno1;", "wait until input"),
    of(
        "INTERRUPT DECL .. WHEN .. DO",
        "INTERRUPT DECL 3 WHEN $IN[1]==TRUE DO stop_it()",
        "stop if force",
    ),
    of("StopMove", "StopMove;", "stop if force > 5 N"),
    of("BRAKE F", "BRAKE F", "stop if force > 5 N"),
    of("stopj", "stopj(2.0)", "stop if force > 5 N"),
];

/// What is written the same here, or has no word here.
const SAME: [&str; 4] = ["=", "==", "!=", "while"];

/// The rows of the tables of words: the words of the others, and what is said here.
fn rows() -> Vec<(Vec<&'static str>, &'static str)> {
    let rows = PAGE.lines().filter(|line| line.starts_with("| ") && line.matches('|').count() == 6);
    let cells = rows.map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
    let is_of_words = |cells: &Vec<&str>| !matches!(cells[1], "" | "---") && cells[5] != "Obverse";
    let words = |cells: &[&'static str]| -> Vec<&'static str> {
        cells.iter().flat_map(|cell| cell.split('`').skip(1).step_by(2)).collect()
    };
    cells.filter(is_of_words).map(|cells| (words(&cells[2..5]), cells[5])).collect()
}

/// What is said of a use in a sequence, with the lines that it is said of.
fn said_of(written: &str) -> Vec<(u32, Diagnostic)> {
    let before = format!("{DECLARATIONS}sequence main {{\n  wait 1 s\n");
    let first = before.lines().count() as u32 + 1;
    let source = format!("{before}{written}\n  wait 1 s\n}}\n");
    let index = LineIndex::new(&source);
    let found = compile("elsewhere.obv", &source).diagnostics;
    let line = |one: &Diagnostic| index.position(one.primary.span.start).line + 1 - first;
    found.into_iter().map(|one| (line(&one), one)).collect()
}

#[test]
fn every_word_of_the_page_has_a_use_that_is_told_what_the_page_says() {
    let rows = rows();
    assert!(rows.len() > 35, "{} rows", rows.len());
    let mut missing = Vec::new();
    for (words, cell) in &rows {
        for word in words.iter().filter(|word| !SAME.contains(word)) {
            if !USES.iter().any(|one| one.word == *word && cell.contains(one.said.trim())) {
                missing.push(format!("{word}: {cell}"));
            }
        }
    }
    assert!(missing.is_empty(), "{} of the page:\n{}", missing.len(), missing.join("\n"));
}

/// What is said of a statement, and what becomes of it when the suggestion is taken.
fn mended(declarations: &str, written: &str) -> (String, Option<String>) {
    let source = format!("{declarations}\nsequence main {{\n{written}\nwait 1 s\n}}\n");
    let mut found = compile("elsewhere.obv", &source).diagnostics;
    assert_eq!(found.len(), 1, "{written}: {found:#?}");
    let found = found.remove(0);
    let mended = found.suggestion.map(|change| {
        let (start, end) = (change.span.start as usize, change.span.end as usize);
        let text = [&source[..start], &change.text, &source[end..]].concat();
        text.lines().rev().nth(2).unwrap_or_default().to_owned()
    });
    (found.help.unwrap_or_default(), mended)
}

#[test]
fn levels_that_are_taken_for_values_are_put_right() {
    let cases = [
        ("if input 2 == 1 { wait 1 s }", "if input 2 { wait 1 s }"),
        ("if input 2 == high { wait 1 s }", "if input 2 { wait 1 s }"),
        ("if input 2 != LOW { wait 1 s }", "if input 2 { wait 1 s }"),
        ("if input 2 == 0 { wait 1 s }", "if not input 2 { wait 1 s }"),
        ("if input 2 and holding == low { wait 1 s }", "if input 2 and not holding { wait 1 s }"),
        ("lamp = high", "set lamp high"),
        ("lamp = 0", "set lamp low"),
        ("if True { wait 1 s }", "if true { wait 1 s }"),
    ];
    for (written, meant) in cases {
        let (_, text) = mended("output lamp = 2", written);
        assert_eq!(text.as_deref(), Some(meant), "{written}");
    }
}

#[test]
fn what_is_not_there_is_not_mistaken_for_something_else() {
    let (help, change) = mended("", "var _a = sin(30 deg)");
    assert!(help.contains("no places are computed") && change.is_none(), "{help}");
    let (help, _) = mended("", "while false { wait 1 s }");
    assert_eq!(help, "leave it out, with the block that is never run");
}

#[test]
fn every_use_gets_one_message_that_says_what_the_page_says() {
    let mut wrong = Vec::new();
    for Use { word, written, said } in USES {
        let found = said_of(written);
        let told: Vec<String> = found
            .iter()
            .map(|(line, one)| {
                let help = one.help.as_deref().unwrap_or("");
                format!("  {line} {} {}: {help}", one.code, one.message)
            })
            .collect();
        let is_told = |(line, one): &(u32, Diagnostic)| {
            *line == 1 && one.help.as_ref().is_some_and(|help| help.contains(said))
        };
        if found.len() != 1 || !found.iter().any(is_told) {
            wrong.push(format!("{word}: {written} wants {said}\n{}", told.join("\n")));
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), USES.len(), wrong.join("\n"));
}
