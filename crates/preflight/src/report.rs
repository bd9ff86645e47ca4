//! The check as a whole: from a program and a cell to a grade for every move.

use crate::explore::{Course, Explorer};
use crate::notes::Graded;
use crate::reason::{Grade, Reason};
use crate::state::{Frame, State};
use crate::value::Values;
use crate::verdict::Verdict;
use crate::worlds::Worlds;
use obverse_bytecode::{Module, Verified};
use obverse_isa::{Family, Setting};
use obverse_sim::Plan;
use obverse_vm::{Calculator, Direction, LinkError, Links};
use obverse_workcell::Items;

/// What was found out about a program in a workcell.
#[derive(Clone, Debug)]
pub struct Report {
    /// Every move, in the order of the code.
    pub moves: Vec<MoveReport>,
    /// Whether all ways were followed, round by round where it matters; if not, nothing may be
    /// concluded from moves that look fine.
    pub is_complete: bool,
}

/// What was found out about a move.
#[derive(Clone, Debug)]
pub struct MoveReport {
    /// The instruction.
    pub pc: u32,
    /// Going forward, if any way leads there.
    pub forward: Option<Graded>,
    /// Going in reverse, if any way leads back over it. What replaces a block in reverse is run in
    /// reverse alone.
    pub reverse: Option<Graded>,
    /// What is said of it if neither is there.
    pub unseen: Reason,
}

impl MoveReport {
    /// The worse of both directions.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let both = [&self.forward, &self.reverse];
        // Of two that are as bad, forward is told.
        let worst = both.into_iter().flatten().rev().max_by_key(|graded| graded.verdict.grade());
        worst.map_or_else(|| Verdict::new(self.unseen), |graded| graded.verdict.clone())
    }
}

impl Report {
    /// How many moves have a grade.
    #[must_use]
    pub fn count(&self, grade: Grade) -> usize {
        self.moves.iter().filter(|found| found.verdict().grade() == grade).count()
    }

    /// Whether every way was followed and no move leads to a fault. With `strict`, whether nothing
    /// is left to be seen either.
    #[must_use]
    pub fn is_fine(&self, strict: bool) -> bool {
        let worst = if strict { Grade::Reachable } else { Grade::NotKnown };
        self.is_complete && self.moves.iter().all(|found| found.verdict().grade() <= worst)
    }
}

/// Grade every move of a program that begins in a cell as it is planned to be then.
///
/// The time is bounded, whatever the program: with too many ways or too many motions the check is
/// given up, and the report says that it is not complete.
///
/// # Errors
/// All that the program needs and the cell lacks.
pub fn check(program: &Verified, plan: Plan) -> Result<Report, Vec<LinkError>> {
    let module = program.module();
    Links::new(module, plan.workcell())?;
    let tools = module.tools.iter().filter_map(|tool| plan.workcell().tool(tool));
    let values = Values {
        module,
        tools: tools.map(|tool| u64::from(tool.0)).collect(),
        calculator: Calculator::default(),
    };
    let initial_tool = plan.workcell().initial_tool();
    let (mut explorer, begin) = Explorer::new(values, Worlds::new(plan));
    let mut settings = std::array::from_fn(|at| Some(Setting::ALL[at].initial()));
    settings[Setting::Tool as usize] = Some(u64::from(initial_tool.0));
    let start = State {
        pc: 1,
        frames: vec![Frame::new(0, &module.functions[0], 0)],
        globals: vec![Some(0); module.globals.len()],
        settings,
        raised: Some(Vec::new()),
        world: explorer.worlds.start(),
        distance: Some(0),
        peak_force: Some(0),
        duration: Some(0),
        is_planned: true,
        is_certain: true,
        since: None,
        blocks: Vec::new(),
        forks: Vec::new(),
        last: begin,
    };
    explorer.follow(start, Course::Forward);
    let went_back = explorer.go_back();
    let is_followed = went_back && !explorer.is_given_up();
    // Of a move that nobody came to in a check that was given up, nothing can be said.
    let unseen = if is_followed { Reason::NoWay } else { Reason::TooMany };
    let is_complete = is_followed && !explorer.notes.lacks_rounds();
    Ok(Report { moves: moves(module, &explorer, unseen), is_complete })
}

fn moves(module: &Module, explorer: &Explorer<'_>, unseen: Reason) -> Vec<MoveReport> {
    let is_move = |pc: &u32| module.code[*pc as usize].info().family == Family::Kinematic;
    let report = |pc| MoveReport {
        pc,
        forward: explorer.notes.of(pc, Direction::Forward),
        reverse: explorer.notes.of(pc, Direction::Reverse),
        unseen,
    };
    (0..module.code.len() as u32).filter(is_move).map(report).collect()
}
