//! Code as text: one line an instruction, and around it labels, prefixes and source lines. Knows
//! nothing of the tables of a module.

use super::names::{Found, Names, Scope, is_named};
use super::quote::{excerpt, is_bare, is_short, quoted};
use super::words::{self, Word};
use crate::builder::with_prefix;
use crate::module::{Function, Module, SourceEntry};
use obverse_isa::{Class, Instr, Opcode, OperandKind, Prefix};
use std::fmt::Write;
use std::ops::Range;

/// Where the comments of effects begin, if the instruction is not longer.
const COMMENT_COLUMN: usize = 44;

/// An operand that names an entry of a table: its name where it is one, and otherwise its index.
pub(super) fn name(scope: &Scope, kind: OperandKind, at: usize) -> String {
    let index = format!("#{at}");
    let Some(name) = scope.name(kind, at).filter(|name| is_short(name)) else { return index };
    let is_unique = scope.find(kind, name) == Some(Found::One(at));
    // A reason is prose, also where it is one word.
    let is_word = is_bare(name) && kind != OperandKind::Reason;
    match (is_word, is_unique) {
        (true, true) => name.to_owned(),
        (true, false) => name.to_owned() + &index,
        (false, true) => quoted(name),
        (false, false) => index,
    }
}

/// The instructions of one function, or of none.
pub(super) struct Section<'n, 'm> {
    scope: Scope<'n, 'm>,
    range: Range<usize>,
}

impl<'n, 'm> Section<'n, 'm> {
    /// The code of a function; a range that is not in the code is empty.
    pub(super) fn of_function(
        names: &'n Names<'m>,
        scope: &'m Module,
        function: &'m Function,
    ) -> Self {
        let range = function.first as usize..function.end as usize;
        let range = if scope.code.get(range.clone()).is_some() { range } else { 0..0 };
        Self { scope: Scope::new(names, Some(function)), range }
    }

    /// Code of no function.
    pub(super) fn of_none(names: &'n Names<'m>, range: Range<usize>) -> Self {
        Self { scope: Scope::new(names, None), range }
    }

    /// The instruction in one line: mnemonic and operands.
    pub(super) fn instruction(&self, instr: &Instr) -> String {
        let mut text = instr.info().mnemonic.to_owned();
        let mut separator = " ";
        instr.each_operand(&mut |kind, _, value| {
            if kind != OperandKind::Prefix {
                text.push_str(separator);
                text.push_str(&self.operand(instr.opcode(), kind, value));
                separator = ", ";
            }
        });
        text
    }

    fn operand(&self, opcode: Opcode, kind: OperandKind, value: i64) -> String {
        // Only numbers have a sign.
        let at = usize::try_from(value).unwrap_or_default();
        match kind {
            OperandKind::Label if self.range.contains(&at) => format!("L{at}"),
            OperandKind::Label => format!("#{at}"),
            OperandKind::Constant => self.constant(at),
            OperandKind::Level if opcode == Opcode::PushBool => (value != 0).to_string(),
            _ if is_named(kind) => name(&self.scope, kind, at),
            _ => words::choice_word(kind, value).map_or_else(|| value.to_string(), str::to_owned),
        }
    }

    fn constant(&self, at: usize) -> String {
        let constant = self.scope.module.constants.get(at).copied();
        constant
            .filter(|&constant| self.scope.names.constant(constant) == Some(Found::One(at)))
            .map_or_else(|| format!("#{at}"), words::constant)
    }

    /// What the assembly text says of the class of an effect.
    fn class(&self, instr: &Instr) -> String {
        let reason = match *instr {
            Instr::Barrier { reason } | Instr::Irreversible { reason } => {
                self.scope.name(OperandKind::Reason, reason.index())
            }
            _ => None,
        };
        match instr.info().class {
            Class::Never(why) => format!("never: {}", excerpt(reason.unwrap_or(why))),
            class => class.to_string(),
        }
    }

