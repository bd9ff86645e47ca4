//! The tree that each construct becomes.

use obverse_syntax::ast::*;
use obverse_syntax::parse;

/// The declarations of a text without mistakes.
fn items(source: &str) -> Vec<Item<'_>> {
    let parsed = parse(source);
    assert_eq!(parsed.diagnostics, [], "{source}");
    parsed.program.items
}

fn item(source: &str) -> Item<'_> {
    let mut items = items(source);
    assert_eq!(items.len(), 1, "{source}");
    items.remove(0)
}

/// Calls `check` with the statements of a sequence with this body.
fn with_statements(body: &str, check: impl FnOnce(Vec<StatementKind<'_>>)) {
    let source = format!("sequence main {{\n{body}\n}}");
    let Item::Sequence(sequence) = item(&source) else { panic!("{source}") };
    check(sequence.body.statements.into_iter().map(|statement| statement.kind).collect());
}

fn with_statement(body: &str, check: impl FnOnce(StatementKind<'_>)) {
    with_statements(body, |mut statements| {
        assert_eq!(statements.len(), 1, "{body}");
        check(statements.remove(0));
    });
}

fn signal(signal: Signal<'_>) -> String {
    match signal {
        Signal::Number(number) => number.to_string(),
        Signal::Name(name) => name.to_owned(),
    }
}

/// An expression with brackets around every operation, numbers as they are.
fn show(expression: &Expression<'_>) -> String {
    let list =
        |arguments: &[Expression<'_>]| arguments.iter().map(show).collect::<Vec<_>>().join(", ");
    match &expression.kind {
        ExpressionKind::Integer(value) => format!("{value}"),
        ExpressionKind::Real(value) => format!("{value:?}"),
        ExpressionKind::Quantity { value, unit } => format!("{value:?}{}", unit.value),
        ExpressionKind::Boolean(value) => format!("{value}"),
        ExpressionKind::Name(name) => (*name).to_owned(),
        ExpressionKind::Unary { operator, operand } => format!("({operator:?} {})", show(operand)),
        ExpressionKind::Binary { operator, left, right } => {
            format!("({} {operator:?} {})", show(left), show(right))
        }
        ExpressionKind::Function { name, arguments } => {
            format!("{}({})", name.value, list(arguments))
        }
        ExpressionKind::Input(line) => format!("input {}", signal(line.value)),
        ExpressionKind::Force => "force".to_owned(),
        ExpressionKind::Distance => "distance".to_owned(),
        ExpressionKind::Holding => "holding".to_owned(),
        ExpressionKind::Missing => "missing".to_owned(),
    }
}

fn expression(source: &str) -> String {
    let text = format!("var v = {source}");
    let Item::Variable(variable) = item(&text) else { panic!("{source}") };
    show(&variable.value)
}

#[test]
fn operators_bind_as_usual() {
    let cases = [
        ("1 + 2 * 3 - 4", "((1 Add (2 Multiply 3)) Subtract 4)"),
        ("a / b mod c", "((a Divide b) Remainder c)"),
        ("not a == b and c or d", "(((Not (a Equal b)) And c) Or d)"),
        ("a or b and c", "(a Or (b And c))"),
        ("- -1 * 2", "((Negate (Negate 1)) Multiply 2)"),
        ("a - -b", "(a Subtract (Negate b))"),
        ("(1 + 2) * 3", "((1 Add 2) Multiply 3)"),
        ("a < b", "(a Less b)"),
        ("a <= 1", "(a LessOrEqual 1)"),
        ("a > 1", "(a Greater 1)"),
        ("a >= 1", "(a GreaterOrEqual 1)"),
        ("a != 1", "(a NotEqual 1)"),
        ("(a < b) == true", "((a Less b) Equal true)"),
    ];
    for (source, tree) in cases {
        assert_eq!(expression(source), tree, "{source}");
    }
}

#[test]
fn what_an_expression_is_made_of() {
    let cases = [
        ("9223372036854775807", "9223372036854775807"),
        ("0.5", "0.5"),
        ("1e-3", "0.001"),
        ("0.5 s", "0.5s"),
        ("20mm/s", "20.0mm/s"),
        ("3 mm / s", "(3.0mm Divide s)"),
        ("false", "false"),
        ("input 3 and force > 5 N", "(input 3 And (force Greater 5.0N))"),
        ("distance", "distance"),
        ("holding", "holding"),
        ("random(-1 mm, 1 mm,)", "random((Negate 1.0mm), 1.0mm)"),
        ("abs()", "abs()"),
        ("min(m, s)", "min(m, s)"),
    ];
    for (source, tree) in cases {
        assert_eq!(expression(source), tree, "{source}");
    }
}

#[test]
fn spans_cover_what_was_written() {
    let source = "var gap = (1 + 2) * 3 // that is it";
    let Item::Variable(variable) = item(source) else { panic!() };
    let text = |span: obverse_syntax::span::Span| &source[span.start as usize..span.end as usize];
    assert_eq!(text(variable.span), "var gap = (1 + 2) * 3");
    assert_eq!(text(variable.value.span), "(1 + 2) * 3");
    let ExpressionKind::Binary { left, .. } = &variable.value.kind else { panic!() };
    assert_eq!(text(left.span), "(1 + 2)");
    let source = "sequence s { wait 20 mm / s }";
    let Item::Sequence(sequence) = item(source) else { panic!() };
    let statement = &sequence.body.statements[0];
    let text = |span: obverse_syntax::span::Span| &source[span.start as usize..span.end as usize];
    assert_eq!(text(statement.span), "wait 20 mm / s");
    assert_eq!(text(sequence.body.span), "{ wait 20 mm / s }");
    let StatementKind::Wait(Expression { kind: ExpressionKind::Binary { left, .. }, .. }) =
        &statement.kind
    else {
        panic!()
    };
    let ExpressionKind::Quantity { unit, .. } = left.kind else { panic!() };
    assert_eq!((text(left.span), text(unit.span)), ("20 mm", "mm"));
}

#[test]
fn a_cell_is_a_path() {
    let Item::Cell(path) = item("cell \"peg in hole.toml\"") else { panic!() };
    assert_eq!(path.value, "peg in hole.toml");
}

#[test]
fn an_import_is_a_path() {
    let Item::Import(path) = item("import \"poses/left.obv\"") else { panic!() };
    assert_eq!(path.value, "poses/left.obv");
}

#[test]
fn an_entry_of_an_io_map_has_a_name_and_a_number() {
    let entries = [
        ("output gripper = 0", SignalKind::Output, "gripper", 0),
        ("input part_present = 3", SignalKind::Input, "part_present", 3),
        ("input high = 4", SignalKind::Input, "high", 4),
        ("output output = 5", SignalKind::Output, "output", 5),
    ];
    for (source, kind, name, number) in entries {
        let Item::Signal(entry) = item(source) else { panic!("{source}") };
        assert_eq!((entry.kind, entry.name.value, entry.number.value), (kind, name, number));
    }
}

#[test]
fn outputs_and_inputs_are_used_by_name_as_by_number() {
    let body = "set lamp high toggle lamp; wait until input ready low for up to 2 s";
    with_statements(body, |statements| {
        let names = statements.iter().map(|statement| match statement {
            StatementKind::Primitive(
                Primitive::Set { bit, .. } | Primitive::Toggle { bit, .. },
            ) => signal(bit.value),
            StatementKind::WaitUntil { input, .. } => signal(input.value),
            other => panic!("{other:?}"),
        });
        assert_eq!(names.collect::<Vec<_>>(), ["lamp", "lamp", "ready"]);
    });
    assert_eq!(expression("input ready and not input 3"), "(input ready And (Not input 3))");
}

#[test]
fn each_file_of_several_is_read_alone() {
    let mut sources = obverse_syntax::sources::Sources::one("a", "var a = 1 // {");
    sources.add("b", "\u{FEFF}var b = 2");
    sources.add("c", "sequence c {");
    let parsed = [0, 1, 2].map(|file| obverse_syntax::parse_file(&sources, file));
    let [Item::Variable(b)] = &parsed[1].program.items[..] else { panic!("{parsed:?}") };
    assert_eq!(&sources.whole()[b.name.span.start as usize..b.name.span.end as usize], "b");
    assert_eq!((parsed[0].diagnostics.len(), parsed[1].diagnostics.len()), (0, 0));
    let [unclosed] = &parsed[2].diagnostics[..] else { panic!("{parsed:?}") };
    assert_eq!(sources.locate(unclosed.primary.span).file, 2);
    assert_eq!(sources.locate(unclosed.labels[0].span).file, 2);
}

#[test]
fn an_advanced_move_has_a_counterpart_and_a_way_back() {
    let text = "advanced move in1 { distance 1 mm x opposite force in reverse } reverse out1";
    let Item::AdvancedMove(guarded) = item(text) else { panic!() };
    assert_eq!(guarded.counterpart.map(|name| name.value), Some("out1"));
    assert!(matches!(guarded.clauses[1].value, MoveClause::OppositeForce));
    let text = "advanced move in1 { distance 1 mm x in tcp }";
    let Item::AdvancedMove(guarded) = item(text) else { panic!() };
    assert!(guarded.counterpart.is_none());
}

#[test]
fn an_io_operation_has_primitives_and_a_counterpart() {
    let Item::Io(io) = item("io open { set 0 low; toggle 3 sleep 0.5 s } reverse close") else {
        panic!()
    };
    assert_eq!((io.name.value, io.counterpart.map(|name| name.value)), ("open", Some("close")));
    let [
        Primitive::Set { bit, high: false, .. },
        Primitive::Toggle { bit: toggled, .. },
        Primitive::Sleep { duration, .. },
    ] = &io.primitives[..]
    else {
        panic!("{:?}", io.primitives)
    };
    let signals = [signal(bit.value), signal(toggled.value)];
    assert_eq!((signals, show(duration)), (["0", "3"].map(str::to_owned), "0.5s".to_owned()));
}

#[test]
fn a_joint_configuration_has_values_and_a_unit() {
    let Item::Joints(joints) = item("joints start = [1, -2.5, 3 deg] rad") else { panic!() };
    assert_eq!(
        (joints.name.value, joints.values.unit.map(|unit| unit.value)),
        ("start", Some("rad"))
    );
    let elements: Vec<String> = joints.values.elements.iter().map(show).collect();
    assert_eq!(elements, ["1", "(Negate 2.5)", "3.0deg"]);
}

#[test]
fn an_item_has_keyframes() {
    let source = "item peg { keyframe a = [0, 0, 20] mm [0, 180, 0] deg keyframe b = [1] }";
    let Item::ItemDeclaration(peg) = item(source) else { panic!() };
    let [a, b] = &peg.keyframes[..] else { panic!() };
    let unit = |vector: &Vector<'_>| vector.unit.map(|unit| unit.value.to_owned());
    assert_eq!(unit(&a.position).as_deref(), Some("mm"));
    assert_eq!(a.rotation.as_ref().and_then(unit).as_deref(), Some("deg"));
    assert_eq!((b.name.value, &b.rotation, unit(&b.position)), ("b", &None, None));
}

fn error_clauses(source: &str) -> Vec<ErrorClause<'_>> {
    let Item::Error(error) = item(source) else { panic!("{source}") };
    assert_eq!(error.name.value, "e");
    error.clauses.into_iter().map(|clause| clause.value).collect()
}

#[test]
fn an_error_has_clauses() {
    let clauses = error_clauses(
        "error e { severity fatal; otherwise stop respond at once then restart program }",
    );
    assert_eq!(
        clauses,
        [
            ErrorClause::Severity(Severity::Fatal),
            ErrorClause::Otherwise(Otherwise::Stop),
            ErrorClause::Respond(Respond::AtOnce),
            ErrorClause::Then(Continuation::Program),
        ]
    );
    let clauses = error_clauses(
        "error e { severity warning severity recoverable otherwise operator
           respond after current action respond after current sequence
           then return to action then return to sequence then continue then stop }",
    );
    assert_eq!(
        clauses,
        [
            ErrorClause::Severity(Severity::Warning),
            ErrorClause::Severity(Severity::Recoverable),
            ErrorClause::Otherwise(Otherwise::Operator),
            ErrorClause::Respond(Respond::AfterAction),
            ErrorClause::Respond(Respond::AfterSequence),
            ErrorClause::Then(Continuation::Action),
            ErrorClause::Then(Continuation::Sequence),
            ErrorClause::Then(Continuation::NextAction),
            ErrorClause::Then(Continuation::Stop),
        ]
    );
}

#[test]
fn a_recovery_has_depth_extent_and_changes() {
    let recovery = |source: &'static str| {
        let source = format!("error e {{ recover {source} }}");
        let clauses = error_clauses(&source);
        let [ErrorClause::Recover(recovery)] = &clauses[..] else { panic!("{source}") };
        match recovery {
            Recovery::Using(name) => format!("using {}", name.value),
            Recovery::Reversing { depth, extent, changes } => {
                let extent = match extent {
                    Extent::Actions(count) => format!("{} actions", count.value),
                    Extent::Checkpoint(name) => format!("checkpoint {}", name.value),
                    Extent::Sequence => "sequence".to_owned(),
                };
                let changes = changes.iter().map(|change| match &change.value {
                    Change::Perturbed(by) => format!(", perturbed {}", show(by)),
                    Change::Slower => ", slower".to_owned(),
                    Change::Lighter => ", lighter".to_owned(),
                });
                format!("{depth:?} {extent}{}", changes.collect::<String>())
            }
        }
    };
    assert_eq!(recovery("using fetch"), "using fetch");
    assert_eq!(recovery("by reversing 1 action"), "Fixed 1 actions");
    assert_eq!(
        recovery("by reversing escalating up to 4 actions, perturbed 1 mm, slower, lighter"),
        "Escalating 4 actions, perturbed 1.0mm, slower, lighter"
    );
    assert_eq!(recovery("by reversing learned up to 2 actions"), "Learned 2 actions");
    assert_eq!(recovery("by reversing to checkpoint here"), "Fixed checkpoint here");
    assert_eq!(recovery("by reversing to start of sequence, slower"), "Fixed sequence, slower");
    assert_eq!(recovery("by reversing escalating up to start of sequence"), "Escalating sequence");
}

