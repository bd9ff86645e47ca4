//! The law of names over generated programs: every name leads somewhere, and a thing may as well be
//! called otherwise. Knows nothing of editors.

use crate::programs::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::Module;
use obverse_compiler::symbols::{Symbol, SymbolKind, Symbols};
use obverse_compiler::{Loader, analyse, compile};

/// Called so wherever it is named, a thing of a program is what it was: the code is the same.
/// Whether there was a thing to be renamed.
///
/// # Errors
/// Only those of the randomness.
///
/// # Panics
/// If the law does not hold.
pub fn renames(u: &mut Unstructured<'_>) -> Result<bool> {
    let choice: usize = u.arbitrary()?;
    let text = programs::generate(u, Options { max_statements: 40, ..Options::default() })?;
    let (compiled, symbols) = analyse("program.obv", &text, &mut NoFiles);
    let lost = symbols.occurrences.iter().find(|one| one.symbol.is_none());
    assert!(lost.is_none(), "{lost:?} leads nowhere\n{text}");
    let own: Vec<usize> = own(&symbols);
    let Some(&symbol) = own.get(choice % own.len().max(1)) else { return Ok(false) };
    let renamed = renamed(&text, &symbols, symbol);
    let before = compiled.module.as_ref().map(meaning);
    let after = compile("program.obv", &renamed);
    assert!(before.is_some() && before == after.module.as_ref().map(meaning), "{renamed}");
    Ok(true)
}

/// What the program itself has given a name that may be another. A keyframe that several items have
/// is one name to the module: called otherwise at one of them, it becomes two.
fn own(symbols: &Symbols) -> Vec<usize> {
    let all = symbols.symbols.iter().enumerate();
    let is_shared = |one: &Symbol| {
        let same = symbols.symbols.iter().filter(|other| other.name == one.name);
        one.kind == SymbolKind::Keyframe && same.count() > 1
    };
    let own = all.filter(|(_, symbol)| !symbol.declared.is_empty() && symbol.name != "main");
    own.filter(|(_, symbol)| !is_shared(symbol)).map(|(id, _)| id).collect()
}

fn renamed(text: &str, symbols: &Symbols, symbol: usize) -> String {
    let mut renamed = text.to_owned();
    let places: Vec<_> = symbols.of_symbol(symbol).map(|one| one.span).collect();
    for span in places.iter().rev() {
        renamed.replace_range(span.start as usize..span.end as usize, "renamed_thing");
    }
    renamed
}

/// What a module does, whatever things are called.
fn meaning(module: &Module) -> impl PartialEq + use<> {
    let ranges = module.functions.iter().map(|function| (function.first, function.end));
    (module.code.clone(), module.constants.clone(), ranges.collect::<Vec<_>>())
}

/// A program of one file.
struct NoFiles;

impl Loader for NoFiles {
    fn name(&mut self, _path: &str) -> std::result::Result<String, String> {
        Err("there are no files".to_owned())
    }

    fn read(&mut self, _name: &str) -> std::result::Result<String, String> {
        Err("there are no files".to_owned())
    }
}
