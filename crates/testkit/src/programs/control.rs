//! Blocks: branches, loops, scopes, and the ways out of them. Every block can be left by its end,
//! so that assertions have two ways to tell apart.

use super::scope::Type;
use super::{Generator, MAX_COST};
use arbitrary::Result;

/// How deep blocks may be in one another.
const MAX_NESTING: usize = 5;

/// How often a loop goes round at the most.
const MAX_ROUNDS: usize = 4;

impl Generator<'_, '_> {
    /// The statements of a block, in a scope of their own.
    pub(super) fn block(&mut self, most: usize) -> Result<()> {
        let mark = self.mark();
        self.frame.nesting += 1;
        self.statements(most)?;
        self.frame.nesting -= 1;
        self.forget(mark);
        Ok(())
    }

    /// A statement with a block.
    pub(super) fn control(&mut self) -> Result<()> {
        if self.frame.nesting >= MAX_NESTING {
            return self.motion();
        }
        match self.below(if self.has_forks { 18 } else { 15 })? {
            15..=17 => self.fork(),
            0..=2 => self.branch(),
            3 => self.chain(),
            4 => self.asserted_branch(),
            5 => self.while_loop(),
            6 => self.asserted_while(),
            7 => self.for_loop(),
            8 => self.endless(),
            9 => self.scoped(),
            10 => self.way_out(),
            11 | 14 => self.throw(),
            12 if self.may_be_irreversible() => self.irreversible(),
            13 if self.options.allow_overrides => self.reversed(),
            _ => self.branch(),
        }
    }

    fn branch(&mut self) -> Result<()> {
        let condition = self.expression(Type::Bool)?;
        let knows_position = self.frame.knows_position;
        self.open(&format!("if {condition}"));
        self.block(4)?;
        if self.one_in(2)? {
            self.close(" else {");
            self.depth += 1;
            self.frame.knows_position = knows_position;
            self.block(4)?;
        }
        self.close("");
        self.frame.knows_position = false;
        Ok(())
    }

    /// `if … else if … else …`
    fn chain(&mut self) -> Result<()> {
        let first = self.expression(Type::Bool)?;
        let second = self.expression(Type::Bool)?;
        self.frame.knows_position = false;
        self.open(&format!("if {first}"));
        self.block(3)?;
        self.close(&format!(" else if {second} {{"));
        self.depth += 1;
        self.frame.knows_position = false;
        self.block(3)?;
        self.close(" else {");
        self.depth += 1;
        self.frame.knows_position = false;
        self.block(3)?;
        self.close("");
        self.frame.knows_position = false;
        Ok(())
    }

    /// A branch whose join is asserted, by a variable that nothing else sets.
    fn asserted_branch(&mut self) -> Result<()> {
        let condition = self.expression(Type::Bool)?;
        let flag = self.name("flag");
        let is_set_before = self.one_in(2)?;
        let first = if is_set_before { condition.clone() } else { "false".to_owned() };
        self.line(&format!("var {flag} = {first}"));
        let tested = if is_set_before { flag.clone() } else { condition };
        self.declare(&flag, Type::Bool, false);
        let is_wrong = self.traps()?;
        self.frame.knows_position = false;
        self.open(&format!("if {tested}"));
        self.block(3)?;
        if !is_set_before {
            self.line(&format!("{flag} = true"));
        }
        if is_set_before || self.one_in(2)? {
            self.close(" else {");
            self.depth += 1;
            self.frame.knows_position = false;
            self.block(3)?;
        }
        let assertion = match is_wrong {
            true => self.inner_expression(Type::Bool)?,
            false => flag,
        };
        self.close(&format!(" ending when {assertion}"));
        self.frame.knows_position = false;
        Ok(())
    }

    /// Whether a loop of so many rounds may stand here.
    fn affords(&self, rounds: usize) -> bool {
        self.frame.cost + self.frame.times * rounds as u64 * 10 <= MAX_COST
    }

