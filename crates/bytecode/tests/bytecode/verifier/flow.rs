//! Rules 5, 6 and 8: joins, counted loops, blocks.

use super::{LOOP, LOOP_1, accepted, module, refused, refused_among, refuses, start};
use obverse_bytecode::verify::Rule;
use obverse_bytecode::{Variable, verify};
use obverse_isa::Type;

#[test]
fn rule_5_jumps_and_joins_name_each_other() {
    let nameless = "which does not name it";
    // Both halves say so, each of the other; the first comes first.
    refuses(
        "jump #2\n land #4\n jump #4\n land #3",
        Rule::Joins,
        1,
        "it names instruction 2, which",
    );
    refuses("push.local b\n jump.if #3\n add.local.imm n, 1", Rule::Joins, 2, nameless);
    refuses("add.local.imm n, 1\n join #1", Rule::Joins, 2, nameless);
    refuses("join #1", Rule::Joins, 1, nameless);
    // Two jumps to one join.
    refuses(
        "push.local b\n jump.if #5\n push.local b\n jump.if #5\n join #2",
        Rule::Joins,
        4,
        nameless,
    );
    // Two jumps, or two joins, that name each other.
    refuses(
        "push.local b\n jump.if #4\n push.local b\n jump.if #2",
        Rule::Joins,
        2,
        "do not go together",
    );
    refuses("join #2\n join #1", Rule::Joins, 1, "join and join do not go together");
}

#[test]
fn rule_5_jumps_stay_in_their_function() {
    let text = |first: &str, second: &str| {
        let start = format!(".function f start\nenter\n{first}\nhalt\n");
        module(&format!("obvasm 1\n{start}.function g io\nenter\n{second}\nreturn"))
    };
    let other = "it names an instruction of another function";
    refused(text("join #4", "jump #1\nland #5"), Rule::Joins, Some(1), other);
    let both = verify(text("join #4", "join #1")).unwrap_err();
    let places: Vec<_> = both.iter().map(|error| (error.pc, error.why.as_str())).collect();
    assert_eq!(places, [(Some(1), other), (Some(4), other)]);
}

#[test]
fn rule_5_loop_instructions_go_with_each_other() {
    let apart = "do not go together";
    // A plain jump to a loop's join, and a loop's jump to a plain join.
    refused_among("jump #2\n for.top 0, #1", Rule::Joins, 1, apart);
    refused_among("push.local b\n jump.if #3\n for.exit 0, #2", Rule::Joins, 2, apart);
    refused_among("join #2\n for.next 0, #1", Rule::Joins, 1, apart);
    refused_among("push.int 1\n push.int 2\n for.enter 0, #4\n join #3", Rule::Joins, 3, apart);
    // The counters differ.
    refused_among(&LOOP.replace("for.next 0", "for.next 1"), Rule::Joins, 4, apart);
    refused_among(&LOOP.replace("for.exit 0", "for.exit 1"), Rule::Joins, 3, apart);
    // `for.enter` with `for.top`, `for.next` with `for.exit`.
    refused_among(
        "push.int 1\n push.int 2\n for.enter 0, #4\n for.top 0, #3",
        Rule::Joins,
        3,
        apart,
    );
    refused_among("for.next 0, #2\n for.exit 0, #1", Rule::Joins, 1, apart);
}

#[test]
fn rule_5_land_follows_what_never_falls_through() {
    let land = "land can only follow what never falls through";
    let other = "only land can follow what never falls through";
    refuses("push.local b\n jump.if #3\n land #2", Rule::Joins, 3, land);
    refuses("push.local b\n jump.if #4\n add.local.imm n, 1\n land #2", Rule::Joins, 4, land);
    refuses("jump #2\n join #1", Rule::Joins, 2, other);
    refuses("jump #3\n add.local.imm n, 1\n join #1", Rule::Joins, 2, other);
    refuses("a: join b\n b: jump a", Rule::Joins, 3, other);
}

#[test]
fn rule_6_loops_have_their_order() {
    let top = "for.top does not follow for.enter";
    let body = LOOP.replace("t: for.top", "add.local.imm n, 1\nt: for.top");
    refuses(&body, Rule::Loops, 3, top);
    let last = verify(start(&body)).unwrap_err();
    assert!(last.iter().any(|error| error.pc == Some(5) && error.why == top), "{last:?}");
    // Next to `for.enter`, of the other counter.
    let crossed = LOOP.replace("for.top 0", "for.top 1").replace("for.next 0", "for.next 1");
    refused_among(&crossed, Rule::Loops, 3, top);
    refused_among(&crossed, Rule::Loops, 4, top);
    let next = "for.next does not end the innermost loop";
    refuses(&LOOP.replace("d: for.exit", "add.local.imm n, 1\nd: for.exit"), Rule::Loops, 6, next);
    let inside = LOOP
        .replace("add.local.imm n, 1", "a: block.begin")
        .replace("d: for", "block.skip a\nd: for");
    refused_among(&inside, Rule::Loops, 6, next);
    refused_among("for.next 0, #2\n for.exit 0, #1", Rule::Loops, 1, next);
}

