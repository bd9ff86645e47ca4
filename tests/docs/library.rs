//! What the page of actions owes the library, and the page of campaigns the words of true causes:
//! each is there as the sources have it, and nothing else is.

use crate::page::Page;
use obverse_compiler::library;
use std::collections::BTreeSet;

/// The parameters with a range of the action of a file, as the beginnings of the rows of a table.
fn rows(text: &str) -> Vec<String> {
    let (_, action) = text.split_once("\naction ").expect("an action");
    let (head, _) = action.split_once(") {").expect("its parameters");
    let (name, parameters) = head.split_once('(').expect("its name");
    let row = |parameter: &str| {
        let words: Vec<&str> = parameter.split_whitespace().collect();
        let parameter = words.join(" ");
        let (of, default) = parameter.split_once(" = ")?;
        let (of, range) = of.split_once(" in ")?;
        let (of, _) = of.split_once(':')?;
        Some(format!("| `{name}` | `{of}` | {range} | {default} | "))
    };
    parameters.split(',').filter_map(row).collect()
}

#[test]
fn the_table_of_parameters_is_that_of_the_library() {
    let page = Page::read("docs/actions.md").text;
    let expected: Vec<String> =
        library::FILES.iter().flat_map(|file| rows(&format!("\n{}", (file.1)()))).collect();
    assert!(expected.len() > 30, "{expected:?}");
    for row in &expected {
        assert_eq!(page.matches(row.as_str()).count(), 1, "docs/actions.md lacks {row}");
    }
    let is_row = |line: &&str| line.starts_with("| `") && line.matches(" | ").count() == 4;
    let ranged = |line: &&str| line.split(" | ").nth(2).is_some_and(|cell| cell.contains(" to "));
    let told = page.lines().filter(is_row).filter(ranged).count();
    assert_eq!(told, expected.len(), "a row of docs/actions.md is of no parameter");
}

/// The words of the table that begins with a heading of a page.
fn words_of_table(page: &str, before: &str) -> BTreeSet<String> {
    let (_, behind) = page.split_once(before).expect("what stands before the table");
    let rows = behind.lines().skip_while(|line| !line.starts_with("| `"));
    let rows = rows.take_while(|line| line.starts_with("| `"));
    rows.filter_map(|row| Some(row.split('`').nth(1)?.to_owned())).collect()
}

#[test]
fn every_true_cause_is_explained() {
    let source = Page::read("crates/sim/src/truth.rs").text;
    let codes = source.lines().filter_map(|line| {
        let (_, code) = line.trim().strip_prefix("Self::")?.split_once(" => \"")?;
        Some(code.trim_end_matches("\",").to_owned())
    });
    let codes: BTreeSet<String> = codes.collect();
    assert!(codes.len() > 10, "{codes:?}");
    let page = Page::read("docs/campaigns.md").text;
    assert_eq!(words_of_table(&page, "A *true cause* is"), codes);
}