    /// The body of a loop that goes round so often.
    fn body(&mut self, rounds: usize) -> Result<()> {
        let outer = self.enter_loop(rounds);
        self.block(4)?;
        self.leave_loop(outer);
        Ok(())
    }

    fn enter_loop(&mut self, rounds: usize) -> (u64, bool) {
        let outer = (self.frame.times, self.frame.in_loop);
        self.frame.times *= rounds.max(1) as u64;
        self.frame.cost += 2 * self.frame.times;
        self.frame.in_loop = true;
        self.frame.knows_position = false;
        outer
    }

    fn leave_loop(&mut self, (times, in_loop): (u64, bool)) {
        self.frame.times = times;
        self.frame.in_loop = in_loop;
        self.frame.knows_position = false;
    }

    /// A variable that counts rounds and that nothing else sets.
    fn counter(&mut self) -> String {
        let counter = self.name("k");
        self.line(&format!("var {counter} = 0"));
        self.declare(&counter, Type::Int, false);
        counter
    }

    fn while_loop(&mut self) -> Result<()> {
        let rounds = self.below(MAX_ROUNDS + 1)?;
        if !self.affords(rounds) {
            return self.branch();
        }
        let counter = self.counter();
        let mut condition = format!("{counter} < {rounds}");
        if self.one_in(3)? {
            condition = format!("{condition} and {}", self.expression(Type::Bool)?);
        }
        self.open(&format!("while {condition}"));
        let counts_first = self.one_in(2)?;
        if counts_first {
            self.line(&format!("{counter} += 1"));
        }
        self.body(rounds)?;
        if !counts_first {
            self.line(&format!("{counter} += 1"));
        }
        self.close("");
        Ok(())
    }

    fn asserted_while(&mut self) -> Result<()> {
        let rounds = self.below(MAX_ROUNDS + 1)?;
        if !self.affords(rounds) {
            return self.asserted_branch();
        }
        let counter = self.counter();
        let assertion = match self.traps()? {
            true => self.inner_expression(Type::Bool)?,
            false => format!("{counter} == 0"),
        };
        self.open(&format!("while {counter} != {rounds} entered when {assertion}"));
        self.body(rounds)?;
        self.line(&format!("{counter} += 1"));
        self.close("");
        Ok(())
    }

    fn for_loop(&mut self) -> Result<()> {
        if !self.affords(MAX_ROUNDS) {
            return self.branch();
        }
        let rounds = self.below(MAX_ROUNDS)? + 1;
        let mark = self.mark();
        match self.below(4)? {
            0 => {
                let times = self.expression(Type::Int)?;
                self.open(&format!("repeat min({times}, {rounds}) times"));
            }
            1 => {
                // A loop that ends at the largest integer, or the smallest, ends there.
                let counter = self.name("i");
                let (first, last) = (i64::MAX - (rounds as i64 - 1), i64::MAX);
                let head = match self.one_in(2)? {
                    true => format!("for {counter} from -{first} - 1 down to -{last} - 1"),
                    false => format!("for {counter} from {first} to {last}"),
                };
                self.open(&head);
                self.declare(&counter, Type::Int, false);
            }
            _ => {
                let counter = self.name("i");
                let (first, last) = (self.expression(Type::Int)?, self.expression(Type::Int)?);
                let (least, most) = (format!("max({first}, 1)"), format!("min({last}, {rounds})"));
                let head = match self.one_in(2)? {
                    true => format!("for {counter} from {most} down to {least}"),
                    false => format!("for {counter} from {least} to {most}"),
                };
                self.open(&head);
                self.declare(&counter, Type::Int, false);
            }
        }
        self.body(rounds)?;
        self.close("");
        self.forget(mark);
        Ok(())
    }

