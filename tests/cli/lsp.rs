//! The language server on standard input and output: messages as bytes, what is no message, and the
//! exit codes.

use crate::support::Bench;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::process::Stdio;

/// A message as it goes over the stream.
fn framed(message: &Value) -> Vec<u8> {
    let text = message.to_string();
    format!("Content-Length: {}\r\n\r\n{text}", text.len()).into_bytes()
}

fn notification(method: &str, params: Value) -> Vec<u8> {
    framed(&json!({ "jsonrpc": "2.0", "method": method, "params": params }))
}

fn request(id: u64, method: &str, params: Value) -> Vec<u8> {
    framed(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }))
}

fn begin() -> Vec<u8> {
    let mut bytes = request(1, "initialize", json!({ "capabilities": {} }));
    bytes.extend(notification("initialized", json!({})));
    bytes
}

fn end() -> Vec<u8> {
    let mut bytes = request(9, "shutdown", Value::Null);
    bytes.extend(notification("exit", Value::Null));
    bytes
}

/// What a session leaves: the exit code, the messages of the server, and its standard error.
fn session(bench: &Bench, input: &[u8]) -> (i32, Vec<Value>, String) {
    let mut command = bench.command(&["lsp", "--stdio"]);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the binary runs");
    // A server that has ended reads no more.
    let _ = child.stdin.take().expect("it has one").write_all(input);
    let output = child.wait_with_output().expect("it ends");
    let mut rest = String::from_utf8(output.stdout).expect("text");
    let mut messages = Vec::new();
    while let Some((header, after)) = rest.split_once("\r\n\r\n") {
        let length = header.strip_prefix("Content-Length: ").expect("a header");
        let length: usize = length.parse().expect("a length");
        messages.push(serde_json::from_str(&after[..length]).expect("a message"));
        rest = after[length..].to_owned();
    }
    let stderr = String::from_utf8(output.stderr).expect("text");
    assert!(!stderr.contains("panicked"), "{stderr}");
    (output.status.code().unwrap_or(-1), messages, stderr)
}

#[test]
fn a_session_serves_files_from_the_disk() {
    let bench = Bench::new("lsp_session");
    let path = bench.path("handover.obv");
    let uri = format!("file://{}", path.display());
    let text = String::from_utf8(bench.read("handover.obv")).expect("text");
    let document = json!({ "uri": uri, "languageId": "obverse", "version": 1, "text": text });
    let mut input = begin();
    input.extend(notification("textDocument/didOpen", json!({ "textDocument": document })));
    let at = json!({ "textDocument": { "uri": uri } });
    input.extend(request(2, "textDocument/codeLens", at));
    input.extend(end());
    let (code, messages, stderr) = session(&bench, &input);
    assert_eq!((code, stderr.as_str()), (0, ""));
    let answer =
        |id: u64| messages.iter().find(|one| one["id"] == id && one.get("method").is_none());
    assert_eq!(answer(1).expect("an answer")["result"]["serverInfo"]["name"], "obverse");
    let lenses = answer(2).expect("an answer")["result"].as_array().expect("lenses").len();
    assert!(lenses > 0, "what it imports is there, so that it compiles: {messages:?}");
    assert_eq!(answer(9).expect("an answer")["result"], Value::Null);
    assert!(messages.iter().all(|message| message["jsonrpc"] == "2.0"));
}

#[test]
fn what_is_no_message_is_answered_and_the_session_goes_on() {
    let bench = Bench::new("lsp_garbage");
    let mut input = begin();
    for garbage in ["{ not json", "[]", "{\"id\": 5}", "\u{0}", ""] {
        input.extend(format!("Content-Length: {}\r\n\r\n{garbage}", garbage.len()).bytes());
    }
    input.extend(b"Content-Length: 2\r\n\r\n\xff\xfe");
    input.extend(end());
    let (code, messages, stderr) = session(&bench, &input);
    assert_eq!(code, 0, "{stderr}");
    let refused = messages.iter().filter(|message| message["error"]["code"] == -32700).count();
    assert_eq!(refused, 4, "{messages:?}");
    let invalid: Vec<&Value> = messages
        .iter()
        .filter(|one| one["error"]["code"] == -32600)
        .map(|one| &one["id"])
        .collect();
    assert_eq!(invalid, [&Value::Null, &json!(5)]);
    assert!(stderr.contains("a message is not understood"), "{stderr}");
}

