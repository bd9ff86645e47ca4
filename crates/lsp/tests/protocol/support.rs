//! An editor that a test drives: it opens texts, asks, and reads what is published.

use lsp_server::{Connection, Message, Notification, Request, RequestId};
use obverse_compiler::Loader;
use obverse_lsp::{Disk, Ended, serve};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;

/// The folder of every test.
pub(crate) const FOLDER: &str = "/cell";

/// How long an answer may take.
const PATIENCE: Duration = Duration::from_secs(60);

/// A disk of texts, by path; it may change meanwhile.
#[derive(Clone, Default)]
pub(crate) struct Texts(pub(crate) Arc<Mutex<BTreeMap<String, String>>>);

impl Texts {
    fn all(&self) -> BTreeMap<String, String> {
        self.0.lock().expect("no panic").clone()
    }
}

struct Folder {
    folder: String,
    texts: BTreeMap<String, String>,
}

impl Disk for Texts {
    fn folder_of(&self, path: &str) -> Box<dyn Loader> {
        let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
        Box::new(Folder { folder, texts: self.all() })
    }

    fn sources(&self, folder: &str) -> Vec<(String, String)> {
        let within = |(path, text): (&String, &String)| {
            let name = path.strip_prefix(folder)?.strip_prefix('/')?;
            (!name.contains('/')).then(|| (name.to_owned(), text.clone()))
        };
        self.all().iter().filter_map(within).collect()
    }
}

impl Loader for Folder {
    fn name(&mut self, path: &str) -> Result<String, String> {
        let is_there = self.texts.contains_key(&format!("{}/{path}", self.folder));
        if is_there { Ok(path.to_owned()) } else { Err("no such file".to_owned()) }
    }

    fn read(&mut self, name: &str) -> Result<String, String> {
        let text = self.texts.get(&format!("{}/{name}", self.folder));
        text.cloned().ok_or_else(|| "no such file".to_owned())
    }
}

/// What a request came to.
pub(crate) type Answer = Result<Value, (i64, String)>;

pub(crate) struct Editor {
    connection: Connection,
    server: JoinHandle<Ended>,
    next_id: i32,
    version: i64,
    /// The newest diagnostics of each file.
    published: BTreeMap<String, Vec<Value>>,
    /// How often diagnostics were published of each file.
    pub(crate) publications: BTreeMap<String, usize>,
}

impl Editor {
    /// One that has been initialized.
    pub(crate) fn new() -> Self {
        Self::with_disk(Texts::default())
    }

    /// The same with files.
    pub(crate) fn with_disk(disk: Texts) -> Self {
        let mut editor = Self::uninitialized(disk);
        let can = json!({ "didChangeWatchedFiles": { "dynamicRegistration": true } });
        let can = json!({ "capabilities": { "workspace": can } });
        editor.ask("initialize", can).expect("it is initialized");
        editor.tell("initialized", json!({}));
        editor
    }

    /// One that has not said a word.
    pub(crate) fn uninitialized(disk: Texts) -> Self {
        let (server, connection) = Connection::memory();
        let server = std::thread::spawn(move || serve(&server, Box::new(disk)));
        let (published, publications) = (BTreeMap::new(), BTreeMap::new());
        Self { connection, server, next_id: 100, version: 1, published, publications }
    }

    /// Send a notification.
    pub(crate) fn tell(&self, method: &str, params: Value) {
        self.send(Notification::new(method.to_owned(), params).into());
    }

    /// Send a message.
    pub(crate) fn send(&self, message: Message) {
        self.connection.sender.send(message).expect("the server is there");
    }

    /// Send a request without waiting for its answer.
    pub(crate) fn begin(&mut self, method: &str, params: Value) -> RequestId {
        self.next_id += 1;
        let id = RequestId::from(self.next_id);
        self.send(Request::new(id.clone(), method.to_owned(), params).into());
        id
    }

    /// The answer to a request; what is published meanwhile is kept.
    pub(crate) fn end(&mut self, id: &RequestId) -> Answer {
        loop {
            let message = self.connection.receiver.recv_timeout(PATIENCE).expect("an answer");
            match message {
                Message::Response(response) if response.id == *id => {
                    let error =
                        |error: lsp_server::ResponseError| (i64::from(error.code), error.message);
                    return response.response_result.map_err(error);
                }
                Message::Response(response) => panic!("nobody asked for {response:?}"),
                Message::Notification(notification) => self.note(notification),
                Message::Request(request) => {
                    assert_eq!(request.method, "client/registerCapability");
                }
            }
        }
    }

    /// Ask, and wait for the answer.
    pub(crate) fn ask(&mut self, method: &str, params: Value) -> Answer {
        let id = self.begin(method, params);
        self.end(&id)
    }

    fn note(&mut self, notification: Notification) {
        assert_eq!(notification.method, "textDocument/publishDiagnostics");
        let uri = notification.params["uri"].as_str().expect("an address").to_owned();
        let found = notification.params["diagnostics"].as_array().expect("a list").clone();
        *self.publications.entry(uri.clone()).or_default() += 1;
        self.published.insert(uri, found);
    }

