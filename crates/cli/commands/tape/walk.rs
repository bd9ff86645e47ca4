//! The records of a tape, newest first.
//!
//! The tape has no tags: a record's meaning follows from the instruction that will pop it. So a
//! machine is walked back over it, with a workcell that moves nothing. What the file says is not
//! believed: a walk has an end, whatever the tape.

use super::{Recorded, value};
use crate::report;
use obverse_bytecode::{Module, Verified};
use obverse_geometry::JointConfiguration;
use obverse_isa::Instr;
use obverse_recovery::Ending;
use obverse_tape::{Place, Tape};
use obverse_vm::{Direction, Machine, Refusal, Stop};
use obverse_workcell::Shadow;

/// So many instructions are walked back at most.
pub(super) const STEPS_MAX: u64 = 1_000_000;

/// What a walk met.
pub(super) struct Walk {
    /// The records, newest first.
    pub(super) entries: Vec<Entry>,
    /// How many robot commands were walked over.
    pub(super) commands: u64,
    /// Where it ended.
    pub(super) end: End,
    /// The bits of the records that it did not come to.
    pub(super) left_bits: u64,
}

/// One record.
pub(super) struct Entry {
    /// The instruction that left it.
    pub(super) pc: u32,
    /// Its size in bits.
    pub(super) bits: u64,
    /// What it holds.
    pub(super) what: String,
}

/// Where a walk ended.
pub(super) enum End {
    /// Where the program began.
    Start,
    /// Behind an instruction that cannot be taken back.
    Refused(Refusal),
    /// Before this instruction, after [`STEPS_MAX`].
    Limit(u32),
}

impl End {
    /// The name, for machines.
    pub(super) fn code(&self) -> &'static str {
        match self {
            Self::Start => "at_start",
            Self::Refused(_) => "refused",
            Self::Limit(_) => "limit",
        }
    }

    /// The instruction.
    pub(super) fn pc(&self) -> Option<u32> {
        match self {
            Self::Start => None,
            Self::Refused(refusal) => Some(refusal.pc),
            Self::Limit(pc) => Some(*pc),
        }
    }

    /// In words, to stand behind "they lead back to".
    pub(super) fn words(&self, module: &Module) -> String {
        match self {
            Self::Start => "the start".to_owned(),
            Self::Refused(refusal) => {
                let words = report::ending_words(module, &Ending::Refused(*refusal));
                words.trim_start_matches("cannot go back past ").to_owned()
            }
            Self::Limit(pc) => format!(
                "{} after {STEPS_MAX} instructions, and further: more are not walked back",
                report::line_of(module, *pc)
            ),
        }
    }
}

/// Walk back over the tape of a file.
pub(super) fn back(program: &Verified, file: &Recorded) -> Result<Walk, String> {
    let state = &file.state;
    let mut cell = Shadow::new(JointConfiguration(state.joints), state.outputs.clone());
    let mut machine = Machine::from_recording(program, state, &file.streams, &cell)
        .map_err(|error| error.to_string())?;
    let mut walk = Walk { entries: Vec::new(), commands: 0, end: End::Start, left_bits: 0 };
    for _ in 0..STEPS_MAX {
        if let Some(end) = step(&mut machine, &mut cell, &mut walk)? {
            walk.end = end;
            walk.left_bits = place(&machine).size_bits();
            return Ok(walk);
        }
    }
    walk.end = End::Limit(machine.state().pc());
    walk.left_bits = place(&machine).size_bits();
    Ok(walk)
}

/// One instruction back; where that is the end, which.
fn step(
    machine: &mut Machine<'_>,
    cell: &mut Shadow,
    walk: &mut Walk,
) -> Result<Option<End>, String> {
    let module = machine.program().module();
    let (before, steps, pc) = (place(machine), machine.state().steps(), machine.state().pc());
    let pending = machine.state().pending();
    let top = value::Newest::of(machine.tape());
    match machine.unwind(cell) {
        Ok(()) => {}
        Err(Stop::Refused(refusal)) => return Ok(Some(End::Refused(refusal))),
        Err(Stop::AtStart) if is_unused(machine) => return Ok(Some(End::Start)),
        Err(Stop::Trap(trap)) => return Err(misfit(&trap.kind.to_string())),
        Err(_) => return Err(misfit("they do not lead back to where it began")),
    }
    // An act that was begun and not finished has not been counted yet.
    let is_settled = pending.is_some() && machine.state().pending().is_none();
    if machine.state().steps() >= steps && !is_settled {
        return Err(misfit("a step back leads no nearer to the start"));
    }
    let is_forward = pending.is_some_and(|pending| pending.direction == Direction::Forward);
    let taken_back = if is_forward { pc } else { pc.saturating_sub(1) };
    let Some(instr) = module.code.get(taken_back as usize) else {
        return Err(misfit("they lead behind the end of its code"));
    };
    walk.commands += u64::from(instr.info().family.commands_workcell());
    let size = less(before, place(machine));
    if size != Place::default() {
        // Behind a call, what was taken back is the end of what it called.
        let is_call = matches!(instr, Instr::Call { .. });
        let pc = if is_call { machine.state().pc() } else { taken_back };
        let what = value::words(module, pc, size, &top);
        walk.entries.push(Entry { pc, bits: size.size_bits(), what });
    }
    Ok(None)
}

fn misfit(why: &str) -> String {
    format!("its records do not fit the program: {why}")
}

/// Whether nothing is left of the run: no record, and no more steps than lie before the start.
fn is_unused(machine: &Machine<'_>) -> bool {
    machine.tape().is_none_or(Tape::is_empty)
        && machine.state().steps() == u64::from(machine.state().pc())
}

fn place(machine: &Machine<'_>) -> Place {
    machine.tape().map(Tape::place).unwrap_or_default()
}

fn less(a: Place, b: Place) -> Place {
    Place {
        bits: a.bits.saturating_sub(b.bits),
        words: a.words.saturating_sub(b.words),
        joints: a.joints.saturating_sub(b.joints),
        control: a.control.saturating_sub(b.control),
        faults: a.faults.saturating_sub(b.faults),
        asides: a.asides.saturating_sub(b.asides),
    }
}
