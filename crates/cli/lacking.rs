//! What a program needs and its workcell has not: said of both, the line of the program that needs
//! it and the line of the workcell file that could have it.

use crate::load::{self, Program, Workcell};
use crate::problem::Message;
use obverse_bytecode::{Mention, Mentioned, Module, verify};
use obverse_lsp::Lacking;
use obverse_sim::{CellCode, CellPlaces};
use obverse_vm::LinkError;
use std::path::Path;

/// So many names of what is there are told.
const NAMES_MAX: usize = 6;

/// What is lacking, in the order in which the program speaks of it.
pub(crate) fn messages(
    program: &Program,
    workcell: &Workcell,
    errors: &[LinkError],
) -> Vec<Message> {
    let places = workcell.text.as_deref().map(CellPlaces::of);
    let sought = Sought { program, workcell, places };
    errors.iter().map(|error| sought.message(error)).collect()
}

/// What is wrong with the workcell of a program or is lacking in it, as `check` finds it, by the
/// places of the program.
pub(crate) fn in_its_cell(path: &Path, module: &Module) -> Vec<Lacking> {
    let names: Vec<String> = module.sources.iter().map(|source| source.name.clone()).collect();
    let cell = module.mentions.iter().find(|mention| mention.what == Mentioned::Cell);
    let cell = cell.and_then(|mention| module.place_of_mention(mention));
    let cell = cell.map(|(file, line, column)| (file.to_owned(), (line, column)));
    // What does not verify is no fault of the workcell.
    let Ok(verified) = verify(module.clone()) else { return Vec::new() };
    // Without sources of its own, so that its files are called as in the module.
    let program = Program { path: path.to_owned(), verified, source: None };
    let found = load::workcell(&program, None, 0)
        .and_then(|(sim, workcell)| load::machine(&program, &sim, &workcell).map(drop));
    let messages = found.err().map(|problem| problem.messages).unwrap_or_default();
    let of_message = |message: &Message| {
        let own = placed(message, &names)
            .or_else(|| message.also.iter().find_map(|also| placed(also, &names)));
        let (file, (line, column)) = own.or_else(|| cell.clone())?;
        let text = std::iter::once(message).chain(&message.also).map(|one| match &one.file {
            Some(file) if names.contains(file) => one.text.clone(),
            _ => one.to_string(),
        });
        let text = text.collect::<Vec<_>>().join("\n");
        Some(Lacking { file, line, column, code: message.code, message: text })
    };
    messages.iter().filter_map(of_message).collect()
}

/// The place of a message, if it is in one of some files.
fn placed(message: &Message, files: &[String]) -> Option<(String, (usize, usize))> {
    let file = message.file.clone().filter(|file| files.contains(file))?;
    Some((file, message.place?))
}

fn code(error: &LinkError) -> CellCode {
    match error {
        LinkError::Item { .. } => CellCode::NoItem,
        LinkError::Tool { .. } => CellCode::NoTool,
        LinkError::Output { .. } => CellCode::NoOutput,
        LinkError::Input { .. } => CellCode::NoInput,
    }
}

struct Sought<'p> {
    program: &'p Program,
    workcell: &'p Workcell,
    /// None without a workcell file.
    places: Option<CellPlaces>,
}

/// A place as files, lines and columns go.
type Place<'m> = Option<(&'m str, usize, usize)>;

impl<'p> Sought<'p> {
    fn message(&self, error: &LinkError) -> Message {
        let text = format!("{error} (workcell: {})", self.workcell.name);
        let message = match error {
            LinkError::Item { index, .. } => {
                self.at(self.mention(|what| *what == Mentioned::Item(*index)), text)
            }
            LinkError::Tool { index, .. } => {
                self.at(self.mention(|what| *what == Mentioned::Tool(*index)), text)
            }
            LinkError::Output { bit, pc, .. } => {
                let is_named =
                    |what: &_| matches!(what, Mentioned::Output { bit: named, .. } if named == bit);
                self.of_line(self.first(is_named), *pc, text)
            }
            LinkError::Input { bit, pc, .. } => {
                let is_named =
                    |what: &_| matches!(what, Mentioned::Input { bit: named, .. } if named == bit);
                self.of_line(self.first(is_named), *pc, text)
            }
        };
        message.coded(code(error).as_str()).with(self.in_workcell(error))
    }

    fn module(&self) -> &'p Module {
        self.program.verified.module()
    }

    fn first(&self, is_wanted: impl Fn(&Mentioned) -> bool) -> Option<&'p Mention> {
        self.module().mentions.iter().find(|mention| is_wanted(&mention.what))
    }

    /// Where the program speaks of something first.
    fn mention(&self, is_wanted: impl Fn(&Mentioned) -> bool) -> Place<'p> {
        self.module().place_of_mention(self.first(is_wanted)?)
    }

    /// A sentence about a place of the program.
    fn at(&self, place: Place<'_>, text: String) -> Message {
        match place {
            Some((file, line, column)) => {
                Message::of_file(&self.program.path_of(file), text).at(Some((line, column)))
            }
            None => Message::of_file(&self.program.path, text),
        }
    }

    /// An output or an input: where it has its name, and where it is needed.
    fn of_line(&self, named: Option<&'p Mention>, pc: Option<u32>, text: String) -> Message {
        let needed = pc.and_then(|pc| self.module().place_of(pc));
        let Some(mention) = named else { return self.at(needed, text) };
        let message = self.at(self.module().place_of_mention(mention), text);
        match needed {
            Some(_) => message.with(Some(self.at(needed, "it is needed here".to_owned()))),
            None => message,
        }
    }

    /// The place of the workcell file that could have it.
    fn in_workcell(&self, error: &LinkError) -> Option<Message> {
        let places = self.places.as_ref()?;
        let (place, text) = match error {
            LinkError::Item { name, .. } => among("item", name, &places.items),
            LinkError::Tool { name, .. } => among("tool", name, &places.tools),
            LinkError::Output { count, .. } => counted("output", *count, places.outputs),
            LinkError::Input { count, .. } => counted("input", *count, places.inputs),
        };
        let message = Message { file: Some(self.workcell.name.clone()), ..Message::new(text) };
        Some(message.at(place))
    }
}

/// The thing of the workcell that may be meant, or those that there are.
fn among(
    what: &str,
    name: &str,
    there: &[(String, (usize, usize))],
) -> (Option<(usize, usize)>, String) {
    let names = there.iter().map(|(name, _)| name.as_str());
    let meant = obverse_syntax::nearest(name, names.clone());
    if let Some((meant, place)) = there.iter().find(|(known, _)| Some(known.as_str()) == meant) {
        return (Some(*place), format!("did you mean `{meant}`, the {what} that is named here?"));
    }
    let Some((_, place)) = there.first() else {
        return (None, format!("it has no {what}; add `[[{what}]]` with `name = \"{name}\"`"));
    };
    let told: Vec<String> = names.take(NAMES_MAX).map(|name| format!("`{name}`")).collect();
    let more = if there.len() > NAMES_MAX { ", .." } else { "" };
    (Some(*place), format!("its {what}s begin here: {}{more}", told.join(", ")))
}

/// Where the workcell says how many outputs or inputs it has.
fn counted(
    what: &str,
    count: u16,
    written: Option<(usize, usize)>,
) -> (Option<(usize, usize)>, String) {
    match written {
        Some(_) => (written, format!("it says here that it has {count} {what}s")),
        None => (None, format!("without `[{what}s]` with a `count` it has {count} {what}s")),
    }
}
