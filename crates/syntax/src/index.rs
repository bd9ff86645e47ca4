//! The index of all diagnostics as a page for people. It knows how the page looks, and no code.

use crate::codes::Code;

/// What a page says of a code, of whatever is diagnosed.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The stable code.
    pub code: &'static str,
    /// What is wrong, in a few words.
    pub title: &'static str,
    /// Why it is wrong, and what is asked for.
    pub reason: &'static str,
    /// An example that has the mistake; empty where one cannot be shown.
    pub wrong: &'static str,
    /// The same without it.
    pub right: &'static str,
}

impl Entry {
    /// The page that explains it: what, why, an example wrong and the same right.
    #[must_use]
    pub fn explanation(&self) -> String {
        let Self { code, title, reason, wrong, right } = self;
        let examples = match wrong.is_empty() {
            true => String::new(),
            false => format!("\n\nWrong:\n\n{wrong}\n\nRight:\n\n{right}"),
        };
        format!("{code}: {title}\n\n{reason}{examples}\n")
    }
}

impl From<Code> for Entry {
    fn from(code: Code) -> Self {
        Self {
            code: code.as_str(),
            title: code.title(),
            reason: code.reason(),
            wrong: code.wrong_example(),
            right: code.right_example(),
        }
    }
}

/// The index of all codes, those of the compiler and others behind them, as a page: docs/codes.md.
#[must_use]
pub fn page(others: &[Entry]) -> String {
    let mut page = format!(
        "# Diagnostics\n\n{}\n\n{}\n\n```\n{ALLOW_EXAMPLE}```\n\n{}\n\n| code | |\n| --- | --- |\n",
        set(
            "Every message about a program (`E` and `W`), a workcell file or what it lacks (`C`), \
             and assembly text or a module (`A`) has a code, which never means anything else. \
             `obverse explain CODE` shows what stands here. This page is written by `UPDATE=1 \
             cargo test --test codes`."
        ),
        set(
            "A warning that is meant is allowed, for the statement or declaration that follows, or \
             for the file:"
        ),
        set("`obverse check --deny warnings` lets no warning pass that is not allowed."),
    );
    let entries = || Code::ALL.iter().map(|code| Entry::from(*code)).chain(others.iter().copied());
    for Entry { code, title, .. } in entries() {
        page += &format!("| [{code}](#{}) | {title} |\n", code.to_lowercase());
    }
    for Entry { code, title, reason, wrong, right } in entries() {
        let text = format!("**{}.** {reason}", capital(title));
        page += &format!("\n## {code}\n\n{}\n", set(&text));
        for (word, example) in [("Wrong", wrong), ("Right", right)] {
            let is_shown = example.lines().all(|line| line.len() <= COLUMNS);
            if !example.is_empty() && is_shown {
                page += &format!("\n{word}:\n\n```\n{example}\n```\n");
            }
        }
    }
    page
}

/// How a warning is allowed.
const ALLOW_EXAMPLE: &str = "\
allow W0001 \"the operator reads it\"
allow W0001 in file \"taught poses, of which each program uses some\"
";

/// How wide prose is set.
const COLUMNS: usize = 96;

/// A paragraph in lines, broken between words.
fn set(paragraph: &str) -> String {
    let mut lines = String::new();
    let mut column = 0;
    for word in paragraph.split(' ') {
        let width = word.chars().count();
        if column > 0 && column + 1 + width > COLUMNS {
            lines.push('\n');
            column = 0;
        } else if column > 0 {
            lines.push(' ');
            column += 1;
        }
        lines.push_str(word);
        column += width;
    }
    lines
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|first| first.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}
