//! The pages of the documents and the fenced blocks in them. It knows nothing of what the blocks
//! say.

use std::path::{Path, PathBuf};

pub(crate) const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Pages that are written by a program, and held by its test.
const GENERATED: [&str; 1] = ["docs/codes.md"];

/// A document.
pub(crate) struct Page {
    /// Its path within the project.
    pub(crate) name: String,
    pub(crate) text: String,
}

/// What stands between two fences.
pub(crate) struct Block<'p> {
    /// The line of its opening fence, from 1.
    pub(crate) line: usize,
    /// What stands behind that: a language, and how the block is meant.
    pub(crate) words: Vec<&'p str>,
    pub(crate) lines: Vec<&'p str>,
}

impl Page {
    pub(crate) fn read(name: &str) -> Self {
        let path = Path::new(ROOT).join(name);
        let text = std::fs::read_to_string(&path);
        let text = text.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        Self { name: name.to_owned(), text }
    }

    /// Every page that somebody has written for people who use the language.
    pub(crate) fn all() -> Vec<Self> {
        let entries = std::fs::read_dir(Path::new(ROOT).join("docs")).expect("documents");
        let names = entries.map(|entry| entry.expect("an entry").file_name());
        let names = names.map(|name| format!("docs/{}", name.to_string_lossy()));
        let is_written =
            |name: &String| name.ends_with(".md") && !GENERATED.contains(&name.as_str());
        let mut names: Vec<String> = names.filter(is_written).collect();
        names.push("README.md".to_owned());
        names.sort();
        names.iter().map(|name| Self::read(name)).collect()
    }

    pub(crate) fn path(&self) -> PathBuf {
        Path::new(ROOT).join(&self.name)
    }

    pub(crate) fn blocks(&self) -> Vec<Block<'_>> {
        let mut blocks: Vec<Block<'_>> = Vec::new();
        let mut is_open = false;
        for (number, line) in (1..).zip(self.text.lines()) {
            match (line.strip_prefix("```"), is_open) {
                (Some(_), true) => is_open = false,
                (Some(words), false) => {
                    let words = words.split_whitespace().collect();
                    blocks.push(Block { line: number, words, lines: Vec::new() });
                    is_open = true;
                }
                (None, true) => {
                    blocks.last_mut().into_iter().for_each(|block| block.lines.push(line));
                }
                (None, false) => {}
            }
        }
        assert!(!is_open, "{}: a block without an end", self.name);
        blocks
    }
}

impl Block<'_> {
    pub(crate) fn language(&self) -> &str {
        self.words.first().copied().unwrap_or_default()
    }

    /// Whether a word stands behind the language.
    pub(crate) fn says(&self, word: &str) -> bool {
        self.words.iter().skip(1).any(|said| *said == word)
    }

    /// The word that follows another one behind the language.
    pub(crate) fn after(&self, word: &str) -> Option<&str> {
        let at = self.words.iter().skip(1).position(|said| *said == word)?;
        self.words.get(at + 2).copied()
    }

    pub(crate) fn text(&self) -> String {
        self.lines.iter().flat_map(|line| [*line, "\n"]).collect()
    }
}
