//! The debug adapter: a session of the debugger, which editors speak to in the Debug Adapter
//! Protocol.
//!
//! Bytes come in and go out; what is to be said to people beside that, and how a program is loaded,
//! is the caller's. A client is not trusted: whatever it sends, it is answered or told why not, and
//! the session stays as it is.
//!
//! Reading order: [`frame`], one message among bytes; [`message`], what is asked; [`arguments`],
//! what a session can begin with; `inbox` and `outbox`, how messages come and go while a run is
//! under way; [`server`], a connection up to where a program is loaded; `begin`, how a session
//! begins; `debuggee`, the session, with `walking` and `motion`, how it is driven, `targets`,
//! where one can go, `points` and `filters`, its breakpoints, `places`, source files and
//! instructions, `shown`, what is looked at, `change`, what is given another value, [`console`],
//! what can be typed, with `stepping`, `jumping`, `looking`, `trying` and `completing`, `words`,
//! what stops are called, and `story`, what is told of recoveries.
//! It knows no files, and no source language.

pub mod arguments;
pub mod frame;
pub mod message;
pub mod server;

mod begin;
mod change;
mod completing;
pub mod console;
mod debuggee;
mod filters;
mod inbox;
mod jumping;
mod looking;
mod motion;
mod outbox;
mod places;
mod points;
mod shown;
mod stepping;
mod story;
mod targets;
mod trying;
mod walking;
mod words;

pub use message::{Attach, Launch, Wanted};
pub use server::{Begin, Ended, Keep, Loaded, OnDisk, serve};