#[test]
fn what_is_no_header_costs_no_message_but_itself() {
    let wrong: [(&[u8], &str); 5] = [
        (b"GET / HTTP/1.1\r\nHost: x\r\n\r\n", "`GET / HTTP/1.1` is no line of a header"),
        (b"Content-Length: abc\r\n\r\n{\"id\":7}", "`abc` is not the length of a message"),
        (b"Content-Length: 99999999999\r\n\r\n", "99999999999 bytes is not read"),
        (b"Content-Length: 99\r\n\r\n{\"id\"", "99 bytes ends after 5"),
        (b"\x00\xff", "is no line of a header"),
    ];
    let bench = Bench::new("lsp_header");
    for (bytes, why) in wrong {
        let mut input = begin();
        input.extend(bytes);
        input.extend(request(2, "textDocument/codeLens", json!({})));
        input.extend(end());
        let (code, messages, stderr) = session(&bench, &input);
        assert_eq!(code, 0, "{stderr}");
        let refused: Vec<&Value> =
            messages.iter().filter(|one| one["error"]["code"] == -32700).collect();
        assert_eq!(refused.len(), 1, "{messages:?}");
        assert_eq!(refused[0]["id"], Value::Null);
        assert!(refused[0]["error"]["message"].to_string().contains(why), "{refused:?}");
        assert!(stderr.contains(why), "{stderr}");
        // The next one is answered, and the one behind it.
        for id in [2, 9] {
            assert!(messages.iter().any(|one| one["id"] == id), "{id}: {messages:?}");
        }
    }
}

#[test]
fn a_stream_that_ends_ends_the_server_with_a_word() {
    let bench = Bench::new("lsp_broken");
    let broken: [(&[u8], &str); 3] = [
        (b"", "the editor went away"),
        (b"Content-Length: 99\r\n\r\n{\"id\"", "in the middle of a message: 5 of 99 bytes"),
        (b"Content-Length: 3\r\n", "in the middle of a header"),
    ];
    for (bytes, why) in broken {
        let mut input = begin();
        input.extend(bytes);
        let (code, messages, stderr) = session(&bench, &input);
        assert_eq!(code, 1, "{why}");
        assert!(stderr.contains(why), "no `{why}` in\n{stderr}");
        assert_eq!(messages[0]["id"], 1, "what came before is answered");
    }
}

#[test]
fn an_exit_at_once_is_told_from_one_after_a_shutdown() {
    let bench = Bench::new("lsp_exit");
    let mut input = begin();
    input.extend(notification("exit", Value::Null));
    assert_eq!(session(&bench, &input).0, 1);
    let mut input = begin();
    input.extend(end());
    assert_eq!(session(&bench, &input).0, 0);
}

/// The diagnostics of a program that is opened in the folder of programs.
fn published(bench: &Bench, text: &str) -> Vec<Value> {
    let uri = format!("file://{}", bench.path("open.obv").display());
    let document = json!({ "uri": uri, "languageId": "obverse", "version": 1, "text": text });
    let mut input = begin();
    input.extend(notification("textDocument/didOpen", json!({ "textDocument": document })));
    // Answered behind what is published.
    input.extend(request(2, "textDocument/codeLens", json!({ "textDocument": { "uri": uri } })));
    let mut command = bench.command(&["lsp"]);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut child = command.spawn().expect("the binary runs");
    let mut server = child.stdin.take().expect("it has one");
    server.write_all(&input).expect("it reads");
    let mut output = BufReader::new(child.stdout.take().expect("it has one"));
    let found = loop {
        let message = read_message(&mut output);
        if message["method"] == "textDocument/publishDiagnostics" {
            break message["params"]["diagnostics"].as_array().cloned().unwrap_or_default();
        }
    };
    server.write_all(&end()).expect("it reads");
    child.wait().expect("it ends");
    found
}

fn read_message(output: &mut impl BufRead) -> Value {
    let mut length = 0;
    loop {
        let mut line = String::new();
        assert!(output.read_line(&mut line).expect("it is text") > 0, "it ended");
        match line.trim().strip_prefix("Content-Length: ") {
            Some(number) => length = number.parse().expect("a length"),
            None => break,
        }
    }
    let mut body = vec![0; length];
    output.read_exact(&mut body).expect("a whole message");
    serde_json::from_slice(&body).expect("a message is JSON")
}

#[test]
fn what_the_workcell_has_not_is_published_where_the_program_asks_for_it() {
    let bench = Bench::new("lsp_workcell");
    let place = |one: &Value| {
        let start = &one["range"]["start"];
        (start["line"].as_u64(), start["character"].as_u64())
    };
    let wrong = "cell \"pin_cell.toml\"\nitem pin_9 { keyframe at = [0, 0, 0] mm }\n\
                 sequence main {\n  move to pin_9.at\n  set 77 high\n}\n";
    let found = published(&bench, wrong);
    let codes: Vec<&Value> = found.iter().map(|one| &one["code"]).collect();
    assert_eq!(codes, ["C0201", "C0203"], "{found:?}");
    assert_eq!(place(&found[0]), (Some(1), Some(5)), "{found:?}");
    assert_eq!(found[0]["range"]["end"]["character"], 10, "{found:?}");
    assert_eq!(place(&found[1]).0, Some(4), "{found:?}");
    let found = published(&bench, &wrong.replace("pin_9", "pin_1").replace("77", "1"));
    assert_eq!(found, Vec::<Value>::new());
    let found = published(&bench, "cell \"none.toml\"\nsequence main { wait 1 s }\n");
    assert_eq!((found.len(), place(&found[0])), (1, (Some(0), Some(5))), "{found:?}");
    let message = found[0]["message"].as_str().expect("it says why");
    assert!(message.contains("none.toml") && message.contains("cannot be read"), "{message}");
}
