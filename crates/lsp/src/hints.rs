//! What is shown beside the text: the class of each action at the end of its line, and above each
//! sequence how far it can be taken back.

use crate::workspace::Workspace;
use lsp_types::{CodeLens, Command, InlayHint, Label, Range, Tooltip, Uri};
use obverse_compiler::symbols::SymbolKind;
use obverse_reach::Standing;
use std::collections::BTreeMap;

/// So many places that stop going back are named of one sequence.
const MOST_STOPS: usize = 2;

impl Workspace {
    /// The class of what stands on the lines of a range, in short.
    pub fn hints(&mut self, uri: &Uri, range: Range) -> Vec<InlayHint> {
        let Some(file) = self.file(uri) else { return Vec::new() };
        let program = &file.program;
        let (Some(steps), Some(lines)) = (program.steps(), program.lines(file.file)) else {
            return Vec::new();
        };
        let name = program.sources().name(file.file);
        let text = program.text(file.file);
        // By line: what is hardest to take back of it.
        let mut by_line: BTreeMap<usize, (Standing, String)> = BTreeMap::new();
        for (span, step) in steps.of_file(name) {
            let line = lines.line_of(span.start);
            let is_asked = (range.start.line as usize..=range.end.line as usize).contains(&line);
            if !is_asked || !(step.is_action || step.standing == Standing::Never) {
                continue;
            }
            let is_harder = by_line.get(&line).is_none_or(|(known, _)| *known < step.standing);
            if let (true, Some(ends)) = (is_harder, steps.ends_of(step)) {
                by_line.insert(line, (step.standing, steps.words(ends, name)));
            }
        }
        let hint = |(line, (standing, ends)): (usize, (Standing, String))| InlayHint {
            position: lines.position(text, lines.end_of(text, line)),
            label: Label::String(short(standing).to_owned()),
            kind: None,
            text_edits: None,
            tooltip: Some(Tooltip::String(tooltip(standing, &ends))),
            padding_left: Some(true),
            padding_right: None,
            data: None,
        };
        by_line.into_iter().map(hint).collect()
    }

    /// How far each sequence, action, I/O operation and advanced move can be taken back.
    pub fn lenses(&mut self, uri: &Uri) -> Vec<CodeLens> {
        let Some(file) = self.file(uri) else { return Vec::new() };
        let program = &file.program;
        let Some(steps) = program.steps() else { return Vec::new() };
        let name = program.sources().name(file.file);
        let is_run = |kind| {
            matches!(kind, SymbolKind::Sequence | SymbolKind::Action | SymbolKind::AdvancedMove)
        };
        let symbols = program.symbols.symbols.iter().filter(|symbol| is_run(symbol.kind));
        let lens = |symbol: &obverse_compiler::symbols::Symbol| {
            let range = program.range(file.file, *symbol.declared.first()?)?;
            let whole = steps.function(&symbol.name)?;
            let title = match steps.stops(&whole.left, name).as_slice() {
                [] => "goes back to its start".to_owned(),
                stops => {
                    let named = stops.iter().take(MOST_STOPS).cloned().collect::<Vec<_>>();
                    let more = stops.len().saturating_sub(MOST_STOPS);
                    let more =
                        if more > 0 { format!(", or at {more} more") } else { String::new() };
                    format!("stops at {}{more}", named.join(", or "))
                }
            };
            // A lens without anything to be done is no command of the editor's.
            let command = Command { title, tooltip: None, command: String::new(), arguments: None };
            Some(CodeLens::new(range, Some(command), None))
        };
        symbols.filter_map(lens).collect()
    }
}

fn short(standing: Standing) -> &'static str {
    match standing {
        Standing::Always => "always",
        Standing::AfterForward => "after",
        Standing::Never => "never",
    }
}

fn tooltip(standing: Standing, ends: &str) -> String {
    let class = match standing {
        Standing::Always => "can be taken back in any state",
        Standing::AfterForward => "can be taken back once it has been run, from what it recorded",
        Standing::Never => "cannot be taken back",
    };
    match ends.is_empty() {
        true => format!("{class}; nothing comes here"),
        false => format!("{class}; from before it a run goes back {ends}"),
    }
}
