//! What may be written next: the words that the grammar allows, names of the kind that is needed,
//! keyframes behind an item, units behind a number. A list that is not long.

use crate::before::Before;
use crate::workspace::{InProgram, Workspace};
use lsp_types::{CompletionItem, CompletionItemKind, CompletionList, Position, Uri};
use obverse_compiler::symbols::{self, Symbol, SymbolKind};
use obverse_syntax::UNITS;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::expected::{Expected, expected_after};
use obverse_syntax::highlight::PieceKind;

/// The most that is offered.
const MOST_OFFERED: usize = 200;

/// What names of a kind are for.
const VALUES: &[SymbolKind] =
    &[SymbolKind::Variable, SymbolKind::Local, SymbolKind::Parameter, SymbolKind::Counter];
const TARGETS: &[SymbolKind] = &[
    SymbolKind::Joints,
    SymbolKind::Position,
    SymbolKind::Item,
    SymbolKind::Parameter,
    SymbolKind::Local,
    SymbolKind::Variable,
];
const ARGUMENTS: &[SymbolKind] = &[
    SymbolKind::Variable,
    SymbolKind::Local,
    SymbolKind::Parameter,
    SymbolKind::Counter,
    SymbolKind::Joints,
    SymbolKind::Item,
];

impl Workspace {
    /// What may be written at a place, the likeliest first; nothing within texts and comments.
    pub fn completion(&mut self, uri: &Uri, position: Position) -> CompletionList {
        let mut items = Vec::new();
        if let Some(file) = self.file(uri) {
            let program = &file.program;
            let text = program.text(file.file);
            let offset = program.offset(file.file, position) - program.start(file.file);
            if let Some(writing) = Writing::of(&file, text, offset as usize) {
                items = writing.items();
            }
        }
        let is_incomplete = items.len() > MOST_OFFERED;
        items.truncate(MOST_OFFERED);
        CompletionList { is_incomplete, items, ..CompletionList::default() }
    }
}

/// A place where somebody is writing.
struct Writing<'w> {
    file: &'w InProgram,
    before: Before<'w>,
    expected: Expected,
}

impl<'w> Writing<'w> {
    /// The place at an offset of a text; none within a text in quotes or a comment.
    fn of(file: &'w InProgram, text: &'w str, offset: usize) -> Option<Self> {
        let before = Before::of(text, offset)?;
        let expected = expected_after(before.text).unwrap_or_default();
        Some(Self { file, before, expected })
    }

