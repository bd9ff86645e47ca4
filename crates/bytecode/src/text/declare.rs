//! The first pass: tables, functions, and where labels are. Leaves for the second pass every line
//! that names something.

use super::error::{AsmError, Errors, Wrong, none_of, shown, unknown};
use super::mention;
use super::quote::{is_bare, unquote};
use super::scan::{Scanner, Token};
use crate::code::ModuleCode;
use crate::fault::{Bounds, Watched};
use crate::module::{
    Constant, Continuation, ErrorDeclaration, Function, FunctionKind, Item, Module, Otherwise,
    Recovery, Respond, Severity, SourceEntry, SourceFile, Variable,
};
use obverse_isa::{OPS, Opcode, Type};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// What the first pass finds.
#[derive(Debug, Default)]
pub(super) struct Declared<'t> {
    /// The module without code, and without what names something.
    pub(super) module: Module,
    /// For each stretch of code, the function that it belongs to.
    pub(super) sections: Vec<Option<usize>>,
    /// By stretch of code and name, the instruction that a label names.
    pub(super) labels: BTreeMap<(usize, &'t str), u32>,
    /// What is left, in order.
    pub(super) uses: Vec<Use<'t>>,
    pub(super) errors: Errors,
}

/// A line that names something, read up to where the names begin.
#[derive(Debug)]
pub(super) struct Use<'t> {
    pub(super) what: What,
    pub(super) rest: Scanner<'t>,
}

/// What a line is that names something.
#[derive(Clone, Copy, Debug)]
pub(super) enum What {
    /// An instruction of a stretch of code, with the prefix that the text gives it, if any.
    Instr { opcode: Opcode, section: usize, prefix: Option<u8> },
    /// A keyframe of an item.
    At { item: usize },
    /// How an error is recovered from.
    Recover { error: usize },
    /// What follows when recovering an error has been given up.
    Otherwise { error: usize },
    /// The function that runs at the end.
    Cleanup,
}

/// What the lines above have opened for the next ones to add to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Opened {
    #[default]
    Nothing,
    Item,
    Error,
    Source {
        /// Whether it has a line of text.
        has_text: bool,
    },
}

#[derive(Default)]
struct Reader<'t> {
    declared: Declared<'t>,
    opened: Opened,
    /// The index of the next instruction.
    here: u32,
    /// Whether the present function has said where its code is.
    has_range: bool,
    /// The prefix that the next instruction is given.
    prefix: Option<u8>,
}

/// Every directive.
pub const DIRECTIVES: &[&str] = &[
    ".at",
    ".bounds",
    ".cell",
    ".checkpoint",
    ".cleanup",
    ".code",
    ".const",
    ".counters",
    ".error",
    ".function",
    ".global",
    ".item",
    ".joints",
    ".keyframe",
    ".local",
    ".loop",
    ".map",
    ".mention",
    ".on",
    ".otherwise",
    ".parameter",
    ".parameters",
    ".prefix",
    ".range",
    ".reason",
    ".recover",
    ".respond",
    ".slot",
    ".source",
    ".then",
    ".tool",
    ".watch",
];

/// Those that say what an error does.
const OF_ERRORS: [&str; 7] =
    [".bounds", ".on", ".otherwise", ".recover", ".respond", ".then", ".watch"];

/// The first pass over a text.
pub(super) fn declare(text: &str) -> Declared<'_> {
    let mut reader = Reader::default();
    let mut lines = (1..).zip(text.lines()).map(|(number, line)| Scanner::new(number, line));
    if let Err(error) = header(&mut lines) {
        reader.declared.errors.add(error);
        return reader.declared;
    }
    for line in lines {
        let result = reader.line(line);
        reader.declared.errors.keep(result);
        if reader.declared.errors.is_full() {
            break;
        }
    }
    reader.close_function();
    reader.declared
}

fn header<'t>(lines: &mut impl Iterator<Item = Scanner<'t>>) -> Result<(), AsmError> {
    const EXPECTED: &str = "assembly text begins with the line `obvasm 1`";
    for mut line in lines {
        let Some(token) = line.token()? else { continue };
        if token.value != Token::Word("obvasm") {
            return Err(line.error(token.at, other(EXPECTED)));
        }
        let version = line.word("version")?;
        if version.value != "1" {
            let found = shown(version.value);
            let message = format!("there is version 1, and this is {found}");
            return Err(line.error(version.at, other(&message)));
        }
        return line.end();
    }
    Err(Scanner::new(1, "").error(0, other(EXPECTED)))
}

/// That it is no assembly text of this version.
fn other(message: &str) -> Wrong {
    Wrong::new(ModuleCode::Header, message)
}

