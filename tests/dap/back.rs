//! Going back as an editor does: by statements over calls, into the program from its end, to where
//! a call began, and to moments of a line.

use crate::client::{Client, PROGRAMS, line_of};
use serde_json::{Value, json};

fn glue() -> String {
    format!("{PROGRAMS}/glue.obv")
}

/// At the end of a run that nothing has stopped.
fn at_end() -> Client {
    let mut client = Client::at_entry("glue.obv");
    assert_eq!(client.go("continue", json!({}))["reason"], "end");
    client
}

fn frames(client: &mut Client) -> Vec<String> {
    let stack = client.ok("stackTrace", json!({ "threadId": 1 }));
    let frames = stack["stackFrames"].as_array().expect("frames");
    frames.iter().map(|frame| frame["name"].as_str().unwrap_or("").to_owned()).collect()
}

/// A step back is the mirror of `next`: from the end it enters main, and there it goes over calls.
#[test]
fn a_step_back_goes_one_statement_also_from_the_end() {
    let [tool, draw, look] = ["tool probe", "call draw_bead", "call look"].map(line_of_glue);
    let mut client = at_end();
    let mut there = Vec::new();
    for _ in 0..3 {
        assert_eq!(client.go("stepBack", json!({}))["reason"], "step");
        assert_eq!(frames(&mut client), ["main", "the start"]);
        there.push(client.line());
    }
    assert_eq!(there, [look + 2, look + 1, look]);
    // What was gone over going back `next` goes over again.
    client.go("next", json!({}));
    assert_eq!(client.line(), look + 1);
    client.go("stepBack", json!({}));
    let stop = client.go("stepBack", json!({}));
    assert_eq!(stop["reason"], "never", "the call before cannot be taken back as a whole: {stop}");
    // Shown, nothing ends it before the start, from where the first sequence is entered again.
    client.typed("last output 2");
    client.event("stopped");
    let mut lines = vec![client.line()];
    while frames(&mut client).len() > 1 && lines.len() < 30 {
        client.go("stepBack", json!({}));
        lines.push(client.line());
    }
    assert!(lines.contains(&draw) && lines.contains(&tool), "{lines:?}");
    client.go("next", json!({}));
    assert_eq!((frames(&mut client).len(), client.line()), (2, tool));
    assert_eq!(client.bye("back_end"), Some(0));
}

fn line_of_glue(text: &str) -> u64 {
    line_of(&glue(), text)
}

/// Into calls one goes by instructions, or by a word.
#[test]
fn a_call_is_gone_back_into_by_a_word_and_by_instructions() {
    for by_word in [true, false] {
        let mut client = at_end();
        let mut steps = 0;
        while frames(&mut client)[0] != "look" {
            match by_word {
                true => {
                    client.typed("reverse-step");
                    client.event("stopped");
                }
                false => drop(client.go("stepBack", json!({ "granularity": "instruction" }))),
            }
            steps += 1;
            assert!(steps < 9, "it goes by it");
        }
        assert!(client.line() > line_of_glue("sequence look"));
        client.typed("reverse-finish");
        client.event("stopped");
        assert_eq!(client.line(), line_of_glue("call look"));
        assert_eq!(client.bye("back_into"), Some(0));
    }
}

