//! The second pass: what names something, with all names known. Adds the constants and reasons that
//! code says and no table has, counts prefixes, and finds the jumps of joins that name none.

use super::declare::{Declared, Use, What};
use super::error::{AsmError, Errors, Wrong, none_of, shown, unknown};
use super::listing::counted_prefix;
use super::names::{Found, Names, Scope, is_named};
use super::quote::excerpt;
use super::scan::{Placed, Scanner, Token};
use super::words::{choice_number, choices, parse_constant};
use crate::builder::{with_label, with_prefix};
use crate::code::ModuleCode;
use crate::module::{
    Constant, Depth, Extent, Keyframe, Module, Otherwise, Perturbation, Recovery, Reversal,
};
use obverse_isa::{Family, Instr, Label, OpInfo, Opcode, OperandError, OperandKind, Prefix};
use std::collections::{BTreeMap, HashMap};

/// What the second pass adds to a module.
#[derive(Default)]
pub(super) struct Resolved {
    code: Vec<Instr>,
    constants: Vec<Constant>,
    reasons: Vec<String>,
    keyframes: Vec<(usize, Keyframe)>,
    recoveries: Vec<(usize, Recovery)>,
    otherwise: Vec<(usize, Otherwise)>,
    cleanup: Option<u16>,
}

impl Resolved {
    pub(super) fn put_into(self, module: &mut Module) {
        module.code = self.code;
        module.cleanup = self.cleanup;
        module.constants.extend(self.constants);
        module.reasons.extend(self.reasons);
        for (item, keyframe) in self.keyframes {
            module.items[item].keyframes.push(keyframe);
        }
        for (error, recovery) in self.recoveries {
            module.errors[error].recovery = recovery;
        }
        for (error, otherwise) in self.otherwise {
            module.errors[error].otherwise = otherwise;
        }
    }
}

/// The second pass over what the first has left.
pub(super) fn resolve(declared: &mut Declared) -> Resolved {
    let Declared { module, sections, labels, uses, errors } = declared;
    let names = Names::new(module);
    let mut resolver = Resolver {
        scope: Scope::new(&names, None),
        section: None,
        labels,
        prefix: 0,
        added: Added::default(),
        unnamed: Vec::new(),
        resolved: Resolved::default(),
    };
    for Use { what, rest } in uses {
        if errors.is_full() {
            break;
        }
        let mut rest = rest.clone();
        if let What::Instr { section, .. } = *what
            && resolver.section != Some(section)
        {
            let function = sections[section].map(|function| &module.functions[function]);
            resolver.scope = Scope::new(&names, function);
            resolver.section = Some(section);
            resolver.prefix = 0;
        }
        let result = resolver.line(*what, &mut rest);
        errors.keep(result);
    }
    resolver.name_jumps(errors);
    resolver.resolved
}

/// Where the constants and reasons are that code has added.
#[derive(Default)]
struct Added {
    constants: HashMap<(bool, u64), usize>,
    reasons: HashMap<String, usize>,
}

struct Resolver<'a, 't, 'm> {
    scope: Scope<'a, 'm>,
    section: Option<usize>,
    labels: &'a BTreeMap<(usize, &'t str), u32>,
    /// How many pure instructions the present statement has so far.
    prefix: usize,
    added: Added,
    /// The joins that do not say which jump they are of.
    unnamed: Vec<(usize, Scanner<'t>)>,
    resolved: Resolved,
}

/// Why an operand is none.
enum Refused {
    /// It is not in the range of its kind.
    Range(OperandError),
    /// It is not right in the text.
    Text(AsmError),
}

impl From<OperandError> for Refused {
    fn from(error: OperandError) -> Self {
        Self::Range(error)
    }
}

