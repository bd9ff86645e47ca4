//! One tree of all files of a program: each import gives way to the declarations that it stands
//! for. It knows neither how files are found nor what declarations mean.

use crate::load::Loaded;
use obverse_syntax::ast::{Item, Program};
use obverse_syntax::{LeftOut, Parsed, parse_file};

/// The tree of a program, and what is wrong with its files.
pub(crate) fn parse(loaded: &Loaded) -> Parsed<'_> {
    let sources = &loaded.sources;
    let mut diagnostics = loaded.diagnostics.clone();
    // What could not be imported may declare anything.
    let mut left_out = (!diagnostics.is_empty()).then(LeftOut::endless);
    let mut files: Vec<Option<Vec<Item<'_>>>> = Vec::with_capacity(sources.len());
    for file in 0..sources.len() {
        let parsed = parse_file(sources, file);
        diagnostics.extend(parsed.diagnostics);
        left_out = match (left_out, parsed.left_out) {
            (Some(one), Some(other)) => Some(one.and(other)),
            (one, other) => one.or(other),
        };
        files.push(Some(parsed.program.items));
    }
    let mut program = Program::default();
    put(0, loaded, &mut files, &mut program);
    Parsed { program, diagnostics, left_out }
}

/// Put the declarations of a file behind those before it, unless they are there already. Recurses
/// no deeper than files import one another.
fn put<'s>(
    file: usize,
    loaded: &Loaded,
    files: &mut [Option<Vec<Item<'s>>>],
    program: &mut Program<'s>,
) {
    let Some(items) = files.get_mut(file).and_then(Option::take) else { return };
    if !items.iter().any(|item| matches!(item, Item::Import(_))) && program.items.is_empty() {
        program.items = items;
        return;
    }
    for item in items {
        match item {
            Item::Import(import) => {
                // What could not be imported has been reported.
                if let Some(&imported) = loaded.imported.get(&import.path.span.start) {
                    put(imported, loaded, files, program);
                }
                program.items.push(Item::Import(import));
            }
            item => program.items.push(item),
        }
    }
}
