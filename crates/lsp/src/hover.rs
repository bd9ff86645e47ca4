//! What is said of the thing under the pointer: what it is, of which type and unit, its class, what
//! going back over it does, and how far back one can go from there.

use crate::backwards::{Declarations, statement_at};
use crate::feeling;
use crate::navigate::symbol_at;
use crate::program::Program;
use crate::steps::{Step, Steps};
use crate::workspace::{InProgram, Workspace};
use lsp_types::{Contents, Hover, MarkupContent, MarkupKind, Position, Uri};
use obverse_compiler::symbols::{Symbol, SymbolId, SymbolKind};
use obverse_reach::Standing;
use obverse_syntax::ast::{Program as Tree, Statement, StatementKind};
use obverse_syntax::codes::Code;
use obverse_syntax::highlight::{Piece, PieceKind, pieces};
use obverse_syntax::parse_file;
use obverse_syntax::span::Span;

/// The longest declaration that is shown whole, in lines.
const MOST_LINES: usize = 12;

impl Workspace {
    /// What is said of what stands at a place, if anything is.
    pub fn hover(&mut self, uri: &Uri, position: Position) -> Option<Hover> {
        let file = self.file(uri)?;
        let sources = file.program.sources();
        let trees: Vec<Tree<'_>> =
            (0..sources.len()).map(|index| parse_file(sources, index).program).collect();
        let hovered = Hovered { file: &file, trees: &trees };
        let (text, span) = match symbol_at(&file, position) {
            Some((symbol, span)) => (hovered.of_symbol(symbol, span), span),
            None => hovered.of_word(position)?,
        };
        let range = file.program.range(file.file, span);
        let contents = MarkupContent { kind: MarkupKind::Markdown, value: text };
        Some(Hover { contents: Contents::MarkupContent(contents), range })
    }
}

struct Hovered<'t, 's> {
    file: &'t InProgram,
    trees: &'t [Tree<'s>],
}

impl Hovered<'_, '_> {
    fn program(&self) -> &Program {
        &self.file.program
    }

    fn name_of_file(&self) -> &str {
        self.program().sources().name(self.file.file)
    }

    /// What is said of a name: its declaration, its kind and type, its class and reverse.
    fn of_symbol(&self, id: SymbolId, at: Span) -> String {
        let symbol = &self.program().symbols.symbols[id];
        let mut text = String::new();
        if !symbol.declared.is_empty() {
            text += &format!("```obverse\n{}\n```\n", self.declaration(symbol));
        }
        text += &self.kind(symbol);
        if let Some(steps) = self.program().steps()
            && let Some(whole) = steps.function(&symbol.name)
            && is_run(symbol.kind)
        {
            text += &format!("\n\nClass *{}*", whole.standing.name());
            text += &match steps.stops(&whole.left, self.name_of_file()).as_slice() {
                [] => ": it can be taken back to its start".to_owned(),
                stops => format!(": going back stops at {}", stops.join(", or ")),
            };
        }
        let declarations = Declarations(self.trees);
        match symbol.kind {
            SymbolKind::Io => {
                text += &format!("\n\nIn reverse: {}", declarations.of_io(&symbol.name));
            }
            SymbolKind::AdvancedMove => {
                text += &format!("\n\nIn reverse: {}", declarations.of_advanced(&symbol.name));
            }
            _ => {}
        }
        if let Some(how_far) = self.how_far_back(at.start) {
            text += &format!("\n\n{how_far}");
        }
        text
    }

    /// The declaration as it is written; its head, if it is long.
    fn declaration(&self, symbol: &Symbol) -> String {
        let text = self.program().written(symbol.whole);
        let is_head = matches!(symbol.kind, SymbolKind::Sequence | SymbolKind::Action);
        let lines = text.lines().count();
        if is_head || lines > MOST_LINES {
            let head = text.split('{').next().unwrap_or(text);
            return head.trim_end().to_owned();
        }
        // As far to the left as its last line.
        let indent = text.lines().last().map_or(0, |last| last.len() - last.trim_start().len());
        let line = |line: &str| {
            line.get(indent..)
                .filter(|_| is_blank(line, indent))
                .map_or(line.to_owned(), str::to_owned)
        };
        text.lines().map(line).collect::<Vec<_>>().join("\n")
    }

    fn kind(&self, symbol: &Symbol) -> String {
        let kind = symbol.kind.name();
        let article = if is_spoken_with_an(kind) { "An" } else { "A" };
        let parent = symbol.parent.map(|parent| &self.program().symbols.symbols[parent]);
        let of_type = symbol.of_type.as_ref().filter(|_| symbol.kind != SymbolKind::Joints);
        match (symbol.kind, of_type, parent) {
            (SymbolKind::Type, ..) => match unit_of(&symbol.name) {
                Some(units) => format!("{article} type; its values have a unit: {units}"),
                None => format!("{article} type"),
            },
            (SymbolKind::Keyframe, _, Some(item)) => {
                format!("{article} {kind} of the item `{}`", item.name)
            }
            (_, Some(of_type), _) => match unit_of_words(of_type) {
                Some(units) => format!("{article} {kind}: {of_type} ({units})"),
                None => format!("{article} {kind}: {of_type}"),
            },
            _ => format!("{article} {kind}"),
        }
    }

