//! `obverse back`: run a program, then take it back as far as it goes, and compare.

use super::Result;
use super::run;
use crate::load;
use crate::recovering::Kept;
use crate::report;
use crate::taping::{self, Rig};
use crate::write;
use obverse_recovery::Ending;
use obverse_workcell::{Clock, Safety};
use serde_json::{Map, json};

pub(crate) type Arguments = run::Arguments;

pub(crate) fn run(arguments: &Arguments) -> Result {
    let program = load::program_with(&arguments.file, &arguments.parameters.parameters)?;
    let (mut cell, file, before) = run::workcell(arguments, &program)?;
    let mut machine = load::machine(&program, &cell, &file)?;
    let module = program.verified.module();
    let kept = Kept::read(arguments.recovering.policy.memory.as_deref(), &program, &file.name)?;
    let mut memory = kept.memory();
    let mut tape = taping::create(arguments.tape.as_deref())?;
    let start = machine.digest(&cell);
    let mut rig =
        Rig::of(arguments, &program, (&mut machine, &mut cell), tape.as_mut(), (&file, before))?;
    run::head(arguments, &file.name);
    let (there, _) = run::there(arguments, rig.driven(), &mut memory);
    let driven = rig.driven();
    let (there_s, forward_instructions) = (driven.cell().now_s(), driven.machine().executed());
    let tape_bits = driven.machine().tape().map_or(0, obverse_tape::Tape::recorded_bits);
    if !arguments.json {
        write::line(&report::ending_words(module, &there));
        write::line(&run::figures_line(driven.machine(), driven.cell()));
        write::line("\nand back");
    }
    // The fresh command without which nothing moves after a stop.
    if driven.cell().is_stopped() {
        driven.release();
    }
    let back = run::back(arguments, driven);
    let recorded = rig.end(&report::ending_words(module, &back)).and_then(|()| kept.keep(&memory));
    let is_identical = back == Ending::AtStart && machine.digest(&cell) == start;
    let back_s = cell.now_s() - there_s;
    if arguments.json {
        let mut figures = report::figures(&machine, &cell);
        figures.insert("tape_bits".to_owned(), json!(tape_bits));
        let mut more = Map::new();
        more.insert("there".to_owned(), json!(there.code()));
        more.insert("identical".to_owned(), json!(is_identical));
        more.insert("stopped_at".to_owned(), report::place(module, report::ending_pc(&back)));
        more.insert("message".to_owned(), json!(report::ending_words(module, &back)));
        more.insert("forward_instructions".to_owned(), json!(forward_instructions));
        more.insert("forward_time_s".to_owned(), json!(there_s));
        more.insert("reverse_time_s".to_owned(), json!(back_s));
        more.extend(recorded.as_ref().err().map(report::messages));
        report::summary(back.code(), figures, more);
    } else {
        let verdict = match (&back, is_identical) {
            (Ending::AtStart, true) => {
                "the state is identical to the start, bit for bit".to_owned()
            }
            (Ending::AtStart, false) => {
                "at the start, where a block with a reverse of its own left the workcell otherwise"
                    .to_owned()
            }
            (other, _) => report::ending_words(module, other),
        };
        write::line(&verdict);
        let instructions = machine.executed() - forward_instructions;
        write::line(&format!("{instructions} instructions taken back, {back_s:.2} s"));
    }
    let went = matches!(back, Ending::AtStart | Ending::Refused(_));
    Ok(run::outcome(went, recorded))
}
