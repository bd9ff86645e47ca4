//! What is known of going back: the class of each statement, and where going back from it ends. It
//! is of the newest text that compiled, and is carried to a later one as far as that is the same.

use crate::position::Lines;
use obverse_bytecode::{Module, SourceEntry};
use obverse_isa::Instr;
use obverse_reach::statement::{does_something, point};
use obverse_reach::{Horizon, Reach, Standing, Verdict};
use obverse_syntax::sources::Sources;
use obverse_syntax::span::Span;
use std::collections::{HashMap, HashSet};

/// A place of a program by the name of its file.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Spot {
    /// Which file, as an index into [`Steps`]' own.
    file: usize,
    /// Where in it.
    span: Span,
}

/// Where going back ends.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum End {
    /// At the start of the program.
    Start,
    /// At what cannot be taken back.
    Never {
        /// Where that is written, if it is written.
        spot: Option<Spot>,
        /// Why, in the program's words where it has some.
        reason: String,
        /// Whether going back ends inside of the block that is written there.
        is_inside: bool,
    },
}

/// Where going back from a point may end.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Ends {
    /// Each; none where nothing ever comes.
    pub(crate) ends: Vec<End>,
    /// Whether there are others.
    pub(crate) is_more: bool,
}

/// A statement that does something.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    spot: Spot,
    /// Its class.
    pub(crate) standing: Standing,
    /// Whether a story tells of it.
    pub(crate) is_action: bool,
    /// An index into [`Steps`]' own.
    ends: usize,
}

/// What is known of a sequence, an action, an I/O operation or an advanced move as a whole.
#[derive(Clone, Debug)]
pub(crate) struct Whole {
    /// Its class.
    pub(crate) standing: Standing,
    /// What it may leave behind it that stops going back; nothing if it can be taken back whole.
    pub(crate) left: Ends,
}

/// All that is known of going back in a program.
#[derive(Clone, Debug, Default)]
pub(crate) struct Steps {
    /// The files that it is known of.
    files: Vec<File>,
    /// In the order of the files.
    steps: Vec<Step>,
    ends: Vec<Ends>,
    functions: HashMap<String, Whole>,
}

impl Steps {
    /// Of a module that the compiler made.
    pub(crate) fn of(module: &Module) -> Self {
        let reach = Reach::of(module);
        let files = module.sources.iter().map(|file| File::new(&file.name, &file.text));
        let mut steps = Self { files: files.collect(), ..Self::default() };
        let blocks = Blocks::of(module);
        let mut known: HashMap<Ends, usize> = HashMap::new();
        let mut by_place: HashMap<(u16, u32), Step> = HashMap::new();
        for (index, entry) in module.source_map.iter().enumerate() {
            let Some((first, end)) = range_of(module, index) else { continue };
            let code = &module.code[first as usize..end as usize];
            let is_end = blocks.is_end(first) || steps.said(entry).starts_with('}');
            if is_end || matches!(code[0], Instr::Enter {}) || !code.iter().any(does_something) {
                continue;
            }
            let standing = reach.standing(first..end);
            let ends = blocks.ends(module, &reach, &reach.at(point(module, first, end)));
            let next = known.len();
            let ends = *known.entry(ends).or_insert(next);
            let spot = spot(entry);
            let is_action = entry.action.is_some();
            let step = Step { spot, standing, is_action, ends };
            let first = by_place.entry((entry.file, entry.start)).or_insert(step);
            first.standing = first.standing.max(standing);
            first.is_action |= is_action;
        }
        let mut ends: Vec<(Ends, usize)> = known.into_iter().collect();
        ends.sort_unstable_by_key(|(_, index)| *index);
        steps.ends = ends.into_iter().map(|(ends, _)| ends).collect();
        steps.steps = by_place.into_values().collect();
        steps.steps.sort_by_key(|step| (step.spot.file, step.spot.span));
        for function in module.functions.iter().skip(1) {
            let range = function.first..function.end;
            let horizons = reach.left_by(range.clone());
            let left = blocks.ends(module, &reach, &Verdict { horizons, is_more: false });
            let whole = Whole { standing: reach.standing(range), left };
            steps.functions.insert(function.name.clone(), whole);
        }
        steps
    }

