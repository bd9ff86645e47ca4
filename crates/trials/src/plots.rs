//! The plots of a campaign: what was put right, how long it took, how far back it went; a row for
//! each strategy. Knows nothing of files.

use crate::plan::Plan;
use crate::strategy::Strategy;
use crate::svg::{Anchor, MARK, Svg};
use crate::table::grouped;
use crate::tally::{Errors, Summary, Tally};
use std::ops::Range;

/// A plot: the name of its file, and what is in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plot {
    /// Such as `success.svg`.
    pub name: &'static str,
    /// The drawing.
    pub svg: String,
}

/// The names of the files of all plots.
pub const NAMES: [&str; 4] = ["endings.svg", "success.svg", "makespan.svg", "depth.svg"];

/// Whether a text is a plot of a campaign.
#[must_use]
pub fn is_plot(text: &str) -> bool {
    text.contains(MARK)
}

/// All plots of a campaign.
#[must_use]
pub fn plots(plan: &Plan, summary: &Summary) -> Vec<Plot> {
    let under = format!(
        "{}: {} assemblies by each strategy, seed {}",
        plan.program,
        grouped(plan.runs),
        plan.seed
    );
    let [of_endings, of_success, of_makespan, of_depth] = NAMES;
    vec![
        Plot { name: of_endings, svg: endings(summary, &under) },
        Plot { name: of_success, svg: success(summary, &under) },
        Plot { name: of_makespan, svg: makespan(summary, &under) },
        Plot { name: of_depth, svg: depth(summary, &under) },
    ]
}

const WIDTH: f64 = 760.0;
/// Where the field for data lies from the left, and its width.
const LEFT: f64 = 110.0;
const FIELD: f64 = 480.0;
const TOP: f64 = 78.0;
const ROW: f64 = 34.0;
const INK: &str = "#222222";
const FAINT: &str = "#666666";
const GRID: &str = "#e2e2e2";
/// What seems to be right and is not.
const FALSE: &str = "#b3123f";

fn colour(strategy: Strategy) -> &'static str {
    match strategy {
        Strategy::Oracle => "#2a8a5c",
        Strategy::Learned => "#c4561c",
        Strategy::Fixed(_) | Strategy::Escalating | Strategy::Declared => "#2f6db0",
        _ => "#7a7a7a",
    }
}

/// A plot with a row for each strategy, and numbers along the other axis.
struct Rows {
    svg: Svg,
    axis: Axis,
    bottom: f64,
}

/// The numbers along a plot.
struct Axis {
    range: Range<f64>,
    /// Whether equal factors are equally long, and not equal differences.
    is_by_factors: bool,
    /// Where numbers stand.
    ticks: Vec<f64>,
}

impl Rows {
    fn new(summary: &Summary, title: &str, under: &str, axis: Axis) -> Self {
        let bottom = TOP + ROW * summary.strategies.len() as f64;
        let mut svg = Svg::new(WIDTH, bottom + 52.0);
        svg.text([20.0, 30.0], Anchor::Start, 17.0, INK, title);
        svg.text([20.0, 51.0], Anchor::Start, 12.5, FAINT, under);
        for (row, tally) in summary.strategies.iter().enumerate() {
            let y = middle(row) + 4.5;
            svg.text([LEFT - 14.0, y], Anchor::End, 13.0, INK, &tally.strategy.to_string());
        }
        Self { svg, axis, bottom }
    }

    /// Where a value is.
    fn x(&self, value: f64) -> f64 {
        let Axis { range, is_by_factors, .. } = &self.axis;
        let place = |value: f64| if *is_by_factors { libm::log10(value) } else { value };
        let (start, end) = (place(range.start), place(range.end));
        // Held in the range first: a logarithm has no place for zero.
        let share = (place(value.clamp(range.start, range.end)) - start) / (end - start);
        LEFT + FIELD * share
    }

