//! `obverse tape`: show what is on a recorded tape, newest first, and what it costs by instruction
//! and by robot command.
//!
//! The tape has no tags: a record's meaning follows from the instruction that will pop it. So the
//! listing walks a machine back over the tape, with a workcell that moves nothing.

use super::Result;
use crate::problem::{Message, Problem};
use crate::report;
use crate::story::said;
use crate::{Outcome, load, write};
use obverse_bytecode::{Module, Verified, verify};
use obverse_geometry::JointConfiguration;
use obverse_isa::Instr;
use obverse_recovery::Ending;
use obverse_tape::{Place, TapeFile};
use obverse_vm::{Direction, Machine, Stop};
use obverse_workcell::Shadow;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The tape file.
    file: PathBuf,
    /// Show at most so many records.
    #[arg(long, default_value_t = 40, value_name = "N")]
    records: usize,
    /// For machines: JSON Lines, a summary last.
    #[arg(long)]
    json: bool,
}

/// What one instruction's records cost.
#[derive(Default)]
struct Cost {
    records: u64,
    bits: u64,
    commands: bool,
}

/// One record as the walk meets it.
struct Entry {
    pc: u32,
    size: Place,
    what: String,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let path = &arguments.file;
    let (file, module) =
        TapeFile::from_bytes(&load::bytes(path)?).map_err(|error| Problem::of_file(path, error))?;
    let program = verify(module).map_err(|errors| {
        Problem::several(errors.iter().map(|error| Message::of_file(path, error)).collect())
    })?;
    let (entries, stop) = walk(&program, &file).map_err(|error| Problem::of_file(path, error))?;
    let mut costs: BTreeMap<&'static str, Cost> = BTreeMap::new();
    for entry in &entries {
        let info = program.module().code[entry.pc as usize].info();
        let cost = costs.entry(info.mnemonic).or_default();
        cost.records += 1;
        cost.bits += entry.size.size_bits();
        cost.commands = info.family.commands_workcell();
    }
    if arguments.json {
        as_json(arguments, &program, &file, &entries, &costs);
    } else {
        as_text(arguments, &program, &file, &entries, &costs, &stop);
    }
    Ok(Outcome::Done)
}

/// All records, newest first, and where they lead back to.
fn walk(program: &Verified, file: &TapeFile) -> std::result::Result<(Vec<Entry>, Stop), String> {
    let state = &file.state;
    let mut cell = Shadow::new(JointConfiguration(state.joints), state.outputs.clone());
    let mut machine = Machine::from_recording(program, state, &file.streams, &cell)
        .map_err(|error| error.to_string())?;
    let mut entries = Vec::new();
    loop {
        let before = place(&machine);
        let pc = machine.state().pc();
        let is_pending =
            machine.state().pending().is_some_and(|p| p.direction == Direction::Forward);
        let top = newest(&machine);
        match machine.unwind(&mut cell) {
            Ok(()) => {}
            Err(stop @ Stop::Refused(_)) => return Ok((entries, stop)),
            Err(stop @ Stop::AtStart) if is_unused(&machine) => return Ok((entries, stop)),
            Err(Stop::Trap(trap)) => {
                let what = format!("its records do not fit the program: {}", trap.kind);
                return Err(what);
            }
            Err(_) => return Err("its records do not fit the program".to_owned()),
        }
        let size = less(before, place(&machine));
        if size != Place::default() {
            let popped_by = if is_pending { pc } else { pc.saturating_sub(1) };
            // Behind a call, what was taken back is the end of what it called.
            let is_call = matches!(program.module().code[popped_by as usize], Instr::Call { .. });
            let pc = if is_call { machine.state().pc() } else { popped_by };
            entries.push(Entry { pc, size, what: describe(size, &top) });
        }
    }
}

/// Whether nothing is left of the run: no record, and no more steps than lie before the start.
fn is_unused(machine: &Machine<'_>) -> bool {
    machine.tape().is_none_or(obverse_tape::Tape::is_empty)
        && machine.state().steps() == u64::from(machine.state().pc())
}

fn place(machine: &Machine<'_>) -> Place {
    machine.tape().map(obverse_tape::Tape::place).unwrap_or_default()
}

fn less(a: Place, b: Place) -> Place {
    Place { bits: a.bits - b.bits, words: a.words - b.words, joints: a.joints - b.joints }
}

/// The newest record of each stream.
struct Newest {
    bit: Option<bool>,
    word: Option<u64>,
    joints: Option<[f64; 6]>,
}

