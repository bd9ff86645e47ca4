//! Forks: what branches may not share and how that is explained, their code, their way out.

use crate::common::{check_code, findings, function, module};
use crate::diagnostics::check;
use obverse_compiler::compile;
use obverse_isa::{CounterId, Instr};

/// The labels of the only diagnostic, the primary one first.
fn reasons(source: &str) -> Vec<String> {
    let diagnostics = compile("test.obv", source).diagnostics;
    let [only] = diagnostics.as_slice() else { panic!("{diagnostics:#?}") };
    let labels = std::iter::once(&only.primary).chain(&only.labels);
    labels.map(|label| label.text.clone()).collect()
}

#[test]
fn each_device_is_of_one_branch() {
    let uses = [
        "move 1 mm up",
        "advance _probe",
        "position _here",
        "speed slow { wait 1 s }",
        "tool probe",
        "wait 1 s * (force / 1 N)",
        "if distance > 1 mm { wait 1 s }",
        "while holding { wait 1 s }",
    ];
    for first in uses {
        for second in uses {
            let source = format!(
                "advanced move _probe {{ distance 2 mm down }}
                 sequence main {{ fork {{ {first} }} and {{ {second} }} }}"
            );
            let found = findings(&source);
            assert_eq!(found.len(), 1, "{first} and {second}: {found:?}");
            assert!(found[0].starts_with("E0603"), "{first} and {second}: {found:?}");
        }
    }
}

#[test]
fn what_branches_share_is_found_beside_other_mistakes() {
    let mistakes = [
        ("fork { wait 1 s }", "E0601"),
        ("fork { return } and { wait 1 s }", "E0602"),
        ("call nowhere", "E0101"),
        ("wait 3", "E0203"),
        ("advance broken", "E0209"),
    ];
    for (mistake, code) in mistakes {
        let source = format!(
            "advanced move broken {{ }}
             sequence main {{
               {mistake}
               if holding {{ advance broken }}
               fork {{ set 1 high }} and {{ set 1 low }}
               var n = 0
               fork {{ n = 1 }} and {{ n = 2 }}
               if n > 0 {{ wait 1 s }}
             }}"
        );
        let found = findings(&source);
        let has = |code: &str| found.iter().any(|one| one.starts_with(code));
        let is_all = has("E0603") && has("E0604") && (has(code) || code == "E0209");
        assert!(is_all, "{mistake}: {found:#?}");
    }
}

#[test]
fn inputs_and_reading_are_shared() {
    check(
        "var n = 1
sequence main {
  var k = 2
  fork { if input 1 { repeat n times { toggle 1 } } repeat k times { toggle 2 } }
  and { if input 1 { repeat n times { toggle 3 } } repeat k times { toggle 4 } }
}",
        &[],
    );
}

#[test]
fn variables_of_a_call_are_its_own() {
    check(
        "action count(most: int) { var n = 0 while n < most { n += 1 } }
sequence main { fork { var n = 1 call count(n) n = 2 } and { var n = 1 call count(n) n += 2 } }",
        &[],
    );
}

#[test]
fn what_runs_after_one_another_is_not_shared() {
    check("sequence main { fork { set 1 high } and { set 2 high } set 1 low set 2 low }", &[]);
    check(
        "sequence main {
  fork { fork { set 1 high } and { set 2 high } set 1 low } and { set 3 low }
}",
        &[],
    );
}

