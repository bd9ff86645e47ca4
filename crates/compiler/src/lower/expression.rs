//! Expressions as prefixes: pure instructions, with common pairs fused into one.

use super::Lower;
use crate::tree::{Expression, ExpressionKind, Hoist, Place};
use obverse_bytecode::Constant;
use obverse_isa::{Instr, Level, Prefix};

impl Lower<'_> {
    /// Push the value of an expression.
    pub(super) fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Int(value) => self.int(*value),
            ExpressionKind::Real(value) => {
                let constant = self.constant(Constant::Real(*value));
                self.push(Instr::PushConstant { constant });
            }
            ExpressionKind::Bool(value) => self.push_bool(*value),
            ExpressionKind::Joints(joints) => self.push(Instr::PushJoints { joints: *joints }),
            ExpressionKind::Item(item) => self.push(Instr::PushItem { item: *item }),
            ExpressionKind::Local(local) => self.push(Instr::PushLocal { local: *local }),
            ExpressionKind::Global(global) => self.push(Instr::PushGlobal { global: *global }),
            ExpressionKind::Counter(counter) => {
                self.push(Instr::PushCounter { counter: *counter });
            }
            ExpressionKind::Unary(instr, operand) => {
                self.expression(operand);
                self.push(*instr);
            }
            ExpressionKind::Binary(instr, operands) => {
                self.binary(*instr, &operands.0, &operands.1);
            }
            // No checked tree has one.
            ExpressionKind::Missing => self.int(0),
        }
    }

    fn int(&mut self, value: i64) {
        match i32::try_from(value) {
            Ok(value) => self.push(Instr::PushInt { value }),
            Err(_) => {
                let constant = self.constant(Constant::Int(value));
                self.push(Instr::PushConstant { constant });
            }
        }
    }

    /// Push a truth value.
    pub(super) fn push_bool(&mut self, value: bool) {
        let value = if value { Level::High } else { Level::Low };
        self.push(Instr::PushBool { value });
    }

    /// Push a real.
    pub(super) fn push_real(&mut self, value: f64) {
        let constant = self.constant(Constant::Real(value));
        self.push(Instr::PushConstant { constant });
    }

    fn binary(&mut self, instr: Instr, left: &Expression, right: &Expression) {
        match fuse(instr, left, right) {
            Some((operand, fused)) => {
                operand.into_iter().for_each(|operand| self.expression(operand));
                self.push(fused);
            }
            None => {
                self.expression(left);
                self.expression(right);
                self.push(instr);
            }
        }
    }

    /// Do what comes before a statement.
    pub(super) fn hoists(&mut self, hoists: &[Hoist]) {
        for hoist in hoists {
            match hoist {
                Hoist::Read(instr) => self.push(*instr),
                Hoist::Store { local, value } => self.store(Place::Local(*local), value),
            }
        }
    }

    /// Store a value.
    pub(super) fn store(&mut self, place: Place, value: &Expression) {
        self.expression(value);
        self.push(store(place));
    }

    /// Add to an integer variable that the value does not read, or subtract.
    pub(super) fn update(&mut self, place: Place, subtracts: bool, value: &Expression) {
        let Place::Local(local) = place else { return self.update_any(place, subtracts, value) };
        let fused = match (&value.kind, subtracts) {
            (ExpressionKind::Int(value), false) => small(*value),
            (ExpressionKind::Int(value), true) => value.checked_neg().and_then(small),
            (ExpressionKind::Local(value), false) => {
                return self.push(Instr::AddLocalLocal { local, value: *value });
            }
            (ExpressionKind::Local(value), true) => {
                return self.push(Instr::SubLocalLocal { local, value: *value });
            }
            (ExpressionKind::Counter(counter), false) => {
                return self.push(Instr::AddLocalCounter { local, counter: *counter });
            }
            (ExpressionKind::Counter(counter), true) => {
                return self.push(Instr::SubLocalCounter { local, counter: *counter });
            }
            _ => None,
        };
        match fused {
            Some(value) => self.push(Instr::AddLocalImmediate { local, value }),
            None => self.update_any(place, subtracts, value),
        }
    }

    fn update_any(&mut self, place: Place, subtracts: bool, value: &Expression) {
        self.expression(value);
        let prefix = Prefix(0);
        self.push(match (place, subtracts) {
            (Place::Local(local), false) => Instr::AddLocal { prefix, local },
            (Place::Local(local), true) => Instr::SubLocal { prefix, local },
            (Place::Global(global), false) => Instr::AddGlobal { prefix, global },
            (Place::Global(global), true) => Instr::SubGlobal { prefix, global },
        });
    }
}

/// Store into a variable.
pub(super) fn store(place: Place) -> Instr {
    let prefix = Prefix(0);
    match place {
        Place::Local(local) => Instr::StoreLocal { prefix, local },
        Place::Global(global) => Instr::StoreGlobal { prefix, global },
    }
}

fn small(value: i64) -> Option<i32> {
    i32::try_from(value).ok()
}

/// An instruction that does the work of several, and the operand that it still needs computed.
fn fuse<'e>(
    instr: Instr,
    left: &'e Expression,
    right: &'e Expression,
) -> Option<(Option<&'e Expression>, Instr)> {
    use ExpressionKind::{Counter, Int, Local};
    Some(match (instr, &left.kind, &right.kind) {
        (Instr::IntAdd {}, Local(left), Local(right)) => {
            (None, Instr::IntAddLocals { left: *left, right: *right })
        }
        (Instr::IntAdd {}, _, Int(value)) => {
            (Some(left), Instr::IntAddImmediate { value: small(*value)? })
        }
        (Instr::IntAdd {}, Int(value), _) => {
            (Some(right), Instr::IntAddImmediate { value: small(*value)? })
        }
        (Instr::IntSub {}, _, Int(value)) => {
            (Some(left), Instr::IntAddImmediate { value: small(value.checked_neg()?)? })
        }
        (Instr::IntAdd {}, _, Local(local)) => (Some(left), Instr::IntAddLocal { local: *local }),
        (Instr::IntAdd {}, Local(local), _) => (Some(right), Instr::IntAddLocal { local: *local }),
        (Instr::IntMul {}, Local(local), Int(value))
        | (Instr::IntMul {}, Int(value), Local(local)) => {
            (None, Instr::IntMulLocalImmediate { local: *local, value: small(*value)? })
        }
        (Instr::IntMul {}, Counter(counter), Int(value))
        | (Instr::IntMul {}, Int(value), Counter(counter)) => {
            (None, Instr::IntMulCounterImmediate { counter: *counter, value: small(*value)? })
        }
        (Instr::IntMul {}, _, Int(value)) => {
            (Some(left), Instr::IntMulImmediate { value: small(*value)? })
        }
        (Instr::IntMul {}, Int(value), _) => {
            (Some(right), Instr::IntMulImmediate { value: small(*value)? })
        }
        (Instr::IntRem {}, Local(local), Int(value)) => {
            (None, Instr::IntRemLocalImmediate { local: *local, value: small(*value)? })
        }
        (Instr::IntRem {}, Counter(counter), Int(value)) => {
            (None, Instr::IntRemCounterImmediate { counter: *counter, value: small(*value)? })
        }
        (Instr::IntRem {}, _, Int(value)) => {
            (Some(left), Instr::IntRemImmediate { value: small(*value)? })
        }
        _ => return None,
    })
}
