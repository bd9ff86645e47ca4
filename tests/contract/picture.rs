//! A picture of a machine and its workcell, by name, and the words that contracts use for values.
//!
//! Everything that a step may change is a row of words here, so that a contract compares all of it
//! and names what differs.

use super::cell::Cell;
use super::{Clause, Value};
use obverse_bytecode::Module;
use obverse_isa::{Setting, SpeedId};
use obverse_testkit::Ledger;
use obverse_testkit::logged::Command;
use obverse_vm::Machine;
use obverse_workcell::{Goal, Motion, Path};
use std::collections::BTreeMap;

/// What there is, by name, each as words of 64 bits.
pub(crate) type Picture = BTreeMap<String, Vec<u64>>;

/// The picture of a machine and what its workcell was commanded.
pub(crate) fn of(machine: &Machine<'_>, cell: &Cell) -> Picture {
    let module = machine.program().module();
    let state = machine.snapshot(cell);
    let mut picture = Picture::new();
    let mut put = |name: &str, words: Vec<u64>| {
        picture.insert(name.to_owned(), words);
    };
    put("at", vec![u64::from(state.pc)]);
    put("steps", vec![state.steps]);
    put("stack", state.operands);
    for (depth, frame) in state.frames.iter().enumerate() {
        let function = &module.functions[usize::from(frame.function)];
        let counters = frame.words[function.locals.len()..].chunks(3);
        for (local, word) in function.locals.iter().zip(&frame.words) {
            put(&of_frame(depth, &local.name), vec![*word]);
        }
        for (number, words) in counters.enumerate() {
            put(&of_frame(depth, &format!("counter {number}")), words.to_vec());
        }
        for (slot, joints) in function.slots.iter().zip(&frame.positions) {
            put(&of_frame(depth, &format!("slot {slot}")), bits(joints));
        }
    }
    let calls = state.frames.iter();
    let calls = calls.flat_map(|frame| [u64::from(frame.function), u64::from(frame.return_pc)]);
    put("calls", calls.collect());
    for (global, word) in module.globals.iter().zip(&state.globals) {
        put(&global.name, vec![*word]);
    }
    for setting in Setting::ALL {
        put(setting.name(), vec![state.settings[*setting as usize]]);
    }
    put("raised", state.raised.iter().map(|&error| u64::from(error)).collect());
    put("draws", vec![state.draws]);
    put("blocks", vec![u64::from(machine.state().open_blocks())]);
    let pending = state.pending.map_or(0, |(is_reverse, _)| 1 + u64::from(is_reverse));
    put("pending", vec![pending]);
    let turns = state.forks.iter().map(|fork| u64::from(fork.current));
    put("turn", turns.collect());
    let waiting = state.forks.iter().flat_map(|fork| {
        let others = (0..).zip(&fork.tasks).filter(|(task, _)| *task != fork.current);
        others.map(|(_, task)| u64::from(task.pc))
    });
    put("waiting", waiting.collect());
    put("joints", bits(&state.joints));
    for (bit, level) in state.outputs.iter().enumerate() {
        put(&format!("output {bit}"), vec![u64::from(*level)]);
    }
    let tape = machine.streams();
    put("tape bits", tape.bits.iter().map(|&bit| u64::from(bit)).collect());
    put("tape words", tape.words);
    put("tape joints", tape.joints.iter().flat_map(bits).collect());
    put("tape control", tape.control);
    put("tape dropped", vec![tape.dropped_bits]);
    put("digest", vec![machine.digest(cell)]);
    picture
}

fn bits(joints: &[f64; 6]) -> Vec<u64> {
    joints.iter().map(|joint| joint.to_bits()).collect()
}

fn of_frame(depth: usize, name: &str) -> String {
    format!("{name} of call {depth}")
}

