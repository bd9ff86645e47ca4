//! `obverse explain`: explain an opcode or the code of a diagnostic.

use super::Result;
use crate::show::Problem;
use crate::{Outcome, write};
use obverse_isa::{OPS, Opcode, reference};
use obverse_syntax::codes::Code;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// A mnemonic such as `move.joint`, or a code such as `E0201`.
    word: String,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let word = arguments.word.trim();
    if let Some(opcode) = Opcode::from_mnemonic(word) {
        write::out(&reference::explain(opcode.info()));
        return Ok(Outcome::Done);
    }
    if let Ok(code) = word.to_uppercase().parse::<Code>() {
        write::line(&format!("{code}: {}\n\n{}", code.title(), code.explanation().trim()));
        return Ok(Outcome::Done);
    }
    let words =
        OPS.iter().map(|row| row.mnemonic).chain(Code::ALL.iter().map(|code| code.as_str()));
    let near = obverse_syntax::nearest(word, words);
    let hint = near.map_or_else(
        || "`obverse isa` lists the opcodes".to_owned(),
        |near| format!("did you mean `{near}`?"),
    );
    Err(Problem::new(format!("`{word}` is neither an opcode nor the code of a diagnostic; {hint}")))
}
