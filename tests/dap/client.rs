//! A client of the debug adapter: the binary, spoken to over its standard input and output.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// The folder of programs.
pub(crate) const PROGRAMS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/programs");

/// The line that begins so.
pub(crate) fn line_of(program: &str, text: &str) -> u64 {
    let source = std::fs::read_to_string(program).expect("the program is there");
    let at = source.lines().position(|line| line.trim_start().starts_with(text));
    at.expect("the line is there") as u64 + 1
}

/// A client, and the adapter that it speaks to.
pub(crate) struct Client {
    adapter: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    seq: i64,
    /// Everything that came, oldest first.
    pub(crate) came: Vec<Value>,
}

impl Client {
    pub(crate) fn new() -> Self {
        Self::in_folder(Path::new(PROGRAMS))
    }

    /// With the adapter in a folder.
    pub(crate) fn in_folder(folder: &Path) -> Self {
        let mut adapter = Command::new(env!("CARGO_BIN_EXE_obverse"))
            .arg("dap")
            .current_dir(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the adapter starts");
        let input = adapter.stdin.take();
        let output = BufReader::new(adapter.stdout.take().expect("it has an output"));
        Self { adapter, input, output, seq: 0, came: Vec::new() }
    }

    /// At the first statement of a program.
    pub(crate) fn at_entry(program: &str) -> Self {
        let mut client = Self::new();
        client.ok("initialize", json!({ "adapterID": "obverse" }));
        client.ok("launch", json!({ "program": program, "seed": 1, "stopOnEntry": true }));
        client.event("initialized");
        client.ok("configurationDone", Value::Null);
        assert_eq!(client.event("stopped")["reason"], "entry");
        client
    }

    /// Send bytes as they are.
    pub(crate) fn raw(&mut self, bytes: &[u8]) {
        let input = self.input.as_mut().expect("it is open");
        input.write_all(bytes).expect("the adapter reads");
        input.flush().expect("the adapter reads");
    }

    pub(crate) fn frame(&mut self, body: &[u8]) {
        self.raw(format!("Content-Length: {}\r\n\r\n", body.len()).as_bytes());
        self.raw(body);
    }

    /// What comes next; none at the end.
    pub(crate) fn next(&mut self) -> Option<Value> {
        let mut length = 0;
        loop {
            let mut line = String::new();
            if self.output.read_line(&mut line).expect("it is text") == 0 {
                return None;
            }
            match line.trim().strip_prefix("Content-Length: ") {
                Some(number) => length = number.parse().expect("a length"),
                None => break,
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).expect("a whole message");
        let message: Value = serde_json::from_slice(&body).expect("a message is JSON");
        self.came.push(message.clone());
        Some(message)
    }

    /// The next message of which something is true.
    pub(crate) fn until(&mut self, is_it: impl Fn(&Value) -> bool) -> Value {
        loop {
            let message = self.next().expect("the adapter is there");
            if is_it(&message) {
                return message;
            }
        }
    }

    /// The body of the next event of a kind.
    pub(crate) fn event(&mut self, event: &str) -> Value {
        self.until(|message| message["event"] == event)["body"].clone()
    }

    pub(crate) fn send(&mut self, command: &str, arguments: Value) -> i64 {
        self.seq += 1;
        let mut request = json!({ "seq": self.seq, "type": "request", "command": command });
        if !arguments.is_null() {
            request["arguments"] = arguments;
        }
        self.frame(request.to_string().as_bytes());
        self.seq
    }

    pub(crate) fn response(&mut self, seq: i64) -> Value {
        self.until(|message| message["type"] == "response" && message["request_seq"] == seq)
    }

    /// The body of a response to a request that is carried out.
    pub(crate) fn ok(&mut self, command: &str, arguments: Value) -> Value {
        let seq = self.send(command, arguments);
        let response = self.response(seq);
        assert_eq!(response["success"], true, "{response}");
        response["body"].clone()
    }

    /// Why a request is refused.
    pub(crate) fn refused(&mut self, command: &str, arguments: Value) -> String {
        let seq = self.send(command, arguments);
        let response = self.response(seq);
        assert_eq!(response["success"], false, "{response}");
        assert_eq!(response["body"]["error"]["showUser"], true);
        response["message"].as_str().expect("it says why").to_owned()
    }

    /// The next stop after a request.
    pub(crate) fn go(&mut self, command: &str, mut arguments: Value) -> Value {
        arguments["threadId"] = json!(1);
        self.ok(command, arguments);
        self.event("stopped")
    }

    /// The line of the innermost call.
    pub(crate) fn line(&mut self) -> u64 {
        let stack = self.ok("stackTrace", json!({ "threadId": 1 }));
        stack["stackFrames"][0]["line"].as_u64().expect("a line")
    }

    /// What something typed into the console comes to.
    pub(crate) fn typed(&mut self, text: &str) -> String {
        let body = self.ok("evaluate", json!({ "expression": text, "context": "repl" }));
        body["result"].as_str().expect("a result is text").to_owned()
    }

    /// Say good-bye; the exit code.
    pub(crate) fn bye(mut self, test: &str) -> Option<i32> {
        self.ok("disconnect", json!({}));
        self.gone(test)
    }

    /// Go away; the exit code. What came is kept for a check against the protocol's schema.
    pub(crate) fn gone(mut self, test: &str) -> Option<i32> {
        self.input = None;
        while self.next().is_some() {}
        let code = self.adapter.wait().expect("it ends").code();
        let lines: Vec<String> = self.came.iter().map(Value::to_string).collect();
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("dap");
        std::fs::create_dir_all(&folder).expect("a folder");
        std::fs::write(folder.join(format!("{test}.jsonl")), lines.join("\n") + "\n")
            .expect("a file");
        code
    }
}