    fn endless(&mut self) -> Result<()> {
        let rounds = self.below(MAX_ROUNDS)? + 1;
        if !self.affords(rounds) {
            return self.branch();
        }
        let counter = self.counter();
        self.open("loop");
        let mark = self.mark();
        let outer = self.enter_loop(rounds);
        self.block(2)?;
        self.open(&format!("if {counter} >= {rounds}"));
        self.frame.in_loop = false;
        self.block(2)?;
        self.line("break");
        self.close("");
        self.frame.in_loop = true;
        self.frame.knows_position = false;
        self.line(&format!("{counter} += 1"));
        self.block(2)?;
        self.leave_loop(outer);
        self.forget(mark);
        self.close("");
        Ok(())
    }

    /// A setting for a block.
    fn scoped(&mut self) -> Result<()> {
        if !self.has_arm() {
            return self.output();
        }
        let setting = match self.one_in(2)? {
            true => self.setting_in_reverse()?,
            false => self.setting()?,
        };
        self.open(&setting);
        self.block(4)?;
        self.close("");
        Ok(())
    }

    /// `if … { … break }`, `if … { … return }`
    fn way_out(&mut self) -> Result<()> {
        if self.frame.in_reversed && !self.frame.in_loop {
            return self.branch();
        }
        let condition = self.expression(Type::Bool)?;
        self.open(&format!("if {condition}"));
        self.block(2)?;
        let leaves_loop = self.frame.in_loop && (self.frame.in_reversed || self.one_in(2)?);
        self.line(if leaves_loop { "break" } else { "return" });
        self.close("");
        self.frame.knows_position = false;
        Ok(())
    }

    /// `if … { … throw e }`, `requires … else throw e`
    fn throw(&mut self) -> Result<()> {
        let may_raise = !self.frame.is_replacement && self.frame.claim.is_none();
        if self.errors.is_empty() || !may_raise {
            return self.branch();
        }
        let condition = self.expression(Type::Bool)?;
        let error = self.choose(&self.errors.clone())?;
        match self.one_in(3)? {
            true => self.line(&format!("requires {condition} else throw {error}")),
            false => {
                self.open(&format!("if {condition}"));
                self.block(2)?;
                self.line(&format!("throw {error}"));
                self.close("");
            }
        }
        self.frame.knows_position = false;
        Ok(())
    }

    fn irreversible(&mut self) -> Result<()> {
        self.frame.has_barrier = true;
        self.open("irreversible \"it is welded\"");
        self.block(3)?;
        self.close("");
        Ok(())
    }

    /// `with speed slow, straight moves in reverse`
    fn setting_in_reverse(&mut self) -> Result<String> {
        let mut parameters = Vec::new();
        let first = self.below(3)?;
        for choice in first..=first + self.below(3)? {
            parameters.push(match choice % 3 {
                0 => self.speed()?,
                1 => "straight moves".to_owned(),
                _ => format!("force limit max({}, 1 N)", self.expression(Type::Force)?),
            });
        }
        Ok(format!("with {} in reverse", parameters.join(", ")))
    }

    /// A block that is skipped, replaced or kept in reverse.
    fn reversed(&mut self) -> Result<()> {
        let outer = (self.frame.in_reversed, self.frame.in_loop, self.frame.is_replacement);
        let (word, is_replaced, is_kept) = self.choose(&[
            ("skip in reverse", false, false),
            ("do", true, false),
            ("keep in reverse", false, true),
        ])?;
        self.open(word);
        (self.frame.in_reversed, self.frame.in_loop) = (true, false);
        // A kept block is run in reverse too, and may fail as little as one that replaces another;
        // a position that is remembered before it stays.
        self.frame.is_replacement |= is_kept;
        let positions = self.frame.kept_positions;
        if is_kept {
            self.frame.knows_position = false;
            self.frame.kept_positions = self.frame.positions.len();
        }
        self.block(3)?;
        self.frame.kept_positions = positions;
        (self.frame.in_reversed, self.frame.in_loop, self.frame.is_replacement) = outer;
        if is_replaced {
            self.close(" in reverse {");
            self.depth += 1;
            let replacement = self.frame.in_reverse();
            let around = std::mem::replace(&mut self.frame, replacement);
            self.block(3)?;
            self.frame = around;
        }
        self.close("");
        self.frame.knows_position = false;
        Ok(())
    }
}