/// From where an error is due what was done for it is taken back, and then statement by statement.
#[test]
fn a_step_back_from_an_error_goes_to_before_what_raised_it() {
    let mut client = Client::new();
    client.ok("initialize", json!({ "adapterID": "obverse" }));
    client.ok("launch", json!({ "program": "bad_pin.obv", "seed": 1 }));
    client.ok("configurationDone", Value::Null);
    assert_eq!(client.event("stopped")["reason"], "exception");
    let program = format!("{PROGRAMS}/bad_pin.obv");
    let insert = line_of(&program, "advance insert");
    client.go("stepBack", json!({}));
    assert_eq!((client.line(), frames(&mut client)[0].as_str()), (insert, "main"));
    assert_eq!(client.typed("error pin_jams"), "false");
    client.go("stepBack", json!({}));
    assert_eq!(client.line(), insert - 1, "what counts the attempts is no statement");
    client.go("next", json!({}));
    assert_eq!(client.line(), insert);
    assert_eq!(client.go("next", json!({}))["reason"], "exception");
    // Nor does a breakpoint stop twice for one statement.
    let source = json!({ "path": program });
    let lines = json!({ "source": source, "breakpoints": [{ "line": insert }] });
    client.ok("setBreakpoints", lines);
    assert_eq!(client.go("reverseContinue", json!({}))["reason"], "breakpoint");
    assert_eq!(client.go("reverseContinue", json!({}))["reason"], "entry");
    assert_eq!(client.go("continue", json!({}))["reason"], "breakpoint");
    assert_eq!(client.go("continue", json!({}))["reason"], "exception");
    let targets = json!({ "source": source, "line": insert - 1 });
    let found = client.ok("gotoTargets", targets);
    assert!(found["targets"].as_array().is_some_and(|all| !all.is_empty()), "{found}");
    assert_eq!(client.bye("back_error"), Some(0));
}

#[test]
fn a_step_out_of_the_first_sequence_leads_to_the_end() {
    let mut client = Client::at_entry("glue.obv");
    assert_eq!(client.go("stepOut", json!({}))["reason"], "end");
    assert_eq!(client.bye("out"), Some(0));
}

#[test]
fn a_call_is_restarted_whatever_is_met_on_the_way() {
    let mut client = Client::at_entry("glue.obv");
    let data = json!({ "name": "output 2" });
    let info = client.ok("dataBreakpointInfo", data);
    let watched = json!({ "breakpoints": [{ "dataId": info["dataId"] }] });
    let first = line_of_glue("set 2 high");
    let lines = json!({
        "source": { "path": glue() },
        "breakpoints": [{ "line": first + 2 }, { "line": first + 4 }],
    });
    assert_eq!(client.ok("setBreakpoints", lines)["breakpoints"][1]["verified"], true);
    client.go("continue", json!({}));
    client.go("continue", json!({}));
    client.ok("setDataBreakpoints", watched);
    assert_eq!(client.line(), first + 4);
    let stack = client.ok("stackTrace", json!({ "threadId": 1 }));
    let frame = stack["stackFrames"][0]["id"].clone();
    let stop = client.go("restartFrame", json!({ "frameId": frame }));
    assert_eq!((&stop["reason"], client.line()), (&json!("restart"), first), "{stop}");
    assert_eq!(client.typed("output 2"), "false");
    // They are met again afterwards.
    assert_eq!(client.go("continue", json!({}))["reason"], "data breakpoint");
    assert_eq!(client.bye("restart"), Some(0));
}

/// A line that only calls does nothing by itself, and was come to all the same.
#[test]
fn a_line_that_only_calls_has_moments() {
    let mut client = at_end();
    // Another breakpoint is not stopped at meanwhile, and stays.
    let others = json!({ "breakpoints": [{ "name": "look" }] });
    client.ok("setFunctionBreakpoints", others);
    let line = line_of_glue("call draw_bead");
    let targets = json!({ "source": { "path": glue() }, "line": line });
    let found = client.ok("gotoTargets", targets);
    let targets = found["targets"].as_array().expect("targets");
    assert_eq!(targets.len(), 1, "{found}");
    assert!(targets[0]["label"].as_str().is_some_and(|label| label.ends_with("call draw_bead")));
    // Looking has moved nothing.
    assert_eq!(frames(&mut client), ["the start"]);
    let target = targets[0]["id"].clone();
    assert_eq!(client.go("goto", json!({ "targetId": target }))["reason"], "goto");
    assert_eq!(client.line(), line);
    assert_eq!(client.go("continue", json!({}))["reason"], "function breakpoint");
    let none = json!({ "source": { "path": glue() }, "line": 1 });
    assert_eq!(client.ok("gotoTargets", none)["targets"], json!([]));
    assert_eq!(client.bye("targets"), Some(0));
}
