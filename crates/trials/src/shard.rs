//! The file of a shard: lines of JSON, of which the first says which campaign it belongs to, and
//! the last that it is whole. Between them there is a line for each run and strategy.
//!
//! What stands in a file follows from the plan and the shard alone. So the files of all shards,
//! put together, give the bytes of the file of the whole, and what was begun can be gone on with.
//! Knows bytes; how they come to a disk is known elsewhere.

use crate::outcome::Record;
use crate::plan::{MAX_RUNS, Plan, Purpose, Shard, seed_of};
use serde::{Deserialize, Serialize};
use std::fmt;
use xxhash_rust::xxh3::Xxh3;

/// The version of the format, which the first line names.
pub const FORMAT: u32 = 4;

/// A line of a file.
#[derive(Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
enum Line {
    Campaign(Head),
    Run(Record),
    End(End),
}

#[derive(Serialize, Deserialize)]
struct Head {
    format: u32,
    shard: Shard,
    #[serde(flatten)]
    plan: Plan,
}

/// That a file is whole.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct End {
    /// How many lines stand between the first and this one.
    lines: u64,
    /// A checksum of all bytes before this line (XXH3).
    checksum: String,
}

/// What is in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The campaign.
    pub plan: Plan,
    /// Which part of it.
    pub shard: Shard,
    /// What came of its runs, by run and then in the order of the strategies.
    pub records: Vec<Record>,
}

/// What was made of a shard before something stopped it.
#[derive(Clone, Debug, PartialEq)]
pub struct Begun {
    /// What came of the runs that are complete.
    pub records: Vec<Record>,
    /// How many bytes of the file that is, with its first line.
    pub bytes: usize,
}

/// Why a file is not used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ShardError {
    /// It does not begin as one.
    NotAShard,
    /// It is of another format.
    Format(u64),
    /// Its last line is missing, or not that of these bytes.
    Torn(&'static str),
    /// A line is not what must stand there.
    Line {
        /// Which, from 1.
        number: usize,
        /// Why.
        why: String,
    },
    /// It belongs to another campaign.
    Foreign(String),
}

impl fmt::Display for ShardError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotAShard => {
                write!(f, "this is no file of a campaign: its first line does not say so")
            }
            Self::Format(found) => write!(
                f,
                "this file of a campaign has format {found}, and this version of Obverse reads \
                 format {FORMAT}"
            ),
            Self::Torn(why) => {
                write!(f, "this file is not whole: {why}; run its shard again")
            }
            Self::Line { number, why } => write!(f, "line {number}: {why}"),
            Self::Foreign(why) => write!(f, "this belongs to another campaign: {why}"),
        }
    }
}

impl std::error::Error for ShardError {}

/// The first line of a file.
#[must_use]
pub fn head_line(plan: &Plan, shard: Shard) -> String {
    line(&Line::Campaign(Head { format: FORMAT, shard, plan: plan.clone() }))
}

/// The line of a record.
#[must_use]
pub fn record_line(record: &Record) -> String {
    line(&Line::Run(record.clone()))
}

/// The last line of a file, of which these are the bytes so far.
#[must_use]
pub fn end_line(before: &[u8]) -> String {
    let mut seal = Seal::default();
    seal.add(before);
    seal.line()
}

/// What the last line of a file says of the bytes before it, as they come.
#[derive(Default)]
pub struct Seal {
    lines: u64,
    hash: Xxh3,
}

impl Seal {
    /// The next bytes of the file.
    pub fn add(&mut self, bytes: &[u8]) {
        self.lines += bytes.iter().filter(|byte| **byte == b'\n').count() as u64;
        self.hash.update(bytes);
    }

    /// The last line.
    #[must_use]
    pub fn line(&self) -> String {
        let checksum = format!("{:016x}", self.hash.digest());
        line(&Line::End(End { lines: self.lines.saturating_sub(1), checksum }))
    }
}

fn line(line: &Line) -> String {
    // Maps with keys of text and numbers that are finite: there is nothing that could fail.
    let mut text = serde_json::to_string(line).unwrap_or_default();
    text.push('\n');
    text
}

