//! What docs/editor.md says of the debugger is what the adapter understands: its arguments, and
//! what is typed into the console.

use crate::read;
use obverse_dap::arguments::{ATTACH, Argument, LAUNCH};
use obverse_dap::console::{WORDS, Word};

const PAGE: &str = "docs/editor.md";

/// That the page has a table under a head with these rows and no other.
fn check_table(head: &str, rows: impl Iterator<Item = String>) {
    let rows: String = rows.collect();
    let table = format!("| {head} |\n| --- | --- |\n{rows}\n");
    assert!(read(PAGE).contains(&table), "{PAGE} lacks this table:\n{table}");
}

#[test]
fn the_page_names_the_arguments() {
    let row = |one: &Argument| format!("| `{}` | {} |\n", one.name, one.about);
    check_table("`launch` | what it says", LAUNCH.iter().map(row));
    check_table("`attach` | what it says", ATTACH.iter().map(row));
}

#[test]
fn the_page_names_what_is_typed() {
    let row = |word: &Word| {
        let arguments = word.arguments.replace('|', "\\|");
        let head = format!("{} {arguments}", word.names[0]);
        format!("| `{}` | {} |\n", head.trim_end(), word.help)
    };
    let typed = WORDS.iter().filter(|word| word.is_carried_out());
    check_table("word | what it does", typed.map(row));
}
