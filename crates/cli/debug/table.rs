//! The commands as data: their names, what may follow them, and what `help` says.

use super::{
    Answer, Done, Front, code, displays, errors, frames, stops, tries, until, values, walk,
};
use obverse_bytecode::text::nearest;
use obverse_debugger::{Grain, Walk};
use obverse_vm::Direction::{Forward, Reverse};

/// What the line editor offers behind a command.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Offers {
    Nothing,
    /// Where a run can stop.
    Places,
    /// What can be asked about.
    Values,
    /// Numbers of breakpoints.
    Breakpoints,
    /// Numbers of what is shown after each command.
    Displays,
    /// What `info` knows of.
    Info,
    /// Where one can go.
    Moments,
    /// Commands and topics.
    Commands,
}

/// A command.
pub(super) struct Command {
    /// Its full name, then shorter ones.
    pub(super) names: &'static [&'static str],
    /// What follows it.
    pub(super) arguments: &'static str,
    pub(super) topic: &'static str,
    pub(super) help: &'static str,
    pub(super) offers: Offers,
    pub(super) run: fn(&mut Front<'_>, &str) -> Done,
}

/// The topics of help, in their order.
const TOPICS: [(&str, &str); 5] = [
    ("walking", "by statements and instructions, forward and back"),
    ("jumping", "to a moment of the run, which is then shown and commands nothing"),
    ("stopping", "breakpoints and watches"),
    ("looking", "at variables, the workcell, the code, and what stops going back"),
    ("trying", "what would have been, in a run of its own"),
];

const fn command(
    names: &'static [&'static str],
    arguments: &'static str,
    topic: &'static str,
    offers: Offers,
    run: fn(&mut Front<'_>, &str) -> Done,
    help: &'static str,
) -> Command {
    Command { names, arguments, topic, help, offers, run }
}

const STATEMENT: Grain = Grain::Statement;
const INSTRUCTION: Grain = Grain::Instruction;

