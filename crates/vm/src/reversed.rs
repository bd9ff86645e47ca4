//! The code as a run in reverse meets it: a table that is made when a program is loaded, with what
//! undoes each effect and where the next one is. Knows no state and no tape.

use crate::update::{Undo, Updates};
use obverse_isa::{Family, Instr};

/// How many statements that have nothing to do in reverse are passed over at once.
const MAX_PASSED: usize = 8;

/// Where a run in reverse goes on when a statement has been undone: at which instruction, and
/// how many steps earlier.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WayBack {
    next: u32,
    steps: u32,
}

impl WayBack {
    /// Before the first instruction, where the index is none of the code's.
    const START: Self = Self { next: u32::MAX, steps: 0 };

    /// The instruction to be undone next.
    #[inline(always)]
    pub(crate) fn next(self) -> u32 {
        self.next
    }

    #[inline(always)]
    pub(crate) fn steps(self) -> i64 {
        i64::from(self.steps)
    }

    /// From behind an effect to before its statement.
    fn beside(code: &[Instr], effect: usize) -> Option<Self> {
        let prefix = usize::from(code.get(effect)?.prefix());
        let start = u32::try_from(effect.checked_sub(prefix)?).ok()?;
        Some(Self { next: start.wrapping_sub(1), steps: prefix as u32 + 1 })
    }

    /// From behind a join to before the statement of its jump.
    fn by_jump(code: &[Instr], join: usize) -> Option<Self> {
        Self::beside(code, code[join].join_from()?.index())
    }

    fn from(code: &[Instr], effect: usize, by_jump: bool) -> Option<Self> {
        if by_jump { Self::by_jump(code, effect) } else { Self::beside(code, effect) }
    }

    /// Over one more statement, if it has nothing to do in reverse.
    fn further(self, code: &[Instr]) -> Option<Self> {
        let at = self.next as usize;
        let way = match *code.get(at)? {
            Instr::Land { .. } => Self::by_jump(code, at)?,
            instr if is_plain_jump(instr) => Self::beside(code, at)?,
            _ => return None,
        };
        Some(Self { next: way.next, steps: self.steps.checked_add(way.steps)? })
    }

    fn each_further(self, code: &[Instr]) -> impl Iterator<Item = Self> {
        std::iter::successors(Some(self), |way| way.further(code)).take(MAX_PASSED)
    }
}

/// A jump that changes nothing but where the run is.
fn is_plain_jump(instr: Instr) -> bool {
    let is_loop = matches!(instr, Instr::ForEnter { .. } | Instr::ForNext { .. });
    instr.info().family == Family::Flow && instr.jump_target().is_some() && !is_loop
}

/// An effect as a run in reverse meets it: what undoes its statement, and the ways on from there,
/// beside it and by the jump that it names. They pass over the statements that have nothing to do
/// in reverse: one load stands for a label, the prefix of a jump, and a dispatch for each statement
/// passed over.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Reversed {
    pub(crate) undo: Undo,
    pub(crate) beside: WayBack,
    pub(crate) jump: WayBack,
}

impl Reversed {
    /// A row that a single step can be made by: what undoes an effect is its instruction.
    pub(crate) fn by_instr(instr: Instr) -> Self {
        Self { undo: Undo::Instr(instr), beside: WayBack::START, jump: WayBack::START }
    }
}

/// The code as a run in reverse meets it.
pub(crate) fn reversed(code: &[Instr]) -> Vec<Reversed> {
    let whole = |at, by_jump| {
        let first = WayBack::from(code, at, by_jump);
        first.and_then(|way| way.each_further(code).last()).unwrap_or(WayBack::START)
    };
    let mut updates = Updates::default();
    let row = |at| Reversed {
        undo: updates.undo(code, at),
        beside: whole(at, false),
        jump: whole(at, true),
    };
    (0..code.len()).map(row).collect()
}

/// The way back that passes over no more than is needed to undo `steps`.
#[inline(never)]
#[cold]
pub(crate) fn nearest(code: &[Instr], effect: usize, by_jump: bool, steps: i64) -> WayBack {
    let mut ways =
        WayBack::from(code, effect, by_jump).into_iter().flat_map(|way| way.each_further(code));
    ways.find(|way| way.steps() >= steps).unwrap_or(WayBack::START)
}
