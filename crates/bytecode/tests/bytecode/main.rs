//! The tests of the crate from outside: text, bytes, verifier, builder.

mod builder;
mod codec;
mod module;
mod support;
mod text;
mod text_errors;
mod verifier;
