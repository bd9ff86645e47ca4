//! The reference page of the instruction set, written from the table.

use crate::columns::{Class, Family, StackItem};
use crate::instr::{OPS, OpInfo};
use crate::operand::OperandKind;
use std::fmt::Write;

/// The whole reference page, as Markdown.
#[must_use]
pub fn page() -> String {
    let mut page = String::from(HEAD);
    for family in Family::ALL {
        let _ = write!(page, "\n## {}\n\n{}\n\n", family.name(), describe(family));
        page.push_str("| code | mnemonic | operands | stack | class | what it does |\n");
        page.push_str("| --- | --- | --- | --- | --- | --- |\n");
        for row in OPS.iter().filter(|row| row.family == family) {
            let _ = writeln!(
                page,
                "| 0x{:02x} | `{}` | {} | {} | {} | {} |",
                row.code,
                row.mnemonic,
                operands(row),
                stack_picture(row),
                row.class,
                prose(row),
            );
        }
    }
    page
}

const HEAD: &str = "\
# The instruction set

Written by the tests from `isa/src/table.rs`; do not edit. `UPDATE=1 cargo test --test isa`
refreshes it. An instruction is eight bytes: its code, its operands in order, zeros. `prefix` is
the number of pure instructions before an effect in its statement, and the assembler fills it in.
";

fn describe(family: Family) -> &'static str {
    match family {
        Family::Value => {
            "Pure instructions: they touch the operand stack alone, cost no tape, and are undone \
             by running the prefix of their statement again up to the one before."
        }
        Family::Variable => "Variables. A store saves the former value; an update is undone.",
        Family::Flow => {
            "Where the program goes on. Every jump lands on a join in the same step, and the join \
             knows how to find its way back."
        }
        Family::Frame => {
            "Calls and returns. A frame that dies is saved; a call and a return are each one step."
        }
        Family::Setting => "What holds for the motions that follow, by identity.",
        Family::Kinematic => "Motions of the arm. The tape keeps joint values, never poses.",
        Family::Sense => "Readings of the outside, stored into a variable.",
        Family::Io => "Digital outputs and time.",
        Family::Reversal => "How far, and how, a program can be reversed.",
        Family::Error => "The errors that the program has raised and not yet dealt with.",
        Family::Task => {
            "Branches that take turns. A turn ends when an act is done and what came of it has \
             been read, and one switch on the tape says whose it was and how many steps it took. \
             While an error is pending, the others are held."
        }
    }
}

/// The documentation of a row in one line.
#[must_use]
pub fn prose(row: &OpInfo) -> String {
    row.doc.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ")
}

/// The stack picture of a row: what it pops, `--`, what it pushes; empty if neither.
#[must_use]
pub fn stack_picture(row: &OpInfo) -> String {
    if row.pops.is_empty() && row.pushes.is_empty() {
        return String::new();
    }
    let words =
        |items: &[StackItem]| items.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    format!("{} -- {}", words(row.pops), words(row.pushes)).trim().to_owned()
}

/// The operands that are written in assembly text, by name.
#[must_use]
pub fn operands(row: &OpInfo) -> String {
    row.operands
        .iter()
        .filter(|(_, kind)| *kind != OperandKind::Prefix)
        .map(|(name, _)| *name)
        .collect::<Vec<_>>()
        .join(", ")
}

/// A page about one instruction, as text for a terminal.
#[must_use]
pub fn explain(row: &OpInfo) -> String {
    let mut text = format!("{} (0x{:02x}, {})\n\n", row.mnemonic, row.code, row.family.name());
    let _ = writeln!(text, "{}\n", prose(row));
    let operands = operands(row);
    if !operands.is_empty() {
        let _ = writeln!(text, "operands  {operands}");
    }
    let picture = stack_picture(row);
    if !picture.is_empty() {
        let _ = writeln!(text, "stack     {picture}");
    }
    let _ = writeln!(text, "class     {}", row.class.name());
    let _ = match row.class {
        Class::Always => writeln!(text, "          reversed in any state, without a record"),
        Class::AfterForward(kind) => {
            writeln!(text, "          reversed from what it recorded: {}", kind.name())
        }
        Class::Never(why) => writeln!(text, "          never reversed: {why}"),
    };
    text
}
