//! The table of names: what stands where means the same thing, in every program for people and in
//! texts that show one rule each.

use obverse_compiler::symbols::{Role, SymbolKind, Symbols};
use obverse_compiler::{Loader, analyse, compile};
use std::fs;
use std::path::{Path, PathBuf};

/// The files of a folder, as they are.
struct Folder(PathBuf);

impl Loader for Folder {
    fn name(&mut self, path: &str) -> Result<String, String> {
        Ok(path.to_owned())
    }

    fn read(&mut self, name: &str) -> Result<String, String> {
        fs::read_to_string(self.0.join(name)).map_err(|error| error.to_string())
    }
}

fn symbols(source: &str) -> Symbols {
    analyse("test.obv", source, &mut Folder(PathBuf::new())).1
}

/// The source with the marks `«` and `»` taken out, and the places between them.
fn marked(source: &str) -> (String, Vec<u32>) {
    let (mut text, mut places) = (String::new(), Vec::new());
    for c in source.chars() {
        match c {
            '«' => places.push(text.len() as u32),
            '»' => {}
            c => text.push(c),
        }
    }
    (text, places)
}

/// That the marked places, and no others, are where one thing is named.
fn check_same(source: &str) {
    let (text, places) = marked(source);
    let symbols = symbols(&text);
    let first = symbols.at(places[0]).expect("a name is marked");
    let symbol = first.symbol.expect("it names something");
    let found: Vec<u32> = symbols.of_symbol(symbol).map(|one| one.span.start).collect();
    assert_eq!(found, places, "{text}");
}

#[test]
fn a_declaration_is_named_in_every_clause() {
    check_same(
        "io «open» { set 0 low } io close { set 0 high } reverse «open»
         sequence main { io «open» io close }",
    );
    check_same(
        "error «jam» { severity fatal }
         advanced move go { requires holding else throw «jam» distance 3 mm up
           on failure { throw «jam» } }
         sequence main { requires holding else throw «jam» throw «jam» advance go }",
    );
    check_same(
        "sequence «fix» { wait 1 s } error a { recover using «fix» }
         error b { recover by reversing 2 actions otherwise using «fix» }
         sequence main { call «fix» }",
    );
    check_same("output «lamp» = 3 io on { set «lamp» high } sequence main { toggle «lamp» }");
    check_same("input «part» = 3 sequence main { if input «part» { wait 1 s } }");
}

#[test]
fn a_name_in_parentheses_stands_within_them() {
    check_same("sequence main(«gap»: length) { move ( «gap» ) up move («gap» + 1 mm) up }");
}

#[test]
fn names_of_blocks_are_seen_to_the_end_of_the_block() {
    check_same(
        "sequence main { if holding { var «x» = 1 «x» += «x» } else { var x = 2 x += 1 }
           for x from 1 to 2 { wait real(x) * 1 s } }",
    );
    check_same("sequence main { for «i» from 1 to 2 { if «i» > 1 { break } } var i = 2 i += 1 }");
    check_same("sequence main { position «here» move to «here» position «here» }");
}

#[test]
fn a_variable_is_not_seen_in_its_own_first_value() {
    check_same(
        "sequence main { var x = «x» }".replace("«x»", "1").replace("var x", "var «x»").as_str(),
    );
    let symbols = symbols("sequence main { var x = x }");
    assert_eq!(symbols.occurrences.last().map(|one| one.symbol), Some(None));
}

#[test]
fn an_argument_names_the_parameter_of_what_is_called() {
    check_same(
        "action push(«depth»: length) { move «depth» up }
         sequence main { var depth = 3 mm call push(«depth»: depth) }",
    );
}

#[test]
fn keyframes_are_of_their_item_unless_a_parameter_asks_for_them() {
    check_same(
        "item a { keyframe «top» = [0, 0, 0] mm } item b { keyframe top = [0, 0, 0] mm }
         sequence main { move to a.«top» move to b.top }",
    );
    check_same(
        "item a { keyframe «top» = [0, 0, 0] mm } item b { keyframe «top» = [0, 0, 0] mm }
         action go(what: item) { move to what.«top» }
         sequence main { call go(a) move to a.«top» move to b.«top» }",
    );
}

