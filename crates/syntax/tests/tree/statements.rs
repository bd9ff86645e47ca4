//! Statements: moves and their ways, settings, blocks, and where one ends.

use super::*;

#[test]
fn a_move_goes_to_a_place_or_a_way() {
    let show_move = |body: &str| {
        let mut shown = String::new();
        with_statement(body, |statement| {
            let StatementKind::Move { target, linear, always } = statement else { panic!() };
            let target = match target {
                Target::Named(name) => name.value.to_owned(),
                Target::Keyframe { item, keyframe } => {
                    format!("{}.{}", item.value, keyframe.value)
                }
                Target::Relative { distance, heading, frame } => {
                    let frame = frame.map(|frame| frame.value);
                    format!("{} {:?} {frame:?}", show(&distance), heading.value)
                }
                Target::Turned(turn) => {
                    let by: Vec<String> = turn.amounts().map(show).collect();
                    let frame = turn.frame.map(|frame| frame.value);
                    format!("{} {:?} {frame:?}", by.join(" on "), turn.heading.value)
                }
            };
            shown = format!("{target} {linear} {}", always.is_some());
        });
        shown
    };
    assert_eq!(show_move("move to start"), "start false false");
    assert_eq!(show_move("move to peg.start linearly"), "peg.start true false");
    assert_eq!(show_move("move to start linearly reversible always"), "start true true");
    assert_eq!(show_move("move 20 mm up in base"), "20.0mm Up Some(Base) false false");
    assert_eq!(show_move("move 20 mm -x"), "20.0mm MinusX None false false");
    assert_eq!(show_move("move x x in toolmount"), "x X Some(ToolMount) false false");
    assert_eq!(
        show_move("move (a - b) * 2 -z"),
        "((a Subtract b) Multiply 2) MinusZ None false false"
    );
    assert_eq!(show_move("turn 90 deg forward"), "90.0deg Forward None false false");
    assert_eq!(
        show_move("turn 2 * turn advancing -x -y in base"),
        "(2 Multiply turn) on (Negate x) MinusY Some(Base) false false"
    );
}

#[test]
fn every_heading_has_its_word() {
    let cases = [
        ("forward", Heading::Forward),
        ("backward", Heading::Backward),
        ("backwards", Heading::Backward),
        ("left", Heading::Left),
        ("right", Heading::Right),
        ("up", Heading::Up),
        ("down", Heading::Down),
        ("x", Heading::X),
        ("y", Heading::Y),
        ("z", Heading::Z),
        ("-x", Heading::MinusX),
        ("-y", Heading::MinusY),
        ("- z", Heading::MinusZ),
    ];
    for (word, expected) in cases {
        with_statement(&format!("move 1 mm {word}"), |statement| {
            let StatementKind::Move { target: Target::Relative { heading, .. }, .. } = statement
            else {
                panic!("{word}")
            };
            assert_eq!(heading.value, expected, "{word}");
        });
    }
}

#[test]
fn every_speed_has_its_words() {
    let cases = [
        ("very slow", SpeedWord::VerySlow),
        ("slow", SpeedWord::Slow),
        ("normal", SpeedWord::Normal),
        ("fast", SpeedWord::Fast),
        ("very fast", SpeedWord::VeryFast),
    ];
    for (words, expected) in cases {
        with_statements(&format!("speed {words} speed {words} {{ break }}"), |statements| {
            let [
                StatementKind::Speed { speed, block: None },
                StatementKind::Speed { block: Some(_), .. },
            ] = &statements[..]
            else {
                panic!("{words}: {statements:?}")
            };
            assert_eq!(speed.value, expected);
        });
    }
}

