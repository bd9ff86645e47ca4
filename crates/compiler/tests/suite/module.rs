//! What a module holds beside its code: tables, errors with their defaults, the source map.

use crate::common::{function, module};
use obverse_bytecode::{
    ActionKind, Continuation, Depth, Extent, FunctionKind, Module, Otherwise, Pattern,
    Perturbation, Recovery, Respond, Reversal, Severity,
};
use std::f64::consts::FRAC_PI_2;

#[test]
fn declarations_become_tables_in_si_units() {
    let module = module(
        r#"
        cell "cells/peg.toml"
        joints start = [0 rad, -90 deg, 90 deg, -90 deg, -90 deg, 0.5 rad]
        item peg { keyframe grasp = [1, 2, 300] mm [0, 180, 0] deg
                   keyframe above = [1 m, 2 cm, 3 um] }
        var gap = 2 mm + 1 mm
        sequence main { tool gripper move to start checkpoint here barrier "glued" move gap up }
        "#,
    );
    assert_eq!(module.cell.as_deref(), Some("cells/peg.toml"));
    let joints = [0.0, -FRAC_PI_2, FRAC_PI_2, -FRAC_PI_2, -FRAC_PI_2, 0.5];
    assert_eq!(module.joints, [("start".to_owned(), joints)]);
    let [grasp, above] = module.items[0].keyframes[..] else { panic!("two keyframes") };
    assert_eq!(grasp.position_m, [0.001, 0.002, 0.3]);
    assert_eq!(grasp.rotation_rad, [0.0, 2.0 * FRAC_PI_2, 0.0]);
    assert_eq!((above.position_m, above.rotation_rad), ([1.0, 0.02, 3e-6], [0.0; 3]));
    assert_eq!(module.keyframes, ["grasp", "above"]);
    assert_eq!(
        (&module.tools[..], &module.checkpoints[..]),
        (&["gripper".to_owned()][..], &["here".to_owned()][..])
    );
    assert_eq!(module.reasons, ["glued"]);
    assert_eq!(module.globals[0].name, "gap");
}

#[test]
fn an_error_has_its_defaults() {
    let module = module(
        "error plain { }
         error noted { severity warning }
         error fixed { recover using fix }
         error last { severity fatal }
         sequence fix { wait 1 s }
         sequence main { throw noted if holding { throw fixed }
           if input 1 { throw last } throw plain }",
    );
    let kinds = module.errors.iter().map(|error| {
        assert_eq!((error.otherwise, error.respond), (Otherwise::Stop, Respond::AfterAction));
        (error.severity, error.recovery.clone(), error.continuation)
    });
    let fix =
        module.functions.iter().position(|function| function.name == "fix").map(|at| at as u16);
    let expected = [
        (Severity::Recoverable, Recovery::None, Continuation::Stop),
        (Severity::Warning, Recovery::None, Continuation::NextAction),
        (Severity::Recoverable, Recovery::Using(fix.expect("it is there")), Continuation::Sequence),
        (Severity::Fatal, Recovery::None, Continuation::Stop),
    ];
    assert_eq!(kinds.collect::<Vec<_>>(), expected);
}

#[test]
fn a_policy_of_reversal_is_kept_for_whoever_drives_the_machine() {
    let module = module(
        "error e {
           recover by reversing learned to checkpoint ready, perturbed 1 mm, slower
           otherwise operator  respond at once  then return to action
         }
         error f { recover by reversing 3 actions, lighter }
         error g { recover by reversing escalating to start of sequence }
         sequence main {
           checkpoint ready if holding { throw e } if input 1 { throw f } throw g
         }",
    );
    let plain = Reversal {
        depth: Depth::Learned,
        extent: Extent::Checkpoint(0),
        perturbation: Some(Perturbation { limit_m: 0.001, pattern: Pattern::Spiral }),
        slower: true,
        lighter: false,
    };
    let [e, f, g] = &module.errors[..] else { panic!("three errors") };
    assert_eq!(e.recovery, Recovery::Reversing(plain));
    assert_eq!((e.otherwise, e.respond), (Otherwise::Operator, Respond::AtOnce));
    assert_eq!(e.continuation, Continuation::Action);
    let Recovery::Reversing(fixed) = f.recovery else { panic!("by reversing") };
    assert_eq!((fixed.depth, fixed.extent), (Depth::Fixed, Extent::Actions(3)));
    assert_eq!((fixed.perturbation, fixed.slower, fixed.lighter), (None, false, true));
    let Recovery::Reversing(escalating) = g.recovery else { panic!("by reversing") };
    assert_eq!(
        (escalating.depth, escalating.extent),
        (Depth::Escalating { doubling: false }, Extent::Sequence)
    );
}

