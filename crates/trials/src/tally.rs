//! Counting what came of a campaign: by strategy, by strategy and error, and by assembly.

use crate::outcome::{Ending, Incident, Record};
use crate::plan::Plan;
use crate::statistics::{Interval, mean, mean_interval, quantile, wilson};
use crate::strategy::Strategy;
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// What came of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// By strategy, in the order of the plan.
    pub strategies: Vec<Tally>,
    /// Whether assemblies were judged by goals, and not by what the program believes.
    pub is_judged: bool,
    /// Whether an error of the program has a sequence written against it.
    pub has_sequences: bool,
    /// What the makespans of all strategies are compared with, assembly by assembly: the strategy
    /// that learns, or else the first; none of fewer than two.
    pub compared_with: Option<Strategy>,
}

/// What came of all assemblies by a strategy.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    /// The strategy.
    pub strategy: Strategy,
    /// How many assemblies were made.
    pub runs: u64,
    /// In how many of them an error came up.
    pub in_error: u64,
    /// How many ended as if all were well, and were not as they should be.
    pub false_successes: u64,
    /// How many of them missed a goal how, in words; one may miss several.
    pub misses: BTreeMap<String, u64>,
    /// For how many a person had to come; those that ended falsely are among them.
    pub to_a_person: u64,
    /// For how many of those what brought a person; each is there once.
    pub brought_by: BTreeMap<String, u64>,
    /// How often something was tried again.
    pub attempts: u64,
    /// How many assemblies had so many errors each.
    pub by_errors: BTreeMap<u64, u64>,
    /// All errors together.
    pub all: Errors,
    /// Each kind of error by itself.
    pub kinds: Vec<Kind>,
    /// How long each assembly took with the time of a person, in seconds, ascending.
    pub makespans_s: Vec<f64>,
    /// How much longer each assembly took than the same one by the strategy compared with, in
    /// seconds, in the order of the runs; nothing for that strategy itself.
    pub longer_s: Vec<f64>,
}

/// Errors of a kind: of a name, and of a true cause where the workcell tells it.
#[derive(Clone, Debug, PartialEq)]
pub struct Kind {
    /// The error's name.
    pub error: String,
    /// The true cause; none for all causes together.
    pub cause: Option<String>,
    /// How they went.
    pub errors: Errors,
}

/// How errors went.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Errors {
    /// How many came up.
    pub count: u64,
    /// In how many assemblies; one may have several.
    pub assemblies: u64,
    /// After how many the program went on without a person, in an assembly that did not end
    /// falsely.
    pub recovered: u64,
    /// How many of those were recovered by going back how many actions, at the last attempt.
    pub depths: BTreeMap<u32, u64>,
}

impl Errors {
    fn add(&mut self, incident: &Incident, is_put_right: bool) {
        self.count += 1;
        if is_put_right {
            self.recovered += 1;
            if let Some(depth) = incident.depths.last().filter(|_| !incident.otherwise) {
                *self.depths.entry(*depth).or_default() += 1;
            }
        }
    }

    /// The share that was recovered; none of no errors.
    #[must_use]
    pub fn share(&self) -> Option<f64> {
        (self.count > 0).then(|| self.recovered as f64 / self.count as f64)
    }

    /// Its Wilson interval at 95 %.
    #[must_use]
    pub fn interval(&self) -> Option<Interval> {
        wilson(self.recovered, self.count)
    }

    /// How many actions a recovery went back by on average; none where nothing was gone back by.
    #[must_use]
    pub fn mean_depth(&self) -> Option<f64> {
        let count: u64 = self.depths.values().sum();
        let sum: u128 =
            self.depths.iter().map(|(depth, n)| u128::from(*depth) * u128::from(*n)).sum();
        (count > 0).then(|| sum as f64 / count as f64)
    }

    fn to_json(&self) -> Map<String, Value> {
        let interval = self.interval();
        let depths: Map<String, Value> =
            self.depths.iter().map(|(depth, count)| (depth.to_string(), json!(count))).collect();
        let fields = [
            ("errors", json!(self.count)),
            ("assemblies_with_errors", json!(self.assemblies)),
            ("recovered", json!(self.recovered)),
            ("recovered_share", json!(self.share())),
            ("recovered_share_low", json!(interval.map(|interval| interval.low))),
            ("recovered_share_high", json!(interval.map(|interval| interval.high))),
            ("mean_depth", json!(self.mean_depth())),
            ("depths", Value::Object(depths)),
        ];
        fields.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
    }
}

/// What came of the records of a campaign, or of a part of it.
#[must_use]
pub fn summary(plan: &Plan, records: &[Record]) -> Summary {
    let of = |strategy| records.iter().filter(move |record| record.strategy == strategy);
    let compared_with = compared_with(&plan.strategies);
    let base_s: BTreeMap<u64, f64> = compared_with
        .into_iter()
        .flat_map(of)
        .map(|record| (record.run, record.outcome.total_s()))
        .collect();
    let tally = |strategy: &Strategy| {
        let mut tally = tally(*strategy, of(*strategy));
        if Some(*strategy) != compared_with {
            let longer_s =
                |record: &Record| Some(record.outcome.total_s() - base_s.get(&record.run)?);
            tally.longer_s = of(*strategy).filter_map(longer_s).collect();
        }
        tally
    };
    let strategies = plan.strategies.iter().map(tally).collect();
    let (is_judged, has_sequences) = (plan.goals > 0, plan.sequences > 0);
    Summary { strategies, is_judged, has_sequences, compared_with }
}

