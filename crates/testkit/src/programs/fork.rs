//! Forks: who has what. Devices and variables are dealt out among the branches, or seen by all and
//! changed by none, so that the branches could as well run one after the other.

use super::Generator;
use super::scope::{Frame, Variable};
use arbitrary::Result;

/// The most branches of a fork.
const MAX_BRANCHES: usize = 4;

/// The devices that a branch has for itself.
#[derive(Clone, Debug)]
pub(super) struct Claim {
    has_arm: bool,
    has_dice: bool,
    outputs: Vec<usize>,
}

impl Claim {
    fn of_all() -> Self {
        Self { has_arm: true, has_dice: true, outputs: (0..8).collect() }
    }
}

impl Generator<'_, '_> {
    /// Whether the arm may be used here, with its settings and readings.
    pub(super) fn has_arm(&self) -> bool {
        self.frame.claim.as_ref().is_none_or(|claim| claim.has_arm)
    }

    /// Whether random numbers may be drawn here.
    pub(super) fn has_dice(&self) -> bool {
        self.frame.claim.as_ref().is_none_or(|claim| claim.has_dice)
    }

    /// An output that may be set here.
    pub(super) fn any_output(&mut self) -> Result<String> {
        match self.frame.claim.clone() {
            Some(claim) => Ok(self.choose(&claim.outputs)?.to_string()),
            None => self.signal(&self.outputs.clone()),
        }
    }

    /// `fork { … } and { … }`
    pub(super) fn fork(&mut self) -> Result<()> {
        let whole = self.frame.claim.clone().unwrap_or_else(Claim::of_all);
        let most = whole.outputs.iter().filter(|bit| **bit != 0).count().min(MAX_BRANCHES);
        if most < 2 {
            return self.output();
        }
        let count = self.below(most - 1)? + 2;
        let claims = self.deal_devices(&whole, count)?;
        let (globals, variables) = (self.globals.clone(), self.frame.variables.clone());
        let positions = self.frame.positions.clone();
        let owners = self.deal(globals.len() + variables.len(), count + 2)?;
        let outer = (self.frame.claim.take(), self.frame.in_reversed, self.frame.in_loop);
        let knows_position = self.frame.knows_position;
        (self.frame.in_reversed, self.frame.in_loop) = (true, false);
        self.open("fork");
        for (branch, claim) in claims.into_iter().enumerate() {
            if branch > 0 {
                self.close(" and {");
                self.depth += 1;
            }
            let (of_globals, of_frame) = owners.split_at(globals.len());
            self.globals = seen_by(branch, count, &globals, of_globals);
            self.frame.variables = seen_by(branch, count, &variables, of_frame);
            self.frame.positions = if claim.has_arm { positions.clone() } else { Vec::new() };
            self.frame.knows_position = knows_position;
            self.frame.claim = Some(claim);
            self.output()?;
            self.block(4)?;
        }
        self.close("");
        (self.globals, self.frame.variables) = (globals, variables);
        self.frame.positions = positions;
        (self.frame.claim, self.frame.in_reversed, self.frame.in_loop) = outer;
        self.frame.knows_position = false;
        Ok(())
    }

    /// So many numbers below a bound.
    fn deal(&mut self, count: usize, bound: usize) -> Result<Vec<usize>> {
        (0..count).map(|_| self.below(bound)).collect()
    }

    /// Each branch has an output at least; the one of the gripper goes with the arm.
    fn deal_devices(&mut self, whole: &Claim, count: usize) -> Result<Vec<Claim>> {
        let (arm, dice) = (self.below(count)?, self.below(count)?);
        let mut claims: Vec<Claim> = (0..count)
            .map(|branch| Claim {
                has_arm: whole.has_arm && branch == arm,
                has_dice: whole.has_dice && branch == dice,
                outputs: Vec::new(),
            })
            .collect();
        let others = whole.outputs.iter().filter(|bit| **bit != 0);
        for (turn, bit) in others.enumerate() {
            let owner = if turn < count { turn } else { self.below(count)? };
            claims[owner].outputs.push(*bit);
        }
        if whole.outputs.contains(&0) {
            claims[arm].outputs.push(0);
        }
        Ok(claims)
    }

    /// A call of a sequence that this branch alone calls, declared for it.
    pub(super) fn call_of_branch(&mut self) -> Result<()> {
        let name = self.name("f");
        let inner = Frame {
            claim: self.frame.claim.clone(),
            cost: self.frame.cost,
            times: self.frame.times,
            nesting: self.frame.nesting,
            ..Frame::new()
        };
        let frame = std::mem::replace(&mut self.frame, inner);
        let (text, depth) = (std::mem::take(&mut self.text), std::mem::take(&mut self.depth));
        self.open(&format!("action {name}"));
        self.output()?;
        self.block(4)?;
        self.close("");
        let declared = std::mem::replace(&mut self.text, text);
        self.of_branches.push(declared);
        self.depth = depth;
        let cost = self.frame.cost;
        self.frame = Frame { cost, knows_position: false, ..frame };
        self.line(&format!("call {name}"));
        Ok(())
    }
}

/// The variables that a branch sees: its own, and those that no branch owns, which it only reads.
fn seen_by(branch: usize, count: usize, all: &[Variable], owners: &[usize]) -> Vec<Variable> {
    let seen = all.iter().zip(owners).filter(|(_, owner)| **owner == branch || **owner >= count);
    seen.map(|(variable, owner)| Variable {
        is_free: variable.is_free && *owner == branch,
        ..variable.clone()
    })
    .collect()
}
