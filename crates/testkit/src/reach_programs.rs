//! Random programs in which what is said of reach depends on how errors lead on: short sequences
//! of barriers and throws, in calls, loops and forks, with an error of every response. Every one
//! compiles. Knows nothing of what may be said of them.

use arbitrary::{Result, Unstructured};

/// The errors, and what recovers from them.
pub const ERRORS: &str = r#"
error dead { severity fatal }
error anew { recover using fix; then restart program }
error again { recover using fix; then return to sequence }
error redo { recover using fix; then return to action }
error on { recover using fix; then continue }
error late { respond after current sequence; recover using fix; then continue }
sequence fix { toggle 6 }
"#;

const NAMES: [&str; 6] = ["dead", "anew", "again", "redo", "on", "late"];

/// How many sequences there are, each calling those before it.
const SEQUENCES: usize = 4;

/// What is so or not, anew each time: an input is what it is for a whole run.
const CHANCE: &str = "random(0.0, 1.0) < 0.5";

/// How deep blocks are.
const MAX_DEPTH: usize = 2;

/// The source text of a random program, with forks or without.
///
/// # Errors
/// Only those of the randomness.
pub fn generate(u: &mut Unstructured<'_>, with_forks: bool) -> Result<String> {
    let mut writer = Writer { text: ERRORS.to_owned(), with_forks, callees: 0 };
    for sequence in 0..SEQUENCES {
        writer.callees = sequence;
        let name =
            if sequence + 1 == SEQUENCES { "main".to_owned() } else { format!("s{sequence}") };
        writer.block(u, &format!("sequence {name}"), "", 0)?;
    }
    Ok(writer.text)
}

struct Writer {
    text: String,
    with_forks: bool,
    /// How many sequences may be called.
    callees: usize,
}

impl Writer {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn block(
        &mut self,
        u: &mut Unstructured<'_>,
        head: &str,
        foot: &str,
        depth: usize,
    ) -> Result<()> {
        self.line(&format!("{head} {{"));
        for _ in 0..u.int_in_range(2..=4)? {
            self.statement(u, depth)?;
        }
        self.line(&format!("}}{foot}"));
        Ok(())
    }

    fn statement(&mut self, u: &mut Unstructured<'_>, depth: usize) -> Result<()> {
        match u.int_in_range(0..=9)? {
            0 | 1 => {
                let error = u.choose(&NAMES)?;
                self.line(&format!("if {CHANCE} {{ throw {error} }}"));
            }
            2 | 3 => self.line(&format!("barrier \"b{}\"", self.text.len())),
            4 | 5 if self.callees > 0 => {
                let callee = u.int_in_range(0..=self.callees - 1)?;
                self.line(&format!("call s{callee}"));
            }
            6 if depth < MAX_DEPTH => self.block(u, &format!("if {CHANCE}"), "", depth + 1)?,
            7 if depth < MAX_DEPTH => self.block(u, "repeat 2 times", "", depth + 1)?,
            8 if depth < MAX_DEPTH && self.with_forks => {
                self.block(u, "fork", " and { wait 1 s }", depth + 1)?;
            }
            _ => {
                let output = u.int_in_range(0..=5)?;
                self.line(&format!("toggle {output}"));
            }
        }
        Ok(())
    }
}
