//! Another name for a thing, in every program that it is part of; or why not.
//!
//! Whether a new name can stand in the place of an old one is not reasoned about: the texts are
//! changed, and every name must lead to the same thing as before.

use crate::diagnostics::changes;
use crate::hover::is_spoken_with_an;
use crate::navigate::symbol_at;
use crate::program::{Program, is_of_library};
use crate::workspace::{Document, InProgram, Workspace};
use lsp_types::{Position, Range, TextEdit, Uri, WorkspaceEdit};
use obverse_compiler::symbols::{SymbolId, SymbolKind};
use obverse_syntax::RESERVED_WORDS;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Severity;
use std::collections::BTreeMap;

/// Why something is not renamed, for people.
pub type Refusal = String;

/// A place of a name: the key of its file, and where it begins and ends there, in bytes.
type Place = (String, u32, u32);

impl Workspace {
    /// The name at a place, if it can be given another.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn prepare_rename(
        &mut self,
        uri: &Uri,
        position: Position,
    ) -> Result<Option<(Range, String)>, Refusal> {
        let Some(file) = self.file(uri) else { return Ok(None) };
        let Some((symbol, span)) = symbol_at(&file, position) else { return Ok(None) };
        may_be_renamed(&file.program, symbol)?;
        let range = file.program.range(file.file, span);
        Ok(range.map(|range| (range, file.program.written(span).to_owned())))
    }

    /// The changes that give what is named at a place another name.
    ///
    /// # Errors
    /// Why it is not given that name.
    pub fn rename(
        &mut self,
        uri: &Uri,
        position: Position,
        name: &str,
    ) -> Result<WorkspaceEdit, Refusal> {
        is_name(name)?;
        let mut places: BTreeMap<Place, Range> = BTreeMap::new();
        let files = self.files(uri);
        for file in &files {
            let Some((symbol, _)) = symbol_at(file, position) else { continue };
            may_be_renamed(&file.program, symbol)?;
            if name == "main" && file.program.symbols.symbols[symbol].name != "main" {
                return Err("`main` is where a program begins".to_owned());
            }
            for one in file.program.symbols.of_symbol(symbol) {
                let Some((key, range)) = file.program.place(one.span) else { continue };
                let within = file.program.sources().locate(one.span).span;
                places.insert((key, within.start, within.end), range);
            }
        }
        if places.is_empty() {
            return Err("there is no name here that could be changed".to_owned());
        }
        self.try_out(&files, places.keys(), name)?;
        let edit = |((key, ..), range): (Place, Range)| {
            (self.uri(&key), TextEdit::new(range, name.to_owned()))
        };
        Ok(changes(places.into_iter().map(edit)))
    }

    /// Change the texts aside, and look whether every name leads where it led.
    fn try_out<'p>(
        &self,
        files: &[InProgram],
        places: impl Iterator<Item = &'p Place>,
        name: &str,
    ) -> Result<(), Refusal> {
        let mut by_file: BTreeMap<&str, Vec<(u32, u32)>> = BTreeMap::new();
        for (key, start, end) in places {
            by_file.entry(key).or_default().push((*start, *end));
        }
        let mut texts = self.copy_of_open();
        for (key, spans) in by_file {
            let text = text_of(files, key).ok_or("a file of the program is not there")?;
            let text = with_name(text, &spans, name);
            texts.insert(key.to_owned(), Document { uri: self.uri(key), version: 0, text });
        }
        for file in files {
            let before = &file.program;
            let after = self.compiled(&before.key(0), Some(&texts));
            let after = after.ok_or("a file of the program is not there")?;
            if let Some(why) = difference(before, &after, name) {
                return Err(why);
            }
        }
        Ok(())
    }
}

/// The text of a file of the programs.
fn text_of<'f>(files: &'f [InProgram], key: &str) -> Option<&'f str> {
    let mut found = files.iter().filter_map(|file| {
        let of_program = file.program.file_of(key)?;
        Some(file.program.text(of_program))
    });
    found.next()
}

/// A text with a name in the place of what stands at some places, in their order.
fn with_name(text: &str, places: &[(u32, u32)], name: &str) -> String {
    let mut changed = String::with_capacity(text.len());
    let mut rest = 0;
    for (start, end) in places {
        changed += text.get(rest..*start as usize).unwrap_or("");
        changed += name;
        rest = *end as usize;
    }
    changed + text.get(rest..).unwrap_or("")
}

/// What is otherwise in a program in which a name has been changed, if anything is.
fn difference(before: &Program, after: &Program, name: &str) -> Option<Refusal> {
    let (old, new) = (&before.symbols, &after.symbols);
    let same_kinds = old.symbols.len() == new.symbols.len()
        && old.symbols.iter().zip(&new.symbols).all(|(a, b)| a.kind == b.kind);
    let led = |symbols: &obverse_compiler::symbols::Symbols| -> Vec<(Option<SymbolId>, _)> {
        symbols.occurrences.iter().map(|one| (one.symbol, one.role)).collect()
    };
    let clashes = || {
        let errors = |program: &Program| {
            let found = program.compiled.diagnostics.iter();
            found.filter(|one| one.severity == Severity::Error).count()
        };
        errors(after) > errors(before)
    };
    if same_kinds && led(old) == led(new) && !clashes() {
        return None;
    }
    let other = old.symbols.iter().find(|symbol| symbol.name == name);
    Some(match other {
        Some(other) => {
            let kind = other.kind.name();
            let article = if is_spoken_with_an(kind) { "an" } else { "a" };
            format!("there is {article} {kind} of the name `{name}` already")
        }
        None => format!("with the name `{name}` the text would be read otherwise"),
    })
}

fn may_be_renamed(program: &Program, symbol: SymbolId) -> Result<(), Refusal> {
    let found = &program.symbols.symbols[symbol];
    let name = &found.name;
    let why = match found.kind {
        SymbolKind::Type | SymbolKind::Function => format!("`{name}` is a word of the language"),
        SymbolKind::Tool => format!("the tool `{name}` has its name from the workcell file"),
        SymbolKind::Item => format!("the item `{name}` has its name from the workcell file"),
        SymbolKind::Sequence if name == "main" => "`main` is where a program begins".to_owned(),
        _ => String::new(),
    };
    if !why.is_empty() {
        return Err(why);
    }
    let of_library = |span: &obverse_syntax::span::Span| {
        is_of_library(program.sources().name(program.sources().locate(*span).file))
    };
    if found.declared.iter().any(of_library) {
        return Err(format!("`{name}` is declared in the library that comes with the language"));
    }
    // Names may stand in what the parser has left out.
    let mistake = program.compiled.diagnostics.iter().find(|one| leaves_out(one.code));
    match mistake.and_then(|one| program.place(one.primary.span)) {
        Some((key, range)) => {
            let (_, file) = crate::uri::split(&key);
            let line = range.start.line + 1;
            Err(format!(
                "line {line} of {file} cannot be read; mend that before, so that no use of \
                 `{name}` is missed"
            ))
        }
        None => Ok(()),
    }
}

/// Whether a mistake of this kind leaves a part of the text, or a file, out of the program.
fn leaves_out(code: Code) -> bool {
    code.as_str().starts_with("E00") || code.as_str().starts_with("E05")
}

/// Whether a text can be a name.
fn is_name(name: &str) -> Result<(), Refusal> {
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let goes_on = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    if !begins || !goes_on {
        return Err(format!("`{name}` is no name: letters, digits and `_`, and no digit first"));
    }
    if RESERVED_WORDS.contains(&name) {
        return Err(format!("`{name}` is a word of the language that cannot be a name"));
    }
    Ok(())
}