#[test]
fn an_inner_fork_is_of_its_branch() {
    check(
        "sequence main { fork { fork { set 1 high } and { set 2 high } } and { set 2 low } }",
        &[r#"E0603 1:71 "set 2 low""#],
    );
}

#[test]
fn the_chain_of_reasons_is_the_shortest() {
    let source = "
error jam { recover by reversing 1 action otherwise using clear }
sequence clear { toggle 1 }
action long_way { call feed }
action feed { throw jam }
sequence main { fork { toggle 1 } and { call long_way call feed } }";
    assert_eq!(
        reasons(source),
        [
            "branch 2 calls `feed`",
            "branch 1 uses output 1",
            "`feed` recovers using `clear`",
            "`clear` uses output 1 for branch 2",
            "the fork begins here",
        ]
    );
}

#[test]
fn what_is_run_in_reverse_counts() {
    let source = "
io on { set 1 high } reverse off
io off { set 2 low }
sequence main { fork { io on } and { toggle 2 } }";
    assert_eq!(reasons(source)[1], "branch 1 takes this back by `off`");
    let source =
        "sequence main { fork { do { toggle 1 } in reverse { toggle 2 } } and { toggle 2 } }";
    assert_eq!(
        reasons(source)[1..3],
        [
            "branch 1 takes this back by the block in reverse",
            "the block in reverse uses output 2 for branch 1"
        ]
    );
}

#[test]
fn recursion_is_followed_once() {
    check(
        "action a(n: int) { if n > 0 { call b(n - 1) } toggle 1 }
action b(n: int) { call a(n) }
sequence main { fork { call a(3) } and { call b(3) } }",
        &[r#"E0603 3:42 "call b(3)""#],
    );
}

#[test]
fn a_fork_that_never_ends_is_followed_by_nothing() {
    check(
        "sequence main { fork { loop { toggle 1 wait 1 s } } and { toggle 2 } wait 1 s }",
        &[r#"W0002 1:70 "wait 1 s""#],
    );
}

#[test]
fn the_position_named_last_is_that_of_the_branch_that_moves() {
    check(
        "joints a = [0, -90, 90, -90, -90, 0] deg
joints b = [9, -90, 90, -90, -90, 0] deg
sequence main {
  move to a
  fork { toggle 1 } and { move to b reversible always move to a reversible always }
  move to b reversible always
  fork { toggle 1 } and { move to a move 2 mm up }
  move to b reversible always
}",
        &[r#"E0401 8:13 "reversible always""#],
    );
}

#[test]
fn branches_follow_one_another() {
    check_code(
        "sequence main { fork { toggle 1 } and { toggle 2 } and { toggle 3 } }",
        "main",
        "enter
         fork +9
         push.const 0.0
         output.toggle 1
         fork.next
         push.const 0.0
         output.toggle 2
         fork.next
         push.const 0.0
         output.toggle 3
         fork.join -9
         return",
    );
}

/// The counters of the loops of a function, in the order of the code.
fn counters(source: &str) -> Vec<u8> {
    let module = module(source);
    let main = function(&module, "main");
    let code = &module.code[main.first as usize..main.end as usize];
    let counter = |instr: &Instr| match instr {
        Instr::ForEnter { counter: CounterId(counter), .. } => Some(*counter),
        _ => None,
    };
    code.iter().filter_map(counter).collect()
}

#[test]
fn branches_share_no_counter() {
    let source = "sequence main {
  repeat 2 times { repeat 2 times { wait 1 s } }
  repeat 2 times {
    fork {
      repeat 2 times { toggle 1 } repeat 2 times { toggle 1 }
    } and {
      repeat 2 times { fork { repeat 2 times { toggle 2 } } and { repeat 2 times { toggle 3 } } }
    } and {
      repeat 2 times { toggle 4 }
    }
    repeat 2 times { wait 1 s }
  }
  repeat 2 times { wait 1 s }
}";
    assert_eq!(counters(source), [0, 1, 0, 1, 1, 2, 3, 4, 5, 1, 0]);
}

#[test]
fn branches_share_no_hidden_local() {
    let wait = |bit: u8| {
        format!("wait until input {bit} high for up to 1 s else {{ toggle {bit} }} ").repeat(2)
    };
    let source = format!(
        "sequence main {{ {} fork {{ {} }} and {{ {} }} {} }}",
        wait(1),
        wait(2),
        wait(3),
        wait(4)
    );
    let module = module(&source);
    let local = |instr: &Instr| match instr {
        Instr::WaitInput { local, .. } => Some(local.0),
        _ => None,
    };
    let locals: Vec<u8> = module.code.iter().filter_map(local).collect();
    assert_eq!(locals, [0, 0, 0, 0, 1, 1, 0, 0]);
}

#[test]
fn a_frame_that_is_too_small_for_all_branches_is_refused() {
    let nest =
        |bit: usize| format!("{} toggle {bit} {}", "repeat 2 times { ".repeat(6), "} ".repeat(6));
    let branches: Vec<String> = (0..16).map(|bit| format!("{{ {} }}", nest(bit))).collect();
    check(
        &format!("sequence main {{ fork {} }}", branches.join(" and ")),
        &[r#"E0310 1:10 "main""#],
    );
}

#[test]
fn a_branch_that_nothing_leaves_has_no_way_out() {
    let leaves = |source: &str| {
        let leaves = |instr: &&Instr| matches!(instr, Instr::ForkLeave { .. });
        module(source).code.iter().filter(leaves).count()
    };
    let errors = "error dead { severity fatal } error noted { severity warning }
action fails { if input 1 { throw dead } } action notes { if input 1 { throw noted } }";
    let with = |branch: &str| {
        leaves(&format!(
            "{errors} sequence main {{
               fork {{ {branch} }} and {{ toggle 1 }} call fails call notes
             }}"
        ))
    };
    assert_eq!(with("toggle 2"), 0);
    assert_eq!(with("call notes if input 2 { throw noted }"), 0);
    assert_eq!(with("if input 2 { throw dead }"), 1);
    assert_eq!(with("call fails"), 1);
    assert_eq!(with("fork { call fails } and { toggle 3 }"), 2);
}

#[test]
fn what_a_held_branch_was_in_is_put_right() {
    let put_right = |held: &str| {
        let module = module(&format!(
            "error dead {{ severity fatal }}
             advanced move slowly {{ distance 2 mm down speed slow }}
             action weld {{ irreversible \"welded\" {{ set 5 high wait 1 s set 5 low }} }}
             sequence main {{
               fork {{ {held} }} and {{ if input 1 {{ throw dead }} }}
               advance slowly call weld
             }}"
        ));
        let main = function(&module, "main");
        let code = &module.code[main.first as usize..main.end as usize];
        let join = code.iter().position(|instr| matches!(instr, Instr::ForkJoin { .. }));
        let behind = code.iter().skip(join.expect("a join"));
        let settings = behind.clone().filter(|one| matches!(one, Instr::SettingSet { .. })).count();
        let barriers = behind.filter(|one| matches!(one, Instr::Irreversible { .. })).count();
        (settings, barriers)
    };
    assert_eq!(put_right("toggle 1"), (0, 0));
    assert_eq!(put_right("speed fast { move 1 mm up }"), (1, 0));
    assert_eq!(put_right("advance slowly"), (1, 0));
    assert_eq!(put_right("tool probe { speed fast { move 1 mm up } }"), (2, 0));
    assert_eq!(put_right("call weld"), (0, 1));
}

#[test]
fn forks_that_call_too_much_are_refused_once() {
    let mut source = "sequence s0 { toggle 1 }\n".to_owned();
    for index in 1..4000 {
        let branch = format!("call s{}", index - 1);
        source += &format!("sequence s{index} {{ fork {{ {branch} }} and {{ wait 1 s }} }}\n");
    }
    let found = findings(&(source + "sequence main { call s3999 }"));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("E0310"), "{found:?}");
}
