//! Statements but for branches and loops: motions, outputs, settings, calls, reversal words.

use super::Lower;
use super::frame::Scope;
use super::leave::Way;
use crate::tree::{Block, Expression, Motion, SettingValue, Statement, StatementKind};
use obverse_bytecode::{ActionKind, Mark};
use obverse_isa::{Bit, ErrorId, FunctionId, Instr, Label, Level, LocalId, Prefix, Setting};

/// The builder counts prefixes.
pub(super) const PREFIX: Prefix = Prefix(0);

impl Lower<'_> {
    /// Statements in a row.
    pub(super) fn block(&mut self, block: &Block) {
        for statement in &block.statements {
            if self.frame.is_reached && self.has_room() {
                self.statement(statement);
            }
        }
    }

    fn statement(&mut self, statement: &Statement) {
        use StatementKind::{
            Advance, Barrier, Break, Call, Checkpoint, Demand, For, Fork, If, Io, Irreversible,
            Kept, Loop, Move, Output, Remember, Requires, Return, Reversed, Set, SetFor, Store,
            Throw, Update, Wait, WaitInput, While,
        };
        let due: Vec<ErrorId> = self.due(&statement.kind);
        if !due.is_empty() {
            self.at(statement.span, None);
        }
        let site = self.begin_site(&due);
        self.begin(statement);
        let holds = match &statement.kind {
            Requires(condition, _) => {
                let test = self.test(condition, true);
                Some(self.code.jump(|target| test.to(target)))
            }
            _ => None,
        };
        match &statement.kind {
            Move(motion) => self.motion(motion),
            Advance(function, counterpart) | Io(function, counterpart) => {
                self.call_or_opposite(*function, *counterpart);
            }
            Call(function, arguments) => {
                arguments.iter().for_each(|argument| self.expression(argument));
                self.push(Instr::Call { prefix: PREFIX, function: *function });
                self.leave_if_left(*function);
            }
            Wait(time) => {
                self.expression(time);
                self.push(Instr::Wait { prefix: PREFIX });
            }
            WaitInput { .. } => self.wait_input(statement),
            Output { bit, level, settle } => self.output(*bit, *level, settle),
            Store(place, value) => self.store(*place, value),
            Update { place, subtracts, value } => self.update(*place, *subtracts, value),
            Remember(slot) => self.push(Instr::Remember { slot: *slot }),
            If { .. } | While { .. } | For { .. } | Loop(_) => self.control(statement),
            Fork(branches) => self.fork(branches),
            Break => self.leave_loop(),
            Return => self.leave(Way::Out),
            Set(value) => self.set(value),
            SetFor { value, former, block } => self.set_for(value, *former, block),
            Checkpoint(checkpoint) => self.push(Instr::Checkpoint { checkpoint: *checkpoint }),
            Barrier(reason) => self.push(Instr::Barrier { reason: *reason }),
            Irreversible(reason, block) => {
                let reason = *reason;
                self.push(Instr::Irreversible { reason });
                self.scoped(Scope::Irreversible(reason), block);
                // Going back stops here, and it is the header that says why.
                self.at(statement.span, None);
                if self.frame.is_reached {
                    self.push(Instr::Irreversible { reason });
                }
            }
            Reversed(block, replacement) => self.reversed(block, *replacement),
            Kept(function) => self.kept(*function),
            Demand(condition, reason) => {
                self.expression(condition);
                self.push(Instr::Require { prefix: PREFIX, reason: *reason });
            }
            Throw(error) | Requires(_, error) => self.raise(*error),
        }
        let is_thrown = matches!(statement.kind, Throw(_) | Requires(..));
        self.end_site(&due, site, is_thrown);
        let effects = self.effects;
        self.end_if_raised(effects.raised_by_act(&statement.kind));
        holds.into_iter().for_each(|holds| self.join_one(holds));
        if let WaitInput { came, otherwise: Some(otherwise), .. } = &statement.kind {
            self.unless_came(*came, otherwise);
        }
    }

    /// Where a statement begins, and what comes before it.
    fn begin(&mut self, statement: &Statement) {
        let action = if self.frame.has_actions { action_of(&statement.kind) } else { None };
        self.at(statement.span, action);
        self.hoists(&statement.hoists);
    }

    fn motion(&mut self, motion: &Motion) {
        match motion {
            Motion::Joints(joints, path) => {
                self.expression(joints);
                self.push(match path {
                    obverse_isa::Path::Joint => Instr::MoveJoint { prefix: PREFIX },
                    obverse_isa::Path::Linear => Instr::MoveLinear { prefix: PREFIX },
                });
            }
            Motion::Always(from, to, path) => {
                self.push(Instr::PushJoints { joints: *from });
                self.push(Instr::PushJoints { joints: *to });
                self.push(Instr::MoveAlways { prefix: PREFIX, path: *path });
            }
            Motion::Keyframe(item, keyframe, path) => {
                self.expression(item);
                let (keyframe, path) = (*keyframe, *path);
                self.push(Instr::MoveItem { prefix: PREFIX, keyframe, path });
            }
            Motion::Relative(distance, axis, frame) => {
                self.expression(distance);
                let (axis, frame) = (*axis, *frame);
                self.push(Instr::MoveRelative { prefix: PREFIX, axis, frame });
            }
            Motion::Position(slot, path) => {
                self.push(Instr::MoveSlot { slot: *slot, path: *path });
            }
        }
    }

    /// A call of an I/O operation or an advanced move; with a counterpart it is a block that this
    /// replaces.
    fn call_or_opposite(&mut self, function: FunctionId, counterpart: Option<FunctionId>) {
        let Some(counterpart) = counterpart else {
            return self.push(Instr::Call { prefix: PREFIX, function });
        };
        let from = Label(self.code.push(Instr::BlockBegin {}));
        self.push(Instr::Call { prefix: PREFIX, function });
        self.push(Instr::BlockReplace { function: counterpart, from });
    }

    fn output(&mut self, bit: Bit, level: Option<Level>, settle: &Expression) {
        self.expression(settle);
        self.push(match level {
            Some(level) => Instr::OutputSet { prefix: PREFIX, bit, level },
            None => Instr::OutputToggle { prefix: PREFIX, bit },
        });
    }

    fn wait_input(&mut self, statement: &Statement) {
        let StatementKind::WaitInput { bit, level, timeout, came, .. } = &statement.kind else {
            return;
        };
        self.expression(timeout);
        let (local, bit, level) = (*came, *bit, *level);
        self.push(Instr::WaitInput { prefix: PREFIX, local, bit, level });
    }

    /// What is done if an input did not come.
    fn unless_came(&mut self, local: LocalId, otherwise: &Block) {
        self.push(Instr::PushLocal { local });
        let over = self.code.jump(|target| Instr::JumpIf { prefix: PREFIX, target });
        self.block(otherwise);
        self.at(otherwise.end, None);
        self.join_one(over);
    }

    /// Change a setting.
    pub(super) fn set(&mut self, value: &SettingValue) {
        match value {
            SettingValue::Speed(speed) | SettingValue::ReverseSpeed(speed) => {
                self.push(Instr::PushSpeed { speed: *speed });
            }
            SettingValue::Tool(tool) => self.push(Instr::PushTool { tool: *tool }),
            SettingValue::ReverseForceLimit(limit) => self.expression(limit),
            SettingValue::ReverseStraight => self.push_bool(true),
        }
        self.push(Instr::SettingSet { prefix: PREFIX, setting: value.setting() });
    }

    /// Keep what a setting is.
    pub(super) fn keep(&mut self, setting: Setting, local: LocalId) {
        self.push(Instr::PushSetting { setting });
        self.push(Instr::StoreLocal { prefix: PREFIX, local });
    }

    /// Make a setting what it was.
    pub(super) fn restore(&mut self, setting: Setting, local: LocalId) {
        self.push(Instr::PushLocal { local });
        self.push(Instr::SettingSet { prefix: PREFIX, setting });
    }

    fn set_for(&mut self, value: &SettingValue, former: LocalId, block: &Block) {
        let setting = value.setting();
        self.keep(setting, former);
        self.set(value);
        self.scoped(Scope::Setting(setting, former), block);
        self.at(block.end, None);
        if self.frame.is_reached {
            self.restore(setting, former);
        }
    }

    /// A block with something to put right when it is left on the way.
    pub(super) fn scoped(&mut self, scope: Scope, block: &Block) -> Option<Scope> {
        self.frame.scopes.push(scope);
        self.block(block);
        self.frame.scopes.pop()
    }

    /// A block with a reverse of its own: all ways out of it lead over its end.
    pub(super) fn reversed(&mut self, block: &Block, replacement: Option<FunctionId>) {
        let from = Label(self.code.push(Instr::BlockBegin {}));
        self.begin_ways(std::slice::from_ref(block));
        let scope = self.scoped(Scope::Reversed(Vec::new()), block);
        let Some(Scope::Reversed(ways)) = scope else { return };
        let (marks, ways): (Vec<Mark>, Vec<Way>) = ways.into_iter().unzip();
        self.at(block.end, None);
        self.join_all(marks);
        self.push(match replacement {
            Some(function) => Instr::BlockReplace { function, from },
            None => Instr::BlockSkip { from },
        });
        self.go_on(&ways);
    }
}

/// What a statement is to a story, if it is an action of the robot.
fn action_of(kind: &StatementKind) -> Option<ActionKind> {
    match kind {
        StatementKind::Move(_) => Some(ActionKind::Move),
        StatementKind::Advance(..) => Some(ActionKind::Advance),
        StatementKind::Call(..) => Some(ActionKind::Call),
        StatementKind::Io(..) => Some(ActionKind::Io),
        StatementKind::Output { .. } => Some(ActionKind::Primitive),
        StatementKind::Wait(_) | StatementKind::WaitInput { .. } => Some(ActionKind::Wait),
        _ => None,
    }
}