impl<'t> Resolver<'_, 't, '_> {
    fn line(&mut self, what: What, line: &mut Scanner<'t>) -> Result<(), AsmError> {
        match what {
            What::Instr { opcode, prefix, .. } => {
                let instr = self.instruction(opcode, prefix, line);
                // An instruction stands in for a wrong one, so that the others keep their places.
                self.resolved.code.push(*instr.as_ref().unwrap_or(&Instr::Halt {}));
                instr?;
            }
            What::At { item } => {
                let name = self.index(OperandKind::Keyframe, line)?;
                let position_m = line.reals("position in metres")?;
                let rotation_rad = line.reals("rotation in radians")?;
                let keyframe = Keyframe { name, position_m, rotation_rad };
                self.resolved.keyframes.push((item, keyframe));
            }
            What::Recover { error } => {
                let recovery = self.recovery(line)?;
                self.resolved.recoveries.push((error, recovery));
            }
            What::Otherwise { error } => {
                let otherwise = self.otherwise(line)?;
                self.resolved.otherwise.push((error, otherwise));
            }
            What::Cleanup => {
                self.resolved.cleanup = Some(self.index(OperandKind::Function, line)?);
            }
        }
        line.end()
    }

    fn instruction(
        &mut self,
        opcode: Opcode,
        given: Option<u8>,
        line: &mut Scanner<'t>,
    ) -> Result<Instr, AsmError> {
        let row = opcode.info();
        let counted = counted_prefix(self.prefix);
        self.prefix = if row.family.is_pure() { self.prefix + 1 } else { 0 };
        let takes_prefix = row.operands.iter().any(|(_, kind)| *kind == OperandKind::Prefix);
        if given.is_some() && !takes_prefix {
            return Err(line.error_here(format!("{} takes no prefix", row.mnemonic)));
        }
        let mut written = row.operands.iter();
        let mut place = line.clone();
        let mut is_first = true;
        let instr = Instr::from_operands(opcode, &mut |kind, _| {
            let field = written.next().map_or("", |(field, _)| *field);
            if kind == OperandKind::Prefix {
                return Ok(0);
            }
            if field == "from" && row.family == Family::Flow && is_at_end(line) {
                self.unnamed.push((self.resolved.code.len(), line.clone()));
                return Ok(0);
            }
            if !std::mem::take(&mut is_first) {
                comma(line, row).map_err(Refused::Text)?;
            }
            place = line.clone();
            self.operand(kind, field, row, line).map_err(Refused::Text)
        });
        let instr = instr.map_err(|refused| match refused {
            Refused::Text(error) => error,
            Refused::Range(OperandError { value, .. }) => {
                place.error_here(no_fit(&value.to_string()))
            }
        })?;
        Ok(with_prefix(instr, given.map_or(counted, Prefix)))
    }

    /// An operand as a number.
    fn operand(
        &mut self,
        kind: OperandKind,
        field: &str,
        row: &OpInfo,
        line: &mut Scanner<'t>,
    ) -> Result<i64, AsmError> {
        let Some(token) = line.token()? else {
            let usage = usage(row);
            return Err(line.error_here(format!("the operand `{field}` is missing: {usage}")));
        };
        let at = token.at;
        let number = match token.value {
            Token::Text(text) if is_named(kind) => self.name(kind, &text),
            Token::Word(word) => self.word(kind, word),
            _ => Err(format!("{token} is no {}", kind_name(kind)).into()),
        };
        number.map_err(|message| line.error(at, message))
    }

    fn word(&mut self, kind: OperandKind, word: &str) -> Result<i64, Wrong> {
        let no_number = || format!("{} is no {}", shown(word), kind_name(kind));
        if choices(kind).next().is_some() {
            return choice_number(kind, word)
                .ok_or_else(|| none_of(kind_name(kind), word, choices(kind)));
        }
        if matches!(kind, OperandKind::Integer | OperandKind::Counter | OperandKind::Bit) {
            return word.parse().map_err(|_| match is_whole(word) {
                true => no_fit(word),
                false => not_a(format!("{}: it is a number", no_number())),
            });
        }
        if let Some((name, index)) = word.split_once('#') {
            let at = index.parse::<u32>().map_err(|_| not_a(no_number()))?;
            let is_name = name.is_empty() || self.scope.name(kind, at as usize) == Some(name);
            return is_name.then_some(i64::from(at)).ok_or_else(|| {
                let found = format!("{} {at} is not called {}", kind_name(kind), shown(name));
                Wrong::new(ModuleCode::UnknownWord, found)
            });
        }
        match kind {
            OperandKind::Label => self.label(word),
            OperandKind::Constant => {
                let constant = parse_constant(word)
                    .ok_or_else(|| not_a(format!("{}: it is a number or `#index`", no_number())))?;
                self.constant(constant)
            }
            OperandKind::Reason => Err(format!("{}: it stands in quotes", no_number()).into()),
            _ => self.name(kind, word),
        }
    }

