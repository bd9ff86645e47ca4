//! `obverse explain`: explain an opcode, the code of a diagnostic, or that of a check of moves.

use super::Result;
use crate::problem::Problem;
use crate::{Outcome, write};
use obverse_bytecode::ModuleCode;
use obverse_codes::Page;
use obverse_isa::{OPS, Opcode, reference};
use obverse_preflight::Reason;
use obverse_recovery::MemoryCode;
use obverse_sim::CellCode;
use obverse_syntax::codes::Code;
use serde_json::{Value, json};

/// How wide prose is set.
const COLUMNS: usize = 80;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// A mnemonic such as `move.joint`, or a code such as `E0201`, `C0102` or `P0501`; without one,
    /// the codes are listed.
    word: Option<String>,
    /// For machines: JSON Lines, an object a code or opcode and a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let Some(word) = arguments.word.as_deref().map(str::trim) else {
        list(arguments.json);
        return Ok(Outcome::Done);
    };
    if arguments.json {
        return as_json(word);
    }
    if let Some(opcode) = Opcode::from_mnemonic(&word.to_lowercase()) {
        write::out(&set(&reference::explain(opcode.info())));
        return Ok(Outcome::Done);
    }
    if let Some(page) = page(word) {
        write::out(&set(&page.explanation()));
        return Ok(Outcome::Done);
    }
    if let Ok(reason) = word.parse::<Reason>() {
        write::out(&set(reason.explanation()));
        return Ok(Outcome::Done);
    }
    Err(unknown(word))
}

/// Every code of a diagnostic and of a reason with its title, a line each.
fn list(is_json: bool) {
    if is_json {
        let codes = pages().map(|page| of_code(&page));
        tell(codes.chain(Reason::ALL.iter().map(|reason| of_reason(*reason))));
        return;
    }
    for Page { code, title, .. } in pages() {
        write::line(&format!("{code}  {title}"));
    }
    for reason in Reason::ALL {
        write::line(&format!("{}  {}", reason.code(), reason.title()));
    }
}

fn as_json(word: &str) -> Result {
    if let Some(opcode) = Opcode::from_mnemonic(&word.to_lowercase()) {
        let row = opcode.info();
        tell(std::iter::once(json!({
            "type": "opcode",
            "mnemonic": row.mnemonic,
            "class": row.class.name(),
            "explanation": reference::explain(row),
        })));
        return Ok(Outcome::Done);
    }
    if let Ok(reason) = word.parse::<Reason>() {
        tell(std::iter::once(of_reason(reason)));
        return Ok(Outcome::Done);
    }
    let page = page(word).ok_or_else(|| unknown(word))?;
    tell(std::iter::once(of_code(&page)));
    Ok(Outcome::Done)
}

/// The pages of the codes of programs, of workcells, of assembly text and modules, and of memories.
fn pages() -> impl Iterator<Item = Page> {
    Code::pages().chain(CellCode::pages()).chain(ModuleCode::pages()).chain(MemoryCode::pages())
}

/// What is known of a code, however it is written.
fn page(word: &str) -> Option<Page> {
    pages().find(|page| page.code.eq_ignore_ascii_case(word))
}

fn of_code(page: &Page) -> Value {
    json!({
        "type": "code",
        "code": page.code,
        "title": page.title,
        "explanation": page.explanation(),
        "wrong": page.wrong,
        "right": page.right,
    })
}

fn of_reason(reason: Reason) -> Value {
    json!({
        "type": "reason",
        "code": reason.code(),
        "title": reason.title(),
        "explanation": reason.explanation(),
    })
}

fn tell(objects: impl Iterator<Item = Value>) {
    let mut count = 0;
    for object in objects {
        write::line(&object.to_string());
        count += 1;
    }
    write::line(&json!({ "type": "summary", "outcome": "done", "explained": count }).to_string());
}

fn unknown(word: &str) -> Problem {
    let codes = pages().map(|page| page.code);
    let reasons = Reason::ALL.iter().map(|reason| reason.code());
    let words = OPS.iter().map(|row| row.mnemonic).chain(codes).chain(reasons);
    let near = obverse_syntax::nearest(word, words);
    let hint = near.map_or_else(
        || "`obverse isa` lists the opcodes, and `obverse explain` the codes".to_owned(),
        |near| format!("did you mean `{near}`?"),
    );
    Problem::new(format!("`{word}` is neither an opcode nor a code; {hint}"))
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
