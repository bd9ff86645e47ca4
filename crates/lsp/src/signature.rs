//! What belongs where somebody writes: the parameters of what is called, with units, ranges and
//! defaults, or the form of a command, and which part of it is at hand.

use crate::before::Before;
use crate::forms::{self, Command};
use crate::hover::unit_of;
use crate::program::{Program, is_of_library};
use crate::workspace::{InProgram, Workspace};
use lsp_types::{
    ActiveParameter, Documentation, MarkupContent, MarkupKind, ParameterInformation, Position,
    SignatureHelp, SignatureInformation, Uri,
};
use obverse_compiler::symbols;
use obverse_syntax::ast::{Item, Parameter, Sequence};
use obverse_syntax::highlight::PieceKind;
use obverse_syntax::parse_file;
use obverse_syntax::span::Span;
use std::ops::Range;

impl Workspace {
    /// What belongs at a place, if it is among the arguments of a call or in a command.
    pub fn signature(&mut self, uri: &Uri, position: Position) -> Option<SignatureHelp> {
        let file = self.file(uri)?;
        let program = &file.program;
        let offset = program.offset(file.file, position) - program.start(file.file);
        let before = Before::of(program.text(file.file), offset as usize)?;
        let shown = match Call::around(&before) {
            Some(call) => call.shown(&file),
            None => forms::command(&before).map(Shown::from),
        };
        shown.map(|shown| shown.help(self.can_have_none_active))
    }
}

/// A signature.
struct Shown {
    label: String,
    says: String,
    /// Where each parameter stands in the label, in characters, and what is said of it.
    parameters: Vec<(Range<usize>, String)>,
    /// Which of them is at hand; one more than there are, if none is.
    active: usize,
}

impl From<Command> for Shown {
    fn from(command: Command) -> Self {
        let parts = command.parts.into_iter().map(|(range, says)| (range, says.to_owned()));
        let Command { label, active, .. } = command;
        Self { label, says: String::new(), parameters: parts.collect(), active }
    }
}

impl Shown {
    /// `name(first, second)`
    fn call(name: &str, parameters: impl Iterator<Item = (String, String)>) -> Self {
        let mut shown =
            Self { label: format!("{name}("), says: String::new(), parameters: vec![], active: 0 };
        for (index, (parameter, says)) in parameters.enumerate() {
            shown.label.push_str(if index > 0 { ", " } else { "" });
            let begin = shown.label.chars().count();
            shown.label.push_str(&parameter);
            shown.parameters.push((begin..shown.label.chars().count(), says));
        }
        shown.label.push(')');
        shown
    }

    fn help(self, can_have_none_active: bool) -> SignatureHelp {
        let is_none_active = self.active >= self.parameters.len();
        let short = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        let parameter = |(range, says): (Range<usize>, String)| {
            // All that is in a label is a single unit of the protocol.
            let label = (short(range.start), short(range.end)).into();
            ParameterInformation { label, documentation: words(says) }
        };
        let signature = SignatureInformation {
            label: self.label,
            documentation: words(self.says),
            parameters: Some(self.parameters.into_iter().map(parameter).collect()),
            active_parameter: None,
        };
        SignatureHelp {
            signatures: vec![signature],
            active_signature: Some(0),
            // To a client that knows of no other way, one that is not there says the same.
            active_parameter: Some(match is_none_active && can_have_none_active {
                true => ActiveParameter::Null,
                false => short(self.active).into(),
            }),
        }
    }
}

fn words(text: String) -> Option<Documentation> {
    let content = MarkupContent { kind: MarkupKind::Markdown, value: text };
    (!content.value.is_empty()).then_some(Documentation::MarkupContent(content))
}

/// A call that is being written.
struct Call<'w> {
    name: &'w str,
    is_function: bool,
    /// The arguments so far, each with the name of its parameter if that is written.
    arguments: Vec<Option<&'w str>>,
}

impl<'w> Call<'w> {
    /// The innermost call whose arguments a text ends in.
    fn around(before: &Before<'w>) -> Option<Self> {
        let begin = |index: usize| match before.at(index + 1) {
            ":" => Some(before.at(index)),
            _ => None,
        };
        let (mut depth, mut commas) = (0_usize, Vec::new());
        for index in (0..before.pieces.len()).rev() {
            match before.at(index) {
                ")" | "]" => depth += 1,
                "(" | "[" if depth > 0 => depth -= 1,
                "," if depth == 0 => commas.push(index),
                "[" => commas.clear(),
                "(" => {
                    let ago = |count| index.checked_sub(count).map_or("", |index| before.at(index));
                    let name = ago(1);
                    let is_call = ago(2) == "call";
                    let is_function = is_function(name);
                    if is_call || is_function {
                        let begins = [index].into_iter().chain(commas.into_iter().rev());
                        let arguments = begins.map(|sign| begin(sign + 1)).collect();
                        return Some(Self { name, is_function: !is_call, arguments });
                    }
                    commas.clear();
                }
                "{" | "}" | ";" => return None,
                "call" => {
                    // Nothing is written yet but what is called.
                    let is_named = index + 2 == before.pieces.len() && before.is_same_line();
                    let name = before.at(index + 1);
                    let call = Self { name, is_function: false, arguments: vec![None] };
                    return is_named.then_some(call);
                }
                word => {
                    let is_reserved = before.pieces[index].kind == PieceKind::Reserved;
                    if is_reserved && !is_of_value(word) {
                        return None;
                    }
                }
            }
        }
        None
    }

