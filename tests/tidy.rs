//! The rules of the house that no compiler checks: which crate may know which, how sources and
//! documents are kept, and that what documents name is there. Each finding says where it is.

use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The command line, which may know all of the above.
const COMMAND_LINE: &str = "obverse";
const WORKSHOP: [&str; 2] = ["testkit", "benches"];
/// The two columns meet in bytecode and nowhere else.
const LANGUAGE: [&str; 3] = ["syntax", "compiler", "lsp"];
const MACHINE: [&str; 9] =
    ["tape", "workcell", "sim", "vm", "recovery", "preflight", "debugger", "dap", "trials"];

/// The widest line and the longest file of source text.
const MAX_COLUMNS: usize = 100;
const MAX_LINES: usize = 600;
/// Rows cannot be broken; a syntax tree and a generator of every opcode are read as one page.
const WIDE: [&str; 1] = ["isa/src/table.rs"];
const LONG: [&str; 2] = ["crates/syntax/src/ast.rs", "crates/testkit/src/code.rs"];

/// Documents that there must be.
const DOCUMENTS: [&str; 5] =
    ["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "isa/README.md", "isa/ISA.md"];

/// Which crates each crate knows, itself below all of them: the list of that in the architecture's
/// page. What only tests and benchmarks build stands in [`WORKSHOP`].
fn layers() -> Vec<(String, Vec<String>)> {
    let page = read(&Path::new(ROOT).join("ARCHITECTURE.md"));
    let rows = page.lines().skip_while(|line| *line != "```layers").skip(1);
    let layers: Vec<_> = rows
        .take_while(|line| *line != "```")
        .map(|line| {
            let (name, knows) = line.split_once("->").expect("a row `crate -> crates`");
            let knows = knows.split_whitespace().map(str::to_owned).collect();
            (name.trim().to_owned(), knows)
        })
        .collect();
    assert!(!layers.is_empty(), "the page has no list of layers");
    layers
}

fn metadata() -> Metadata {
    MetadataCommand::new().no_deps().exec().expect("cargo tells what the workspace is")
}

/// The name of a crate of ours without its prefix.
fn short(name: &str) -> &str {
    name.strip_prefix("obverse-").unwrap_or(name)
}

/// The crates of ours that a package depends on, for one purpose.
fn ours(package: &Package, kind: DependencyKind) -> BTreeSet<&str> {
    let dependencies = package.dependencies.iter().filter(|found| found.kind == kind);
    dependencies
        .map(|found| found.name.as_str())
        .filter(|name| name.starts_with("obverse"))
        .map(short)
        .collect()
}

fn fails(findings: &[String]) {
    assert!(findings.is_empty(), "{} findings:\n{}", findings.len(), findings.join("\n"));
}

#[test]
fn dependencies_point_one_way() {
    let metadata = metadata();
    let layers = layers();
    let table: BTreeMap<&str, BTreeSet<&str>> = layers
        .iter()
        .map(|(name, knows)| (name.as_str(), knows.iter().map(String::as_str).collect()))
        .collect();
    let mut found = BTreeMap::new();
    for package in &metadata.packages {
        let name = short(package.name.as_str());
        let (normal, dev) =
            (ours(package, DependencyKind::Normal), ours(package, DependencyKind::Development));
        assert!(ours(package, DependencyKind::Build).is_empty(), "{name} is built by one of ours");
        if WORKSHOP.contains(&name) {
            continue;
        }
        let links_the_workshop = WORKSHOP.iter().any(|tool| normal.contains(tool));
        assert!(!links_the_workshop, "{name} would ship what is for tests");
        let may_test_with: &[&str] = if name == COMMAND_LINE { &["testkit"] } else { &[] };
        assert!(dev.iter().all(|tool| may_test_with.contains(tool)), "{name} tests with {dev:?}");
        if name == COMMAND_LINE {
            assert!(normal.iter().all(|known| table.contains_key(known)), "{normal:?}");
        } else {
            found.insert(name, normal);
        }
    }
    assert_eq!(found, table, "left what cargo says, right what ARCHITECTURE.md says");
    let mut below = BTreeSet::new();
    for (name, knows) in &layers {
        assert!(knows.iter().all(|known| below.contains(known)), "{name} knows one above it");
        below.insert(name);
    }
}

/// All that a crate links, of ours.
fn links<'t>(layers: &'t [(String, Vec<String>)], name: &str, all: &mut BTreeSet<&'t str>) {
    let (_, knows) = layers.iter().find(|(row, _)| row == name).expect("it has a row");
    for known in knows {
        if all.insert(known) {
            links(layers, known, all);
        }
    }
}

