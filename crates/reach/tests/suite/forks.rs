//! What is said of points in branches of forks, and behind their joins.

use crate::common::{START, of_main, point, said, verified};
use obverse_isa::Instr;
use obverse_reach::{Horizon, Link, Reach, ShortfallKind, shortfalls};

#[test]
fn a_barrier_in_one_branch_may_lie_behind_the_others() {
    of_main(
        r#"
        begin: fork end
        checkpoint before
        barrier "glued"
        checkpoint after
        fork.next
        checkpoint beside
        end: fork.join begin
        checkpoint behind
        "#,
        &[
            ("before", &["start"]),
            ("after", &["glued"]),
            ("beside", &["start", "glued"]),
            // Both branches have been run through.
            ("behind", &["glued"]),
        ],
    );
}

#[test]
fn what_a_branch_has_run_itself_hides_what_was_before_the_fork_and_not_the_others() {
    of_main(
        r#"
        barrier "before"
        begin: fork end
        barrier "own"
        checkpoint own
        fork.next
        barrier "other"
        fork.next
        checkpoint third
        end: fork.join begin
        checkpoint behind
        "#,
        &[
            ("own", &["own", "other"]),
            ("third", &["before", "own", "other"]),
            ("behind", &["own", "other"]),
        ],
    );
}

#[test]
fn what_was_before_the_fork_stops_if_nothing_in_any_branch_does() {
    let of_branch = |barrier: &str| {
        format!(
            r#"
            barrier "before"
            begin: fork end
                push.bool true
            split: jump.unless other
            barrier "perhaps"
            other: join split
            fork.next
            {barrier}
            end: fork.join begin
            checkpoint behind
            "#
        )
    };
    of_main(&of_branch(""), &[("behind", &["before", "perhaps"])]);
    of_main(&of_branch("barrier \"surely\""), &[("behind", &["perhaps", "surely"])]);
}

#[test]
fn who_leaves_does_not_know_how_far_the_others_came() {
    of_main(
        r#"
        begin: fork end
            push.bool true
        split: jump.if stay
        fork.leave end
        stay: land split
        barrier "own"
        fork.next
        barrier "other"
        end: fork.join begin
        checkpoint behind
        "#,
        &[("behind", &["start", "own", "other"])],
    );
    // From behind a barrier of its own, what was before the fork is out of the question.
    of_main(
        r#"
        begin: fork end
        barrier "own"
            push.bool true
        split: jump.if stay
        fork.leave end
        stay: land split
        fork.next
        barrier "other"
        end: fork.join begin
        checkpoint behind
        "#,
        &[("behind", &["own", "other"])],
    );
}

#[test]
fn calls_in_branches_are_looked_into_and_out_of() {
    said(
        &format!(
            r#"{START}
            .function "main" sequence
            enter
            begin: fork end
            call fetch
            fork.next
            checkpoint beside
            call press
            checkpoint after
            end: fork.join begin
            return
            .function "fetch" sequence
            enter
            barrier "fetched"
            checkpoint inner
            return
            .function "press" sequence
            enter
            call deep
            return
            .function "deep" sequence
            enter
            barrier "pressed"
            checkpoint deep
            return"#
        ),
        &[
            ("inner", &["fetched", "pressed"]),
            ("beside", &["start", "fetched"]),
            ("after", &["fetched", "pressed"]),
            ("deep", &["fetched", "pressed"]),
        ],
    );
}

#[test]
fn only_branches_of_the_innermost_fork_take_turns() {
    of_main(
        r#"
        outer: fork end
        inner: fork met
        barrier "own"
        checkpoint own
        fork.next
        checkpoint beside
        met: fork.join inner
        checkpoint behind
        fork.next
        barrier "outer"
        end: fork.join outer
        "#,
        &[
            ("own", &["own"]),
            // The other branch of the outer fork may have had turns before the inner one began,
            ("beside", &["start", "own", "outer"]),
            // and has them again behind it.
            ("behind", &["own", "outer"]),
        ],
    );
}

