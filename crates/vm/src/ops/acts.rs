//! What an effect outside the hot loops may touch: operands, the frame, settings, the workcell.
//! It sees neither the tape nor the program counter.

use crate::alter::Alteration;
use crate::class::Failure;
use crate::link::Links;
use crate::stop::TrapKind;
use crate::values::Settings;
use obverse_bytecode::Module;
use obverse_geometry::JointConfiguration;
use obverse_isa::{ErrorId, LocalId, Setting, SlotId, SpeedId};
use obverse_workcell::{Fault, Motion, MotionReport, Speed, ToolId, Watch, Workcell};

pub(crate) struct Acts<'a> {
    pub(crate) operands: &'a [u64],
    pub(crate) slots: &'a mut [u64],
    pub(crate) positions: &'a mut [JointConfiguration],
    pub(crate) settings: &'a mut Settings,
    pub(crate) raised: &'a mut Vec<ErrorId>,
    pub(crate) draws: &'a mut u64,
    pub(crate) module: &'a Module,
    pub(crate) links: &'a Links,
    pub(crate) cell: &'a mut dyn Workcell,
    /// See [`Pending::level_before`](crate::state::Pending::level_before).
    pub(crate) level_before: Option<bool>,
    /// The instruction.
    pub(crate) pc: u32,
    /// What is done otherwise than the program says.
    pub(crate) alteration: Option<&'a Alteration>,
    /// Going back, where the motion began if it was made aside.
    pub(crate) aside: Option<JointConfiguration>,
    /// Whether others go on while the task of a fork waits.
    pub(crate) may_rest: bool,
    /// What came of it so far.
    pub(crate) done: Done,
}

/// What came of an effect.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Done {
    /// The report of the motion that it made.
    pub(crate) report: Option<MotionReport>,
    /// Where the motion began that it made aside of where the program says.
    pub(crate) aside: Option<JointConfiguration>,
    /// What came to hold meanwhile that is to be told when it is done, and where.
    pub(crate) noticed: Option<(Watch, f64)>,
    /// How long it had the workcell wait, in seconds.
    pub(crate) waited_s: f64,
    /// How long its task is still to wait while others go on, in seconds.
    pub(crate) rest_s: f64,
}

impl Acts<'_> {
    /// The operand at a place of the stack picture.
    pub(crate) fn operand(&self, at: usize) -> u64 {
        self.operands[at]
    }

    /// The real at a place of the stack picture.
    pub(crate) fn real(&self, at: usize) -> f64 {
        f64::from_bits(self.operands[at])
    }

    /// The time in seconds at a place of the stack picture.
    ///
    /// # Errors
    /// If it is none; asked for before anything is commanded.
    pub(crate) fn duration_s(&self, at: usize) -> Result<f64, TrapKind> {
        let duration_s = self.real(at);
        let is_one = duration_s >= 0.0 && duration_s.is_finite();
        if is_one { Ok(duration_s) } else { Err(TrapKind::NotADuration) }
    }

    /// Wait, or leave it to the task while others go on.
    ///
    /// # Errors
    /// A fault of the workcell.
    pub(crate) fn rest(&mut self, duration_s: f64) -> Result<(), Failure> {
        if self.may_rest {
            self.done.rest_s = duration_s;
            return Ok(());
        }
        self.wait(duration_s)
    }

    /// Wait, whoever waits with it.
    ///
    /// # Errors
    /// A fault of the workcell.
    pub(crate) fn wait(&mut self, duration_s: f64) -> Result<(), Failure> {
        let waited = self.cell.wait(duration_s);
        self.noting(waited)?;
        self.done.waited_s += duration_s;
        Ok(())
    }

    /// Have the arm move.
    ///
    /// # Errors
    /// A fault of the workcell.
    pub(crate) fn execute(&mut self, motion: &Motion) -> Result<MotionReport, Failure> {
        let executed = self.cell.execute(motion).map(|_| ());
        self.noting(executed)?;
        Ok(self.cell.last_motion())
    }

    /// What has come to hold and stopped nothing is told when the act is done.
    ///
    /// # Errors
    /// Any other fault.
    pub(crate) fn noting(&mut self, acted: Result<(), Fault>) -> Result<(), Failure> {
        match acted {
            Err(Fault::Watched { watch, fraction }) if !watch.stops => {
                self.done.noticed.get_or_insert((watch, fraction));
                Ok(())
            }
            acted => Ok(acted?),
        }
    }

    /// The module's joint configuration at a place of the stack picture.
    ///
    /// # Errors
    /// If there is none: a value from a tape that was tampered with.
    pub(crate) fn joints(&self, at: usize) -> Result<JointConfiguration, TrapKind> {
        let joints = self.module.joints.get(self.operands[at] as usize);
        joints.map(|(_, values)| JointConfiguration(*values)).ok_or(TrapKind::Foreign)
    }

    pub(crate) fn local(&mut self, local: LocalId) -> &mut u64 {
        &mut self.slots[local.index()]
    }

    pub(crate) fn position(&mut self, slot: SlotId) -> &mut JointConfiguration {
        &mut self.positions[slot.index()]
    }

    /// The speed that holds.
    ///
    /// # Errors
    /// If there is none: a value from a tape that was tampered with.
    pub(crate) fn speed(&self) -> Result<Speed, TrapKind> {
        Ok(self.named_speed(Setting::Speed)?.unwrap_or(Speed::Normal))
    }

    /// The speed that holds for a motion that goes back.
    ///
    /// # Errors
    /// As for [`speed`](Self::speed).
    pub(crate) fn reverse_speed(&self) -> Result<Speed, TrapKind> {
        match self.named_speed(Setting::ReverseSpeed)? {
            Some(speed) => Ok(speed),
            None => self.speed(),
        }
    }

    fn named_speed(&self, setting: Setting) -> Result<Option<Speed>, TrapKind> {
        let speed = self.settings[setting as usize];
        if speed == SpeedId::Unnamed as u64 {
            return Ok(None);
        }
        Speed::ALL.get(speed as usize).copied().map(Some).ok_or(TrapKind::Foreign)
    }

    /// The force in newtons that stops a motion that goes back, if one does.
    pub(crate) fn reverse_force_limit_n(&self) -> Option<f64> {
        let limit_n = f64::from_bits(self.settings[Setting::ReverseForceLimit as usize]);
        (limit_n != f64::INFINITY).then_some(limit_n)
    }

    /// Whether motions go back on a straight line whatever way they came.
    pub(crate) fn goes_back_straight(&self) -> bool {
        self.settings[Setting::ReverseStraight as usize] != 0
    }

    /// The tool that holds.
    pub(crate) fn tool(&self) -> ToolId {
        ToolId(self.settings[Setting::Tool as usize] as u16)
    }
}
