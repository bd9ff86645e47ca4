//! The pages of many codes as one page for people. It knows how that looks, and no code.

use crate::Page;

/// The index of all codes as a page: docs/codes.md.
#[must_use]
pub fn page(pages: &[Page]) -> String {
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
    for Page { code, title, .. } in pages {
        page += &format!("| [{code}](#{}) | {title} |\n", code.to_lowercase());
    }
    for Page { code, title, reason, wrong, right } in pages {
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
