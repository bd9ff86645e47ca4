//! A tape for machines: an object a record, and a summary last.

use super::Shown;
use super::cost::{Cost, per};
use super::notes;
use crate::report::{self, Lines};
use crate::story::said;
use crate::write;
use serde_json::{Value, json};

/// Show the newest records, or all where no number is given.
pub(super) fn show(shown: &Shown<'_>, records: Option<usize>) {
    let (module, entries) = (shown.module, &shown.walk.entries);
    let lines = Lines::new(module);
    let told = records.unwrap_or(entries.len()).min(entries.len());
    for entry in &entries[..told] {
        let object = json!({
            "type": "record",
            "instruction": entry.pc,
            "opcode": module.code[entry.pc as usize].info().mnemonic,
            "file": lines.of(entry.pc).map(|(file, _)| file),
            "line": lines.of(entry.pc).map(|(_, line)| line),
            "bits": entry.bits,
            "record": entry.what,
        });
        write::line(&object.to_string());
    }
    let notes = &shown.file.streams.notes;
    for note in notes.iter() {
        write::line(&notes::object(module, note).to_string());
    }
    let summary = json!({
        "type": "summary",
        "outcome": "shown",
        "fingerprint": format!("{:016x}", shown.file.fingerprint),
        "seed": shown.file.seed,
        "ending": shown.file.ending,
        "records": entries.len(),
        "records_not_told": entries.len() - told,
        "bits": shown.costs.total.bits + shown.walk.left_bits,
        "bits_not_walked": shown.walk.left_bits,
        "notes": notes.iter().count(),
        "notes_dropped": notes.dropped(),
        "dropped_bits": shown.file.streams.dropped_bits,
        "back_to": back_to(shown),
        "costs": by_opcode(shown),
        "by_instruction": by_instruction(shown, &lines),
        "by_command": by_command(shown),
    });
    write::line(&summary.to_string());
}

fn back_to(shown: &Shown<'_>) -> Value {
    let end = &shown.walk.end;
    json!({
        "outcome": end.code(),
        "at": report::place(shown.module, end.pc()),
        "message": end.words(shown.module),
    })
}

fn by_opcode(shown: &Shown<'_>) -> Value {
    let cost = |((mnemonic, is_command), cost): (&(&str, bool), &Cost)| {
        json!({
            "opcode": mnemonic,
            "records": cost.records,
            "bits": cost.bits,
            "robot_command": is_command,
        })
    };
    shown.costs.by_opcode.iter().map(cost).collect()
}

fn by_instruction(shown: &Shown<'_>, lines: &Lines<'_>) -> Value {
    let cost = |(pc, cost): &(u32, Cost)| {
        json!({
            "instruction": pc,
            "opcode": shown.module.code[*pc as usize].info().mnemonic,
            "file": lines.of(*pc).map(|(file, _)| file),
            "line": lines.of(*pc).map(|(_, line)| line),
            "text": said(shown.module, *pc),
            "records": cost.records,
            "bits": cost.bits,
        })
    };
    shown.costs.by_instruction.iter().map(cost).collect()
}

fn by_command(shown: &Shown<'_>) -> Value {
    let (commands, cost) = (shown.walk.commands, shown.costs.of_commands);
    json!({
        "commands": commands,
        "records": cost.records,
        "bits": cost.bits,
        "bits_per_command": per(cost.bits, commands),
    })
}
