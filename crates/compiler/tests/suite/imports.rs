//! Programs of several files: what an import stands for, which names are warned about, what is
//! asked of a loader and how often.

use obverse_compiler::{Compiled, Loader, MAX_IMPORTED, compile_files};
use std::collections::BTreeMap;

/// Files in memory, and how often each was read.
#[derive(Default)]
struct Files {
    texts: BTreeMap<String, String>,
    read: BTreeMap<String, usize>,
    asked: usize,
}

impl Files {
    fn of(texts: &[(&str, &str)]) -> Self {
        let owned = texts.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned()));
        Self { texts: owned.collect(), ..Self::default() }
    }

    fn compile(&mut self) -> Compiled {
        let main = self.texts["main.obv"].clone();
        compile_files("main.obv", &main, self)
    }
}

impl Loader for Files {
    fn name(&mut self, path: &str) -> Result<String, String> {
        self.asked += 1;
        // A second way to each file.
        Ok(path.trim_end_matches(".link").to_owned())
    }

    fn read(&mut self, name: &str) -> Result<String, String> {
        *self.read.entry(name.to_owned()).or_default() += 1;
        self.texts.get(name).cloned().ok_or_else(|| "no such file".to_owned())
    }
}

/// The diagnostics as `CODE file:line`.
fn findings(texts: &[(&str, &str)]) -> Vec<String> {
    let compiled = Files::of(texts).compile();
    let place = |span| {
        let (file, position) = compiled.sources.position(span);
        format!("{file}:{}", position.line)
    };
    let found = compiled.diagnostics.iter();
    found.map(|one| format!("{} {}", one.code, place(one.primary.span))).collect()
}

const HOME: &str = "joints home = [0, -90, 90, -90, -90, 0] deg\n";

#[test]
fn each_file_is_read_once() {
    let mut files = Files::of(&[
        ("main.obv", "import \"a.obv\" import \"b.obv\" import \"a.obv.link\" call_it"),
        ("a.obv", "import \"c.obv\""),
        ("b.obv", "import \"c.obv\" import \"c.obv\" import \"a.obv\""),
        ("c.obv", "var c = 1"),
    ]);
    let compiled = files.compile();
    assert_eq!(compiled.sources.len(), 4);
    assert!(files.read.values().all(|times| *times == 1), "{:?}", files.read);
    assert!(!files.read.contains_key("main.obv"), "its text was given");
}

#[test]
fn declarations_stand_in_the_place_of_their_import() {
    let mut files = Files::of(&[
        ("main.obv", "var a = 1\nimport \"b.obv\"\nvar d = 4\nsequence main { set 0 high }"),
        ("b.obv", "var b = 2\nimport \"c.obv\""),
        ("c.obv", "var c = 3"),
    ]);
    let module = files.compile().module.expect("a module");
    let names: Vec<&str> = module.globals.iter().map(|global| global.name.as_str()).collect();
    assert_eq!(names, ["a", "b", "c", "d"]);
}

#[test]
fn files_see_each_other_in_any_order() {
    let main = "import \"logic.obv\"\nimport \"poses.obv\"";
    let logic = "sequence main { move to home }";
    assert_eq!(findings(&[("main.obv", main), ("logic.obv", logic), ("poses.obv", HOME)]), [""; 0]);
}

/// Without `main`, the last sequence of the file that was asked for is meant, never one of those
/// that are there to be called.
#[test]
fn a_program_begins_in_its_own_file() {
    let main = "sequence go { call helper }\nimport \"a.obv\"";
    let texts = [("main.obv", main), ("a.obv", "sequence helper { wait 1 s }")];
    let module = Files::of(&texts).compile().module.expect("a module");
    let call = module.code.iter().find_map(|instr| match instr {
        obverse_isa::Instr::Call { function, .. } => Some(function.index()),
        _ => None,
    });
    assert_eq!(module.functions[call.expect("a call")].name, "go");
    let texts = [("main.obv", "import \"a.obv\""), ("a.obv", "sequence helper { wait 1 s }")];
    assert_eq!(findings(&texts), ["E0301 main.obv:1"]);
}