impl<'t> Reader<'t> {
    fn line(&mut self, mut line: Scanner<'t>) -> Result<(), AsmError> {
        if let Some(text) = line.after_bar() {
            return self.source_line(&mut line, text);
        }
        while let Some(token) = line.token()? {
            let Token::Word(word) = token.value else {
                let message = format!("a line does not begin with {token}");
                return Err(line.error(token.at, message));
            };
            if line.takes_colon() {
                self.opened = Opened::Nothing;
                self.label(word).map_err(|message| line.error(token.at, message))?;
                continue;
            }
            let result = match word {
                "@" => self.entry(&mut line),
                _ if word.starts_with('.') => self.directive(word, &mut line),
                _ => self.instruction(word, &mut line),
            };
            return result.map_err(|problem| match problem {
                Problem::Line(error) => error,
                Problem::Word(message) => line.error(token.at, message),
            });
        }
        Ok(())
    }

    fn label(&mut self, name: &'t str) -> Result<(), Wrong> {
        if !is_bare(name) {
            return Err(format!("{} is no label; a label is a word", shown(name)).into());
        }
        let section = self.section()?;
        match self.declared.labels.insert((section, name), self.here) {
            None => Ok(()),
            Some(_) => {
                let message = format!("label {} is there twice in this function", shown(name));
                Err(Wrong::new(ModuleCode::Ambiguous, message))
            }
        }
    }

    /// The present stretch of code.
    fn section(&mut self) -> Result<usize, Wrong> {
        let sections = &mut self.declared.sections;
        if let Some(last) = sections.len().checked_sub(1) {
            return Ok(last);
        }
        // Once is enough.
        sections.push(None);
        Err("code belongs to a function; begin one with `.function \"main\" start`".into())
    }

    fn instruction(&mut self, mnemonic: &str, line: &mut Scanner<'t>) -> Result<(), Problem> {
        self.opened = Opened::Nothing;
        let prefix = self.prefix.take();
        // Of what is wrong, labels below still name the right place.
        self.here = self.here.checked_add(1).ok_or("there is too much code")?;
        let section = self.section()?;
        let Some(opcode) = Opcode::from_mnemonic(mnemonic) else {
            let mnemonics = OPS.iter().map(|row| row.mnemonic);
            return Err(unknown("instruction", mnemonic, mnemonics).into());
        };
        let what = What::Instr { opcode, section, prefix };
        self.leave(what, line)
    }

    /// Leave the rest of a line to the second pass.
    fn leave(&mut self, what: What, line: &Scanner<'t>) -> Result<(), Problem> {
        self.declared.uses.push(Use { what, rest: line.clone() });
        Ok(())
    }

    fn entry(&mut self, line: &mut Scanner<'t>) -> Result<(), Problem> {
        self.opened = Opened::Nothing;
        self.map_entry(self.here, line)
    }

    fn map_entry(&mut self, first: u32, line: &mut Scanner<'t>) -> Result<(), Problem> {
        let file = line.number("source file")?;
        let (start, end) = (line.number("first byte")?, line.number("end")?);
        let is_action = line.clone().token()?.is_some();
        let action = if is_action { Some(line.one_of()?) } else { None };
        self.declared.module.source_map.push(SourceEntry { first, file, start, end, action });
        Ok(line.end()?)
    }

    fn directive(&mut self, word: &str, line: &mut Scanner<'t>) -> Result<(), Problem> {
        let adds = word == ".at" || OF_ERRORS.contains(&word);
        let opened = if adds { self.opened } else { Opened::Nothing };
        self.opened = opened;
        match word {
            ".cell" | ".const" | ".joints" | ".keyframe" | ".tool" | ".checkpoint" | ".reason"
            | ".global" => self.table(word, line),
            ".item" => self.item(line),
            ".at" => {
                let item = self.last(Opened::Item, "`.at` follows its `.item`")?;
                self.leave(What::At { item }, line)
            }
            ".error" => self.error(line),
            _ if OF_ERRORS.contains(&word) => {
                let error = self.last(Opened::Error, "what an error does follows its `.error`")?;
                self.error_clause(word, error, line)
            }
            ".cleanup" => self.leave(What::Cleanup, line),
            ".function" => self.function(line),
            ".parameter" | ".parameters" | ".local" | ".counters" | ".slot" | ".range" => {
                self.of_function(word, line)
            }
            ".code" => {
                self.close_function();
                self.declared.sections.push(None);
                Ok(line.end()?)
            }
            ".prefix" => {
                self.prefix = Some(line.number("prefix")?);
                Ok(line.end()?)
            }
            ".map" => {
                let first = line.number("instruction")?;
                self.map_entry(first, line)
            }
            ".mention" => {
                self.declared.module.mentions.push(mention::read(line)?);
                Ok(line.end()?)
            }
            ".loop" => {
                self.declared.module.loops.push(mention::read_loop(line)?);
                Ok(line.end()?)
            }
            ".source" => {
                let name = line.name("name of the source file")?;
                self.declared.module.sources.push(SourceFile { name, text: String::new() });
                self.opened = Opened::Source { has_text: false };
                Ok(line.end()?)
            }
            _ => Err(unknown("directive", word, DIRECTIVES.iter().copied()).into()),
        }
    }