/// Every command.
#[rustfmt::skip]
pub(super) const COMMANDS: &[Command] = &[
    command(&["step", "s"], "[COUNT]", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Forward, Walk::Step(STATEMENT)),
        "on to the next statement, into calls"),
    command(&["next", "n"], "[COUNT]", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Forward, Walk::Next(STATEMENT)),
        "on to the next statement, over calls"),
    command(&["stepi", "si"], "[COUNT]", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Forward, Walk::Step(INSTRUCTION)),
        "on by an instruction"),
    command(&["nexti", "ni"], "[COUNT]", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Forward, Walk::Next(INSTRUCTION)),
        "on by an instruction, over calls"),
    command(&["finish", "fin"], "", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Forward, Walk::Finish),
        "on until the call is over"),
    command(&["continue", "c"], "[COUNT]", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Forward, Walk::Continue),
        "on until something stops it"),
    command(&["until", "u"], "[PLACE]", "walking", Offers::Places, until::until,
        "on past this line, also out of a loop; or to a place, as long as the call lasts"),
    command(&["advance"], "PLACE", "walking", Offers::Places, until::advance,
        "on to a place, wherever that is"),
    command(&["start"], "", "walking", Offers::Nothing, until::start,
        "into the first sequence, where a run has not begun"),
    command(&["run", "r"], "", "walking", Offers::Nothing, until::run,
        "through a run that has not begun; there is only one, which is not begun again"),
    command(&["reverse-step", "rs"], "[COUNT]", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Reverse, Walk::Step(STATEMENT)),
        "back to the statement before, into calls"),
    command(&["reverse-next", "rn"], "[COUNT]", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Reverse, Walk::Next(STATEMENT)),
        "back to the statement before, over calls"),
    command(&["reverse-stepi", "rsi"], "[COUNT]", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Reverse, Walk::Step(INSTRUCTION)),
        "back by an instruction"),
    command(&["reverse-nexti", "rni"], "[COUNT]", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Reverse, Walk::Next(INSTRUCTION)),
        "back by an instruction, over calls"),
    command(&["reverse-finish", "rf"], "", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Reverse, Walk::Finish),
        "back to before the call"),
    command(&["reverse-continue", "rc"], "[COUNT]", "walking", Offers::Nothing,
        |front, rest| walk::go(front, rest, Reverse, Walk::Continue),
        "back until something stops it"),
    command(&["recover"], "", "walking", Offers::Nothing, errors::recover,
        "on from an error that is due until the run is past it, or it is given up"),
    command(&["release"], "", "walking", Offers::Nothing, errors::release,
        "let an arm move again that has stopped"),
    command(&["goto", "go"], "MOMENT|start|end|error|NAME", "jumping", Offers::Moments, walk::goto,
        "to a moment, the last error, a bookmark or a checkpoint of the program"),
    command(&["last"], "EXPRESSION", "jumping", Offers::Values, walk::last,
        "to before the last change of it; again, to the one before that"),
    command(&["undo"], "", "jumping", Offers::Nothing, walk::undo,
        "back to before the last jump"),
    command(&["bookmark", "mark"], "[NAME]", "jumping", Offers::Nothing, walk::bookmark,
        "remember this moment; without a name, list what is remembered"),
    command(&["break", "b"], "[after] PLACE [if CONDITION]", "stopping", Offers::Places,
        |front, rest| stops::add(front, rest, false),
        "stop at a LINE, FILE:LINE, a sequence, a checkpoint, an opcode, `move`, `error NAME`"),
    command(&["tbreak", "tb"], "[after] PLACE [if CONDITION]", "stopping", Offers::Places,
        |front, rest| stops::add(front, rest, true),
        "the same, once"),
    command(&["watch", "w"], "EXPRESSION [forward|reverse] [if CONDITION]", "stopping",
        Offers::Values, stops::watch,
        "stop when it changes"),
    command(&["ignore"], "NUMBER COUNT", "stopping", Offers::Nothing, stops::ignore,
        "let a breakpoint pass so often"),
    command(&["condition"], "NUMBER [CONDITION]", "stopping", Offers::Breakpoints,
        stops::condition,
        "let a breakpoint stop only if this is true; without one, always"),
    command(&["enable", "en"], "[NUMBER...]", "stopping", Offers::Breakpoints,
        |front, rest| stops::switch(front, rest, true),
        "let breakpoints stop again; without a number, all"),
    command(&["disable", "dis"], "[NUMBER...]", "stopping", Offers::Breakpoints,
        |front, rest| stops::switch(front, rest, false),
        "let breakpoints stop nothing for now; without a number, all"),
    command(&["delete", "d"], "NUMBER...|all", "stopping", Offers::Breakpoints, stops::delete,
        "drop breakpoints"),
    command(&["clear"], "[[after] PLACE]", "stopping", Offers::Places, stops::clear,
        "drop the breakpoints at a place; without one, at this"),
    command(&["info", "i"],
        "breakpoints|bookmarks|display|frame|globals|history|locals|stack|state", "looking",
        Offers::Info, stops::info,
        "what there is of them"),
    command(&["print", "p"], "[EXPRESSION]", "looking", Offers::Values, values::print,
        "what it is: a variable, `force`, `held`, `output 2`, `joint 1`, a setting as \
         `reverse.speed`, or what is worked out of them; without one, every variable"),
    command(&["display"], "[EXPRESSION]", "looking", Offers::Values, displays::display,
        "show it wherever a command leads; without one, show what is shown"),
    command(&["undisplay"], "[NUMBER...]", "looking", Offers::Displays, displays::undisplay,
        "show it no more; without a number, nothing"),
    command(&["locals"], "[FRAME]", "looking", Offers::Nothing, values::locals,
        "the variables of a call; without one, of that which is looked at"),
    command(&["globals"], "", "looking", Offers::Nothing, values::globals,
        "the variables of the program"),
    command(&["state"], "", "looking", Offers::Nothing, values::state,
        "arm, force, what is held, outputs and settings"),
    command(&["backtrace", "bt", "where", "frames"], "", "looking", Offers::Nothing,
        frames::backtrace,
        "the calls under way"),
    command(&["frame", "f"], "[NUMBER]", "looking", Offers::Nothing, frames::frame,
        "look at a call: its variables, its source; until the run moves"),
    command(&["up"], "[COUNT]", "looking", Offers::Nothing, frames::up,
        "look at the call that called"),
    command(&["down"], "[COUNT]", "looking", Offers::Nothing, frames::down,
        "look at the call that was called"),
    command(&["history"], "[COUNT]", "looking", Offers::Nothing, values::history,
        "what the robot did around this moment"),
    command(&["tape"], "", "looking", Offers::Nothing, values::tape,
        "how much is recorded for the way back"),
    command(&["list", "l"], "[LINE|FIRST,LAST|FILE:LINE|SEQUENCE|-]", "looking", Offers::Places,
        code::list,
        "the source, with how each line is taken back; again, on from there; `-`, before that"),
    command(&["disassemble", "x"], "[/COUNT] [PLACE]", "looking", Offers::Places,
        code::disassemble,
        "the instructions around this one; `x/5i PLACE`, so many from a place on"),
    command(&["why"], "", "looking", Offers::Nothing, values::why,
        "what stops going back from here"),
    command(&["what-if", "try"], "", "trying", Offers::Nothing, tries::what_if,
        "go on otherwise from here; what was recorded stays as it is"),
    command(&["set"], "NAME = VALUE", "trying", Offers::Values, tries::set,
        "give a variable a value"),
    command(&["input"], "NAME high|low|real", "trying", Offers::Nothing, tries::input,
        "read an input as this level, or as what it is"),
    command(&["seed"], "N", "trying", Offers::Nothing, tries::seed,
        "draw chance and noise anew"),
    command(&["leave"], "", "trying", Offers::Nothing, tries::leave,
        "back to the run as it was"),
    command(&["help", "h"], "[COMMAND|TOPIC]", "", Offers::Commands,
        |_, rest| help(rest),
        "what there is"),
    command(&["quit", "q", "exit"], "", "", Offers::Nothing, |front, _| {
            front.is_over = true;
            Ok(Answer::default())
        },
        "end"),
];

