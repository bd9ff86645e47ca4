//! Diagnostics and what mends them, as editors take them. It knows how they are shown, and none of
//! them.

use crate::disk::Lacking;
use crate::position::{Lines, boundary};
use crate::program::{Program, is_of_library};
use crate::workspace::Workspace;
use lsp_types::{
    CodeAction, CodeActionKind, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity,
    DiagnosticTag, Location, Range, TextEdit, Uri, WorkspaceEdit,
};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{self, Severity, Suggestion};
use std::collections::{BTreeMap, HashMap};

impl Workspace {
    /// What is wrong with all that is open and what belongs to it, by the address of the file, with
    /// the version where it is open. A file that nothing is wrong with is there without a
    /// diagnostic.
    pub fn diagnostics(&mut self) -> Vec<(Uri, Option<i32>, Vec<Diagnostic>)> {
        let mut found: BTreeMap<String, Vec<Diagnostic>> = BTreeMap::new();
        let mut seen = Vec::new();
        for key in self.keys() {
            let uri = self.uri(&key);
            for file in self.files(&uri) {
                if seen.iter().any(|other| std::rc::Rc::ptr_eq(other, &file.program)) {
                    continue;
                }
                seen.push(std::rc::Rc::clone(&file.program));
                self.gather(&file.program, &mut found);
            }
        }
        let of_file = |(key, diagnostics): (String, Vec<Diagnostic>)| {
            let version = self.document(&key).map(|document| document.version);
            (self.uri(&key), version, diagnostics)
        };
        found.into_iter().map(of_file).collect()
    }

    fn gather(&self, program: &Program, found: &mut BTreeMap<String, Vec<Diagnostic>>) {
        for file in 0..program.sources().len() {
            if !is_of_library(program.sources().name(file)) {
                found.entry(program.key(file)).or_default();
            }
        }
        for one in &program.compiled.diagnostics {
            let Some((key, range)) = program.place(one.primary.span) else { continue };
            let of_file = found.entry(key).or_default();
            let shown = self.shown(program, one, range);
            // A file may be part of several programs.
            if !of_file.contains(&shown) {
                of_file.push(shown);
            }
        }
        for lacking in self.lacking(program) {
            let Some((key, shown)) = of_workcell(program, &lacking) else { continue };
            let of_file = found.entry(key).or_default();
            if !of_file.contains(&shown) {
                of_file.push(shown);
            }
        }
    }

    fn shown(&self, program: &Program, one: &diagnostic::Diagnostic, range: Range) -> Diagnostic {
        let related = one.labels.iter().filter_map(|label| {
            let (key, range) = program.place(label.span)?;
            let location = Location::new(self.uri(&key), range);
            Some(DiagnosticRelatedInformation::new(location, label.text.clone()))
        });
        let related: Vec<_> = related.collect();
        let is_idle = matches!(one.code, Code::Unused | Code::Unreachable);
        Diagnostic {
            range,
            severity: Some(match one.severity {
                Severity::Error => DiagnosticSeverity::Error,
                Severity::Warning => DiagnosticSeverity::Warning,
            }),
            code: Some(one.code.as_str().into()),
            code_description: None,
            source: Some("obverse".to_owned()),
            message: message(one).into(),
            tags: is_idle.then(|| vec![DiagnosticTag::Unnecessary]),
            related_information: (!related.is_empty()).then_some(related),
            data: None,
        }
    }

    /// The changes that mend what is wrong within a range.
    pub fn code_actions(&mut self, uri: &Uri, range: Range) -> Vec<CodeAction> {
        let mut actions: Vec<CodeAction> = Vec::new();
        for file in self.files(uri) {
            let program = &file.program;
            for one in &program.compiled.diagnostics {
                let at = program.range(file.file, one.primary.span);
                let Some(at) = at.filter(|at| at.start <= range.end && range.start <= at.end)
                else {
                    continue;
                };
                for action in self.mending(program, one, at) {
                    if !actions.contains(&action) {
                        actions.push(action);
                    }
                }
            }
        }
        actions
    }

    /// The changes that mend one thing: the one that does, or those of which a person chooses one.
    fn mending(
        &self,
        program: &Program,
        one: &diagnostic::Diagnostic,
        at: Range,
    ) -> Vec<CodeAction> {
        let the_one = one.suggestion.iter().map(|change| {
            let title = one.help.clone().unwrap_or_else(|| one.message.clone());
            (title, change, Some(true))
        });
        let choices = one.choices.iter();
        let choices = choices.map(|one| (format!("write `{}`", one.text.trim()), one, None));
        let action = |(title, change, is_preferred): (String, &Suggestion, Option<bool>)| {
            let (key, place) = program.place(change.span)?;
            let edit = TextEdit::new(place, change.text.clone());
            (!is_of_library(&key)).then(|| CodeAction {
                title,
                kind: Some(CodeActionKind::QuickFix),
                diagnostics: Some(vec![self.shown(program, one, at)]),
                is_preferred,
                edit: Some(changes([(self.uri(&key), edit)])),
                ..CodeAction::default()
            })
        };
        the_one.chain(choices).filter_map(action).collect()
    }