/// What is different, a line each.
pub(crate) fn differences(expected: &Picture, found: &Picture) -> Vec<String> {
    let names = expected.keys().chain(found.keys().filter(|name| !expected.contains_key(*name)));
    let show = |words: Option<&Vec<u64>>| match words {
        None => "nothing".to_owned(),
        Some(words) => {
            let number = |word: &u64| {
                let real = f64::from_bits(*word);
                let is_small = word.cast_signed().unsigned_abs() < 1 << 40;
                if is_small { word.cast_signed().to_string() } else { format!("{real:?}") }
            };
            format!("[{}]", words.iter().map(number).collect::<Vec<_>>().join(", "))
        }
    };
    let differing = names.filter(|name| expected.get(*name) != found.get(*name));
    let line = |name: &String| {
        format!("{name} should be {}, and is {}", show(expected.get(name)), show(found.get(name)))
    };
    differing.map(line).collect()
}

/// The end of a turn: `TASK after STEPS`, where it was not the start of the fork the time before it
/// as `at MILLISECONDS`, where the task that is next waited `until MILLISECONDS`, and `left` where
/// the fork was.
fn switch(what: &str) -> Result<Vec<u64>, String> {
    let (what, leaves) = what.strip_suffix(" left").map_or((what, 0), |what| (what, 1));
    let (what, until_ns) = time(what, " until ")?;
    let (what, now_ns) = time(what, " at ")?;
    let wrong = || format!("`{what}` is not `TASK after STEPS`");
    let (task, steps) = what.split_once(" after ").ok_or_else(wrong)?;
    let number = |text: &str| text.parse::<u64>().map_err(|_| wrong());
    Ok(vec![now_ns, until_ns, number(steps)? << 9 | leaves << 8 | number(task)?])
}

/// What is before a word, and the milliseconds behind it as nanoseconds; none without the word.
fn time<'w>(what: &'w str, word: &str) -> Result<(&'w str, u64), String> {
    let Some((before, time_ms)) = what.split_once(word) else { return Ok((what, 0)) };
    let time_ms: u64 = time_ms.parse().map_err(|_| format!("`{time_ms}` is no time"))?;
    Ok((before, time_ms * 1_000_000))
}

/// What the words of a contract mean.
pub(crate) struct Words<'m> {
    pub(crate) module: &'m Module,
    pub(crate) labels: &'m BTreeMap<String, u32>,
}