/// Which of several strategies the others are compared with.
fn compared_with(strategies: &[Strategy]) -> Option<Strategy> {
    let first = strategies.first().filter(|_| strategies.len() > 1)?;
    let learned = strategies.iter().find(|strategy| **strategy == Strategy::Learned);
    learned.or(Some(first)).copied()
}

fn tally<'r>(strategy: Strategy, records: impl Iterator<Item = &'r Record>) -> Tally {
    let mut tally = Tally {
        strategy,
        runs: 0,
        in_error: 0,
        false_successes: 0,
        misses: BTreeMap::new(),
        to_a_person: 0,
        brought_by: BTreeMap::new(),
        attempts: 0,
        by_errors: BTreeMap::new(),
        all: Errors::default(),
        kinds: Vec::new(),
        makespans_s: Vec::new(),
        longer_s: Vec::new(),
    };
    let mut kinds: BTreeMap<(&str, Option<&str>), Errors> = BTreeMap::new();
    for Record { outcome, .. } in records {
        tally.runs += 1;
        tally.in_error += u64::from(!outcome.incidents.is_empty());
        *tally.by_errors.entry(outcome.incidents.len() as u64).or_default() += 1;
        if outcome.ending == Ending::FalseSuccess {
            tally.false_successes += 1;
            for miss in outcome.why.iter().flat_map(|why| why.split("; ")) {
                *tally.misses.entry(miss.to_owned()).or_default() += 1;
            }
        }
        if let Some(by) = outcome.brought_a_person() {
            tally.to_a_person += 1;
            *tally.brought_by.entry(by).or_default() += 1;
        }
        tally.attempts += u64::from(outcome.attempts);
        tally.makespans_s.push(outcome.total_s());
        let mut seen: BTreeSet<(&str, Option<&str>)> = BTreeSet::new();
        for incident in &outcome.incidents {
            let is_put_right = outcome.puts_right(incident);
            let mut add = |cause| {
                let key = (incident.error.as_str(), cause);
                let kind = kinds.entry(key).or_default();
                kind.add(incident, is_put_right);
                kind.assemblies += u64::from(seen.insert(key));
            };
            add(None);
            if let Some(cause) = &incident.cause {
                add(Some(cause));
            }
            tally.all.add(incident, is_put_right);
        }
    }
    tally.all.assemblies = tally.in_error;
    tally.makespans_s.sort_by(f64::total_cmp);
    let kind = |((error, cause), errors): ((&str, Option<&str>), Errors)| Kind {
        error: error.to_owned(),
        cause: cause.map(str::to_owned),
        errors,
    };
    tally.kinds = kinds.into_iter().map(kind).collect();
    tally
}

impl Tally {
    /// The mean makespan, in seconds; none of no runs.
    #[must_use]
    pub fn makespan_mean_s(&self) -> Option<f64> {
        mean(&self.makespans_s)
    }

    /// Where the mean makespan lies with 95 % confidence, in seconds.
    #[must_use]
    pub fn makespan_interval_s(&self) -> Option<Interval> {
        mean_interval(&self.makespans_s)
    }

    /// The makespan that this share of the assemblies does not exceed, in seconds.
    #[must_use]
    pub fn makespan_quantile_s(&self, share: f64) -> Option<f64> {
        quantile(&self.makespans_s, share)
    }

    /// How much longer an assembly takes on average than the same one by the strategy compared
    /// with, in seconds; none where there is nothing to compare.
    #[must_use]
    pub fn longer_mean_s(&self) -> Option<f64> {
        mean(&self.longer_s)
    }

    /// Where that difference lies with 95 % confidence, in seconds: the interval of the mean of the
    /// differences, from which what both have in common has gone.
    #[must_use]
    pub fn longer_interval_s(&self) -> Option<Interval> {
        mean_interval(&self.longer_s)
    }

    fn to_json(&self) -> Value {
        let interval = self.makespan_interval_s();
        let longer = self.longer_interval_s();
        let mut object = Map::new();
        let fields = [
            ("strategy", json!(self.strategy)),
            ("runs", json!(self.runs)),
            ("in_error", json!(self.in_error)),
            ("false_successes", json!(self.false_successes)),
            ("misses", json!(self.misses)),
            ("to_a_person", json!(self.to_a_person)),
            ("brought_a_person", json!(self.brought_by)),
            ("attempts", json!(self.attempts)),
            ("makespan_mean_s", json!(self.makespan_mean_s())),
            ("makespan_mean_low_s", json!(interval.map(|interval| interval.low))),
            ("makespan_mean_high_s", json!(interval.map(|interval| interval.high))),
            ("makespan_p95_s", json!(self.makespan_quantile_s(0.95))),
            ("longer_mean_s", json!(self.longer_mean_s())),
            ("longer_mean_low_s", json!(longer.map(|interval| interval.low))),
            ("longer_mean_high_s", json!(longer.map(|interval| interval.high))),
        ];
        object.extend(fields.map(|(name, value)| (name.to_owned(), value)));
        let by_errors = self.by_errors.iter().map(|(errors, n)| (errors.to_string(), json!(n)));
        object.insert("assemblies_by_errors".to_owned(), Value::Object(by_errors.collect()));
        object.extend(self.all.to_json());
        let kind = |kind: &Kind| {
            let mut object = Map::new();
            object.insert("error".to_owned(), json!(kind.error));
            object.insert("cause".to_owned(), json!(kind.cause));
            object.extend(kind.errors.to_json());
            Value::Object(object)
        };
        object.insert("kinds".to_owned(), self.kinds.iter().map(kind).collect());
        Value::Object(object)
    }
}

impl Summary {
    /// The same for machines.
    #[must_use]
    pub fn to_json(&self) -> Value {
        self.strategies.iter().map(Tally::to_json).collect()
    }
}
