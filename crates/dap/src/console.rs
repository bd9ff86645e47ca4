//! What can be typed: what something is, and the commands of the debugger at a terminal, by the
//! same names. Those that an editor has controls for are answered with where these are.
//!
//! A text that is the name or the value of something is that; else it is a command.

use crate::debuggee::{Debuggee, Next, THREAD};
use crate::message::{Evaluate, Request};
use crate::motion::Going;
use crate::{jumping, looking, shown, stepping, trying};
use obverse_bytecode::text::nearest;
use obverse_debugger::{Expression, Grain, Value as Known, Walk};
use serde_json::{Value, json};

/// What a command comes to.
pub(crate) enum Done {
    /// A value.
    Is(Known),
    /// Something is told.
    Told(String),
    /// Another moment is shown.
    Moved(String),
    /// The run goes on.
    Goes(String, Going),
    /// It goes back, if it can.
    Back(Going),
}

/// What came of a command, or why it was not carried out.
pub(crate) type Result = std::result::Result<Done, String>;

/// What was typed behind the name of a command.
pub(crate) struct Typed<'t> {
    pub(crate) rest: &'t str,
    /// The function whose names hold.
    pub(crate) function: usize,
}

/// What a command does.
#[derive(Clone, Copy)]
enum Does {
    Run(fn(&mut Debuggee<'_, '_, '_>, &Typed<'_>) -> Result),
    /// The editor has a control for it, which is here.
    Elsewhere(&'static str),
}

/// A command that can be typed.
#[derive(Clone, Copy)]
pub struct Word {
    /// Its name, then shorter ones.
    pub names: &'static [&'static str],
    /// What follows it.
    pub arguments: &'static str,
    /// What it does.
    pub help: &'static str,
    does: Does,
}

impl Word {
    /// Whether it is carried out, and not answered with where the editor has a control for it.
    #[must_use]
    pub fn is_carried_out(&self) -> bool {
        matches!(self.does, Does::Run(_))
    }
}

const fn word(
    names: &'static [&'static str],
    arguments: &'static str,
    run: fn(&mut Debuggee<'_, '_, '_>, &Typed<'_>) -> Result,
    help: &'static str,
) -> Word {
    Word { names, arguments, help, does: Does::Run(run) }
}

const fn elsewhere(names: &'static [&'static str], place: &'static str) -> Word {
    Word { names, arguments: "", help: place, does: Does::Elsewhere(place) }
}

const GUTTER: &str = "a click beside a line sets a breakpoint; its context menu has conditions, \
                      hit counts and messages";
const WATCHED: &str = "`Break on Value Change` in the context menu of a variable stops when it \
                       changes";
const LISTED: &str = "the Breakpoints view lists breakpoints, switches them, and takes them away";
const EXPRESSIONS: &str = "the Watch view shows what something is wherever a run stops";
const CALLS: &str =
    "a click in the Call Stack view looks at a call: what is typed is about it then";
const TO_A_LINE: &str = "`Run to Cursor` in the context menu of a line goes on to it";
const INSTRUCTIONS: &str = "the buttons of the tool bar go by instructions in the Disassembly view";

