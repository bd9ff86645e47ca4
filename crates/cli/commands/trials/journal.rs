//! The file of a shard while it is written: beside its place, as `FILE.part`, until it is whole.
//!
//! Lines are added as they come, and reach the disk every few seconds; so what a stop half-way
//! costs is little, and `--resume` goes on from there. The file takes its name when it is whole,
//! and never in place of another.

use crate::files;
use crate::problem::{Problem, plain};
use crate::write;
use obverse_trials::shard::{Begun, Seal, head_line, record_line};
use obverse_trials::{Part, Plan, Record, Shard};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

type Result<T> = std::result::Result<T, Problem>;

/// How long lines may wait for the disk.
const WAIT: Duration = Duration::from_secs(2);
/// How many bytes of them.
const WAITING_BYTES: usize = 1 << 20;

/// Where what comes of a campaign is kept, if anywhere.
pub(crate) struct Journal {
    open: Option<Open>,
}

struct Open {
    out: PathBuf,
    part: PathBuf,
    file: File,
    seal: Seal,
    waiting: String,
    since: Instant,
}

/// Check that a file can become that of a shard, before anything is done.
pub(crate) fn check(out: &Path, inputs: &[PathBuf], resume: bool) -> Result<()> {
    write::check(out, "result", inputs)?;
    if !resume && fs::symlink_metadata(out).is_ok() {
        let why = "this file is there already, and is not overwritten; name another, or remove it";
        return Err(Problem::of_file(out, why));
    }
    let part = part_of(out);
    if !resume && fs::symlink_metadata(&part).is_ok() {
        return Err(Problem::of_file(
            &part,
            "this was begun, and stopped or is under way; `--resume` goes on with it, and without \
             this file it begins anew",
        ));
    }
    Ok(())
}

/// Where a file is written until it is whole.
fn part_of(out: &Path) -> PathBuf {
    let mut name = out.as_os_str().to_owned();
    name.push(".part");
    PathBuf::from(name)
}

impl Journal {
    /// Nothing is kept.
    pub(crate) fn none() -> Self {
        Self { open: None }
    }

    /// Begin the file of a shard, or go on with it; with what came of the runs that are done.
    pub(crate) fn open(
        out: &Path,
        plan: &Plan,
        shard: Shard,
        resume: bool,
    ) -> Result<(Self, Vec<Record>)> {
        if resume && out.exists() {
            return Ok((Self::none(), finished(out, plan, shard)?));
        }
        let part = part_of(out);
        let cannot = |error: &io::Error| {
            Problem::of_file(&part, format!("cannot be written: {}", plain(error)))
        };
        let is_there = fs::symlink_metadata(&part).is_ok();
        if is_there && !fs::symlink_metadata(&part).is_ok_and(|found| found.is_file()) {
            return Err(Problem::of_file(&part, "this is no regular file"));
        }
        let mut options = OpenOptions::new();
        options.read(true).write(true).create_new(!(resume && is_there));
        let mut file = options.open(&part).map_err(|error| cannot(&error))?;
        if file.try_lock().is_err() {
            return Err(Problem::of_file(&part, "another campaign is writing this now"));
        }
        let begun = match resume && is_there {
            true => begun(&part, plan, shard)?,
            false => Begun { records: Vec::new(), bytes: 0 },
        };
        let mut seal = Seal::default();
        let mut waiting = String::new();
        if begun.bytes == 0 {
            waiting = head_line(plan, shard);
        } else {
            seal.add(head_line(plan, shard).as_bytes());
            begun.records.iter().for_each(|record| seal.add(record_line(record).as_bytes()));
        }
        file.set_len(begun.bytes as u64)
            .and_then(|()| file.seek(SeekFrom::End(0)))
            .map_err(|error| cannot(&error))?;
        let out = out.to_owned();
        let open = Open { out, part, file, seal, waiting, since: Instant::now() };
        let mut journal = Self { open: Some(open) };
        journal.flush()?;
        Ok((journal, begun.records))
    }

    /// Add what came of a run.
    pub(crate) fn add(&mut self, records: &[Record]) -> Result<()> {
        let Some(open) = &mut self.open else { return Ok(()) };
        open.waiting.extend(records.iter().map(record_line));
        let is_due = open.since.elapsed() >= WAIT || open.waiting.len() >= WAITING_BYTES;
        if is_due { self.flush() } else { Ok(()) }
    }

    /// Bring what waits to the disk.
    fn flush(&mut self) -> Result<()> {
        let Some(open) = &mut self.open else { return Ok(()) };
        open.seal.add(open.waiting.as_bytes());
        let written =
            open.file.write_all(open.waiting.as_bytes()).and_then(|()| open.file.sync_data());
        open.waiting.clear();
        open.since = Instant::now();
        written.map_err(|error| open.stopped(&error))
    }

    /// All is there: the file takes its name.
    pub(crate) fn finish(mut self) -> Result<()> {
        self.flush()?;
        let Some(mut open) = self.open else { return Ok(()) };
        let end = open.seal.line();
        let written = open.file.write_all(end.as_bytes()).and_then(|()| open.file.sync_all());
        written.map_err(|error| open.stopped(&error))?;
        if open.out.exists() {
            let why = "this file has come to be meanwhile, and is not overwritten; what was \
                       computed is in the file of that name with `.part` behind it";
            return Err(Problem::of_file(&open.out, why));
        }
        fs::rename(&open.part, &open.out).map_err(|error| open.stopped(&error))?;
        let folder = open.out.parent().filter(|folder| !folder.as_os_str().is_empty());
        // The name is on the disk too, where the system can say so.
        let _ = File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all());
        Ok(())
    }
}

impl Open {
    fn stopped(&self, error: &io::Error) -> Problem {
        let (part, why) = (self.part.display(), plain(error));
        let text = format!(
            "cannot be written: {why}; what was done before is kept in {part}, and `--resume` goes \
             on with it"
        );
        Problem::of_file(&self.out, text)
    }
}

/// What came of a shard that is done already.
fn finished(out: &Path, plan: &Plan, shard: Shard) -> Result<Vec<Record>> {
    let wrong = |why: String| Problem::of_file(out, why);
    let bytes = files::read_at_most(out, super::MAX_SHARD_BYTES).map_err(wrong)?;
    let begun = Begun::parse(&bytes, plan, shard).map_err(|error| wrong(error.to_string()))?;
    Part::parse(&bytes).map_err(|error| wrong(error.to_string()))?;
    Ok(begun.records)
}

/// What was done of a shard before it was stopped.
fn begun(part: &Path, plan: &Plan, shard: Shard) -> Result<Begun> {
    let wrong = |why: String| Problem::of_file(part, why);
    let bytes = files::read_at_most(part, super::MAX_SHARD_BYTES).map_err(wrong)?;
    if head_line(plan, shard).as_bytes().starts_with(&bytes) {
        // Stopped before its first line was there.
        return Ok(Begun { records: Vec::new(), bytes: 0 });
    }
    Begun::parse(&bytes, plan, shard).map_err(|error| wrong(error.to_string()))
}
