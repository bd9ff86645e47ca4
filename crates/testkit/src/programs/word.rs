//! A random program with a reversal word over its last block, and one like it without the word.

use super::scope::Frame;
use super::{Generator, Options};
use arbitrary::{Result, Unstructured};

/// The checkpoint before the last block.
pub const BLOCK: &str = "last_block";

/// What a block of a program is under.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Word {
    /// `skip in reverse { .. }`
    Skip,
    /// `do { .. } in reverse { .. }`
    Replace,
    /// `keep in reverse { .. }`
    Keep,
    /// `with speed very slow, force limit 7.5 N, straight moves in reverse { .. }`
    With,
    /// `io a`, with a counterpart.
    Io,
    /// `advance a`, with a counterpart.
    Advance,
}

/// Two programs that are the same but for their last block.
#[derive(Clone, Debug)]
pub struct Pair {
    /// With the word.
    pub with_word: String,
    /// Without it; where something takes the block's place in reverse, followed by that.
    pub without: String,
}

/// A pair of random programs.
///
/// # Errors
/// Only those of the randomness.
pub fn pair(u: &mut Unstructured<'_>, word: Word) -> Result<Pair> {
    let options = Options {
        allow_never: false,
        allow_overrides: word != Word::With,
        allow_errors: false,
        allow_traps: false,
        allow_forks: false,
        max_statements: 60,
    };
    Generator::new(u, options).pair(word)
}

impl Generator<'_, '_> {
    fn pair(&mut self, word: Word) -> Result<Pair> {
        let mut items = self.data()?;
        let (there, back) = (self.operation("there")?, self.operation("back")?);
        items.extend(self.sequences()?);
        self.frame = Frame::new();
        self.budget = self.budget.max(self.options.max_statements / 3);
        self.depth = 1;
        self.statements(6)?;
        self.line(&format!("checkpoint {BLOCK}"));
        let main = std::mem::take(&mut self.text);
        self.frame.in_reversed = true;
        self.frame.knows_position = false;
        if word == Word::Keep {
            self.frame.is_replacement = true;
            self.frame.kept_positions = self.frame.positions.len();
        }
        let block = self.body_of(4)?;
        self.frame = self.frame.in_reverse();
        let other = self.body_of(4)?;
        let plain = format!("if true {{ {block} }}");
        let (with_word, without) = match word {
            Word::Skip => (format!("skip in reverse {{ {block} }}"), plain),
            Word::Keep => (format!("keep in reverse {{ {block} }}"), plain),
            Word::With => {
                let words = "with speed very slow, force limit 7.5 N, straight moves in reverse";
                (format!("{words} {{ {block} }}"), plain)
            }
            Word::Replace => (
                format!("do {{ {block} }} in reverse {{ {other} }}"),
                format!("{plain} if true {{ {other} }}"),
            ),
            Word::Io => ("io io_there".to_owned(), "io io_there io io_back".to_owned()),
            Word::Advance => {
                ("advance move_there".to_owned(), "advance move_there advance move_back".to_owned())
            }
        };
        items.extend([there, back]);
        let whole = |last: &str| {
            let items = items.join("\n");
            format!("{items}\nsequence main {{\n{main}\n{last}\n}}\n")
        };
        Ok(Pair { with_word: whole(&with_word), without: whole(&without) })
    }

    /// The statements of a block as text.
    fn body_of(&mut self, most: usize) -> Result<String> {
        self.block(most)?;
        Ok(std::mem::take(&mut self.text))
    }

    /// An I/O operation and an advanced move of a name; those called `there` have the others for
    /// counterparts.
    fn operation(&mut self, name: &str) -> Result<String> {
        let counterpart = |kind: &str| match name {
            "there" => format!(" reverse {kind}_back"),
            _ => String::new(),
        };
        self.frame = Frame::new();
        self.open(&format!("io io_{name}"));
        self.output()?;
        self.output()?;
        self.close(&counterpart("io"));
        self.open(&format!("advanced move move_{name}"));
        let way = self.way(true)?;
        self.line(&format!("distance {way}"));
        self.line("stop if force > 5 N");
        self.line("succeeds if force < 3 N");
        self.line("on failure { return to initial position }");
        self.close(&counterpart("move"));
        Ok(std::mem::take(&mut self.text))
    }
}
