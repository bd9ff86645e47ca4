//! Blocks of the language `obvasm`: each is a module that a machine may run; and the page of
//! assembly text, which names every directive.

use crate::page::Page;
use obverse_bytecode::text::DIRECTIVES;
use obverse_bytecode::{assemble, verify};

/// Assemble and verify one.
///
/// # Errors
/// What is wrong with it.
pub(crate) fn check(text: &str) -> Result<(), String> {
    let module = assemble(text).map_err(|errors| format!("{errors:?}"))?;
    verify(module).map(|_| ()).map_err(|errors| format!("{errors:?}"))
}

#[test]
fn every_directive_is_on_the_page() {
    let page = Page::read("docs/assembly.md").text;
    let is_there = |directive: &str| {
        page.contains(&format!("`{directive}`")) || page.contains(&format!("`{directive} "))
    };
    let missing: Vec<_> = DIRECTIVES.iter().filter(|directive| !is_there(directive)).collect();
    assert!(missing.is_empty(), "docs/assembly.md lacks {missing:?}");
}
