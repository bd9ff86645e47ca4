//! Declarations: data, I/O operations, advanced moves, sequences, errors.

use super::expression::bounds;
use super::scope::{Frame, Type, Variable};
use super::{Callee, Generator, Parameter};
use arbitrary::Result;

/// Every fault that a program can name.
const FAULTS: [&str; 12] = [
    "joint limit",
    "out of reach",
    "singularity",
    "collision",
    "force limit",
    "protective stop",
    "emergency stop",
    "stopped short",
    "missing",
    "input 1 high",
    "input 0 low",
    "force > 2 * 20 N",
];

/// How deep a recursion goes at the most.
const RECURSION: u64 = 4;

impl Generator<'_, '_> {
    /// What is declared before the sequences; each with its text.
    pub(super) fn data(&mut self) -> Result<Vec<String>> {
        let mut items = Vec::new();
        for _ in 0..=self.below(3)? {
            items.push(self.joint_configuration()?);
        }
        for _ in 0..self.below(3)? {
            items.push(self.item_declaration()?);
        }
        for _ in 0..self.below(6)? {
            items.push(self.global()?);
        }
        for _ in 0..self.below(4)? {
            items.push(self.signal_entry()?);
        }
        for _ in 0..self.below(3)? {
            items.push(self.io_operation()?);
        }
        if self.options.allow_errors {
            for _ in 0..self.below(3)? {
                let name = self.name("e");
                self.errors.push(name);
            }
        }
        for _ in 0..self.below(3)? {
            items.push(self.advanced_move()?);
        }
        Ok(items)
    }

    fn taken(&mut self) -> String {
        std::mem::take(&mut self.text)
    }

    fn joint_configuration(&mut self) -> Result<String> {
        let name = self.name("q");
        let mut values = Vec::new();
        for _ in 0..6 {
            values.push(format!("{}.{}", self.u.int_in_range(-3..=3)?, self.below(100)?));
        }
        let unit = self.choose(&["rad", "deg"])?;
        self.line(&format!("joints {name} = [{}] {unit}", values.join(", ")));
        self.joints.push(name);
        Ok(self.taken())
    }

    fn item_declaration(&mut self) -> Result<String> {
        let name = self.name("part");
        self.open(&format!("item {name}"));
        for keyframe in ["grasp", "above"] {
            let (x, y) = (self.below(100)?, self.below(100)?);
            let rotation = match self.below(3)? {
                0 => String::new(),
                1 => format!(" [0, {}, 0] deg", self.below(180)?),
                _ => format!(" [{} rad, 10 deg, -0.5 rad]", self.below(3)?),
            };
            self.line(&format!("keyframe {keyframe} = [{x}, -{y}.5, 20] mm{rotation}"));
        }
        self.close("");
        self.items.push(name);
        Ok(self.taken())
    }

    fn global(&mut self) -> Result<String> {
        let of_type = self.choose(&Type::OF_VARIABLES)?;
        let name = self.name("g");
        let value = match of_type {
            Type::Int => format!("{}", self.u.int_in_range(-9..=9)?),
            Type::Bool => self.choose(&["true", "false"])?.to_owned(),
            Type::Joints => self.choose(&self.joints.clone())?,
            Type::Number => format!("{}.5", self.below(9)?),
            Type::Length => format!("{} mm", self.below(90)?),
            Type::Time => format!("{} ms", self.below(90)?),
            Type::Force => format!("-{} N", self.below(90)?),
            _ => format!("{} deg", self.below(90)?),
        };
        let declared = match self.one_in(3)? {
            true => format!(": {}", of_type.name()),
            false => String::new(),
        };
        self.line(&format!("var {name}{declared} = {value}"));
        self.globals.push(Variable { name, of_type, is_free: true });
        Ok(self.taken())
    }

    /// An entry of an I/O map. Lines may have several names.
    fn signal_entry(&mut self) -> Result<String> {
        let word = self.choose(&["output", "input"])?;
        let (name, bit) = (self.name(word), self.below(8)?);
        self.line(&format!("{word} {name} = {bit}"));
        match word {
            "output" => self.outputs.push(name),
            _ => self.inputs.push(name),
        }
        Ok(self.taken())
    }

    /// A line of the workcell by its number, or by one of these names.
    pub(super) fn signal(&mut self, names: &[String]) -> Result<String> {
        let bit = self.below(8)?;
        let is_named = !names.is_empty() && self.one_in(2)?;
        if is_named { self.choose(names) } else { Ok(bit.to_string()) }
    }

    fn io_operation(&mut self) -> Result<String> {
        let name = self.name("io");
        self.frame = Frame::new();
        self.open(&format!("io {name}"));
        for _ in 0..self.below(3)? {
            self.output()?;
        }
        let counterpart = match self.io.last() {
            Some(other) if self.options.allow_overrides => Some(other.clone()),
            _ => None,
        };
        match counterpart {
            Some(other) if self.one_in(2)? => self.close(&format!(" reverse {other}")),
            _ => self.close(""),
        }
        self.io.push(name);
        Ok(self.taken())
    }