/// What a file offers to several programs need not be used by each.
#[test]
fn what_is_imported_and_not_used_is_not_warned_about() {
    let main = "import \"a.obv\"\njoints own = [0, 0, 0, 0, 0, 0] rad\nsequence main { wait 1 s }";
    let imported = format!("{HOME}action offered {{ var unread = 1 }}");
    assert_eq!(
        findings(&[("main.obv", main), ("a.obv", &imported)]),
        ["W0001 main.obv:2", "W0001 a.obv:2"],
        "the variable is of no use to anyone"
    );
}

/// Nor is what only that names which is not used.
#[test]
fn what_is_imported_and_never_run_is_not_warned_about() {
    let main = "import \"a.obv\" action own { toggle 1 } sequence main { wait 1 s }";
    let imported = "io blink { toggle 0 } action offered { io blink }";
    assert_eq!(findings(&[("main.obv", main), ("a.obv", imported)]), ["W0001 main.obv:1"]);
}

#[test]
fn a_warning_is_allowed_in_its_own_file() {
    let unread = "action offered { var unread = 1 }\nallow W0001 \"for nothing\"\n";
    let in_file = "allow W0001 in file \"kept\"\naction other { var unread = 1 }";
    let main = "import \"a.obv\"\nallow W0001 \"for an import\" import \"b.obv\"\n\
                joints own = [0, 0, 0, 0, 0, 0] rad\nsequence main { wait 1 s }";
    let mut found = findings(&[("main.obv", main), ("a.obv", unread), ("b.obv", in_file)]);
    found.sort();
    let expected = ["W0001 a.obv:1", "W0001 main.obv:3", "W0010 a.obv:2", "W0010 main.obv:2"];
    assert_eq!(found, expected);
}

#[test]
fn an_io_map_is_checked_where_it_is_used() {
    let main = "import \"io.obv\"\nsequence main {\n set lmap high\n set door low\n toggle home\n \
                if input lamp { set 1 high }\n wait until input main high for up to 1 s }";
    let io = format!("output lamp = 0\ninput door = 1\noutput far = 65536\n{HOME}");
    assert_eq!(
        findings(&[("main.obv", main), ("io.obv", &io)]),
        [
            "E0101 main.obv:3",
            "E0103 main.obv:4",
            "E0103 main.obv:5",
            "E0103 main.obv:6",
            "E0103 main.obv:7",
            "E0210 io.obv:3"
        ]
    );
}

/// What is missing may be in the file that is: no more is said of it.
#[test]
fn what_a_missing_file_may_declare_is_not_asked_for() {
    let main = "import \"none.obv\"\nsequence main { move to home call go set lamp high }";
    assert_eq!(findings(&[("main.obv", main)]), ["E0501 main.obv:1"]);
    assert_eq!(findings(&[("main.obv", "import \"none.obv\"")]), ["E0501 main.obv:1"]);
}

#[test]
fn an_import_in_a_block_is_a_mistake() {
    let main = "sequence main { import \"a.obv\" move to home }";
    assert_eq!(findings(&[("main.obv", main), ("a.obv", HOME)]), ["E0021 main.obv:1"]);
}

/// Each mistake of a file is shown in it, and mistakes of grammar in each file.
#[test]
fn every_file_is_read_to_its_own_end() {
    let texts = [
        ("main.obv", "import \"a.obv\"\nimport \"b.obv\"\nsequence main { wait 1 s"),
        ("a.obv", "joints home = 3"),
        ("b.obv", "// no end of line, and an open text \"\nvar b = \"x"),
    ];
    assert_eq!(findings(&texts), ["E0011 main.obv:3", "E0010 a.obv:1", "E0002 b.obv:2"]);
}

