//! The language server on a file of 5,000 lines: from a key stroke to what is wrong with the text,
//! and the questions that editors ask behind it. A stroke changes the text in its middle, so that
//! nothing is known of it.

use criterion::{Criterion, criterion_group, criterion_main};
use lsp_types::{Position, Range, TextDocumentContentChangePartial, Uri};
use obverse_lsp::{NoDisk, Workspace};
use obverse_testkit::large;

const LINES: usize = 5_000;

/// Where a key is pressed: at the end of a line of a station in the middle.
fn place(text: &str) -> Position {
    let middle = text.lines().count() / 2;
    let mut lines = text.lines().enumerate().skip(middle);
    let (line, text) = lines.find(|(_, line)| line.contains("attempts += 1")).expect("a station");
    Position::new(line as u32, text.len() as u32)
}

/// A letter more, or the letter taken back.
fn stroke(workspace: &mut Workspace, uri: &Uri, at: Position, is_typed: bool) {
    let end = Position::new(at.line, at.character + u32::from(!is_typed));
    let text = if is_typed { "0" } else { "" }.to_owned();
    let change =
        TextDocumentContentChangePartial { text, range: Range::new(at, end), ..Default::default() };
    workspace.change(uri, 2, vec![change.into()]);
}

fn editor(criterion: &mut Criterion) {
    let text = large::program(LINES);
    let at = place(&text);
    let uri = Uri("file:///line.obv".to_owned());
    let mut workspace = Workspace::new(Box::new(NoDisk));
    workspace.open(uri.clone(), 1, text.clone());
    let mut group = criterion.benchmark_group("editor");
    let mut is_typed = false;
    group.bench_function("key_stroke_to_diagnostics", |bencher| {
        bencher.iter(|| {
            is_typed = !is_typed;
            stroke(&mut workspace, &uri, at, is_typed);
            let found = workspace.diagnostics();
            assert!(found[0].2.is_empty(), "{:?}", found[0].2.first());
        });
    });
    // What follows a letter of a word that is not finished: a mistake of grammar.
    let slip = Position::new(at.line, 2);
    let mut is_broken = false;
    group.bench_function("key_stroke_to_mistake", |bencher| {
        bencher.iter(|| {
            is_broken = !is_broken;
            stroke(&mut workspace, &uri, slip, is_broken);
            assert_eq!(workspace.diagnostics()[0].2.is_empty(), !is_broken);
        });
    });
    if is_broken {
        stroke(&mut workspace, &uri, slip, false);
    }
    let all = Range::new(Position::new(0, 0), Position::new(u32::MAX, 0));
    group.bench_function("hints", |bencher| {
        bencher.iter(|| assert!(!workspace.hints(&uri, all).is_empty()));
    });
    group.bench_function("lenses", |bencher| {
        bencher.iter(|| assert!(!workspace.lenses(&uri).is_empty()));
    });
    group.bench_function("tokens", |bencher| {
        bencher.iter(|| assert!(workspace.tokens(&uri).is_some()));
    });
    group.bench_function("hover", |bencher| {
        let name = Position::new(at.line, at.character - 6);
        bencher.iter(|| workspace.hover(&uri, name));
    });
    group.bench_function("completion", |bencher| {
        bencher.iter(|| assert!(!workspace.completion(&uri, slip).items.is_empty()));
    });
}

criterion_group!(benches, editor);
criterion_main!(benches);
