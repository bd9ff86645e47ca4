//! The source and the instructions around where the session stands, with the class of each line.

use super::{Answer, Done, Front};
use crate::commands::reach::margin::{Mark, sign};
use crate::story;
use crate::write::printable;
use obverse_bytecode::{FunctionKind, Module};
use obverse_isa::Class;
use obverse_reach::Standing;

/// How many lines are shown before and behind where the session stands.
const LINES_BEFORE: usize = 5;
const LINES: usize = 11;

impl Front<'_> {
    /// The source file that the session stands in.
    pub(super) fn file_name(&self) -> Option<String> {
        Some(self.session.position().place?.file)
    }

    /// Where the session stands: line, class, what is next there, and in what.
    pub(super) fn place_line(&self) -> String {
        let position = self.session.position();
        let module = self.module;
        let function = module.function_at(position.pc).and_then(|at| module.functions.get(at));
        let within = match function.map(|function| function.kind) {
            None | Some(FunctionKind::Start) => String::new(),
            Some(FunctionKind::Replacement) => "  (in reverse)".to_owned(),
            Some(_) => format!("  ({})", position.function),
        };
        let said = story::said(module, position.pc);
        let place = position.place.filter(|_| !within.is_empty());
        let (number, class) = match &place {
            Some(place) => {
                let file = self.file_of(&place.file);
                let class = file.and_then(|file| self.margin.mark(file, place.line).class);
                let is_one = module.sources.len() == 1;
                let name = |place: &obverse_debugger::SourcePlace| match is_one {
                    true => place.line.to_string(),
                    false => format!("{}:{}", place.file, place.line),
                };
                (name(place), class)
            }
            None if within.is_empty() => return self.bare_line(position.pc),
            None => (position.pc.to_string(), self.margin.mark(0, position.pc as usize).class),
        };
        self.drawn(&format!("{number:>4} "), class, &format!(" {said}{within}"), false)
    }

    /// A place that is written nowhere: the start calls the first sequence without a word.
    fn bare_line(&self, pc: u32) -> String {
        let is_over = self
            .module
            .code
            .get(pc as usize)
            .is_some_and(|instr| matches!(instr, obverse_isa::Instr::Halt {}));
        if is_over {
            "   at the end of the program".to_owned()
        } else {
            "   at the start".to_owned()
        }
    }

    fn file_of(&self, name: &str) -> Option<u16> {
        let found = self.module.sources.iter().position(|source| source.name == name);
        found.and_then(|file| u16::try_from(file).ok())
    }

    /// A line with its class, in colours if the face has them.
    fn drawn(&self, before: &str, class: Option<Standing>, after: &str, is_here: bool) -> String {
        let sign = sign(class);
        if !self.face.is_coloured {
            return format!("{before}{sign}{after}").trim_end().to_owned();
        }
        let colour = match class {
            Some(Standing::Always) => 32,
            Some(Standing::AfterForward) => 34,
            Some(Standing::Never) => 31,
            None => 39,
        };
        let weight = if is_here { 1 } else { 22 };
        let (before, after) = (printable(before), printable(after));
        format!("\u{1b}[{weight}m{before}\u{1b}[{colour}m{sign}\u{1b}[39m{after}\u{1b}[0m")
    }

    /// Lines of a file from one on.
    fn lines_from(&self, file: u16, first: usize) -> Vec<String> {
        let here = self.session.position().place;
        let here = here.filter(|place| self.file_of(&place.file) == Some(file));
        let here = here.map(|place| place.line);
        let text = self.module.sources.get(usize::from(file)).map_or("", |source| &source.text);
        let lines = (1..).zip(text.lines()).skip(first - 1).take(LINES);
        let line = |(number, text): (usize, &str)| {
            let is_here = here == Some(number);
            let arrow = if is_here { '>' } else { ' ' };
            let Mark { bracket, class } = self.margin.mark(file, number);
            let before = format!("{arrow}{number:>4} {bracket}");
            self.drawn(&before, class, &format!(" {text}"), is_here)
        };
        lines.map(line).collect()
    }
}

pub(super) fn list(front: &mut Front<'_>, rest: &str) -> Done {
    if front.module.source_map.is_empty() {
        return disassemble(front, rest);
    }
    let (file, first) = match (rest, front.listed) {
        ("", Some(next)) => next,
        ("", None) => {
            let place = front.session.position().place;
            let file = place.as_ref().and_then(|place| front.file_of(&place.file));
            let line = place.map_or(1, |place| place.line);
            (file.unwrap_or(0), line.saturating_sub(LINES_BEFORE).max(1))
        }
        (asked, _) => asked_for(front, asked)?,
    };
    let lines = front.lines_from(file, first);
    if lines.is_empty() {
        front.listed = None;
        return Err(format!("there is no line {first}"));
    }
    front.listed = Some((file, first + lines.len()));
    Ok(Answer::lines(lines))
}

/// The file and the first line of what is asked for: `LINE`, `FILE:LINE` or a sequence.
fn asked_for(front: &Front<'_>, asked: &str) -> Result<(u16, usize), String> {
    let (file, line) = match asked.rsplit_once(':') {
        Some((file, line)) => {
            (front.file_of(file).ok_or_else(|| format!("the program has no file `{file}`"))?, line)
        }
        None => (front.file_name().and_then(|name| front.file_of(&name)).unwrap_or(0), asked),
    };
    if let Ok(line) = line.parse::<usize>() {
        return Ok((file, line.saturating_sub(LINES_BEFORE).max(1)));
    }
    let named = front.module.functions.iter().find(|function| function.name == asked);
    let place = named.and_then(|function| front.module.place_of(function.first));
    let (name, line, _) = place.ok_or_else(|| format!("`{asked}` is no line, and no sequence"))?;
    Ok((front.file_of(name).unwrap_or(0), line.saturating_sub(1).max(1)))
}

pub(super) fn disassemble(front: &mut Front<'_>, _: &str) -> Done {
    let here = front.session.machine().state().pc();
    let first = here.saturating_sub(LINES_BEFORE as u32);
    let pcs = first..(first + LINES as u32).min(front.module.code.len() as u32);
    let line = |pc: u32| {
        let arrow = if pc == here { '>' } else { ' ' };
        let text = obverse_bytecode::text::instruction(front.module, pc).unwrap_or_default();
        let class = class_of(front.module, pc);
        // Beside instructions there are brackets where no source has them.
        let has_source = !front.module.source_map.is_empty();
        let bracket = if has_source { ' ' } else { front.margin.mark(0, pc as usize).bracket };
        front.drawn(&format!("{arrow}{pc:>4} {bracket}"), class, &format!(" {text}"), pc == here)
    };
    Ok(Answer::lines(pcs.map(line).collect()))
}

/// The class of an instruction alone.
fn class_of(module: &Module, pc: u32) -> Option<Standing> {
    Some(match module.code.get(pc as usize)?.info().class {
        Class::Always => Standing::Always,
        Class::AfterForward(_) => Standing::AfterForward,
        Class::Never(_) => Standing::Never,
    })
}