    fn grid(&mut self, name: &str) {
        for value in self.axis.ticks.clone() {
            let x = self.x(value);
            self.svg.line([x, TOP], [x, self.bottom], GRID, 1.0);
            // Ticks are multiples of 1, 2 or 5: the shortest digits are few.
            let label = format!("{}", (value * 1e6).round() / 1e6);
            self.svg.text([x, self.bottom + 18.0], Anchor::Middle, 12.0, FAINT, &label);
        }
        let middle = LEFT + FIELD / 2.0;
        self.svg.text([middle, self.bottom + 39.0], Anchor::Middle, 12.5, FAINT, name);
    }

    /// A line along a row from one value to another.
    fn span(&mut self, row: usize, from: f64, to: f64, colour: &str, width: f64) {
        let (from, to) = (self.x(from), self.x(to));
        self.svg.line([from, middle(row)], [to, middle(row)], colour, width);
    }

    /// A broad bar along a row from one value to another.
    fn bar(&mut self, row: usize, from: f64, to: f64, colour: &str) {
        let (from, to) = (self.x(from), self.x(to));
        self.svg.rect([from, middle(row) - 8.0], [(to - from).max(0.0), 16.0], colour);
    }

    /// A stroke across a row.
    fn stroke(&mut self, row: usize, at: f64, half: f64, colour: &str) {
        let (x, y) = (self.x(at), middle(row));
        self.svg.line([x, y - half], [x, y + half], colour, 2.0);
    }

    /// What is said of a row behind its data.
    fn remark(&mut self, row: usize, colour: &str, text: &str) {
        let place = [LEFT + FIELD + 16.0, middle(row) + 4.5];
        self.svg.text(place, Anchor::Start, 12.5, colour, text);
    }
}

fn middle(row: usize) -> f64 {
    TOP + ROW * (row as f64 + 0.5)
}

/// How the assemblies ended: as they should, falsely, or at a person.
fn endings(summary: &Summary, under: &str) -> String {
    let title = match summary.is_judged {
        true => "How the assemblies ended: as they should be, seemingly so, at a person",
        false => "How the assemblies ended: by what the program believes, at a person",
    };
    let ticks = (0..=5).map(|tick| f64::from(tick) * 20.0).collect();
    let axis = Axis { range: 0.0..100.0, is_by_factors: false, ticks };
    let mut rows = Rows::new(summary, title, under, axis);
    rows.grid("assemblies, %");
    for (row, tally) in summary.strategies.iter().enumerate() {
        if tally.runs == 0 {
            rows.remark(row, FAINT, "no assemblies");
            continue;
        }
        let percent = |count: u64| 100.0 * count as f64 / tally.runs as f64;
        let left = percent(tally.to_a_person - tally.false_successes);
        let falsely = percent(tally.false_successes);
        let right = 100.0 - left - falsely;
        rows.bar(row, 0.0, right, colour(tally.strategy));
        rows.bar(row, right, right + falsely, FALSE);
        rows.bar(row, right + falsely, 100.0, GRID);
        let words = match tally.false_successes {
            0 => format!("{right:.1} %"),
            _ => format!("{right:.1} %, {falsely:.1} % seemingly"),
        };
        rows.remark(row, colour(tally.strategy), &words);
    }
    rows.svg.finish()
}

/// How much was put right, with intervals.
fn success(summary: &Summary, under: &str) -> String {
    let title = "Errors put right, with 95 % Wilson intervals";
    let ticks = (0..=5).map(|tick| f64::from(tick) * 20.0).collect();
    let axis = Axis { range: 0.0..100.0, is_by_factors: false, ticks };
    let mut rows = Rows::new(summary, title, under, axis);
    rows.grid("errors put right without a person, %");
    for (row, tally) in summary.strategies.iter().enumerate() {
        let colour = colour(tally.strategy);
        let (Some(share), Some(interval)) = (tally.all.share(), tally.all.interval()) else {
            rows.remark(row, FAINT, "no errors");
            continue;
        };
        let (low, high) = (100.0 * interval.low, 100.0 * interval.high);
        rows.span(row, low, high, colour, 2.0);
        rows.stroke(row, low, 5.0, colour);
        rows.stroke(row, high, 5.0, colour);
        let place = [rows.x(100.0 * share), middle(row)];
        rows.svg.circle(place, 5.5, colour);
        let of = grouped(tally.all.count);
        rows.remark(row, colour, &format!("{:.1} % of {of}", 100.0 * share));
    }
    rows.svg.finish()
}

