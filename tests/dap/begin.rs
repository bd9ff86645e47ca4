//! What a session begins with, as it is asked for, and at which errors and hits a run stops.

use crate::client::Client;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn scratch(file: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("dap_begin");
    std::fs::create_dir_all(&folder).expect("a folder");
    folder.join(file)
}

fn launched(arguments: Value) -> Client {
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.ok("launch", arguments);
    client.event("initialized");
    client
}

fn started(arguments: Value) -> (Client, Value) {
    let mut client = launched(arguments);
    client.ok("configurationDone", Value::Null);
    let stopped = client.event("stopped");
    (client, stopped)
}

#[test]
fn an_argument_that_is_not_understood_is_said_once_and_passed_over() {
    let client = launched(json!({
        "type": "obverse", "request": "launch", "name": "x", "__sessionId": "y",
        "program": "glue.obv", "stopOnEntr": true, "workcell": "none.toml",
    }));
    let told: Vec<&str> = client
        .came
        .iter()
        .filter(|message| message["body"]["category"] == "important")
        .filter_map(|message| message["body"]["output"].as_str())
        .collect();
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told[0].contains("`stopOnEntr`") && told[0].contains("`stopOnEntry`?"), "{told:?}");
    assert!(told[1].contains("`workcell`") && told[1].contains(" cell,"), "{told:?}");
    assert_eq!(client.bye("arguments"), Some(0));
}

#[test]
fn a_wrong_argument_is_refused_by_its_name() {
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    let wrong = [
        ("seed", json!("one")),
        ("stopAtEnd", json!("yes")),
        ("parameters", json!("x.toml")),
        ("strategy", json!(3)),
        ("strategy", json!("hope")),
        ("limit", json!(-1)),
    ];
    for (name, value) in wrong {
        let why = client.refused("launch", json!({ "program": "glue.obv", name: value }));
        assert!(why.contains(&format!("`{name}`")), "{why}");
    }
    let files = [("memory", json!("no/such/folder")), ("parameters", json!(["none.toml"]))];
    for (name, value) in files {
        let why = client.refused("launch", json!({ "program": "glue.obv", name: value }));
        assert!(why.contains("no/such/folder") || why.contains("none.toml"), "{why}");
    }
    client.ok("launch", json!({ "program": "glue.obv", "cell": null }));
    assert_eq!(client.bye("wrong_arguments"), Some(0));
}

#[test]
fn a_strategy_takes_the_place_of_what_is_declared_and_what_is_learned_is_kept() {
    let policy = "reversal_policy.obv";
    let (client, stopped) = started(json!({ "program": policy, "strategy": "stop" }));
    let text = stopped["text"].as_str().expect("it says what is next");
    assert!(!text.contains("back 1 action"), "{text}");
    assert_eq!(client.bye("strategy"), Some(0));
    let memory = scratch("memory.toml");
    let _ = std::fs::remove_file(&memory);
    let arguments = json!({ "program": policy, "strategy": "learned", "memory": memory });
    let (mut client, _) = started(arguments);
    client.ok("setExceptionBreakpoints", json!({ "filters": [] }));
    client.go("continue", json!({}));
    assert_eq!(client.bye("memory"), Some(0));
    let kept = std::fs::read_to_string(&memory).expect("it was written at the end");
    assert!(kept.contains("peg_meets_rim"), "{kept}");
}

#[test]
fn a_run_pauses_at_its_limit_and_goes_on() {
    let path = scratch("for_ever.obv");
    let text = "var n = 0\nsequence main { while n >= 0 { n += 1 } }\n";
    std::fs::write(&path, text).expect("a file");
    let (mut client, stopped) = started(json!({ "program": path, "limit": 1000 }));
    assert_eq!(stopped["reason"], "pause", "{stopped}");
    assert!(stopped["description"].as_str().is_some_and(|text| text.contains("limit")));
    let first: u64 = client.typed("n").parse().expect("a number");
    assert_eq!(client.go("continue", json!({}))["reason"], "pause");
    let then: u64 = client.typed("n").parse().expect("a number");
    assert!(first > 100 && first < 1000 && then > first + 100, "{first} {then}");
    assert_eq!(client.bye("limit"), Some(0));
}

#[test]
fn hit_conditions_say_at_which_hits_it_stops() {
    let path = scratch("six_times.obv");
    let text = "var n = 0\nsequence main {\n  while n < 6 {\n    n += 1\n  }\n}\n";
    std::fs::write(&path, text).expect("a file");
    let expected: [(&str, &[&str]); 6] = [
        ("3", &["2", "3", "4", "5"]),
        (">=5", &["4", "5"]),
        (">4", &["4", "5"]),
        ("==3", &["2"]),
        ("%2", &["1", "3", "5"]),
        ("% 7", &[]),
    ];
    for (condition, expected) in expected {
        let mut client = launched(json!({ "program": path }));
        let line = json!({
            "source": { "path": path },
            "breakpoints": [{ "line": 4, "hitCondition": condition }],
        });
        assert_eq!(client.ok("setBreakpoints", line)["breakpoints"][0]["verified"], true);
        client.ok("configurationDone", Value::Null);
        let mut stops = Vec::new();
        let mut stop = client.event("stopped");
        while stop["reason"] == "breakpoint" {
            stops.push(client.typed("n"));
            stop = client.go("continue", json!({}));
        }
        assert_eq!(stops, expected, "{condition}");
        assert_eq!(client.bye("hits"), Some(0));
    }
}

#[test]
fn filters_are_for_the_errors_that_their_conditions_name() {
    let all = |options: Value| json!({ "filters": [], "filterOptions": options });
    let stops = |options: Value| {
        let mut client = launched(json!({ "program": "bad_pin.obv", "seed": 1 }));
        client.ok("setExceptionBreakpoints", all(options));
        client.ok("configurationDone", Value::Null);
        let stop = client.event("stopped");
        let held = client.typed("error pin_jams");
        assert_eq!(client.bye("filters"), Some(0));
        (stop["reason"].as_str().unwrap_or("").to_owned(), held)
    };
    let is_exception = ("exception".to_owned(), "true".to_owned());
    for filter in ["due", "raised"] {
        for condition in ["pin_jams", "rack_is_empty, pin_jams", " "] {
            let options = json!([{ "filterId": filter, "condition": condition }]);
            assert_eq!(stops(options), is_exception, "{filter} {condition}");
        }
        let options = json!([{ "filterId": filter, "condition": "rack_is_empty" }]);
        assert_eq!(stops(options).0, "end", "{filter}");
    }
    let mut client = Client::at_entry("bad_pin.obv");
    let options = json!([
        { "filterId": "raised", "condition": "pin_jam" }, { "filterId": "none" },
        { "filterId": "error pin_jams" },
    ]);
    let answers = client.ok("setExceptionBreakpoints", all(options))["breakpoints"].clone();
    let message = |at: usize| answers[at]["message"].as_str().unwrap_or("").to_owned();
    assert!(message(0).contains("`pin_jam`") && message(0).contains("`pin_jams`?"), "{answers}");
    assert!(message(1).contains("`none`"), "{answers}");
    assert_eq!(answers[2]["verified"], true);
    assert_eq!(client.bye("filter_answers"), Some(0));
    let mut client = Client::new();
    let told = client.ok("initialize", json!({ "adapterID": "obverse" }));
    assert_eq!(told["supportsExceptionFilterOptions"], true);
    assert_eq!(told["exceptionBreakpointFilters"][0]["supportsCondition"], true);
    assert_eq!(client.bye("filter_capabilities"), Some(0));
}
