//! The law of `reversible always`: wherever the compiler lets it be said, the move goes back to
//! where the arm was, bit for bit. Each move to a joint configuration says so that may.

use crate::laws::agrees_backward_on;
use crate::programs::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_compiler::compile;
use obverse_syntax::ast::{Block, Item, Program, StatementKind, Target};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Severity;
use obverse_syntax::parse;
use obverse_syntax::span::Span;
use std::collections::BTreeSet;

const WORDS: &str = " reversible always";

/// A program whose moves mostly go to joint configurations, each of them reversible always if it
/// may be, goes back through the states that it came through.
///
/// # Errors
/// Those of the randomness.
pub fn always_leads_where_the_arm_was(u: &mut Unstructured<'_>) -> Result<bool> {
    let source = programs::generate(u, Options { allow_overrides: false, ..Options::default() })?;
    let (source, moves) = with_always(&to_joints(&source));
    Ok(agrees_backward_on(&source, u.arbitrary()?) && moves > 0)
}

/// A program of which three moves in four go to joint configurations by name, in turn.
fn to_joints(source: &str) -> String {
    let program = parse(source).program;
    let joints: Vec<&str> = program
        .items
        .iter()
        .filter_map(|item| match item {
            Item::Joints(joints) => Some(joints.name.value),
            _ => None,
        })
        .collect();
    let mut spans = Vec::new();
    each_move(&program, &mut |_, span| spans.push(span));
    let mut text = source.to_owned();
    for (index, span) in spans.into_iter().enumerate().rev() {
        if let Some(name) = joints.get(index % joints.len().max(1))
            && index % 4 != 3
        {
            text.replace_range(span.start as usize..span.end as usize, &format!("move to {name}"));
        }
    }
    text
}

/// A program with the words after every move that may have them, and after how many.
fn with_always(source: &str) -> (String, usize) {
    let program = parse(source).program;
    let is_joints = |name: &str| {
        let declares =
            |item: &Item<'_>| matches!(item, Item::Joints(one) if one.name.value == name);
        program.items.iter().any(declares)
    };
    let mut ends = BTreeSet::new();
    each_move(&program, &mut |kind, span| {
        if let StatementKind::Move { target: Target::Named(name), always: None, .. } = kind
            && is_joints(name.value)
        {
            ends.insert(span.end);
        }
    });
    // Where the position named last is not known, the words are left out again.
    loop {
        let (text, places) = inserted(source, &ends);
        let found = compile("program.obv", &text).diagnostics;
        let errors = found.iter().filter(|found| found.severity == Severity::Error);
        let refused: Vec<u32> = errors
            .map(|error| {
                assert_eq!(error.code, Code::NoNamedPosition, "{error:?}\n{text}");
                let start = error.primary.span.start - 1;
                let index = places.iter().position(|place| *place == start);
                *ends.iter().nth(index.expect("words that were added")).expect("a place")
            })
            .collect();
        if refused.is_empty() {
            return (text, ends.len());
        }
        refused.iter().for_each(|end| _ = ends.remove(end));
    }
}

/// Every move of a program, in the order of its text.
fn each_move(program: &Program<'_>, visit: &mut impl FnMut(&StatementKind<'_>, Span)) {
    fn each_in(block: &Block<'_>, visit: &mut impl FnMut(&StatementKind<'_>, Span)) {
        for statement in &block.statements {
            if matches!(statement.kind, StatementKind::Move { .. }) {
                visit(&statement.kind, statement.span);
            }
            statement.blocks().into_iter().for_each(|block| each_in(block, visit));
        }
    }
    for item in &program.items {
        if let Item::Sequence(sequence) = item {
            each_in(&sequence.body, visit);
        }
    }
}

/// A text with the words at these places, and where they are then.
fn inserted(source: &str, ends: &BTreeSet<u32>) -> (String, Vec<u32>) {
    let (mut text, mut places, mut from) = (String::new(), Vec::new(), 0);
    for &end in ends {
        text.push_str(&source[from..end as usize]);
        places.push(text.len() as u32);
        text.push_str(WORDS);
        from = end as usize;
    }
    text.push_str(&source[from..]);
    (text, places)
}
