//! The source and the instructions around where the session stands, with the class of each line.

use super::{Answer, Done, Front, stops};
use crate::commands::reach::margin::{Mark, sign};
use crate::story;
use crate::write::printable;
use obverse_bytecode::{FunctionKind, Module};
use obverse_debugger::SourcePlace;
use obverse_debugger::session::FrameView;
use obverse_isa::Class;
use obverse_reach::Standing;
use std::ops::Range;

/// How many lines are shown before and behind where the session stands.
const LINES_BEFORE: usize = 5;
const LINES: usize = 11;
/// The most instructions that are shown at once.
const MAX_INSTRUCTIONS: u32 = 10_000;

impl Front<'_> {
    /// The source file that the session stands in.
    pub(super) fn file_name(&self) -> Option<String> {
        Some(self.session.position().place?.file)
    }

    /// Where the session stands: line, class, what is next there, and in what.
    pub(super) fn place_line(&self) -> String {
        let position = self.session.position();
        self.line_at(position.pc, position.place)
    }

    /// The same of a call of a number. One that has called another stands at that call.
    pub(super) fn line_of(&self, number: usize, call: &FrameView) -> String {
        let pc = call.pc.saturating_sub(u32::from(number > 0));
        self.line_at(pc, call.place.clone())
    }

    fn line_at(&self, pc: u32, place: Option<SourcePlace>) -> String {
        let module = self.module;
        let function = module.function_at(pc).and_then(|at| module.functions.get(at));
        let within = match function.map(|function| (function.kind, &function.name)) {
            None | Some((FunctionKind::Start, _)) => String::new(),
            Some((FunctionKind::Replacement, _)) => "  (in reverse)".to_owned(),
            Some((_, name)) => format!("  ({name})"),
        };
        let said = story::said(module, pc);
        let place = place.filter(|_| !within.is_empty());
        let (number, class) = match &place {
            Some(place) => {
                let file = self.file_of(&place.file);
                let class = file.and_then(|file| self.margin.mark(file, place.line).class);
                let number = match module.sources.len() {
                    1 => place.line.to_string(),
                    _ => format!("{}:{}", place.file, place.line),
                };
                (number, class)
            }
            None if within.is_empty() => return self.bare_line(pc),
            None => (pc.to_string(), self.margin.mark(0, pc as usize).class),
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

    /// Lines of a file.
    fn lines_of(&self, file: u16, lines: Range<usize>) -> Vec<String> {
        let here = self.call().and_then(|call| call.place);
        let here = here.filter(|place| self.file_of(&place.file) == Some(file));
        let here = here.map(|place| place.line);
        let text = self.module.sources.get(usize::from(file)).map_or("", |source| &source.text);
        let lines = (1..).zip(text.lines()).skip(lines.start - 1).take(lines.len());
        let line = |(number, text): (usize, &str)| {
            let is_here = here == Some(number);
            let arrow = if is_here { '>' } else { ' ' };
            let Mark { bracket, class } = self.margin.mark(file, number);
            let before = format!("{arrow}{number:>4} {bracket}");
            self.drawn(&before, class, &format!(" {text}"), is_here)
        };
        lines.map(line).collect()
    }

    /// The file and the line that one looks at.
    fn here(&self) -> (u16, usize) {
        let place = self.call().and_then(|call| call.place);
        let file = place.as_ref().and_then(|place| self.file_of(&place.file));
        (file.unwrap_or(0), place.map_or(1, |place| place.line))
    }
}

/// Lines that were listed: what `list` goes on behind, and `list -` before.
pub(super) struct Listed {
    file: u16,
    lines: Range<usize>,
}

/// The lines around one.
fn around(line: usize) -> Range<usize> {
    let first = line.saturating_sub(LINES_BEFORE).max(1);
    first..first.saturating_add(LINES)
}

pub(super) fn list(front: &mut Front<'_>, rest: &str) -> Done {
    if front.module.source_map.is_empty() {
        return disassemble(front, rest);
    }
    let (file, lines) = match (rest, &front.listed) {
        ("", Some(listed)) => (listed.file, listed.lines.end..listed.lines.end + LINES),
        ("", None) => {
            let (file, line) = front.here();
            (file, around(line))
        }
        ("-", listed) => {
            let (file, line) = front.here();
            let before = listed.as_ref().map(|listed| (listed.file, listed.lines.start));
            let (file, end) = before.unwrap_or((file, around(line).start));
            if end == 1 {
                return Err("there is nothing before the first line".to_owned());
            }
            (file, end.saturating_sub(LINES).max(1)..end)
        }
        (asked, _) => asked_for(front, asked)?,
    };
    let shown = front.lines_of(file, lines.clone());
    if shown.is_empty() {
        front.listed = None;
        return Err(format!("there is no line {}", lines.start));
    }
    let lines = lines.start..lines.start + shown.len();
    front.listed = Some(Listed { file, lines });
    Ok(Answer::lines(shown))
}

/// The file and the lines of what is asked for: `LINE`, `FIRST,LAST` or a sequence, which may
/// follow a file and a `:`.
fn asked_for(front: &Front<'_>, asked: &str) -> Result<(u16, Range<usize>), String> {
    let (file, asked) = match asked.rsplit_once(':') {
        Some((file, asked)) => {
            (front.file_of(file).ok_or_else(|| format!("the program has no file `{file}`"))?, asked)
        }
        None => (front.here().0, asked),
    };
    let line = |text: &str| text.trim().parse::<usize>().ok().filter(|line| *line > 0);
    let present = |line: usize| {
        let source = front.module.sources.get(usize::from(file));
        let count = source.map_or(0, |source| source.text.lines().count());
        let missing = || format!("there is no line {line}: the last is {count}");
        (line <= count).then_some(line).ok_or_else(missing)
    };
    if let Some((first, last)) = asked.split_once(',') {
        let lines = match (line(first), line(last)) {
            (Some(first), Some(last)) if first <= last => present(first)?..last.saturating_add(1),
            (Some(first), None) if last.trim().is_empty() => {
                present(first)?..first.saturating_add(LINES)
            }
            (None, Some(last)) if first.trim().is_empty() => {
                let end = present(last)?.saturating_add(1);
                end.saturating_sub(LINES).max(1)..end
            }
            _ => return Err(format!("`{asked}` is no first and last line")),
        };
        return Ok((file, lines));
    }
    if let Some(line) = line(asked) {
        return Ok((file, around(present(line)?)));
    }
    let named = front.module.functions.iter().find(|function| function.name == asked);
    // What is in front of its first statement may be written nowhere.
    let first =
        named.and_then(|named| (named.first..named.end).find_map(|pc| front.module.place_of(pc)));
    let (name, line, _) = first.ok_or_else(|| format!("`{asked}` is no line, and no sequence"))?;
    Ok((front.file_of(name).unwrap_or(0), around(line)))
}

/// The instructions around this one; or so many from a place on: `/5i`, `/5i PLACE`, `PLACE`.
pub(super) fn disassemble(front: &mut Front<'_>, rest: &str) -> Done {
    let here = front.session.machine().state().pc();
    let (format, place) = match rest.strip_prefix('/') {
        Some(rest) => rest.split_once(char::is_whitespace).unwrap_or((rest, "")),
        None => ("", rest),
    };
    let count = match format.strip_suffix('i').unwrap_or(format) {
        "" => LINES as u32,
        count => match count.parse() {
            Ok(count @ 1..=MAX_INSTRUCTIONS) => count,
            _ => return Err(format!("`/{format}` is no count of instructions, as `x/5i` has one")),
        },
    };
    let first = match (format, place.trim()) {
        ("", "") => here.saturating_sub(LINES_BEFORE as u32),
        (_, "") => here,
        (_, place) => {
            let (places, _) = stops::places(front, place)?;
            places.pcs.first().copied().ok_or_else(|| format!("`{place}` has no instruction"))?
        }
    };
    let pcs = first..first.saturating_add(count).min(front.module.code.len() as u32);
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