    fn label(&self, word: &str) -> Result<i64, Wrong> {
        let Some(section) = self.section else { return Err(unknown("label", word, [])) };
        let mut here =
            self.labels.range((section, "")..(section + 1, "")).map(|((_, name), _)| *name);
        match self.labels.get(&(section, word)) {
            Some(at) => Ok(i64::from(*at)),
            None => Err(unknown("label", word, &mut here).and("; labels are of their function")),
        }
    }

    fn name(&mut self, kind: OperandKind, name: &str) -> Result<i64, Wrong> {
        match self.scope.find(kind, name) {
            Some(Found::One(at)) => number(at),
            Some(Found::Several) => {
                Err(several(&format!("there is more than one {} {}", kind_name(kind), shown(name))))
            }
            None if kind == OperandKind::Reason => self.reason(name),
            None => Err(unknown(kind_name(kind), name, self.scope.all(kind))),
        }
    }

    fn constant(&mut self, constant: Constant) -> Result<i64, Wrong> {
        match self.scope.names.constant(constant) {
            Some(Found::One(at)) => number(at),
            Some(Found::Several) => Err(several("this constant is there twice")),
            None => {
                let added = &mut self.resolved.constants;
                let key = (matches!(constant, Constant::Real(_)), constant.bits());
                let next = self.scope.module.constants.len() + added.len();
                let at = *self.added.constants.entry(key).or_insert_with(|| {
                    added.push(constant);
                    next
                });
                number(at)
            }
        }
    }

    fn reason(&mut self, text: &str) -> Result<i64, Wrong> {
        if let Some(at) = self.added.reasons.get(text) {
            return number(*at);
        }
        let at = self.scope.module.reasons.len() + self.resolved.reasons.len();
        self.resolved.reasons.push(text.to_owned());
        self.added.reasons.insert(text.to_owned(), at);
        number(at)
    }

    /// An index that a directive names.
    fn index(&mut self, kind: OperandKind, line: &mut Scanner<'t>) -> Result<u16, AsmError> {
        let Some(Placed { at, value }) = line.token()? else {
            return Err(line.error_here(format!("the {} is missing", kind_name(kind))));
        };
        let number = match value {
            Token::Word(word) => self.word(kind, word),
            Token::Text(text) => self.name(kind, &text),
            Token::Comma | Token::Colon => Err(format!("this is no {}", kind_name(kind)).into()),
        };
        let number = number.map_err(|message| line.error(at, message))?;
        u16::try_from(number).map_err(|_| {
            line.error(at, not_a(format!("{number} is no index: there are at most 65536")))
        })
    }

    fn recovery(&mut self, line: &mut Scanner<'t>) -> Result<Recovery, AsmError> {
        let word = line.word("recovery")?;
        match word.value {
            "none" => Ok(Recovery::None),
            "using" => Ok(Recovery::Using(self.index(OperandKind::Function, line)?)),
            "reversing" => Ok(Recovery::Reversing(self.reversal(line)?)),
            other => {
                let choices = ["none", "using", "reversing"];
                Err(line.error(word.at, none_of("recovery", other, choices)))
            }
        }
    }

    fn reversal(&mut self, line: &mut Scanner<'t>) -> Result<Reversal, AsmError> {
        let depth: Depth = line.one_of()?;
        let word = line.word("extent")?;
        let extent = match word.value {
            "actions" => Extent::Actions(line.number("number of actions")?),
            "checkpoint" => Extent::Checkpoint(self.index(OperandKind::Checkpoint, line)?),
            "sequence" => Extent::Sequence,
            other => {
                let choices = ["actions", "checkpoint", "sequence"];
                return Err(line.error(word.at, none_of("extent", other, choices)));
            }
        };
        let mut reversal =
            Reversal { depth, extent, perturbation: None, slower: false, lighter: false };
        while let Some(word) = line.optional_word("change")? {
            match word.value {
                "perturbed" => {
                    let pattern = line.one_of()?;
                    let limit_m = line.real("distance in metres")?;
                    reversal.perturbation = Some(Perturbation { limit_m, pattern });
                }
                "slower" => reversal.slower = true,
                "lighter" => reversal.lighter = true,
                other => {
                    let choices = ["perturbed", "slower", "lighter"];
                    return Err(line.error(word.at, none_of("change", other, choices)));
                }
            }
        }
        Ok(reversal)
    }

