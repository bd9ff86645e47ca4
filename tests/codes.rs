//! The index of all diagnostics, docs/codes.md, which `UPDATE=1 cargo test --test codes` writes.
//! What each code is for is held by tests of the crates that report it.

use obverse_bytecode::ModuleCode;
use obverse_codes::Page;
use obverse_codes::index::page;
use obverse_recovery::MemoryCode;
use obverse_sim::CellCode;
use obverse_syntax::codes::Code;

const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/codes.md");

/// The pages of the codes of programs, of workcells, of assembly text and modules, and of memories.
fn pages() -> Vec<Page> {
    Code::pages()
        .chain(CellCode::pages())
        .chain(ModuleCode::pages())
        .chain(MemoryCode::pages())
        .collect()
}

#[test]
fn the_index_is_fresh() {
    let page = page(&pages());
    if std::env::var_os("UPDATE").is_some() {
        let folder = std::path::Path::new(PATH).parent().expect("a folder");
        std::fs::create_dir_all(folder).expect("docs can be made");
        std::fs::write(PATH, &page).expect("docs/codes.md can be written");
    }
    let written = std::fs::read_to_string(PATH).unwrap_or_default();
    assert!(
        written == page,
        "docs/codes.md is not what the table says: `UPDATE=1 cargo test --test codes` writes it"
    );
}

#[test]
fn every_code_has_a_section_with_its_reason() {
    let page = page(&pages());
    for Page { code, title, reason, .. } in pages() {
        assert_eq!(page.matches(&format!("\n## {code}\n")).count(), 1, "{code}");
        assert!(page.contains(&format!("| [{code}](#{})", code.to_lowercase())), "{code}");
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words(&page).contains(&words(reason)), "{code}");
        assert!(reason.ends_with('.') && reason.len() > 60, "{code}: {reason}");
        assert!(!title.ends_with('.'), "{code}");
    }
}