    fn advanced_move(&mut self) -> Result<String> {
        let name = self.name("m");
        self.frame = Frame::new();
        self.open(&format!("advanced move {name}"));
        let is_turn = self.one_in(3)?;
        let throws = self.behaviours(is_turn)?;
        if self.one_in(3)? {
            let condition = self.expression(Type::Bool)?;
            if !self.errors.is_empty() && self.one_in(2)? {
                let error = self.choose(&self.errors.clone())?;
                self.line(&format!("requires {condition} else throw {error}"));
            } else if throws || self.traps()? {
                self.line(&format!("requires {condition}"));
            }
        }
        let motion = match is_turn {
            true => self.turn()?,
            false => format!("distance {}", self.way(true)?),
        };
        self.line(&motion);
        if self.one_in(2)? {
            let limit = self.choose(&["force > 5 N", "force >= abs(2 N * 2)", "1.5 N < force"])?;
            self.line(&format!("stop if {limit}"));
            if !is_turn && self.one_in(2)? {
                self.line("opposite force in reverse");
            }
        }
        if self.one_in(2)? {
            let speed = self.speed()?;
            self.line(&speed);
        }
        if self.one_in(2)? {
            let reading = self.expression(Type::Bool)?;
            let condition = self.choose(&[
                "distance > 100 mm".to_owned(),
                "force < 3 N and distance > 1 um".to_owned(),
                reading,
            ])?;
            self.line(&format!("succeeds if {condition}"));
        }
        let is_calm = !self.text.contains("throw ");
        match self.calm_moves.last().cloned() {
            Some(other) if self.options.allow_overrides && self.one_in(2)? => {
                self.close(&format!(" reverse {other}"));
            }
            _ => self.close(""),
        }
        if is_calm {
            self.calm_moves.push(name.clone());
        }
        self.moves.push(name);
        Ok(self.taken())
    }

    /// What an advanced move does afterwards; whether failure throws. A turn is not led back.
    fn behaviours(&mut self, is_turn: bool) -> Result<bool> {
        if self.one_in(2)? {
            self.open("on success");
            if !is_turn && self.one_in(2)? {
                self.line("return to initial position");
            }
            if !self.errors.is_empty() && self.one_in(4)? {
                let error = self.choose(&self.errors.clone())?;
                self.line(&format!("throw {error}"));
            }
            self.close("");
        }
        self.open("on failure");
        if !is_turn && self.one_in(2)? {
            self.line("return to initial position");
        }
        if !is_turn && self.one_in(2)? {
            let within = self.choose(&["", " 2 mm", " (1 mm + 0.5 cm)"])?;
            let times = self.below(3)? + 1;
            self.line(&format!("repeat with perturbation{within} {times} times"));
        }
        let throws = !self.errors.is_empty() && self.one_in(2)?;
        if throws {
            let error = self.choose(&self.errors.clone())?;
            self.line(&format!("throw {error}"));
        }
        self.close("");
        Ok(throws)
    }

    /// `sequence f(…) { … }`, which calls those before it, and perhaps itself.
    pub(super) fn sequence(
        &mut self,
        word: &str,
        parameters: usize,
        is_recursive: bool,
    ) -> Result<String> {
        let name = self.name("f");
        self.frame = Frame::new();
        let mut callee = Callee {
            name: name.clone(),
            parameters: Vec::new(),
            is_recursive,
            cost: 0,
            has_barrier: false,
        };
        let mut written = Vec::new();
        for index in 0..parameters + usize::from(is_recursive) {
            let is_bound = is_recursive && index == 0;
            let of_type = match is_bound {
                true => Type::Int,
                false => self.parameter_type()?,
            };
            let parameter = self.parameter(of_type, is_bound)?;
            written.push(parameter.1);
            self.declare(&parameter.0.name, of_type, !is_bound);
            callee.parameters.push(parameter.0);
        }
        self.open(&format!("{word} {name}({})", written.join(", ")));
        self.statements(6)?;
        if is_recursive {
            self.recursion(&callee)?;
        }
        self.close("");
        let depth = if is_recursive { RECURSION } else { 1 };
        callee.cost = (self.frame.cost + 2) * depth;
        callee.has_barrier = self.frame.has_barrier;
        self.callees.push(callee);
        Ok(self.taken())
    }

    /// A parameter, and how it is written; what bounds a recursion has no range.
    fn parameter(&mut self, of_type: Type, is_bound: bool) -> Result<(Parameter, String)> {
        let name = self.name("p");
        let bounds = bounds(of_type).filter(|_| !is_bound);
        let range = if self.one_in(3)? { bounds } else { None };
        let default = match bounds {
            Some((low, high)) if self.one_in(3)? => Some(self.choose(&[low, high])?),
            _ => None,
        };
        let mut written = format!("{name}: {}", of_type.name());
        if let Some((low, high)) = range {
            written.push_str(&format!(" in {low} to {high}"));
        }
        if let Some(default) = default {
            written.push_str(&format!(" = {default}"));
        }
        Ok((Parameter { name, of_type, range, has_default: default.is_some() }, written))
    }