    fn otherwise(&mut self, line: &mut Scanner<'t>) -> Result<Otherwise, AsmError> {
        let word = line.word("last resort")?;
        match word.value {
            "using" => Ok(Otherwise::Using(self.index(OperandKind::Function, line)?)),
            "operator" => Ok(Otherwise::Operator),
            "stop" => Ok(Otherwise::Stop),
            other => {
                let choices = ["using", "operator", "stop"];
                Err(line.error(word.at, none_of("last resort", other, choices)))
            }
        }
    }

    /// Give each join that names no jump the one that names it.
    fn name_jumps(&mut self, errors: &mut Errors) {
        if self.unnamed.is_empty() {
            return;
        }
        let mut jumps: HashMap<usize, Found> = HashMap::new();
        for (at, instr) in self.resolved.code.iter().enumerate() {
            if let Some(target) = instr.jump_target() {
                let found = jumps.entry(target.index());
                found.and_modify(|found| *found = Found::Several).or_insert(Found::One(at));
            }
        }
        for (at, line) in &mut self.unnamed {
            let join = &mut self.resolved.code[*at];
            match jumps.get(at) {
                Some(Found::One(jump)) => *join = with_label(*join, Label(*jump as u32)),
                found => {
                    let count = if found.is_some() { "more than one jump" } else { "no jump" };
                    let message = format!("{count} goes to this join; name the one that it is of");
                    errors.add(line.error_here(message));
                }
            }
        }
    }
}

fn number(at: usize) -> Result<i64, Wrong> {
    i64::try_from(at).map_err(|error| not_a(error.to_string()))
}

/// Whether a word is a whole number, of whatever size.
fn is_whole(word: &str) -> bool {
    let digits = word.strip_prefix(['-', '+']).unwrap_or(word);
    !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
}

fn no_fit(number: &str) -> Wrong {
    not_a(format!("{} does not fit into this operand", excerpt(number)))
}

fn not_a(message: String) -> Wrong {
    Wrong::new(ModuleCode::Number, message)
}

fn several(found: &str) -> Wrong {
    let message = format!("{found}; write `#` and the index of the one that is meant");
    Wrong::new(ModuleCode::Ambiguous, message)
}

fn is_at_end(line: &Scanner) -> bool {
    matches!(line.clone().token(), Ok(None))
}

fn comma(line: &mut Scanner, row: &OpInfo) -> Result<(), AsmError> {
    let mut next = line.clone();
    match next.token()? {
        // What is missing is the operand.
        None => Ok(()),
        Some(token) if token.value == Token::Comma => {
            *line = next;
            Ok(())
        }
        Some(token) => {
            let usage = usage(row);
            Err(line.error(token.at, format!("a comma is missing before {token}: {usage}")))
        }
    }
}

/// How an instruction is written.
fn usage(row: &OpInfo) -> String {
    format!("`{} {}`", row.mnemonic, obverse_isa::reference::operands(row))
}

/// What an operand of a kind is, in messages.
fn kind_name(kind: OperandKind) -> &'static str {
    match kind {
        OperandKind::Prefix => "prefix",
        OperandKind::Integer => "number",
        OperandKind::Constant => "constant",
        OperandKind::Local => "local",
        OperandKind::Global => "global",
        OperandKind::Counter => "counter",
        OperandKind::Slot => "slot",
        OperandKind::Joints => "joint configuration",
        OperandKind::Item => "item",
        OperandKind::Keyframe => "keyframe",
        OperandKind::Tool => "tool",
        OperandKind::Error => "error",
        OperandKind::Checkpoint => "checkpoint",
        OperandKind::Reason => "reason",
        OperandKind::Function => "function",
        OperandKind::Label => "label",
        OperandKind::Bit => "line",
        OperandKind::Level => "level",
        OperandKind::Speed => "speed",
        OperandKind::Setting => "setting",
        OperandKind::Axis => "axis",
        OperandKind::Frame => "frame",
        OperandKind::Path => "path",
    }
}
