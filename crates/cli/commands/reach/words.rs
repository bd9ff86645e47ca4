//! How instructions and horizons are called: by their source lines, or by their numbers.

use obverse_bytecode::{Function, FunctionKind, Module, SourceEntry};
use obverse_isa::Instr;
use obverse_reach::{Horizon, Link, Reach, Verdict, Way};
use std::collections::HashSet;

pub(super) struct Words<'m> {
    pub(super) module: &'m Module,
    /// For each source file, where its lines begin.
    lines: Vec<Vec<usize>>,
    /// The first instructions of entries that end what an earlier one of the same place began.
    ends: HashSet<u32>,
}

impl<'m> Words<'m> {
    pub(super) fn new(module: &'m Module) -> Self {
        let lines = module.sources.iter().map(|source| {
            let breaks = source.text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
            std::iter::once(0).chain(breaks.map(|(at, _)| at + 1)).collect()
        });
        let mut begun = HashSet::new();
        let is_end = |entry: &&SourceEntry| {
            let instr = module.code[entry.first as usize];
            let function = module.function_at(entry.first);
            matches!(instr, Instr::Irreversible { .. })
                && !begun.insert((function, entry.file, entry.start, entry.end))
        };
        let ends = module.source_map.iter().filter(is_end).map(|entry| entry.first).collect();
        Self { module, lines: lines.collect(), ends }
    }

    /// Whether the module says what was written where.
    pub(super) fn has_source(&self) -> bool {
        !self.module.source_map.is_empty()
    }