    /// The entry that is opened, of one table or another.
    fn last(&self, expected: Opened, otherwise: &str) -> Result<usize, Problem> {
        let length = match expected {
            Opened::Item => self.declared.module.items.len(),
            _ => self.declared.module.errors.len(),
        };
        match length.checked_sub(1) {
            Some(last) if self.opened == expected => Ok(last),
            _ => Err(otherwise.into()),
        }
    }

    fn table(&mut self, word: &str, line: &mut Scanner<'t>) -> Result<(), Problem> {
        let module = &mut self.declared.module;
        match word {
            ".cell" => module.cell = Some(line.name("name of the workcell file")?),
            ".const" => {
                let constant = match line.word("type of the constant")? {
                    of if of.value == "int" => Constant::Int(line.number("constant")?),
                    of if of.value == "real" => Constant::Real(line.real("constant")?),
                    of => return Err(line.error(of.at, "a constant is int or real").into()),
                };
                module.constants.push(constant);
            }
            ".joints" => {
                let name = line.name("name of the configuration")?;
                let joints = line.reals("joint angle");
                // It is there even if its numbers are wrong, so that its uses are not.
                module.joints.push((name, *joints.as_ref().unwrap_or(&[0.0; 6])));
                joints?;
            }
            ".keyframe" => module.keyframes.push(line.name("name of the keyframe")?),
            ".tool" => module.tools.push(line.name("name of the tool")?),
            ".checkpoint" => module.checkpoints.push(line.name("name of the checkpoint")?),
            ".reason" => module.reasons.push(line.name("reason")?),
            _ => variable(&mut module.globals, line)?,
        }
        Ok(line.end()?)
    }

    fn item(&mut self, line: &mut Scanner<'t>) -> Result<(), Problem> {
        let name = line.name("name of the item")?;
        self.declared.module.items.push(Item { name, keyframes: Vec::new() });
        self.opened = Opened::Item;
        Ok(line.end()?)
    }

    fn error(&mut self, line: &mut Scanner<'t>) -> Result<(), Problem> {
        let name = line.name("name of the error")?;
        let severity = line.one_of();
        self.declared.module.errors.push(ErrorDeclaration {
            name,
            severity: *severity.as_ref().unwrap_or(&Severity::Fatal),
            faults: Vec::new(),
            watches: Vec::new(),
            bounds: Bounds::default(),
            recovery: Recovery::None,
            otherwise: Otherwise::Stop,
            respond: Respond::AtOnce,
            continuation: Continuation::Stop,
        });
        self.opened = Opened::Error;
        severity?;
        Ok(line.end()?)
    }

    fn error_clause(
        &mut self,
        word: &str,
        error: usize,
        line: &mut Scanner<'t>,
    ) -> Result<(), Problem> {
        let declaration = &mut self.declared.module.errors[error];
        match word {
            ".recover" => return self.leave(What::Recover { error }, line),
            ".otherwise" => return self.leave(What::Otherwise { error }, line),
            ".on" => {
                while line.clone().token()?.is_some() {
                    declaration.faults.push(line.one_of()?);
                }
            }
            ".watch" => declaration.watches.push(watched(line)?),
            ".bounds" => declaration.bounds = bounds(line)?,
            ".respond" => declaration.respond = line.one_of()?,
            _ => declaration.continuation = line.one_of()?,
        }
        Ok(line.end()?)
    }

    fn function(&mut self, line: &mut Scanner<'t>) -> Result<(), Problem> {
        self.close_function();
        let name = line.name("name of the function")?;
        let kind = line.one_of();
        let functions = &mut self.declared.module.functions;
        self.declared.sections.push(Some(functions.len()));
        functions.push(Function {
            name,
            kind: *kind.as_ref().unwrap_or(&FunctionKind::Sequence),
            parameters: 0,
            locals: Vec::new(),
            counters: 0,
            slots: Vec::new(),
            first: self.here,
            end: self.here,
        });
        kind?;
        Ok(line.end()?)
    }

    /// The present function, if code is of one.
    fn present(&mut self) -> Option<&mut Function> {
        let function = (*self.declared.sections.last()?)?;
        self.declared.module.functions.get_mut(function)
    }

    fn close_function(&mut self) {
        let (has_range, here) = (std::mem::take(&mut self.has_range), self.here);
        if let Some(function) = self.present().filter(|_| !has_range) {
            function.end = here;
        }
    }