fn newest(machine: &Machine<'_>) -> Newest {
    let tape = machine.tape();
    Newest {
        bit: tape.and_then(obverse_tape::Tape::newest_bit),
        word: tape.and_then(obverse_tape::Tape::newest_word),
        joints: tape.and_then(obverse_tape::Tape::newest_joints),
    }
}

fn describe(size: Place, top: &Newest) -> String {
    let numbers = |joints: [f64; 6]| {
        let shown: Vec<String> = joints.iter().map(|joint| format!("{joint:.4}")).collect();
        format!("[{}] rad", shown.join(", "))
    };
    match (size, top) {
        (Place { bits: 1, words: 0, joints: 0 }, Newest { bit: Some(bit), .. }) => {
            format!("bit {}", u8::from(*bit))
        }
        (Place { bits: 0, words: 1, joints: 0 }, Newest { word: Some(word), .. }) => {
            format!("word {word:#x}")
        }
        (Place { bits: 0, words: 0, joints: 1 }, Newest { joints: Some(joints), .. }) => {
            format!("joints {}", numbers(*joints))
        }
        (size, _) => format!("frame of {} words, {} positions", size.words, size.joints),
    }
}

fn as_text(
    arguments: &Arguments,
    program: &Verified,
    file: &TapeFile,
    entries: &[Entry],
    costs: &BTreeMap<&'static str, Cost>,
    stop: &Stop,
) {
    let module = program.module();
    let source = module.sources.first().map_or("a program", |source| source.name.as_str());
    write::line(&format!("{source}, fingerprint {:016x}, seed {}", file.fingerprint, file.seed));
    write::line(&format!("ended: {}", file.ending));
    records_as_text(module, entries, arguments.records);
    write::line(&format!("\n{:18} {:>8} {:>10} {:>12}", "opcode", "records", "bits", "bits each"));
    for (mnemonic, cost) in costs {
        let each = cost.bits as f64 / cost.records as f64;
        let command = if cost.commands { "  robot command" } else { "" };
        write::line(&format!(
            "{mnemonic:18} {:>8} {:>10} {each:>12.1}{command}",
            cost.records, cost.bits
        ));
    }
    let live: u64 = costs.values().map(|cost| cost.bits).sum();
    write::line(&format!(
        "\n{live} bits are on the tape, {} were dropped",
        file.streams.dropped_bits
    ));
    write::line(&match stop {
        Stop::Refused(refusal) => {
            let words = report::ending_words(module, &Ending::Refused(*refusal));
            format!("they lead back to {}", words.trim_start_matches("cannot go back past "))
        }
        _ => "they lead back to the start".to_owned(),
    });
}

fn records_as_text(module: &Module, entries: &[Entry], shown: usize) {
    write::line(&format!(
        "\n{:>6}  {:18} {:>5}  {:40} record, newest first",
        "instr", "opcode", "line", "source"
    ));
    for entry in entries.iter().take(shown) {
        let mnemonic = module.code[entry.pc as usize].info().mnemonic;
        let line = module.place_of(entry.pc).map_or_else(String::new, |at| at.1.to_string());
        let text = said(module, entry.pc);
        write::line(&format!("{:>6}  {mnemonic:18} {line:>5}  {text:40} {}", entry.pc, entry.what));
    }
    let hidden = entries.len().saturating_sub(shown);
    if hidden > 0 {
        write::line(&format!("        and {hidden} more; --records {} shows them", entries.len()));
    }
}

fn as_json(
    arguments: &Arguments,
    program: &Verified,
    file: &TapeFile,
    entries: &[Entry],
    costs: &BTreeMap<&'static str, Cost>,
) {
    let module = program.module();
    for entry in entries.iter().take(arguments.records) {
        let line = module.place_of(entry.pc).map(|(_, line, _)| line);
        write::line(
            &json!({
                "type": "record",
                "instruction": entry.pc,
                "opcode": module.code[entry.pc as usize].info().mnemonic,
                "line": line,
                "bits": entry.size.size_bits(),
                "record": entry.what,
            })
            .to_string(),
        );
    }
    let cost = |(mnemonic, cost): (&&str, &Cost)| {
        json!({
            "opcode": mnemonic,
            "records": cost.records,
            "bits": cost.bits,
            "robot_command": cost.commands,
        })
    };
    write::line(
        &json!({
            "type": "summary",
            "fingerprint": format!("{:016x}", file.fingerprint),
            "seed": file.seed,
            "ending": file.ending,
            "records": entries.len(),
            "dropped_bits": file.streams.dropped_bits,
            "costs": costs.iter().map(cost).collect::<Vec<_>>(),
        })
        .to_string(),
    );
}
