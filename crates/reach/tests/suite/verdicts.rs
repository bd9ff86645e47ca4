//! What is said of points of small modules. A point is a checkpoint, a horizon is the reason of a
//! barrier.

use crate::common::{START, of_main, of_main_with, point, said, verified};
use obverse_isa::Instr;
use obverse_reach::{Horizon, Link, MAX_KEPT, Reach, Standing};

#[test]
fn a_barrier_is_what_comes_after_it_ends_at() {
    of_main(
        r#"
        checkpoint a
        barrier "glued"
        checkpoint b
        irreversible "cut"
        checkpoint c
        "#,
        &[("a", &["start"]), ("b", &["glued"]), ("c", &["cut"])],
    );
}

#[test]
fn where_ways_meet_either_may_have_been_taken() {
    of_main(
        r#"
            push.bool true
        split: jump.unless other
        barrier "left"
        checkpoint left
        over: jump end
        other: land split
        checkpoint right
        end: join over
        checkpoint behind
        "#,
        &[("left", &["left"]), ("right", &["start"]), ("behind", &["start", "left"])],
    );
}

#[test]
fn a_loop_brings_back_what_its_last_round_has_left() {
    of_main(
        r#"
        top: join again
        checkpoint top
            push.bool true
        out: jump.if end
        checkpoint body
        barrier "drilled"
        checkpoint after
        again: jump top
        end: land out
        checkpoint end
        "#,
        &[
            ("top", &["start", "drilled"]),
            ("body", &["start", "drilled"]),
            ("after", &["drilled"]),
            ("end", &["start", "drilled"]),
        ],
    );
}

#[test]
fn a_call_adds_what_it_may_leave_and_keeps_what_it_may_not() {
    said(
        &format!(
            r#"{START}
            .function "main" sequence
            enter
            checkpoint a
            call perhaps
            checkpoint b
            call surely
            checkpoint c
            call nothing
            checkpoint d
            return
            .function "perhaps" sequence
            enter
                push.bool true
            split: jump.if end
            barrier "perhaps"
            over: jump out
            end: land split
            out: join over
            return
            .function "surely" sequence
            enter
            checkpoint inner
            barrier "surely"
            return
            .function "nothing" sequence
            enter
            checkpoint nothing
            return"#
        ),
        &[
            ("a", &["start"]),
            ("b", &["start", "perhaps"]),
            ("c", &["surely"]),
            ("d", &["surely"]),
            // What was there before the call.
            ("inner", &["start", "perhaps"]),
            ("nothing", &["surely"]),
        ],
    );
}

#[test]
fn functions_that_call_themselves_come_to_an_end() {
    said(
        &format!(
            r#"{START}
            .function "main" sequence
            enter
                push.bool true
            split: jump.if end
            call main
            checkpoint within
            barrier "deep"
            over: jump out
            end: land split
            checkpoint ground
            out: join over
            return"#
        ),
        &[("within", &["start", "deep"]), ("ground", &["start"])],
    );
}

#[test]
fn a_block_with_a_reverse_of_its_own_is_passed_over() {
    of_main(
        r#"
        barrier "before"
        begin: block.begin
        checkpoint a
        barrier "within"
        checkpoint b
        block.skip begin
        checkpoint c
        "#,
        &[("a", &["before"]), ("b", &["within"]), ("c", &["before"])],
    );
}

#[test]
fn what_replaces_a_block_goes_on_to_before_that_block() {
    said(
        &format!(
            r#"{START}
            .function "main" sequence
            enter
            barrier "before"
            begin: block.begin
            barrier "within"
            block.replace instead, begin
            checkpoint behind
            return
            .function "instead" sequence
            enter
            barrier "nothing is stopped by this"
            call part
            checkpoint instead
            return
            .function "part" sequence
            enter
            checkpoint part
            return"#
        ),
        &[("behind", &["before"]), ("instead", &["before"]), ("part", &["before"])],
    );
}

/// The compiler's own: a sequence that gives up sets a variable, and its caller looks at it.
#[test]
fn a_way_out_after_an_error_is_not_taken_for_the_way_on() {
    said(
        &format!(
            r#"
            .global "user" bool
            .global "$leaving" bool
            {START}
            .function "main" sequence
            enter
            call press
                push.global $leaving
            out: jump.if end
            checkpoint on
            over: jump behind
            end: land out
            checkpoint left
            behind: join over
            return
            .function "press" sequence
            enter
                push.bool true
            split: jump.if fails
            barrier "pressed"
            over: jump out
            fails: land split
                push.bool true
                store.global $leaving
            out: join over
            return"#
        ),
        &[("on", &["pressed"]), ("left", &["start"])],
    );
}