#[test]
fn rule_6_loops_nest() {
    // Two loops that cross: the outer one ends within the inner one.
    let crossing = "push.int 1\n push.int 2\n for.enter 0, d\n t: for.top 0\n push.int 1\n \
         push.int 2\n \
                    for.enter 1, dd\n tt: for.top 1\n for.next 0, t\n d: for.exit 0\n \
                    for.next 1, tt\n dd: for.exit 1";
    refuses(crossing, Rule::Loops, 9, "for.next does not end the innermost loop");
    let reused = LOOP.replace(
        "add.local.imm n, 1",
        &LOOP_1.replace(" 1,", " 0,").replace("top 1", "top 0").replace("exit 1", "exit 0"),
    );
    refuses(&reused, Rule::Loops, 7, "the counter is that of a loop around this one");
    // The end of a loop that is not the innermost one, without `for.next`.
    let ends = "it does not end the innermost loop, block or branch";
    refused_among(
        "push.int 1\n push.int 2\n for.enter 0, #5\n a: block.begin\n for.exit 0, #3\n \
         block.skip a",
        Rule::Loops,
        5,
        ends,
    );
    refused_among("for.exit 0, #1", Rule::Loops, 1, ends);
    refused_among(
        "push.int 1\n push.int 2\n for.enter 0, #4",
        Rule::Loops,
        3,
        "the loop, block or fork has no end",
    );
}

#[test]
fn rule_6_nothing_jumps_into_a_loop() {
    let into = "it jumps into a loop, block or branch from outside";
    let before = LOOP.replace("add.local.imm n, 1", "x: join");
    refuses(&format!("push.local b\n jump.if x\n{before}"), Rule::Loops, 2, into);
    refuses(&format!("{before}\n push.local b\n jump.if x"), Rule::Loops, 9, into);
    // From one loop into another.
    let from = LOOP_1.replace("add.local.imm m, 1", "push.local b\n jump.if x");
    refuses(&format!("{from}{before}"), Rule::Loops, 6, into);
    // From a loop into one within it.
    let inner = LOOP_1.replace("add.local.imm m, 1", "x: join");
    let outer = LOOP.replace("add.local.imm n, 1", &format!("push.local b\n jump.if x\n{inner}"));
    refuses(&outer, Rule::Loops, 6, into);
}

#[test]
fn rule_8_blocks_nest() {
    let ends = "it does not end the innermost loop, block or branch";
    let none = "the loop, block or fork has no end";
    refuses("block.skip #1", Rule::Blocks, 1, ends);
    refuses("block.begin\n block.skip #2", Rule::Blocks, 2, ends);
    refuses("block.begin\n block.replace plain, #0", Rule::Blocks, 2, ends);
    refuses("block.begin\n block.begin\n block.skip #1\n block.skip #2", Rule::Blocks, 3, ends);
    refuses("block.begin", Rule::Blocks, 1, none);
    refuses("block.begin\n block.begin\n block.skip #2", Rule::Blocks, 1, none);
    // A block that ends within a loop that begins within it.
    let crossing = LOOP.replace("add.local.imm n, 1", "block.skip a");
    refused_among(&format!("a: block.begin\n{crossing}"), Rule::Blocks, 6, ends);
    // A block's end of a loop's begin.
    refused_among(
        "push.int 1\n push.int 2\n for.enter 0, #4\n block.skip #3",
        Rule::Blocks,
        4,
        ends,
    );
}

#[test]
fn rule_8_nothing_jumps_into_or_out_of_a_block() {
    let into = "it jumps into a loop, block or branch from outside";
    refuses(
        "push.local b\n jump.if x\n a: block.begin\n x: join\n block.skip a",
        Rule::Blocks,
        2,
        into,
    );
    refuses(
        "a: block.begin\n x: join\n block.skip a\n push.local b\n jump.if x",
        Rule::Blocks,
        5,
        into,
    );
    let out = "it jumps out of a block with a reverse of its own";
    refuses(
        "a: block.begin\n push.local b\n jump.if x\n block.skip a\n x: join",
        Rule::Blocks,
        3,
        out,
    );
    refuses(
        "x: join\n a: block.begin\n push.local b\n jump.if x\n block.replace plain, a",
        Rule::Blocks,
        4,
        out,
    );
    // Out of a loop within a block, and out of both.
    let inner = LOOP.replace("add.local.imm n, 1", "push.local b\n jump.if x");
    refuses(&format!("a: block.begin\n{inner}\n block.skip a\n x: join"), Rule::Blocks, 7, out);
    accepted(start(&format!("a: block.begin\n{inner}\n x: join\n block.skip a")));
}