    fn of_function(&mut self, word: &str, line: &mut Scanner<'t>) -> Result<(), Problem> {
        let Some(function) = self.present() else {
            return Err(format!("`{word}` follows its `.function`").into());
        };
        match word {
            ".parameter" => {
                let parameters = function.parameters.checked_add(1);
                let comes_first = function.locals.len() == usize::from(function.parameters);
                let (Some(parameters), true) = (parameters, comes_first) else {
                    let why = "parameters come before other locals, and there are no more than 255";
                    return Err(why.into());
                };
                function.parameters = parameters;
                variable(&mut function.locals, line)?;
            }
            ".parameters" => function.parameters = line.number("number of parameters")?,
            ".local" => variable(&mut function.locals, line)?,
            ".counters" => function.counters = line.number("number of counters")?,
            ".slot" => function.slots.push(line.name("name of the position")?),
            _ => {
                function.first = line.number("first instruction")?;
                function.end = line.number("end")?;
                self.has_range = true;
            }
        }
        Ok(line.end()?)
    }

    /// A line of a source file: as it is behind a space, or quoted.
    fn source_line(&mut self, line: &mut Scanner<'t>, text: &str) -> Result<(), AsmError> {
        let Opened::Source { has_text } = self.opened else {
            return Err(line.error_here("source text follows its `.source`"));
        };
        let written = if text.starts_with('"') {
            let (unquoted, width) = unquote(text).map_err(|error| line.error_here(error.why))?;
            if !text[width..].trim().is_empty() {
                return Err(line.error_here("nothing follows a quoted line of source text"));
            }
            Cow::Owned(unquoted)
        } else {
            Cow::Borrowed(text.strip_prefix(' ').unwrap_or(text))
        };
        if let Some(file) = self.declared.module.sources.last_mut() {
            file.text.push_str(if has_text { "\n" } else { "" });
            file.text.push_str(&written);
        }
        self.opened = Opened::Source { has_text: true };
        Ok(())
    }
}

fn bounds(line: &mut Scanner) -> Result<Bounds, AsmError> {
    let mut bounds = Bounds::default();
    while let Some(word) = line.optional_word("bound")? {
        match word.value {
            "attempts" => bounds.attempts = Some(line.number("number of attempts")?),
            "time" => bounds.time_s = Some(line.real("time in seconds")?),
            "distance" => bounds.distance_m = Some(line.real("distance in metres")?),
            other => {
                let choices = ["attempts", "time", "distance"];
                return Err(line.error(word.at, none_of("bound", other, choices)));
            }
        }
    }
    Ok(bounds)
}

fn watched(line: &mut Scanner) -> Result<Watched, AsmError> {
    let word = line.word("condition")?;
    match word.value {
        "force" => Ok(Watched::Force { above_n: line.real("force in newtons")? }),
        "input" => {
            let bit = line.number("number of the input")?;
            let level = line.word("level")?;
            match level.value {
                "low" | "high" => Ok(Watched::Input { bit, level: level.value == "high" }),
                other => Err(line.error(level.at, none_of("level", other, ["low", "high"]))),
            }
        }
        other => Err(line.error(word.at, none_of("condition", other, ["input", "force"]))),
    }
}

fn variable(variables: &mut Vec<Variable>, line: &mut Scanner) -> Result<(), AsmError> {
    let name = line.name("name of the variable")?;
    let of_type = line.one_of();
    let type_or_first = *of_type.as_ref().unwrap_or(&Type::Int);
    variables.push(Variable { name, of_type: type_or_first, measures: None });
    of_type?;
    let measures = match line.optional_word("part of a variable")? {
        None => None,
        Some(word) if word.value == "of" => {
            let mut exponents = [0; 4];
            for exponent in &mut exponents {
                *exponent = line.number("exponent")?;
            }
            Some(exponents)
        }
        Some(word) => {
            return Err(line.error(word.at, "behind a type there is `of` or nothing"));
        }
    };
    variables.iter_mut().last().into_iter().for_each(|variable| variable.measures = measures);
    Ok(())
}

/// What is wrong with a line: there, or with its first word.
enum Problem {
    Line(AsmError),
    Word(Wrong),
}

impl From<AsmError> for Problem {
    fn from(error: AsmError) -> Self {
        Self::Line(error)
    }
}

impl From<Wrong> for Problem {
    fn from(wrong: Wrong) -> Self {
        Self::Word(wrong)
    }
}

impl From<String> for Problem {
    fn from(message: String) -> Self {
        Self::Word(message.into())
    }
}

impl From<&str> for Problem {
    fn from(message: &str) -> Self {
        Self::Word(message.into())
    }
}
