//! Where names lead: definition, references, highlights, the outline of a file.

use crate::program::{Place, Program, is_of_library};
use crate::workspace::{InProgram, Workspace};
use lsp_types::{
    DocumentHighlight, DocumentHighlightKind, DocumentSymbol, Location, Position, Uri,
};
use obverse_compiler::symbols::{Occurrence, Role, Symbol, SymbolId, SymbolKind};
use obverse_syntax::imports;
use obverse_syntax::span::Span;

impl Workspace {
    /// Where the name at a place is declared; of an import, the file.
    pub fn definition(&mut self, uri: &Uri, position: Position) -> Vec<Location> {
        let mut found = Vec::new();
        for file in self.files(uri) {
            let places = match symbol_at(&file, position) {
                Some((symbol, _)) => {
                    let declared = &file.program.symbols.symbols[symbol].declared;
                    declared.iter().filter_map(|span| file.program.place(*span)).collect()
                }
                None => imported_at(&file, position).into_iter().collect(),
            };
            self.add_locations(places, &mut found);
        }
        found
    }

    /// Every place where what is named at a place is named, in every program that the file is part
    /// of.
    pub fn references(
        &mut self,
        uri: &Uri,
        position: Position,
        with_declarations: bool,
    ) -> Vec<Location> {
        let mut found = Vec::new();
        for file in self.files(uri) {
            let Some((symbol, _)) = symbol_at(&file, position) else { continue };
            let places = file.program.symbols.of_symbol(symbol);
            let places = places.filter(|one| with_declarations || one.role != Role::Declares);
            let places = places.filter_map(|one| file.program.place(one.span)).collect();
            self.add_locations(places, &mut found);
        }
        found
    }

    fn add_locations(&self, places: Vec<Place>, found: &mut Vec<Location>) {
        for (key, range) in places {
            let location = Location::new(self.uri(&key), range);
            if !found.contains(&location) {
                found.push(location);
            }
        }
    }

    /// Where in the same file what is named at a place is named.
    pub fn highlights(&mut self, uri: &Uri, position: Position) -> Vec<DocumentHighlight> {
        let Some(file) = self.file(uri) else { return Vec::new() };
        let Some((symbol, _)) = symbol_at(&file, position) else { return Vec::new() };
        let highlight = |one: &Occurrence| {
            let kind = match one.role {
                Role::Uses => DocumentHighlightKind::Read,
                Role::Declares | Role::Assigns => DocumentHighlightKind::Write,
            };
            let range = file.program.range(file.file, one.span)?;
            Some(DocumentHighlight::new(range, Some(kind)))
        };
        file.program.symbols.of_symbol(symbol).filter_map(highlight).collect()
    }

    /// What a file declares, each with what belongs to it.
    pub fn outline(&mut self, uri: &Uri) -> Vec<DocumentSymbol> {
        let Some(file) = self.file(uri) else { return Vec::new() };
        let symbols = &file.program.symbols;
        let top = symbols.symbols.iter().enumerate();
        let top = top.filter(|(_, symbol)| symbol.parent.is_none());
        top.filter_map(|(id, symbol)| outlined(&file, id, symbol)).collect()
    }
}

/// What is named at a place, and where exactly that stands.
pub(crate) fn symbol_at(file: &InProgram, position: Position) -> Option<(SymbolId, Span)> {
    let offset = file.program.offset(file.file, position);
    let found = file.program.symbols.at(offset)?;
    // Beyond the end of a file the next one begins.
    file.program.range(file.file, found.span)?;
    Some((found.symbol?, found.span))
}

/// The file that is imported at a place.
fn imported_at(file: &InProgram, position: Position) -> Option<Place> {
    let program: &Program = &file.program;
    let offset = program.offset(file.file, position);
    let imports = imports(program.sources(), file.file);
    let mut at = imports.iter().filter(|one| {
        let Span { start, end } = one.path.span;
        start <= offset && offset <= end
    });
    let one = at.next()?;
    let target = program.imported(file.file, one.is_library, one.path.value)?;
    program.place(Span::new(program.start(target), program.start(target)))
}

fn outlined(file: &InProgram, id: SymbolId, symbol: &Symbol) -> Option<DocumentSymbol> {
    let program = &file.program;
    let name = *symbol.declared.first()?;
    let (range, selection_range) =
        (program.range(file.file, symbol.whole)?, program.range(file.file, name)?);
    if is_of_library(program.sources().name(file.file)) {
        return None;
    }
    let belongs = |kind| {
        matches!(kind, SymbolKind::Keyframe | SymbolKind::Parameter | SymbolKind::Checkpoint)
    };
    let children = program.symbols.children(id).filter(|(_, child)| belongs(child.kind));
    let children: Vec<DocumentSymbol> =
        children.filter_map(|(id, child)| outlined(file, id, child)).collect();
    #[allow(deprecated, reason = "the field is there, whatever is in it")]
    Some(DocumentSymbol {
        name: symbol.name.clone(),
        detail: Some(match &symbol.of_type {
            Some(of_type) if symbol.kind != SymbolKind::Joints => of_type.clone(),
            _ => symbol.kind.name().to_owned(),
        }),
        kind: outline_kind(symbol.kind),
        tags: None,
        deprecated: None,
        range,
        selection_range,
        children: (!children.is_empty()).then_some(children),
    })
}

fn outline_kind(kind: SymbolKind) -> lsp_types::SymbolKind {
    use lsp_types::SymbolKind as Shown;
    match kind {
        SymbolKind::Io | SymbolKind::AdvancedMove => Shown::Method,
        SymbolKind::Sequence | SymbolKind::Action | SymbolKind::Function => Shown::Function,
        SymbolKind::Output | SymbolKind::Input => Shown::Interface,
        SymbolKind::Joints | SymbolKind::Position => Shown::Constant,
        SymbolKind::Item | SymbolKind::Tool => Shown::Object,
        SymbolKind::Keyframe => Shown::Field,
        SymbolKind::Error => Shown::Event,
        SymbolKind::Checkpoint => Shown::Key,
        SymbolKind::Type => Shown::Class,
        SymbolKind::Variable | SymbolKind::Parameter | SymbolKind::Local | SymbolKind::Counter => {
            Shown::Variable
        }
    }
}