    /// Open a text.
    pub(crate) fn open(&mut self, name: &str, text: &str) {
        let document =
            json!({ "uri": uri(name), "languageId": "obverse", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Change a text as editors do.
    pub(crate) fn change(&mut self, name: &str, changes: Value) {
        self.version += 1;
        let document = json!({ "uri": uri(name), "version": self.version });
        let params = json!({ "textDocument": document, "contentChanges": changes });
        self.tell("textDocument/didChange", params);
    }

    /// What is wrong with a file, when all that was said has been heard.
    pub(crate) fn diagnostics(&mut self, name: &str) -> Vec<Value> {
        loop {
            let Ok(message) = self.connection.receiver.recv_timeout(PATIENCE) else {
                panic!("nothing was published of {name}");
            };
            match message {
                Message::Notification(notification) => {
                    let is_it = notification.params["uri"] == uri(name);
                    self.note(notification);
                    if is_it {
                        return self.published[&uri(name)].clone();
                    }
                }
                Message::Request(_) => {}
                Message::Response(response) => panic!("nobody asked for {response:?}"),
            }
        }
    }

    /// What a question of this name about a place is answered with.
    pub(crate) fn at(&mut self, method: &str, name: &str, position: Value) -> Answer {
        let params = json!({ "textDocument": { "uri": uri(name) }, "position": position });
        self.ask(&format!("textDocument/{method}"), params)
    }

    /// What a question of this name about a whole text is answered with.
    pub(crate) fn of(&mut self, method: &str, name: &str) -> Value {
        let params = json!({ "textDocument": { "uri": uri(name) } });
        self.ask(&format!("textDocument/{method}"), params).expect("an answer")
    }

    /// Shut down and exit.
    pub(crate) fn leave(mut self) -> Ended {
        self.ask("shutdown", Value::Null).expect("it shuts down");
        self.exit()
    }

    /// Exit at once.
    pub(crate) fn exit(self) -> Ended {
        self.tell("exit", Value::Null);
        self.server.join().expect("no panic")
    }

    /// Go away without a word.
    pub(crate) fn vanish(self) -> Ended {
        let Self { connection, server, .. } = self;
        drop(connection);
        server.join().expect("no panic")
    }
}

/// The address of a file.
pub(crate) fn uri(name: &str) -> String {
    format!("file://{FOLDER}/{name}")
}

/// A source without its marks, and where they were: from `«` to `»`, in the protocol's words.
pub(crate) fn marked(source: &str) -> (String, Vec<Value>) {
    let (mut text, mut places, mut open) = (String::new(), Vec::new(), Vec::new());
    let (mut line, mut character) = (0, 0);
    for c in source.chars() {
        match c {
            '«' => open.push(json!({ "line": line, "character": character })),
            '»' => {
                let end = json!({ "line": line, "character": character });
                let start = open.pop().expect("it was opened");
                places.push(json!({ "start": start, "end": end }));
            }
            c => {
                text.push(c);
                character += c.len_utf16();
                if c == '\n' {
                    (line, character) = (line + 1, 0);
                }
            }
        }
    }
    (text, places)
}

/// An editor with one text that has marks, and its places.
pub(crate) fn opened(source: &str) -> (Editor, Vec<Value>) {
    let (text, places) = marked(source);
    let mut editor = Editor::new();
    editor.open("main.obv", &text);
    (editor, places)
}

/// The text of a hover.
pub(crate) fn hover(source: &str) -> String {
    let (mut editor, places) = opened(source);
    let answer = editor.at("hover", "main.obv", places[0]["start"].clone()).expect("an answer");
    answer["contents"]["value"].as_str().unwrap_or_default().to_owned()
}

/// What is offered at the mark.
pub(crate) fn offered(source: &str) -> Vec<String> {
    let (mut editor, places) = opened(source);
    let answer = editor.at("completion", "main.obv", places[0]["end"].clone()).expect("a list");
    let items = answer["items"].as_array().expect("a list").iter();
    items.map(|item| item["label"].as_str().expect("a label").to_owned()).collect()
}

/// A text with edits done, as an editor does them: all of the text as it was.
pub(crate) fn edited(text: &str, edits: &Value) -> String {
    let lines: Vec<usize> =
        std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
    let offset = |place: &Value| {
        let line = place["line"].as_u64().expect("a line") as usize;
        let character = place["character"].as_u64().expect("a character") as usize;
        let start = lines.get(line).copied().unwrap_or(text.len());
        let mut units = 0;
        let within = text[start..].char_indices().find(|(_, c)| {
            let is_there = units >= character;
            units += c.len_utf16();
            is_there
        });
        within.map_or(text.len(), |(at, _)| start + at)
    };
    let mut edits: Vec<(usize, usize, &str)> = edits
        .as_array()
        .expect("edits")
        .iter()
        .map(|edit| {
            let range = &edit["range"];
            let new = edit["newText"].as_str().expect("a text");
            (offset(&range["start"]), offset(&range["end"]), new)
        })
        .collect();
    edits.sort_unstable();
    let mut text = text.to_owned();
    for (start, end, new) in edits.into_iter().rev() {
        text.replace_range(start..end, new);
    }
    text
}