/// How long the assemblies took.
fn makespan(summary: &Summary, under: &str) -> String {
    let values = |tally: &Tally| {
        let quantiles = [0.05, 0.25, 0.5, 0.75, 0.95].map(|share| tally.makespan_quantile_s(share));
        let [low, first, median, third, high] = quantiles;
        Some(([low?, first?, median?, third?, high?], tally.makespan_mean_s()?))
    };
    let all: Vec<_> = summary.strategies.iter().filter_map(values).collect();
    let least = all.iter().map(|(quantiles, _)| quantiles[0]).fold(f64::INFINITY, f64::min);
    let most = all.iter().map(|(quantiles, mean)| quantiles[4].max(*mean)).fold(0.0, f64::max);
    let axis = Axis::around(if least.is_finite() { least } else { 0.0 }, most);
    let title = "Makespan: mean (dot), quartiles (box), 5 to 95 % (line)";
    let mut rows = Rows::new(summary, title, under, axis);
    let scale = if rows.axis.is_by_factors { " (logarithmic)" } else { "" };
    rows.grid(&format!("seconds, with the time of a person where one had to come{scale}"));
    for (row, tally) in summary.strategies.iter().enumerate() {
        let Some(([low, first, median, third, high], mean)) = values(tally) else { continue };
        let colour = colour(tally.strategy);
        rows.span(row, low, high, colour, 2.0);
        rows.stroke(row, low, 5.0, colour);
        rows.stroke(row, high, 5.0, colour);
        let (from, to) = (rows.x(first), rows.x(third));
        rows.svg.rect([from, middle(row) - 8.0], [(to - from).max(2.0), 16.0], colour);
        rows.stroke(row, median, 8.0, "#ffffff");
        let place = [rows.x(mean), middle(row)];
        rows.svg.circle(place, 6.5, "#ffffff");
        rows.svg.circle(place, 5.0, INK);
        rows.remark(row, colour, &format!("mean {mean:.1} s"));
    }
    rows.svg.finish()
}

/// From how many times the least value the greatest is shown by factors.
const FAR_APART: f64 = 5.0;

impl Axis {
    /// An axis that holds these values, which are not negative.
    fn around(least: f64, most: f64) -> Self {
        match least > 1e-3 && most / least >= FAR_APART {
            true => Self::by_factors(least, most),
            false => Self::by_differences(least, most),
        }
    }

    /// With 2 to 10 ticks at equal steps.
    fn by_differences(least: f64, most: f64) -> Self {
        let extent = (most - least).max(most * 0.01).max(1e-3);
        let is_few = |step: &f64| extent / step <= 8.0;
        let step = round_numbers().find(is_few).unwrap_or(extent);
        let (first, last) = (libm::floor(least / step), libm::ceil(most / step));
        let last = last.max(first + 1.0);
        let ticks = (0..=(last - first) as u64).map(|tick| (first + tick as f64) * step).collect();
        Self { range: first * step..last * step, is_by_factors: false, ticks }
    }

    /// With ticks at 1, 2 and 5 of each power of ten.
    fn by_factors(least: f64, most: f64) -> Self {
        let below = round_numbers().take_while(|tick| *tick <= least).last().unwrap_or(least);
        let above = round_numbers().find(|tick| *tick >= most).unwrap_or(most);
        let ticks = round_numbers().filter(|tick| (below..=above).contains(tick)).collect();
        Self { range: below..above, is_by_factors: true, ticks }
    }
}

/// 1, 2 and 5 times powers of ten, ascending: the numbers that axes are marked at.
fn round_numbers() -> impl Iterator<Item = f64> {
    let powers = (-4..16).map(|power| libm::pow(10.0, f64::from(power)));
    powers.flat_map(|power| [1.0, 2.0, 5.0].map(|part| part * power))
}

