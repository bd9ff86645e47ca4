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

#[test]
fn breakpoints_that_cannot_be_are_told_one_by_one() {
    let mut client = Client::at_entry("glue.obv");
    let why = |answer: &Value| {
        assert_eq!(answer["verified"], false, "{answer}");
        answer["message"].as_str().expect("it says why").to_owned()
    };
    let points = json!([
        { "line": 30, "condition": "output 99" },
        { "line": 30, "logMessage": "it is {input 99}" },
        { "line": "x" },
        { "line": 30, "condition": "output 0" },
    ]);
    let source = json!({ "path": "glue.obv" });
    let asked = json!({ "source": source, "breakpoints": points });
    let answers = client.ok("setBreakpoints", asked)["breakpoints"].clone();
    assert!(why(&answers[0]).contains("no output 99"), "{answers}");
    assert!(why(&answers[1]).contains("99"), "{answers}");
    assert!(why(&answers[2]).contains("`line` of a breakpoint must be"), "{answers}");
    assert_eq!(answers[3]["verified"], true, "{answers}");
    let data = json!({ "breakpoints": [{ "dataId": "0:output 99" }] });
    let answers = client.ok("setDataBreakpoints", data)["breakpoints"].clone();
    assert!(why(&answers[0]).contains("no output 99"), "{answers}");
    let other = json!({ "source": { "path": "/other.obv" }, "lines": [1, 2] });
    let answers = client.ok("setBreakpoints", other)["breakpoints"].clone();
    assert!(why(&answers[0]).contains("no file of the program"), "{answers}");
    assert_eq!(answers.as_array().map(Vec::len), Some(2));
    let lines = client.ok("setBreakpoints", json!({ "source": source, "lines": [30, 31] }));
    assert_eq!(lines["breakpoints"].as_array().map(Vec::len), Some(2));
    assert_eq!(lines["breakpoints"][1]["verified"], true);
    assert_eq!(client.bye("points"), Some(0));
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.ok("launch", json!({ "program": "glue.obv", "noDebug": true }));
    for (request, points) in [
        ("setBreakpoints", json!({ "source": source, "breakpoints": [{ "line": 30 }] })),
        ("setFunctionBreakpoints", json!({ "breakpoints": [{ "name": "main" }] })),
        ("setExceptionBreakpoints", json!({ "filters": ["due"] })),
    ] {
        let answers = client.ok(request, points)["breakpoints"].clone();
        assert!(why(&answers[0]).contains("without stops"), "{answers}");
    }
    assert_eq!(client.bye("points_no_debug"), Some(0));
}

#[test]
fn what_is_wrong_with_a_request_is_said_in_words_of_the_protocol() {
    let mut client = Client::new();
    let why = client.refused("initialize", json!({ "linesStartAt1": "yes" }));
    assert_eq!(why, "`linesStartAt1` of `initialize` must be true or false, and is \"yes\"");
    let why = client.refused("initialize", json!({ "pathFormat": "uri" }));
    assert!(why.contains("`pathFormat` must be `path`"), "{why}");
    client.ok("initialize", json!({ "pathFormat": "path" }));
    client.ok("launch", json!({ "program": "glue.obv" }));
    let why = client.refused("scopes", json!({ "frameId": -1 }));
    assert_eq!(why, "`frameId` of `scopes` must be a whole number from 0, and is -1");
    assert_eq!(client.refused("scopes", json!({})), "`scopes` must say `frameId`");
    client.frame(b"{\"type\": \"request\", \"command\": 3}");
    let told = client.event("output")["output"].clone();
    assert_eq!(told, "`command` of a request must be text, and is 3\n");
    client.frame(b"{\"a\":");
    let told = client.event("output")["output"].clone();
    let no_json = "this is no message of the protocol: no JSON from line 1, column 5 on\n";
    assert_eq!(told, no_json);
    assert_eq!(client.bye("protocol_words"), Some(0));
}

#[test]
fn what_cannot_be_set_is_shown_so_and_said_so() {
    let mut client = Client::at_entry("bad_pin.obv");
    let workcell = json!({ "variablesReference": 2 });
    let shown = client.ok("variables", workcell)["variables"].clone();
    let found = |shown: &Value, name: &str| {
        let mut all = shown.as_array().expect("variables").iter();
        all.find(|it| it["name"] == name).expect("it is there")["presentationHint"].clone()
    };
    let read_only = json!({ "attributes": ["readOnly"] });
    assert_eq!(found(&shown, "force"), read_only, "{shown}");
    assert_eq!(found(&shown, "input 0"), Value::Null, "{shown}");
    fn set(variables: u64, name: &str, value: &str) -> Value {
        json!({ "variablesReference": variables, "name": name, "value": value })
    }
    let why = client.refused("setVariable", set(2, "force", "3"));
    assert_eq!(why, "`force` can only be looked at: variables and inputs can be set");
    let globals = client.ok("variables", json!({ "variablesReference": 1 }))["variables"].clone();
    assert_eq!(found(&globals, "next_pin"), Value::Null, "{globals}");
    let why = client.refused("setVariable", set(1, "next_pin", "true"));
    assert_eq!(why, "`next_pin`: it cannot be given this value");
    assert_eq!(client.bye("read_only"), Some(0));
}
