//! What the pure prefix of a statement leaves, of words that are known or not.

use crate::state::{State, Word};
use obverse_bytecode::Module;
use obverse_isa::Instr;
use obverse_vm::Calculator;

/// The module's numbers and the workcell's, and the machine's own arithmetic.
pub(crate) struct Values<'m> {
    pub(crate) module: &'m Module,
    /// The workcell's numbers of the module's tools.
    pub(crate) tools: Vec<u64>,
    pub(crate) calculator: Calculator,
}

/// The statement would trap: no run gets beyond it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trapped;

impl Values<'_> {
    /// The operands of the effect at a place.
    ///
    /// # Errors
    /// The prefix traps.
    pub(crate) fn operands(&mut self, state: &State, at: usize) -> Result<Vec<Word>, Trapped> {
        let prefix = usize::from(self.module.code[at].prefix());
        let mut operands = Vec::with_capacity(prefix);
        for pc in at - prefix..at {
            self.pure(state, self.module.code[pc], &mut operands)?;
        }
        Ok(operands)
    }

    fn pure(
        &mut self,
        state: &State,
        instr: Instr,
        operands: &mut Vec<Word>,
    ) -> Result<(), Trapped> {
        let local =
            |state: &State, local: obverse_isa::LocalId| state.frame().locals[local.index()];
        let pushed = match instr {
            Instr::PushInt { value } => Some(i64::from(value).cast_unsigned()),
            Instr::PushConstant { constant } => {
                Some(self.module.constants[constant.index()].bits())
            }
            Instr::PushBool { value } => Some(u64::from(value.is_high())),
            Instr::PushLocal { local: id } => local(state, id),
            Instr::PushGlobal { global } => state.globals[global.index()],
            Instr::PushCounter { counter } => state.frame().counters[counter.index()][2],
            Instr::PushJoints { joints } => Some(u64::from(joints.0)),
            Instr::PushItem { item } => Some(u64::from(item.0)),
            Instr::PushSpeed { speed } => Some(speed as u64),
            Instr::PushTool { tool } => self.tools.get(tool.index()).copied(),
            Instr::PushSetting { setting } => state.settings[setting as usize],
            Instr::PushRaised { error } => {
                state.raised.as_ref().map(|raised| u64::from(raised.contains(&error)))
            }
            // What fuses a push with arithmetic is both, one after the other.
            Instr::IntAddLocals { left, right } => {
                let terms = [local(state, left), local(state, right)];
                return self.calculate_pushed(Instr::IntAdd {}, terms, operands);
            }
            Instr::IntAddLocal { local: id } => {
                operands.push(local(state, id));
                return self.calculate(Instr::IntAdd {}, operands);
            }
            Instr::IntMulLocalImmediate { local: id, value } => {
                let factor = [local(state, id)];
                return self.calculate_pushed(Instr::IntMulImmediate { value }, factor, operands);
            }
            Instr::IntMulCounterImmediate { counter, value } => {
                let factor = [state.frame().counters[counter.index()][2]];
                return self.calculate_pushed(Instr::IntMulImmediate { value }, factor, operands);
            }
            Instr::IntRemLocalImmediate { local: id, value } => {
                let dividend = [local(state, id)];
                return self.calculate_pushed(Instr::IntRemImmediate { value }, dividend, operands);
            }
            Instr::IntRemCounterImmediate { counter, value } => {
                let dividend = [state.frame().counters[counter.index()][2]];
                return self.calculate_pushed(Instr::IntRemImmediate { value }, dividend, operands);
            }
            arithmetic => return self.calculate(arithmetic, operands),
        };
        operands.push(pushed);
        Ok(())
    }

    fn calculate_pushed<const N: usize>(
        &mut self,
        instr: Instr,
        pushed: [Word; N],
        operands: &mut Vec<Word>,
    ) -> Result<(), Trapped> {
        operands.extend(pushed);
        self.calculate(instr, operands)
    }

    fn calculate(&mut self, instr: Instr, operands: &mut Vec<Word>) -> Result<(), Trapped> {
        let info = instr.info();
        let taken = operands.split_off(operands.len().saturating_sub(info.pops.len()));
        let known: Option<Vec<u64>> = taken.into_iter().collect();
        let result = match known.and_then(|known| self.calculator.result(instr, &known)) {
            Some(Ok(result)) => Some(result),
            Some(Err(_)) => return Err(Trapped),
            None => None,
        };
        operands.extend(info.pushes.iter().map(|_| result));
        Ok(())
    }

    /// What an integer instruction makes of two words.
    pub(crate) fn binary(&mut self, instr: Instr, a: Word, b: Word) -> Word {
        let both = [a?, b?];
        self.calculator.result(instr, &both)?.ok()
    }
}
