//! The reader of a page, who writes the files that it says, in a folder of their own, and runs its
//! commands there; before the first file, in the folder of the project.

use crate::page::{Block, Page, ROOT};
use std::fs;
use std::path::{Path, PathBuf};

pub(crate) struct Reader {
    folder: PathBuf,
    has_begun: bool,
}

impl Reader {
    pub(crate) fn of(page: &Page) -> Self {
        let name = format!("docs_{}", page.name.replace('/', "_"));
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("a folder");
        Self { folder, has_begun: false }
    }

    /// Where commands are run.
    pub(crate) fn place(&self) -> &Path {
        if self.has_begun { &self.folder } else { Path::new(ROOT) }
    }

    pub(crate) fn file(&self, name: &str) -> Option<String> {
        fs::read_to_string(self.folder.join(name)).ok()
    }

    /// Do what a block asks for: `file NAME` writes a file, `change NAME` writes declarations in
    /// place of those that begin alike, `add NAME` puts some at the end.
    ///
    /// # Errors
    /// What of it cannot be done.
    pub(crate) fn write(&mut self, block: &Block<'_>) -> Result<(), String> {
        let (name, text) = if let Some(name) = block.after("file") {
            (name, block.text())
        } else if let Some(name) = block.after("change") {
            (name, changed(&self.known(name)?, &block.lines)?)
        } else if let Some(name) = block.after("add") {
            (name, format!("{}\n{}", self.known(name)?, block.text()))
        } else {
            return Ok(());
        };
        self.has_begun = true;
        fs::write(self.folder.join(name), text).map_err(|error| format!("{name}: {error}"))
    }

    fn known(&self, name: &str) -> Result<String, String> {
        self.file(name).ok_or_else(|| format!("no block has written `{name}` before"))
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let _ = fs::remove_dir_all(&self.folder);
        }
    }
}

/// A text with a declaration in place of the one that begins with the same line. A declaration
/// ends at the first line after its beginning that is not indented.
fn changed(text: &str, declaration: &[&str]) -> Result<String, String> {
    let lines: Vec<&str> = text.lines().collect();
    let head = declaration.first().ok_or("nothing to change")?;
    let begin = lines.iter().position(|line| line == head);
    let begin = begin.ok_or_else(|| format!("no line is `{head}`"))?;
    let is_inner = |line: &&str| line.starts_with(' ') || line.is_empty();
    let inner = lines[begin + 1..].iter().take_while(|line| is_inner(line)).count();
    // The closing brace is of the declaration, and the lines that are blank before another not.
    let after = begin + 1 + inner;
    let end = match lines.get(after) {
        Some(line) if line.starts_with(['}', ']']) => after + 1,
        _ => begin + 1,
    };
    let all = lines[..begin].iter().chain(declaration).chain(&lines[end..]);
    Ok(all.flat_map(|line| [*line, "\n"]).collect())
}

#[test]
fn a_declaration_takes_the_place_of_its_namesake() {
    let text = "cell \"a\"\n\nb {\n  1\n\n  2\n}\n\nc {\n  3\n}\n";
    let changed = |lines: &[&str]| changed(text, lines).expect("it is there");
    assert_eq!(changed(&["b {", "  9", "}"]), "cell \"a\"\n\nb {\n  9\n}\n\nc {\n  3\n}\n");
    assert_eq!(changed(&["cell \"a\"", "d"]), format!("cell \"a\"\nd\n{}", &text[9..]));
    assert!(super::reader::changed(text, &["e {"]).is_err());
}