#[test]
fn an_advanced_move_has_clauses() {
    let source = "advanced move insert {
        requires holding  distance 300 mm forward in tcp  stop if force > 5 N  speed very slow
        succeeds if distance > 200 mm
        on success { return to initial position }
        on failure { repeat with perturbation 3 times; repeat with perturbation 2 mm 4 times
                     throw lost } }";
    let Item::AdvancedMove(advanced) = item(source) else { panic!() };
    let clauses: Vec<MoveClause<'_>> =
        advanced.clauses.into_iter().map(|clause| clause.value).collect();
    let [
        MoveClause::Requires(requires),
        MoveClause::Distance { distance, heading, frame },
        MoveClause::StopIf(stop),
        MoveClause::Speed(SpeedWord::VerySlow),
        MoveClause::SucceedsIf(succeeds),
        MoveClause::OnSuccess(on_success),
        MoveClause::OnFailure(on_failure),
    ] = &clauses[..]
    else {
        panic!("{clauses:?}")
    };
    assert_eq!(show(requires), "holding");
    assert_eq!((show(distance).as_str(), heading.value), ("300.0mm", Heading::Forward));
    assert_eq!(frame.map(|frame| frame.value), Some(FrameWord::Tcp));
    assert_eq!(show(stop), "(force Greater 5.0N)");
    assert_eq!(show(succeeds), "(distance Greater 200.0mm)");
    assert_eq!(on_success[0].value, Behaviour::ReturnToInitialPosition);
    let behaviours: Vec<String> = on_failure
        .iter()
        .map(|behaviour| match &behaviour.value {
            Behaviour::ReturnToInitialPosition => "return".to_owned(),
            Behaviour::RepeatWithPerturbation { within, times } => {
                format!("{:?} {}", within.as_ref().map(show), times.value)
            }
            Behaviour::Throw(name) => format!("throw {}", name.value),
        })
        .collect();
    assert_eq!(behaviours, ["None 3", "Some(\"2.0mm\") 4", "throw lost"]);
}