#[test]
fn functions_are_of_their_kind_and_the_last_sequence_is_the_main_one() {
    let module = module(
        "io open { set 0 low }
         advanced move go { distance 1 mm x }
         action pick(n: int) { repeat n times { position here move to here } }
         sequence last { io open advance go call pick(2) do { wait 1 s } in reverse { wait 2 s } }",
    );
    let kinds: Vec<(&str, FunctionKind)> =
        module.functions.iter().map(|function| (function.name.as_str(), function.kind)).collect();
    let expected = [
        ("$start", FunctionKind::Start),
        ("open", FunctionKind::Io),
        ("go", FunctionKind::AdvancedMove),
        ("pick", FunctionKind::Action),
        ("last", FunctionKind::Sequence),
        ("last$reverse0", FunctionKind::Replacement),
    ];
    assert_eq!(kinds, expected);
    let pick = function(&module, "pick");
    assert_eq!((pick.parameters, pick.counters, &pick.slots[..]), (1, 1, &["here".to_owned()][..]));
}

/// The actions of the source map: line and kind.
fn actions(module: &Module) -> Vec<(usize, ActionKind)> {
    let entries = module.source_map.iter().filter_map(|entry| Some((entry.first, entry.action?)));
    entries
        .map(|(first, action)| (module.place_of(first).expect("it is in the map").1, action))
        .collect()
}

#[test]
fn the_source_map_tells_which_statements_are_actions() {
    let module = module(
        "io open { set 0 low }
advanced move go { distance 1 mm x on failure { return to initial position throw jam } }
error jam { recover using fix then return to action }
joints a = [0, 0, 0, 0, 0, 0] deg
sequence fix { move to a }
sequence main {
  move to a
  advance go
  call fix
  io open
  set 1 high
  wait 1 s
  wait until input 1 high for up to 1 s
  var n = 1
  if n > 0 {
    move to a
  }
}",
    );
    let expected = [
        (5, ActionKind::Move),
        (7, ActionKind::Move),
        (8, ActionKind::Advance),
        (9, ActionKind::Call),
        (10, ActionKind::Io),
        (11, ActionKind::Primitive),
        (12, ActionKind::Wait),
        (13, ActionKind::Wait),
        (16, ActionKind::Move),
    ];
    assert_eq!(actions(&module), expected);
}

#[test]
fn an_action_that_is_done_again_begins_where_the_map_says() {
    let module = module(
        "error jam { recover using fix then return to action }
         advanced move go { distance 1 mm x on failure { throw jam } }
         sequence fix { wait 1 s }
         sequence main { advance go }",
    );
    let main = function(&module, "main");
    let advance = module
        .source_map
        .iter()
        .find(|entry| entry.action == Some(ActionKind::Advance))
        .expect("there is an advance");
    let instr = module.code[advance.first as usize];
    assert_eq!(instr.info().mnemonic, "call");
    let before = module.code[advance.first as usize - 1];
    assert_eq!(before.info().mnemonic, "join");
    assert!((main.first..main.end).contains(&advance.first));
}

#[test]
fn every_instruction_has_a_place_in_its_own_function() {
    let source = "\
io open { set 0 low }
sequence main {
  var n = 1
  while n < 9 {
    n += 1
  }
}
";
    let module = module(source);
    let line = |pc: u32| module.place_of(pc).map(|(_, line, _)| line);
    let open = function(&module, "open");
    assert!((open.first..open.end).all(|pc| line(pc) == Some(1)));
    let main = function(&module, "main");
    let lines: Vec<_> = (main.first..main.end).filter_map(line).collect();
    // enter; store; join and test; update; jump back and land; return.
    assert_eq!(lines, [2, 3, 3, 4, 4, 5, 6, 6, 7]);
}