/// Every command that can be typed. Each that is carried out is one of the debugger at a terminal;
/// of the others it may know some.
#[rustfmt::skip]
pub const WORDS: &[Word] = &[
    word(&["reverse-step", "rs"], "",
        |it, typed| stepping::back(it, typed, Walk::Step(Grain::Statement)),
        "back to the statement before, into calls"),
    word(&["reverse-stepi", "rsi"], "",
        |it, typed| stepping::back(it, typed, Walk::Step(Grain::Instruction)),
        "back by an instruction"),
    word(&["reverse-nexti", "rni"], "",
        |it, typed| stepping::back(it, typed, Walk::Next(Grain::Instruction)),
        "back by an instruction, over calls"),
    word(&["reverse-finish", "rf"], "",
        |it, typed| stepping::back(it, typed, Walk::Finish),
        "back to before the call"),
    word(&["recover"], "", stepping::recover,
        "on from an error that is due until the run is past it, or it is given up"),
    word(&["release"], "", stepping::release, "let an arm move again that has stopped"),
    word(&["goto", "go"], "MOMENT|start|end|error|NAME", jumping::goto,
        "to a moment, the last error, a bookmark or a checkpoint; `goto end` is live again"),
    word(&["last"], "EXPRESSION|error", jumping::last,
        "to before the last change of it, as in `last output 3`; again, to the one before that"),
    word(&["undo"], "", jumping::undo, "back to before the last jump"),
    word(&["bookmark", "mark"], "[NAME]", jumping::bookmark,
        "remember this moment; without a name, list what is remembered"),
    word(&["why"], "", looking::why, "what stops going back from here"),
    word(&["history"], "[COUNT]", looking::history, "what the robot did around this moment"),
    word(&["print", "p"], "[EXPRESSION]", looking::print,
        "what it is; without one, every variable"),
    word(&["locals"], "[FRAME]", looking::locals, "the variables of a call"),
    word(&["globals"], "", looking::globals, "the variables of the program"),
    word(&["state"], "", looking::state, "arm, force, what is held, outputs and settings"),
    word(&["backtrace", "bt", "where"], "", looking::backtrace, "the calls under way"),
    word(&["list", "l"], "[LINE|FILE:LINE]", looking::list, "the source around"),
    word(&["disassemble", "x"], "", looking::disassemble, "the instructions around this one"),
    word(&["tape"], "", looking::tape, "how much is recorded for the way back"),
    word(&["what-if", "try"], "", trying::what_if,
        "go on otherwise from here, in a copy of the workcell"),
    word(&["set"], "NAME = VALUE", trying::set,
        "give a variable or an input a value, in a what-if, which begins here if none has"),
    word(&["input"], "NAME high|low|real", trying::input,
        "the same: read an input as this level, or as what it is"),
    word(&["seed"], "N", trying::seed, "the same: draw chance and noise anew"),
    word(&["leave"], "", trying::leave, "out of the what-if, back to the run as it was"),
    word(&["help", "h"], "[COMMAND]", |_, typed| help(typed.rest), "what there is"),
    elsewhere(&["step", "s"], "`Step Into` (F11) of the tool bar"),
    elsewhere(&["next", "n"], "`Step Over` (F10) of the tool bar"),
    elsewhere(&["finish", "fin"], "`Step Out` (Shift+F11) of the tool bar"),
    elsewhere(&["continue", "c"], "`Continue` (F5) of the tool bar"),
    elsewhere(&["reverse-next", "rn"], "`Step Back` of the tool bar"),
    elsewhere(&["reverse-continue", "rc"], "`Reverse` of the tool bar"),
    elsewhere(&["stepi", "si"], INSTRUCTIONS),
    elsewhere(&["nexti", "ni"], INSTRUCTIONS),
    elsewhere(&["break", "b"], GUTTER),
    elsewhere(&["tbreak", "tb"], GUTTER),
    elsewhere(&["ignore"], GUTTER),
    elsewhere(&["condition"], GUTTER),
    elsewhere(&["watch", "w"], WATCHED),
    elsewhere(&["delete", "d"], LISTED),
    elsewhere(&["clear"], LISTED),
    elsewhere(&["enable", "en"], LISTED),
    elsewhere(&["disable", "dis"], LISTED),
    elsewhere(&["info", "i"], LISTED),
    elsewhere(&["display"], EXPRESSIONS),
    elsewhere(&["undisplay"], EXPRESSIONS),
    elsewhere(&["frame", "f"], CALLS),
    elsewhere(&["up"], CALLS),
    elsewhere(&["down"], CALLS),
    elsewhere(&["until", "u"], TO_A_LINE),
    elsewhere(&["advance"], TO_A_LINE),
    elsewhere(&["start"], "`Start Debugging` (F5), with `stopOnEntry`"),
    elsewhere(&["run", "r"], "`Start Debugging` (F5)"),
    elsewhere(&["quit", "q", "exit"], "`Stop` (Shift+F5) of the tool bar"),
];