#[test]
fn a_block_is_run_in_one_turn() {
    of_main(
        r#"
        begin: fork end
        within: block.begin
        barrier "within"
        checkpoint within
        block.skip within
        fork.next
        checkpoint beside
        end: fork.join begin
        checkpoint behind
        "#,
        &[("within", &["within"]), ("beside", &["start"]), ("behind", &["start"])],
    );
}

/// One branch sets the flag and acts, the other asks for it.
#[test]
fn a_flag_may_be_altered_while_other_branches_have_their_turns() {
    let of_branch = |act: &str| {
        format!(
            r#"
            .const real 0.5
            .global "flag" bool
            {START}
            .function "main" sequence
            enter
            begin: fork end
                push.global flag
            unset: jump.unless on
            barrier "flag"
            on: join unset
            checkpoint on
            fork.next
                push.bool true
            store.global flag
            {act}
                push.bool false
            store.global flag
            end: fork.join begin
            return"#
        )
    };
    said(&of_branch("push.const 0.5\n wait"), &[("on", &["start", "flag"])]);
    // Without the act, no turn ends while it is set.
    said(&of_branch(""), &[("on", &["start"])]);
}

#[test]
fn the_way_tells_of_the_fork_and_the_calls() {
    let program = verified(
        &(START.to_owned()
            + r#"
            .checkpoint "here"
            .function "main" sequence
            enter
            begin: fork end
            call glue
            fork.next
            call look
            end: fork.join begin
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
    let code = &program.module().code;
    let at = |is_it: fn(&Instr) -> bool| -> Vec<u32> {
        (0..code.len() as u32).filter(|&pc| is_it(&code[pc as usize])).collect()
    };
    let calls = at(|instr| matches!(instr, Instr::Call { .. }));
    let fork = at(|instr| matches!(instr, Instr::Fork { .. }))[0];
    let barrier = at(|instr| matches!(instr, Instr::Barrier { .. }))[0];
    let reach = Reach::of(program.module());
    let way = reach.way(point(&program, "here"), Horizon::Never(barrier)).expect("a way");
    let links = [Link::CalledFrom(calls[2]), Link::Beside(fork), Link::Within(calls[1])];
    assert_eq!(way.links, links);
}

/// Of the error that `main` raises: whether its reversal is surely stopped, may be, or is not.
#[track_caller]
fn stopped(extent: &str, body: &str) -> Option<bool> {
    let text = format!(
        r#"
        .error "jam" recoverable
            .recover reversing fixed {extent}
            .otherwise stop
            .respond after_action
            .then sequence
        .checkpoint "ready"
        {START}
        .function "main" sequence
        enter
        {body}
        return"#
    );
    let found = shortfalls(verified(&text).module());
    match &found[..] {
        [] => None,
        [one] => match one.kind {
            ShortfallKind::Stopped { is_certain, .. } => Some(is_certain),
            ref other => panic!("{other:?}"),
        },
        more => panic!("{more:?}"),
    }
}

#[test]
fn a_reversal_out_of_a_branch_may_be_stopped_by_another() {
    let branches = |before: &str, own: &str, other: &str| {
        format!(
            "checkpoint ready\n {before}\n begin: fork end\n {own}\n error.raise jam\n \
             fork.next\n {other}\n end: fork.join begin"
        )
    };
    let barrier = "barrier \"glued\"";
    for extent in ["sequence", "checkpoint ready", "actions 1"] {
        assert_eq!(stopped(extent, &branches("", "", "")), None, "{extent}");
        assert_eq!(stopped(extent, &branches("", "", barrier)), Some(false), "{extent}");
    }
    for extent in ["sequence", "checkpoint ready"] {
        assert_eq!(stopped(extent, &branches("", barrier, "")), Some(true), "{extent}");
        assert_eq!(stopped(extent, &branches(barrier, "", "")), Some(true), "{extent}");
    }
}
