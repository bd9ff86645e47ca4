//! What docs/editor.md says: the picture of a program is what the server shows of it, and every
//! question that the server answers is in the table.

use crate::{check_made, path, read};
use lsp_types::{Position, Range, Uri};
use obverse_lsp::{NoDisk, Workspace};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::process::{Command, Stdio};

const PAGE: &str = "docs/editor.md";

/// Where hints begin in the picture, in characters.
const MARGIN: usize = 44;

/// A program as an editor shows it: lenses above their lines, hints at their ends.
fn picture(program: &str) -> String {
    let uri = Uri("file:///program.obv".to_owned());
    let mut workspace = Workspace::new(Box::new(NoDisk));
    workspace.open(uri.clone(), 1, program.to_owned());
    let all = Range::new(Position::new(0, 0), Position::new(u32::MAX, 0));
    let hints = serde_json::to_value(workspace.hints(&uri, all)).expect("hints");
    let lenses = serde_json::to_value(workspace.lenses(&uri)).expect("lenses");
    let by_line = |list: &Value, line: &dyn Fn(&Value) -> Value, text: &dyn Fn(&Value) -> Value| {
        let each = list.as_array().expect("a list").iter();
        let each = each
            .filter_map(|one| Some((line(one).as_u64()? as usize, text(one).as_str()?.to_owned())));
        each.collect::<BTreeMap<usize, String>>()
    };
    let hints =
        by_line(&hints, &|one| one["position"]["line"].clone(), &|one| one["label"].clone());
    let lenses = by_line(&lenses, &|one| one["range"]["start"]["line"].clone(), &|one| {
        one["command"]["title"].clone()
    });
    let mut picture = String::new();
    for (number, line) in program.lines().enumerate() {
        if let Some(lens) = lenses.get(&number) {
            picture += &format!("    ({lens})\n");
        }
        match hints.get(&number) {
            Some(hint) => picture += &format!("{:3} {line:MARGIN$} {hint}\n", number + 1),
            None => picture += &format!("{:3} {line}\n", number + 1),
        }
    }
    picture.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// The first block of a language, and where it stands.
fn block(page: &str, language: &str) -> (usize, usize) {
    let head = format!("```{language}\n");
    let start = page.find(&head).expect("the page has such a block") + head.len();
    let end = start + page[start..].find("```").expect("it ends");
    (start, end)
}

#[test]
fn the_picture_is_what_the_server_shows() {
    let page = read(PAGE);
    let (start, end) = block(&page, "obv");
    let picture = picture(&page[start..end]);
    assert!(picture.contains("never") && picture.contains("(goes back to its start)"), "{picture}");
    let (start, end) = block(&page, "text");
    check_made(PAGE, &format!("{}{picture}{}", &page[..start], &page[end..]));
}

/// What the server says that it can do.
fn capabilities() -> BTreeSet<String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_obverse"));
    command.arg("lsp").stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut server = command.spawn().expect("the binary runs");
    let params = json!({ "capabilities": {} });
    let begin = json!({ "jsonrpc": "2.0", "id": 1, "method": "initialize", "params": params });
    let begin = begin.to_string();
    let mut input = server.stdin.take().expect("it has one");
    write!(input, "Content-Length: {}\r\n\r\n{begin}", begin.len()).expect("it listens");
    drop(input);
    let output = server.wait_with_output().expect("it ends");
    let text = String::from_utf8(output.stdout).expect("text");
    let (_, message) = text.split_once("\r\n\r\n").expect("a message");
    let message: Value = serde_json::from_str(message).expect("one message");
    message["result"]["capabilities"].as_object().expect("capabilities").keys().cloned().collect()
}

#[test]
fn every_question_that_is_answered_is_in_the_table() {
    let page = read(PAGE);
    let rows = page.lines().filter(|line| line.starts_with("| ") && line.contains('`'));
    let named = rows.filter_map(|row| row.rsplit('`').nth(1)).map(str::to_owned);
    let named: BTreeSet<String> = named.filter(|name| name.ends_with("Provider")).collect();
    let mut answered = capabilities();
    assert!(answered.remove("textDocumentSync"));
    assert_eq!(named, answered, "left the page, right the server");
    assert!(path("editors/README.md").is_file());
}
