//! `obverse reach`: show how far back each line of a program can go, and what stops it.

mod draw;
mod page;
mod words;

use super::Result;
use crate::problem::Problem;
use crate::{Outcome, load, write};
use draw::Pens;
use obverse_reach::{Horizon, Reach, Verdict};
use page::{Page, Row, Statement};
use serde_json::{Value, json};
use std::path::PathBuf;
use words::Words;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The program: source, assembly text or module.
    file: PathBuf,
    /// Explain one line: where it can go back to, and how. For a program without a source, an
    /// instruction.
    #[arg(long, value_name = "LINE")]
    at: Option<usize>,
    /// Draw with ASCII alone.
    #[arg(long)]
    ascii: bool,
    /// For machines: JSON Lines, an object a statement and a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result {
    let program = load::program(&arguments.file)?;
    let module = program.verified.module();
    let (reach, words) = (Reach::of(module), Words::new(module));
    let view = View { arguments, page: Page::of(module, &reach, &words), reach, words };
    match (arguments.json, arguments.at) {
        (true, _) => view.as_json()?,
        (false, Some(_)) => view.explain()?,
        (false, None) => view.draw(),
    }
    Ok(Outcome::Done)
}

struct View<'m> {
    arguments: &'m Arguments,
    reach: Reach<'m>,
    words: Words<'m>,
    page: Page,
}

impl View<'_> {
    fn draw(&self) {
        let pens = if self.arguments.ascii { Pens::ASCII } else { Pens::LINES };
        write::out(&draw::picture(&self.page, &pens));
        write::out(&draw::table(&self.page, &pens, self.unit()));
    }

    fn unit(&self) -> &'static str {
        if self.words.has_source() { "lines" } else { "instructions" }
    }

    /// The statements that are asked for.
    fn chosen(&self) -> std::result::Result<Vec<(&Row, &Statement)>, Problem> {
        let rows = self.page.rows.iter();
        let all = rows.filter_map(|row| Some((row, row.statement.as_ref()?)));
        let Some(line) = self.arguments.at else { return Ok(all.collect()) };
        let chosen: Vec<_> = all.filter(|(row, _)| row.number == line).collect();
        if chosen.is_empty() {
            let unit = self.unit().trim_end_matches('s');
            let why = format!("{unit} {line} does nothing that could be gone back from");
            return Err(Problem::of_file(&self.arguments.file, why));
        }
        Ok(chosen)
    }

    /// Where one line can go back to, and how.
    fn explain(&self) -> std::result::Result<(), Problem> {
        for (_, statement) in self.chosen()? {
            let function = self.words.function(statement.function);
            let place = self.words.statement(statement.point);
            write::line(&format!("{place}, in {function}: {}", statement.standing.name()));
            let verdict = self.reach.at(statement.point);
            if verdict.horizons.is_empty() {
                write::line("nothing comes there");
            }
            for &horizon in &verdict.horizons {
                write::line(&format!("\ngoes back to {}", self.words.end(&self.reach, horizon)));
                let way = self.reach.way(statement.point, horizon);
                let steps = way.map(|way| self.words.way(&way)).unwrap_or_default();
                steps.iter().for_each(|step| write::line(&format!("  {step}")));
            }
            if verdict.is_more {
                write::line("\nand to others");
            }
        }
        Ok(())
    }

    fn as_json(&self) -> std::result::Result<(), Problem> {
        let chosen = self.chosen()?;
        for (row, statement) in &chosen {
            let verdict = self.reach.at(statement.point);
            let file = self.words.module.sources.get(usize::from(row.file));
            let has_source = self.words.has_source();
            let object = json!({
                "type": "statement",
                "file": file.filter(|_| has_source).map(|file| &file.name),
                "line": has_source.then_some(row.number),
                "text": row.text.trim(),
                "function": self.words.module.functions[statement.function].name,
                "instruction": statement.point,
                "action": statement.is_action,
                "class": statement.standing.name(),
                "reached": !verdict.horizons.is_empty(),
                "stretch": statement.stretch.map(draw::letter),
                "stops": self.stops(&verdict, statement.point),
                "more": verdict.is_more,
            });
            write::line(&object.to_string());
        }
        let stretches = self.page.stretches.iter().enumerate().map(|(index, stretch)| {
            let stops: Vec<Value> =
                stretch.verdict.horizons.iter().map(|&horizon| self.stop(horizon)).collect();
            json!({ "stretch": draw::letter(index), "stops": stops })
        });
        let summary = json!({
            "type": "summary",
            "outcome": "shown",
            "statements": chosen.len(),
            "stretches": stretches.collect::<Vec<_>>(),
        });
        write::line(&summary.to_string());
        Ok(())
    }

    /// What may stop going back; for one line, with the way there.
    fn stops(&self, verdict: &Verdict, point: u32) -> Vec<Value> {
        let stops = verdict.horizons.iter().map(|&horizon| {
            let mut stop = self.stop(horizon);
            let way = self.arguments.at.and_then(|_| self.reach.way(point, horizon));
            if let Some(way) = way {
                stop["way"] = json!(self.words.way(&way));
            }
            stop
        });
        stops.collect()
    }

    fn stop(&self, horizon: Horizon) -> Value {
        match horizon {
            Horizon::Start => json!({ "at": "start" }),
            Horizon::Never(pc) => json!({
                "at": "never",
                "instruction": pc,
                "file": self.words.place(pc).map(|(file, _)| {
                    &self.words.module.sources[usize::from(file)].name
                }),
                "line": self.words.place(pc).map(|(_, line)| line),
                "reason": self.reach.reason(pc),
            }),
        }
    }
}
