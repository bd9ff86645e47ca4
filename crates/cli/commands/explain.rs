//! `obverse explain`: explain an opcode, the code of a diagnostic, or that of a check of moves.

use super::Result;
use crate::problem::Problem;
use crate::{Outcome, write};
use obverse_isa::{OPS, Opcode, reference};
use obverse_preflight::Reason;
use obverse_syntax::codes::Code;

/// How wide prose is set.
const COLUMNS: usize = 80;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// A mnemonic such as `move.joint`, or a code such as `E0201` or `P0501`.
    word: String,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let word = arguments.word.trim();
    if let Some(opcode) = Opcode::from_mnemonic(&word.to_lowercase()) {
        write::out(&set(&reference::explain(opcode.info())));
        return Ok(Outcome::Done);
    }
    if let Ok(code) = word.parse::<Code>() {
        write::out(&set(code.explanation()));
        return Ok(Outcome::Done);
    }
    if let Ok(reason) = word.parse::<Reason>() {
        write::out(&set(reason.explanation()));
        return Ok(Outcome::Done);
    }
    let codes = Code::ALL.iter().map(|code| code.as_str());
    let reasons = Reason::ALL.iter().map(|reason| reason.code());
    let words = OPS.iter().map(|row| row.mnemonic).chain(codes).chain(reasons);
    let near = obverse_syntax::nearest(word, words);
    let hint = near.map_or_else(
        || {
            "`obverse isa` lists the opcodes, and diagnostics and checks show their codes"
                .to_owned()
        },
        |near| format!("did you mean `{near}`?"),
    );
    Err(Problem::new(format!("`{word}` is neither an opcode nor a code; {hint}")))
}

/// The lines of a text, broken between words where they are too long.
fn set(text: &str) -> String {
    let mut lines = String::new();
    for line in text.lines() {
        let mut column = 0;
        for word in line.split_inclusive(' ') {
            let width = word.trim_end().chars().count();
            if column > 0 && column + width > COLUMNS {
                lines.truncate(lines.trim_end_matches(' ').len());
                lines.push('\n');
                column = 0;
            }
            lines.push_str(word);
            column += word.chars().count();
        }
        lines.push('\n');
    }
    lines
}
