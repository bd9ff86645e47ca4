//! Warnings that the program says are meant: `allow W0001 "why"`. Which statement, declaration or
//! file each is for, and which of them allow nothing. Knows nothing of what is warned about.

use crate::report::warning;
use obverse_syntax::ast::{Allow, Block, Item, Program, Statement};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::nearest;
use obverse_syntax::sources::Sources;
use obverse_syntax::span::Span;
use std::collections::HashMap;

/// A code that is allowed, and where.
#[derive(Debug)]
struct Allowed {
    code: Code,
    /// The `allow`, and what it is for.
    scope: Span,
    /// The `allow` itself.
    span: Span,
    /// The innermost one around it that is of the same code.
    around: Option<usize>,
    is_used: bool,
}

/// All that a program allows.
#[derive(Debug, Default)]
pub(crate) struct Allows {
    all: Vec<Allowed>,
    /// By code: those for a statement or a declaration, in the order of the text.
    scoped: HashMap<Code, Vec<usize>>,
    /// By code: those for a file, one a file, in the order of the files.
    of_file: HashMap<Code, Vec<usize>>,
    /// The mistakes in them.
    mistakes: Vec<Diagnostic>,
}

impl Allows {
    /// Those of a program.
    pub(crate) fn of(sources: &Sources, program: &Program<'_>) -> Self {
        let mut allows = Self::default();
        let mut waiting: Vec<&Allow<'_>> = Vec::new();
        let mut file = 0;
        // In the order of the text, whatever file each is of.
        let mut items: Vec<&Item<'_>> = program.items.iter().collect();
        items.sort_by_key(|item| item_end(item));
        for item in items {
            let end = item_end(item);
            let its_file = sources.locate(Span::new(end, end)).file;
            if std::mem::replace(&mut file, its_file) != its_file {
                allows.settle(&mut waiting, 0);
            }
            match item {
                Item::Allow(allow) => waiting.push(allow),
                _ => allows.settle(&mut waiting, end),
            }
            if let Item::Sequence(sequence) = item {
                allows.block(&sequence.body);
            }
        }
        allows.settle(&mut waiting, 0);
        allows.widen(sources);
        allows
    }

    /// Those for a file are for all of it; the first of a code is the one that counts.
    fn widen(&mut self, sources: &Sources) {
        for of_file in self.of_file.values_mut() {
            for &index in of_file.iter() {
                let range = sources.range(sources.locate(self.all[index].span).file);
                self.all[index].scope = Span::new(range.start as u32, range.end as u32);
            }
            of_file.dedup_by_key(|index| self.all[*index].scope);
        }
    }

    fn block(&mut self, block: &Block<'_>) {
        let mut waiting: Vec<&Allow<'_>> = Vec::new();
        for statement in &block.statements {
            match statement.allow() {
                Some(allow) => waiting.push(allow),
                None => self.settle(&mut waiting, statement.span.end),
            }
            self.within(statement);
        }
        self.settle(&mut waiting, 0);
    }

    fn within(&mut self, statement: &Statement<'_>) {
        for block in statement.blocks() {
            self.block(block);
        }
    }

    /// What the `allow`s before something are for is known: it ends here.
    fn settle(&mut self, waiting: &mut Vec<&Allow<'_>>, end: u32) {
        for allow in waiting.drain(..) {
            let Some(code) = self.code_of(allow) else { continue };
            let index = self.all.len();
            let scope = Span::new(allow.span.start, end.max(allow.span.end));
            let mut allowed =
                Allowed { code, scope, span: allow.span, around: None, is_used: false };
            if allow.in_file {
                self.of_file.entry(code).or_default().push(index);
            } else {
                let before = self.scoped.entry(code).or_default();
                allowed.around = before.last().copied();
                while let Some(around) = allowed.around
                    && self.all[around].scope.end <= scope.start
                {
                    allowed.around = self.all[around].around;
                }
                before.push(index);
            }
            self.all.push(allowed);
        }
    }

