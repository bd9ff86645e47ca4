//! What no client should send, and clients that go away.

use crate::client::Client;
use serde_json::{Value, json};

#[test]
fn requests_out_of_turn_are_refused() {
    let mut client = Client::new();
    assert!(client.refused("launch", json!({ "program": "glue.obv" })).contains("initialize"));
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.refused("initialize", json!({}));
    assert!(client.refused("continue", json!({ "threadId": 1 })).contains("launch"));
    assert!(client.refused("attach", json!({ "tape": "none.tape" })).contains("none.tape"));
    assert!(client.refused("attach", json!({ "program": "glue.obv" })).contains("tape"));
    for wrong in [json!({}), json!({ "program": 3 }), json!({ "program": "none.obv" })] {
        client.refused("launch", wrong);
    }
    client.ok("launch", json!({ "program": "glue.obv" }));
    assert!(client.refused("next", json!({ "threadId": 1 })).contains("configurationDone"));
    client.refused("launch", json!({ "program": "glue.obv" }));
    assert_eq!(client.bye("turn"), Some(0));
}

#[test]
fn wrong_requests_are_refused_and_change_nothing() {
    let mut client = Client::at_entry("glue.obv");
    let line = client.line();
    let wrong = [
        ("nonsense", json!({})),
        ("configurationDone", json!({})),
        ("setBreakpoints", json!({})),
        ("setBreakpoints", json!({ "source": { "path": "/other.obv" }, "breakpoints": [] })),
        ("scopes", json!({ "frameId": 99 })),
        ("scopes", json!({ "frameId": -1 })),
        ("variables", json!({ "variablesReference": 77 })),
        ("variables", json!({ "variablesReference": 1e300 })),
        ("variables", json!({ "variablesReference": u64::MAX })),
        ("setVariable", json!({ "variablesReference": 2, "name": "force", "value": "3" })),
        ("setVariable", json!({ "variablesReference": 2, "name": "x", "value": "3" })),
        ("evaluate", json!({ "expression": "nothing_of_this_name", "context": "hover" })),
        ("evaluate", json!({ "expression": "nothing_of_this_name", "context": "repl" })),
        ("evaluate", json!({ "expression": "goto 999999", "context": "repl" })),
        ("evaluate", json!({ "expression": "goto -1", "context": "repl" })),
        ("evaluate", json!({ "expression": "(".repeat(900), "context": "watch" })),
        ("next", json!({ "threadId": 1, "granularity": "century" })),
        ("goto", json!({ "threadId": 1, "targetId": 3 })),
        ("restartFrame", json!({ "frameId": 0 })),
        ("disassemble", json!({ "memoryReference": "here", "instructionCount": 3 })),
        ("disassemble", json!({ "memoryReference": "0", "instructionCount": 1e9 })),
        ("disassemble", json!({ "memoryReference": "0", "instructionCount": 1_000_000 })),
        ("source", json!({ "sourceReference": 99 })),
        ("exceptionInfo", json!({ "threadId": 1 })),
        ("dataBreakpointInfo", json!({ "name": "x", "variablesReference": 1 })),
        ("stepBack", json!([1, 2])),
        ("evaluate", json!({ "expression": "goto", "context": "repl" })),
        ("evaluate", json!({ "expression": "goto nowhere", "context": "repl" })),
        ("evaluate", json!({ "expression": "last", "context": "repl" })),
        ("evaluate", json!({ "expression": "last 1 + 1", "context": "repl" })),
        ("evaluate", json!({ "expression": "undo", "context": "repl" })),
        ("evaluate", json!({ "expression": "bookmark 3", "context": "repl" })),
        ("evaluate", json!({ "expression": "bookmark end", "context": "repl" })),
        ("evaluate", json!({ "expression": "history none", "context": "repl" })),
        ("evaluate", json!({ "expression": "locals 9", "context": "repl" })),
        ("evaluate", json!({ "expression": "list 99999", "context": "repl" })),
        ("evaluate", json!({ "expression": "list none.obv:1", "context": "repl" })),
        ("evaluate", json!({ "expression": "input 99 high", "context": "repl" })),
        ("evaluate", json!({ "expression": "input 0 up", "context": "repl" })),
        ("evaluate", json!({ "expression": "set force = 3", "context": "repl" })),
        ("evaluate", json!({ "expression": "seed x", "context": "repl" })),
        ("evaluate", json!({ "expression": "leave", "context": "repl" })),
        ("evaluate", json!({ "expression": "release", "context": "repl" })),
        ("evaluate", json!({ "expression": "recover", "context": "repl" })),
        ("evaluate", json!({ "expression": "reverse-step 3", "context": "repl" })),
        ("evaluate", json!({ "expression": "help nothing", "context": "repl" })),
    ];
    for (command, arguments) in wrong {
        client.refused(command, arguments);
    }
    let far = json!({ "memoryReference": i64::MAX.to_string(), "offset": i64::MAX,
        "instructionOffset": i64::MAX, "instructionCount": 2 });
    client.ok("disassemble", far);
    let points = json!({ "breakpoints": [
        { "name": "main", "condition": "force" }, { "name": "main", "hitCondition": "0" },
        { "name": "main", "logMessage": "{" }, { "name": 3 }, 7,
    ] });
    let body = client.ok("setFunctionBreakpoints", points);
    for answer in body["breakpoints"].as_array().expect("answers") {
        assert_eq!(answer["verified"], false, "{answer}");
        assert!(answer["message"].is_string());
    }
    let data = json!({ "breakpoints": [
        { "dataId": "0:held", "accessType": "read" }, { "dataId": "0:nothing_of_this_name" },
        { "dataId": "x:held" }, {},
    ] });
    let body = client.ok("setDataBreakpoints", data);
    for answer in body["breakpoints"].as_array().expect("answers") {
        assert_eq!(answer["verified"], false, "{answer}");
    }
    assert_eq!(client.line(), line);
    assert_eq!(client.bye("wrong"), Some(0));
}