    /// The piece so many pieces ago, as text.
    fn ago(&self, count: usize) -> &'w str {
        self.before.ago(count)
    }

    /// Whether the line of the last piece goes on.
    fn is_same_line(&self) -> bool {
        self.before.is_same_line()
    }

    fn items(&self) -> Vec<CompletionItem> {
        let last = self.before.pieces.last().map(|piece| piece.kind);
        let is_number = last == Some(PieceKind::Number) || self.ago(1) == "]";
        let mut items = Vec::new();
        if is_number && self.is_same_line() {
            let units = self.units().into_iter();
            items.extend(units.map(|unit| item("0", unit, CompletionItemKind::Unit, "unit")));
        }
        if self.ago(1) == "." {
            return self.keyframes();
        }
        items.extend(self.names());
        items.extend(self.words());
        items.sort_by(|a, b| a.sort_text.cmp(&b.sort_text));
        items.dedup_by(|a, b| a.label == b.label);
        items
    }

    /// The units that a number may lack, where it is known what it measures; else all.
    fn units(&self) -> Vec<&str> {
        let program = &self.file.program;
        let end = self.before.pieces.last().map_or(0, |piece| piece.span.end);
        let end = program.start(self.file.file) + end;
        let lacks = |one: &&Diagnostic| {
            one.code == Code::MissingUnit && one.primary.span.end == end && !one.choices.is_empty()
        };
        match program.compiled.diagnostics.iter().find(lacks) {
            Some(one) => {
                one.choices.iter().filter_map(|it| it.text.split_whitespace().last()).collect()
            }
            None => UNITS.to_vec(),
        }
    }

    /// The words of the language. On the line of a statement that could go on, those that begin the
    /// next one are not among them.
    fn words(&self) -> Vec<CompletionItem> {
        let is_new = matches!(self.ago(1), "" | "{" | "}" | ";") || !self.is_same_line();
        let begins = |word: &str| {
            self.expected.is_statement
                && !is_new
                && expected_after("sequence a {").is_some_and(|start| start.words.contains(&word))
        };
        let words = self.expected.words.iter().filter(|word| !begins(word));
        words.map(|word| item("1", word, CompletionItemKind::Keyword, "")).collect()
    }

    /// The names of the kind that is needed here.
    fn names(&self) -> Vec<CompletionItem> {
        let (last, before) = (self.ago(1), self.ago(2));
        let kinds: &[SymbolKind] = match (before, last) {
            (_, "advance") => &[SymbolKind::AdvancedMove],
            (_, "call" | "using") => &[SymbolKind::Sequence, SymbolKind::Action],
            (_, "throw") => &[SymbolKind::Error],
            ("move", "to") => TARGETS,
            (_, "checkpoint") if before == "to" => return self.everywhere(SymbolKind::Checkpoint),
            (_, "tool") => return self.everywhere(SymbolKind::Tool),
            (_, "set" | "toggle") => &[SymbolKind::Output],
            (_, "input") if !self.expected.words.contains(&"sequence") => &[SymbolKind::Input],
            ("}", "reverse") => &[SymbolKind::Io, SymbolKind::AdvancedMove],
            (_, "io") if !self.is_declaring() => &[SymbolKind::Io],
            (_, "allow") => return warnings(),
            (_, ":") if !self.expected.is_value && self.expected.is_name => return types(),
            _ if self.expected.is_value => return self.values(),
            _ if self.expected.is_statement && !self.expected.is_top && self.is_new_line() => {
                &[SymbolKind::Variable, SymbolKind::Local, SymbolKind::Parameter]
            }
            _ => &[],
        };
        self.visible(kinds)
    }

    fn is_new_line(&self) -> bool {
        !self.is_same_line() || matches!(self.ago(1), "{" | "}" | ";")
    }

    /// Whether this is outside of all blocks, where `io` declares.
    fn is_declaring(&self) -> bool {
        let signs = |sign: &str| self.pieces_of(sign);
        signs("{") <= signs("}")
    }

    fn pieces_of(&self, sign: &str) -> usize {
        let all = 0..self.before.pieces.len();
        all.filter(|&index| self.before.at(index) == sign).count()
    }

    /// What can stand in an expression here, and in a call the names of parameters.
    fn values(&self) -> Vec<CompletionItem> {
        let callee = self.callee();
        let mut items = self.visible(if callee.is_some() { ARGUMENTS } else { VALUES });
        let symbols = &self.file.program.symbols;
        if let (Some(callee), "(" | ",") = (callee, self.ago(1)) {
            let parameters = symbols.symbols.iter().position(|symbol| {
                symbol.name == callee
                    && matches!(symbol.kind, SymbolKind::Sequence | SymbolKind::Action)
            });
            let of_callee = parameters.into_iter().flat_map(|callee| symbols.children(callee));
            let of_callee = of_callee.filter(|(_, one)| one.kind == SymbolKind::Parameter);
            items.extend(of_callee.map(|(_, parameter)| {
                let label = format!("{}: ", parameter.name);
                let of_type = parameter.of_type.clone().unwrap_or_default();
                item("0", &label, CompletionItemKind::Property, &of_type)
            }));
        }
        let function = |(name, count): (&str, usize)| {
            let detail = if count == 1 { "of one value" } else { "of two values" };
            item("2", name, CompletionItemKind::Function, detail)
        };
        items.extend(symbols::functions().into_iter().map(function));
        items
    }

    /// What is called, if this is among the arguments of a call.
    fn callee(&self) -> Option<&'w str> {
        let mut depth = 0;
        for count in 1..=self.before.pieces.len() {
            match self.ago(count) {
                ")" => depth += 1,
                "(" if depth > 0 => depth -= 1,
                "(" => {
                    let is_call = self.ago(count + 2) == "call";
                    return is_call.then(|| self.ago(count + 1));
                }
                "{" | "}" | ";" => return None,
                _ => {}
            }
        }
        None
    }

    /// The keyframes of the item before the point; of a parameter, those of every item.
    fn keyframes(&self) -> Vec<CompletionItem> {
        let program = &self.file.program;
        let symbols = &program.symbols.symbols;
        let named = self.ago(2);
        let is_item = |symbol: &Symbol| symbol.kind == SymbolKind::Item && symbol.name == named;
        let is_one = symbols.iter().any(is_item);
        let of_item = symbols.iter().filter(|symbol| {
            let item = symbol.parent.and_then(|parent| symbols.get(parent));
            symbol.kind == SymbolKind::Keyframe && (!is_one || item.is_some_and(is_item))
        });
        let detail = |symbol: &Symbol| {
            let item = symbol.parent.and_then(|parent| symbols.get(parent));
            item.map_or_else(String::new, |item| format!("keyframe of {}", item.name))
        };
        let mut items: Vec<CompletionItem> = of_item
            .map(|symbol| item("0", &symbol.name, CompletionItemKind::Field, &detail(symbol)))
            .collect();
        items.sort_by(|a, b| a.label.cmp(&b.label));
        items.dedup_by(|a, b| a.label == b.label);
        items
    }

    /// What can be seen here of some kinds.
    fn visible(&self, kinds: &[SymbolKind]) -> Vec<CompletionItem> {
        let program = &self.file.program;
        let offset = program.start(self.file.file) + self.before.text.len() as u32;
        let seen = program.symbols.visible(offset);
        seen.filter(|(_, symbol)| kinds.contains(&symbol.kind)).map(|(_, one)| named(one)).collect()
    }

    /// What has a name of its own wherever it is named.
    fn everywhere(&self, kind: SymbolKind) -> Vec<CompletionItem> {
        let symbols = self.file.program.symbols.symbols.iter();
        symbols.filter(|symbol| symbol.kind == kind).map(named).collect()
    }
}

