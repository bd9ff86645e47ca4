//! What can be looked at by what is typed, as text: what lies behind and what stops going back,
//! variables, the workcell, calls, source and instructions.

use crate::console::{Done, Result, Typed};
use crate::debuggee::Debuggee;
use crate::words;
use obverse_bytecode::Module;
use obverse_bytecode::text::instruction;
use obverse_debugger::session::{Action, Variable};
use obverse_vm::Direction;

/// How many actions of the history are shown unless another number is asked for, and at the most.
const HISTORY: usize = 20;
const MAX_HISTORY: usize = 10_000;
/// How many lines are shown, and how many of them before the one that it is about.
const LINES: usize = 11;
const LINES_BEFORE: usize = 5;

fn lines(lines: &[String], none: &str) -> Done {
    Done::Told(if lines.is_empty() { none.to_owned() } else { lines.join("\n") })
}

fn listed(variables: &[Variable], none: &str) -> Done {
    let line = |it: &Variable| format!("{} = {}", it.name, it.value);
    lines(&variables.iter().map(line).collect::<Vec<_>>(), none)
}

pub(crate) fn why(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    let why = it.session.why();
    let Some(never) = why.never else {
        let told = format!("nothing stops going back; {} actions lie behind", why.actions);
        return Ok(Done::Told(told));
    };
    let place = words::line(it.session.module(), never.pc);
    Ok(Done::Told(format!(
        "{} actions can be taken back; {place} cannot, at moment {}: {}",
        why.actions, never.moment, never.reason
    )))
}

pub(crate) fn history(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>) -> Result {
    let count = match typed.rest.parse() {
        _ if typed.rest.is_empty() => HISTORY,
        Ok(count @ 1..=MAX_HISTORY) => count,
        _ => return Err(format!("say how many, from 1 to {MAX_HISTORY}")),
    };
    let around = it.session.history_around(count);
    let module = it.session.module();
    let line = |action: &Action| {
        let way = if action.direction == Direction::Reverse { "<-" } else { "->" };
        let place = words::line(module, action.pc);
        format!("{:>8} {way} {place}: {}", action.moment.to_string(), action.text)
    };
    let mut shown: Vec<String> = around.actions.iter().map(line).collect();
    if let Some(here) = around.here {
        shown.insert(here, format!("{:>8} here", it.session.moment().to_string()));
    }
    Ok(lines(&shown, "nothing was done"))
}

pub(crate) fn print(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>) -> Result {
    if typed.rest.is_empty() {
        let mut all = it.session.locals(it.session.frames().len().saturating_sub(1));
        all.extend(it.session.globals());
        return Ok(listed(&all, "there are no variables here"));
    }
    let expression = it.expression(typed, typed.rest)?;
    Ok(Done::Is(it.session.look(|look| expression.value(look))))
}

pub(crate) fn locals(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>) -> Result {
    let innermost = it.session.frames().len().saturating_sub(1);
    // Calls are counted from the innermost, as `backtrace` does.
    let frame = match typed.rest.parse::<usize>() {
        _ if typed.rest.is_empty() => innermost,
        Ok(number) if number <= innermost => innermost - number,
        _ => {
            let asked = typed.rest;
            return Err(format!("`{asked}` is no call: they are numbered from 0 to {innermost}"));
        }
    };
    Ok(listed(&it.session.locals(frame), "this call has no variables"))
}

pub(crate) fn globals(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    Ok(listed(&it.session.globals(), "the program has no variables"))
}

pub(crate) fn state(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    Ok(listed(&it.session.workcell(), "nothing is seen"))
}

pub(crate) fn backtrace(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    let frames = it.session.frames();
    let module = it.session.module();
    let line = |(number, frame): (usize, &obverse_debugger::session::FrameView)| {
        let place = frame.place.as_ref().map(|at| format!("{}:{}", at.file, at.line));
        match frame.index {
            0 => format!("#{number} the start"),
            _ => {
                let place = place.unwrap_or_else(|| words::line(module, frame.pc));
                format!("#{number} {} at {place}", frame.name)
            }
        }
    };
    let calls: Vec<String> = frames.iter().rev().enumerate().map(line).collect();
    Ok(lines(&calls, "no call is under way"))
}

pub(crate) fn list(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>) -> Result {
    let module = it.session.module();
    let here = it.session.position().place;
    let (file, line) = match typed.rest.rsplit_once(':') {
        Some((file, line)) => (Some(file.to_owned()), line),
        None => (here.as_ref().map(|place| place.file.clone()), typed.rest),
    };
    let file = file.or_else(|| module.sources.first().map(|source| source.name.clone()));
    let file = file.ok_or("the program has no source: `disassemble` shows its instructions")?;
    let source = module.sources.iter().find(|source| source.name == file);
    let source = source.ok_or_else(|| format!("the program has no file `{file}`"))?;
    let here = here.filter(|place| place.file == file).map(|place| place.line);
    let line = match line {
        "" => here.unwrap_or(1),
        line => line.parse::<usize>().map_err(|_| format!("`{line}` is no line"))?,
    };
    let first = line.saturating_sub(LINES_BEFORE).max(1);
    let shown = (1..).zip(source.text.lines()).skip(first - 1).take(LINES);
    let shown = shown.map(|(number, text)| {
        let arrow = if here == Some(number) { '>' } else { ' ' };
        format!("{arrow}{number:>4}  {text}").trim_end().to_owned()
    });
    let shown: Vec<String> = shown.collect();
    if shown.is_empty() { Err(format!("there is no line {line}")) } else { Ok(lines(&shown, "")) }
}

pub(crate) fn disassemble(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    let module: &Module = it.session.module();
    let here = it.session.machine().state().pc();
    let first = here.saturating_sub(LINES_BEFORE as u32);
    let shown = (first..first.saturating_add(LINES as u32)).filter_map(|pc| {
        let arrow = if pc == here { '>' } else { ' ' };
        let class = module.code.get(pc as usize)?.info().class.name();
        Some(format!("{arrow}{pc:>4}  {:<32} ; {class}", instruction(module, pc)?))
    });
    Ok(lines(&shown.collect::<Vec<_>>(), "there are no instructions here"))
}

pub(crate) fn tape(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    let told = match it.session.machine().tape() {
        None => "nothing is recorded: the run cannot go back".to_owned(),
        Some(tape) => {
            let bits = tape.place().size_bits();
            format!("{bits} bits from here back, of {} recorded", tape.recorded_bits())
        }
    };
    Ok(Done::Told(told))
}
