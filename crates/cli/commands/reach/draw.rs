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

    fn of(&self, standing: Standing) -> char {
        match standing {
            Standing::Always => self.always,
            Standing::AfterForward => self.after_forward,
            Standing::Never => self.never,
        }
    }
}

/// How long the lines of horizons are, with their reasons.
const ACROSS_COLUMNS: usize = 76;

/// What is drawn beside a line.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Edge {
    Top,
    Side,
    Foot,
    Alone,
    Nothing,
}

/// The picture of a page.
pub(super) fn picture(page: &Page, pens: &Pens) -> String {
    let digits = page.rows.iter().map(|row| row.number).max().unwrap_or(0).to_string().len();
    let letters = page.stretches.len().checked_sub(1).map_or(0, |last| letter(last).len());
    let edges = edges(&page.rows);
    let mut drawn = String::new();
    for (row, edge) in page.rows.iter().zip(edges) {
        if row.is_after_gap {
            drawn.push('\n');
        }
        if let Some(heading) = &row.heading {
            let _ = writeln!(drawn, "{}{heading}", " ".repeat(digits + letters + 5));
        }
        let stretch = row.statement.as_ref().and_then(|statement| statement.stretch);
        let name = match (edge, stretch) {
            (Edge::Top | Edge::Alone, Some(stretch)) => letter(stretch),
            _ => String::new(),
        };
        let bracket = match edge {
            Edge::Top => pens.top,
            Edge::Side => pens.side,
            Edge::Foot => pens.foot,
            Edge::Alone => pens.alone,
            Edge::Nothing => ' ',
        };
        let class = row.statement.as_ref().map_or(' ', |statement| pens.of(statement.standing));
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

/// A bracket is around lines of one function, one below the other, that can go back equally far.
fn edges(rows: &[Row]) -> Vec<Edge> {
    let mut edges = vec![Edge::Nothing; rows.len()];
    // The first and the last line of the bracket that is open, and whose it is.
    let mut open: Option<(usize, usize, (usize, usize))> = None;
    let mut close = |open: Option<(usize, usize, (usize, usize))>| {
        let Some((first, last, _)) = open else { return };
        edges[first..=last].fill(Edge::Side);
        edges[first] = Edge::Top;
        edges[last] = if first == last { Edge::Alone } else { Edge::Foot };
    };
    for (at, row) in rows.iter().enumerate() {
        if let Some(statement) = &row.statement {
            let key = statement.stretch.map(|stretch| (statement.function, stretch));
            open = match (open, key) {
                (Some((first, _, of)), Some(key)) if of == key => Some((first, at, key)),
                (before, key) => {
                    close(before);
                    key.map(|key| (at, at, key))
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
    let rows: Vec<(String, String)> =
        (0..page.stretches.len()).map(|index| (letter(index), lines(page, index))).collect();
    let letters = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let columns = rows.iter().map(|(_, lines)| lines.len()).max().unwrap_or(0).max(what.len());
    let _ = writeln!(told, "{:letters$}  {what:columns$}  go back to", "");
    for ((name, lines), stretch) in rows.iter().zip(&page.stretches) {
        let (first, more) = stretch
            .ends
            .split_first()
            .map_or(("", &[][..]), |(first, more)| (first.as_str(), more));
        let _ = writeln!(told, "{name:letters$}  {lines:columns$}  {first}");
        for end in more {
            let _ = writeln!(told, "{:letters$}  {:columns$}  or {end}", "", "");
        }
    }
    if page.rows.iter().filter_map(|row| row.statement.as_ref()).any(|one| one.stretch.is_none()) {
        let _ = writeln!(told, "Nothing ever comes to {what} without a bracket.");
    }
    told
}

/// The lines of a stretch: `12-15, 20`. A line that does nothing does not part them.
fn lines(page: &Page, stretch: usize) -> String {
    let mut ranges: Vec<(u16, usize, usize)> = Vec::new();
    let mut is_open = false;
    for row in &page.rows {
        is_open &= !row.is_after_gap;
        let Some(statement) = &row.statement else { continue };
        if statement.stretch != Some(stretch) {
            is_open = false;
        } else if let (true, Some((_, _, last))) = (is_open, ranges.last_mut()) {
            *last = row.number;
        } else {
            ranges.push((row.file, row.number, row.number));
            is_open = true;
        }
    }
    let range = |(_, first, last): &(u16, usize, usize)| match first == last {
        true => first.to_string(),
        false => format!("{first}-{last}"),
    };
    ranges.iter().map(range).collect::<Vec<_>>().join(", ")
}
