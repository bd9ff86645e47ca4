//! The tables of a campaign, as text.

use crate::statistics::Interval;
use crate::strategy::Strategy;
use crate::tally::{Errors, Kind, Summary, Tally};

/// A table whose first columns are words, and the others numbers.
struct Table {
    /// How many columns are words.
    words: usize,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn new(words: usize, heads: &[&str]) -> Self {
        Self { words, rows: vec![heads.iter().map(|head| (*head).to_owned()).collect()] }
    }

    fn draw(&self) -> String {
        let columns = self.rows.first().map_or(0, Vec::len);
        let width = |column: usize| {
            self.rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        let line = |row: &Vec<String>| {
            let cell = |(column, text): (usize, &String)| {
                let width = widths[column];
                if column < self.words {
                    format!("{text:<width$}")
                } else {
                    format!("{text:>width$}")
                }
            };
            let cells: Vec<String> = row.iter().enumerate().map(cell).collect();
            format!("{}\n", cells.join("  ").trim_end())
        };
        self.rows.iter().map(line).collect()
    }
}

/// How many true causes of an error have a row of their own, the most frequent; and how many errors
/// of a strategy.
const CAUSES_SHOWN: usize = 3;
const ERRORS_SHOWN: usize = 12;
/// How many reasons why a person had to come have a row, the most frequent.
const REASONS_SHOWN: usize = 8;
/// So many errors of an assembly, and more, are counted together.
const MANY_ERRORS: u64 = 4;

/// The table by strategy; of several, how their makespans differ; where errors came up, that by
/// strategy and error and that by how many errors an assembly had; and what brought a person, and
/// what is not as it should be, where that is so.
#[must_use]
pub fn draw(summary: &Summary) -> String {
    let mut text = by_strategy(summary).draw();
    let by_error = by_error(summary);
    for table in
        [differences(summary), by_error, by_assembly(summary), reasons(summary), misses(summary)]
    {
        if table.rows.len() > 1 {
            text.push('\n');
            text.push_str(&table.draw());
        }
    }
    for note in notes(summary) {
        text.push('\n');
        text.push_str(note);
    }
    text
}

/// What must be known to read the tables rightly.
fn notes(summary: &Summary) -> Vec<&'static str> {
    let is_tried = |strategy| summary.strategies.iter().any(|tally| tally.strategy == strategy);
    let mut notes = Vec::new();
    if !summary.is_judged {
        notes.push(
            "The workcell file has no goal: what succeeded is what the program believes, and \
             nobody has looked.\n",
        );
    }
    if is_tried(Strategy::Explicit) && !summary.has_sequences {
        notes.push(
            "No error of the program has a sequence written against it: explicit does what stop \
             does.\n",
        );
    }
    notes
}

fn by_strategy(summary: &Summary) -> Table {
    let heads = [
        "strategy",
        "assemblies",
        "in error",
        "errors",
        "recovered",
        "95 % interval",
        "false",
        "to a person",
        "mean s",
        "95th s",
        "depth",
    ];
    let mut table = Table::new(1, &heads);
    for tally in &summary.strategies {
        let mut row = vec![
            tally.strategy.to_string(),
            grouped(tally.runs),
            share(tally.in_error, tally.runs),
        ];
        row.extend(recovery(&tally.all));
        row.extend([
            if summary.is_judged { share(tally.false_successes, tally.runs) } else { none() },
            share(tally.to_a_person, tally.runs),
            mean(tally),
            seconds(tally.makespan_quantile_s(0.95)),
            number(tally.all.mean_depth(), 1),
        ]);
        table.rows.push(row);
    }
    table
}

/// How much longer the assemblies took than the same ones by one strategy.
fn differences(summary: &Summary) -> Table {
    let Some(base) = summary.compared_with else { return Table::new(1, &["strategy"]) };
    let head = format!("mean s more than {base}");
    let mut table = Table::new(1, &["strategy", &head, "95 % interval"]);
    for tally in summary.strategies.iter().filter(|tally| tally.strategy != base) {
        let mean_s = tally.longer_mean_s().map_or_else(none, |mean_s| format!("{mean_s:+.2}"));
        let range = |interval: Interval| format!("{:+.2} to {:+.2}", interval.low, interval.high);
        let interval = tally.longer_interval_s().map_or_else(none, range);
        table.rows.push(vec![tally.strategy.to_string(), mean_s, interval]);
    }
    table
}

