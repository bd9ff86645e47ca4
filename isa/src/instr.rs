//! The instruction as a value, one struct an opcode, and the table as data.
//!
//! An [`Instr`] is eight bytes, so that the machine runs over a slice of them and walks backwards
//! by index. All of this is expanded from [`for_each_op`](crate::for_each_op).

use crate::columns::{Class, Family, RecordKind, StackItem, Type};
use crate::operand::{
    Axis, Bit, CheckpointId, ConstantId, CounterId, ErrorId, Frame, FunctionId, GlobalId, ItemId,
    JointsId, KeyframeId, Label, Level, LocalId, Operand, OperandError, OperandKind, Path, Prefix,
    ReasonId, Setting, SlotId, SpeedId, ToolId,
};

/// A row of the table as data.
#[derive(Clone, Copy, Debug)]
pub struct OpInfo {
    /// The opcode.
    pub opcode: Opcode,
    /// Its code in modules.
    pub code: u8,
    /// Its name in Rust.
    pub ident: &'static str,
    /// Its name in assembly text.
    pub mnemonic: &'static str,
    /// The lines of its documentation; the first is its summary.
    pub doc: &'static [&'static str],
    /// Names and kinds of its operands.
    pub operands: &'static [(&'static str, OperandKind)],
    /// What it takes from the operand stack, the top last.
    pub pops: &'static [StackItem],
    /// What it leaves there.
    pub pushes: &'static [StackItem],
    /// Whether it can be reversed.
    pub class: Class,
    /// What it touches.
    pub family: Family,
}

/// Turn the tokens of a stack picture into stack items.
macro_rules! stack_items {
    ($($item:ident)*) => { &[$(stack_items!(@ $item)),*] };
    (@ int) => { StackItem::Of(Type::Int) };
    (@ real) => { StackItem::Of(Type::Real) };
    (@ bool) => { StackItem::Of(Type::Bool) };
    (@ joints) => { StackItem::Of(Type::Joints) };
    (@ item) => { StackItem::Of(Type::Item) };
    (@ speed) => { StackItem::Of(Type::Speed) };
    (@ tool) => { StackItem::Of(Type::Tool) };
    (@ local) => { StackItem::Local };
    (@ global) => { StackItem::Global };
    (@ constant) => { StackItem::Constant };
    (@ setting) => { StackItem::Setting };
    (@ parameters) => { StackItem::Parameters };
}

macro_rules! class {
    (always) => {
        Class::Always
    };
    (after_forward $record:ident) => {
        Class::AfterForward(RecordKind::$record)
    };
    (never $why:literal) => {
        Class::Never($why)
    };
}

macro_rules! family {
    (value) => {
        Family::Value
    };
    (variable) => {
        Family::Variable
    };
    (flow) => {
        Family::Flow
    };
    (frame) => {
        Family::Frame
    };
    (setting) => {
        Family::Setting
    };
    (kinematic) => {
        Family::Kinematic
    };
    (sense) => {
        Family::Sense
    };
    (io) => {
        Family::Io
    };
    (reversal) => {
        Family::Reversal
    };
    (error) => {
        Family::Error
    };
    (task) => {
        Family::Task
    };
}

