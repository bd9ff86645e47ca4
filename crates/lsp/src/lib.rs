//! The language for editors: what stands where, what it means, how far it can be taken back.
//!
//! [`Workspace`] holds what is open and answers questions about it, data in and data out; [`serve`]
//! speaks the Language Server Protocol over a connection. Read `workspace` and `program`, then
//! `steps` (what is known of going back), then a module a question: `diagnostics`, `hover` with
//! `backwards`, `navigate`, `rename`, `completion` and `signature` with `forms` (both look at what
//! is written `before`), `tokens`, `hints`; `headers` mends what is half written. Files are read
//! by whoever gives a [`Disk`]. Nothing here runs a program, prints, or knows a machine.

mod backwards;
mod before;
mod completion;
mod diagnostics;
mod disk;
mod feeling;
mod forms;
mod headers;
mod hints;
mod hover;
mod navigate;
mod position;
mod program;
mod rename;
mod server;
mod signature;
mod steps;
mod tokens;
mod uri;
mod workspace;

pub use disk::{Disk, Lacking, NoDisk};
pub use rename::Refusal;
pub use server::{Ended, serve};
pub use tokens::legend;
pub use uri::LIBRARY_SCHEME;
pub use workspace::Workspace;
