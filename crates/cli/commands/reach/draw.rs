//! The picture: the source with the class of each line in the margin, the stretches as brackets,
//! and the horizons as lines across; and the table of the stretches below.

use super::page::{Line, Page, Row};
use obverse_reach::Standing;
use std::fmt::Write;

/// What the picture is drawn with.
pub(super) struct Pens {
    always: char,
    after_forward: char,
    never: char,
    top: char,
    side: char,
    foot: char,
    alone: char,
    across: char,
    perhaps: char,
}

impl Pens {
    /// As text terminals draw lines.
    pub(super) const LINES: Self = Self {
        always: '⇄',
        after_forward: '←',
        never: '✗',
        top: '╭',
        side: '│',
        foot: '╰',
        alone: '╶',
        across: '━',
        perhaps: '╍',
    };

    /// In ASCII.
    pub(super) const ASCII: Self = Self {
        always: '=',
        after_forward: '<',
        never: 'x',
        top: '/',
        side: '|',
        foot: '\\',
        alone: '-',
        across: '=',
        perhaps: '-',
    };

    pub(super) fn of(&self, standing: Standing) -> char {
        match standing {
            Standing::Always => self.always,
            Standing::AfterForward => self.after_forward,
            Standing::Never => self.never,
        }
    }

    /// The part of a bracket that is beside a line.
    pub(super) fn bracket(&self, edge: Edge) -> char {
        match edge {
            Edge::Top => self.top,
            Edge::Side => self.side,
            Edge::Foot => self.foot,
            Edge::Alone => self.alone,
            Edge::Nothing => ' ',
        }
    }
}

/// How long the lines of horizons are, with their reasons.
const ACROSS_COLUMNS: usize = 76;

/// How wide the lists of lines are at the most.
const LINES_COLUMNS: usize = 32;

/// What is drawn beside a line.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Edge {
    Top,
    Side,
    Foot,
    Alone,
    Nothing,
}

/// The picture of a page.
pub(super) fn picture(page: &Page, pens: &Pens) -> String {
    let digits = page.rows.iter().map(|row| row.number).max().unwrap_or(0).to_string().len();
    let letters = page.rows.iter().map(|row| names(&row.stretches()).len()).max().unwrap_or(0);
    let edges = edges(&page.rows);
    let mut drawn = String::new();
    for (row, edge) in page.rows.iter().zip(edges) {
        if row.is_after_gap {
            drawn.push('\n');
        }
        if let Some(heading) = &row.heading {
            let _ = writeln!(drawn, "{}{heading}", " ".repeat(digits + letters + 5));
        }
        let name = match edge {
            Edge::Top | Edge::Alone => names(&row.stretches()),
            Edge::Side | Edge::Foot | Edge::Nothing => String::new(),
        };
        let bracket = pens.bracket(edge);
        let class = row.standing().map_or(' ', |standing| pens.of(standing));
        let (number, text) = (row.number, row.text.as_str());
        let line = format!("{number:>digits$}  {name:>letters$}{bracket} {class} {text}");
        let _ = writeln!(drawn, "{}", line.trim_end());
        if let Some(line) = &row.horizon {
            let _ = writeln!(drawn, "{}{}", " ".repeat(digits + 2), across(line, letters, pens));
        }
    }
    drawn
}

/// A horizon: solid where it always is, broken where it may be.
fn across(line: &Line, letters: usize, pens: &Pens) -> String {
    let pen = if line.is_certain { pens.across } else { pens.perhaps };
    let draw = |columns: usize| std::iter::repeat_n(pen, columns).collect::<String>();
    let told = format!("{} {} ", draw(letters + 2), line.reason);
    let rest = ACROSS_COLUMNS.saturating_sub(told.chars().count()).max(3);
    told + &draw(rest)
}

/// The names of the stretches that the statements of a line are in.
fn names(stretches: &[usize]) -> String {
    stretches.iter().map(|&stretch| letter(stretch)).collect::<Vec<_>>().join(",")
}

/// A bracket: its first and last row, and the function and the stretch that it is of, if it is of
/// one alone.
type Bracket = (usize, usize, Option<(usize, usize)>);

