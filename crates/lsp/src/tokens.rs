//! The pieces of a text in the words of editors, for colouring by meaning. It knows which name is
//! what; what a piece is, the lexer knows.

use crate::workspace::{InProgram, Workspace};
use lsp_types::{SemanticToken, SemanticTokens, SemanticTokensLegend, Uri};
use obverse_compiler::symbols::{Occurrence, Role, SymbolKind};
use obverse_syntax::highlight::{PieceKind, pieces};
use obverse_syntax::span::Span;
use std::collections::HashMap;

/// The kinds of piece, in the words of the protocol.
const TYPES: [&str; 14] = [
    "keyword",
    "comment",
    "string",
    "number",
    "operator",
    "function",
    "variable",
    "parameter",
    "property",
    "event",
    "label",
    "type",
    "struct",
    "enumMember",
];

/// What else is said of a piece.
const MODIFIERS: [&str; 4] = ["declaration", "readonly", "modification", "defaultLibrary"];

/// What the numbers of pieces mean.
#[must_use]
pub fn legend() -> SemanticTokensLegend {
    let owned = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
    SemanticTokensLegend::new(owned(&TYPES), owned(&MODIFIERS))
}

impl Workspace {
    /// The pieces of a file that is open.
    pub fn tokens(&mut self, uri: &Uri) -> Option<SemanticTokens> {
        let file = self.file(uri)?;
        let (text, start) = (file.program.text(file.file), file.program.start(file.file));
        let lines = file.program.lines(file.file)?;
        let names = names(&file);
        let mut data = Vec::new();
        let (mut line, mut character) = (0, 0);
        for piece in pieces(text) {
            let span = Span::new(piece.span.start + start, piece.span.end + start);
            let Some((kind, modifiers)) = meaning(&file, piece.kind, names.get(&span)) else {
                continue;
            };
            let range = lines.range(text, piece.span);
            let is_same_line = range.start.line == line;
            let before = if is_same_line { character } else { 0 };
            data.push(SemanticToken {
                delta_line: range.start.line - line,
                delta_start: range.start.character - before,
                length: range.end.character.saturating_sub(range.start.character),
                token_type: number(&TYPES, kind),
                token_modifiers_bitset: modifiers,
            });
            (line, character) = (range.start.line, range.start.character);
        }
        Some(SemanticTokens { result_id: None, data })
    }
}

fn names(file: &InProgram) -> HashMap<Span, &Occurrence> {
    let occurrences = file.program.symbols.occurrences.iter();
    occurrences.map(|one| (one.span, one)).collect()
}

fn number(words: &[&str], word: &str) -> u32 {
    words.iter().position(|known| *known == word).map_or(0, |at| at as u32)
}

fn modifier(word: &str) -> u32 {
    1 << number(&MODIFIERS, word)
}

/// The kind of a piece and its modifiers; none where a name leads nowhere, and for what editors
/// need not be told.
fn meaning(
    file: &InProgram,
    kind: PieceKind,
    name: Option<&&Occurrence>,
) -> Option<(&'static str, u32)> {
    if let Some(one) = name {
        let symbol = &file.program.symbols.symbols[one.symbol?];
        let (kind, readonly) = of_symbol(symbol.kind);
        let role = match one.role {
            Role::Declares => modifier("declaration"),
            Role::Assigns => modifier("modification"),
            Role::Uses => 0,
        };
        let is_readonly = if readonly { modifier("readonly") } else { 0 };
        let is_given = matches!(symbol.kind, SymbolKind::Type | SymbolKind::Function);
        let library = if is_given { modifier("defaultLibrary") } else { 0 };
        return Some((kind, role | is_readonly | library));
    }
    let kind = match kind {
        PieceKind::Reserved | PieceKind::Free => "keyword",
        PieceKind::Number => "number",
        PieceKind::Unit => "enumMember",
        PieceKind::Text => "string",
        PieceKind::Comment => "comment",
        PieceKind::Operator => "operator",
        PieceKind::Name | PieceKind::Punctuation => return None,
    };
    Some((kind, 0))
}

/// The kind of a name, and whether what it names never changes.
fn of_symbol(kind: SymbolKind) -> (&'static str, bool) {
    match kind {
        SymbolKind::Io
        | SymbolKind::AdvancedMove
        | SymbolKind::Sequence
        | SymbolKind::Action
        | SymbolKind::Function => ("function", false),
        SymbolKind::Output | SymbolKind::Input => ("property", false),
        SymbolKind::Joints | SymbolKind::Counter => ("variable", true),
        SymbolKind::Variable | SymbolKind::Local | SymbolKind::Position => ("variable", false),
        SymbolKind::Parameter => ("parameter", false),
        SymbolKind::Item | SymbolKind::Tool => ("struct", false),
        SymbolKind::Keyframe => ("property", true),
        SymbolKind::Error => ("event", false),
        SymbolKind::Checkpoint => ("label", false),
        SymbolKind::Type => ("type", false),
    }
}