/// What brought a person, the most frequent first; the counts add up to all that did.
fn reasons(summary: &Summary) -> Table {
    let mut table = Table::new(2, &["strategy", "what brought a person", "assemblies"]);
    for tally in &summary.strategies {
        let mut reasons: Vec<(String, u64)> =
            tally.brought_by.iter().map(|(by, count)| (by.clone(), *count)).collect();
        reasons.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        if reasons.len() > REASONS_SHOWN {
            let rest = reasons.split_off(REASONS_SHOWN - 1);
            let count = rest.iter().map(|(_, count)| count).sum();
            reasons.push((format!("{} others", rest.len()), count));
        }
        for (index, (by, count)) in reasons.into_iter().enumerate() {
            let strategy = if index == 0 { tally.strategy.to_string() } else { String::new() };
            table.rows.push(vec![strategy, by, grouped(count)]);
        }
    }
    table
}

/// What was not as it should be where the program ended as if all were well.
fn misses(summary: &Summary) -> Table {
    let mut table = Table::new(2, &["strategy", "not as it should be", "assemblies"]);
    for tally in &summary.strategies {
        for (index, (miss, count)) in tally.misses.iter().enumerate() {
            let strategy = if index == 0 { tally.strategy.to_string() } else { String::new() };
            table.rows.push(vec![strategy, miss.clone(), grouped(*count)]);
        }
    }
    table
}

fn by_error(summary: &Summary) -> Table {
    let has_causes =
        summary.strategies.iter().flat_map(|tally| &tally.kinds).any(|kind| kind.cause.is_some());
    let mut heads = vec!["strategy", "error"];
    heads.extend(has_causes.then_some("true cause"));
    heads.extend(["assemblies", "errors", "recovered", "95 % interval", "depth"]);
    let mut table = Table::new(heads.len() - 5, &heads);
    for tally in &summary.strategies {
        for (index, (error, cause, errors)) in shown(&tally.kinds).into_iter().enumerate() {
            let strategy = if index == 0 { tally.strategy.to_string() } else { String::new() };
            let mut row = vec![strategy, error];
            row.extend(has_causes.then_some(cause));
            row.push(errors.map_or_else(none, |errors| grouped(errors.assemblies)));
            match errors {
                Some(errors) => row.extend(recovery(errors)),
                None => row.extend([none(), none(), none()]),
            }
            row.push(number(errors.and_then(Errors::mean_depth), 1));
            table.rows.push(row);
        }
    }
    table
}

/// The rows of a strategy: each error with all causes together and then its most frequent causes.
/// What is left out is said to be, in a row without numbers.
fn shown(kinds: &[Kind]) -> Vec<(String, String, Option<&Errors>)> {
    let mut rows = Vec::new();
    let of_errors: Vec<&Kind> = kinds.iter().filter(|kind| kind.cause.is_none()).collect();
    for all in of_errors.iter().take(ERRORS_SHOWN) {
        rows.push((all.error.clone(), "all".to_owned(), Some(&all.errors)));
        let is_its = |kind: &&Kind| kind.error == all.error && kind.cause.is_some();
        let mut causes: Vec<&Kind> = kinds.iter().filter(is_its).collect();
        causes.sort_by_key(|kind| std::cmp::Reverse(kind.errors.count));
        for kind in causes.iter().take(CAUSES_SHOWN) {
            let cause = kind.cause.clone().unwrap_or_default();
            rows.push((String::new(), cause, Some(&kind.errors)));
        }
        if let more @ 1.. = causes.len().saturating_sub(CAUSES_SHOWN) {
            rows.push((String::new(), format!("and {more} more"), None));
        }
    }
    if let more @ 1.. = of_errors.len().saturating_sub(ERRORS_SHOWN) {
        rows.push((format!("and {more} more"), String::new(), None));
    }
    rows
}

/// How many assemblies had how many errors, where one had any.
fn by_assembly(summary: &Summary) -> Table {
    let heads = ["assemblies with", "no error", "1", "2", "3", "4 or more", "the most"];
    let mut table = Table::new(1, &heads);
    if summary.strategies.iter().all(|tally| tally.in_error == 0) {
        return table;
    }
    for tally in &summary.strategies {
        let exactly = |errors: u64| tally.by_errors.get(&errors).copied().unwrap_or(0);
        let many: u64 = tally.by_errors.range(MANY_ERRORS..).map(|(_, count)| count).sum();
        let most = tally.by_errors.keys().next_back().copied().unwrap_or(0);
        let mut row = vec![tally.strategy.to_string()];
        row.extend((0..MANY_ERRORS).map(exactly).chain([many, most]).map(grouped));
        table.rows.push(row);
    }
    table
}

