//! What could be meant by what is half typed: commands, what follows them, and names.

use crate::console::{WORDS, Word};
use crate::debuggee::{Answer, Debuggee};
use crate::message::Completions;
use obverse_debugger::session::Variable;
use serde_json::{Value, json};

/// The most that is offered.
const MAX_OFFERED: usize = 200;

/// Something that is offered, and what it is.
type Offer = (String, &'static str);

impl Debuggee<'_, '_, '_> {
    pub(crate) fn completions(&self, asked: &Completions) -> Answer {
        let client = &self.server.client;
        let line = asked.line.map_or(1, |line| client.line_of(line)).max(1);
        let text = asked.text.lines().nth(line - 1).unwrap_or_default();
        let before = asked.column.saturating_sub(usize::from(client.columns_from_1));
        let typed = first_units(text, before);
        let is_of_name = |c: char| c.is_alphanumeric() || "_-.".contains(c);
        let begun = typed.trim_end_matches(is_of_name).len();
        let (head, begun) = typed.split_at(begun);
        let start = client.column(head.encode_utf16().count() + 1);
        let length = begun.encode_utf16().count();
        let offers = self.offers(head.trim(), asked.frame_id);
        let offers = offers.into_iter().filter(|(text, _)| text.starts_with(begun));
        let target = |(text, kind): Offer| -> Value {
            json!({ "label": text, "type": kind, "start": start, "length": length })
        };
        let targets: Vec<Value> = offers.take(MAX_OFFERED).map(target).collect();
        Ok(json!({ "targets": targets }))
    }

    /// What can stand behind what is typed.
    fn offers(&self, head: &str, frame: Option<usize>) -> Vec<Offer> {
        let command = head.split_whitespace().next().unwrap_or_default();
        let of = |names: &[&str]| names.contains(&command);
        if of(&["help", "h"]) {
            return words();
        }
        if of(&["goto", "go"]) {
            let marks = self.session.bookmarks().keys().cloned();
            let checkpoints = self.session.module().checkpoints.iter().cloned();
            let moments = ["start", "end", "error"].map(str::to_owned).into_iter();
            return moments.chain(marks).chain(checkpoints).map(|it| (it, "value")).collect();
        }
        let mut offers = if head.is_empty() { words() } else { Vec::new() };
        let innermost = self.session.frames().len();
        let called = frame.unwrap_or(innermost).saturating_sub(1);
        let known = [self.session.locals(called), self.session.globals(), self.session.workcell()];
        offers.extend(known.into_iter().flatten().map(|it: Variable| (it.name, "variable")));
        offers
    }
}

fn words() -> Vec<Offer> {
    let typed = WORDS.iter().filter(|word| word.is_carried_out());
    typed.map(|word: &Word| (word.names[0].to_owned(), "function")).collect()
}

/// The beginning of a text that takes so many units of UTF-16.
fn first_units(text: &str, units: usize) -> &str {
    let mut left = units;
    let end = text.char_indices().find(|(_, c)| match left.checked_sub(c.len_utf16()) {
        Some(rest) => {
            left = rest;
            false
        }
        None => true,
    });
    &text[..end.map_or(text.len(), |(at, _)| at)]
}

#[cfg(test)]
mod tests {
    //! Columns are counted as editors do.

    use super::*;

    #[test]
    fn units_are_those_of_utf_16() {
        for (units, expected) in
            [(0, ""), (1, "a"), (2, "a"), (3, "a🤖"), (4, "a🤖ü"), (99, "a🤖ü")]
        {
            assert_eq!(first_units("a🤖ü", units), expected, "{units}");
        }
    }
}
