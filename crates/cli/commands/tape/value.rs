//! What a record holds, in words: by the type that the instruction that pops it gives it.

use obverse_bytecode::Module;
use obverse_isa::{Class, GlobalId, Instr, LocalId, RecordKind, Setting, SpeedId, Type};
use obverse_tape::{Place, Tape};

/// The newest record of each stream.
pub(super) struct Newest {
    bit: Option<bool>,
    word: Option<u64>,
    joints: Option<[f64; 6]>,
}

impl Newest {
    pub(super) fn of(tape: Option<&Tape>) -> Self {
        Self {
            bit: tape.and_then(Tape::newest_bit),
            word: tape.and_then(Tape::newest_word),
            joints: tape.and_then(Tape::newest_joints),
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
    match (size, top) {
        (Place { bits: 1, words: 0, joints: 0 }, Newest { bit: Some(bit), .. }) => {
            format!("bit {}", u8::from(*bit))
        }
        (Place { bits: 0, words: 1, joints: 0 }, Newest { word: Some(word), .. }) => {
            instr.map_or_else(|| plain(*word), |instr| word_of(module, pc, instr, *word))
        }
        (Place { bits: 0, words: 0, joints: 1 }, Newest { joints: Some(joints), .. }) => {
            let shown: Vec<String> = joints.iter().map(|joint| format!("{joint:.4}")).collect();
            format!("joints [{}] rad", shown.join(", "))
        }
        _ => frame(size),
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
