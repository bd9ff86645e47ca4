//! What a record holds, in words: by the type that the instruction that pops it gives it.

use obverse_bytecode::Module;
use obverse_isa::{Class, GlobalId, Instr, LocalId, RecordKind, Setting, SpeedId, Type};
use obverse_tape::record::{Fault, Switch};
use obverse_tape::{Place, Tape};

/// The newest record of each stream.
pub(super) struct Newest {
    bit: Option<bool>,
    word: Option<u64>,
    joints: Option<[f64; 6]>,
    control: Option<u64>,
    fault: Option<Fault>,
}

impl Newest {
    pub(super) fn of(tape: Option<&Tape>) -> Self {
        Self {
            bit: tape.and_then(Tape::newest_bit),
            word: tape.and_then(Tape::newest_word),
            joints: tape.and_then(Tape::newest_joints),
            control: tape.and_then(Tape::newest_control),
            fault: tape.and_then(Fault::peek),
        }
    }
}

/// What a record of this size holds that an instruction left.
pub(super) fn words(module: &Module, pc: u32, size: Place, top: &Newest) -> String {
    let instr = module.code.get(pc as usize);
    let class = instr.map(|instr| instr.info().class);
    match class {
        Some(Class::AfterForward(RecordKind::Counter)) => return "counter".to_owned(),
        Some(Class::AfterForward(RecordKind::Frame)) => return frame(size),
        _ => {}
    }
    let own = match ((size.bits, size.words, size.joints), top) {
        ((0, 0, 0), _) => None,
        ((1, 0, 0), Newest { bit: Some(bit), .. }) => Some(format!("bit {}", u8::from(*bit))),
        ((0, 1, 0), Newest { word: Some(word), .. }) => {
            Some(instr.map_or_else(|| plain(*word), |instr| word_of(module, pc, instr, *word)))
        }
        ((0, 0, 1), Newest { joints: Some(joints), .. }) => {
            let shown: Vec<String> = joints.iter().map(|joint| format!("{joint:.4}")).collect();
            Some(format!("joints [{}] rad", shown.join(", ")))
        }
        _ => Some(frame(size)),
    };
    let turn = top.control.filter(|_| size.control > 0).map(|word| turn(size.control, word));
    let raised = |fault: Fault| {
        let error = module.errors.get(usize::from(fault.error));
        format!("a fault as error {}", error.map_or("unknown", |error| &error.name))
    };
    let fault = top.fault.filter(|_| size.faults > 0).map(raised);
    let aside = (size.asides > 0).then(|| "where it was made aside".to_owned());
    own.into_iter().chain(turn).chain(fault).chain(aside).collect::<Vec<_>>().join(", ")
}

/// Whose turn ended with the instruction.
fn turn(words: u64, newest: u64) -> String {
    let Switch { task, steps, leaves, .. } = Switch::from_word(newest);
    let ended = format!("end of a turn of branch {} after {}", task + 1, counted(steps, "step"));
    if leaves {
        format!("{ended}, the others held in {}", counted(words.saturating_sub(3), "word"))
    } else {
        ended
    }
}

fn frame(size: Place) -> String {
    let (words, positions) = (counted(size.words, "word"), counted(size.joints, "position"));
    format!("frame of {words}, {positions}")
}

fn counted(count: u64, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// A word, as what the instruction that pops it takes it for.
fn word_of(module: &Module, pc: u32, instr: &Instr, word: u64) -> String {
    match *instr {
        Instr::StoreLocal { local, .. }
        | Instr::SenseInput { local, .. }
        | Instr::SenseForce { local }
        | Instr::SenseDistance { local }
        | Instr::SensePeakForce { local }
        | Instr::SenseHolding { local }
        | Instr::Draw { local }
        | Instr::WaitInput { local, .. } => typed(type_of_local(module, pc, local), word),
        Instr::StoreGlobal { global, .. } => typed(type_of_global(module, global), word),
        // Which number the workcell has for a tool is not on the tape.
        Instr::SettingSet { setting: Setting::Tool, .. } => {
            format!("tool number {word} of the workcell")
        }
        Instr::SettingSet { setting, .. } => typed(Some(setting.of_type()), word),
        Instr::ErrorClear { .. } if word == u64::MAX => "not pending".to_owned(),
        Instr::ErrorClear { .. } => format!("place {word} of those pending"),
        _ => plain(word),
    }
}

fn type_of_local(module: &Module, pc: u32, local: LocalId) -> Option<Type> {
    let function = module.functions.get(module.function_at(pc)?)?;
    function.locals.get(local.index()).map(|variable| variable.of_type)
}

fn type_of_global(module: &Module, global: GlobalId) -> Option<Type> {
    module.globals.get(global.index()).map(|variable| variable.of_type)
}

fn typed(of_type: Option<Type>, word: u64) -> String {
    match of_type {
        Some(Type::Int) => format!("int {}", word.cast_signed()),
        Some(Type::Real) => format!("real {:?}", f64::from_bits(word)),
        Some(Type::Bool) if word <= 1 => format!("bool {}", word == 1),
        Some(Type::Speed) => match SpeedId::ALL.iter().find(|&&speed| speed as u64 == word) {
            Some(speed) => format!("speed {}", speed.name()),
            None => plain(word),
        },
        // The others are not what a variable holds.
        _ => plain(word),
    }
}

fn plain(word: u64) -> String {
    format!("word {word:#x}")
}