#[test]
fn the_compiler_never_links_the_machine_nor_the_machine_the_compiler() {
    let layers = layers();
    for (columns, forbidden) in [(&LANGUAGE[..], &MACHINE[..]), (&MACHINE[..], &LANGUAGE[..])] {
        for name in columns {
            let mut all = BTreeSet::new();
            links(&layers, name, &mut all);
            let met: Vec<_> = forbidden.iter().filter(|other| all.contains(**other)).collect();
            assert!(met.is_empty(), "{name} links {met:?}");
        }
    }
}

#[test]
fn every_dependency_is_used() {
    let mut findings = Vec::new();
    for package in &metadata().packages {
        let folder = package.manifest_path.parent().expect("a manifest is in a folder");
        let roots: Vec<PathBuf> = if package.name.as_str() == COMMAND_LINE {
            ["crates/cli", "tests"].iter().map(|part| Path::new(ROOT).join(part)).collect()
        } else {
            vec![folder.into()]
        };
        let text: String = files()
            .iter()
            .filter(|file| roots.iter().any(|root| file.starts_with(root)))
            .filter(|file| has_extension(file, &["rs", "lalrpop"]))
            .map(|file| read(file))
            .collect();
        for dependency in &package.dependencies {
            let name = dependency.rename.as_ref().unwrap_or(&dependency.name);
            if !text.contains(&name.replace('-', "_")) {
                findings.push(format!("{} never names {}", package.name, dependency.name));
            }
        }
    }
    fails(&findings);
}

#[test]
fn every_crate_keeps_the_lints_of_the_workspace() {
    for package in &metadata().packages {
        let manifest = read(package.manifest_path.as_std_path());
        let inherits = manifest.contains("[lints]\nworkspace = true\n");
        assert!(inherits, "{} does not", package.manifest_path);
    }
}

/// Every file of the project, but for what is built and what git keeps.
fn files() -> Vec<PathBuf> {
    fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
        let entries = std::fs::read_dir(folder).expect("the project can be read");
        for entry in entries {
            let path = entry.expect("the project can be read").path();
            let is_ours = !["target", ".git", "node_modules"].iter().any(|one| path.ends_with(one));
            match path.is_dir() {
                true if is_ours => walk(&path, files),
                false => files.push(path),
                true => {}
            }
        }
    }
    let mut files = Vec::new();
    walk(Path::new(ROOT), &mut files);
    files.sort();
    files
}

fn read(path: &Path) -> String {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    String::from_utf8_lossy(&bytes).into_owned()
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|found| extensions.iter().any(|one| found == *one))
}

/// Within the project, with strokes.
fn relative(path: &Path) -> String {
    let within = path.strip_prefix(ROOT).expect("it is in the project");
    within.to_string_lossy().replace('\\', "/")
}

/// What a rule finds in lines of Rust: where, and what.
fn each_line(mut rule: impl FnMut(&str, &str) -> Option<String>) {
    let mut findings = Vec::new();
    for path in files().iter().filter(|path| has_extension(path, &["rs"])) {
        let name = relative(path);
        for (number, line) in (1..).zip(read(path).lines()) {
            findings.extend(rule(&name, line).map(|found| format!("{name}:{number}: {found}")));
        }
    }
    fails(&findings);
}

/// A line of Rust without a comment.
fn code(line: &str) -> &str {
    line.split("//").next().unwrap_or_default()
}

#[test]
fn every_source_begins_by_saying_what_it_is_for() {
    let sources = files().into_iter().filter(|path| has_extension(path, &["rs"]));
    let without = sources.filter(|path| !read(path).starts_with("//! "));
    fails(&without.map(|path| relative(&path)).collect::<Vec<_>>());
}

#[test]
fn lines_fit_a_page() {
    each_line(|name, line| {
        let columns = line.chars().count();
        let is_wide = columns > MAX_COLUMNS && !WIDE.contains(&name);
        is_wide.then(|| format!("{columns} columns, and {MAX_COLUMNS} is the limit"))
    });
}

#[test]
fn files_are_of_one_subject() {
    let mut findings = Vec::new();
    for path in files().iter().filter(|path| has_extension(path, &["rs"])) {
        let (name, lines) = (relative(path), read(path).lines().count());
        if lines > MAX_LINES && !LONG.contains(&name.as_str()) {
            findings.push(format!("{name}: {lines} lines, and {MAX_LINES} is the limit"));
        }
    }
    fails(&findings);
}

