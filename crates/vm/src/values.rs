//! What pure instructions and variables see: the operand stack, the frame's slots, the globals.
//!
//! Every value is 64 bits; the verifier knows its type. A frame's slots hold its locals from the
//! bottom and its loop counters, three words each, from the top, so that every index fits a byte
//! and needs no check.

use obverse_isa::{CounterId, ErrorId, GlobalId, LocalId, Setting};

/// The slots of a frame, and the operand stack.
pub type Slots = [u64; 256];

/// The identities of the present settings, by [`Setting`].
pub type Settings = [u64; 2];

/// What does not change while pure instructions run.
#[derive(Clone, Copy)]
pub struct Fixed<'a> {
    /// The module's constants.
    pub constants: &'a [u64],
    /// The workcell's numbers of the module's tools.
    pub tools: &'a [u64],
    /// The present settings.
    pub settings: Settings,
    /// The errors that are pending.
    pub raised: &'a [ErrorId],
}

/// What a pure instruction may touch: it reads all, and changes the operand stack alone.
pub struct Values<'a> {
    pub(crate) operands: &'a mut Slots,
    pub(crate) depth: u8,
    pub(crate) slots: &'a mut Slots,
    pub(crate) globals: &'a mut [u64],
    pub(crate) fixed: Fixed<'a>,
}

/// Where the words of a counter are in a frame's slots.
#[derive(Clone, Copy)]
pub(crate) struct CounterSlots {
    pub(crate) first: u8,
    pub(crate) last: u8,
    pub(crate) present: u8,
}

impl CounterSlots {
    #[inline(always)]
    pub(crate) fn of(counter: CounterId) -> Self {
        let top = 255_u8.wrapping_sub(counter.0.wrapping_mul(3));
        Self { first: top, last: top.wrapping_sub(1), present: top.wrapping_sub(2) }
    }
}

impl Values<'_> {
    /// Push a word.
    #[inline(always)]
    pub fn push(&mut self, word: u64) {
        self.operands[usize::from(self.depth)] = word;
        self.depth = self.depth.wrapping_add(1);
    }

    /// Push an integer.
    #[inline(always)]
    pub fn push_int(&mut self, value: i64) {
        self.push(value.cast_unsigned());
    }

    /// Push a real.
    #[inline(always)]
    pub fn push_real(&mut self, value: f64) {
        self.push(value.to_bits());
    }

    /// Push a truth value.
    #[inline(always)]
    pub fn push_bool(&mut self, value: bool) {
        self.push(u64::from(value));
    }

    /// Pop a word.
    #[inline(always)]
    pub fn pop(&mut self) -> u64 {
        self.depth = self.depth.wrapping_sub(1);
        self.operands[usize::from(self.depth)]
    }

    /// Pop an integer.
    #[inline(always)]
    pub fn pop_int(&mut self) -> i64 {
        self.pop().cast_signed()
    }

    /// Pop a real.
    #[inline(always)]
    pub fn pop_real(&mut self) -> f64 {
        f64::from_bits(self.pop())
    }

    /// Pop a truth value.
    #[inline(always)]
    pub fn pop_bool(&mut self) -> bool {
        self.pop() != 0
    }

    /// A local variable.
    #[inline(always)]
    #[must_use]
    pub fn local(&self, local: LocalId) -> u64 {
        self.slots[local.index()]
    }

    /// A variable of the program.
    #[inline(always)]
    #[must_use]
    pub fn global(&self, global: GlobalId) -> u64 {
        self.globals[global.index()]
    }

    /// The present value of a loop counter.
    #[inline(always)]
    #[must_use]
    pub fn counter(&self, counter: CounterId) -> i64 {
        self.slots[usize::from(CounterSlots::of(counter).present)].cast_signed()
    }

    /// What a setting is now.
    #[inline(always)]
    #[must_use]
    pub fn setting(&self, setting: Setting) -> u64 {
        self.fixed.settings[setting as usize]
    }

    /// Whether an error is pending.
    #[must_use]
    pub fn is_raised(&self, error: ErrorId) -> bool {
        self.fixed.raised.contains(&error)
    }
}

/// What an effect on variables may touch. Its operands lie from the bottom of the operand stack.
pub struct Variables<'v, 'a>(pub(crate) &'v mut Values<'a>);

impl Variables<'_, '_> {
    /// The operand at a place of the stack picture, from 0.
    #[inline(always)]
    #[must_use]
    pub fn operand(&self, at: usize) -> u64 {
        self.0.operands[at]
    }

    /// A local variable.
    #[inline(always)]
    pub fn local(&mut self, local: LocalId) -> &mut u64 {
        &mut self.0.slots[local.index()]
    }

    /// A variable of the program.
    #[inline(always)]
    pub fn global(&mut self, global: GlobalId) -> &mut u64 {
        &mut self.0.globals[global.index()]
    }

    /// A slot of the frame.
    #[inline(always)]
    pub(crate) fn slot(&mut self, slot: u8) -> &mut u64 {
        &mut self.0.slots[usize::from(slot)]
    }

    /// What is there to be read.
    #[inline(always)]
    #[must_use]
    pub fn values(&self) -> &Values<'_> {
        // The lifetime shrinks to that of the borrow: nothing can be changed through it.
        self.0
    }
}
