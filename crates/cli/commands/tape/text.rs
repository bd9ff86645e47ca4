//! A tape in tables that people read.

use super::Shown;
use super::cost::per;
use super::notes;
use crate::report::Lines;
use crate::story::said;
use crate::write;
use obverse_bytecode::Module;

/// So many records are shown where no number is given.
pub(super) const RECORDS: usize = 40;
/// So many instructions are shown, the most expensive first.
const INSTRUCTIONS: usize = 10;

pub(super) fn show(shown: &Shown<'_>, records: usize) {
    let (module, file) = (shown.module, shown.file);
    let source = module.sources.first().map_or("a program", |source| source.name.as_str());
    write::line(&format!("{source}, fingerprint {:016x}, seed {}", file.fingerprint, file.seed));
    write::line(&format!("ended: {}", file.ending));
    show_records(shown, records);
    show_notes(shown);
    by_opcode(shown);
    by_instruction(shown);
    by_command(shown);
    totals(shown);
}

fn show_records(shown: &Shown<'_>, records: usize) {
    let (module, entries) = (shown.module, &shown.walk.entries);
    let lines = Lines::new(module);
    let width = lines.width();
    write::line(&format!(
        "\n{:>6}  {:18} {:>width$}  {:40} record, newest first",
        "instr", "opcode", "line", "source"
    ));
    for entry in entries.iter().take(records) {
        let place = placed(module, &lines, entry.pc);
        write::line(&format!("{place} {}", entry.what));
    }
    let hidden = entries.len().saturating_sub(records);
    if hidden > 0 {
        write::line(&format!("        and {hidden} more; --records {} shows them", entries.len()));
    }
}

/// What happened in recoveries, if there were any.
fn show_notes(shown: &Shown<'_>) {
    let all = &shown.file.streams.notes;
    if all.iter().next().is_none() {
        return;
    }
    write::line("\nrecoveries, oldest first");
    for note in all.iter() {
        write::line(&notes::line(shown.module, note));
    }
    if all.dropped() > 0 {
        write::line(&format!("  and {} before them, which are not kept", all.dropped()));
    }
}

/// An instruction, with its opcode, line and source text, in columns.
fn placed(module: &Module, lines: &Lines<'_>, pc: u32) -> String {
    let mnemonic = module.code[pc as usize].info().mnemonic;
    let (line, width) = (lines.shown(pc), lines.width());
    format!("{pc:>6}  {mnemonic:18} {line:>width$}  {:40}", said(module, pc))
}

fn by_opcode(shown: &Shown<'_>) {
    write::line(&format!("\n{:18} {:>8} {:>10} {:>12}", "opcode", "records", "bits", "bits each"));
    for ((mnemonic, is_command), cost) in &shown.costs.by_opcode {
        let (records, bits, each) = (cost.records, cost.bits, cost.each());
        let command = if *is_command { "  robot command" } else { "" };
        write::line(&format!("{mnemonic:18} {records:>8} {bits:>10} {each:>12.1}{command}"));
    }
}

fn by_instruction(shown: &Shown<'_>) {
    let all = &shown.costs.by_instruction;
    let lines = Lines::new(shown.module);
    let width = lines.width();
    write::line(&format!(
        "\n{:>6}  {:18} {:>width$}  {:40} {:>8} {:>10}",
        "instr", "opcode", "line", "source", "records", "bits"
    ));
    for (pc, cost) in all.iter().take(INSTRUCTIONS) {
        let place = placed(shown.module, &lines, *pc);
        write::line(&format!("{place} {:>8} {:>10}", cost.records, cost.bits));
    }
    let hidden = all.get(INSTRUCTIONS..).unwrap_or_default();
    if !hidden.is_empty() {
        let bits: u64 = hidden.iter().map(|(_, cost)| cost.bits).sum();
        let count = hidden.len();
        write::line(&format!("        and {count} more, with {bits} bits; --json tells them all"));
    }
}

fn by_command(shown: &Shown<'_>) {
    let (commands, cost) = (shown.walk.commands, shown.costs.of_commands);
    write::line(&format!(
        "\n{commands} robot commands: {} records, {} bits, {:.1} bits a command",
        cost.records,
        cost.bits,
        per(cost.bits, commands)
    ));
}

fn totals(shown: &Shown<'_>) {
    let live = shown.costs.total.bits + shown.walk.left_bits;
    let dropped = shown.file.streams.dropped_bits;
    write::line(&format!("{live} bits are on the tape, {dropped} were dropped"));
    if shown.walk.left_bits > 0 {
        write::line(&format!("{} of them are not shown here", shown.walk.left_bits));
    }
    write::line(&format!("they lead back to {}", shown.walk.end.words(shown.module)));
}
