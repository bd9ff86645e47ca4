//! What is known of each line: its class, and how far back it can go. A line is one of the source
//! where the module carries it, and an instruction otherwise.

use super::words::Words;
use obverse_bytecode::{Module, text};
use obverse_isa::Instr;
use obverse_reach::statement::{does_something, point};
use obverse_reach::{Horizon, Reach, Standing, Verdict};
use std::collections::{BTreeMap, HashMap};

/// How far below its last statement the brace of a block is looked for.
const MAX_LINES_TO_BRACE: usize = 100;

/// All lines that hold code, and the stretches that they make up.
pub(super) struct Page {
    pub(super) rows: Vec<Row>,
    /// By what going back from them ends at.
    pub(super) stretches: Vec<Stretch>,
    /// The names of the source files, if there are several.
    pub(super) files: Vec<String>,
}

/// A line.
pub(super) struct Row {
    /// Which source file; that of the first where there are instructions only.
    pub(super) file: u16,
    /// Of the source, from 1; or of the instruction.
    pub(super) number: usize,
    pub(super) text: String,
    /// Whether lines are left out before this one.
    pub(super) is_after_gap: bool,
    /// What begins here, if the text does not say so.
    pub(super) heading: Option<String>,
    /// What stands there and does anything, in the order of the source.
    pub(super) statements: Vec<Statement>,
    /// What stops going back from behind this line that is on it.
    pub(super) horizon: Option<Line>,
}

/// A horizon that lies behind a line of the page.
pub(super) struct Line {
    /// Why there is no way back over it.
    pub(super) reason: String,
    /// Whether it is there whichever way led past the line.
    pub(super) is_certain: bool,
}

/// Something that is done on a line.
#[derive(Clone)]
pub(super) struct Statement {
    pub(super) function: usize,
    /// The instruction before which it is gone back from.
    pub(super) point: u32,
    /// Where in the line it begins, in characters from 1; 1 without a source.
    pub(super) column: usize,
    pub(super) standing: Standing,
    /// None if nothing ever comes there.
    pub(super) stretch: Option<usize>,
    /// Whether the story of a run tells of it.
    pub(super) is_action: bool,
}

impl Row {
    /// What is hardest to take back of it.
    pub(super) fn standing(&self) -> Option<Standing> {
        self.statements.iter().map(|statement| statement.standing).max()
    }

    /// The stretches of its statements, in their order, each once.
    pub(super) fn stretches(&self) -> Vec<usize> {
        let mut stretches = Vec::new();
        for stretch in self.statements.iter().filter_map(|statement| statement.stretch) {
            if !stretches.contains(&stretch) {
                stretches.push(stretch);
            }
        }
        stretches
    }
}

/// Points that can go back equally far.
pub(super) struct Stretch {
    pub(super) verdict: Verdict,
    /// Where going back from it ends.
    pub(super) ends: Vec<String>,
}

impl Page {
    pub(super) fn of(module: &Module, reach: &Reach<'_>, words: &Words<'_>) -> Self {
        let mut stretches = Stretches { reach, words, known: HashMap::new(), all: Vec::new() };
        let rows = if words.has_source() {
            Sheet::of(module, reach, words).rows(&mut stretches)
        } else {
            instructions(module, reach, &mut stretches)
        };
        let sources = module.sources.iter().filter(|_| module.sources.len() > 1);
        let files = sources.map(|source| source.name.clone()).collect();
        let mut page = Self { rows, stretches: stretches.all, files };
        page.sort();
        page
    }

    /// Those that go back furthest first.
    fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.stretches.len()).collect();
        order.sort_by_key(|&index| self.stretches[index].verdict.horizons.clone());
        let mut places = vec![0; order.len()];
        order.iter().enumerate().for_each(|(place, &index)| places[index] = place);
        for statement in self.rows.iter_mut().flat_map(|row| &mut row.statements) {
            statement.stretch = statement.stretch.map(|stretch| places[stretch]);
        }
        self.stretches.sort_by_key(|stretch| stretch.verdict.horizons.clone());
    }
}

/// The stretches found so far.
struct Stretches<'r, 'm> {
    reach: &'r Reach<'m>,
    words: &'r Words<'m>,
    known: HashMap<Vec<String>, usize>,
    all: Vec<Stretch>,
}

impl Stretches<'_, '_> {
    /// The stretch of a point, if anything comes there.
    fn of(&mut self, point: u32) -> Option<usize> {
        let verdict = self.reach.at(point);
        if verdict.horizons.is_empty() {
            return None;
        }
        let ends = self.words.ends(self.reach, &verdict);
        let next = self.all.len();
        let stretch = *self.known.entry(ends.clone()).or_insert(next);
        if stretch == next {
            self.all.push(Stretch { verdict, ends });
        }
        Some(stretch)
    }
}

/// The lines of all source files, with what stands on them.
struct Sheet<'m, 'w> {
    words: &'w Words<'m>,
    /// By line, and where they begin in the source.
    statements: HashMap<(u16, usize), BTreeMap<u32, Statement>>,
    /// The file, and the first and the last line, of each function.
    shown: Vec<(u16, usize, usize)>,
    /// By line: what may be left behind it that stops going back, and the last instruction.
    left: HashMap<(u16, usize), (Vec<Horizon>, u32)>,
}

impl<'m, 'w> Sheet<'m, 'w> {
    fn of(module: &'m Module, reach: &Reach<'m>, words: &'w Words<'m>) -> Self {
        let (statements, shown, left) = (HashMap::new(), Vec::new(), HashMap::new());
        let mut sheet = Self { words, statements, shown, left };
        // The start is written nowhere.
        for function in module.functions.iter().skip(1) {
            sheet.shown.extend(words.lines_of(function));
        }
        for (index, _) in module.source_map.iter().enumerate() {
            sheet.entry(module, reach, index);
        }
        sheet
    }

