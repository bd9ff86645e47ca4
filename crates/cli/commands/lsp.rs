//! `obverse lsp`: the language server on standard input and output.

use super::Result;
use crate::files::{self, ProgramFolder};
use crate::{Outcome, lacking};
use lsp_server::{Connection, ErrorCode, Message};
use obverse_bytecode::Module;
use obverse_compiler::Loader;
use obverse_dap::frame::{self, Frame, Reader};
use obverse_lsp::{Disk, Ended, Lacking, serve};
use serde_json::{Value, json};
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::sync::{Arc, Mutex};

/// The longest message, in bytes.
const MAX_MESSAGE: usize = 64 << 20;

/// So many source files of one folder are looked at for what they import.
const MAX_SOURCES: usize = 100;

/// And no larger ones, in bytes.
const MAX_SOURCE_BYTES: u64 = 1 << 20;

#[derive(clap::Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    /// On standard input and output, which is the only way.
    #[arg(long, hide = true)]
    stdio: bool,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  the editor has shut the server down and told it to exit
  1  it told it to exit at once, or went away; standard error says so";

pub(crate) fn run(arguments: &Arguments) -> Result {
    // Editors say so; there is nothing else to choose.
    let _ = arguments.stdio;
    let (server, editor) = Connection::memory();
    let Connection { sender, receiver } = editor;
    let output = Arc::new(Mutex::new(io::stdout()));
    let refusals = Arc::clone(&output);
    let writer = std::thread::spawn(move || {
        for message in receiver {
            if !say(&output, &message) {
                break;
            }
        }
    });
    std::thread::spawn(move || {
        let mut input = Reader::new(io::stdin().lock(), MAX_MESSAGE);
        loop {
            match input.read() {
                Frame::Message(bytes) => match message(&bytes) {
                    Ok(message) => {
                        let is_exit =
                            matches!(&message, Message::Notification(one) if one.method == "exit");
                        if sender.send(message).is_err() || is_exit {
                            return;
                        }
                    }
                    Err(refusal) => _ = write(&refusals, &refusal),
                },
                Frame::Wrong(why) => {
                    let refusal = refusal(&Value::Null, ErrorCode::ParseError, why);
                    write(&refusals, &refusal);
                }
                Frame::End(None) => return log("the editor went away"),
                Frame::End(Some(why)) => return log(&why),
            }
        }
    });
    let ended = serve(&server, Box::new(Files));
    drop(server);
    // What was answered last is still being written.
    let _ = writer.join();
    match ended {
        Ended::Properly => Ok(Outcome::Done),
        Ended::AtOnce | Ended::Alone => Ok(Outcome::EndedOtherwise),
    }
}

/// The message that bytes are, or the answer that they are none.
fn message(bytes: &[u8]) -> std::result::Result<Message, String> {
    let value: Value = serde_json::from_slice(bytes)
        .map_err(|error| refusal(&Value::Null, ErrorCode::ParseError, error.to_string()))?;
    let id = value.get("id").filter(|id| id.is_string() || id.is_i64()).cloned();
    serde_json::from_value(value).map_err(|_| {
        let why = "neither a request nor a notification nor a response".to_owned();
        refusal(&id.unwrap_or_default(), ErrorCode::InvalidRequest, why)
    })
}

/// The answer that something is no message, which is logged too.
fn refusal(id: &Value, code: ErrorCode, why: String) -> String {
    log(&format!("a message is not understood: {why}"));
    let error = json!({ "code": code as i32, "message": why });
    json!({ "jsonrpc": "2.0", "id": id, "error": error }).to_string()
}

/// Write a message; whether the editor is still there.
fn say(output: &Mutex<io::Stdout>, message: &Message) -> bool {
    let mut value = serde_json::to_value(message).unwrap_or_default();
    value["jsonrpc"] = json!("2.0");
    write(output, &value.to_string())
}

fn write(output: &Mutex<io::Stdout>, text: &str) -> bool {
    let Ok(mut output) = output.lock() else { return false };
    frame::write(&mut *output, text.as_bytes()).is_ok()
}

/// Tell whoever reads standard error, which editors show on demand.
fn log(text: &str) {
    let _ = writeln!(io::stderr(), "obverse lsp: {text}");
}

/// Files as they lie on the disk.
struct Files;

impl Disk for Files {
    fn folder_of(&self, path: &str) -> Box<dyn Loader> {
        Box::new(ProgramFolder::of(Path::new(path)))
    }

    fn sources(&self, folder: &str) -> Vec<(String, String)> {
        let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|name| name.ends_with(".obv")).collect();
        names.sort_unstable();
        names.truncate(MAX_SOURCES);
        let text = |name: String| {
            let bytes = files::read_at_most(&Path::new(folder).join(&name), MAX_SOURCE_BYTES);
            Some((name, String::from_utf8(bytes.ok()?).ok()?))
        };
        names.into_iter().filter_map(text).collect()
    }

    fn lacking(&self, path: &str, module: &Module) -> Vec<Lacking> {
        lacking::in_its_cell(Path::new(path), module)
    }
}
