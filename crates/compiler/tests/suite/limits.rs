//! Programs that are too large are refused with a place, and those just small enough are not.

use crate::common::{findings, module};

fn repeated(count: usize, write: impl Fn(usize) -> String) -> String {
    (0..count).map(write).collect()
}

/// The codes and lines of the errors, without warnings.
fn errors(source: &str) -> Vec<String> {
    let found = findings(source).into_iter().filter(|finding| finding.starts_with('E'));
    found.map(|finding| finding.split(' ').take(2).collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn a_frame_has_room_for_256_words() {
    let program = |variables: usize, loops: usize| {
        let variables = repeated(variables, |n| format!("var x{n} = 1 "));
        format!(
            "sequence main {{ {}{variables}{} }}",
            "repeat 2 times { ".repeat(loops),
            "}".repeat(loops)
        )
    };
    module(&program(256, 0));
    assert_eq!(errors(&program(257, 0)), ["E0310 1:3239"]);
    module(&program(226, 10));
    assert_eq!(errors(&program(227, 10)).len(), 1);
}

#[test]
fn the_variables_that_errors_need_count() {
    let program = |variables: usize| {
        let variables = repeated(variables, |n| format!("var x{n} = 1 "));
        format!(
            "error jam {{ recover using fix then return to action }}
             sequence fix {{ wait 1 s }}
             sequence main {{ {variables} throw jam }}"
        )
    };
    module(&program(255));
    assert_eq!(errors(&program(256)), ["E0310 3:23"]);
}

#[test]
fn a_statement_computes_and_holds_so_much() {
    let sum = |terms: usize| {
        let terms = vec!["x"; terms].join(" + ");
        format!("sequence main {{ var x = 1 x = {terms} if x > 0 {{ wait 1 s }} }}")
    };
    module(&sum(100));
    assert_eq!(errors(&sum(101)), ["E0311 1:31"]);
    let call = |arguments: usize| {
        let parameters = repeated(arguments, |n| format!("a{n}: int,"));
        let arguments = "1, ".repeat(arguments);
        format!("action f({parameters}) {{ wait 1 s }}\nsequence main {{ call f({arguments}) }}")
    };
    module(&call(120));
    assert_eq!(errors(&call(121)), ["E0311 2:17"]);
    assert_eq!(errors(&call(256))[0], "E0310 1:8");
}

#[test]
fn nested_draws_stay_small() {
    let nested = format!("{}1.0{}", "random(".repeat(60), ", 2.0)".repeat(60));
    let module = module(&format!("sequence main {{ var x = {nested} if x > 1 {{ wait 1 s }} }}"));
    assert!(module.code.len() < 600, "{} instructions", module.code.len());
}

#[test]
fn tables_have_65535_entries() {
    let main = "sequence main { wait 1 s }\n";
    let items = repeated(65_536, |n| format!("item i{n} {{ }}\n"));
    assert_eq!(errors(&format!("{main}{items}")), ["E0310 65537:6"]);
    let sequences = repeated(65_540, |n| format!("sequence s{n} {{ }}\n"));
    assert_eq!(errors(&format!("{main}{sequences}")), ["E0310 65535:10"]);
}

#[test]
fn code_that_would_grow_without_measure_is_refused() {
    let declared = repeated(2000, |n| {
        format!("error e{n} {{ recover using fix respond after current sequence }}\n")
    });
    let thrown = repeated(2000, |n| format!("throw e{n} "));
    let program = format!(
        "{declared}sequence fix {{ wait 1 s }}
         sequence inner {{ {thrown} }}
         sequence main {{ {} }}",
        "call inner ".repeat(2000)
    );
    let found = errors(&program);
    assert_eq!(found.len(), 1);
    assert!(found[0].starts_with("E0310"), "{found:?}");
}

#[test]
fn positions_and_lines_are_counted() {
    let positions = repeated(257, |n| format!("position p{n} move to p{n} "));
    let found = errors(&format!("sequence main {{ {positions} }}"));
    assert_eq!(found.len(), 2, "the 257th, and the move to it: {found:?}");
    assert_eq!(errors("sequence main { set 65536 high }"), ["E0210 1:21"]);
    module("sequence main { set 65535 high }");
}

#[test]
fn the_frame_of_an_advanced_move_is_counted_too() {
    let program = |draws: usize| {
        let inputs = vec!["input 1"; 100].join(" and ");
        let [distance, limit] = [33, draws].map(|count| vec!["random(1, 2)"; count].join(" * "));
        format!(
            "advanced move go {{ requires {inputs} succeeds if {inputs}
               distance {distance} * 1 mm x stop if force > {limit} * 1 N
               on failure {{ repeat with perturbation 2 times }} }}
             sequence main {{ advance go }}"
        )
    };
    // 200 inputs, 47 draws, distance and limit, two results, two offsets, three for the counter.
    module(&program(14));
    assert_eq!(errors(&program(15)), ["E0310 3:29"]);
}
