//! How a session begins and ends, and what is no question: cancelled, unknown, out of order.

use crate::support::{Editor, Texts, uri};
use lsp_server::{Connection, Message, Notification, Request, Response};
use obverse_lsp::{Ended, NoDisk, serve};
use serde_json::{Value, json};

#[test]
fn a_session_ends_as_it_is_told() {
    assert_eq!(Editor::new().leave(), Ended::Properly);
    assert_eq!(Editor::new().exit(), Ended::AtOnce);
    assert_eq!(Editor::new().vanish(), Ended::Alone);
    assert_eq!(Editor::uninitialized(Texts::default()).exit(), Ended::AtOnce);
}

fn code(answer: Result<Value, (i64, String)>) -> i64 {
    answer.expect_err("refused").0
}

#[test]
fn what_is_out_of_order_is_refused() {
    let mut editor = Editor::uninitialized(Texts::default());
    assert_eq!(code(editor.ask("textDocument/hover", json!({}))), -32002);
    // A notification before has no effect.
    editor.open("main.obv", "sequence main {");
    let told = editor.ask("initialize", json!({ "capabilities": {} })).expect("it is initialized");
    assert_eq!(told["serverInfo"]["name"], "obverse");
    assert_eq!(code(editor.ask("initialize", json!({ "capabilities": {} }))), -32600);
    assert_eq!(editor.of("documentSymbol", "main.obv"), json!([]));
    editor.ask("shutdown", Value::Null).expect("it shuts down");
    assert_eq!(code(editor.ask("textDocument/hover", json!({}))), -32600);
    assert_eq!(editor.exit(), Ended::Properly);
}

#[test]
fn what_is_not_known_is_answered() {
    let mut editor = Editor::new();
    assert_eq!(code(editor.ask("textDocument/moniker", json!({}))), -32601);
    assert_eq!(code(editor.ask("no/such", json!([1, 2]))), -32601);
    editor.tell("$/setTrace", json!({ "value": "off" }));
    editor.tell("no/such", Value::Null);
    editor.send(Message::Response(Response::new_ok(7.into(), ())));
    assert_eq!(editor.leave(), Ended::Properly);
}

#[test]
fn wrong_parameters_are_refused_and_nothing_is_lost() {
    let mut editor = Editor::new();
    editor.open("main.obv", "sequence main { wait 1 s }");
    for params in [Value::Null, json!({}), json!([]), json!({ "textDocument": 3 })] {
        assert_eq!(code(editor.ask("textDocument/hover", params.clone())), -32602);
        editor.tell("textDocument/didChange", params.clone());
        editor.tell("textDocument/didOpen", params.clone());
        editor.tell("textDocument/didClose", params.clone());
        editor.tell("$/cancelRequest", params);
    }
    assert_eq!(editor.of("documentSymbol", "main.obv")[0]["name"], "main");
}

#[test]
fn a_cancelled_request_is_answered_as_such_or_as_if_it_were_not() {
    let mut editor = Editor::new();
    editor.open("main.obv", include_str!("../../../../programs/press_fit.obv"));
    let params = json!({ "textDocument": { "uri": uri("main.obv") } });
    let ids: Vec<_> =
        (0..50).map(|_| editor.begin("textDocument/codeLens", params.clone())).collect();
    for id in &ids {
        editor.tell("$/cancelRequest", json!({ "id": id }));
    }
    let answers: Vec<_> = ids.iter().map(|id| editor.end(id)).collect();
    for answer in &answers {
        assert!(matches!(answer, Ok(_) | Err((-32800, _))), "{answer:?}");
    }
    editor.tell("$/cancelRequest", json!({ "id": "unknown" }));
    assert_eq!(editor.leave(), Ended::Properly);
}

#[test]
fn only_an_editor_that_can_is_asked_to_tell_of_files() {
    let registration = |capabilities: Value| {
        let (server, editor) = Connection::memory();
        let server = std::thread::spawn(move || serve(&server, Box::new(NoDisk)));
        let send = |message: Message| editor.sender.send(message).expect("the server is there");
        let params = json!({ "capabilities": capabilities });
        send(Request::new(1.into(), "initialize".to_owned(), params).into());
        send(Notification::new("initialized".to_owned(), json!({})).into());
        send(Request::new(2.into(), "shutdown".to_owned(), Value::Null).into());
        send(Notification::new("exit".to_owned(), Value::Null).into());
        assert_eq!(server.join().expect("no panic"), Ended::Properly);
        let asked = |message: Message| match message {
            Message::Request(request) => Some(request.params["registrations"][0].clone()),
            _ => None,
        };
        editor.receiver.try_iter().find_map(asked)
    };
    assert_eq!(registration(json!({})), None);
    let can = json!({ "workspace": { "didChangeWatchedFiles": { "dynamicRegistration": true } } });
    let asked = registration(can).expect("it is asked");
    assert_eq!(asked["registerOptions"]["watchers"][0]["globPattern"], "**/*.{obv,toml}");
}