    /// The same of a later text of the program: what lies where the texts are the same, from the
    /// beginning of each file and from its end.
    pub(crate) fn carried_to(&self, sources: &Sources) -> Self {
        let shifts: Vec<Option<Shift>> =
            self.files.iter().map(|file| Shift::of(&file.name, &file.text, sources)).collect();
        let carried = |spot: &Spot| {
            let span = shifts.get(spot.file)?.as_ref()?.span(spot.span)?;
            Some(Spot { file: spot.file, span })
        };
        let of_end = |end: &End| match end {
            End::Never { spot: Some(spot), reason, is_inside } => {
                let (reason, is_inside) = (reason.clone(), *is_inside);
                End::Never { spot: carried(spot), reason, is_inside }
            }
            end => end.clone(),
        };
        let of_ends = |ends: &Ends| Ends {
            ends: ends.ends.iter().map(of_end).collect(),
            is_more: ends.is_more,
        };
        let step = |step: &Step| Some(Step { spot: carried(&step.spot)?, ..step.clone() });
        let files = self.files.iter().map(|before| {
            let now = file_named(sources, &before.name).map(|file| sources.text(file));
            File::new(&before.name, now.unwrap_or(&before.text))
        });
        let functions = self.functions.iter().map(|(name, whole)| {
            (name.clone(), Whole { left: of_ends(&whole.left), ..whole.clone() })
        });
        Self {
            files: files.collect(),
            steps: self.steps.iter().filter_map(step).collect(),
            ends: self.ends.iter().map(of_ends).collect(),
            functions: functions.collect(),
        }
    }

    /// The statements of a file, with their places in it.
    pub(crate) fn of_file<'s>(&'s self, name: &str) -> impl Iterator<Item = (Span, &'s Step)> {
        let file = self.files.iter().position(|known| known.name == name);
        let steps = self.steps.iter().filter(move |step| Some(step.spot.file) == file);
        steps.map(|step| (step.spot.span, step))
    }

    /// Where going back from before a statement may end.
    pub(crate) fn ends_of(&self, step: &Step) -> Option<&Ends> {
        self.ends.get(step.ends)
    }

    /// What is known of a sequence, an action, an I/O operation or an advanced move.
    pub(crate) fn function(&self, name: &str) -> Option<&Whole> {
        self.functions.get(name)
    }

    /// Where going back from a point ends, in words that follow "goes back".
    pub(crate) fn words(&self, ends: &Ends, seen_from: &str) -> String {
        let mut words: Vec<String> = Vec::new();
        for end in &ends.ends {
            let one = self.end_in_words(end, seen_from);
            if !words.contains(&one) {
                words.push(one);
            }
        }
        if ends.is_more {
            words.push("elsewhere".to_owned());
        }
        words.join(", or ")
    }

    fn end_in_words(&self, end: &End, seen_from: &str) -> String {
        let End::Never { spot, reason, is_inside } = end else {
            return "to the start of the program".to_owned();
        };
        let side = if *is_inside { "just inside" } else { "just after" };
        match spot {
            Some(spot) => format!("to {side} {}: {reason}", self.line_of(spot, seen_from)),
            None => format!("to where it cannot be taken back: {reason}"),
        }
    }

    /// What stops going back, in words: `line 12: press fit`.
    pub(crate) fn stops(&self, ends: &Ends, seen_from: &str) -> Vec<String> {
        let stop = |end: &End| match end {
            End::Start => None,
            End::Never { spot: Some(spot), reason, .. } => {
                Some(format!("{}: {reason}", self.line_of(spot, seen_from)))
            }
            End::Never { spot: None, reason, .. } => Some(reason.clone()),
        };
        let mut stops: Vec<String> = Vec::new();
        for stop in ends.ends.iter().filter_map(stop) {
            if !stops.contains(&stop) {
                stops.push(stop);
            }
        }
        stops
    }

    /// `line 12`, with the file where it is another one.
    fn line_of(&self, spot: &Spot, seen_from: &str) -> String {
        let Some(file) = self.files.get(spot.file) else { return String::new() };
        let line = file.lines.line_of(spot.span.start) + 1;
        match file.name == seen_from {
            true => format!("line {line}"),
            false => format!("line {line} of {}", file.name),
        }
    }

    fn said(&self, entry: &SourceEntry) -> &str {
        let text = self.files.get(usize::from(entry.file)).map_or("", |file| &file.text);
        text.get(entry.start as usize..entry.end as usize).unwrap_or("")
    }
}

/// A file that something is known of.
#[derive(Clone, Debug)]
struct File {
    name: String,
    text: String,
    lines: Lines,
}

