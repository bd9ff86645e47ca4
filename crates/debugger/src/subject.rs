//! What can be asked about at a moment: variables, settings, errors, and what is seen of the
//! workcell. Knows names and values, and nothing of how a moment is reached.

use crate::recording::World;
use crate::unit::Unit;
use obverse_bytecode::text::nearest;
use obverse_bytecode::{LoopName, Mentioned, Module, Variable};
use obverse_isa::{ErrorId, GlobalId, Instr, LocalId, Setting, SpeedId, Type};
use obverse_vm::{Frame, State};
use obverse_workcell::ItemId;

/// A machine and its workcell at a moment.
#[derive(Clone, Copy)]
pub struct Look<'a> {
    /// The program.
    pub module: &'a Module,
    /// The machine's state.
    pub state: &'a State,
    /// What is seen of the workcell.
    pub world: &'a dyn Seen,
}

/// What is seen of a workcell without reading anything that the program did not read.
pub trait Seen {
    /// Where the joints are, in radians.
    fn joints(&self) -> [f64; 6];
    /// The level of an output.
    fn output(&self, bit: u16) -> Option<bool>;
    /// The level of an input.
    fn input(&self, bit: u16) -> Option<bool>;
    /// The force, in newtons.
    fn force_n(&self) -> f64;
    /// What is held.
    fn held(&self) -> Option<ItemId>;
    /// The clock, in seconds.
    fn now_s(&self) -> f64;
    /// The name of an item of the workcell, as the program knows it.
    fn item_name(&self, item: ItemId) -> Option<String>;
}

impl World {
    /// The level of an output.
    pub(crate) fn output(&self, bit: u16) -> Option<bool> {
        self.outputs.get(usize::from(bit)).copied()
    }
}

/// Something that can be asked about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A variable of the program.
    Global(GlobalId),
    /// A local variable of the innermost call of a function.
    Local(u16, LocalId),
    /// The counter of a loop in the innermost call of a function: of all loops of the function
    /// that call theirs as this one of the module's table does.
    Counter(u16, u16),
    /// An output.
    Output(u16),
    /// An input, as the program read it last.
    Input(u16),
    /// A joint, from 0 at the base.
    Joint(u8),
    /// Where the arm is.
    Joints,
    /// The force.
    Force,
    /// What is held.
    Held,
    /// A setting.
    Setting(Setting),
    /// Whether an error is pending.
    Error(ErrorId),
    /// The workcell's clock.
    Time,
    /// How many instructions lie between the start of the program and here.
    Steps,
}

/// What no tool is called, and no limit.
pub(crate) const NONE: &str = "none";

/// What it is.
#[derive(Clone, Debug)]
pub enum Value {
    /// An integer.
    Int(i64),
    /// A real of which it is not known what it measures, in SI units.
    Real(f64),
    /// A real and what it measures, in SI units.
    Quantity(f64, Unit),
    /// A limit that there is not: more than any number.
    Unlimited,
    /// A truth value or a level.
    Bool(bool),
    /// Six joints, in radians.
    Joints([f64; 6]),
    /// The name of an item, a tool, a speed, or joints.
    Name(String),
    /// There is none here: no such call is under way, or it was never read.
    Absent,
    /// It cannot be worked out.
    Wrong(Wrong),
}

/// Why something cannot be worked out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrong {
    /// It is beyond the integers that there are.
    Overflow,
    /// An integer is divided by zero.
    DivisionByZero,
}

impl std::fmt::Display for Wrong {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Overflow => write!(f, "an overflow: an integer has no more than 64 bits"),
            Self::DivisionByZero => write!(f, "a division by zero"),
        }
    }
}