#[test]
fn nothing_is_left_to_be_done() {
    // Put together, so that this file does not find itself.
    let banned = [
        concat!("TO", "DO"),
        concat!("FIX", "ME"),
        concat!("to", "do!"),
        concat!("unimpl", "emented!"),
        concat!("db", "g!("),
        concat!("uns", "afe {"),
        concat!("uns", "afe fn"),
        concat!("uns", "afe impl"),
    ];
    each_line(|_, line| {
        let found = banned.iter().find(|word| line.contains(**word))?;
        Some(format!("`{found}`"))
    });
}

#[test]
fn only_the_command_line_prints() {
    each_line(|name, line| {
        let prints = ["println!", "print!"].iter().any(|word| code(line).contains(word));
        let may = ["crates/cli/", "tests/", "benches/"].iter().any(|place| name.starts_with(place));
        (prints && !may).then(|| "it prints".to_owned())
    });
}

/// The standard library's are those of the machine's C library, and differ from one to the next.
#[test]
fn what_libm_computes_is_computed_by_libm() {
    let functions = "sin cos tan asin acos atan atan2 sin_cos sinh cosh tanh exp exp2 ln log log2 \
                     log10 powf cbrt hypot";
    each_line(|name, line| {
        let is_ours = name.starts_with("crates/") || name.starts_with("isa/");
        let calls = |function: &&str| {
            [format!(".{function}("), format!("f64::{function}")].iter().any(|call| {
                let found = code(line).split_once(call.as_str());
                found.is_some_and(|(_, rest)| !rest.starts_with(|c: char| c.is_alphanumeric()))
            })
        };
        let found = functions.split_whitespace().find(calls).filter(|_| is_ours)?;
        Some(format!("`{found}` of the standard library"))
    });
}

#[test]
fn the_project_speaks_of_itself_alone() {
    let mut findings = Vec::new();
    let texts = ["rs", "md", "toml", "obv", "obvasm", "lalrpop", "txt", "run"];
    for path in files() {
        if !has_extension(&path, &texts) && !relative(&path).starts_with(".ci/") {
            continue;
        }
        for (number, line) in (1..).zip(read(&path).lines()) {
            let place = [concat!("../sh", "ared"), concat!("/wo", "rk/"), concat!("/t", "mp")];
            let names = |place: &&&str| {
                line.match_indices(**place).any(|(at, _)| {
                    let before = line[..at].chars().next_back();
                    !before.is_some_and(|c| c.is_alphanumeric() || c == '_')
                })
            };
            if let Some(place) = place.iter().find(names) {
                findings.push(format!("{}:{number}: `{place}`", relative(&path)));
            }
        }
    }
    fails(&findings);
}

mod documents {
    //! What documents name is there: files, folders, commands, opcodes, tests, links.

    use super::*;

    /// What stands in backticks, and the lines of fenced blocks, each with the number of its line.
    fn quoted(text: &str) -> Vec<(usize, String)> {
        let (mut quoted, mut is_fenced) = (Vec::new(), false);
        for (number, line) in (1..).zip(text.lines()) {
            if line.trim_start().starts_with("```") {
                is_fenced = !is_fenced;
            } else if is_fenced {
                quoted.push((number, line.to_owned()));
            } else {
                let spans = line.split('`').skip(1).step_by(2);
                quoted.extend(spans.map(|span| (number, span.to_owned())));
            }
        }
        quoted
    }

    fn documents() -> Vec<PathBuf> {
        files().into_iter().filter(|path| has_extension(path, &["md"])).collect()
    }

    /// What a rule finds in what documents quote.
    fn each_quote(rule: impl Fn(&Path, &str) -> Vec<String>) {
        let mut findings = Vec::new();
        for path in documents() {
            for (number, quote) in quoted(&read(&path)) {
                let found = rule(&path, &quote).into_iter();
                findings
                    .extend(found.map(|found| format!("{}:{number}: {found}", relative(&path))));
            }
        }
        fails(&findings);
    }

    #[test]
    fn they_are_there() {
        let missing = DOCUMENTS.iter().filter(|name| !Path::new(ROOT).join(name).is_file());
        fails(&missing.map(|name| format!("{name} is missing")).collect::<Vec<_>>());
    }

