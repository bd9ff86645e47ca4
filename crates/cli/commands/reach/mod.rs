//! `obverse reach`: show how far back each line of a program can go, and what stops it.

mod draw;
pub(crate) mod margin;
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
    /// Explain what is on one line, or at one column of it: where it can go back to, and how. For a
    /// program without a source, an instruction.
    #[arg(long, value_name = "LINE[:COLUMN]")]
    at: Option<Place>,
    /// Draw with ASCII alone.
    #[arg(long)]
    ascii: bool,
    /// For machines: JSON Lines, an object a statement and a summary last.
    #[arg(long)]
    pub(crate) json: bool,
}

/// A line, and where in it, both from 1.
#[derive(Clone, Copy)]
struct Place {
    line: usize,
    column: Option<usize>,
}

impl std::str::FromStr for Place {
    type Err = &'static str;

    fn from_str(text: &str) -> std::result::Result<Self, Self::Err> {
        let number = |text: &str| text.parse().map_err(|_| "write a line, or line:column");
        let (line, column) = match text.split_once(':') {
            Some((line, column)) => (line, Some(number(column)?)),
            None => (text, None),
        };
        Ok(Self { line: number(line)?, column })
    }
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
        let all = rows.flat_map(|row| row.statements.iter().map(move |one| (row, one)));
        let Some(Place { line, column }) = self.arguments.at else { return Ok(all.collect()) };
        let of_line: Vec<_> = all.filter(|(row, _)| row.number == line).collect();
        let Some(first) = of_line.first() else {
            let unit = self.unit().trim_end_matches('s');
            let why = format!("{unit} {line} does nothing that could be gone back from");
            return Err(Problem::of_file(&self.arguments.file, why));
        };
        let Some(column) = column else { return Ok(of_line) };
        // The one that is written there; the first, before all of them.
        let begun = of_line.iter().map(|(_, one)| one.column).filter(|&begin| begin <= column);
        let begin = begun.max().unwrap_or(first.1.column);
        Ok(of_line.into_iter().filter(|(_, one)| one.column == begin).collect())
    }

    /// Where one line can go back to, and how.
    fn explain(&self) -> std::result::Result<(), Problem> {
        for (index, (_, statement)) in self.chosen()?.into_iter().enumerate() {
            if index > 0 {
                write::line("");
            }
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
                "column": has_source.then_some(statement.column),
                "text": row.text.trim(),
                "statement": crate::story::said(self.words.module, statement.point),
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
