//! The tests of the compiler, by source text: what each construct becomes, what each mistake is
//! called and where, and that whatever compiles keeps the rules of the verifier.

mod allow;
mod codes;
mod common;
mod diagnostics;
mod elsewhere;
mod errors;
mod expressions;
mod flow;
mod forks;
mod generated;
mod guarded;
mod imports;
mod incidents;
mod invert;
mod library;
mod limits;
mod module;
mod parameters;
mod recursion;
mod reversal;
mod reversal_mistakes;
mod reversal_words;
mod shortfalls;
mod statements;
mod symbols;
mod turns;
mod vain;
