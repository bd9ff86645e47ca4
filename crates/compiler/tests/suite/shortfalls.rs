//! Warnings where an error asks for a reversal that cannot be had.

use obverse_compiler::compile;
use obverse_syntax::source::LineIndex;

/// The errors that the programs here raise, and what each asks for.
const ERRORS: &str = "\
error one { recover by reversing 1 actions then return to action }
error two { recover by reversing escalating up to 2 actions then return to action }
error begin { recover by reversing to start of sequence then return to action }
error late { recover by reversing to start of sequence respond after current sequence }
error ready { recover by reversing to checkpoint ready then return to action }
sequence glue { barrier \"glued\" }
";

/// The warnings of a program, each with its primary line, message, and the lines of its labels.
/// Lines are those of the program without the errors before it.
#[track_caller]
fn check(program: &str, expected: &[&str]) {
    let source = format!("{ERRORS}{program}");
    let index = LineIndex::new(&source);
    let first = ERRORS.lines().count() as u32;
    let line = |at: u32| index.position(at).line.saturating_sub(first).to_string();
    let compiled = compile("test.obv", &source);
    assert!(compiled.module.is_some(), "{:?}", compiled.diagnostics);
    let warnings = compiled.diagnostics.iter().filter(|one| one.code.as_str().starts_with("W04"));
    let told = warnings.map(|warning| {
        let labels: Vec<String> =
            warning.labels.iter().map(|label| line(label.span.start)).collect();
        let (_, what) = warning.message.split_once("going back ").unwrap_or_default();
        let place = line(warning.primary.span.start);
        format!("{} {place}: {what} [{}]", warning.code, labels.join(" "))
    });
    assert_eq!(told.collect::<Vec<_>>(), expected, "{program}");
}

#[test]
fn so_many_actions() {
    check(
        "sequence main {\ncheckpoint ready\ncall glue\nif input 0 { throw one }\n\
         wait 1 s\nif input 1 { throw one }\nif input 2 { throw two }\n\
         wait 2 s\nif input 3 { throw two }\n}",
        &[
            "W0401 4: 1 action, and may be stopped before the first [3 0 0]",
            "W0401 7: 2 actions, and may be stopped after 1 [3 0 0]",
        ],
    );
}

#[test]
fn actions_of_those_that_called_count_too() {
    check(
        "sequence work { if input 1 { throw two } wait 1 s if input 2 { throw two } }\n\
         sequence main {\ncheckpoint ready\ncall glue\ncall work\n}",
        &["W0401 1: 2 actions, and may be stopped after 1 [5 4 0 0]"],
    );
}

#[test]
fn the_start_of_the_sequence() {
    check(
        "sequence work { wait 1 s if input 2 { throw begin } }\n\
         sequence main {\ncheckpoint ready\ncall work\ncall glue\ncall work\nthrow begin\n}",
        &["W0401 7: to the start of the sequence, and is stopped before that [5 0 0]"],
    );
}

#[test]
fn an_advanced_move_is_of_the_sequence_that_it_stands_in() {
    check(
        "advanced move push { distance 9 mm down in base on failure { throw begin } }\n\
         sequence main {\ncheckpoint ready\ncall glue\nadvance push\n}",
        &["W0401 1: to the start of the sequence, and is stopped before that [5 4 0 0]"],
    );
}

#[test]
fn what_is_responded_to_after_the_sequence_goes_back_from_its_end() {
    check(
        "sequence work {\nif input 2 { throw late }\nbarrier \"drilled\"\n}\n\
         sequence main {\ncheckpoint ready\ncall work\n}",
        &["W0401 2: to the start of the sequence, and is stopped before that [3 0]"],
    );
}

#[test]
fn to_a_checkpoint() {
    check("sequence main { checkpoint ready wait 1 s throw ready }", &[]);
    check(
        "sequence main {\ncheckpoint ready\nif input 1 { call glue }\nthrow ready\n}",
        &["W0401 4: to checkpoint `ready`, and may be stopped before that [3 0 0]"],
    );
    check(
        "sequence main {\nif input 1 { checkpoint ready }\nthrow ready\n}",
        &["W0402 3: to checkpoint `ready`, which is not on every way here [0]"],
    );
    check(
        "sequence main {\nif input 1 { throw ready }\ncheckpoint ready\n}",
        &["W0403 2: to checkpoint `ready`, which is on no way here [0]"],
    );
}

#[test]
fn a_checkpoint_in_the_caller_will_do() {
    check(
        "sequence work { throw ready }\nsequence main { call glue checkpoint ready call work }",
        &[],
    );
}

#[test]
fn a_barrier_that_is_passed_over_in_reverse_stops_nothing() {
    check("sequence main { checkpoint ready skip in reverse { wait 1 s } throw begin }", &[]);
}

/// One that the workcell raises is gone back for where it is responded to: behind the operation or
/// the advanced move that has met it, in the sequence that does it, and in the cleanup.
#[test]
fn an_error_that_a_fault_raises() {
    let stuck = "error stuck { on protective stop recover by reversing to start of sequence }\n";
    let slipped = "error slipped { on collision recover by reversing 2 actions }\n";
    check(&format!("{stuck}sequence main {{ checkpoint ready toggle 1 call glue }}"), &[]);
    check(
        &format!(
            "{stuck}io grip {{ set 0 high }}\n\
             sequence main {{ checkpoint ready\ncall glue\nio grip\n}}"
        ),
        &["W0401 5: to the start of the sequence, and is stopped before that [4 0 1]"],
    );
    check(
        &format!(
            "{stuck}{slipped}advanced move push {{ distance 9 mm down in base }}\n\
             sequence main {{ checkpoint ready\nwait 1 s\ncall glue\nadvance push\n}}"
        ),
        &[
            "W0401 7: to the start of the sequence, and is stopped before that [6 0 1]",
            "W0401 7: 2 actions, and may be stopped after 1 [6 0 2]",
        ],
    );
    check(
        &format!(
            "{stuck}sequence main {{ checkpoint ready }}\ncleanup {{\nbarrier \"b\"\nset 0 low\n}}"
        ),
        &["W0401 5: to the start of the sequence, and is stopped before that [4 1]"],
    );
}
