//! What the source says at an instruction, and where, for a line of text.

use super::instruction;
use crate::module::Module;

/// The most columns of what is quoted.
pub const SAID_COLUMNS: usize = 52;

/// What the program says at an instruction, on one line; the instruction, where it says nothing.
#[must_use]
pub fn said(module: &Module, pc: u32) -> String {
    let entry = module.source_at(pc);
    let text = entry.and_then(|entry| {
        let file = module.sources.get(usize::from(entry.file))?;
        file.text.get(entry.start as usize..entry.end as usize)
    });
    let Some(text) = text else {
        return instruction(module, pc).unwrap_or_default();
    };
    let line = text.lines().next().unwrap_or("").trim();
    let words: Vec<&str> = line.split_whitespace().collect();
    let short: String = words.join(" ").chars().take(SAID_COLUMNS).collect();
    short.trim_end_matches(['{', ' ']).to_owned()
}

/// Where an instruction was written: `peg_in_hole.obv:42`.
#[must_use]
pub fn line_of(module: &Module, pc: u32) -> String {
    let place = module.place_of(pc);
    place.map_or_else(|| format!("instruction {pc}"), |(file, line, _)| format!("{file}:{line}"))
}