/// The most columns of depths; what is deeper shares the last.
const DEPTHS: usize = 10;

/// How far back it went.
fn depth(summary: &Summary, under: &str) -> String {
    let depths = summary.strategies.iter().flat_map(|tally| tally.all.depths.keys().copied());
    let mut columns: Vec<u32> = depths.collect();
    columns.sort_unstable();
    columns.dedup();
    let has_deeper = columns.len() > DEPTHS;
    columns.truncate(DEPTHS);
    let title = "How many actions a recovery went back by, share of the errors put right";
    let axis = Axis { range: 0.0..1.0, is_by_factors: false, ticks: Vec::new() };
    let mut rows = Rows::new(summary, title, under, axis);
    let width = FIELD / columns.len().max(4) as f64;
    let centre = |column: usize| LEFT + width * (column as f64 + 0.5);
    for (column, depth) in columns.iter().enumerate() {
        let is_last = column + 1 == columns.len();
        let more = if is_last && has_deeper { " and more" } else { "" };
        let place = [centre(column), rows.bottom + 18.0];
        rows.svg.text(place, Anchor::Middle, 12.0, FAINT, &format!("{depth}{more}"));
    }
    let place = [LEFT + FIELD / 2.0, rows.bottom + 39.0];
    rows.svg.text(place, Anchor::Middle, 12.5, FAINT, "actions; 0 is in place");
    for (row, tally) in summary.strategies.iter().enumerate() {
        let colour = colour(tally.strategy);
        let Some(mean) = tally.all.mean_depth() else {
            rows.remark(row, FAINT, "none");
            continue;
        };
        rows.remark(row, colour, &format!("mean {mean:.1}"));
        for (column, share) in shares(&tally.all, &columns).into_iter().enumerate() {
            bubble(&mut rows.svg, [centre(column), middle(row)], share, colour);
        }
    }
    rows.svg.finish()
}

/// A share as a disc of that area, with its number beside it.
fn bubble(svg: &mut Svg, [x, y]: [f64; 2], share: f64, colour: &str) {
    if share > 0.0 {
        svg.circle([x, y], 14.0 * libm::sqrt(share) + 1.0, colour);
        svg.text(
            [x + 17.0, y + 4.0],
            Anchor::Start,
            10.5,
            FAINT,
            &format!("{:.0} %", 100.0 * share),
        );
    }
}

/// The share of each column's depth; the last column has what is deeper, too.
fn shares(errors: &Errors, columns: &[u32]) -> Vec<f64> {
    let count: u64 = errors.depths.values().sum();
    let mut shares = vec![0.0; columns.len()];
    for (depth, number) in &errors.depths {
        let column = columns.partition_point(|column| column < depth);
        if let Some(share) = shares.get_mut(column.min(columns.len() - 1)) {
            *share += *number as f64 / count as f64;
        }
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_their_values_and_have_few_ticks() {
        let bounds =
            [(0.0, 0.0), (58.1, 58.4), (20.0, 361.0), (0.0, 1e7), (1e-9, 2e-9), (3.0, 3e5)];
        for (least, most) in bounds {
            let Axis { range, ticks, .. } = Axis::around(least, most);
            assert!(range.start <= least && most <= range.end, "{least} to {most}: {range:?}");
            assert!((2..=18).contains(&ticks.len()), "{least} to {most}: {ticks:?}");
            assert!(ticks.iter().all(|tick| (range.start..=range.end).contains(tick)), "{ticks:?}");
        }
        assert_eq!(Axis::around(20.0, 361.0).ticks, [20.0, 50.0, 100.0, 200.0, 500.0]);
        assert!(Axis::around(20.0, 361.0).is_by_factors);
    }

    #[test]
    fn what_is_deeper_than_all_columns_is_in_the_last() {
        let errors = Errors { depths: [(0, 1), (2, 1), (9, 2)].into(), ..Errors::default() };
        assert_eq!(shares(&errors, &[0, 1, 2]), [0.25, 0.0, 0.75]);
    }
}