impl File {
    fn new(name: &str, text: &str) -> Self {
        Self { name: name.to_owned(), text: text.to_owned(), lines: Lines::new(text) }
    }
}

fn file_named(sources: &Sources, name: &str) -> Option<usize> {
    (0..sources.len()).find(|file| sources.name(*file) == name)
}

fn spot(entry: &SourceEntry) -> Spot {
    Spot { file: usize::from(entry.file), span: Span::new(entry.start, entry.end) }
}

/// The instructions of an entry of the source map; none of the start, which is written nowhere.
fn range_of(module: &Module, index: usize) -> Option<(u32, u32)> {
    let first = module.source_map[index].first;
    let function = module.function_at(first).filter(|&function| function > 0)?;
    let next = module.source_map.get(index + 1).map_or(u32::MAX, |next| next.first);
    let end = next.min(module.functions[function].end);
    (first < end).then_some((first, end))
}

/// Blocks that cannot be taken back: both of their ends are written in their head.
struct Blocks {
    /// The first instructions of the entries that end one.
    ends: HashSet<u32>,
}

impl Blocks {
    fn of(module: &Module) -> Self {
        let mut begun = HashSet::new();
        let is_end = |entry: &&SourceEntry| {
            let instr = module.code[entry.first as usize];
            let function = module.function_at(entry.first);
            matches!(instr, Instr::Irreversible { .. })
                && !begun.insert((function, entry.file, entry.start, entry.end))
        };
        Self { ends: module.source_map.iter().filter(is_end).map(|entry| entry.first).collect() }
    }

    fn is_end(&self, first: u32) -> bool {
        self.ends.contains(&first)
    }

    fn ends(&self, module: &Module, reach: &Reach<'_>, verdict: &Verdict) -> Ends {
        let end = |horizon: &Horizon| {
            let Horizon::Never(pc) = *horizon else { return End::Start };
            let entry = module.source_at(pc);
            let is_block = matches!(module.code[pc as usize], Instr::Irreversible { .. });
            let is_inside = is_block && entry.is_some_and(|entry| !self.is_end(entry.first));
            End::Never { spot: entry.map(spot), reason: reach.reason(pc).to_owned(), is_inside }
        };
        Ends { ends: verdict.horizons.iter().map(end).collect(), is_more: verdict.is_more }
    }
}

/// How a file has changed: what is the same at its beginning, and at its end.
struct Shift {
    same_before: u32,
    same_after: u32,
    length_before: u32,
    length_now: u32,
}

impl Shift {
    fn of(name: &str, before: &str, sources: &Sources) -> Option<Self> {
        let now = sources.text(file_named(sources, name)?);
        let pairs = before.bytes().zip(now.bytes());
        let same_before = pairs.take_while(|(a, b)| a == b).count();
        let most = before.len().min(now.len()) - same_before;
        let pairs = before.bytes().rev().zip(now.bytes().rev());
        let same_after = pairs.take(most).take_while(|(a, b)| a == b).count();
        let short = |length: usize| u32::try_from(length).ok();
        Some(Self {
            same_before: short(same_before)?,
            same_after: short(same_after)?,
            length_before: short(before.len())?,
            length_now: short(now.len())?,
        })
    }

    /// Where a span is now, if it lies within what is the same.
    fn span(&self, span: Span) -> Option<Span> {
        let first_after = self.length_before - self.same_after;
        if span.end <= self.same_before {
            Some(span)
        } else if span.start >= first_after {
            let now = |offset: u32| self.length_now - (self.length_before - offset);
            Some(Span::new(now(span.start), now(span.end)))
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_the_same_at_both_ends_is_carried() {
        let sources = Sources::one("a", "one TWO2 three");
        let shift = Shift::of("a", "one two three", &sources).expect("the file is there");
        assert_eq!(shift.span(Span::new(0, 3)), Some(Span::new(0, 3)));
        assert_eq!(shift.span(Span::new(8, 13)), Some(Span::new(9, 14)));
        assert_eq!(shift.span(Span::new(4, 7)), None);
        assert!(Shift::of("b", "", &sources).is_none());
        // What is repeated is not counted twice.
        let sources = Sources::one("a", "aa");
        let shift = Shift::of("a", "aaa", &sources).expect("the file is there");
        assert_eq!((shift.same_before, shift.same_after), (2, 0));
    }
}
