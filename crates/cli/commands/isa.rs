//! `obverse isa`: show the instruction set.

use super::Result;
use crate::{Outcome, write};
use obverse_isa::{Class, FINGERPRINT, OPS, OpInfo, OperandKind, reference};
use serde_json::{Value, json};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// For machines: one JSON object.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    if arguments.json {
        let table = json!({
            "fingerprint": format!("{FINGERPRINT:016x}"),
            "opcodes": OPS.iter().map(row).collect::<Vec<_>>(),
        });
        write::line(&table.to_string());
    } else {
        write::out(&listing());
    }
    Ok(Outcome::Done)
}

fn row(info: &OpInfo) -> Value {
    let (record, why) = match info.class {
        Class::Always => (None, None),
        Class::AfterForward(kind) => (Some(kind.name()), None),
        Class::Never(why) => (None, Some(why)),
    };
    let operand = |(name, kind): &(&str, OperandKind)| {
        let kind = format!("{kind:?}").to_lowercase();
        json!({ "name": name, "kind": kind })
    };
    let words = |items: &[obverse_isa::StackItem]| {
        items.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    json!({
        "code": info.code,
        "mnemonic": info.mnemonic,
        "operands": info.operands.iter().map(operand).collect::<Vec<_>>(),
        "pops": words(info.pops),
        "pushes": words(info.pushes),
        "class": info.class.name(),
        "record": record,
        "why": why,
        "family": info.family.name(),
        "doc": reference::prose(info),
    })
}

fn listing() -> String {
    let rows: Vec<[String; 3]> = OPS.iter().map(columns).collect();
    let width = |column: usize| {
        rows.iter().map(|row| row[column].chars().count()).max().unwrap_or_default()
    };
    let [mnemonic, class, stack] = [0, 1, 2].map(width);
    let mut text = String::new();
    let mut family = None;
    for (info, row) in OPS.iter().zip(&rows) {
        if family.replace(info.family) != Some(info.family) {
            text.push_str(&format!("\n{}\n", info.family.name()));
        }
        let summary = reference::prose(info);
        let summary = summary.split(". ").next().unwrap_or_default().trim_end_matches('.');
        text.push_str(&format!(
            "  {:02x}  {:mnemonic$}  {:class$}  {:stack$}  {summary}\n",
            info.code, row[0], row[1], row[2],
        ));
    }
    text.trim_start().to_owned()
}

/// Mnemonic, class and stack effect.
fn columns(info: &OpInfo) -> [String; 3] {
    let class = match info.class {
        Class::AfterForward(kind) => format!("{}({})", info.class.name(), kind.name()),
        Class::Always | Class::Never(_) => info.class.name().to_owned(),
    };
    [info.mnemonic.to_owned(), class, reference::stack_picture(info)]
}