    /// The warning that is meant; a mistake is kept.
    fn code_of(&mut self, allow: &Allow<'_>) -> Option<Code> {
        let written = allow.code;
        let known: Option<Code> = written.value.parse().ok();
        let is_warning = |code: &Code| code.as_str().starts_with('W');
        if known.as_ref().is_some_and(is_warning) {
            return known;
        }
        let message = match known {
            Some(code) => format!("`{code}` is an error, and only warnings can be allowed"),
            None => format!("there is no warning `{}`", written.value),
        };
        let mut diagnostic =
            Diagnostic::error(Code::UnknownCode, written.span, message, "not a warning");
        let warnings = Code::ALL.iter().copied().filter(|code| is_warning(code));
        if let (None, Some(meant)) = (known, nearest(written.value, warnings.map(Code::as_str))) {
            diagnostic = diagnostic.did_you_mean(written.span, meant);
        }
        self.mistakes.push(diagnostic);
        None
    }

    /// The mistakes in them, once.
    pub(crate) fn take_mistakes(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.mistakes)
    }

    /// Whether a warning of this code at this place is meant. It is then used.
    pub(crate) fn permits(&mut self, code: Code, at: u32) -> bool {
        let scoped = self.scoped.get(&code).map_or(&[][..], Vec::as_slice);
        let before = scoped.partition_point(|&index| self.all[index].scope.start <= at);
        let mut candidate = before.checked_sub(1).map(|last| scoped[last]);
        while let Some(index) = candidate
            && self.all[index].scope.end <= at
        {
            candidate = self.all[index].around;
        }
        let found = candidate.or_else(|| self.for_file(code, at));
        if let Some(index) = found {
            self.all[index].is_used = true;
        }
        found.is_some()
    }

    /// The one for the file that a place is in.
    fn for_file(&self, code: Code, at: u32) -> Option<usize> {
        let of_file = self.of_file.get(&code)?;
        let before = of_file.partition_point(|&index| self.all[index].scope.start <= at);
        let last = of_file[before.checked_sub(1)?];
        (at <= self.all[last].scope.end).then_some(last)
    }

    /// A warning for each that allows nothing.
    pub(crate) fn useless(&self) -> Vec<Diagnostic> {
        let useless = self.all.iter().filter(|one| !one.is_used && one.code != Code::UselessAllow);
        let warn = |one: &Allowed| {
            let message = format!("this allows {}, and there is none", one.code);
            warning(Code::UselessAllow, one.span, message, "allows nothing")
                .with_help("leave it out")
                .replacing(one.span, "")
        };
        useless.map(warn).collect()
    }
}

/// Leave them out of a program, where they are of no use: what they say is of its own text.
pub(crate) fn leave_out(program: &mut Program<'_>) {
    program.items.retain(|item| !matches!(item, Item::Allow(_)));
    for item in &mut program.items {
        if let Item::Sequence(sequence) = item {
            leave_out_of(&mut sequence.body);
        }
    }
}

fn leave_out_of(block: &mut Block<'_>) {
    block.statements.retain(|statement| statement.allow().is_none());
    for statement in &mut block.statements {
        statement.blocks_mut().into_iter().for_each(leave_out_of);
    }
}

fn item_end(item: &Item<'_>) -> u32 {
    match item {
        Item::Cell(path) => path.span.end,
        Item::Import(import) => import.path.span.end,
        Item::Signal(entry) => entry.span.end,
        Item::Io(io) => io.span.end,
        Item::Joints(joints) => joints.span.end,
        Item::ItemDeclaration(item) => item.span.end,
        Item::Error(error) => error.span.end,
        Item::AdvancedMove(guarded) => guarded.span.end,
        Item::Variable(variable) => variable.span.end,
        Item::Sequence(sequence) => sequence.span.end,
        Item::Cleanup(cleanup) => cleanup.span.end,
        Item::Allow(allow) => allow.span.end,
    }
}
