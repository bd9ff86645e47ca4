//! How far a campaign is, on a line of standard error that is written over; on a terminal alone.

use obverse_trials::table::grouped;
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// How often the line is written.
const EVERY: Duration = Duration::from_millis(100);
/// How many characters the bar has.
const BAR: u64 = 30;

pub(crate) struct Progress {
    what: &'static str,
    before: u64,
    done: u64,
    all: u64,
    begun: Instant,
    shown: Option<Instant>,
    is_seen: bool,
}

impl Progress {
    /// So much of so much is done already.
    pub(crate) fn new(what: &'static str, done: u64, all: u64) -> Self {
        let is_seen = std::io::stderr().is_terminal();
        Self { what, before: done, done, all, begun: Instant::now(), shown: None, is_seen }
    }

    pub(crate) fn one_more(&mut self) {
        self.done += 1;
        if self.is_seen && self.shown.is_none_or(|shown| shown.elapsed() >= EVERY) {
            self.shown = Some(Instant::now());
            put(&format!("\r{}\x1b[K", self.line(self.begun.elapsed().as_secs_f64())));
        }
    }

    fn line(&self, elapsed_s: f64) -> String {
        let (done, all) = (self.done.min(self.all), self.all.max(1));
        let full = (done * BAR / all) as usize;
        let bar = format!("{}{}", "#".repeat(full), ".".repeat(BAR as usize - full));
        let speed = (self.done - self.before) as f64 / elapsed_s.max(1e-3);
        let left_s = (all - done) as f64 / speed.max(1e-9);
        let (done, all) = (grouped(done), grouped(all));
        let speed = grouped(speed as u64);
        format!("{} [{bar}] {done} of {all}, {speed} a second, {left_s:.0} s left", self.what)
    }
}

impl Drop for Progress {
    /// What follows is written on an empty line.
    fn drop(&mut self) {
        if self.shown.is_some() {
            put("\r\x1b[K");
        }
    }
}

fn put(text: &str) {
    // Where nobody can be told, nobody is.
    let _ = std::io::stderr().write_all(text.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_says_how_far_it_is_and_how_long_it_takes() {
        let mut progress = Progress::new("assemblies", 500, 2000);
        progress.done = 1000;
        let line = progress.line(0.5);
        let bar = "#".repeat(15) + &".".repeat(15);
        assert_eq!(line, format!("assemblies [{bar}] 1,000 of 2,000, 1,000 a second, 1 s left"));
    }
}