impl PartialEq for Value {
    /// Reals are the same if their bits are.
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Int(a), Self::Int(b)) => a == b,
            (Self::Real(a), Self::Real(b)) => a.to_bits() == b.to_bits(),
            (Self::Quantity(a, of), Self::Quantity(b, other)) => {
                a.to_bits() == b.to_bits() && of == other
            }
            (Self::Bool(a), Self::Bool(b)) => a == b,
            (Self::Joints(a), Self::Joints(b)) => a.map(f64::to_bits) == b.map(f64::to_bits),
            (Self::Name(a), Self::Name(b)) => a == b,
            (Self::Absent, Self::Absent) | (Self::Unlimited, Self::Unlimited) => true,
            (Self::Wrong(a), Self::Wrong(b)) => a == b,
            _ => false,
        }
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Int(value) => value.fmt(f),
            Self::Real(value) => write!(f, "{value:?}"),
            Self::Quantity(value, unit) => f.write_str(&unit.shown(*value)),
            Self::Unlimited => f.write_str(NONE),
            Self::Bool(value) => value.fmt(f),
            Self::Joints(joints) => {
                let joints = joints.map(|joint| format!("{:.2}", joint.to_degrees())).join(", ");
                write!(f, "[{joints}] deg")
            }
            Self::Name(name) => f.write_str(name),
            Self::Absent => write!(f, "not there"),
            Self::Wrong(why) => why.fmt(f),
        }
    }
}

/// The bits of a value of a type.
#[must_use]
pub fn value(module: &Module, of_type: Type, bits: u64) -> Value {
    let name = |name: Option<&String>| Value::Name(name.cloned().unwrap_or_default());
    let index = bits as usize;
    match of_type {
        Type::Int => Value::Int(bits.cast_signed()),
        Type::Real => Value::Real(f64::from_bits(bits)),
        Type::Bool => Value::Bool(bits != 0),
        Type::Joints => name(module.joints.get(index).map(|(name, _)| name)),
        Type::Item => name(module.items.get(index).map(|item| &item.name)),
        Type::Speed => {
            let speed = SpeedId::ALL.get(index).map_or("", |speed| speed.name());
            Value::Name(speed.replace('_', " "))
        }
        Type::Tool => Value::Name(module.tools.get(index).map_or(NONE, String::as_str).to_owned()),
    }
}

/// The bits of a value of a variable, with what it measures.
pub(crate) fn measured(module: &Module, declared: &Variable, bits: u64) -> Value {
    match (value(module, declared.of_type, bits), declared.measures) {
        (Value::Real(value), Some(exponents)) if Unit::of(exponents) != Unit::NONE => {
            Value::Quantity(value, Unit::of(exponents))
        }
        (value, _) => value,
    }
}

/// The bits of a value that can be given to a variable; none if it is of another type, or measures
/// something else.
pub(crate) fn bits_for(module: &Module, declared: &Variable, value: &Value) -> Option<u64> {
    let is_one = declared.of_type == Type::Real;
    let unit = declared.measures.filter(|_| is_one).map(Unit::of);
    let given = match value {
        Value::Quantity(_, unit) => *unit,
        _ => Unit::NONE,
    };
    unit.is_none_or(|unit| unit == given).then(|| bits(module, declared.of_type, value))?
}

/// The bits of a value that can be given to a variable of a type; none if it is of another.
#[must_use]
pub fn bits(module: &Module, of_type: Type, value: &Value) -> Option<u64> {
    let index = |at: Option<usize>| at.map(|index| index as u64);
    match (of_type, value) {
        (Type::Int, Value::Int(value)) => Some(value.cast_unsigned()),
        (Type::Real, Value::Int(value)) => Some((*value as f64).to_bits()),
        (Type::Real, Value::Real(value) | Value::Quantity(value, _)) => Some(value.to_bits()),
        (Type::Bool, Value::Bool(value)) => Some(u64::from(*value)),
        (Type::Joints, Value::Name(name)) => {
            index(module.joints.iter().position(|(known, _)| known == name))
        }
        (Type::Item, Value::Name(name)) => {
            index(module.items.iter().position(|item| item.name == *name))
        }
        (Type::Tool, Value::Name(name)) => {
            index(module.tools.iter().position(|known| known == name))
        }
        (Type::Speed, Value::Name(name)) => {
            let name = name.replace(' ', "_");
            index(SpeedId::ALL.iter().position(|speed| speed.name() == name))
        }
        _ => None,
    }
}