    /// The name of a source file, if there are several.
    pub(super) fn name_of_file(&self, file: u16) -> Option<&'m str> {
        let sources = &self.module.sources;
        let source = sources.get(usize::from(file)).filter(|_| sources.len() > 1)?;
        Some(&source.name)
    }

    /// The source line of an instruction, from 1.
    pub(super) fn place(&self, pc: u32) -> Option<(u16, usize)> {
        let entry = self.module.source_at(pc)?;
        let lines = self.lines.get(usize::from(entry.file))?;
        Some((entry.file, lines.partition_point(|&begin| begin <= entry.start as usize)))
    }

    /// The file of a function, and its first and last line.
    pub(super) fn lines_of(&self, function: &Function) -> Option<(u16, usize, usize)> {
        let ((file, first), (other, last)) =
            (self.place(function.first)?, self.place(function.end - 1)?);
        (file == other).then_some((file, first, last))
    }

    /// The text of a source line.
    pub(super) fn line(&self, file: u16, number: usize) -> Option<&'m str> {
        let lines = self.lines.get(usize::from(file))?;
        let text = &self.module.sources.get(usize::from(file))?.text;
        let begin = *lines.get(number.checked_sub(1)?)?;
        let end = lines.get(number).map_or(text.len(), |next| next - 1);
        text.get(begin..end).map(|line| line.trim_end_matches('\r'))
    }

    /// What is written at an entry.
    pub(super) fn said(&self, entry: &SourceEntry) -> &'m str {
        let file = self.module.sources.get(usize::from(entry.file));
        let text = file.and_then(|file| file.text.get(entry.start as usize..entry.end as usize));
        text.unwrap_or("")
    }

    /// Where in its line an entry begins, in characters from 1.
    pub(super) fn column(&self, entry: &SourceEntry) -> usize {
        let lines = self.lines.get(usize::from(entry.file)).map_or(&[][..], Vec::as_slice);
        let line = lines.partition_point(|&begin| begin <= entry.start as usize).checked_sub(1);
        let begin = line.map_or(0, |line| lines[line]);
        let file = self.module.sources.get(usize::from(entry.file));
        let before = file.and_then(|file| file.text.get(begin..entry.start as usize));
        before.map_or(0, |before| before.chars().count()) + 1
    }

    /// Whether an entry is the later one of a block: both are written in its header.
    pub(super) fn is_end(&self, first: u32) -> bool {
        self.ends.contains(&first)
    }

    /// `line 7`, with the file where there are several; `instruction 7` without a source.
    pub(super) fn name(&self, pc: u32) -> String {
        match self.place(pc) {
            Some((_, line)) if self.module.sources.len() < 2 => format!("line {line}"),
            Some((file, line)) => {
                format!("{}:{line}", self.module.sources[usize::from(file)].name)
            }
            None => format!("instruction {pc}"),
        }
    }

    /// The same with what stands there.
    pub(super) fn statement(&self, pc: u32) -> String {
        format!("{} `{}`", self.name(pc), crate::story::said(self.module, pc))
    }

    /// `sequence main`
    pub(super) fn function(&self, function: usize) -> String {
        let Some(function) = self.module.functions.get(function) else { return String::new() };
        let kind = match function.kind {
            FunctionKind::Start => return "the start".to_owned(),
            FunctionKind::Replacement => return "a block run in reverse".to_owned(),
            FunctionKind::Cleanup => return "the cleanup".to_owned(),
            FunctionKind::Sequence => "sequence",
            FunctionKind::Action => "action",
            FunctionKind::Io => "io",
            FunctionKind::AdvancedMove => "advanced move",
        };
        format!("{kind} {}", function.name)
    }

    /// Where going back ends.
    pub(super) fn end(&self, reach: &Reach<'_>, horizon: Horizon) -> String {
        let Horizon::Never(pc) = horizon else { return "the start".to_owned() };
        let is_begin = matches!(self.module.code[pc as usize], Instr::Irreversible { .. })
            && self.module.source_at(pc).is_some_and(|entry| !self.is_end(entry.first));
        let side = if is_begin { "just inside" } else { "just after" };
        format!("{side} {}: {}", self.name(pc), reach.reason(pc))
    }

    /// Where going back from a point may end, each once.
    pub(super) fn ends(&self, reach: &Reach<'_>, verdict: &Verdict) -> Vec<String> {
        let mut ends: Vec<String> = Vec::new();
        for &horizon in &verdict.horizons {
            let end = self.end(reach, horizon);
            if !ends.contains(&end) {
                ends.push(end);
            }
        }
        if verdict.is_more {
            ends.push("and others".to_owned());
        }
        ends
    }

    /// The reasons of horizons, each once.
    pub(super) fn reasons(&self, reach: &Reach<'m>, horizons: &[Horizon]) -> Vec<&'m str> {
        let mut reasons = Vec::new();
        for horizon in horizons {
            let Horizon::Never(pc) = *horizon else { continue };
            let reason = reach.reason(pc);
            if !reasons.contains(&reason) {
                reasons.push(reason);
            }
        }
        reasons
    }

    /// How going back comes to its end, a line a step.
    pub(super) fn way(&self, way: &Way) -> Vec<String> {
        let step = |link: &Link| match *link {
            Link::CalledFrom(pc) => {
                let function = self.called(pc);
                format!("out of {function}, to before {}", self.statement(pc))
            }
            Link::Within(pc) => {
                format!("back into {}, by {}", self.called(pc), self.statement(pc))
            }
            Link::InPlaceOf(pc) => {
                format!("on to before the block that it replaces, {}", self.statement(pc))
            }
            Link::Beside(pc) => {
                format!("back over turns of another branch of {}", self.statement(pc))
            }
            Link::Again(pc) => format!("back into the round before: {}", self.begun_again(pc)),
        };
        let last = match way.horizon {
            Horizon::Start => "to the start of the program".to_owned(),
            Horizon::Never(pc) => format!("to {}, which is not taken back", self.statement(pc)),
        };
        // The start calls the first sequence without a word.
        let is_written = |link: &&Link| match **link {
            Link::CalledFrom(pc) | Link::Within(pc) | Link::InPlaceOf(pc) | Link::Beside(pc) => {
                self.module.function_at(pc).is_some_and(|function| function > 0)
            }
            Link::Again(_) => true,
        };
        way.links.iter().filter(is_written).map(step).chain([last]).collect()
    }

    /// What has begun again at this join.
    fn begun_again(&self, pc: u32) -> String {
        let function = self.module.function_at(pc).unwrap_or(0);
        let place = |pc| self.module.source_at(pc).map(|entry| (entry.file, entry.start));
        match function {
            0 => "the program has begun again".to_owned(),
            _ if place(pc) == place(self.module.functions[function].first) => {
                format!("{} has begun again", self.function(function))
            }
            _ => self.statement(pc),
        }
    }

    fn called(&self, pc: u32) -> String {
        match self.module.code[pc as usize] {
            Instr::Call { function, .. } => self.function(function.index()),
            _ => String::new(),
        }
    }
}
