//! The start: first values, the call of the main sequence, and beginning the program again.

use super::Lower;
use super::errors::most_rounds;
use super::frame::Frame;
use super::statement::PREFIX;
use super::test::Test;
use crate::effects::Effects;
use crate::response::Response;
use crate::tree::{Place, Program, StatementKind};
use obverse_bytecode::{Continuation, FunctionKind, Mark};
use obverse_isa::{ErrorId, GlobalId, Instr, LocalId, Type};

/// The errors after which the program begins again.
pub(super) fn restarting_errors(program: &Program, effects: &Effects) -> Vec<ErrorId> {
    let errors = (0..program.module.errors.len()).filter_map(|index| u16::try_from(index).ok());
    errors
        .map(ErrorId)
        .filter(|error| {
            let response = effects.response(*error);
            matches!(response, Response::Recover { then: Continuation::Program, .. })
        })
        .collect()
}

impl<'p> Lower<'p> {
    /// Function 0.
    pub(super) fn start(&mut self) {
        let program = self.program;
        let main = program.function(program.main);
        self.frame =
            Frame { named: main.named, is_start: true, is_reached: true, ..Frame::default() };
        self.at(main.named, None);
        self.push(Instr::Enter {});
        let top = self.globals.restart.map(|_| {
            let rounds = self.hidden("rounds", Type::Int);
            (self.join_ahead(), rounds)
        });
        for (index, value) in program.first_values.iter().enumerate() {
            self.at(value.span, None);
            let global = GlobalId(u16::try_from(index).unwrap_or(u16::MAX));
            self.store(Place::Global(global), value);
        }
        self.at(main.named, None);
        let call = StatementKind::Call(program.main, Vec::new());
        let due = self.due(&call);
        let site = self.begin_site(&due);
        self.push(Instr::Call { prefix: PREFIX, function: program.main });
        if self.effects.leaves(program.main) && !due.is_empty() {
            self.leave_if_leaving();
        }
        self.end_site(&due, site, false);
        let exits = std::mem::take(&mut self.frame.exits);
        self.join_all(exits);
        if let Some((top, rounds)) = top {
            self.restart(top, rounds);
        }
        self.cleanup();
        self.push(Instr::Halt {});
        self.close_function("$start", FunctionKind::Start, 0);
    }

    /// What is done at the end, whatever came before. Errors that are pending then are not so
    /// meanwhile: it is none of them that is found after an act of it.
    fn cleanup(&mut self) {
        let Some(function) = self.program.cleanup else { return };
        self.at(self.program.function(function).named, None);
        if let (true, Some(leaving)) = (self.effects.leaves(function), self.globals.leaving) {
            self.set_flag(leaving, false);
        }
        let pending = self.set_aside(&self.effects.raised_within(function));
        self.push(Instr::Call { prefix: PREFIX, function });
        for &error in self.effects.left_by(function) {
            if self.effects.response(error) == Response::Ignore {
                self.clear_if_raised(error);
            }
        }
        self.take_up(&pending);
    }

    /// Begin the program again if that is asked for and has not been done too often.
    fn restart(&mut self, top: Mark, rounds: LocalId) {
        let Some(restart) = self.globals.restart else { return };
        // Where nothing has been left, the program does not begin again, and reach follows that.
        let flags = [self.globals.leaving, Some(restart)];
        let mut not_again: Vec<Mark> = Vec::new();
        for global in flags.into_iter().flatten() {
            self.push(Instr::PushGlobal { global });
            let unless = self.code.jump(|target| Instr::JumpUnless { prefix: PREFIX, target });
            not_again.push(unless);
        }
        let errors = restarting_errors(self.program, self.effects);
        let declared = errors.iter().map(|error| &self.program.module.errors[error.index()]);
        let most = declared.map(most_rounds).max().unwrap_or(0);
        let test = Test::UnlessLocalLtImmediate(rounds, most);
        not_again.push(self.code.jump(|target| test.to(target)));
        self.push(Instr::AddLocalImmediate { local: rounds, value: 1 });
        for error in errors {
            self.clear_if_raised(error);
        }
        self.set_flag(restart, false);
        if let Some(leaving) = self.globals.leaving {
            self.set_flag(leaving, false);
        }
        self.jump_back(top);
        self.join_all(not_again);
    }
}