impl Subject {
    /// What it is at a moment.
    #[must_use]
    pub fn read(&self, look: &Look<'_>) -> Value {
        let bool = |value: Option<bool>| value.map_or(Value::Absent, Value::Bool);
        match *self {
            Self::Global(global) => {
                let declared = look.module.globals.get(global.index());
                let bits = look.state.globals().get(global.index());
                match (declared, bits) {
                    (Some(declared), Some(bits)) => measured(look.module, declared, *bits),
                    _ => Value::Absent,
                }
            }
            Self::Local(function, local) => {
                let mut frames = look.state.frames().iter().rev();
                let frame = frames.find(|frame| frame.function == function);
                let declared = look.module.functions.get(usize::from(function));
                let declared = declared.and_then(|it| it.locals.get(local.index()));
                match (declared, frame) {
                    (Some(declared), Some(frame)) => {
                        measured(look.module, declared, frame.local(local.0))
                    }
                    _ => Value::Absent,
                }
            }
            Self::Counter(function, named) => counter(look, function, named),
            Self::Output(bit) => bool(look.world.output(bit)),
            Self::Input(bit) => bool(look.world.input(bit)),
            Self::Joint(index) => {
                let joints = look.world.joints();
                let angle = |joint: &f64| Value::Quantity(*joint, Unit::ANGLE);
                joints.get(usize::from(index)).map_or(Value::Absent, angle)
            }
            Self::Joints => Value::Joints(look.world.joints()),
            Self::Force => Value::Quantity(look.world.force_n(), Unit::FORCE),
            Self::Held => match look.world.held() {
                Some(item) => {
                    let number = || format!("item {}", item.0);
                    Value::Name(look.world.item_name(item).unwrap_or_else(number))
                }
                None => Value::Name("nothing".to_owned()),
            },
            Self::Setting(setting) => {
                let bits = look.state.settings()[setting as usize];
                match (setting, value(look.module, setting.of_type(), bits)) {
                    (Setting::ReverseForceLimit, Value::Real(f64::INFINITY)) => Value::Unlimited,
                    (Setting::ReverseForceLimit, Value::Real(limit_n)) => {
                        Value::Quantity(limit_n, Unit::FORCE)
                    }
                    (_, value) => value,
                }
            }
            Self::Error(error) => Value::Bool(look.state.raised().contains(&error)),
            Self::Time => Value::Quantity(look.world.now_s(), Unit::TIME),
            Self::Steps => Value::Int(look.state.steps().cast_signed()),
        }
    }

    /// Whether it changes at commands alone, so that no step between two needs to be looked at.
    #[must_use]
    pub fn is_of_the_workcell(&self) -> bool {
        matches!(
            self,
            Self::Output(_) | Self::Joint(_) | Self::Joints | Self::Force | Self::Held | Self::Time
        )
    }

    /// What a person calls it.
    #[must_use]
    pub fn name(&self, module: &Module) -> String {
        let local = |function: u16, local: LocalId| {
            let function = module.functions.get(usize::from(function))?;
            Some(function.locals.get(local.index())?.name.clone())
        };
        match *self {
            Self::Global(global) => {
                module.globals.get(global.index()).map(|it| it.name.clone()).unwrap_or_default()
            }
            Self::Local(function, slot) => local(function, slot).unwrap_or_default(),
            Self::Counter(_, named) => {
                let named = module.loops.get(usize::from(named));
                named.map(|named| named.name.clone()).unwrap_or_default()
            }
            Self::Output(bit) => line_name(module, bit, true),
            Self::Input(bit) => line_name(module, bit, false),
            Self::Joint(index) => format!("joint {}", index + 1),
            Self::Joints => "joints".to_owned(),
            Self::Force => "force".to_owned(),
            Self::Held => "held".to_owned(),
            Self::Setting(setting) => setting.name().to_owned(),
            Self::Error(error) => {
                let error = module.errors.get(error.index());
                format!("error {}", error.map_or("", |error| &error.name))
            }
            Self::Time => "time".to_owned(),
            Self::Steps => "steps".to_owned(),
        }
    }
}

