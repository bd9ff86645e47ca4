//! Statements that do one thing, and which statement comes next.

use super::scope::Type;
use super::{Callee, Generator, MAX_COST, Parameter};
use arbitrary::Result;

impl Generator<'_, '_> {
    /// So many statements at the most.
    pub(super) fn statements(&mut self, most: usize) -> Result<()> {
        for _ in 0..self.below(most + 1)? {
            if self.budget == 0 {
                break;
            }
            self.budget -= 1;
            self.frame.cost += self.frame.times;
            if self.one_in(16)? {
                self.line("allow W0002 \"it is made so\"");
            }
            self.statement()?;
        }
        Ok(())
    }

    fn statement(&mut self) -> Result<()> {
        match self.below(33)? {
            0..=3 => self.assign(),
            4..=6 => self.update(),
            7..=9 => self.variable(),
            10..=13 => self.motion(),
            14 => self.remember(),
            15 => self.output(),
            16 => self.io(),
            17 => self.wait(),
            18 => self.modal(),
            19 | 20 => self.call(),
            21 => self.advance(),
            22 => self.landmark(),
            _ => self.control(),
        }
    }

    /// `var x = …`
    pub(super) fn variable(&mut self) -> Result<()> {
        let of_type = self.choose(&Type::OF_VARIABLES)?;
        let name = self.name("v");
        let value = self.bounded(of_type)?;
        let declared = match of_type {
            Type::Number if self.one_in(3)? => {
                // An integer that is written out is a number where one is declared.
                self.line(&format!("var {name}: number = {}", self.names));
                self.declare(&name, of_type, true);
                return Ok(());
            }
            _ if self.one_in(3)? => format!(": {}", of_type.name()),
            _ => String::new(),
        };
        self.line(&format!("var {name}{declared} = {value}"));
        self.declare(&name, of_type, true);
        Ok(())
    }

    /// `x = …`
    fn assign(&mut self) -> Result<()> {
        let of_type = self.choose(&Type::OF_VARIABLES)?;
        let names = self.assignable(of_type);
        if names.is_empty() {
            return self.variable();
        }
        let name = self.choose(&names)?;
        let value = self.bounded(of_type)?;
        self.line(&format!("{name} = {value}"));
        Ok(())
    }

    /// `x += …`, `x -= …`, with and without the variable in the value.
    fn update(&mut self) -> Result<()> {
        let of_type = self.choose(&[Type::Int, Type::Int, Type::Number, Type::Length])?;
        let names = self.assignable(of_type);
        if names.is_empty() {
            return self.variable();
        }
        let name = self.choose(&names)?;
        let operator = self.choose(&["+=", "-="])?;
        let value = match (of_type, self.below(3)?) {
            (Type::Int, 0) => format!("({name} * 2 + {})", self.expression(Type::Int)?),
            (Type::Number, 0) => "2".to_owned(),
            _ => self.bounded(of_type)?,
        };
        self.line(&format!("{name} {operator} {value}"));
        Ok(())
    }

    fn io(&mut self) -> Result<()> {
        let has_all = self.frame.claim.is_none();
        if self.io.is_empty() || !has_all || self.frame.cost + self.frame.times * 6 > MAX_COST {
            return self.output();
        }
        self.frame.cost += self.frame.times * 6;
        let name = self.choose(&self.io.clone())?;
        self.line(&format!("io {name}"));
        Ok(())
    }

    fn wait(&mut self) -> Result<()> {
        let time = self.duration()?;
        if self.frame.nesting < 4 && self.one_in(2)? {
            let bit = self.signal(&self.inputs.clone())?;
            let level = self.choose(&["low", "high"])?;
            let wait = format!("wait until input {bit} {level} for up to {time}");
            if self.one_in(2)? {
                self.open(&format!("{wait} else"));
                self.block(3)?;
                self.close("");
                self.frame.knows_position = false;
                return Ok(());
            }
            self.line(&wait);
            return Ok(());
        }
        let word = self.choose(&["wait", "wait", "sleep"])?;
        self.line(&format!("{word} {time}"));
        Ok(())
    }

    /// A setting to the end of the sequence.
    fn modal(&mut self) -> Result<()> {
        if !self.has_arm() {
            return self.output();
        }
        let setting = self.setting()?;
        self.line(&setting);
        Ok(())
    }

    /// `call f(…)`
    fn call(&mut self) -> Result<()> {
        if self.frame.claim.is_some() {
            return self.call_of_branch();
        }
        let affordable: Vec<Callee> =
            self.callees.iter().filter(|f| self.may_call(f)).cloned().collect();
        if affordable.is_empty() {
            return self.motion();
        }
        let callee = self.choose(&affordable)?;
        self.frame.cost += self.frame.times * callee.cost;
        self.frame.has_barrier |= callee.has_barrier;
        let arguments = self.arguments(&callee)?;
        self.line(&format!("call {}({})", callee.name, arguments.join(", ")));
        self.frame.knows_position = false;
        Ok(())
    }

    fn may_call(&self, callee: &Callee) -> bool {
        let fits = self.frame.cost + self.frame.times * callee.cost <= MAX_COST;
        let may_fail = self.options.allow_errors && self.frame.is_replacement;
        let is_item = |parameter: &Parameter| parameter.of_type == Type::Item;
        let has_all = !callee.parameters.iter().any(is_item) || !self.items.is_empty();
        let is_allowed = !callee.has_barrier || !self.frame.in_reversed;
        fits && !may_fail && has_all && is_allowed
    }

    /// Some by their place, then some by name or not at all.
    fn arguments(&mut self, callee: &Callee) -> Result<Vec<String>> {
        let mut arguments = Vec::new();
        let mut are_named = false;
        for (index, parameter) in callee.parameters.iter().enumerate() {
            let is_bound = index == 0 && callee.is_recursive;
            are_named |= self.one_in(4)?;
            if parameter.has_default && self.one_in(2)? {
                are_named = true;
                continue;
            }
            let value = match (is_bound, parameter.of_type) {
                (true, _) => format!("min({}, 3)", self.expression(Type::Int)?),
                (false, Type::Number) if self.one_in(4)? => "3".to_owned(),
                _ => self.argument(parameter)?,
            };
            arguments.push(match are_named {
                true => format!("{}: {value}", parameter.name),
                false => value,
            });
        }
        Ok(arguments)
    }

    /// A value for a parameter, in its range.
    pub(super) fn argument(&mut self, parameter: &Parameter) -> Result<String> {
        self.within(parameter.of_type, parameter.range)
    }

    fn advance(&mut self) -> Result<()> {
        let may_fail = self.options.allow_errors && self.frame.is_replacement;
        // Some follow failure with an error.
        let in_branch = self.frame.claim.is_some();
        if self.moves.is_empty() || may_fail || in_branch {
            return self.motion();
        }
        let name = self.choose(&self.moves.clone())?;
        self.line(&format!("advance {name}"));
        self.frame.knows_position = false;
        Ok(())
    }

    /// What is nothing going forward.
    fn landmark(&mut self) -> Result<()> {
        if self.may_be_irreversible() && self.one_in(2)? {
            self.frame.has_barrier = true;
            self.line("barrier \"glue sets\"");
            return Ok(());
        }
        let name = self.choose(&["apart", "together"])?;
        self.line(&format!("checkpoint {name}"));
        Ok(())
    }

    /// Whether what cannot be taken back may stand here.
    pub(super) fn may_be_irreversible(&self) -> bool {
        self.options.allow_never && !self.frame.in_reversed && self.frame.claim.is_none()
    }
}