/// There is one thread, and who is about one names it.
#[test]
fn a_thread_that_is_not_there_is_refused() {
    let mut client = Client::at_entry("glue.obv");
    let line = client.line();
    let about = ["next", "stepIn", "stepOut", "continue", "stepBack", "reverseContinue", "pause"];
    for command in about.into_iter().chain(["stackTrace", "exceptionInfo"]) {
        let why = client.refused(command, json!({ "threadId": 99 }));
        assert!(why.contains("no thread 99"), "{command}: {why}");
        for wrong in [json!({}), json!({ "threadId": "1" }), Value::Null] {
            let why = client.refused(command, wrong);
            assert!(why.contains(command) && !why.contains("no thread 99"), "{command}: {why}");
        }
    }
    assert_eq!(client.line(), line);
    assert_eq!(client.bye("thread"), Some(0));
}

#[test]
fn garbage_is_answered_and_the_session_goes_on() {
    let mut client = Client::at_entry("glue.obv");
    let line = client.line();
    client.raw(b"hello\r\n\r\n");
    client.event("output");
    for garbage in [&b"{"[..], b"[]", b"null", b"{\"type\":\"event\"}", b"\xff\xfe", b""] {
        client.frame(garbage);
        assert_eq!(client.event("output")["category"], "stderr");
    }
    client.frame("[".repeat(100_000).as_bytes());
    client.event("output");
    client.frame(&vec![b' '; (1 << 20) + 1]);
    let told = client.event("output");
    assert!(told["output"].as_str().is_some_and(|text| text.contains("1048577 bytes")), "{told}");
    assert_eq!(client.line(), line);
    assert_eq!(client.bye("garbage"), Some(0));
}

/// A header that is none is said before anything else comes, and costs no request.
#[test]
fn behind_a_header_that_is_none_the_next_request_is_answered() {
    let mut client = Client::at_entry("glue.obv");
    let line = client.line();
    let wrong: [(&[u8], &str); 5] = [
        (b"Content-Length: abc\r\n\r\n{\"seq\":3,\"type\":\"request\"}", "`abc` is not the length"),
        (b"Content-Length: 99999999999\r\n\r\n", "99999999999 bytes is not read"),
        (b"{\"seq\":3}", "is no line of a header"),
        (b"\x00\xff\r\n\r\n", "is no line of a header"),
        (b"Content-Type: x\r\n\r\n", "must say `Content-Length`"),
    ];
    for (bytes, why) in wrong {
        client.raw(bytes);
        let told = client.event("output");
        assert!(told["output"].as_str().is_some_and(|text| text.contains(why)), "{told}");
        let before = client.came.len();
        assert_eq!(client.line(), line);
        assert_eq!(client.came.len(), before + 1, "nothing else is said");
    }
    client.raw(b"Content-Length: 90\r\n\r\n{}");
    assert_eq!(client.line(), line, "a length that is too large takes no request");
    assert_eq!(client.bye("headers"), Some(0));
}

#[test]
fn a_client_that_goes_away_ends_it() {
    let client = Client::at_entry("glue.obv");
    assert_eq!(client.gone("away"), Some(1));
    let mut client = Client::at_entry("glue.obv");
    client.raw(b"Content-Length: 100\r\n\r\n{\"seq\"");
    assert_eq!(client.gone("half"), Some(1));
}

#[test]
fn what_does_not_compile_is_told() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("dap_wrong.obv");
    std::fs::write(&path, "sequence main { move to nowhere }\n").expect("a file");
    let mut client = Client::new();
    client.ok("initialize", Value::Null);
    let why = client.refused("launch", json!({ "program": path }));
    assert!(why.contains("nowhere"), "{why}");
    assert_eq!(client.bye("diagnostics"), Some(0));
}
