//! The tables of a campaign, as text.

use crate::statistics::Interval;
use crate::tally::{Errors, Summary, Tally};

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

/// The table by strategy, that by strategy and error where errors came up, and what is not as it
/// should be where that is so.
#[must_use]
pub fn draw(summary: &Summary) -> String {
    let mut text = by_strategy(summary).draw();
    let by_error = by_error(summary);
    if by_error.rows.len() > 1 {
        text.push('\n');
        text.push_str(&by_error.draw());
    }
    let misses = misses(summary);
    if misses.rows.len() > 1 {
        text.push('\n');
        text.push_str(&misses.draw());
    }
    text
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
    heads.extend(["errors", "recovered", "95 % interval", "depth"]);
    let mut table = Table::new(heads.len() - 4, &heads);
    for tally in &summary.strategies {
        for (index, kind) in tally.kinds.iter().enumerate() {
            let strategy = if index == 0 { tally.strategy.to_string() } else { String::new() };
            let error = if kind.cause.is_none() { kind.error.clone() } else { String::new() };
            let mut row = vec![strategy, error];
            if has_causes {
                row.push(kind.cause.clone().unwrap_or_else(|| "all".to_owned()));
            }
            row.extend(recovery(&kind.errors));
            row.push(number(kind.errors.mean_depth(), 1));
            table.rows.push(row);
        }
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

    #[test]
    fn thousands_stand_apart() {
        for (number, text) in [(0, "0"), (999, "999"), (1000, "1,000"), (1_234_567, "1,234,567")] {
            assert_eq!(grouped(number), text);
        }
    }
}
