//! The law of `reversible always`: wherever the compiler lets it be said, the move goes back to
//! where the arm was, bit for bit. Each move to a joint configuration says so that may.

use crate::laws::agrees_backward_on;
use crate::programs::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_compiler::compile;
use obverse_syntax::ast::{Block, Item, StatementKind, Target};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Severity;
use obverse_syntax::parse;
use std::collections::BTreeSet;

const WORDS: &str = " reversible always";

/// A program of which every move is reversible always that may be goes back through the states that
/// it came through.
///
/// # Errors
/// Those of the randomness.
pub fn always_leads_where_the_arm_was(u: &mut Unstructured<'_>) -> Result<bool> {
    let source = programs::generate(u, Options { allow_overrides: false, ..Options::default() })?;
    let (source, moves) = with_always(&source);
    Ok(agrees_backward_on(&source, u.arbitrary()?) && moves > 0)
}

/// A program with the words after every move that may have them, and how many did not have them
/// before.
fn with_always(source: &str) -> (String, usize) {
    let program = parse(source).program;
    let is_joints = |name: &str| {
        let declares =
            |item: &Item<'_>| matches!(item, Item::Joints(one) if one.name.value == name);
        program.items.iter().any(declares)
    };
    let mut ends = BTreeSet::new();
    for item in &program.items {
        if let Item::Sequence(sequence) = item {
            collect(&sequence.body, &is_joints, &mut ends);
        }
    }
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

/// Where the moves to joint configurations end that do not have the words.
fn collect(block: &Block<'_>, is_joints: &impl Fn(&str) -> bool, ends: &mut BTreeSet<u32>) {
    for statement in &block.statements {
        if let StatementKind::Move { target: Target::Named(name), always: None, .. } =
            &statement.kind
            && is_joints(name.value)
        {
            ends.insert(statement.span.end);
        }
        statement.blocks().into_iter().for_each(|block| collect(block, is_joints, ends));
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