macro_rules! make_instructions {
    ($(
        $(#[doc = $doc:literal])+
        $code:literal $ident:ident $mnemonic:literal ($($field:ident: $ty:ty),*)
        [$($pop:ident)* -- $($push:ident)*] $class:ident $(($payload:tt))? $family:ident;
    )*) => {
        /// An opcode.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u8)]
        pub enum Opcode {
            $($(#[doc = $doc])+ $ident = $code,)*
        }

        /// An instruction: an opcode and its operands.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Instr {
            $($(#[doc = $doc])+ $ident {
                $(#[doc = concat!("The operand `", stringify!($field), "`.")] $field: $ty,)*
            },)*
        }

        /// One type an opcode, for what is implemented by opcode.
        pub mod op {
            use super::*;
            $(
                $(#[doc = $doc])+
                #[derive(Clone, Copy, Debug, PartialEq, Eq)]
                pub struct $ident {
                    $(#[doc = concat!("The operand `", stringify!($field), "`.")] pub $field: $ty,)*
                }
            )*
        }

        /// The table as data, by ascending code.
        pub const OPS: &[OpInfo] = &[$(
            OpInfo {
                opcode: Opcode::$ident,
                code: $code,
                ident: stringify!($ident),
                mnemonic: $mnemonic,
                doc: &[$($doc),+],
                operands: &[$((stringify!($field), <$ty as Operand>::KIND)),*],
                pops: stack_items!($($pop)*),
                pushes: stack_items!($($push)*),
                class: class!($class $($payload)?),
                family: family!($family),
            },
        )*];

        impl Opcode {
            /// The opcode of this code, if there is one.
            #[must_use]
            pub fn from_code(code: u8) -> Option<Self> {
                match code {
                    $($code => Some(Self::$ident),)*
                    _ => None,
                }
            }
        }

        impl Instr {
            /// The opcode.
            #[must_use]
            #[inline]
            pub fn opcode(&self) -> Opcode {
                match self { $(Self::$ident { .. } => Opcode::$ident,)* }
            }

            /// How many pure instructions come before this one in its statement.
            #[inline(always)]
            #[must_use]
            pub fn prefix(&self) -> u8 {
                match *self { $(Self::$ident { $($field,)* } => 0 $(+ $field.as_prefix())*,)* }
            }

            /// Call `visit` with each operand as a number, in the order of the row.
            pub fn each_operand(&self, visit: &mut dyn FnMut(OperandKind, usize, i64)) {
                match *self {
                    $(Self::$ident { $($field,)* } => {
                        $({
                            let (kind, bytes) = (<$ty as Operand>::KIND, <$ty as Operand>::BYTES);
                            visit(kind, bytes, $field.to_number());
                        })*
                        let _ = &visit;
                    })*
                }
            }

            /// The instruction with these operands; `next` is called once for each, in the order
            /// of the row, with its kind and its width in bytes.
            ///
            /// # Errors
            /// If a number is no operand of its kind, or `next` says so.
            pub fn from_operands<E: From<OperandError>>(
                opcode: Opcode,
                next: &mut dyn FnMut(OperandKind, usize) -> Result<i64, E>,
            ) -> Result<Self, E> {
                Ok(match opcode {
                    $(Opcode::$ident => Self::$ident {
                        $($field: <$ty as Operand>::from_number(
                            next(<$ty as Operand>::KIND, <$ty as Operand>::BYTES)?,
                        )?,)*
                    },)*
                })
            }
        }

        $(impl From<op::$ident> for Instr {
            #[inline]
            fn from(op: op::$ident) -> Self {
                let op::$ident { $($field,)* } = op;
                Self::$ident { $($field,)* }
            }
        })*
    };
}

crate::for_each_op!(make_instructions);

const _: () = assert!(size_of::<Instr>() == 8, "an instruction is eight bytes");

/// Codes ascend and are not zero, so that a run of zero bytes is no code.
const _: () = {
    let mut index = 0;
    while index < OPS.len() {
        assert!(OPS[index].code != 0, "code 0 is not used");
        assert!(
            index == 0 || OPS[index - 1].code < OPS[index].code,
            "codes ascend and none is used twice"
        );
        index += 1;
    }
};

impl Opcode {
    /// The row of this opcode.
    #[must_use]
    pub fn info(self) -> &'static OpInfo {
        const INDEX: [u8; 256] = {
            let mut index = [u8::MAX; 256];
            let mut row = 0;
            while row < OPS.len() {
                index[OPS[row].code as usize] = row as u8;
                row += 1;
            }
            index
        };
        &OPS[usize::from(INDEX[self as usize])]
    }

    /// The opcode of this mnemonic, if there is one.
    #[must_use]
    pub fn from_mnemonic(mnemonic: &str) -> Option<Self> {
        OPS.iter().find(|row| row.mnemonic == mnemonic).map(|row| row.opcode)
    }
}

impl Instr {
    /// The row of this instruction.
    #[must_use]
    pub fn info(&self) -> &'static OpInfo {
        self.opcode().info()
    }

    /// The instruction that this one may go on at other than the next: the target of a jump.
    #[must_use]
    pub fn jump_target(&self) -> Option<Label> {
        match *self {
            Self::Jump { target }
            | Self::JumpIf { target, .. }
            | Self::JumpUnless { target, .. }
            | Self::JumpUnlessLt { target, .. }
            | Self::JumpUnlessLe { target, .. }
            | Self::JumpUnlessEq { target, .. }
            | Self::JumpUnlessNe { target, .. }
            | Self::JumpUnlessEqImmediate { target, .. }
            | Self::JumpUnlessLocalLtImmediate { target, .. }
            | Self::JumpUnlessLocalLtLocal { target, .. }
            | Self::ForNext { target, .. } => Some(target),
            Self::ForEnter { exit, .. } => Some(exit),
            Self::Fork { join } => Some(join),
            _ => None,
        }
    }

    /// The jump that a join is the target of.
    #[must_use]
    pub fn join_from(&self) -> Option<Label> {
        match *self {
            Self::Land { from }
            | Self::Join { from }
            | Self::JoinAssert { from, .. }
            | Self::ForTop { from, .. }
            | Self::ForExit { from, .. }
            | Self::ForkJoin { from } => Some(from),
            _ => None,
        }
    }

    /// Whether a branch of a fork has had its turn when it has run this: it has commanded the
    /// workcell, waited for it, or read what came of a motion.
    #[must_use]
    pub fn ends_turn(&self) -> bool {
        self.info().family.commands_workcell()
            || matches!(self, Self::WaitInput { .. })
            || self.reads_motion()
    }

    /// The same with the instruction that is next: what came of a motion is read in its own turn.
    #[must_use]
    pub fn ends_turn_before(&self, next: &Self) -> bool {
        let is_motion = self.info().family == Family::Kinematic || self.reads_motion();
        self.ends_turn() && !(is_motion && next.reads_motion())
    }

    /// Whether it reads what came of the last motion.
    #[must_use]
    pub fn reads_motion(&self) -> bool {
        matches!(self, Self::SenseDistance { .. } | Self::SensePeakForce { .. })
    }

    /// Whether it is a motion that a force may end, as a success.
    #[must_use]
    pub fn is_guarded(&self) -> bool {
        matches!(
            self,
            Self::MoveGuarded { .. }
                | Self::MoveGuardedOpposite { .. }
                | Self::MoveTurnGuarded { .. }
        )
    }

    /// Whether control never passes from this instruction to the next.
    #[must_use]
    pub fn never_falls_through(&self) -> bool {
        matches!(self, Self::Jump { .. } | Self::Return {} | Self::Halt {} | Self::ForkLeave { .. })
    }
}