    /// What is said of a word of the language: of the statement that it is of, a unit, a code.
    fn of_word(&self, position: Position) -> Option<(String, Span)> {
        let (program, file) = (self.program(), self.file.file);
        let start = program.start(file);
        let offset = program.offset(file, position);
        let text = program.text(file);
        let is_at =
            |piece: &&Piece| piece.span.start + start <= offset && offset <= piece.span.end + start;
        let pieces = pieces(text);
        let mut at = pieces.iter().rev().filter(is_at);
        let piece = at.find(|piece| piece.kind != PieceKind::Punctuation)?;
        let span = Span::new(piece.span.start + start, piece.span.end + start);
        let word = program.written(span);
        match piece.kind {
            PieceKind::Unit => return Some((unit_words(word)?, span)),
            PieceKind::Name if word.starts_with(['W', 'E']) => {
                let code: Code = word.parse().ok()?;
                let text = format!("**{code}**: {}\n\n{}", code.page().title, code.page().reason);
                return Some((text, span));
            }
            PieceKind::Reserved | PieceKind::Free => {}
            _ => return None,
        }
        let Some(statement) = statement_at(&self.trees[file], offset) else {
            return Some((feeling::said(&self.trees[file], offset, word)?, span));
        };
        // What stands in its blocks is said of other statements.
        let in_block = statement
            .blocks()
            .iter()
            .any(|block| block.span.start < offset && offset < block.span.end);
        if in_block {
            return None;
        }
        let mut text = String::new();
        if let Some((steps, step)) = self.step_at(statement.span.start) {
            text += &format!("Class *{}*\n\n", step.standing.name());
            text += &format!("In reverse: {}", self.in_reverse(statement, steps, step));
            text += &format!("\n\n{}", self.ends(steps, step));
        } else {
            let words = Declarations(self.trees).of_statement(statement);
            if words.is_empty() {
                return None;
            }
            text += &format!("In reverse: {words}");
        }
        Some((text, span))
    }

    /// What going back over a statement does: no further than to what cannot be taken back in it.
    fn in_reverse(&self, statement: &Statement<'_>, steps: &Steps, step: &Step) -> String {
        let words = Declarations(self.trees).of_statement(statement);
        if step.standing != Standing::Never {
            return words;
        }
        let called = match &statement.kind {
            StatementKind::Call { name, .. } => steps.function(name.value),
            _ => None,
        };
        let stops = called.map(|whole| steps.stops(&whole.left, self.name_of_file()));
        match stops.unwrap_or_default().as_slice() {
            [] => "going back ends here".to_owned(),
            stops => format!("{words}; but going back stops within it, at {}", stops.join(", or ")),
        }
    }

    /// How far back one can go from the statement around a position.
    fn how_far_back(&self, offset: u32) -> Option<String> {
        let statement = statement_at(&self.trees[self.file.file], offset)?;
        let (steps, step) = self.step_at(statement.span.start)?;
        let mut text = self.ends(steps, step);
        if step.standing == Standing::Never {
            text = format!("This statement is of class *never*. {text}");
        }
        Some(text)
    }

    fn ends(&self, steps: &Steps, step: &Step) -> String {
        let ends = steps.ends_of(step).filter(|ends| !ends.ends.is_empty());
        match ends {
            Some(ends) => {
                format!(
                    "From before this statement a run goes back {}",
                    steps.words(ends, self.name_of_file())
                )
            }
            None => "Nothing comes here".to_owned(),
        }
    }

    fn step_at(&self, offset: u32) -> Option<(&Steps, &Step)> {
        let steps = self.program().steps()?;
        let within = offset - self.program().start(self.file.file).min(offset);
        let mut found = steps.of_file(self.name_of_file());
        let (_, step) = found.find(|(span, _)| span.start == within)?;
        Some((steps, step))
    }
}

/// Whether `an` stands before it.
pub(crate) fn is_spoken_with_an(noun: &str) -> bool {
    noun.starts_with(['a', 'e', 'i', 'o', 'I'])
}

fn is_blank(line: &str, indent: usize) -> bool {
    line.bytes().take(indent).all(|byte| byte == b' ')
}

/// Whether things of this kind are run.
fn is_run(kind: SymbolKind) -> bool {
    matches!(
        kind,
        SymbolKind::Io | SymbolKind::AdvancedMove | SymbolKind::Sequence | SymbolKind::Action
    )
}

/// The units of a type.
pub(crate) fn unit_of(name: &str) -> Option<&'static str> {
    let units = match name {
        "length" => "um, mm, cm or m",
        "angle" => "deg or rad",
        "time" => "ms, s or min",
        "force" => "N",
        "speed" => "mm/s or m/s",
        _ => return None,
    };
    Some(units)
}

/// The same by the type in words: `a length`.
fn unit_of_words(of_type: &str) -> Option<&'static str> {
    of_type.split_once(' ').and_then(|(_, name)| unit_of(name))
}

/// What a unit measures.
fn unit_words(unit: &str) -> Option<String> {
    let (what, si) = match unit {
        "um" => ("a length", "a millionth of a metre"),
        "mm" => ("a length", "a thousandth of a metre"),
        "cm" => ("a length", "a hundredth of a metre"),
        "m" => ("a length", "a metre"),
        "deg" => ("an angle", "a degree"),
        "rad" => ("an angle", "a radian"),
        "ms" => ("a time", "a thousandth of a second"),
        "s" => ("a time", "a second"),
        "min" => ("a time", "sixty seconds"),
        "N" => ("a force", "a newton"),
        "mm/s" | "m/s" => ("a speed", "a way over a time"),
        "deg/s" | "rad/s" => ("a turning speed", "an angle over a time"),
        _ => return None,
    };
    Some(format!("The unit of {what}: {si}"))
}
