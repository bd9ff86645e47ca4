//! What an effect does: to the variables, to the robot, and to what is gone back over.
//!
//! Mirrors the machine's families, on values that may not be known. An effect that is not known
//! here leaves nothing known: new instructions are never taken for harmless.

use crate::command::{Aim, Command, Guard};
use crate::explore::{Course, Explorer};
use crate::reason::Reason;
use crate::state::{State, Word};
use crate::trace::{Deed, Node};
use crate::verdict::{Verdict, because};
use crate::worlds::WorldId;
use obverse_geometry::{JointConfiguration, Pose};
use obverse_isa::{Axis, Family, Frame, Instr, KeyframeId, LocalId, Setting, SpeedId};
use obverse_sim::cell::InputRule;
use obverse_vm::{Direction, convert};
use obverse_workcell::{Items, MotionEnd, Path, Speed, ToolId};
use std::rc::Rc;

/// The operands of an effect.
struct Operands<'o>(&'o [Word]);

impl Operands<'_> {
    fn word(&self, at: usize) -> Word {
        self.0.get(at).copied().flatten()
    }

    fn real(&self, at: usize) -> Option<f64> {
        self.word(at).map(f64::from_bits)
    }
}

impl Explorer<'_> {
    /// Do an effect other than flow; the state after it, unless the run ends there.
    pub(crate) fn act(
        &mut self,
        mut state: State,
        instr: Instr,
        operands: &[Word],
    ) -> Option<State> {
        let operands = Operands(operands);
        match instr {
            Instr::StoreLocal { local, .. } => self.store(state, local, operands.word(0)),
            Instr::StoreGlobal { global, .. } => {
                state.globals[global.index()] = operands.word(0);
                self.pass(state)
            }
            Instr::AddLocal { local, .. } => self.add(state, local, operands.word(0)),
            Instr::AddLocalImmediate { local, value } => {
                self.add(state, local, Some(i64::from(value).cast_unsigned()))
            }
            Instr::AddLocalLocal { local, value } => {
                let term = state.frame().locals[value.index()];
                self.add(state, local, term)
            }
            Instr::AddLocalCounter { local, counter } => {
                let term = state.frame().counters[counter.index()][2];
                self.add(state, local, term)
            }
            Instr::SubLocal { local, .. } => self.subtract(state, local, operands.word(0)),
            Instr::SubLocalLocal { local, value } => {
                let term = state.frame().locals[value.index()];
                self.subtract(state, local, term)
            }
            Instr::SubLocalCounter { local, counter } => {
                let term = state.frame().counters[counter.index()][2];
                self.subtract(state, local, term)
            }
            Instr::AddGlobal { global, .. } | Instr::SubGlobal { global, .. } => {
                let is_add = matches!(instr, Instr::AddGlobal { .. });
                let change = if is_add { Instr::IntAdd {} } else { Instr::IntSub {} };
                let place = &mut state.globals[global.index()];
                *place = self.values.binary(change, *place, operands.word(0));
                self.pass(state)
            }
            // The limit of a force is above zero, or the machine traps.
            Instr::SettingSet { setting: Setting::ReverseForceLimit, .. }
                if operands.real(0).is_some_and(|limit_n| limit_n.is_nan() || limit_n <= 0.0) =>
            {
                None
            }
            Instr::SettingSet { setting, .. } => {
                state.settings[setting as usize] = operands.word(0);
                self.pass(state)
            }
            Instr::ErrorRaise { error } => {
                if let Some(raised) = &mut state.raised {
                    raised.push(error);
                }
                // A program that raises for ever is not followed error by error.
                state.raised = state.raised.filter(|raised| raised.len() < 64);
                self.pass(state)
            }
            Instr::ErrorClear { error } => {
                if let Some(raised) = &mut state.raised
                    && let Some(at) = raised.iter().position(|pending| *pending == error)
                {
                    raised.remove(at);
                }
                self.pass(state)
            }
            Instr::Require { .. } if operands.word(0) == Some(0) => None,
            Instr::Require { .. }
            | Instr::Wait { .. }
            | Instr::Checkpoint { .. }
            | Instr::ErrorDue { .. } => self.pass(state),
            _ => self.act_on_robot(state, instr, &operands),
        }
    }

    fn store(&mut self, mut state: State, local: LocalId, word: Word) -> Option<State> {
        state.frame_mut().locals[local.index()] = word;
        self.pass(state)
    }

    fn add(&mut self, state: State, local: LocalId, term: Word) -> Option<State> {
        let present = state.frame().locals[local.index()];
        let sum = self.values.binary(Instr::IntAdd {}, present, term);
        self.store(state, local, sum)
    }

    fn subtract(&mut self, state: State, local: LocalId, term: Word) -> Option<State> {
        let present = state.frame().locals[local.index()];
        let less = self.values.binary(Instr::IntSub {}, present, term);
        self.store(state, local, less)
    }

    fn act_on_robot(
        &mut self,
        mut state: State,
        instr: Instr,
        operands: &Operands<'_>,
    ) -> Option<State> {
        if let Some(command) = self.command(&state, instr, operands) {
            let back = self.command_back(&state, instr, command, operands);
            return self.go(state, &command?, back);
        }
        match instr {
            Instr::Remember { slot } => {
                let joints = self.worlds.joints(state.world);
                state.frame_mut().slots[slot.index()] = joints;
                self.pass(state)
            }
            Instr::SenseDistance { local } => {
                let distance = state.distance;
                self.store(state, local, distance)
            }
            Instr::SensePeakForce { local } => {
                let force = state.peak_force;
                self.store(state, local, force)
            }
            Instr::SenseForce { local } | Instr::Draw { local } => self.store(state, local, None),
            Instr::SenseHolding { local } => self.sense_holding(state, local),
            Instr::SenseInput { local, bit } => match self.rule(bit.0) {
                Some(InputRule::Holding) => self.sense_holding(state, local),
                Some(&InputRule::Constant(is_high)) => self.sense_input(state, local, is_high),
                _ => self.store(state, local, None),
            },
            Instr::WaitInput { local, bit, level, .. } => match self.rule(bit.0) {
                Some(&InputRule::Constant(is_high)) => {
                    self.sense_input(state, local, is_high == level.is_high())
                }
                _ => self.store(state, local, None),
            },
            Instr::OutputSet { bit, level, .. } => {
                self.set_output(state, bit.0, Some(level.is_high()), Deed::Output)
            }
            Instr::OutputToggle { bit, .. } => {
                let level = self.worlds.level(state.world).map(|level| !level);
                self.set_output(state, bit.0, level, Deed::Toggle)
            }
            _ => self.act_on_reverse(state, instr),
        }
    }

    /// The words of reversal, and what this check does not know.
    fn act_on_reverse(&mut self, mut state: State, instr: Instr) -> Option<State> {
        match instr {
            Instr::Barrier { .. } | Instr::Irreversible { .. } => self.done(state, Deed::Never),
            Instr::BlockBegin {} => {
                state = self.noted(state, Deed::BlockBegin);
                let begin = state.last;
                state.blocks.push(begin);
                self.pass(state)
            }
            Instr::BlockSkip { .. } => {
                let begin = state.blocks.pop()?;
                self.done(state, Deed::BlockSkip { begin })
            }
            Instr::BlockReplace { function, .. } => {
                let begin = state.blocks.pop()?;
                let state_then = Rc::new(self.copy(&state));
                let deed = Deed::BlockReplace { begin, function, state: state_then };
                self.done(state, deed)
            }
            _ => {
                if instr.info().family == Family::Kinematic {
                    self.note_unknown(&state);
                }
                if !state.forks.is_empty() {
                    return self.lose_turns(state);
                }
                state.frame_mut().forget();
                let before = state.world;
                state.forget_effects(self.worlds.nothing_known());
                let (deed, after) = (Deed::Unfollowed { restores: false }, state.world);
                let from = vec![state.last];
                state.last = self.trace.add(Node { deed, before, after, from });
                self.pass(state)
            }
        }
    }

    /// Nothing can be said of a move that this check does not know.
    fn note_unknown(&mut self, state: &State) {
        let unknown = Rc::new(Verdict::new(Reason::UnknownInstruction));
        let calls = state.calls().into();
        for direction in [Direction::Forward, Direction::Reverse] {
            self.notes.add(state.pc as u32, direction, &unknown, &calls, state.is_planned);
        }
    }

    /// Note what was done without moving, and go on.
    fn done(&mut self, state: State, deed: Deed) -> Option<State> {
        let state = self.noted(state, deed);
        self.pass(state)
    }

    fn noted(&mut self, mut state: State, deed: Deed) -> State {
        let world = state.world;
        let from = vec![state.last];
        state.last = self.trace.add(Node { deed, before: world, after: world, from });
        state
    }

    fn rule(&self, bit: u16) -> Option<&InputRule> {
        self.worlds.cell().inputs.get(usize::from(bit))
    }

    /// An input that never changes in the cell is so as planned; the other way is followed too.
    fn sense_input(&mut self, state: State, local: LocalId, planned: bool) -> Option<State> {
        let world = state.world;
        self.sense(state, local, planned, world)
    }

    /// Whether something is held is known if all went as planned; where it is otherwise, nobody
    /// knows what became of the items.
    fn sense_holding(&mut self, state: State, local: LocalId) -> Option<State> {
        let Some(is_holding) = self.worlds.is_holding(state.world) else {
            return self.store(state, local, None);
        };
        let otherwise = self.worlds.forget_items(state.world);
        self.sense(state, local, is_holding, otherwise)
    }

    /// Go on with what is read as planned; and otherwise, in the workcell of that.
    fn sense(
        &mut self,
        state: State,
        local: LocalId,
        planned: bool,
        otherwise: WorldId,
    ) -> Option<State> {
        let mut other = self.copy(&state);
        other.world = otherwise;
        (other.is_planned, other.is_certain) = (false, false);
        let other = self.store(other, local, Some(u64::from(!planned)));
        self.open.extend(other);
        self.store(state, local, Some(u64::from(planned)))
    }

    fn set_output(
        &mut self,
        mut state: State,
        bit: u16,
        level: Option<bool>,
        deed: Deed,
    ) -> Option<State> {
        if !self.worlds.drives_gripper(bit) {
            return self.pass(state);
        }
        let before = state.world;
        state.world = self.worlds.with_level(before, level);
        let (after, from) = (state.world, vec![state.last]);
        state.last = self.trace.add(Node { deed, before, after, from });
        self.pass(state)
    }

    /// Go, note what comes of it, and go on from where that leads.
    fn go(&mut self, mut state: State, command: &Command, back: Command) -> Option<State> {
        let pc = state.pc as u32;
        let answer = self.worlds.ask(state.world, command);
        let calls: Rc<[u32]> = state.calls().into();
        let direction = match self.course {
            Course::Forward => Direction::Forward,
            Course::InReverse => Direction::Reverse,
        };
        let since = state.since;
        let verdict = because(&answer.verdict, since, direction);
        self.notes.add(pc, direction, &verdict, &calls, state.is_planned);
        state.since = match verdict.grade() {
            grade if grade.is_wrong() => Some(Reason::AfterFailure),
            // Where it leads is what would have come of it otherwise, too.
            _ if self.worlds.is_known(answer.after) => None,
            _ => since,
        };
        let is_guarded = command.guard != Guard::None;
        let number = |of: Option<f64>| of.map(f64::to_bits);
        state.distance = number(answer.report.map(|report| report.distance_m));
        // What is read of a motion that waits for no contact is noise.
        let peak_n = answer.report.filter(|_| is_guarded).map(|report| report.peak_force_n);
        state.peak_force = number(peak_n);
        // Where contact ends a motion, and so when, is not known to the last bit.
        let exact = answer.report.filter(|report| report.end == MotionEnd::Reached);
        let exact = exact.filter(|_| !state.forks.is_empty());
        state.duration = number(exact.map(|report| report.duration_s));
        let before = state.world;
        let arrive = |explorer: &mut Self, mut state: State, after: WorldId| {
            let is_planned = state.is_planned;
            let deed = Deed::Move { pc, back, calls: calls.clone(), is_planned, since };
            let from = vec![state.last];
            state.last = explorer.trace.add(Node { deed, before, after, from });
            state.world = after;
            state.pc += 1;
            state
        };
        if let Some(otherwise) = answer.otherwise.filter(|_| answer.report.is_some()) {
            let mut other = self.copy(&state);
            (other.distance, other.peak_force, other.duration) = (None, None, None);
            (other.is_planned, other.is_certain) = (false, false);
            let other = arrive(self, other, otherwise);
            self.open.push(other);
        }
        Some(arrive(self, state, answer.after))
    }

    /// The command that goes back over a motion, in the settings that hold for it: they are what
    /// they were when the machine comes back to it.
    fn command_back(
        &self,
        state: &State,
        instr: Instr,
        there: Option<Command>,
        operands: &Operands<'_>,
    ) -> Command {
        let setting = |setting: Setting| state.settings[setting as usize];
        let path = match setting(Setting::ReverseStraight) {
            Some(0) => there.and_then(|there| there.path),
            Some(_) => Some(Path::Linear),
            None => None,
        };
        let aim = match instr {
            Instr::MoveAlways { .. } => self.named(operands.word(0)).unwrap_or(Aim::NotKnown),
            Instr::MoveTurn { axis, frame, .. } | Instr::MoveTurnGuarded { axis, frame, .. } => {
                let start = self.worlds.joints(state.world);
                start.map_or(Aim::NotKnown, |start| turn(Some(start), (0.0, 0.0), axis, frame))
            }
            _ => self.worlds.joints(state.world).map_or(Aim::NotKnown, Aim::Joints),
        };
        Command {
            aim,
            path,
            tool: there.and_then(|there| there.tool),
            speed: speed(state, &[Setting::ReverseSpeed, Setting::Speed]),
            guard: guard_back(instr, operands, setting(Setting::ReverseForceLimit)),
        }
    }

    /// The motion that an instruction commands, if it is one; none within if it would trap.
    fn command(
        &mut self,
        state: &State,
        instr: Instr,
        operands: &Operands<'_>,
    ) -> Option<Option<Command>> {
        let mut guard = Guard::None;
        let or_not_known = |aim: Option<Aim>| aim.unwrap_or(Aim::NotKnown);
        let joints = |at: usize| match operands.word(at) {
            Some(word) => self.named(Some(word)),
            None => Some(Aim::NotKnown),
        };
        let displaced = |axis, frame| {
            let (axis, frame) = (convert::axis(axis), convert::frame(frame));
            let displaced = |distance_m| Aim::Displaced { distance_m, axis, frame };
            Some(or_not_known(operands.real(0).map(displaced)))
        };
        let turned = |axis, frame| {
            let by = operands.real(0).zip(operands.real(1));
            Some(or_not_known(by.map(|by| turn(None, by, axis, frame))))
        };
        let (aim, path) = match instr {
            Instr::MoveJoint { .. } => (joints(0), Path::Joint),
            Instr::MoveLinear { .. } => (joints(0), Path::Linear),
            Instr::MoveAlways { path, .. } => (joints(1), convert::path(path)),
            Instr::MoveItem { keyframe, path, .. } => {
                (self.keyframe(operands.word(0), keyframe), convert::path(path))
            }
            Instr::MoveRelative { axis, frame, .. } => (displaced(axis, frame), Path::Linear),
            Instr::MoveGuarded { axis, frame, .. }
            | Instr::MoveGuardedOpposite { axis, frame, .. } => {
                guard = Guard::Ends(operands.real(1));
                (displaced(axis, frame), Path::Linear)
            }
            Instr::MoveOffset { frame, .. } => {
                let all: Option<Vec<f64>> = (0..3).map(|at| operands.real(at)).collect();
                let by_m = all.and_then(|all| <[f64; 3]>::try_from(all).ok());
                let frame = convert::frame(frame);
                (Some(or_not_known(by_m.map(|by_m| Aim::Offset { by_m, frame }))), Path::Linear)
            }
            Instr::MoveTurn { axis, frame, .. } => (turned(axis, frame), Path::Linear),
            Instr::MoveTurnGuarded { axis, frame, .. } => {
                guard = Guard::Ends(operands.real(2));
                (turned(axis, frame), Path::Linear)
            }
            Instr::MoveSlot { slot, path } => {
                let position = state.frame().slots[slot.index()];
                (Some(or_not_known(position.map(Aim::Joints))), convert::path(path))
            }
            _ => return None,
        };
        let tool = state.settings[Setting::Tool as usize];
        let tool = tool.and_then(|tool| u16::try_from(tool).ok()).map(ToolId);
        let speed = speed(state, &[Setting::Speed]);
        Some(aim.map(|aim| Command { aim, path: Some(path), tool, speed, guard }))
    }

    /// The module's joint configuration of a number; none if there is none.
    fn named(&self, word: Word) -> Option<Aim> {
        let index = usize::try_from(word?).ok()?;
        let (_, joints) = self.values.module.joints.get(index)?;
        Some(Aim::Joints(JointConfiguration(*joints)))
    }

    /// A keyframe of an item; none if the item has no such keyframe, which is a trap.
    fn keyframe(&self, item: Word, keyframe: KeyframeId) -> Option<Aim> {
        let Some(item) = item else { return Some(Aim::NotKnown) };
        let item = self.values.module.items.get(usize::try_from(item).ok()?)?;
        let keyframe = item.keyframes.iter().find(|candidate| candidate.name == keyframe.0)?;
        let workcell = self.worlds.workcell();
        let nominal = workcell.nominal_pose(workcell.item(&item.name)?)?;
        let offset = Pose::from_rotation_vector(keyframe.position_m, keyframe.rotation_rad);
        Some(Aim::Pose(nominal.compose(&offset)))
    }
}

