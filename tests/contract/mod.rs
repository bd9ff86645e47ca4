//! The format of a contract: assembly text with lines that say what is before and after one step.
//!
//! ```text
//! ;; op: move.joint       class: after-forward(joints)
//!
//! .joints a  0 0 0 0 0 0
//! .joints b  1 0 0 0 0 0
//!
//! ;; case: to another configuration
//! ;; given:   joints = a
//!     push.joints b
//! ;; before:  stack = [b]
//!     move.joint
//! ;; after:   joints = b  stack = []   tape += [joints a]   commands = [move joint to b]
//! ;; back:    joints = a  stack = [b]  commands = [move joint to a]
//! ```
//!
//! What stands before the first case belongs to every case. A case without `.function` is the body
//! of the start, and `enter` and `halt` are put around it. It runs, a step at a time, up to the
//! instruction under `before:`, makes one step more, and then one back.
//!
//! - `given:` sets the workcell up: `joints`, `output N`, and what it will answer: `input N`,
//!   `force`, `draw N`. `stopped = 0.5` stops the act half way, `in_the_way = 0.5` is there for a
//!   motion with a force limit to meet, `holds_back = 0.5` once for one that goes to joints. With
//!   `visit = 2` it is the second time that control comes there.
//! - `before:` is what its clauses say, and may say little.
//! - `after:` is *exactly* the state before with what the clauses change, a step further. `tape +=`
//!   is what was recorded; `commands` is what the workcell was told, nothing if it is left out;
//!   `lands = LABEL` is behind that join, `at = LABEL` before that instruction; else control is at
//!   the next instruction. `trap`, `fault`, `raises`, `due`, `stop` say why the step was none of
//!   the ordinary; after a trap the state is that before the statement, and nothing is left to
//!   say.
//! - `back:` is exactly the state before, to the bit, and its clauses only repeat what of that is
//!   worth seeing; `refused = ".."` is a never, for the program's reason. `at = LABEL` is the state
//!   that was there when control was at that instruction. `back, with:` is the same state but for
//!   what the clauses say, for those opcodes that restore less by the programmer's own word, and
//!   where a fault left the act pending.
//!   `back in 3 steps:` makes so many.
//!
//! Clauses are `key = value`; other keys are the names of locals of the innermost frame, of
//! globals, and `stack`, `calls`, `counter N`, `slot NAME`, `joints`, `output N`, the settings,
//! `raised`, `draws`, `blocks`, `pending`; of forks `turn`, whose turn it is, and `waiting`, where
//! the other tasks stand. A `;;` line that begins with no such word goes on with
//! the one above.

mod cell;
pub(crate) mod picture;
pub(crate) mod run;

use obverse_isa::Opcode;
use std::collections::BTreeMap;

/// A contract.
pub(crate) struct Contract {
    pub(crate) op: String,
    pub(crate) class: String,
    pub(crate) cases: Vec<Case>,
}

/// One case of it.
#[derive(Default)]
pub(crate) struct Case {
    pub(crate) title: String,
    /// Its assembly text.
    pub(crate) source: String,
    /// Where labels are.
    pub(crate) labels: BTreeMap<String, u32>,
    pub(crate) given: Vec<Clause>,
    /// The instruction that is stepped over.
    pub(crate) pc: Option<u32>,
    pub(crate) before: Vec<Clause>,
    pub(crate) after: Vec<Clause>,
    pub(crate) back: Vec<Back>,
}

/// What is found after going back.
pub(crate) struct Back {
    pub(crate) steps: usize,
    /// Whether it may differ from what was there before.
    pub(crate) may_differ: bool,
    pub(crate) clauses: Vec<Clause>,
}

/// `key = value` or `key += value`.
#[derive(Clone, Debug)]
pub(crate) struct Clause {
    pub(crate) key: String,
    pub(crate) value: Value,
}

#[derive(Clone, Debug)]
pub(crate) enum Value {
    One(String),
    Many(Vec<String>),
}

impl Value {
    pub(crate) fn all(&self) -> &[String] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Many(many) => many,
        }
    }

    pub(crate) fn one(&self) -> Result<&str, String> {
        match self {
            Self::One(one) => Ok(one),
            Self::Many(many) => Err(format!("{many:?} is a list")),
        }
    }
}

