//! Blocks, branches and loops, and the ways out of them.

use super::error::Site;
use super::statement::speed;
use super::value::Value;
use super::{Counter, Interpreter, Run, Trap};
use obverse_syntax::ast::{
    Block, Expression, Primitive, ReverseParameter, Statement, StatementKind,
};

/// Where the program goes on after a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flow {
    /// At the next one.
    Next,
    /// Behind the innermost loop.
    Break,
    /// Behind the call of the sequence.
    Return,
    /// At the beginning of the sequence.
    Again,
    /// Nowhere: all sequences are left, with an error pending.
    Leave,
}

impl<'p> Interpreter<'p, '_> {
    /// The body of a sequence, or of the cleanup, as often as its errors want it again.
    pub(super) fn body(&mut self, body: &'p Block<'p>) -> Run<Flow> {
        let settings = (self.speed, self.tool);
        loop {
            let flow = self.block(body)?;
            if flow != Flow::Again {
                return Ok(flow);
            }
            self.step()?;
            (self.speed, self.tool) = settings;
            self.frame_mut().counters.clear();
        }
    }

    /// Statements in a row.
    pub(super) fn block(&mut self, block: &'p Block<'p>) -> Run<Flow> {
        // What is allowed does nothing.
        let statements: Vec<&'p Statement<'p>> =
            block.statements.iter().filter(|statement| statement.allow().is_none()).collect();
        for (index, &statement) in statements.iter().enumerate() {
            let flow = match &statement.kind {
                StatementKind::Primitive(primitive) => {
                    let (before, after) = (&statements[..index], &statements[index + 1..]);
                    let before = before.iter().copied().rev().map_while(as_primitive);
                    let after = after.iter().copied().map_while(as_primitive);
                    self.primitive(primitive, before, after)?;
                    Flow::Next
                }
                _ => {
                    self.step()?;
                    self.remember_state(statement.span);
                    self.statement(statement)?
                }
            };
            if flow != Flow::Next {
                return Ok(flow);
            }
        }
        Ok(Flow::Next)
    }

    fn statement(&mut self, statement: &'p Statement<'p>) -> Run<Flow> {
        match &statement.kind {
            StatementKind::If { condition, then, otherwise, ending_when } => {
                self.branch(condition, (then, otherwise.as_ref()), ending_when.as_ref())
            }
            StatementKind::While { condition, entered_when, body } => {
                self.while_loop(condition, entered_when.as_ref(), body)
            }
            StatementKind::Repeat { times, body } => {
                let times = self.value(times)?.int();
                self.counted(None, 1..=times, |count| count, body)
            }
            StatementKind::For { name, first, down, last, body } => {
                let [first, last] = self.values([first, last])?;
                let (first, last) = (first.int(), last.int());
                match down {
                    false => self.counted(Some(name.value), first..=last, |count| count, body),
                    true => {
                        let counts = (last..=first).rev();
                        self.counted(Some(name.value), counts, |count| !count, body)
                    }
                }
            }
            StatementKind::Loop(body) => self.endless(body),
            StatementKind::Fork(branches) => self.one_after_another(branches),
            StatementKind::Break => Ok(Flow::Break),
            StatementKind::Return => Ok(Flow::Return),
            StatementKind::WaitUntil { input, high, timeout, otherwise } => {
                let line = (self.names.line(input.value), *high);
                match self.wait_until(line, timeout, otherwise.as_ref())? {
                    Some(otherwise) => self.block(otherwise),
                    None => Ok(Flow::Next),
                }
            }
            StatementKind::Speed { block, .. } | StatementKind::Tool { block, .. } => {
                self.setting(&statement.kind, block.as_ref())
            }
            StatementKind::WithInReverse { parameters, block } => {
                let before = self.going_back;
                for parameter in parameters {
                    self.reverse_parameter(&parameter.value)?;
                }
                let flow = self.block(block)?;
                self.going_back = before;
                Ok(flow)
            }
            // Going forward, the blocks of reversal are blocks.
            StatementKind::Irreversible { block, .. }
            | StatementKind::SkipInReverse(block)
            | StatementKind::KeepInReverse(block)
            | StatementKind::ReplaceInReverse { block, .. } => self.block(block),
            StatementKind::Advance(_)
            | StatementKind::Call { .. }
            | StatementKind::Throw(_)
            | StatementKind::Requires { .. } => self.fallible(statement),
            _ => {
                self.simple(statement)?;
                Ok(Flow::Next)
            }
        }
    }

    /// A statement that may leave errors to be responded to, as often as they want it again.
    fn fallible(&mut self, statement: &'p Statement<'p>) -> Run<Flow> {
        let mut site = Site::default();
        loop {
            let flow = match &statement.kind {
                StatementKind::Advance(name) => {
                    self.advance(name.value)?;
                    self.respond_after_move(name.value, &mut site)?
                }
                StatementKind::Call { name, arguments } => {
                    let arguments = self.bound(name.value, arguments)?;
                    self.call_and_respond(name.value, &arguments, &mut site)?
                }
                StatementKind::Throw(name) => {
                    self.raise(name.value);
                    self.respond_to_throw(name.value, &mut site)?
                }
                StatementKind::Requires { condition, error } => {
                    if self.value(condition)?.holds() {
                        return Ok(Flow::Next);
                    }
                    self.raise(error.value);
                    self.respond_to_throw(error.value, &mut site)?
                }
                _ => return Ok(Flow::Next),
            };
            match flow {
                Some(flow) => return Ok(flow),
                None => self.step()?,
            }
        }
    }

    fn branch(
        &mut self,
        condition: &'p Expression<'p>,
        (then, otherwise): (&'p Block<'p>, Option<&'p Block<'p>>),
        ending_when: Option<&'p Expression<'p>>,
    ) -> Run<Flow> {
        let condition = self.value(condition)?.holds();
        let flow = match (condition, otherwise) {
            (true, _) => self.block(then)?,
            (false, Some(otherwise)) => self.block(otherwise)?,
            (false, None) => Flow::Next,
        };
        if flow == Flow::Next {
            self.assert(ending_when, condition)?;
        }
        Ok(flow)
    }

    /// An assertion must be as it should; one that is not written is.
    fn assert(&mut self, assertion: Option<&'p Expression<'p>>, should: bool) -> Run<()> {
        match assertion {
            Some(assertion) if self.value(assertion)? != Value::Bool(should) => {
                Err(Trap::Assertion.into())
            }
            _ => Ok(()),
        }
    }

    fn while_loop(
        &mut self,
        condition: &'p Expression<'p>,
        entered_when: Option<&'p Expression<'p>>,
        body: &'p Block<'p>,
    ) -> Run<Flow> {
        self.assert(entered_when, true)?;
        while self.value(condition)?.holds() {
            self.step()?;
            match self.block(body)? {
                Flow::Next => self.assert(entered_when, false)?,
                Flow::Break => break,
                flow => return Ok(flow),
            }
        }
        Ok(Flow::Next)
    }

    /// A loop over numbers, of which a machine keeps others.
    fn counted(
        &mut self,
        name: Option<&'p str>,
        counts: impl Iterator<Item = i64>,
        kept: impl Fn(i64) -> i64,
        body: &'p Block<'p>,
    ) -> Run<Flow> {
        for count in counts {
            self.step()?;
            self.frame_mut().counters.push(Counter { name, count, kept: kept(count) });
            let flow = self.block(body)?;
            self.frame_mut().counters.pop();
            match flow {
                Flow::Next => {}
                Flow::Break => break,
                flow => return Ok(flow),
            }
        }
        Ok(Flow::Next)
    }

    /// Branches are independent of one another, so that their order is open.
    fn one_after_another(&mut self, branches: &'p [Block<'p>]) -> Run<Flow> {
        for branch in branches {
            let flow = self.block(branch)?;
            if flow != Flow::Next {
                return Ok(flow);
            }
        }
        Ok(Flow::Next)
    }

    fn endless(&mut self, body: &'p Block<'p>) -> Run<Flow> {
        loop {
            self.step()?;
            match self.block(body)? {
                Flow::Next => {}
                Flow::Break => return Ok(Flow::Next),
                flow => return Ok(flow),
            }
        }
    }

    fn reverse_parameter(&mut self, parameter: &'p ReverseParameter<'p>) -> Run<()> {
        match parameter {
            ReverseParameter::Speed(word) => self.going_back.speed = Some(speed(*word)),
            ReverseParameter::ForceLimit(limit) => {
                self.going_back.limit_n = self.value(limit)?.real();
            }
            ReverseParameter::StraightMoves => self.going_back.is_straight = true,
        }
        Ok(())
    }

    /// A setting for a block, or else to the end of the call.
    fn setting(&mut self, kind: &'p StatementKind<'p>, block: Option<&'p Block<'p>>) -> Run<Flow> {
        let (speed_before, tool_before) = (self.speed, self.tool);
        let is_speed = match kind {
            StatementKind::Speed { speed: word, .. } => {
                self.speed = speed(word.value);
                true
            }
            StatementKind::Tool { name, .. } => {
                self.tool = self.tool_number(name.value);
                false
            }
            _ => return Ok(Flow::Next),
        };
        let Some(block) = block else { return Ok(Flow::Next) };
        let flow = self.block(block)?;
        match is_speed {
            true => self.speed = speed_before,
            false => self.tool = tool_before,
        }
        Ok(flow)
    }
}

fn as_primitive<'a, 'p>(statement: &'a Statement<'p>) -> Option<&'a Primitive<'p>> {
    match &statement.kind {
        StatementKind::Primitive(primitive) => Some(primitive),
        _ => None,
    }
}
