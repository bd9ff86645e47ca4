//! Putting code together: statements with their prefix counted, jumps and joins paired.
//!
//! A jump and its join name each other, and one of them is always written first; the builder
//! hands out a [`Mark`] for the first and patches it when the second comes. Knows nothing of what
//! the code means.

use obverse_isa::{Instr, Label, Prefix};

/// An instruction that waits for its other half.
#[derive(Debug)]
#[must_use = "a jump without its join is refused by the verifier"]
pub struct Mark(u32);

impl Mark {
    /// Where the waiting instruction is.
    #[must_use]
    pub fn at(&self) -> Label {
        Label(self.0)
    }
}

/// Code under construction.
#[derive(Debug, Default)]
pub struct CodeBuilder {
    code: Vec<Instr>,
    prefix: u32,
}

/// What a jump or join carries until its other half is known.
const UNKNOWN: Label = Label(u32::MAX);

impl CodeBuilder {
    /// Nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The index that the next instruction will have.
    #[must_use]
    pub fn here(&self) -> u32 {
        u32::try_from(self.code.len()).unwrap_or(u32::MAX)
    }

    /// How many pure instructions the statement under construction has so far.
    #[must_use]
    pub fn prefix(&self) -> u32 {
        self.prefix
    }

    /// Append an instruction. An effect gets the length of the prefix before it, which the caller
    /// leaves at zero; a prefix that is too long for one byte shows in the verifier.
    pub fn push(&mut self, instr: impl Into<Instr>) -> u32 {
        let instr: Instr = instr.into();
        let at = self.here();
        if instr.info().family.is_pure() {
            self.prefix += 1;
            self.code.push(instr);
        } else {
            let prefix = Prefix(u8::try_from(self.prefix).unwrap_or(u8::MAX));
            self.code.push(with_prefix(instr, prefix));
            self.prefix = 0;
        }
        at
    }

    /// Append a jump forward, made by `jump` from its target; [`join`](Self::join) completes it.
    pub fn jump<I: Into<Instr>>(&mut self, jump: impl FnOnce(Label) -> I) -> Mark {
        Mark(self.push(jump(UNKNOWN)))
    }

    /// Append the join of a jump forward, made by `join` from where it comes.
    pub fn join<I: Into<Instr>>(&mut self, jump: Mark, join: impl FnOnce(Label) -> I) -> u32 {
        let at = self.push(join(jump.at()));
        self.patch(jump, Label(at));
        at
    }

    /// Append the join of a jump that comes later; [`jump_back`](Self::jump_back) completes it.
    pub fn join_ahead<I: Into<Instr>>(&mut self, join: impl FnOnce(Label) -> I) -> Mark {
        Mark(self.push(join(UNKNOWN)))
    }

    /// Append a jump back to a join, made by `jump` from its target.
    pub fn jump_back<I: Into<Instr>>(&mut self, join: Mark, jump: impl FnOnce(Label) -> I) -> u32 {
        let at = self.push(jump(join.at()));
        self.patch(join, Label(at));
        at
    }

    /// Let one more jump lead to a place, beside the one that its join names.
    pub fn lead(&mut self, jump: Mark, to: u32) {
        self.patch(jump, Label(to));
    }

    /// The last instructions, as long as they are pure and of this statement.
    #[must_use]
    pub fn last_pure(&self) -> &[Instr] {
        &self.code[self.code.len() - self.prefix as usize..]
    }

    /// Take back the last pure instruction of this statement, to put a fused one in its place.
    pub fn pop_pure(&mut self) -> Option<Instr> {
        if self.prefix == 0 {
            return None;
        }
        self.prefix -= 1;
        self.code.pop()
    }

    /// The code.
    #[must_use]
    pub fn finish(self) -> Vec<Instr> {
        self.code
    }

    fn patch(&mut self, mark: Mark, other: Label) {
        let instr = &mut self.code[mark.0 as usize];
        *instr = with_label(*instr, other);
    }
}

/// The instruction with its prefix operand, if it has one, replaced.
pub(crate) fn with_prefix(instr: Instr, prefix: Prefix) -> Instr {
    map_operand(instr, obverse_isa::OperandKind::Prefix, i64::from(prefix.0))
}

/// The instruction with its label replaced.
pub(crate) fn with_label(instr: Instr, label: Label) -> Instr {
    map_operand(instr, obverse_isa::OperandKind::Label, i64::from(label.0))
}

fn map_operand(instr: Instr, changed: obverse_isa::OperandKind, value: i64) -> Instr {
    let mut values = Vec::with_capacity(4);
    instr.each_operand(&mut |kind, _, old| {
        values.push(if kind == changed { value } else { old });
    });
    let mut values = values.into_iter();
    let rebuilt: Result<Instr, obverse_isa::OperandError> =
        Instr::from_operands(instr.opcode(), &mut |kind, _| {
            values.next().ok_or(obverse_isa::OperandError { kind, value: 0 })
        });
    rebuilt.unwrap_or(instr)
}