    #[test]
    fn paths_are_there() {
        let files = files();
        let names: Vec<String> = files.iter().map(|path| relative(path)).collect();
        let is_there = |document: &Path, path: &str| {
            let path = path.trim_end_matches('/');
            let beside = document.parent().is_some_and(|folder| folder.join(path).exists());
            beside
                || Path::new(ROOT).join(path).exists()
                || names.iter().any(|name| name.ends_with(&format!("/{path}")))
        };
        each_quote(|document, quote| {
            let words = quote.split(|c: char| c.is_whitespace() || "(),;:\"'".contains(c));
            let paths = words.filter(|word| is_path(word)).filter(|word| !is_there(document, word));
            paths.map(|path| format!("there is no `{path}`")).collect()
        });
    }

    /// Whether a word is the name of a file or folder of the project.
    fn is_path(word: &str) -> bool {
        let is_plain = word.chars().all(|c| c.is_ascii_alphanumeric() || "_-./".contains(c));
        let extension = Path::new(word).extension().and_then(|found| found.to_str());
        let is_source = matches!(extension, Some("rs" | "md" | "lalrpop"));
        let is_long = word.contains('/') && matches!(extension, Some("toml" | "obv" | "obvasm"));
        let first = word.split('/').next().unwrap_or_default();
        let is_of_ours = ["crates", "isa", "programs", "tests", "benches", ".ci"].contains(&first);
        is_plain
            && !word.starts_with('/')
            && (is_source || is_long || is_of_ours && word.contains('/'))
    }

    /// The words after a word.
    fn following<'q>(quote: &'q str, word: &str) -> Vec<&'q str> {
        let words: Vec<&str> = quote.split_whitespace().collect();
        words.windows(2).filter(|pair| pair[0] == word).map(|pair| pair[1]).collect()
    }

    #[test]
    fn commands_are_there() {
        let help = Command::new(env!("CARGO_BIN_EXE_obverse")).arg("--help").output();
        let help = String::from_utf8(help.expect("it runs").stdout).expect("it prints text");
        let commands: Vec<&str> = help
            .lines()
            .skip_while(|line| *line != "Commands:")
            .skip(1)
            .take_while(|line| !line.is_empty())
            .filter_map(|line| line.split_whitespace().next())
            .collect();
        assert!(commands.contains(&"run"), "{commands:?}");
        each_quote(|_, quote| {
            let by_cargo = quote.contains("cargo run").then(|| following(quote, "--"));
            let named =
                following(quote, "obverse").into_iter().chain(by_cargo.into_iter().flatten());
            let is_word = |word: &&str| word.bytes().all(|byte| byte.is_ascii_lowercase());
            let unknown = named.filter(is_word).filter(|word| !commands.contains(word));
            unknown.map(|word| format!("there is no command `obverse {word}`")).collect()
        });
    }

    #[test]
    fn opcodes_are_there() {
        let rows = obverse_isa::OPS.iter().map(|row| row.mnemonic);
        let first = |mnemonic: &str| mnemonic.split('.').next().unwrap_or_default().to_owned();
        let firsts: BTreeSet<String> =
            rows.clone().filter(|row| row.contains('.')).map(first).collect();
        let mnemonics: BTreeSet<&str> = rows.collect();
        each_quote(|_, quote| {
            let is_mnemonic = quote.bytes().all(|b| b.is_ascii_lowercase() || b"._".contains(&b))
                && firsts.contains(&first(quote))
                && quote.contains('.')
                && !quote.ends_with('.')
                && !is_path(quote);
            let is_missing = is_mnemonic && !mnemonics.contains(quote);
            is_missing.then(|| format!("there is no opcode `{quote}`")).into_iter().collect()
        });
    }

    #[test]
    fn tests_and_benchmarks_are_there() {
        let metadata = metadata();
        let targets = metadata.packages.iter().flat_map(|package| &package.targets);
        let targets: BTreeSet<&str> = targets.map(|target| target.name.as_str()).collect();
        each_quote(|_, quote| {
            let named = ["--test", "--bench", "--example"].map(|flag| following(quote, flag));
            let unknown = named.into_iter().flatten().filter(|name| !targets.contains(name));
            unknown.map(|name| format!("cargo knows no `{name}`")).collect()
        });
    }

    #[test]
    fn links_lead_somewhere() {
        let mut findings = Vec::new();
        for path in documents() {
            for (number, line) in (1..).zip(read(&path).lines()) {
                for link in line.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
                    let file = link.split('#').next().unwrap_or_default();
                    let folder = path.parent().expect("a file is in a folder");
                    if !link.contains("://") && !folder.join(file).exists() {
                        findings.push(format!("{}:{number}: `{link}`", relative(&path)));
                    }
                }
            }
        }
        fails(&findings);
    }
}