    fn parameter_type(&mut self) -> Result<Type> {
        let of_type = self.choose(&Type::OF_VARIABLES)?;
        let wants_item = !self.items.is_empty() && self.one_in(4)?;
        Ok(if wants_item { Type::Item } else { of_type })
    }

    /// A call of the sequence in hand by itself, with less left to go.
    fn recursion(&mut self, callee: &Callee) -> Result<()> {
        let bound = self.frame.variables[0].name.clone();
        self.open(&format!("if {bound} > 0"));
        self.block(3)?;
        let mut arguments = vec![format!("{bound} - 1")];
        for parameter in &callee.parameters[1..] {
            arguments.push(self.argument(parameter)?);
        }
        self.line(&format!("call {}({})", callee.name, arguments.join(", ")));
        self.frame.knows_position = false;
        self.block(2)?;
        self.close("");
        Ok(())
    }

    pub(super) fn main(&mut self) -> Result<String> {
        self.frame = Frame::new();
        self.budget = self.budget.max(self.options.max_statements / 3);
        self.open("sequence main");
        self.statements(6)?;
        self.statements(12)?;
        self.close("");
        Ok(self.taken())
    }

    /// The errors, now that the sequences are known that can recover from them.
    pub(super) fn error_declarations(&mut self) -> Result<Vec<String>> {
        let can_recover = |callee: &&Callee| callee.parameters.is_empty();
        let callees = self.callees.iter().filter(can_recover);
        let using: Vec<String> = callees.map(|callee| callee.name.clone()).collect();
        let mut items = Vec::new();
        let mut faults = FAULTS.to_vec();
        for name in self.errors.clone() {
            self.open(&format!("error {name}"));
            let raised_by_faults = self.faults(&mut faults)?;
            // Whatever acts would share the devices of the recovery with the other branches.
            let is_shared = raised_by_faults && self.has_forks;
            self.error_clauses(if is_shared { &[] } else { &using })?;
            self.close("");
            items.push(self.taken());
        }
        Ok(items)
    }

    /// The faults that raise an error and what is watched for it, of those that raise none yet;
    /// whether any does.
    fn faults(&mut self, left: &mut Vec<&'static str>) -> Result<bool> {
        if !self.one_in(3)? {
            return Ok(false);
        }
        let mut chosen = Vec::new();
        for _ in 0..=self.below(2)? {
            if !left.is_empty() {
                chosen.push(left.swap_remove(self.below(left.len())?));
            }
        }
        if !chosen.is_empty() {
            self.line(&format!("on {}", chosen.join(", ")));
        }
        Ok(!chosen.is_empty())
    }

    /// `give up after …`
    fn bounds(&mut self, is_by_reversing: bool) -> Result<()> {
        if self.one_in(3)? {
            let times = format!("{} times", self.below(4)? + 1);
            let bounds = match is_by_reversing && self.one_in(2)? {
                true => {
                    self.choose(&[format!("{times}, 1.5 min"), "20 mm * 2, 90 s".to_owned()])?
                }
                false => times,
            };
            self.line(&format!("give up after {bounds}"));
        }
        Ok(())
    }

    /// `cleanup { … }`
    pub(super) fn cleanup(&mut self) -> Result<String> {
        self.frame = Frame::new();
        self.budget = self.budget.max(6);
        self.open("cleanup");
        self.statements(6)?;
        self.close("");
        Ok(self.taken())
    }

    fn error_clauses(&mut self, using: &[String]) -> Result<()> {
        let respond =
            self.choose(&["after current sequence", "at once", "after current action"])?;
        if !self.one_in(3)? {
            self.line(&format!("respond {respond}"));
        }
        match self.below(6)? {
            0 => self.line("severity warning"),
            1 => self.line("severity fatal"),
            _ => self.recovery(using)?,
        }
        Ok(())
    }

    fn recovery(&mut self, using: &[String]) -> Result<()> {
        let sequence = match using.is_empty() {
            true => None,
            false => Some(self.choose(using)?),
        };
        let how = self.below(4)?;
        self.bounds(how == 2)?;
        match (sequence, how) {
            (Some(sequence), 0 | 1) => self.line(&format!("recover using {sequence}")),
            (sequence, 2) => {
                let depth =
                    self.choose(&["", "escalating ", "escalating doubling ", "learned "])?;
                let change = self.choose(&["perturbed 1 mm", "perturbed at random 0.5 mm"])?;
                self.line(&format!("recover by reversing {depth}up to 3 actions, {change}"));
                let sequence = sequence.map(|name| format!("using {name}"));
                let otherwise = sequence.unwrap_or_else(|| "operator".to_owned());
                self.line(&format!("otherwise {otherwise}"));
            }
            _ => {}
        }
        let then = self.choose(&[
            "",
            "then continue",
            "then return to action",
            "then return to sequence",
            "then restart program",
            "then stop",
        ])?;
        if !then.is_empty() {
            self.line(then);
        }
        Ok(())
    }
}