fn types() -> Vec<CompletionItem> {
    let types = symbols::types().into_iter();
    types.map(|name| item("0", name, CompletionItemKind::Class, "type")).collect()
}

fn warnings() -> Vec<CompletionItem> {
    let codes = Code::ALL.iter().filter(|code| code.as_str().starts_with('W'));
    codes
        .map(|code| item("0", code.as_str(), CompletionItemKind::Value, code.page().title))
        .collect()
}

fn named(symbol: &Symbol) -> CompletionItem {
    let kind = match symbol.kind {
        SymbolKind::Io | SymbolKind::AdvancedMove => CompletionItemKind::Method,
        SymbolKind::Sequence | SymbolKind::Action | SymbolKind::Function => {
            CompletionItemKind::Function
        }
        SymbolKind::Joints | SymbolKind::Position => CompletionItemKind::Constant,
        SymbolKind::Item | SymbolKind::Tool => CompletionItemKind::Struct,
        SymbolKind::Error => CompletionItemKind::Event,
        SymbolKind::Checkpoint => CompletionItemKind::Reference,
        SymbolKind::Output | SymbolKind::Input => CompletionItemKind::Property,
        _ => CompletionItemKind::Variable,
    };
    let detail = symbol.of_type.as_deref().unwrap_or(symbol.kind.name());
    item("0", &symbol.name, kind, detail)
}

fn item(rank: &str, label: &str, kind: CompletionItemKind, detail: &str) -> CompletionItem {
    CompletionItem {
        label: label.to_owned(),
        kind: Some(kind),
        detail: (!detail.is_empty()).then(|| detail.to_owned()),
        sort_text: Some(format!("{rank}{label}")),
        ..CompletionItem::default()
    }
}