impl Part {
    /// The file of a part.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = head_line(&self.plan, self.shard);
        text.extend(self.records.iter().map(record_line));
        let end = end_line(text.as_bytes());
        text + &end
    }

    /// What is in a file that is whole.
    ///
    /// # Errors
    /// Why it is not used.
    pub fn parse(bytes: &[u8]) -> Result<Self, ShardError> {
        let (head, rest) = first_line(bytes)?;
        let torn = ShardError::Torn;
        let before_last = rest.strip_suffix(b"\n").ok_or(torn("its last line is cut off"))?;
        let begin = before_last.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        let (before, last) = bytes.split_at(bytes.len() - rest.len() + begin);
        if !matches!(read(last), Ok(Line::End(_))) {
            return Err(torn("it has no last line"));
        }
        if last != end_line(before).as_bytes() {
            return Err(torn("its checksum is not that of its bytes"));
        }
        let mut reader = Reader::new(&head.plan, head.shard);
        for text in rest[..begin].split_inclusive(|byte| *byte == b'\n') {
            reader.push(text)?;
        }
        let (plan, shard) = (head.plan.clone(), head.shard);
        if !reader.is_complete() {
            return Err(torn("runs are missing from it"));
        }
        Ok(Self { records: reader.records, plan, shard })
    }
}

impl Begun {
    /// What is in a file that was begun for this shard of a campaign: all runs whose lines are
    /// complete. A line that is not is where the writer was stopped.
    ///
    /// # Errors
    /// That the file belongs to another campaign, or to none.
    pub fn parse(bytes: &[u8], plan: &Plan, shard: Shard) -> Result<Self, ShardError> {
        let (head, rest) = first_line(bytes)?;
        if let Some(why) = plan.difference(&head.plan) {
            return Err(ShardError::Foreign(why));
        }
        if head.shard != shard {
            let why = format!("it is shard {}, and not {shard}", head.shard);
            return Err(ShardError::Foreign(why));
        }
        let mut reader = Reader::new(plan, shard);
        let (mut length, mut whole) = (bytes.len() - rest.len(), (0, bytes.len() - rest.len()));
        for text in rest.split_inclusive(|byte| *byte == b'\n') {
            if reader.is_complete() || reader.push(text).is_err() {
                break;
            }
            length += text.len();
            if reader.records.len().is_multiple_of(plan.strategies.len()) {
                whole = (reader.records.len(), length);
            }
        }
        let mut records = reader.records;
        records.truncate(whole.0);
        Ok(Self { records, bytes: whole.1 })
    }
}

/// The first line of a file, and the bytes behind it.
fn first_line(bytes: &[u8]) -> Result<(Head, &[u8]), ShardError> {
    let end = bytes.iter().position(|byte| *byte == b'\n').ok_or(ShardError::NotAShard)?;
    let (first, rest) = bytes.split_at(end + 1);
    let value: serde_json::Value =
        serde_json::from_slice(first).map_err(|_| ShardError::NotAShard)?;
    if value["type"] != "campaign" {
        return Err(ShardError::NotAShard);
    }
    let format = value["format"].as_u64().ok_or(ShardError::NotAShard)?;
    if format != u64::from(FORMAT) {
        return Err(ShardError::Format(format));
    }
    let wrong = |why: String| ShardError::Line { number: 1, why };
    let head: Head = serde_json::from_value(value).map_err(|error| wrong(error.to_string()))?;
    let strategies = &head.plan.strategies;
    let is_twice = |index: usize| strategies[..index].contains(&strategies[index]);
    if strategies.is_empty() || (0..strategies.len()).any(is_twice) {
        return Err(wrong("its strategies must be some, and each once".to_owned()));
    }
    if !head.shard.is_valid() || head.plan.runs > MAX_RUNS {
        return Err(wrong("there is no such shard, or there are too many runs".to_owned()));
    }
    Ok((head, rest))
}

fn read(text: &[u8]) -> Result<Line, String> {
    serde_json::from_slice(text).map_err(|error| error.to_string())
}