#[test]
fn what_is_never_come_to_has_no_horizon() {
    said(
        &format!(
            r#"{START}
            .function "main" sequence
            enter
            call endless
            checkpoint behind
            return
            .function "endless" sequence
            enter
            top: join again
            checkpoint within
                push.bool false
            out: jump.if end
            again: jump top
            end: land out
            call endless
            return
            .function "forgotten" sequence
            enter
            checkpoint forgotten
            return"#
        ),
        // The call of itself is never come back from, either.
        &[("within", &["start"]), ("behind", &[]), ("forgotten", &[])],
    );
}

#[test]
fn the_first_few_are_kept_and_all_can_be_asked_for() {
    let mut body = String::new();
    for index in 0..20 {
        body += &format!(
            "push.bool true\nsplit{index}: jump.if end{index}\nbarrier \"b{index}\"\n\
             over{index}: jump out{index}\nend{index}: land split{index}\n\
             out{index}: join over{index}\n"
        );
    }
    let text =
        format!("{START}.function \"main\" sequence\nenter\n{body}\ncheckpoint here\nreturn");
    let program = verified(&format!(".checkpoint \"here\"\n{text}"));
    let reach = Reach::of(program.module());
    let here = point(&program, "here");
    assert_eq!(reach.every(here).len(), 21);
    let verdict = reach.at(here);
    assert_eq!((verdict.horizons.len(), verdict.is_more), (MAX_KEPT, true));
}

#[test]
fn the_way_says_which_calls_are_crossed() {
    let program = verified(
        &(START.to_owned()
            + r#"
            .checkpoint "here"
            .function "main" sequence
            enter
            call glue
            call look
            return
            .function "glue" sequence
            enter
            barrier "glued"
            return
            .function "look" sequence
            enter
            checkpoint here
            return"#),
    );
    let reach = Reach::of(program.module());
    let code = &program.module().code;
    let calls: Vec<u32> = (0..code.len() as u32)
        .filter(|&pc| matches!(code[pc as usize], Instr::Call { .. }))
        .collect();
    let here = point(&program, "here");
    let [horizon] = reach.at(here).horizons[..] else { panic!("one horizon") };
    let way = reach.way(here, horizon).expect("a way");
    assert_eq!(way.links, [Link::CalledFrom(calls[2]), Link::Within(calls[1])]);
    assert_eq!(reach.way(here, Horizon::Start), None);
}

#[test]
fn a_statement_is_of_the_class_of_what_is_hardest_to_take_back_in_it() {
    let program = verified(
        &(START.to_owned()
            + r#"
            .function "main" sequence
            enter
            call nothing
            call records
            call glue
            begin: block.begin
            call glue
            block.skip begin
            return
            .function "nothing" sequence
            enter
            return
            .function "records" sequence
            .local "x" int
            enter
            return
            .function "glue" sequence
            enter
            barrier "glued"
            return"#),
    );
    let reach = Reach::of(program.module());
    let main = program.module().functions[1].first;
    let class = |from: u32, to: u32| reach.standing(main + from..main + to);
    assert_eq!(class(1, 2), Standing::Always);
    assert_eq!(class(2, 3), Standing::AfterForward);
    assert_eq!(class(3, 4), Standing::Never);
    assert_eq!(class(4, 7), Standing::Always, "passed over");
    assert_eq!(class(5, 6), Standing::Never, "from within the block");
}

#[test]
fn a_counted_loop_of_at_least_one_round_is_not_passed_by() {
    let counted = |first: i32, last: i32| {
        format!(
            r#"
                push.int {first}
                push.int {last}
            enter: for.enter 0, out
            top: for.top 0, next
            barrier "round"
            next: for.next 0, top
            out: for.exit 0, enter
            checkpoint behind
            "#
        )
    };
    of_main_with(".counters 1", &counted(1, 3), &[("behind", &["round"])]);
    of_main_with(".counters 1", &counted(2, 2), &[("behind", &["round"])]);
    of_main_with(".counters 1", &counted(3, 1), &[("behind", &["start", "round"])]);
}
