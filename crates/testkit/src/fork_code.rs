//! Random modules of little but forks, calls and what cannot be taken back: branches that call,
//! that fork again, that leave, that are in a block, and that share a flag which says where to go.
//!
//! Every generated module verifies and, on a [`Ledger`](crate::Ledger), ends: there are no loops,
//! and functions call later ones alone.

use arbitrary::{Result, Unstructured};
use obverse_bytecode::{CodeBuilder, Constant, Function, FunctionKind, Mark, Module, Variable};
use obverse_isa::{
    Bit, ConstantId, FunctionId, GlobalId, Label, Level, LocalId, Prefix, ReasonId, Type, op,
};

const P: Prefix = Prefix(0);
const FUNCTIONS: u16 = 4;
const MAX_DEPTH: u8 = 3;
const INPUT: LocalId = LocalId(0);
const FLAG: GlobalId = GlobalId(0);

/// A random module that verifies.
///
/// # Errors
/// None in practice: exhausted randomness yields the simplest choice.
pub fn module(u: &mut Unstructured<'_>) -> Result<Module> {
    let variable =
        |name: &str| Variable { name: name.to_owned(), of_type: Type::Bool, measures: None };
    let mut module = Module {
        constants: vec![Constant::Real(0.5)],
        reasons: vec!["because".to_owned()],
        globals: vec![variable("flag")],
        ..Module::default()
    };
    let mut code = CodeBuilder::new();
    for index in 0..FUNCTIONS {
        let first = code.here();
        code.push(op::Enter {});
        let (u, code) = (&mut *u, &mut code);
        let mut body = Body { u, code, index, depth: 0, leaves: vec![None] };
        body.statements(4)?;
        if index == 0 {
            code.push(op::Halt {});
        } else {
            code.push(op::Return {});
        }
        let kind = if index == 0 { FunctionKind::Start } else { FunctionKind::Sequence };
        module.functions.push(Function {
            name: format!("f{index}"),
            kind,
            parameters: 0,
            locals: vec![variable("input")],
            counters: 0,
            slots: Vec::new(),
            first,
            end: code.here(),
        });
    }
    module.code = code.finish();
    Ok(module)
}

struct Body<'b, 'u> {
    u: &'b mut Unstructured<'u>,
    code: &'b mut CodeBuilder,
    index: u16,
    depth: u8,
    /// Of each branch around: where it is left. None for the function, and for a block, which is
    /// not left.
    leaves: Vec<Option<Vec<Mark>>>,
}

impl Body<'_, '_> {
    fn statements(&mut self, most: u8) -> Result<()> {
        for _ in 0..self.u.int_in_range(1..=most)? {
            self.statement()?;
        }
        Ok(())
    }

    fn nested(&mut self) -> Result<()> {
        self.depth += 1;
        self.statements(2)?;
        self.depth -= 1;
        Ok(())
    }

    fn statement(&mut self) -> Result<()> {
        let can_nest = self.depth < MAX_DEPTH;
        match self.u.int_in_range(0..=11)? {
            0 => drop(self.code.push(op::Barrier { reason: ReasonId(0) })),
            1 | 2 if self.index + 1 < FUNCTIONS => {
                let function = FunctionId(self.u.int_in_range(self.index + 1..=FUNCTIONS - 1)?);
                self.code.push(op::Call { prefix: P, function });
            }
            3..=5 if can_nest => self.fork()?,
            6 if can_nest => {
                self.code.push(op::SenseInput { local: INPUT, bit: Bit(0) });
                self.code.push(op::PushLocal { local: INPUT });
                self.branch()?;
            }
            7 if can_nest => {
                self.code.push(op::PushGlobal { global: FLAG });
                self.branch()?;
            }
            8 => {
                let value = if self.u.ratio(1_u8, 2)? { Level::High } else { Level::Low };
                self.code.push(op::PushBool { value });
                self.code.push(op::StoreGlobal { prefix: P, global: FLAG });
            }
            9 if can_nest => self.block()?,
            10 => self.leave()?,
            _ => {
                self.code.push(op::PushConstant { constant: ConstantId(0) });
                self.code.push(op::Wait { prefix: P });
            }
        }
        Ok(())
    }

    /// Statements that are run if a condition holds.
    fn branch(&mut self) -> Result<()> {
        let around = self.code.jump(|target| op::JumpUnless { prefix: P, target });
        self.nested()?;
        self.code.join(around, |from| op::Join { from });
        Ok(())
    }

    fn fork(&mut self) -> Result<()> {
        let fork = self.code.jump(|join| op::Fork { join });
        let mut leaves = Vec::new();
        for number in 0..self.u.int_in_range(2..=3)? {
            if number > 0 {
                self.code.push(op::ForkNext {});
            }
            self.leaves.push(Some(Vec::new()));
            self.nested()?;
            leaves.extend(self.leaves.pop().flatten().into_iter().flatten());
        }
        let join = self.code.join(fork, |from| op::ForkJoin { from });
        leaves.into_iter().for_each(|leave| self.code.lead(leave, join));
        Ok(())
    }

    fn leave(&mut self) -> Result<()> {
        let Some(Some(_)) = self.leaves.last() else { return Ok(()) };
        self.code.push(op::SenseInput { local: INPUT, bit: Bit(1) });
        self.code.push(op::PushLocal { local: INPUT });
        let stay = self.code.jump(|target| op::JumpIf { prefix: P, target });
        let leave = self.code.jump(|join| op::ForkLeave { join });
        self.code.join(stay, |from| op::Land { from });
        if let Some(Some(leaves)) = self.leaves.last_mut() {
            leaves.push(leave);
        }
        Ok(())
    }

    fn block(&mut self) -> Result<()> {
        let from = Label(self.code.push(op::BlockBegin {}));
        self.leaves.push(None);
        self.nested()?;
        self.leaves.pop();
        if self.u.ratio(1_u8, 2)? && self.index + 1 < FUNCTIONS {
            self.code.push(op::BlockReplace { function: FunctionId(FUNCTIONS - 1), from });
        } else {
            self.code.push(op::BlockSkip { from });
        }
        Ok(())
    }
}
