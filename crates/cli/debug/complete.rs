//! What the line editor offers: commands, and behind them what they take.

use super::Front;
use super::stops::INFO;
use super::table::{self, Offers};
use obverse_bytecode::{FunctionKind, Mentioned};
use obverse_isa::Setting;
use rustyline::completion::Completer as Completes;
use rustyline::highlight::Highlighter;
use rustyline::hint::Hinter;
use rustyline::validate::Validator;
use rustyline::{Context, Helper};

/// Names that may be meant.
#[derive(Default)]
pub(super) struct Names {
    places: Vec<String>,
    values: Vec<String>,
    moments: Vec<String>,
    breakpoints: Vec<String>,
    displays: Vec<String>,
}

/// The names of a program at a moment.
pub(super) fn names(front: &Front<'_>) -> Names {
    let (module, session) = (front.module, &front.session);
    let hidden = [FunctionKind::Start, FunctionKind::Replacement];
    let functions = module.functions.iter().filter(|function| !hidden.contains(&function.kind));
    let functions = functions.map(|function| function.name.clone());
    let checkpoints = module.checkpoints.iter().cloned();
    let errors = module.errors.iter().map(|error| format!("error {}", error.name));
    let locals = front.call().map_or(Vec::new(), |call| session.locals(call.index));
    let variables = locals.into_iter().chain(session.globals());
    let lines = module.mentions.iter().filter_map(|mention| match &mention.what {
        Mentioned::Output { name, .. } => Some(format!("output {name}")),
        Mentioned::Input { name, .. } => Some(format!("input {name}")),
        _ => None,
    });
    let plain = ["force", "held", "holding", "joints", "time", "steps"];
    let settings = Setting::ALL.iter().map(|setting| setting.name());
    let marks = session.bookmarks().keys().cloned();
    let words = ["start", "end", "error"].map(str::to_owned);
    Names {
        places: functions.chain(checkpoints.clone()).chain(errors).collect(),
        values: variables
            .map(|variable| variable.name)
            .chain(lines)
            .chain(plain.into_iter().chain(settings).map(str::to_owned))
            .collect(),
        moments: words.into_iter().chain(marks).chain(checkpoints).collect(),
        breakpoints: session.breakpoints().iter().map(|it| it.id.to_string()).collect(),
        displays: front.displays.numbers().map(|number| number.to_string()).collect(),
    }
}

/// What the editor asks.
#[derive(Default)]
pub(crate) struct Completer {
    names: Names,
}

impl Completer {
    pub(super) fn offer(&mut self, names: Names) {
        self.names = names;
    }

    /// Where what is completed begins, and what it may be.
    fn candidates(&self, line: &str) -> (usize, Vec<String>) {
        let begin = line.rfind(char::is_whitespace).map_or(0, |at| at + 1);
        let begun = &line[begin..];
        let fitting = |names: &mut dyn Iterator<Item = &str>| {
            let mut fitting: Vec<String> =
                names.filter(|name| name.starts_with(begun)).map(str::to_owned).collect();
            fitting.sort_unstable();
            fitting.dedup();
            fitting
        };
        if begin == 0 {
            let mut commands = table::COMMANDS.iter().map(|command| command.names[0]);
            return (begin, fitting(&mut commands));
        }
        let word = line.split([' ', '\t', '/']).next().unwrap_or("");
        let offers = table::find(word).map_or(Offers::Nothing, |command| command.offers);
        let names = match offers {
            Offers::Nothing => return (begin, Vec::new()),
            Offers::Commands => return (begin, fitting(&mut table::names())),
            Offers::Info => return (begin, fitting(&mut INFO.into_iter())),
            Offers::Breakpoints => &self.names.breakpoints,
            Offers::Displays => &self.names.displays,
            Offers::Places => &self.names.places,
            Offers::Values => &self.names.values,
            Offers::Moments => &self.names.moments,
        };
        (begin, fitting(&mut names.iter().map(String::as_str)))
    }
}

impl Completes for Completer {
    type Candidate = String;

    fn complete(
        &self,
        line: &str,
        at: usize,
        _: &Context<'_>,
    ) -> rustyline::Result<(usize, Vec<String>)> {
        Ok(self.candidates(line.get(..at).unwrap_or(line)))
    }
}

impl Hinter for Completer {
    type Hint = String;
}

impl Highlighter for Completer {}
impl Validator for Completer {}
impl Helper for Completer {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_and_what_they_take_are_completed() {
        let completer = Completer {
            names: Names {
                places: vec!["main".to_owned(), "insert".to_owned()],
                values: vec!["force".to_owned()],
                moments: vec!["start".to_owned()],
                breakpoints: vec!["1".to_owned(), "2".to_owned()],
                displays: vec!["3".to_owned()],
            },
        };
        let of = |line| completer.candidates(line);
        assert_eq!(
            of("reverse-n"),
            (0, vec!["reverse-next".to_owned(), "reverse-nexti".to_owned()])
        );
        assert_eq!(of("b in"), (2, vec!["insert".to_owned()]));
        assert_eq!(of("p f"), (2, vec!["force".to_owned()]));
        assert_eq!(of("goto "), (5, vec!["start".to_owned()]));
        assert_eq!(of("condition "), (10, vec!["1".to_owned(), "2".to_owned()]));
        assert_eq!(of("undisplay "), (10, vec!["3".to_owned()]));
        assert_eq!(of("info dis"), (5, vec!["display".to_owned()]));
        assert_eq!(of("x/5i ma"), (5, vec!["main".to_owned()]));
        assert_eq!(of("un"), (0, vec!["undisplay".to_owned(), "undo".into(), "until".into()]));
        assert_eq!(of("step "), (5, Vec::new()));
        assert_eq!(of("nonsense x"), (9, Vec::new()));
    }
}
