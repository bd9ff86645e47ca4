//! Advanced moves as functions: attempts, what success is, and what follows.

use super::Lower;
use super::statement::PREFIX;
use crate::tree::{Aftermath, Expression, GuardedMove, Retry, SettingValue, Unmet};
use obverse_bytecode::Mark;
use obverse_isa::{Axis, CounterId, Instr, LocalId, Path, Setting, SlotId};

/// The counter of attempts.
const ATTEMPT: CounterId = CounterId(0);

impl Lower<'_> {
    /// The body of an advanced move.
    pub(super) fn guarded(&mut self, guarded: &GuardedMove) {
        self.guarded_body(guarded);
        let exits = std::mem::take(&mut self.frame.exits);
        self.join_all(exits);
    }

    fn guarded_body(&mut self, guarded: &GuardedMove) {
        self.at(guarded.spans.motion, None);
        if let Some(slot) = guarded.initial {
            self.push(Instr::Remember { slot });
        }
        let cannot = self.requires(guarded);
        self.at(guarded.spans.motion, None);
        guarded.angle.iter().for_each(|angle| self.hoists(&angle.hoists));
        self.hoists(&guarded.distance.hoists);
        guarded.limit.iter().for_each(|limit| self.hoists(&limit.hoists));
        if let Some((_, former)) = guarded.speed {
            self.keep(Setting::Speed, former);
        }
        let has_aftermath = [guarded.on_success, guarded.on_failure].iter().any(has_some);
        let succeeded = match &guarded.repeat {
            Some(retry) => self.attempts(guarded, retry),
            None => {
                self.motion_and_results(guarded);
                if !has_aftermath {
                    // Whether it has succeeded changes nothing.
                    return self.at(guarded.spans.end, None);
                }
                self.jump_if_succeeded(guarded)
            }
        };
        self.aftermath_failure(guarded, cannot);
        self.aftermath_success(guarded, succeeded);
        self.at(guarded.spans.end, None);
    }

    /// What must hold before: the jump to what follows if it does not, or a trap.
    fn requires(&mut self, guarded: &GuardedMove) -> Option<Mark> {
        let (condition, unmet) = guarded.requires.as_ref()?;
        self.at(condition.value.span, None);
        self.hoists(&condition.hoists);
        match *unmet {
            Unmet::Throws(error) => {
                let test = self.test(&condition.value, true);
                let holds = self.code.jump(|target| test.to(target));
                self.raise(error);
                let over = self.jump();
                self.frame.exits.push(over);
                self.join_one(holds);
                return None;
            }
            Unmet::Fails(reason) if guarded.on_failure.throws.is_none() => {
                self.expression(&condition.value);
                self.push(Instr::Require { prefix: PREFIX, reason });
                return None;
            }
            Unmet::Fails(_) => {}
        }
        let test = self.test(&condition.value, false);
        Some(self.code.jump(|target| test.to(target)))
    }

    fn motion_and_results(&mut self, guarded: &GuardedMove) {
        self.at(guarded.spans.motion, None);
        if let Some((speed, _)) = guarded.speed {
            self.set(&SettingValue::Speed(speed));
        }
        self.motion_itself(guarded);
        self.push(Instr::SenseDistance { local: guarded.results.distance });
        self.push(Instr::SensePeakForce { local: guarded.results.force });
        if let Some((_, former)) = guarded.speed {
            self.restore(Setting::Speed, former);
        }
        self.end_if_moved_wrong();
    }

    fn motion_itself(&mut self, guarded: &GuardedMove) {
        guarded.angle.iter().for_each(|angle| self.expression(&angle.value));
        self.expression(&guarded.distance.value);
        guarded.limit.iter().for_each(|limit| self.expression(&limit.value));
        let (prefix, axis, frame) = (PREFIX, guarded.axis, guarded.frame);
        let (is_turn, is_limited) = (guarded.angle.is_some(), guarded.limit.is_some());
        self.push(match (is_turn, is_limited) {
            (true, true) => Instr::MoveTurnGuarded { prefix, axis, frame },
            (true, false) => Instr::MoveTurn { prefix, axis, frame },
            (false, true) if guarded.is_opposed => {
                Instr::MoveGuardedOpposite { prefix, axis, frame }
            }
            (false, true) => Instr::MoveGuarded { prefix, axis, frame },
            (false, false) => Instr::MoveRelative { prefix, axis, frame },
        });
    }

    /// After a motion: the move ends if it has met a fault that the program calls an error.
    fn end_if_moved_wrong(&mut self) {
        let effects = self.effects;
        self.end_if_raised(effects.raised_by_motion());
    }

    /// The jump that is taken if an attempt has succeeded.
    fn jump_if_succeeded(&mut self, guarded: &GuardedMove) -> Mark {
        self.at(guarded.spans.succeeds, None);
        self.hoists(&guarded.succeeds.hoists);
        let test = self.test(&guarded.succeeds.value, true);
        self.code.jump(|target| test.to(target))
    }

    /// Attempts in a row, all but the first with a sideways offset.
    fn attempts(&mut self, guarded: &GuardedMove, retry: &Retry) -> Mark {
        self.at(retry.span, None);
        self.hoists(&retry.within.hoists);
        self.push(Instr::PushInt { value: 0 });
        self.push(Instr::PushInt { value: retry.times });
        let exit =
            self.code.jump(|exit| Instr::ForEnter { prefix: PREFIX, counter: ATTEMPT, exit });
        let top = self.code.join_ahead(|from| Instr::ForTop { counter: ATTEMPT, from });
        self.push(Instr::PushCounter { counter: ATTEMPT });
        self.push(Instr::PushInt { value: 0 });
        let first = self.code.jump(|target| Instr::JumpUnlessNe { prefix: PREFIX, target });
        self.perturb(guarded, retry);
        self.join_one(first);
        self.motion_and_results(guarded);
        let succeeded = self.jump_if_succeeded(guarded);
        self.at(retry.span, None);
        self.code.jump_back(top, |target| Instr::ForNext { counter: ATTEMPT, target });
        self.code.join(exit, |from| Instr::ForExit { counter: ATTEMPT, from });
        succeeded
    }

    /// Go to where the move began, and from there somewhat aside.
    fn perturb(&mut self, guarded: &GuardedMove, retry: &Retry) {
        for local in retry.draws {
            self.push(Instr::Draw { local });
        }
        if let Some(slot) = guarded.initial {
            self.move_back(slot);
        }
        let [first, second] = retry.draws.map(Some);
        // Only across the move: how far it comes says whether it has succeeded.
        let offsets = match guarded.axis {
            Axis::PlusX | Axis::MinusX => [None, first, second],
            Axis::PlusY | Axis::MinusY => [first, None, second],
            Axis::PlusZ | Axis::MinusZ => [first, second, None],
        };
        for draw in offsets {
            self.offset(draw, &retry.within.value);
        }
        self.push(Instr::MoveOffset { prefix: PREFIX, frame: guarded.frame });
        self.end_if_moved_wrong();
    }

    /// Push `(2 * draw - 1) * within`: evenly from `-within` to `within`.
    fn offset(&mut self, draw: Option<LocalId>, within: &Expression) {
        let Some(local) = draw else { return self.push_real(0.0) };
        self.push(Instr::PushLocal { local });
        self.push_real(2.0);
        self.push(Instr::RealMul {});
        self.push_real(1.0);
        self.push(Instr::RealSub {});
        self.expression(within);
        self.push(Instr::RealMul {});
    }

    fn move_back(&mut self, slot: SlotId) {
        self.push(Instr::MoveSlot { slot, path: Path::Linear });
        self.end_if_moved_wrong();
    }

    fn aftermath_failure(&mut self, guarded: &GuardedMove, cannot: Option<Mark>) {
        self.return_to_initial(&guarded.on_failure, guarded.initial);
        if let Some((_, span)) = guarded.on_failure.throws {
            self.at(span, None);
        }
        cannot.into_iter().for_each(|cannot| self.join_one(cannot));
        self.throw(&guarded.on_failure);
    }

    fn aftermath_success(&mut self, guarded: &GuardedMove, succeeded: Mark) {
        let aftermath = &guarded.on_success;
        let over = has_some(aftermath).then(|| self.jump());
        self.join_one(succeeded);
        self.return_to_initial(aftermath, guarded.initial);
        self.throw(aftermath);
        self.at(guarded.spans.end, None);
        over.into_iter().for_each(|over| self.join_one(over));
    }

    fn return_to_initial(&mut self, aftermath: &Aftermath, initial: Option<SlotId>) {
        if let (Some(span), Some(slot)) = (aftermath.returns, initial) {
            self.at(span, None);
            self.move_back(slot);
        }
    }

    fn throw(&mut self, aftermath: &Aftermath) {
        if let Some((error, span)) = aftermath.throws {
            self.at(span, None);
            self.raise(error);
        }
    }
}

fn has_some(aftermath: &Aftermath) -> bool {
    aftermath.returns.is_some() || aftermath.throws.is_some()
}