    /// Write all instructions, each with what belongs before it.
    pub(super) fn write(&self, source: &SourceComments, out: &mut String) {
        let targets = self.targets();
        let mut prefix = 0;
        for at in self.range.clone() {
            let instr = &self.scope.module.code[at];
            source.write(at, out);
            if targets[at - self.range.start] {
                let _ = writeln!(out, "L{at}:");
            }
            if instr.info().family.is_pure() {
                prefix += 1;
                let _ = writeln!(out, "        {}", self.instruction(instr));
                continue;
            }
            if with_prefix(*instr, counted_prefix(prefix)) != *instr {
                let _ = writeln!(out, "    .prefix {}", instr.prefix());
            }
            prefix = 0;
            let line = format!("    {}", self.instruction(instr));
            let _ = writeln!(out, "{line:COMMENT_COLUMN$}  ; {}", self.class(instr));
        }
    }

    /// Which instructions of the section are named by one of it.
    fn targets(&self) -> Vec<bool> {
        let mut targets = vec![false; self.range.len()];
        for instr in &self.scope.module.code[self.range.clone()] {
            instr.each_operand(&mut |kind, _, value| {
                let at = usize::try_from(value).unwrap_or_default();
                if kind == OperandKind::Label && self.range.contains(&at) {
                    targets[at - self.range.start] = true;
                }
            });
        }
        targets
    }
}

/// The prefix operand of an effect after so many pure instructions. More than fit are refused by
/// the verifier.
pub(super) fn counted_prefix(pure: usize) -> Prefix {
    Prefix(u8::try_from(pure).unwrap_or(u8::MAX))
}

/// The entries of a source map as lines of assembly text, with the source in comments.
pub(super) struct SourceComments<'m> {
    module: &'m Module,
    /// For each source file, where its lines begin.
    lines: Vec<Vec<usize>>,
    /// Whether each entry can stand before its instruction.
    pub(super) is_inline: bool,
}

impl<'m> SourceComments<'m> {
    pub(super) fn new(module: &'m Module) -> Self {
        let line_starts = |text: &str| {
            let after = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
            std::iter::once(0).chain(after.map(|(at, _)| at + 1)).collect()
        };
        let lines = module.sources.iter().map(|source| line_starts(&source.text)).collect();
        let map = &module.source_map;
        let is_inline = map.is_sorted_by_key(|entry| entry.first)
            && map.last().is_none_or(|last| last.first as usize <= module.code.len());
        Self { module, lines, is_inline }
    }

    /// Write the entries that begin at an instruction.
    pub(super) fn write(&self, at: usize, out: &mut String) {
        if !self.is_inline {
            return;
        }
        let map = &self.module.source_map;
        let first = map.partition_point(|entry| (entry.first as usize) < at);
        for entry in map[first..].iter().take_while(|entry| entry.first as usize == at) {
            let line = format!("  @ {}", numbers(entry));
            let _ = match self.source_line(entry) {
                Some(source) => writeln!(out, "{line:COMMENT_COLUMN$}  ; {source}"),
                None => writeln!(out, "{line}"),
            };
        }
    }

    /// Write every entry with the instruction that it begins at.
    pub(super) fn write_map(&self, out: &mut String) {
        for entry in &self.module.source_map {
            let _ = writeln!(out, ".map {} {}", entry.first, numbers(entry));
        }
    }

    fn source_line(&self, entry: &SourceEntry) -> Option<String> {
        let text = &self.module.sources.get(usize::from(entry.file))?.text;
        let lines = &self.lines[usize::from(entry.file)];
        let start = entry.start as usize;
        let number = lines.partition_point(|&begin| begin <= start);
        let begin = *lines.get(number.checked_sub(1)?)?;
        let end = lines.get(number).copied().unwrap_or(text.len());
        let file = match self.module.sources.len() {
            1 => String::new(),
            _ => format!("{}:", excerpt(&self.module.sources[usize::from(entry.file)].name)),
        };
        (start <= text.len()).then(|| format!("{file}{number} | {}", excerpt(&text[begin..end])))
    }
}

/// An entry of the source map but for where it begins.
fn numbers(entry: &SourceEntry) -> String {
    let SourceEntry { first: _, file, start, end, action } = entry;
    let action = action.map(|action| format!(" {}", action.word())).unwrap_or_default();
    format!("{file} {start} {end}{action}")
}