#[test]
fn checkpoints_are_named_before_they_are_set() {
    check_same(
        "error e { recover by reversing up to checkpoint «begun» }
         sequence main { checkpoint «begun» throw e } sequence other { checkpoint «begun» }",
    );
}

#[test]
fn tools_types_and_functions_are_declared_nowhere() {
    let symbols =
        symbols("sequence main(x: length) { tool probe var y: length = abs(x) tool probe }");
    let foreign: Vec<(&str, SymbolKind)> = symbols
        .symbols
        .iter()
        .filter(|symbol| symbol.declared.is_empty())
        .map(|symbol| (symbol.name.as_str(), symbol.kind))
        .collect();
    let expected =
        [("length", SymbolKind::Type), ("probe", SymbolKind::Tool), ("abs", SymbolKind::Function)];
    assert_eq!(foreign, expected);
}

#[test]
fn values_have_the_type_that_the_check_finds() {
    let source = "joints a = [0, 0, 0, 0, 0, 0] deg var rounds = 3
                  sequence main(gap: length) {
                    var v = gap / 2 s var at = a for i from 1 to 2 { }
                  }";
    let symbols = symbols(source);
    let of_type = |name: &str| {
        let symbol = symbols.symbols.iter().find(|symbol| symbol.name == name);
        symbol.and_then(|symbol| symbol.of_type.clone()).unwrap_or_default()
    };
    assert_eq!(of_type("rounds"), "an integer");
    assert_eq!(of_type("gap"), "a length");
    assert_eq!(of_type("v"), "a speed");
    assert_eq!(of_type("at"), "a joint configuration");
    assert_eq!(of_type("i"), "an integer");
    assert_eq!(of_type("main"), "");
}

#[test]
fn what_is_assigned_is_told_from_what_is_used() {
    let symbols = symbols("sequence main { var x = 1 x = x + 1 }");
    let roles: Vec<Role> = symbols.occurrences.iter().map(|one| one.role).collect();
    assert_eq!(roles, [Role::Declares, Role::Declares, Role::Assigns, Role::Uses]);
}

/// The programs for people, and the library.
fn programs() -> Vec<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["../../programs", "../../programs/cases", "../../programs/handover", "library"];
    let files = folders.iter().flat_map(|folder| {
        let entries = fs::read_dir(here.join(folder)).expect("a folder of programs");
        entries.map(|entry| entry.expect("an entry").path())
    });
    let mut files: Vec<PathBuf> =
        files.filter(|path| path.extension().is_some_and(|found| found == "obv")).collect();
    files.sort();
    assert!(files.len() > 25, "{files:?}");
    files
}

#[test]
fn every_name_of_every_program_leads_somewhere() {
    for path in programs() {
        let source = fs::read_to_string(&path).expect("a program");
        let folder = path.parent().expect("it is in a folder").to_owned();
        let name = path.file_name().expect("it has a name").to_string_lossy();
        let (compiled, symbols) = analyse(&name, &source, &mut Folder(folder));
        let whole = compiled.sources.whole();
        for one in &symbols.occurrences {
            let text = &whole[one.span.start as usize..one.span.end as usize];
            let Some(symbol) = one.symbol else {
                // What imports a part of a program declares the rest.
                assert!(compiled.module.is_none(), "{}: `{text}` leads nowhere", path.display());
                continue;
            };
            assert_eq!(symbols.symbols[symbol].name, text, "{}", path.display());
        }
        let places: Vec<_> = symbols.occurrences.iter().map(|one| one.span).collect();
        assert!(places.windows(2).all(|pair| pair[0].end <= pair[1].start), "{}", path.display());
    }
}

#[test]
fn the_table_of_half_a_program_has_what_is_there() {
    let source =
        "joints home = [0, 0, 0, 0, 0, 0] deg\nsequence main {\n  move to home\n  move to ";
    let symbols = symbols(source);
    assert!(compile("test.obv", source).module.is_none());
    let home = symbols.at(source.find("home\n  move to ").expect("it is there") as u32);
    assert_eq!(home.and_then(|one| one.symbol), Some(0));
}