#[test]
fn a_variable_may_name_its_type() {
    let Item::Variable(variable) = item("var gap: length = 3 mm") else { panic!() };
    assert_eq!(variable.type_name.map(|name| name.value), Some("length"));
    let Item::Variable(variable) = item("var gap = 3 mm") else { panic!() };
    assert_eq!(variable.type_name, None);
}

#[test]
fn a_sequence_or_action_has_parameters() {
    let Item::Sequence(action) = item("action pick(part: item, by: length) { break }") else {
        panic!()
    };
    let parameters: Vec<_> =
        action.parameters.iter().map(|one| (one.name.value, one.type_name.value)).collect();
    assert!(action.is_action);
    assert_eq!(parameters, [("part", "item"), ("by", "length")]);
    for source in ["sequence main { }", "sequence main() { }"] {
        let Item::Sequence(sequence) = item(source) else { panic!() };
        assert!(!sequence.is_action && sequence.parameters.is_empty());
    }
}

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
        ("a = 1 a += 2 a -= 3", "a:Set:1 a:Add:2 a:Subtract:3"),
        ("while a { break }", "while:a{break}"),
        ("while a entered when b { }", "while:a:b{}"),
        ("repeat 3 times { break }", "repeat:3{break}"),
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

#[test]
fn the_example_is_read_whole() {
    let names = items(include_str!("example.obv")).len();
    assert_eq!(names, 11);
}