/// A statement's kind in a word, with what is in its blocks.
fn outline(statement: &Statement<'_>) -> String {
    let block = |block: &Block<'_>| {
        let inner: Vec<String> = block.statements.iter().map(outline).collect();
        format!("{{{}}}", inner.join(" "))
    };
    let optional = |one: &Option<Block<'_>>| one.as_ref().map_or(String::new(), block);
    match &statement.kind {
        StatementKind::Move { .. } => "move".to_owned(),
        StatementKind::Advance(name) => format!("advance:{}", name.value),
        StatementKind::Call { name, arguments } => {
            format!("call:{}/{}", name.value, arguments.len())
        }
        StatementKind::Io(name) => format!("io:{}", name.value),
        StatementKind::Wait(duration) => format!("wait:{}", show(duration)),
        StatementKind::WaitUntil { input, high, timeout, otherwise } => {
            format!("until:{}:{high}:{}{}", signal(input.value), show(timeout), optional(otherwise))
        }
        StatementKind::Primitive(_) => "primitive".to_owned(),
        StatementKind::Variable(variable) => format!("var:{}", variable.name.value),
        StatementKind::Remember(name) => format!("position:{}", name.value),
        StatementKind::Assign { name, operator, value } => {
            format!("{}:{operator:?}:{}", name.value, show(value))
        }
        StatementKind::If { condition, then, otherwise, ending_when } => {
            let ending =
                ending_when.as_ref().map_or(String::new(), |one| format!(":{}", show(one)));
            format!("if:{}{}{}{ending}", show(condition), block(then), optional(otherwise))
        }
        StatementKind::While { condition, entered_when, body } => {
            let entered =
                entered_when.as_ref().map_or(String::new(), |one| format!(":{}", show(one)));
            format!("while:{}{entered}{}", show(condition), block(body))
        }
        StatementKind::Repeat { times, body } => format!("repeat:{}{}", show(times), block(body)),
        StatementKind::For { name, first, down, last, body } => {
            let down = if *down { ":down" } else { "" };
            format!("for:{}:{}{down}:{}{}", name.value, show(first), show(last), block(body))
        }
        StatementKind::Loop(body) => format!("loop{}", block(body)),
        StatementKind::Fork(branches) => {
            format!("fork{}", branches.iter().map(block).collect::<String>())
        }
        StatementKind::Break => "break".to_owned(),
        StatementKind::Return => "return".to_owned(),
        StatementKind::Speed { block, .. } => format!("speed{}", optional(block)),
        StatementKind::Tool { name, block } => format!("tool:{}{}", name.value, optional(block)),
        StatementKind::Requires { condition, error } => {
            format!("requires:{}:{}", show(condition), error.value)
        }
        StatementKind::Checkpoint(name) => format!("checkpoint:{}", name.value),
        StatementKind::Barrier(reason) => format!("barrier:{}", reason.value),
        StatementKind::Irreversible { reason, block: body } => {
            format!("irreversible:{}{}", reason.value, block(body))
        }
        StatementKind::SkipInReverse(body) => format!("skip{}", block(body)),
        StatementKind::ReplaceInReverse { block: body, replacement } => {
            format!("do{}{}", block(body), block(replacement))
        }
        StatementKind::KeepInReverse(body) => format!("keep{}", block(body)),
        StatementKind::WithInReverse { parameters, block: body } => {
            let words: Vec<String> = parameters
                .iter()
                .map(|parameter| match &parameter.value {
                    ReverseParameter::Speed(word) => format!("{word:?}"),
                    ReverseParameter::ForceLimit(limit) => show(limit),
                    ReverseParameter::StraightMoves => "straight".to_owned(),
                })
                .collect();
            format!("with:{}{}", words.join(","), block(body))
        }
        StatementKind::Throw(name) => format!("throw:{}", name.value),
        StatementKind::Allow(allow) => format!("allow:{}:{}", allow.code.value, allow.in_file),
    }
}

fn body(source: &str) -> String {
    let text = format!("sequence main {{ {source} }}");
    let Item::Sequence(sequence) = item(&text) else { panic!("{source}") };
    sequence.body.statements.iter().map(outline).collect::<Vec<_>>().join(" ")
}

