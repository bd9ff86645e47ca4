//! Source files and instructions, as a client names them.
//!
//! An instruction is called by its number, as everywhere. A file that is in no folder, as those of
//! the library, is asked for by a number too: its place in the module, from 1. So is one that has
//! changed since.

use crate::message::{Client, Disassemble, Source};
use crate::server::{Loaded, OnDisk};
use obverse_bytecode::Module;
use obverse_bytecode::text::instruction;
use obverse_debugger::SourcePlace;
use serde_json::{Value, json};
use std::path::Path;

/// The most instructions that are shown at once.
const MAX_SHOWN: usize = 4096;

/// A source file as a client is told of it: by its path only if the file there is what runs.
pub(crate) fn source(loaded: &Loaded, file: &str) -> Value {
    let sources = &loaded.program.module().sources;
    let index = sources.iter().position(|source| source.name == file);
    let number = index.map_or(0, |index| index + 1);
    match index.and_then(|index| loaded.files.get(index)) {
        Some(OnDisk::Same(path)) => json!({ "name": file, "path": path }),
        Some(OnDisk::Changed(_)) => {
            json!({ "name": file, "sourceReference": number, "origin": "as the program has it" })
        }
        _ => json!({ "name": file, "sourceReference": number }),
    }
}

/// All of them.
pub(crate) fn sources(loaded: &Loaded) -> Value {
    let names = loaded.program.module().sources.iter().map(|file| file.name.as_str());
    let all: Vec<Value> = names.map(|name| source(loaded, name)).collect();
    json!({ "sources": all })
}

/// The file of the program that a client means.
///
/// # Errors
/// It is none of the program's, or it is not what the program was made of.
pub(crate) fn file<'l>(loaded: &'l Loaded, source: &Source) -> Result<&'l str, String> {
    let sources = &loaded.program.module().sources;
    let reference = source.source_reference.unwrap_or(0);
    let by_number = usize::try_from(reference).ok().and_then(|it| it.checked_sub(1));
    let path = source.path.as_deref().or(source.name.as_deref()).unwrap_or("").replace('\\', "/");
    let path = Path::new(&path);
    let by_path = || loaded.files.iter().position(|known| is_same(loaded, known, path));
    // A file elsewhere may have the same name: it is meant only where there is no file, as where a
    // tape was made on another machine, or where a client says no more than a name.
    let by_name = || {
        let is_open = |index: usize| {
            source.path.is_none() || matches!(loaded.files.get(index), None | Some(OnDisk::No))
        };
        let mut all = sources.iter().enumerate();
        let found = all.find(|(index, file)| is_open(*index) && path.ends_with(&file.name));
        found.map(|(index, _)| index)
    };
    let index = by_number.or_else(by_path).or_else(by_name);
    let found = index.and_then(|index| Some((sources.get(index)?, loaded.files.get(index))));
    match found {
        Some((_, Some(OnDisk::Changed(_)))) if by_number.is_none() => Err(format!(
            "`{}` has changed since the program was made of it: its text as it was then is among \
             the loaded sources",
            path.display()
        )),
        Some((file, _)) => Ok(&file.name),
        None => Err(no_file(loaded, path)),
    }
}

/// Whether a file of the program is the one that a client calls so, by way of a link for one.
fn is_same(loaded: &Loaded, known: &OnDisk, path: &Path) -> bool {
    let Some(known) = known.path() else { return false };
    let is_real = || (loaded.real)(known).is_some_and(|it| (loaded.real)(path) == Some(it));
    known == path || is_real()
}

fn no_file(loaded: &Loaded, path: &Path) -> String {
    let sources = loaded.program.module().sources.iter().zip(&loaded.files);
    let known = sources.map(|(source, known)| {
        known.path().map_or_else(|| source.name.clone(), |path| path.display().to_string())
    });
    let known = known.collect::<Vec<_>>().join(", ");
    format!("`{}` is no file of the program; it is made of {known}", path.display())
}

/// The text of a file that is in no folder.
pub(crate) fn text(module: &Module, reference: u64) -> Result<Value, String> {
    let index = usize::try_from(reference).ok().and_then(|reference| reference.checked_sub(1));
    let found = index.and_then(|index| module.sources.get(index));
    let found = found.ok_or_else(|| format!("there is no source {reference}"))?;
    Ok(json!({ "content": found.text }))
}

/// What stands on a line of a file.
pub(crate) fn line_text(module: &Module, file: &str, line: usize) -> String {
    let source = module.sources.iter().find(|source| source.name == file);
    let text = source.and_then(|source| source.text.lines().nth(line.checked_sub(1)?));
    text.unwrap_or_default().trim().to_owned()
}

/// The number of the instruction that a reference and an offset mean; it may be beside the code.
pub(crate) fn address(reference: &str, offset: i64) -> Result<i64, String> {
    let digits = reference.trim();
    let number = match digits.strip_prefix("0x") {
        Some(digits) => i64::from_str_radix(digits, 16),
        None => digits.parse(),
    };
    let number =
        number.map_err(|_| format!("`{reference}` is not the number of an instruction"))?;
    Ok(number.saturating_add(offset))
}

/// Instructions, so many as are asked for: beside the code too.
pub(crate) fn disassembled(
    loaded: &Loaded,
    client: &Client,
    asked: &Disassemble,
) -> Result<Value, String> {
    if asked.instruction_count > MAX_SHOWN {
        return Err(format!("no more than {MAX_SHOWN} instructions are shown at once"));
    }
    let module = loaded.program.module();
    let first = address(&asked.memory_reference, asked.offset)?;
    let first = first.saturating_add(asked.instruction_offset);
    let mut all = Vec::new();
    for at in (0..asked.instruction_count as i64).map(|index| first.saturating_add(index)) {
        let pc = u32::try_from(at).ok().filter(|pc| (*pc as usize) < module.code.len());
        all.push(match pc {
            Some(pc) => one(loaded, client, pc),
            None => json!({
                "address": at.to_string(),
                "instruction": "no instruction",
                "presentationHint": "invalid",
            }),
        });
    }
    Ok(json!({ "instructions": all }))
}

fn one(loaded: &Loaded, client: &Client, pc: u32) -> Value {
    let module = loaded.program.module();
    let text = instruction(module, pc).unwrap_or_default();
    let class = module.code.get(pc as usize).map_or("", |instr| instr.info().class.name());
    let mut shown = json!({
        "address": pc.to_string(),
        "instruction": format!("{text:<32} ; {class}"),
    });
    let function = module.functions.iter().find(|function| function.first == pc);
    if let Some(function) = function {
        shown["symbol"] = json!(function.name);
    }
    if let Some((file, line, column)) = module.place_of(pc) {
        shown["location"] = source(loaded, file);
        shown["line"] = json!(client.line(line));
        shown["column"] = json!(client.column(column));
    }
    shown
}

/// Whether a place is on a line of a file.
pub(crate) fn is_on(place: Option<&SourcePlace>, file: &str, line: usize) -> bool {
    place.is_some_and(|place| place.file == file && place.line == line)
}