/// What the counter is of the innermost loop under way of some that have one name.
fn counter(look: &Look<'_>, function: u16, named: u16) -> Value {
    let frames = look.state.frames();
    let Some(frame) = frames.iter().rposition(|frame| frame.function == function) else {
        return Value::Absent;
    };
    // A caller stands behind its call.
    let called = frames.get(frame + 1).map(|called| called.return_pc.saturating_sub(1));
    let pc = called.unwrap_or(look.state.pc());
    let name = look.module.loops.get(usize::from(named)).map(|named| &named.name);
    let mut around = loops_around(look.module, pc).filter(|around| Some(&around.name) == name);
    match around.next_back() {
        Some(around) => Value::Int(count(look.module, around, &frames[frame])),
        None => Value::Absent,
    }
}

/// The loops with a name that an instruction is in, outermost first.
pub(crate) fn loops_around(module: &Module, pc: u32) -> impl DoubleEndedIterator<Item = &LoopName> {
    let before = module.loops.partition_point(|around| around.enter < pc);
    module.loops[..before].iter().filter(move |around| {
        match module.code.get(around.enter as usize) {
            Some(Instr::ForEnter { exit, .. }) => pc < exit.0,
            _ => false,
        }
    })
}

/// What the program calls the counter of a loop, in a frame.
pub(crate) fn count(module: &Module, around: &LoopName, frame: &Frame) -> i64 {
    let counter = match module.code.get(around.enter as usize) {
        Some(Instr::ForEnter { counter, .. }) => frame.counter(*counter),
        _ => 0,
    };
    if around.is_down { !counter } else { counter }
}

fn line_name(module: &Module, bit: u16, is_output: bool) -> String {
    let named = module.mentions.iter().find_map(|mention| match &mention.what {
        Mentioned::Output { name, bit: of } if is_output && *of == bit => Some(name),
        Mentioned::Input { name, bit: of } if !is_output && *of == bit => Some(name),
        _ => None,
    });
    let kind = if is_output { "output" } else { "input" };
    match named {
        Some(name) if *name != bit.to_string() => format!("{kind} {name}"),
        _ => format!("{kind} {bit}"),
    }
}

/// The output or the input of a name or a number.
pub(crate) fn line(module: &Module, name: &str, is_output: bool) -> Option<u16> {
    if let Ok(bit) = name.parse() {
        return Some(bit);
    }
    module.mentions.iter().find_map(|mention| match &mention.what {
        Mentioned::Output { name: known, bit } if is_output && known == name => Some(*bit),
        Mentioned::Input { name: known, bit } if !is_output && known == name => Some(*bit),
        _ => None,
    })
}

/// The variable of a name: of a function, or of the program.
pub(crate) fn variable(
    module: &Module,
    function: usize,
    name: &str,
) -> Option<(Subject, Type, Option<Unit>)> {
    let declared = module.functions.get(function)?;
    // Of two with one name the later is the inner one.
    let local = declared.locals.iter().rposition(|local| local.name == name);
    if let Some(local) = local {
        let subject = Subject::Local(function as u16, LocalId(local as u8));
        let Variable { of_type, measures, .. } = declared.locals[local];
        return Some((subject, of_type, measures.map(Unit::of)));
    }
    let is_here = |around: &LoopName| {
        around.name == name && (declared.first..declared.end).contains(&around.enter)
    };
    if let Some(named) = module.loops.iter().position(is_here) {
        return Some((Subject::Counter(function as u16, named as u16), Type::Int, None));
    }
    let global = module.globals.iter().position(|global| global.name == name)?;
    let Variable { of_type, measures, .. } = module.globals[global];
    Some((Subject::Global(GlobalId(global as u16)), of_type, measures.map(Unit::of)))
}

/// The variable that was probably meant.
pub(crate) fn nearest_variable<'m>(
    module: &'m Module,
    function: usize,
    name: &str,
) -> Option<&'m str> {
    let locals = module.functions.get(function).map(|function| &function.locals);
    let all = locals.into_iter().flatten().chain(&module.globals);
    let here = module.functions.get(function).map_or(0..0, |it| it.first..it.end);
    let loops = module.loops.iter().filter(|around| here.contains(&around.enter));
    let loops = loops.map(|around| around.name.as_str());
    let names = all.map(|variable| variable.name.as_str()).chain(loops);
    // What the compiler keeps for itself is nobody's to name.
    nearest(name, names.filter(|name| !name.starts_with('$')))
}