    fn shown(&self, file: &InProgram) -> Option<Shown> {
        if self.is_function {
            let (name, count) =
                symbols::functions().into_iter().find(|(name, _)| *name == self.name)?;
            let parameters = ["value", "other"].into_iter().take(count);
            let parameters = parameters.map(|name| (name.to_owned(), String::new()));
            return Some(Shown {
                active: self.arguments.len() - 1,
                ..Shown::call(name, parameters)
            });
        }
        let program = &file.program;
        (0..program.sources().len()).find_map(|index| {
            let tree = parse_file(program.sources(), index).program;
            tree.items.iter().find_map(|item| match item {
                Item::Sequence(sequence) if sequence.name.value == self.name => {
                    Some(self.of_sequence(program, index, sequence))
                }
                _ => None,
            })
        })
    }

    fn of_sequence(&self, program: &Program, file: usize, sequence: &Sequence<'_>) -> Shown {
        let written = |parameter: &Parameter<'_>| {
            let end = match (&parameter.default, &parameter.range) {
                (Some(default), _) => default.span.end,
                (None, Some(range)) => range.most.span.end,
                (None, None) => parameter.type_name.span.end,
            };
            let text = program.written(Span::new(parameter.name.span.start, end));
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
            (text, says(program, parameter))
        };
        let parameters = sequence.parameters.iter().map(written);
        Shown {
            says: comment(program, file, sequence.span),
            active: self.active(&sequence.parameters),
            ..Shown::call(self.name, parameters)
        }
    }

    /// Which parameter the last argument is of.
    fn active(&self, parameters: &[Parameter<'_>]) -> usize {
        let Some((last, given)) = self.arguments.split_last() else { return 0 };
        let named = |name: &str| parameters.iter().position(|one| one.name.value == name);
        match last {
            Some(name) => named(name).unwrap_or(parameters.len()),
            None if given.iter().all(Option::is_none) => given.len(),
            None => {
                // Behind one with a name all have one: the first that is left.
                let by_order = given.iter().take_while(|name| name.is_none()).count();
                let is_left = |index: &usize| {
                    let name = parameters[*index].name.value;
                    !given.contains(&Some(name))
                };
                (by_order..parameters.len()).find(is_left).unwrap_or(parameters.len())
            }
        }
    }
}

fn is_function(name: &str) -> bool {
    symbols::functions().iter().any(|(known, _)| *known == name)
}

/// Whether a word that cannot be a name can stand in a value.
fn is_of_value(word: &str) -> bool {
    const WORDS: [&str; 10] =
        ["and", "or", "not", "mod", "true", "false", "force", "distance", "holding", "input"];
    WORDS.contains(&word)
}

/// What is said of a parameter: its type with units, its range and its default.
fn says(program: &Program, parameter: &Parameter<'_>) -> String {
    let of_type = parameter.type_name.value;
    let mut says = of_type.to_owned();
    if let Some(units) = unit_of(of_type) {
        says += &format!(", in {units}");
    }
    if let Some(range) = &parameter.range {
        let (least, most) = (program.written(range.least.span), program.written(range.most.span));
        says += &format!("; from {least} to {most}");
    }
    says += &match &parameter.default {
        Some(default) => format!("; {} where it is left out", program.written(default.span)),
        None => "; must be given".to_owned(),
    };
    says
}

/// What is written of a declaration in the comment before it; of one of the library, at the head
/// of its file.
fn comment(program: &Program, file: usize, span: Span) -> String {
    let of_line = |line: &str| line.trim().strip_prefix("//").map(|text| text.trim().to_owned());
    if is_of_library(program.sources().name(file)) {
        let lines = program.text(file).lines().map_while(of_line);
        return lines.collect::<Vec<_>>().join("\n");
    }
    let start = (span.start - program.start(file)) as usize;
    let before = program.text(file).get(..start).unwrap_or("");
    let mut lines: Vec<String> = before.lines().rev().map_while(of_line).collect();
    lines.reverse();
    lines.join("\n")
}