#[test]
fn statements_are_told_apart() {
    let cases = [
        ("advance insert", "advance:insert"),
        ("call pick(a, b)", "call:pick/2"),
        ("call pick() call pick", "call:pick/0 call:pick/0"),
        ("io open", "io:open"),
        ("wait 2 s", "wait:2.0s"),
        ("wait until input 3 high for up to 2 s", "until:3:true:2.0s"),
        ("wait until input 3 low for up to t else { break }", "until:3:false:t{break}"),
        ("set 0 high toggle 1 sleep 1 s", "primitive primitive primitive"),
        ("var a = 1", "var:a"),
        ("position here", "position:here"),
        ("allow W0001 \"why\" break", "allow:W0001:false break"),
        ("allow W0001 in file \"why\"", "allow:W0001:true"),
        ("a = 1 a += 2 a -= 3", "a:Set:1 a:Add:2 a:Subtract:3"),
        ("while a { break }", "while:a{break}"),
        ("while a entered when b { }", "while:a:b{}"),
        ("repeat 3 times { break }", "repeat:3{break}"),
        ("repeat error times { if a { } }", "repeat:error{if:a{}}"),
        ("for i from 0 to n - 1 { break }", "for:i:0:(n Subtract 1){break}"),
        ("for i from n down to down { break }", "for:i:n:down:down{break}"),
        ("loop { break return }", "loop{break return}"),
        ("fork { break }", "fork{break}"),
        ("fork { break } and { return } and { }", "fork{break}{return}{}"),
        ("tool gripper tool gripper { break }", "tool:gripper tool:gripper{break}"),
        ("checkpoint here", "checkpoint:here"),
        ("barrier \"why\"", "barrier:why"),
        ("irreversible \"why\" { break }", "irreversible:why{break}"),
        ("skip in reverse { break }", "skip{break}"),
        ("do { break } in reverse { return }", "do{break}{return}"),
        ("keep in reverse { break }", "keep{break}"),
        ("with speed very slow in reverse { break }", "with:VerySlow{break}"),
        (
            "with force limit a + 2 N, straight moves, speed fast in reverse { }",
            "with:(a Add 2.0N),straight,Fast{}",
        ),
        ("with = limit straight = moves", "with:Set:limit straight:Set:moves"),
        ("throw lost", "throw:lost"),
        ("requires a > 2 else throw lost", "requires:(a Greater 2):lost"),
        ("requires = 2 requires a else throw b", "requires:Set:2 requires:a:b"),
    ];
    for (source, outline) in cases {
        assert_eq!(body(source), outline, "{source}");
    }
}

#[test]
fn else_if_is_a_block_of_one_and_ending_when_is_of_the_whole() {
    assert_eq!(body("if a { break }"), "if:a{break}");
    assert_eq!(body("if a { break } else { return }"), "if:a{break}{return}");
    assert_eq!(
        body("if a { } else if b { break } else { return } ending when c"),
        "if:a{}{if:b{break}{return}}:c"
    );
    assert_eq!(body("if a { if b { } ending when c } else { }"), "if:a{if:b{}:c}{}");
}

#[test]
fn line_ends_and_semicolons_do_not_matter() {
    let expected = "io:a a:Set:1 break";
    for source in ["io a a = 1 break", "io a; a = 1; break;", ";;io\na\na\n=\n1;;\nbreak"] {
        assert_eq!(body(source), expected, "{source}");
    }
}

#[test]
fn words_of_the_language_can_be_names() {
    let names = ["start", "x", "up", "slow", "high", "left", "base", "normal", "item", "warning"];
    for name in names {
        assert_eq!(
            body(&format!("position {name} {name} = {name} + 1")),
            format!("position:{name} {name}:Set:({name} Add 1)")
        );
        assert_eq!(body(&format!("move to {name}.{name} speed slow")), "move speed");
    }
    assert_eq!(items("item item { } joints joints = [1] rad sequence action { }").len(), 3);
}