impl Words<'_> {
    /// Change a picture by a clause. `found` is what is there, for what is not a number: no two
    /// need have the same bits. `pc` is the instruction that is stepped over.
    pub(crate) fn apply(
        &self,
        picture: &mut Picture,
        clause: &Clause,
        found: &Picture,
        pc: u32,
    ) -> Result<(), String> {
        match clause.key.as_str() {
            "tape +" => return self.record(picture, &clause.value),
            "tape" => return forget(picture, &clause.value),
            "calls" => return self.calls(picture, &clause.value, pc),
            _ => {}
        }
        let key = self.key(picture, &clause.key)?;
        let mut words = Vec::new();
        for (index, text) in clause.value.all().iter().enumerate() {
            let there = found.get(&key).and_then(|words| words.get(index)).copied();
            match there.filter(|bits| text == "nan" && f64::from_bits(*bits).is_nan()) {
                Some(bits) => words.push(bits),
                None => words.extend(self.value(&key, text)?),
            }
        }
        picture.insert(key, words);
        Ok(())
    }

    /// The name in the picture of what a clause calls so.
    fn key(&self, picture: &Picture, key: &str) -> Result<String, String> {
        let innermost = of_frame(picture["calls"].len() / 2 - 1, key);
        let names = [innermost, key.to_owned()];
        let known = names.into_iter().find(|name| picture.contains_key(name));
        known.ok_or_else(|| format!("nothing is called `{key}`"))
    }

    /// The words that a value is made of.
    fn value(&self, key: &str, text: &str) -> Result<Vec<u64>, String> {
        if key == "at" || key == "waiting" {
            return self.label(text).map(|pc| vec![u64::from(pc)]);
        }
        if key == "joints" || key.starts_with("slot ") {
            return self.joints(text).map(|joints| bits(&joints));
        }
        self.word(text).map(|word| vec![word])
    }

    /// The instruction of a label.
    pub(crate) fn label(&self, label: &str) -> Result<u32, String> {
        self.labels.get(label).copied().ok_or_else(|| format!("there is no label `{label}`"))
    }

    /// The configuration of a name; `here` is where the arm is at first.
    pub(crate) fn joints(&self, name: &str) -> Result<[f64; 6], String> {
        let mut known = self.module.joints.iter();
        match known.find(|(known, _)| known == name) {
            Some((_, joints)) => Ok(*joints),
            None if name == "here" => Ok(Ledger::new(0).joints.0),
            None => Err(format!("no configuration is called `{name}`")),
        }
    }

    fn word(&self, text: &str) -> Result<u64, String> {
        if let Ok(number) = text.parse::<i64>() {
            return Ok(number.cast_unsigned());
        }
        let is_real = text.ends_with("inf") || text.contains(['.', 'e']);
        if let (Ok(real), true) = (text.parse::<f64>(), is_real) {
            return Ok(real.to_bits());
        }
        let choice = match text {
            "false" | "low" | "none" => Some(0),
            "true" | "high" | "forward" => Some(1),
            "reverse" => Some(2),
            _ => SpeedId::ALL.iter().find(|speed| speed.name() == text).map(|&speed| speed as u64),
        };
        let module = self.module;
        let tables = [
            module.joints.iter().position(|(name, _)| name == text),
            module.items.iter().position(|item| item.name == text),
            module.errors.iter().position(|error| error.name == text),
        ];
        let index = tables.into_iter().flatten().next().map(|index| index as u64);
        choice.or(index).ok_or_else(|| format!("`{text}` is no value"))
    }

    /// Add records to the tape of a picture.
    fn record(&self, picture: &mut Picture, value: &Value) -> Result<(), String> {
        for record in value.all() {
            let (kind, what) = record.split_once(' ').ok_or("a record is `kind value`")?;
            let (stream, words) = match kind {
                "bit" => ("tape bits", vec![self.word(what)?]),
                "word" => ("tape words", vec![self.word(what)?]),
                "joints" => ("tape joints", bits(&self.joints(what)?)),
                "switch" => ("tape control", switch(what)?),
                "held" => ("tape control", self.held(what)?),
                "call" => ("tape control", vec![self.call(what)?]),
                _ => return Err(format!("`{kind}` is no kind of record")),
            };
            picture.entry(stream.to_owned()).or_default().extend(words);
        }
        Ok(())
    }

    /// Where a task is held: `LABEL`, or `LABEL with CALLS`, and where it waited
    /// `until MILLISECONDS`.
    fn held(&self, what: &str) -> Result<Vec<u64>, String> {
        let (what, until_ns) = time(what, " until ")?;
        let (label, calls) = what.split_once(" with ").unwrap_or((what, "0"));
        let calls: u64 = calls.parse().map_err(|_| format!("`{calls}` is no number"))?;
        Ok(vec![until_ns, calls << 33 | u64::from(self.label(label)?)])
    }

    /// A call of a task that is held: `FUNCTION to LABEL`, where the caller goes on.
    fn call(&self, what: &str) -> Result<u64, String> {
        let (name, to) = what.split_once(" to ").ok_or("a call is `FUNCTION to LABEL`")?;
        let mut functions = self.module.functions.iter();
        let index = functions.position(|function| function.name == name);
        let index = index.ok_or_else(|| format!("no function is called `{name}`"))?;
        Ok((index as u64) << 32 | u64::from(self.label(to)?))
    }

    /// Make the calls of a picture these functions, outermost first.
    fn calls(&self, picture: &mut Picture, value: &Value, pc: u32) -> Result<(), String> {
        let mut calls = picture["calls"].clone();
        let names = value.all();
        while calls.len() / 2 > names.len() {
            calls.truncate(calls.len() - 2);
            let gone = of_frame(calls.len() / 2, "");
            picture.retain(|name, _| !name.ends_with(&gone));
        }
        for (depth, name) in names.iter().enumerate() {
            let mut functions = self.module.functions.iter();
            let index = functions.position(|function| function.name == *name);
            let index = index.ok_or_else(|| format!("no function is called `{name}`"))?;
            if let Some(there) = calls.get(2 * depth) {
                if *there != index as u64 {
                    return Err(format!("call {depth} is not of `{name}`"));
                }
                continue;
            }
            calls.extend([index as u64, u64::from(pc) + 1]);
            let function = &self.module.functions[index];
            for local in &function.locals {
                picture.insert(of_frame(depth, &local.name), vec![0]);
            }
            for number in 0..function.counters {
                picture.insert(of_frame(depth, &format!("counter {number}")), vec![0; 3]);
            }
            for slot in &function.slots {
                picture.insert(of_frame(depth, &format!("slot {slot}")), vec![0; 6]);
            }
        }
        picture.insert("calls".to_owned(), calls);
        Ok(())
    }

    /// A command to the workcell, in words.
    pub(crate) fn command(&self, command: &Command) -> String {
        match command {
            Command::Execute(motion) => self.motion(motion),
            Command::Output(bit, level) => {
                format!("output {bit} {}", if *level { "high" } else { "low" })
            }
            Command::Wait(duration_s) => format!("wait {duration_s:?}"),
        }
    }

    fn motion(&self, motion: &Motion) -> String {
        let path = match motion.path {
            Path::Joint => "joint",
            Path::Linear => "linear",
        };
        let goal = match motion.goal {
            Goal::Joints(joints) => format!("to {}", self.name_of(&joints.0)),
            Goal::Pose(pose) => {
                let at = pose.translation_m;
                format!("to the pose at {:?} {:?} {:?}", at[0], at[1], at[2])
            }
            Goal::Displaced { from, distance_m, axis, frame } => {
                let axis = format!("{axis:?}").replace("Plus", "+").replace("Minus", "-");
                format!("from {} by {distance_m:?} {axis} in {frame:?}", self.name_of(&from.0))
            }
            Goal::Offset { from, by_m: [x, y, z], frame } => {
                format!("from {} by {x:?} {y:?} {z:?} in {frame:?}", self.name_of(&from.0))
            }
            Goal::Turned { from, angle_rad, advance_m, axis, frame } => {
                let axis = format!("{axis:?}").replace("Plus", "+").replace("Minus", "-");
                let from = self.name_of(&from.0);
                format!("from {from} turned {angle_rad:?} on {advance_m:?} {axis} in {frame:?}")
            }
        };
        let mut text = format!("move {path} {goal}").to_lowercase();
        if let Some(limit_n) = motion.force_limit_n {
            text += &format!(" until {limit_n:?} N");
        }
        let speed = SpeedId::ALL[motion.speed as usize];
        if speed != SpeedId::Normal {
            text += &format!(" at {}", speed.name());
        }
        if motion.tool.0 != 0 {
            text += &format!(" with tool {}", motion.tool.0);
        }
        text
    }

    fn name_of(&self, joints: &[f64; 6]) -> String {
        let mut known = self.module.joints.iter();
        let known = known.find(|(_, known)| bits(known) == bits(joints));
        known.map_or_else(|| format!("{joints:?}"), |(name, _)| name.clone())
    }
}

/// Empty the tape of a picture; what was on it counts as dropped.
fn forget(picture: &mut Picture, value: &Value) -> Result<(), String> {
    if !value.all().is_empty() {
        return Err("`tape =` is for an empty one; what is added is `tape +=`".to_owned());
    }
    let widths = [("tape bits", 1), ("tape words", 64), ("tape joints", 64)];
    let dropped: u64 = widths.iter().map(|(name, width)| width * picture[*name].len() as u64).sum();
    for (name, _) in widths {
        picture.insert(name.to_owned(), Vec::new());
    }
    picture.insert("tape dropped".to_owned(), vec![picture["tape dropped"][0] + dropped]);
    Ok(())
}