#[test]
fn rule_8_what_takes_a_blocks_place_begins_with_the_locals_around_it() {
    let why = "has for parameters the first locals of the function around the block";
    // An integer and a real, where two integers are.
    refuses("block.begin\n block.replace helper, #1", Rule::Blocks, 2, why);
    refuses("checkpoint begun\n block.begin\n block.replace helper, #2", Rule::Blocks, 3, why);
    let with_locals = |locals: &str| {
        let mut module = start("block.begin\n block.replace helper, #1");
        let types = locals.split_whitespace().map(|name| match name {
            "int" => Type::Int,
            _ => Type::Real,
        });
        let local = |of_type| Variable { name: format!("{of_type}"), of_type, measures: None };
        module.functions[0].locals = types.map(local).collect();
        module
    };
    accepted(with_locals("int real"));
    accepted(with_locals("int real real"));
    refused(with_locals("int"), Rule::Blocks, Some(2), why);
    refused(with_locals("real int"), Rule::Blocks, Some(2), why);
    refused(with_locals(""), Rule::Blocks, Some(2), why);
}

#[test]
fn rule_8_nesting_is_bounded() {
    let nested = |depth: usize| {
        let ends: String = (1..=depth).rev().map(|at| format!("block.skip #{at}\n")).collect();
        format!("{}{ends}", "block.begin\n".repeat(depth))
    };
    accepted(start(&nested(256)));
    refused_among(&nested(257), Rule::Blocks, 258, "loops, blocks and forks nest deeper than 256");
}

/// A fork of two branches, with what stands in each.
fn fork(first: &str, second: &str) -> String {
    format!("f: fork j\n {first}\n fork.next\n {second}\n j: fork.join f")
}

#[test]
fn rule_10_forks_nest() {
    let ends = "it does not end the innermost loop, block or branch";
    refuses("fork.next", Rule::Tasks, 1, ends);
    refuses("f: fork j\n block.begin\n j: fork.join f", Rule::Tasks, 3, ends);
    refuses("f: fork j\n a: block.begin\n fork.next\n j: fork.join f", Rule::Tasks, 3, ends);
    let within = "a: block.begin\n f: fork j\n block.skip a\n j: fork.join f";
    refused_among(within, Rule::Blocks, 3, ends);
    let many = "fork.next\n ".repeat(16);
    let branches = "a fork has more than 16 branches";
    refuses(&format!("f: fork j\n {many}j: fork.join f"), Rule::Tasks, 17, branches);
}

#[test]
fn rule_10_nothing_jumps_into_or_out_of_a_branch() {
    let into = "it jumps into a loop, block or branch from outside";
    let out = "it jumps out of a branch";
    let jump = "push.local b\n jump.if x";
    refuses(&format!("{jump}\n {}", fork("x: join", "")), Rule::Tasks, 2, into);
    refuses(&format!("{}\n x: join", fork(jump, "")), Rule::Tasks, 3, out);
    refuses(&fork(jump, "x: join"), Rule::Tasks, 3, out);
}

#[test]
fn rule_10_who_leaves_names_the_join_of_the_innermost_fork() {
    let wrong = "it does not name the join of the innermost fork around it";
    let leave = |to: &str| format!("push.local b\n jump.if x\n fork.leave {to}\n x: land");
    refuses(&format!("{}\n {}", fork("", ""), leave("j")), Rule::Tasks, 6, wrong);
    let inner = format!("g: fork k\n {}\n k: fork.join g", leave("j"));
    refuses(&fork(&inner, ""), Rule::Tasks, 5, wrong);
    let block = format!("a: block.begin\n {}\n block.skip a", leave("j"));
    refuses(&fork(&block, ""), Rule::Tasks, 5, wrong);
}

#[test]
fn rule_10_loops_of_two_branches_have_counters_of_their_own() {
    let same = "a loop of this branch has the counter of one of a branch before";
    let again = LOOP_1.replace(" 1,", " 0,").replace("top 1", "top 0").replace("exit 1", "exit 0");
    let branches = fork(LOOP, &again);
    refuses(&branches, Rule::Tasks, 17, same);
    accepted(start(&fork(LOOP, LOOP_1)));
}
