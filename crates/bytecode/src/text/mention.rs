//! What is for people alone as lines of assembly text, in both directions: mentions
//! (`.mention output "lamp" 2 0 7 21`), and the names of loops (`.loop 5 "round" up`).

use super::error::AsmError;
use super::quote::quoted;
use super::scan::Scanner;
use crate::module::{LoopName, Mention, Mentioned};
use std::fmt::Write;

/// Write a line for each.
pub(super) fn write(mentions: &[Mention], out: &mut String) {
    for Mention { what, file, start, end } in mentions {
        let what = match what {
            Mentioned::Cell => "cell".to_owned(),
            Mentioned::Item(item) => format!("item {item}"),
            Mentioned::Tool(tool) => format!("tool {tool}"),
            Mentioned::Output { name, bit } => format!("output {} {bit}", quoted(name)),
            Mentioned::Input { name, bit } => format!("input {} {bit}", quoted(name)),
        };
        let _ = writeln!(out, ".mention {what} {file} {start} {end}");
    }
}

/// Write a line for each name of a loop.
pub(super) fn write_loops(loops: &[LoopName], out: &mut String) {
    for LoopName { enter, name, is_down } in loops {
        let way = if *is_down { "down" } else { "up" };
        let _ = writeln!(out, ".loop {enter} {} {way}", quoted(name));
    }
}

/// Read what follows `.loop`.
///
/// # Errors
/// What is wrong with it, and where.
pub(super) fn read_loop(line: &mut Scanner<'_>) -> Result<LoopName, AsmError> {
    let (enter, name) = (line.number("instruction")?, line.name("name of the counter")?);
    let way = line.word("way that it counts")?;
    let is_down = match way.value {
        "up" => false,
        "down" => true,
        _ => return Err(line.error(way.at, "a loop counts `up` or `down`")),
    };
    Ok(LoopName { enter, name, is_down })
}

/// Read what follows `.mention`.
///
/// # Errors
/// What is wrong with it, and where.
pub(super) fn read(line: &mut Scanner<'_>) -> Result<Mention, AsmError> {
    let word = line.word("what is mentioned")?;
    let what = match word.value {
        "cell" => Mentioned::Cell,
        "item" => Mentioned::Item(line.number("item")?),
        "tool" => Mentioned::Tool(line.number("tool")?),
        "output" => Mentioned::Output {
            name: line.name("name of the output")?,
            bit: line.number("output")?,
        },
        "input" => {
            Mentioned::Input { name: line.name("name of the input")?, bit: line.number("input")? }
        }
        _ => {
            let message = "a mention is of a cell, an item, a tool, an output or an input";
            return Err(line.error(word.at, message));
        }
    };
    let (file, start) = (line.number("source file")?, line.number("first byte")?);
    Ok(Mention { what, file, start, end: line.number("end")? })
}