    /// The text in its canonical layout, as one change of what differs; none where it has mistakes
    /// of form, or is not open.
    pub fn formatting(&mut self, uri: &Uri) -> Option<Vec<TextEdit>> {
        let document = self.document(&crate::workspace::key_of(uri))?;
        let formatted = obverse_syntax::format::format(&document.text).ok()?;
        Some(difference(&document.text, &formatted).into_iter().collect())
    }
}

/// What is lacking in the workcell, in the file of the program that asks for it.
fn of_workcell(program: &Program, lacking: &Lacking) -> Option<(String, Diagnostic)> {
    let names = program.sources();
    let file = (0..names.len()).find(|file| names.name(*file) == lacking.file)?;
    if is_of_library(&lacking.file) {
        return None;
    }
    let (text, lines) = (program.text(file), program.lines(file)?);
    let start = lines.offset_of(text, lacking.line, lacking.column);
    let end = start.saturating_add(word_length(&text[start as usize..]));
    let diagnostic = Diagnostic {
        range: lines.range(text, obverse_syntax::span::Span::new(start, end)),
        severity: Some(DiagnosticSeverity::Error),
        code: lacking.code.map(Into::into),
        source: Some("obverse".to_owned()),
        message: lacking.message.clone().into(),
        ..Diagnostic::default()
    };
    Some((program.key(file), diagnostic))
}

/// How many bytes the word, the number or the text in quotes has that something begins with.
fn word_length(text: &str) -> u32 {
    let quoted = text.strip_prefix('"').and_then(|rest| rest.find('"')).map(|end| end + 2);
    let word = || text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    u32::try_from(quoted.unwrap_or_else(word)).unwrap_or(u32::MAX)
}

/// Changes of files, by address.
pub(crate) fn changes(edits: impl IntoIterator<Item = (Uri, TextEdit)>) -> WorkspaceEdit {
    let mut by_file: HashMap<Uri, Vec<TextEdit>> = HashMap::new();
    for (uri, edit) in edits {
        by_file.entry(uri).or_default().push(edit);
    }
    WorkspaceEdit { changes: Some(by_file), ..WorkspaceEdit::default() }
}

/// All that is said of a diagnostic beside its further places.
fn message(one: &diagnostic::Diagnostic) -> String {
    let mut message = one.message.clone();
    if !one.primary.text.is_empty() {
        message.push_str(&format!("\n{}", one.primary.text));
    }
    for note in &one.notes {
        message.push_str(&format!("\nnote: {note}"));
    }
    if let Some(help) = &one.help {
        message.push_str(&format!("\nhelp: {help}"));
    }
    message
}

/// The change of what lies between the beginning and the end that two texts share, by whole lines.
fn difference(before: &str, after: &str) -> Option<TextEdit> {
    if before == after {
        return None;
    }
    let whole_lines = |same: usize| before[..boundary(before, same)].rfind('\n');
    let pairs = before.bytes().zip(after.bytes());
    let same = pairs.take_while(|(a, b)| a == b).count();
    let start = whole_lines(same).map_or(0, |end| end + 1);
    let (old, new) = (&before[start..], &after[start..]);
    let pairs = old.bytes().rev().zip(new.bytes().rev());
    let same = pairs.take_while(|(a, b)| a == b).count();
    // What is kept begins with a line.
    let tail = &old.as_bytes()[old.len() - same..];
    let kept = tail.iter().position(|byte| *byte == b'\n').map_or(0, |end| same - end - 1);
    let lines = Lines::new(before);
    let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
    let span = obverse_syntax::span::Span::new(offset(start), offset(before.len() - kept));
    let text = new[..new.len() - kept].to_owned();
    Some(TextEdit::new(lines.range(before, span), text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_makes_of_one_text_the_other() {
        let texts = ["", "a\nb\nc\n", "a\nB\nc\n", "a\nc\n", "a\n\nb\nc", "ä\nb\nö\n", "ä\nb\nü\n"];
        for before in texts {
            for after in texts {
                let mut text = before.to_owned();
                if let Some(edit) = difference(before, after) {
                    crate::position::replace(&mut text, edit.range, &edit.new_text);
                }
                assert_eq!(text, after, "from {before:?}");
            }
        }
        let edit = difference("a\nb\nc\n", "a\nB\nc\n").expect("they differ");
        assert_eq!((edit.range.start.line, edit.new_text.as_str()), (1, "B\n"));
    }
}
