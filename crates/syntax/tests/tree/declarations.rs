//! What stands at the top of a file.

use super::*;

#[test]
fn a_cell_is_a_path() {
    let Item::Cell(path) = item("cell \"peg in hole.toml\"") else { panic!() };
    assert_eq!(path.value, "peg in hole.toml");
}

#[test]
fn an_import_is_a_path() {
    let Item::Import(path) = item("import \"poses/left.obv\"") else { panic!() };
    assert_eq!(path.path.value, "poses/left.obv");
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
                    Change::Perturbed { within, at_random } => {
                        let how = if *at_random { " at random" } else { "" };
                        format!(", perturbed{how} {}", show(within))
                    }
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
    assert_eq!(
        recovery("by reversing escalating doubling up to 8 actions, perturbed at random 1 mm"),
        "Doubling 8 actions, perturbed at random 1.0mm"
    );
    assert_eq!(recovery("by reversing 2 actions, perturbed at"), "Fixed 2 actions, perturbed at");
    assert_eq!(recovery("by reversing to checkpoint here"), "Fixed checkpoint here");
    assert_eq!(recovery("by reversing to start of sequence, slower"), "Fixed sequence, slower");
    assert_eq!(recovery("by reversing escalating up to start of sequence"), "Escalating sequence");
}

#[test]
fn an_error_names_faults_and_what_an_incident_may_cost() {
    let clauses = |source: &str| {
        let source = format!("error e {{ {source} }}");
        format!("{:?}", error_clauses(&source))
    };
    for fault in FaultWord::ALL {
        let clauses = clauses(&format!("on missing, {}", fault.text()));
        assert!(clauses.contains(&format!("value: {fault:?}, span")), "{clauses}");
    }
    let source = "error e { on input door low, force > 30 N, input 3 high, collision }";
    let clauses_of = error_clauses(source);
    let [ErrorClause::On(causes)] = &clauses_of[..] else { panic!("{clauses_of:?}") };
    let [
        Cause::Input { input, high, .. },
        Cause::Force(force),
        Cause::Input { .. },
        Cause::Fault(_),
    ] = &causes[..]
    else {
        panic!("{causes:?}")
    };
    assert_eq!((input.value, *high), (Signal::Name("door"), false));
    assert_eq!(show(force), "30.0N");
    let bounds = "error e { give up after 6 times, 90 s, limit * 2 }";
    let clauses = error_clauses(bounds);
    let [ErrorClause::GiveUp(bounds)] = &clauses[..] else { panic!("{clauses:?}") };
    let [Bound::Attempts(times), Bound::Cost(time), Bound::Cost(limit)] = &bounds[..] else {
        panic!("{bounds:?}")
    };
    assert_eq!(times.value, 6);
    assert_eq!((show(time).as_str(), show(limit).as_str()), ("90.0s", "(limit Multiply 2)"));
}

#[test]
fn what_cleans_up_is_a_block() {
    let Item::Cleanup(cleanup) = item("cleanup { io open; move to home }") else { panic!() };
    assert_eq!(cleanup.body.statements.len(), 2);
}

#[test]
fn an_advanced_move_has_clauses() {
    let source = "advanced move insert {
        requires holding else throw lost  distance 300 mm forward in tcp
        stop if force > 5 N  speed very slow
        succeeds if distance > 200 mm
        on success { return to initial position }
        on failure { repeat with perturbation 3 times; repeat with perturbation 2 mm 4 times
                     throw lost } }";
    let Item::AdvancedMove(advanced) = item(source) else { panic!() };
    let clauses: Vec<MoveClause<'_>> =
        advanced.clauses.into_iter().map(|clause| clause.value).collect();
    let [
        MoveClause::Requires { condition: requires, otherwise: Some(otherwise) },
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
    assert_eq!((show(requires).as_str(), otherwise.value), ("holding", "lost"));
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
