//! The place of an action in words that a person knows it by, and that memories are kept under.

use obverse_bytecode::{Module, SourceEntry};
use std::collections::BTreeSet;

/// The place of an instruction in words that stay the same when lines are added: the function, what
/// it says there, and which of those in it that say the same.
#[must_use]
pub fn place(module: &Module, pc: u32) -> String {
    let function = module.function_at(pc).map(|index| &module.functions[index]);
    let name = function.map_or("", |function| &function.name);
    let Some(entry) = module.source_at(pc) else { return name.to_owned() };
    let text = |entry| text_of(module, entry);
    let said = text(entry).unwrap_or_default();
    let first = function.map_or(0, |function| function.first);
    let before: BTreeSet<(u16, u32)> = module
        .source_map
        .iter()
        .filter(|other| (first..entry.first).contains(&other.first) && other.action.is_some())
        .filter(|other| (other.file, other.start) != (entry.file, entry.start))
        .filter(|other| text(other).as_deref() == Some(&said))
        .map(|other| (other.file, other.start))
        .collect();
    match before.len() {
        0 => format!("{name}: {said}"),
        count => format!("{name}: {said} ({})", count + 1),
    }
}

/// Whether a program has a place of these words.
#[must_use]
pub fn has_place(module: &Module, words: &str) -> bool {
    let is_it = |entry: &SourceEntry| {
        let said = text_of(module, entry).unwrap_or_default();
        words.contains(&said) && place(module, entry.first) == words
    };
    let is_name = module.functions.iter().any(|function| function.name == words);
    is_name || module.source_map.iter().any(is_it)
}

/// What the source says at an entry: its first line, with single spaces.
fn text_of(module: &Module, entry: &SourceEntry) -> Option<String> {
    let file = module.sources.get(usize::from(entry.file))?;
    let text = file.text.get(entry.start as usize..entry.end as usize)?;
    let words: Vec<&str> = text.lines().next()?.split_whitespace().collect();
    Some(words.join(" "))
}
