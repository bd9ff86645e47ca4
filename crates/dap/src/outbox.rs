//! How messages go out: responses and events, numbered as they go.

use crate::frame;
use crate::message::Request;
use serde_json::{Value, json};
use std::io::Write;

/// Where messages go out.
pub(crate) struct Outbox<'o> {
    output: &'o mut dyn Write,
    seq: u64,
    /// Whether nobody reads any more.
    pub(crate) is_gone: bool,
}

impl<'o> Outbox<'o> {
    pub(crate) fn to(output: &'o mut dyn Write) -> Self {
        Self { output, seq: 0, is_gone: false }
    }

    fn send(&mut self, mut message: Value) {
        self.seq += 1;
        message["seq"] = json!(self.seq);
        if !self.is_gone {
            let sent = frame::write(self.output, message.to_string().as_bytes());
            self.is_gone = sent.is_err();
        }
    }

    pub(crate) fn event(&mut self, event: &str, body: Value) {
        self.send(json!({ "type": "event", "event": event, "body": body }));
    }

    /// Carried out.
    pub(crate) fn answer(&mut self, request: &Request, body: Value) {
        let mut response = json!({
            "type": "response",
            "request_seq": request.seq,
            "success": true,
            "command": request.command,
        });
        if !body.is_null() {
            response["body"] = body;
        }
        self.send(response);
    }

    /// Not carried out, and nothing has changed.
    pub(crate) fn refuse(&mut self, request: &Request, why: &str) {
        // Braces are variables in what a client shows.
        let shown = why.replace(['{', '}'], "");
        self.send(json!({
            "type": "response",
            "request_seq": request.seq,
            "success": false,
            "command": request.command,
            "message": why,
            "body": { "error": { "id": 1, "format": shown, "showUser": true } },
        }));
    }

    /// Told to the user, on a line of its own.
    pub(crate) fn tell(&mut self, category: &str, text: &str) {
        self.event("output", json!({ "category": category, "output": format!("{text}\n") }));
    }
}