/// The command of a name, of a shorter one, or of the beginning of a name that is no other's.
pub(super) fn find(word: &str) -> Result<&'static Command, String> {
    if let Some(found) = COMMANDS.iter().find(|command| command.names.contains(&word)) {
        return Ok(found);
    }
    let begun: Vec<&Command> =
        COMMANDS.iter().filter(|command| command.names[0].starts_with(word)).collect();
    match begun[..] {
        [one] => return Ok(one),
        [] => {}
        _ => {
            let names: Vec<String> =
                begun.iter().map(|command| format!("`{}`", command.names[0])).collect();
            return Err(format!("`{word}` may be {}", names.join(" or ")));
        }
    }
    let names = COMMANDS.iter().flat_map(|command| command.names.iter().copied());
    let hint = nearest(word, names).map_or_else(
        || "`help` lists what there is".to_owned(),
        |meant| format!("did you mean `{meant}`?"),
    );
    Err(format!("there is no command `{word}`; {hint}"))
}

/// Commands and topics, for completion.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    let commands = COMMANDS.iter().map(|command| command.names[0]);
    commands.chain(TOPICS.iter().map(|(topic, _)| *topic))
}

fn head(command: &Command) -> String {
    format!("{} {}", command.names.join(", "), command.arguments).trim_end().to_owned()
}

fn help(word: &str) -> Done {
    let of_topic = |topic: &str| {
        let commands = COMMANDS.iter().filter(|command| command.topic == topic);
        commands.flat_map(|command| [head(command), format!("    {}", command.help)]).collect()
    };
    if word.is_empty() {
        let topics = TOPICS.iter().map(|(topic, about)| {
            let commands = COMMANDS.iter().filter(|command| command.topic == *topic);
            let names: Vec<&str> = commands.map(|command| command.names[0]).collect();
            format!("{topic}: {about}\n  {}", names.join(", "))
        });
        let more = "`help walking`, `help step` say more; `quit` ends".to_owned();
        return Ok(Answer::lines(topics.chain([more]).collect()));
    }
    if let Some((topic, about)) = TOPICS.iter().find(|(topic, _)| *topic == word) {
        let mut lines: Vec<String> = of_topic(topic);
        lines.insert(0, format!("{topic}: {about}"));
        return Ok(Answer::lines(lines));
    }
    let command = find(word)?;
    Ok(Answer::lines(vec![head(command), format!("  {}", command.help)]))
}
