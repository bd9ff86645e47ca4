//! What pure instructions and variables see: the operand stack, the frame's slots, the globals.
//!
//! Every value is 64 bits; the verifier knows its type. A frame's slots hold its locals from the
//! bottom and its loop counters, three words each, from the top, so that every index fits a byte
//! and needs no check.

use obverse_isa::{CounterId, ErrorId, GlobalId, LocalId, Setting};

/// How many slots a frame has, and how many operands a statement.
const SLOTS: usize = 256;

/// The words of a call: its slots, and behind them the operands of the statement in hand. One
/// array, so that the loops hold one address for both.
#[derive(Clone, Debug)]
pub(crate) struct Words([u64; 2 * SLOTS]);

impl Default for Words {
    fn default() -> Self {
        Self([0; 2 * SLOTS])
    }
}

impl Words {
    #[inline(always)]
    pub(crate) fn slot(&self, at: u8) -> u64 {
        self.0[usize::from(at)]
    }

    #[inline(always)]
    pub(crate) fn slot_mut(&mut self, at: u8) -> &mut u64 {
        &mut self.0[usize::from(at)]
    }

    /// An operand, counted from the bottom.
    #[inline(always)]
    pub(crate) fn operand(&self, at: u8) -> u64 {
        self.0[SLOTS + usize::from(at)]
    }

    #[inline(always)]
    fn operand_mut(&mut self, at: u8) -> &mut u64 {
        &mut self.0[SLOTS + usize::from(at)]
    }

    /// The slots and the operands.
    pub(crate) fn parts(&self) -> (&[u64], &[u64]) {
        self.0.split_at(SLOTS)
    }

    /// The slots and the operands.
    pub(crate) fn parts_mut(&mut self) -> (&mut [u64], &mut [u64]) {
        self.0.split_at_mut(SLOTS)
    }
}

/// The identities of the present settings, by [`Setting`].
pub type Settings = [u64; Setting::ALL.len()];

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
///
/// The newest operand is in `top` and the others below it in `operands`, so that a chain of
/// instructions passes its value on in a register. With an empty stack `top` means nothing, and the
/// place that it is spilled to is one that no stack reaches.
pub struct Values<'a> {
    pub(crate) words: &'a mut Words,
    pub(crate) top: u64,
    pub(crate) depth: u8,
    /// A vector, so that the loops hold one address for it and not a length too.
    pub(crate) globals: &'a mut Vec<u64>,
    pub(crate) fixed: &'a Fixed<'a>,
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

/// Where the operand is that is so far below the top, counted from the empty stack.
#[inline(always)]
fn place(depth: u8, below: u8) -> u8 {
    depth.wrapping_sub(below)
}

impl Values<'_> {
    /// Write the newest operand where the others are.
    #[inline(always)]
    pub(crate) fn spill(&mut self) {
        *self.words.operand_mut(place(self.depth, 1)) = self.top;
    }

    /// Push a word.
    #[inline(always)]
    pub fn push(&mut self, word: u64) {
        self.spill();
        self.top = word;
        self.depth = self.depth.wrapping_add(1);
    }

    /// Replace the newest operand by what is made of it.
    #[inline(always)]
    pub fn unary(&mut self, make: impl FnOnce(u64) -> u64) {
        self.top = make(self.top);
    }

    /// Replace the two newest operands, older first, by what is made of them.
    #[inline(always)]
    pub fn binary(&mut self, make: impl FnOnce(u64, u64) -> u64) {
        let older = self.words.operand(place(self.depth, 2));
        self.depth = self.depth.wrapping_sub(1);
        self.top = make(older, self.top);
    }

    /// The newest operand.
    #[inline(always)]
    #[must_use]
    pub fn top(&self) -> u64 {
        self.top
    }

    /// The operand below the newest.
    #[inline(always)]
    #[must_use]
    pub fn below(&self) -> u64 {
        self.words.operand(place(self.depth, 2))
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

    /// A local variable.
    #[inline(always)]
    #[must_use]
    pub fn local(&self, local: LocalId) -> u64 {
        self.words.slot(local.0)
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
        self.words.slot(CounterSlots::of(counter).present).cast_signed()
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

/// What an effect on variables may touch.
pub struct Variables<'v, 'a>(pub(crate) &'v mut Values<'a>);

impl Variables<'_, '_> {
    /// The last operand of the stack picture.
    #[inline(always)]
    #[must_use]
    pub fn top(&self) -> u64 {
        self.0.top()
    }

    /// The operand before the last.
    #[inline(always)]
    #[must_use]
    pub fn below(&self) -> u64 {
        self.0.below()
    }

    /// A local variable.
    #[inline(always)]
    pub fn local(&mut self, local: LocalId) -> &mut u64 {
        self.0.words.slot_mut(local.0)
    }

    /// A variable of the program.
    #[inline(always)]
    pub fn global(&mut self, global: GlobalId) -> &mut u64 {
        &mut self.0.globals[global.index()]
    }

    /// A slot of the frame.
    #[inline(always)]
    pub(crate) fn slot(&mut self, slot: u8) -> &mut u64 {
        self.0.words.slot_mut(slot)
    }

    /// What is there to be read.
    #[inline(always)]
    #[must_use]
    pub fn values(&self) -> &Values<'_> {
        // The lifetime shrinks to that of the borrow: nothing can be changed through it.
        self.0
    }
}