#[test]
fn imports_without_end_are_not_followed_without_end() {
    let many = (0..3 * MAX_IMPORTED).map(|index| format!("import \"{index}.obv\"\n"));
    let main = many.collect::<String>() + "sequence main { wait 1 s }";
    let mut files = Files::of(&[("main.obv", &main)]);
    for index in 0..3 * MAX_IMPORTED {
        files.texts.insert(format!("{index}.obv"), String::new());
    }
    let compiled = files.compile();
    let codes: Vec<&str> = compiled.diagnostics.iter().map(|one| one.code.as_str()).collect();
    assert_eq!(codes, ["E0504"]);
    assert_eq!((compiled.sources.len(), files.asked), (MAX_IMPORTED + 1, MAX_IMPORTED + 1));
}

/// Every file cut off anywhere gives messages or a module, and no panic.
#[test]
fn files_that_are_cut_off_are_no_end() {
    let texts = [
        ("main.obv", "\u{feff}import \"a.obv\"\nsequence main { set lamp high call go }"),
        ("a.obv", "import \"b.obv\"\nsequence go { move to home }"),
        ("b.obv", "output lamp = 0\njoints home = [0, 0, 0, 0, 0, 0] rad // \u{fc}"),
    ];
    assert_eq!(findings(&texts), [""; 0]);
    for (file, (_, text)) in texts.iter().enumerate() {
        for end in (0..text.len()).filter(|end| text.is_char_boundary(*end)) {
            let mut cut = texts;
            cut[file].1 = &text[..end];
            let compiled = Files::of(&cut).compile();
            assert!(compiled.module.is_some() || !compiled.diagnostics.is_empty(), "{cut:?}");
        }
    }
}

/// The help and the suggested path of the only diagnostic of what imports this.
fn meant(import: &str) -> (Option<String>, Option<String>) {
    let mut folder = Named(&["main.obv", "poses.obv", "p1.obv", "cell/io_map.obv"]);
    let source = format!("import {import}\nsequence main {{ move to nowhere }}");
    let mut found = compile_files("main.obv", &source, &mut folder).diagnostics;
    assert_eq!(found.len(), 1, "{import}: {found:#?}");
    let found = found.remove(0);
    (found.help, found.suggestion.map(|change| change.text))
}

/// Files of which the names matter alone.
struct Named(&'static [&'static str]);

impl Loader for Named {
    fn name(&mut self, path: &str) -> Result<String, String> {
        let is_there = self.0.contains(&path);
        is_there.then(|| path.to_owned()).ok_or_else(|| "no such file".to_owned())
    }

    fn read(&mut self, _name: &str) -> Result<String, String> {
        Ok(String::new())
    }

    fn files(&mut self, folder: &str) -> Vec<String> {
        let folder = if folder.is_empty() { String::new() } else { format!("{folder}/") };
        let inside = self.0.iter().filter_map(|path| path.strip_prefix(folder.as_str()));
        inside.filter(|name| !name.contains('/')).map(str::to_owned).collect()
    }
}

#[test]
fn a_file_that_is_not_there_may_be_another() {
    let cases = [
        ("\"Poses.obv\"", Some("\"poses.obv\"")),
        ("\"pose.obv\"", Some("\"poses.obv\"")),
        ("\"p1\"", Some("\"p1.obv\"")),
        ("\"cell/iomap.obv\"", Some("\"cell/io_map.obv\"")),
        ("\"strategies.obv\"", None),
        ("\"mains.obv\"", None),
    ];
    for (written, path) in cases {
        assert_eq!(meant(written).1.as_deref(), path, "{written}");
    }
}

#[test]
fn what_is_no_source_text_is_one_mistake() {
    let (help, _) = meant("\"cell.toml\"");
    assert_eq!(help.as_deref(), Some("a program names its workcell by `cell \"cell.toml\"`"));
    assert!(meant("\"main.obc\"").0.is_some());
}