/// A bracket is around lines of one function, one below the other, that can go back equally far.
/// A line whose statements cannot has one of its own.
pub(super) fn edges(rows: &[Row]) -> Vec<Edge> {
    let mut edges = vec![Edge::Nothing; rows.len()];
    let mut open: Option<Bracket> = None;
    let mut close = |open: Option<Bracket>| {
        let Some((first, last, _)) = open else { return };
        edges[first..=last].fill(Edge::Side);
        edges[first] = Edge::Top;
        edges[last] = if first == last { Edge::Alone } else { Edge::Foot };
    };
    for (at, row) in rows.iter().enumerate() {
        if let Some(statement) = row.statements.first() {
            let key = match row.stretches()[..] {
                [stretch] => Some((statement.function, stretch)),
                _ => None,
            };
            open = match open {
                Some((first, _, of)) if of.is_some() && of == key => Some((first, at, key)),
                before => {
                    close(before);
                    (!row.stretches().is_empty()).then_some((at, at, key))
                }
            };
        }
        if row.horizon.is_some() {
            close(open.take());
        }
    }
    close(open);
    edges
}

/// The name of a stretch: `A` to `Z`, then `AA`.
pub(super) fn letter(stretch: usize) -> String {
    let mut name = String::new();
    let mut rest = stretch + 1;
    while rest > 0 {
        rest -= 1;
        name.insert(0, char::from(b'A' + (rest % 26) as u8));
        rest /= 26;
    }
    name
}

/// What the signs mean, and how far back each stretch goes.
pub(super) fn table(page: &Page, pens: &Pens, what: &str) -> String {
    let mut told = String::new();
    let Pens { always, after_forward, never, .. } = pens;
    let _ = writeln!(
        told,
        "\n{always} always reversible   {after_forward} once run forward   {never} never\n"
    );
    let rows: Vec<Vec<String>> = lines(page).iter().map(|lines| folded(lines)).collect();
    let letters = rows.len().checked_sub(1).map_or(0, |last| letter(last).len());
    let columns = rows.iter().flatten().map(String::len).max().unwrap_or(0).max(what.len());
    let _ = writeln!(told, "{:letters$}  {what:columns$}  go back to", "");
    for (at, (lines, stretch)) in rows.iter().zip(&page.stretches).enumerate() {
        for row in 0..lines.len().max(stretch.ends.len()) {
            let name = if row == 0 { letter(at) } else { String::new() };
            let lines = lines.get(row).map_or("", String::as_str);
            let or = if row == 0 { "" } else { "or " };
            let end = stretch.ends.get(row).map_or(String::new(), |end| format!("{or}{end}"));
            let line = format!("{name:letters$}  {lines:columns$}  {end}");
            let _ = writeln!(told, "{}", line.trim_end());
        }
    }
    if page.rows.iter().any(|row| !row.statements.is_empty() && row.stretches().is_empty()) {
        let _ = writeln!(told, "Nothing ever comes to {what} without a bracket.");
    }
    told
}

/// A list, broken where it is too wide.
fn folded(list: &str) -> Vec<String> {
    let mut folded: Vec<String> = Vec::new();
    for item in list.split_inclusive(", ") {
        match folded.last_mut() {
            Some(last) if last.len() + item.trim_end().len() <= LINES_COLUMNS => *last += item,
            _ => folded.push(item.to_owned()),
        }
    }
    folded.iter_mut().for_each(|row| row.truncate(row.trim_end().len()));
    folded
}

/// The lines of each stretch: `12-15, 20`, those of each file after its name where there are
/// several. A line that does nothing does not part them.
fn lines(page: &Page) -> Vec<String> {
    let mut lines = vec![String::new(); page.stretches.len()];
    let mut named: Vec<Option<u16>> = vec![None; page.stretches.len()];
    let mut close = |(stretch, row, last): (usize, &Row, usize)| {
        let (told, first) = (&mut lines[stretch], row.number);
        let separator = if told.is_empty() { "" } else { ", " };
        let is_named = named[stretch].replace(row.file) == Some(row.file);
        let file = page.files.get(usize::from(row.file)).filter(|_| !is_named);
        let file = file.map_or(String::new(), |file| format!("{file}:"));
        let _ = match first == last {
            true => write!(told, "{separator}{file}{first}"),
            false => write!(told, "{separator}{file}{first}-{last}"),
        };
    };
    // The stretches of the row before, with the first and the last of their lines.
    let mut open: Vec<(usize, &Row, usize)> = Vec::new();
    for row in &page.rows {
        if row.is_after_gap {
            open.drain(..).for_each(&mut close);
        }
        if row.statements.is_empty() {
            continue;
        }
        let before = std::mem::take(&mut open);
        let first_of = |stretch: usize| before.iter().find(|one| one.0 == stretch).map(|one| one.1);
        open.extend(
            row.stretches()
                .into_iter()
                .map(|stretch| (stretch, first_of(stretch).unwrap_or(row), row.number)),
        );
        let is_over = |one: &&(usize, &Row, usize)| open.iter().all(|goes_on| goes_on.0 != one.0);
        before.iter().filter(is_over).copied().for_each(&mut close);
    }
    open.into_iter().for_each(close);
    lines
}