/// Read a contract.
pub(crate) fn parse(text: &str) -> Result<Contract, String> {
    let mut contract = Contract { op: String::new(), class: String::new(), cases: Vec::new() };
    let mut header = Vec::new();
    let mut stretches: Vec<(String, Vec<&str>)> = Vec::new();
    for line in text.lines() {
        let said = line.strip_prefix(";;").map(str::trim);
        if let Some(said) = said.and_then(|said| said.strip_prefix("op:")) {
            let (op, class) = said.split_once("class:").ok_or("`;; op:` lacks its `class:`")?;
            (contract.op, contract.class) = (op.trim().to_owned(), class.trim().to_owned());
        } else if let Some(title) = said.and_then(|said| said.strip_prefix("case:")) {
            stretches.push((title.trim().to_owned(), Vec::new()));
        } else if let Some((_, lines)) = stretches.last_mut() {
            lines.push(line);
        } else {
            header.push(line);
        }
    }
    if stretches.is_empty() {
        stretches.push((contract.op.clone(), std::mem::take(&mut header)));
    }
    for (title, lines) in stretches {
        let case =
            read_case(&header, &lines).map_err(|error| format!("case `{title}`: {error}"))?;
        contract.cases.push(Case { title, ..case });
    }
    Ok(contract)
}

fn read_case(header: &[&str], lines: &[&str]) -> Result<Case, String> {
    let is_body = !lines.iter().any(|line| line.trim_start().starts_with(".function"));
    let mut case = Case::default();
    let mut asm = vec!["obvasm 1"];
    asm.extend(header);
    let mut next = 0;
    if is_body {
        asm.push(".function \"the start\" start");
    }
    let mut said: Vec<(String, u32)> = Vec::new();
    for line in lines {
        if let Some(words) = line.strip_prefix(";;") {
            match (begins_with_word(words), said.last_mut()) {
                (false, Some((last, _))) => last.push_str(words),
                (false, None) => return Err(format!("`{words}` goes on with nothing")),
                (true, _) => said.push((words.trim().to_owned(), next)),
            }
            continue;
        }
        let code = line.split(';').next().unwrap_or_default().trim();
        let (label, rest) = match code.split_once(':') {
            Some((label, rest)) if !label.contains('"') => (Some(label), rest.trim()),
            _ => (None, code),
        };
        let is_instruction =
            rest.split(' ').next().is_some_and(|word| Opcode::from_mnemonic(word).is_some());
        if is_body && next == 0 && (is_instruction || label.is_some()) {
            asm.push("    enter");
            next = 1;
            said.iter_mut().for_each(|(_, pc)| *pc = 1);
        }
        if let Some(label) = label {
            case.labels.insert(label.to_owned(), next);
        }
        next += u32::from(is_instruction);
        asm.push(line);
    }
    if is_body && !lines.iter().any(|line| line.trim() == "halt") {
        asm.push("    halt");
    }
    case.source = asm.join("\n");
    for (words, pc) in said {
        say(&mut case, &words, pc).map_err(|error| format!("`{words}`: {error}"))?;
    }
    Ok(case)
}

fn begins_with_word(words: &str) -> bool {
    ["given:", "before:", "after:", "back"].iter().any(|word| words.trim().starts_with(word))
}

fn say(case: &mut Case, words: &str, pc: u32) -> Result<(), String> {
    let (word, text) = words.split_once(':').ok_or("a colon is missing")?;
    let clauses = clauses(text)?;
    match word {
        "given" => case.given = clauses,
        "before" if case.pc.is_some() => return Err("a second `before` in a case".to_owned()),
        "before" => (case.before, case.pc) = (clauses, Some(pc)),
        "after" => case.after = clauses,
        _ => {
            let rest = word.strip_prefix("back").ok_or("no such word")?;
            let (count, may_differ) = match rest.strip_suffix(", with") {
                Some(count) => (count, true),
                None => (rest, false),
            };
            let steps = match count.strip_prefix(" in ").and_then(|n| n.strip_suffix(" steps")) {
                Some(steps) => steps.parse().map_err(|_| "the number of steps is none")?,
                None if count.is_empty() => 1,
                None => return Err("it is `back[ in N steps][, with]:`".to_owned()),
            };
            case.back.push(Back { steps, may_differ, clauses });
        }
    }
    Ok(())
}

fn clauses(text: &str) -> Result<Vec<Clause>, String> {
    let mut clauses = Vec::new();
    let mut rest = text.trim();
    while !rest.is_empty() {
        let (key, after) = rest.split_once('=').ok_or_else(|| format!("`{rest}` lacks a `=`"))?;
        let key = key.split_whitespace().collect::<Vec<_>>().join(" ");
        let after = after.trim_start();
        let closing = match after.chars().next() {
            Some('[') => Some(']'),
            Some('"') => Some('"'),
            _ => None,
        };
        let (value, left) = match closing {
            Some(closing) => after[1..]
                .split_once(closing)
                .ok_or_else(|| format!("no `{closing}` in `{rest}`"))?,
            None => after.split_once(' ').unwrap_or((after, "")),
        };
        let value = match closing {
            Some(']') => Value::Many(
                value
                    .split(',')
                    .map(|item| item.trim().to_owned())
                    .filter(|x| !x.is_empty())
                    .collect(),
            ),
            _ => Value::One(value.to_owned()),
        };
        clauses.push(Clause { key, value });
        rest = left.trim_start();
    }
    Ok(clauses)
}