/// Reads the lines of runs, each of which must be the one that is due.
struct Reader<'p> {
    plan: &'p Plan,
    runs: std::ops::Range<u64>,
    records: Vec<Record>,
}

impl<'p> Reader<'p> {
    fn new(plan: &'p Plan, shard: Shard) -> Self {
        Self { plan, runs: shard.runs(plan.runs), records: Vec::new() }
    }

    fn is_complete(&self) -> bool {
        let due = (self.runs.end - self.runs.start) as usize * self.plan.strategies.len();
        self.records.len() == due
    }

    fn push(&mut self, text: &[u8]) -> Result<(), ShardError> {
        let number = self.records.len() + 2;
        let wrong = |why: &str| ShardError::Line { number, why: why.to_owned() };
        if !text.ends_with(b"\n") {
            return Err(wrong("it is cut off"));
        }
        let Line::Run(record) = read(text).map_err(|why| wrong(&why))? else {
            return Err(wrong("this is not the line of a run"));
        };
        let strategies = &self.plan.strategies;
        let run = self.runs.start + (self.records.len() / strategies.len()) as u64;
        let strategy = strategies[self.records.len() % strategies.len()];
        let seed = seed_of(self.plan.seed, Purpose::Trial, run);
        if (record.run, record.seed, record.strategy) != (run, seed, strategy) {
            return Err(wrong(&format!("run {run} by {strategy} with seed {seed} is due here")));
        }
        if record.outcome.makespan_s < 0.0 || record.outcome.person_s < 0.0 {
            return Err(wrong("a time is negative"));
        }
        self.records.push(record);
        Ok(())
    }
}

/// The whole campaign of all its shards, in any order, each with the name of its file.
///
/// # Errors
/// The file that does not belong to the others and why, or what is missing.
pub fn merge(mut parts: Vec<(String, Part)>) -> Result<Part, MergeError> {
    parts.sort_by_key(|(_, part)| part.shard.index);
    let Some((first_name, first)) = parts.first() else { return Err(MergeError::Nothing) };
    let (plan, count) = (first.plan.clone(), first.shard.count);
    for (name, part) in &parts {
        let other_count = (part.shard.count != count)
            .then(|| format!("it is one of {} shards, and not of {count}", part.shard.count));
        if let Some(why) = plan.difference(&part.plan).or(other_count) {
            let why = format!("this belongs to another campaign than {first_name}: {why}");
            return Err(MergeError::File { name: name.clone(), why });
        }
    }
    if let Some([(one, _), (other, part)]) =
        parts.windows(2).find(|pair| pair[0].1.shard == pair[1].1.shard)
    {
        let why = format!("this is shard {}, and so is {one}", part.shard);
        return Err(MergeError::File { name: other.clone(), why });
    }
    if parts.len() < count as usize {
        let is_there =
            |index: u32| parts.binary_search_by_key(&index, |(_, part)| part.shard.index).is_ok();
        let index = (1..=count).find(|index| !is_there(*index)).unwrap_or(count);
        let others = count as usize - parts.len() - 1;
        return Err(MergeError::Missing { shard: Shard { index, count }, others });
    }
    let records = parts.into_iter().flat_map(|(_, part)| part.records).collect();
    Ok(Part { plan, shard: Shard::WHOLE, records })
}

/// Why shards do not make a campaign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MergeError {
    /// There are none.
    Nothing,
    /// A file does not belong to the others.
    File {
        /// Its name.
        name: String,
        /// Why.
        why: String,
    },
    /// Shards are missing.
    Missing {
        /// The first of them.
        shard: Shard,
        /// How many more.
        others: usize,
    },
}

impl fmt::Display for MergeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => write!(f, "there is nothing to merge"),
            Self::File { name, why } => write!(f, "{name}: {why}"),
            Self::Missing { shard, others: 0 } => write!(f, "shard {shard} is missing"),
            Self::Missing { shard, others } => {
                write!(f, "shard {shard} is missing, and {others} more")
            }
        }
    }
}

impl std::error::Error for MergeError {}