fn find(name: &str) -> Option<&'static Word> {
    WORDS.iter().find(|word| word.names.contains(&name))
}

fn help(name: &str) -> Result {
    let heads = || WORDS.iter().filter(|word| word.is_carried_out());
    let head = |word: &Word| format!("{} {}", word.names[0], word.arguments).trim_end().to_owned();
    if name.is_empty() {
        let line = |word: &Word| format!("{:<36} {}", head(word), word.help);
        let more = "Anything else is worked out: `x + 1`, `force > 5 N`, `output 3`, `held`, \
                    `time`, `steps`. The editor's own controls step and set breakpoints."
            .to_owned();
        return Ok(Done::Told(heads().map(line).chain([more]).collect::<Vec<_>>().join("\n")));
    }
    let word = find(name).ok_or_else(|| {
        let names = WORDS.iter().flat_map(|word| word.names.iter().copied());
        let meant = nearest(name, names).map(|meant| format!("; `{meant}`?")).unwrap_or_default();
        format!("there is no command `{name}`{meant}")
    })?;
    let names = word.names.join(", ");
    Ok(Done::Told(format!("{}\n  {}\n  also as {names}", head(word), word.help)))
}

impl Debuggee<'_, '_, '_> {
    pub(crate) fn evaluate(&mut self, request: &Request) -> Next {
        let done = match request.given::<Evaluate>().and_then(|asked| self.evaluated(&asked)) {
            Ok(done) => done,
            Err(why) => {
                self.server.out.refuse(request, &why);
                return Next::Stay;
            }
        };
        let body = |text: &str, kind: &str| -> Value {
            json!({ "result": text, "type": kind, "variablesReference": 0 })
        };
        match done {
            Done::Is(value) => {
                let kind = shown::type_name(&value);
                self.server.out.answer(request, body(&value.to_string(), kind));
            }
            Done::Told(text) => self.server.out.answer(request, body(&text, "")),
            Done::Moved(text) => {
                self.server.out.answer(request, body(&text, ""));
                self.jumped();
            }
            Done::Goes(text, going) => {
                self.server.out.answer(request, body(&text, ""));
                // A client that has not asked for it is told.
                let body = json!({ "threadId": THREAD, "allThreadsContinued": true });
                self.server.out.event("continued", body);
                return Next::Go(going);
            }
            Done::Back(going) => return self.go_back(request, going, body("going back", "")),
        }
        Next::Stay
    }

    /// What it comes to.
    fn evaluated(&mut self, asked: &Evaluate) -> Result {
        let module = self.session.module();
        let text = asked.expression.trim();
        let function = self.function_of(asked.frame_id);
        let facts = &self.session.recording().facts;
        let parsed = Expression::parse(module, function, text);
        let error = match parsed.and_then(|it| it.check_lines(facts).map(|()| it)) {
            Ok(expression) => {
                let value = self.session.look(|look| expression.value(look));
                return Ok(Done::Is(value));
            }
            Err(error) => error,
        };
        if asked.context.as_deref() != Some("repl") {
            return Err(error.to_string());
        }
        let (name, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        match find(name).map(|word| word.does) {
            Some(Does::Run(run)) => run(self, &Typed { rest: rest.trim(), function }),
            Some(Does::Elsewhere(place)) => {
                Err(format!("`{name}` is not typed in an editor: {place}"))
            }
            None => Err(format!("{error}; `help` tells what can be typed")),
        }
    }

    /// What a text of the person's says, with the names that hold there.
    pub(crate) fn expression(
        &self,
        typed: &Typed<'_>,
        text: &str,
    ) -> std::result::Result<Expression, String> {
        let facts = &self.session.recording().facts;
        let parsed = Expression::parse(self.session.module(), typed.function, text);
        let checked = parsed.and_then(|it| it.check_lines(facts).map(|()| it));
        checked.map_err(|why| why.to_string())
    }
}