fn recovery(errors: &Errors) -> [String; 3] {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let range = |interval: Interval| {
        format!("{:.1} to {:.1} %", 100.0 * interval.low, 100.0 * interval.high)
    };
    [
        grouped(errors.count),
        errors.share().map_or_else(none, percent),
        errors.interval().map_or_else(none, range),
    ]
}

fn none() -> String {
    "-".to_owned()
}

fn mean(tally: &Tally) -> String {
    let mean = seconds(tally.makespan_mean_s());
    let half = tally.makespan_interval_s().map(|interval| (interval.high - interval.low) / 2.0);
    half.map_or_else(|| mean.clone(), |half| format!("{mean} ± {half:.2}"))
}

fn seconds(value: Option<f64>) -> String {
    number(value, 2)
}

fn number(value: Option<f64>, places: usize) -> String {
    value.map_or_else(none, |value| format!("{value:.places$}"))
}

fn share(part: u64, whole: u64) -> String {
    if whole == 0 {
        return none();
    }
    format!("{:.2} %", 100.0 * part as f64 / whole as f64)
}

/// A number with its thousands apart: 12,345.
#[must_use]
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn kind(error: &str, cause: Option<&str>, count: u64) -> Kind {
        let errors = Errors { count, assemblies: count, ..Errors::default() };
        Kind { error: error.to_owned(), cause: cause.map(str::to_owned), errors }
    }

    fn tally(kinds: Vec<Kind>, by_errors: BTreeMap<u64, u64>) -> Summary {
        let tally = Tally {
            strategy: Strategy::Stop,
            runs: by_errors.values().sum(),
            in_error: by_errors.range(1..).map(|(_, count)| count).sum(),
            false_successes: 0,
            misses: BTreeMap::new(),
            to_a_person: 0,
            brought_by: BTreeMap::new(),
            attempts: 0,
            by_errors,
            all: Errors::default(),
            kinds,
            makespans_s: Vec::new(),
            longer_s: Vec::new(),
        };
        let strategies = vec![tally];
        Summary { strategies, is_judged: false, has_sequences: false, compared_with: None }
    }

    #[test]
    fn the_table_by_error_is_bounded_and_says_what_it_leaves_out() {
        let causes = ["a", "b", "c", "d", "e"].into_iter().zip([1, 9, 3, 7, 2]);
        let mut kinds: Vec<Kind> = (0..40).map(|n| kind(&format!("e{n:02}"), None, 1)).collect();
        kinds.extend(causes.map(|(cause, count)| kind("e00", Some(cause), count)));
        let rows = shown(&kinds);
        let words: Vec<&str> = rows.iter().map(|row| row.1.as_str()).take(5).collect();
        assert_eq!(words, ["all", "b", "d", "c", "and 2 more"]);
        assert_eq!(rows.len(), ERRORS_SHOWN + CAUSES_SHOWN + 2);
        assert_eq!(rows.last().expect("rows").0, "and 28 more");
    }

    #[test]
    fn what_must_be_known_of_the_tables_is_said() {
        let mut summary = tally(Vec::new(), BTreeMap::from([(0, 5)]));
        assert!(draw(&summary).contains("no goal") && !draw(&summary).contains("explicit"));
        summary.is_judged = true;
        summary.strategies[0].strategy = Strategy::Explicit;
        assert!(draw(&summary).contains("explicit does what stop does"));
        summary.has_sequences = true;
        assert_eq!(notes(&summary).len(), 0);
    }

    #[test]
    fn assemblies_are_counted_by_their_errors() {
        let by_errors = BTreeMap::from([(0, 1200), (1, 30), (3, 4), (4, 2), (9, 1)]);
        let summary = tally(vec![kind("jam", None, 63)], by_errors);
        let table = by_assembly(&summary);
        assert_eq!(table.rows[1], ["stop", "1,200", "30", "0", "4", "3", "9"]);
        let no_error = tally(Vec::new(), BTreeMap::from([(0, 5)]));
        assert_eq!(by_assembly(&no_error).rows.len(), 1);
    }

    #[test]
    fn thousands_stand_apart() {
        for (number, text) in [(0, "0"), (999, "999"), (1000, "1,000"), (1_234_567, "1,234,567")] {
            assert_eq!(grouped(number), text);
        }
    }
}