/// A turn by an angle in radians and a length in metres, from where the arm stands or elsewhere.
fn turn(
    from: Option<JointConfiguration>,
    (angle_rad, advance_m): (f64, f64),
    axis: Axis,
    frame: Frame,
) -> Aim {
    let (axis, frame) = (convert::axis(axis), convert::frame(frame));
    Aim::Turned { from, angle_rad, advance_m, axis, frame }
}

/// The speed that holds: the first of these settings that names one, and else the normal one.
fn speed(state: &State, settings: &[Setting]) -> Option<Speed> {
    for &setting in settings {
        let named = state.settings[setting as usize]?;
        if named != SpeedId::Unnamed as u64 {
            return Speed::ALL.get(usize::try_from(named).ok()?).copied();
        }
    }
    Some(Speed::Normal)
}

/// What stops a motion that goes back: the less of its own limit and that of the setting.
fn guard_back(instr: Instr, operands: &Operands<'_>, setting: Word) -> Guard {
    let set = setting.map(f64::from_bits);
    match instr {
        Instr::MoveGuardedOpposite { .. } => {
            Guard::Faults(operands.real(1).zip(set).map(|(own, set)| own.min(set)))
        }
        _ if set == Some(f64::INFINITY) => Guard::None,
        _ => Guard::Faults(set),
    }
}