    fn entry(&mut self, module: &Module, reach: &Reach<'_>, index: usize) {
        let entry = &module.source_map[index];
        let Some(function) = module.function_at(entry.first).filter(|&function| function > 0)
        else {
            return;
        };
        let Some(place) = self.words.place(entry.first) else { return };
        let next = module.source_map.get(index + 1).map_or(u32::MAX, |next| next.first);
        let end = next.min(module.functions[function].end);
        let place = if self.words.is_end(entry.first) { self.end_of(module, index) } else { place };
        let (left, last) = self.left.entry(place).or_default();
        left.extend(reach.left_by(entry.first..end));
        *last = end - 1;
        let is_end = self.words.is_end(entry.first) || self.words.said(entry).starts_with('}');
        let code = &module.code[entry.first as usize..end as usize];
        if is_end || matches!(code[0], Instr::Enter {}) || !code.iter().any(does_something) {
            return;
        }
        let standing = reach.standing(entry.first..end);
        let (point, is_action) = (point(module, entry.first, end), entry.action.is_some());
        let column = self.words.column(entry);
        let statement = Statement { function, point, column, standing, stretch: None, is_action };
        let of_line = self.statements.entry(place).or_default();
        let known = of_line.entry(entry.start).or_insert(statement);
        known.standing = known.standing.max(standing);
        known.is_action |= is_action;
    }

    /// The line of the brace that ends a block, by its second entry: the last instruction of the
    /// block is on a line before it.
    fn end_of(&self, module: &Module, index: usize) -> (u16, usize) {
        let entry = &module.source_map[index];
        let (file, header) = self.words.place(entry.first).unwrap_or((entry.file, 1));
        let before = module.source_map[..index].iter().rev();
        let inner = before.take_while(|inner| (inner.start, inner.end) != (entry.start, entry.end));
        let lines = inner.filter_map(|inner| self.words.place(inner.first));
        let last = lines.filter(|&(of, _)| of == file).map(|(_, line)| line).max();
        let last = last.unwrap_or(header).max(header);
        let indent = |line: usize| {
            let text = self.words.line(file, line).unwrap_or("");
            text.len() - text.trim_start().len()
        };
        let is_brace = |&line: &usize| {
            let text = self.words.line(file, line).unwrap_or("");
            text.trim_start().starts_with('}') && indent(line) == indent(header)
        };
        let brace = (last..last + MAX_LINES_TO_BRACE).find(is_brace);
        (file, brace.unwrap_or(last))
    }

    fn rows(mut self, stretches: &mut Stretches<'_, '_>) -> Vec<Row> {
        self.shown.sort_unstable();
        let mut next = (0, 0);
        let mut places = Vec::new();
        for &(file, first, last) in &self.shown {
            // One function may stand within another, as a block that is run in reverse does.
            let first = if next.0 == file { first.max(next.1) } else { first };
            places.extend((first..=last).map(|line| (file, line)));
            next = (file, first.max(last + 1));
        }
        let mut rows: Vec<Row> = Vec::with_capacity(places.len());
        for (file, number) in places {
            let text = self.words.line(file, number).unwrap_or("").to_owned();
            let is_next = |last: &Row| last.file == file && last.number + 1 == number;
            let is_after_gap = !rows.last().is_none_or(is_next);
            let found = self.statements.remove(&(file, number)).unwrap_or_default();
            let mut statements: Vec<Statement> = found.into_values().collect();
            for statement in &mut statements {
                statement.stretch = stretches.of(statement.point);
            }
            let left = self.left.remove(&(file, number));
            let horizon = left.and_then(|(left, last)| line(stretches, &left, last));
            let is_other = rows.last().is_none_or(|last| last.file != file);
            let heading = self.words.name_of_file(file).filter(|_| is_other).map(str::to_owned);
            rows.push(Row { file, number, text, is_after_gap, heading, statements, horizon });
        }
        rows
    }
}

/// The horizon behind an instruction, if what has been left before it is what stops there.
fn line(stretches: &Stretches<'_, '_>, left: &[Horizon], last: u32) -> Option<Line> {
    let behind = stretches.reach.at(last + 1).horizons;
    let met: Vec<Horizon> = left.iter().copied().filter(|one| behind.contains(one)).collect();
    let reasons = stretches.words.reasons(stretches.reach, &met);
    let is_certain = behind.iter().all(|horizon| left.contains(horizon));
    (!reasons.is_empty()).then(|| Line { reason: reasons.join(", or "), is_certain })
}

/// A row an instruction.
fn instructions(module: &Module, reach: &Reach<'_>, stretches: &mut Stretches<'_, '_>) -> Vec<Row> {
    let mut rows = Vec::with_capacity(module.code.len());
    for (function, declared) in module.functions.iter().enumerate() {
        for pc in declared.first..declared.end {
            let instr = &module.code[pc as usize];
            let statement = does_something(instr).then(|| Statement {
                function,
                point: pc,
                column: 1,
                standing: reach.standing(pc..pc + 1),
                stretch: stretches.of(pc),
                is_action: false,
            });
            rows.push(Row {
                file: 0,
                number: pc as usize,
                text: text::instruction(module, pc).unwrap_or_default(),
                is_after_gap: pc == declared.first && function > 0,
                heading: (pc == declared.first).then(|| stretches.words.function(function)),
                statements: statement.into_iter().collect(),
                horizon: line(stretches, &reach.left_by(pc..pc + 1), pc),
            });
        }
    }
    rows
}
