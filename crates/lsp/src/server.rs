//! The language server: requests in their order, notifications, and diagnostics when there is
//! nothing else to do. It knows the protocol, and of a program only what [`Workspace`] says; how
//! messages come and go is known elsewhere.

mod answer;

use crate::disk::Disk;
use crate::workspace::Workspace;
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::{
    DidChangeTextDocumentParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams,
    LspNotificationMethod, PublishDiagnosticsParams, Uri,
};
use serde::de::DeserializeOwned;
use std::collections::{BTreeSet, VecDeque};

/// How a server ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// It was told to exit after it had been told to shut down.
    Properly,
    /// It was told to exit at once.
    AtOnce,
    /// The editor went away without a word.
    Alone,
}

/// Serve an editor until it goes away. It is told of what is open, and asks about it.
pub fn serve(connection: &Connection, disk: Box<dyn Disk>) -> Ended {
    let mut server = Server {
        connection,
        workspace: Workspace::new(disk),
        queue: VecDeque::new(),
        stage: Stage::Uninitialized,
        is_stale: false,
        can_watch: false,
        published: BTreeSet::new(),
    };
    server.run()
}

/// What may be asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Nothing but to be initialized.
    Uninitialized,
    /// Everything.
    Serving,
    /// Nothing but to exit.
    ShutDown,
}

struct Server<'c> {
    connection: &'c Connection,
    workspace: Workspace,
    /// What has come and is not done yet.
    queue: VecDeque<Message>,
    stage: Stage,
    /// Whether texts have changed since diagnostics were published.
    is_stale: bool,
    /// Whether the editor can be asked to tell of files that change on the disk.
    can_watch: bool,
    /// What diagnostics were published of, and may have to be taken back.
    published: BTreeSet<String>,
}

impl Server<'_> {
    fn run(&mut self) -> Ended {
        loop {
            self.take_what_came();
            let Some(message) = self.queue.pop_front() else {
                // Of several changes in a row the last one counts.
                self.publish();
                match self.connection.receiver.recv() {
                    Ok(message) => self.queue.push_back(message),
                    Err(_) => return Ended::Alone,
                }
                continue;
            };
            match message {
                Message::Request(request) => self.request(request),
                Message::Notification(notification) if notification.method == "exit" => {
                    return match self.stage {
                        Stage::ShutDown => Ended::Properly,
                        Stage::Uninitialized | Stage::Serving => Ended::AtOnce,
                    };
                }
                Message::Notification(notification) => self.notification(notification),
                // Nothing is asked of the editor whose answer matters.
                Message::Response(_) => {}
            }
        }
    }

    /// Take all that has come, so that what is cancelled meanwhile is not begun.
    fn take_what_came(&mut self) {
        while let Ok(message) = self.connection.receiver.try_recv() {
            match cancelled(&message) {
                Some(id) => self.cancel(&id),
                None => self.queue.push_back(message),
            }
        }
    }

    fn cancel(&mut self, id: &RequestId) {
        let is_it = |message: &Message| matches!(message, Message::Request(one) if one.id == *id);
        if let Some(at) = self.queue.iter().position(is_it) {
            self.queue.remove(at);
            self.refuse(id.clone(), ErrorCode::RequestCanceled, "cancelled");
        }
    }

    fn send(&self, message: impl Into<Message>) {
        // Whoever went away hears nothing; the next message that does not come ends the server.
        let _ = self.connection.sender.send(message.into());
    }

    fn refuse(&self, id: RequestId, code: ErrorCode, why: &str) {
        self.send(Response::new_err(id, code as i32, why.to_owned()));
    }

    fn request(&mut self, request: Request) {
        match (self.stage, request.method.as_str()) {
            (Stage::Uninitialized, "initialize") => {
                self.stage = Stage::Serving;
                self.can_watch = answer::can_watch(&request.params);
                let can_have_none = answer::can_have_none_active(&request.params);
                self.workspace.can_have_none_active = can_have_none;
                self.send(Response::new_ok(request.id, answer::initialized()));
            }
            (Stage::Uninitialized, _) => {
                let why = "the server is not initialized";
                self.refuse(request.id, ErrorCode::ServerNotInitialized, why);
            }
            (Stage::Serving, "initialize") => {
                let why = "the server is initialized already";
                self.refuse(request.id, ErrorCode::InvalidRequest, why);
            }
            (Stage::Serving, "shutdown") => {
                self.stage = Stage::ShutDown;
                self.send(Response::new_ok(request.id, ()));
            }
            (Stage::Serving, _) => {
                let response = answer::answer(&mut self.workspace, request);
                self.send(response);
            }
            (Stage::ShutDown, _) => {
                let why = "the server is shut down";
                self.refuse(request.id, ErrorCode::InvalidRequest, why);
            }
        }
    }

    fn notification(&mut self, notification: Notification) {
        if self.stage != Stage::Serving {
            return;
        }
        use LspNotificationMethod as Method;
        let Notification { method, params } = notification;
        match Method::from(method.as_str()) {
            Method::Initialized => self.watch_files(),
            Method::TextDocumentDidOpen => {
                let Some(opened) = read::<DidOpenTextDocumentParams>(params) else { return };
                let document = opened.text_document;
                self.workspace.open(document.uri, document.version, document.text);
                self.is_stale = true;
            }
            Method::TextDocumentDidChange => {
                let Some(changed) = read::<DidChangeTextDocumentParams>(params) else { return };
                let document = changed.text_document;
                let uri = document.text_document_identifier.uri;
                self.workspace.change(&uri, document.version, changed.content_changes);
                self.is_stale = true;
            }
            Method::TextDocumentDidClose => {
                let Some(closed) = read::<DidCloseTextDocumentParams>(params) else { return };
                self.workspace.close(&closed.text_document.uri);
                self.is_stale = true;
            }
            Method::WorkspaceDidChangeWatchedFiles | Method::TextDocumentDidSave => {
                self.workspace.forget();
                self.is_stale = true;
            }
            // What is not known and may be left alone begins with `$/`; the rest tells nothing.
            _ => {}
        }
    }

    /// Ask the editor to tell of files that change on the disk. With one that cannot, files are
    /// read again when something is opened, saved or closed.
    fn watch_files(&mut self) {
        if self.can_watch {
            self.send(answer::watching());
        }
    }

    /// Publish what is wrong, if that may have changed.
    fn publish(&mut self) {
        if !std::mem::take(&mut self.is_stale) {
            return;
        }
        let found = self.workspace.diagnostics();
        let now: BTreeSet<String> = found.iter().map(|(uri, ..)| uri.0.clone()).collect();
        for gone in self.published.difference(&now) {
            let uri = Uri(gone.clone());
            self.tell(PublishDiagnosticsParams::new(uri, None, Vec::new()));
        }
        for (uri, version, diagnostics) in found {
            self.tell(PublishDiagnosticsParams::new(uri, version, diagnostics));
        }
        self.published = now;
    }

    fn tell(&self, diagnostics: PublishDiagnosticsParams) {
        let method = "textDocument/publishDiagnostics".to_owned();
        self.send(Notification::new(method, diagnostics));
    }
}

/// What a message cancels.
fn cancelled(message: &Message) -> Option<RequestId> {
    match message {
        Message::Notification(one) if one.method == "$/cancelRequest" => {
            serde_json::from_value(one.params.get("id")?.clone()).ok()
        }
        _ => None,
    }
}

/// What a notification says; one that says nothing that can be read is passed over.
fn read<P: DeserializeOwned>(params: serde_json::Value) -> Option<P> {
    serde_json::from_value(params).ok()
}
