//! What is shown again wherever a command leads.

use super::{Answer, Done, Front, values};
use obverse_debugger::{Expression, Subject, Value};
use serde_json::{Map, Value as Json, json};

/// The most that is shown at once.
const MAX_DISPLAYS: usize = 100;

/// What is shown, by numbers that are not used again.
#[derive(Default)]
pub(super) struct Displays {
    all: Vec<(u32, Expression)>,
    last: u32,
}

impl Displays {
    /// The numbers, for completion.
    pub(super) fn numbers(&self) -> impl Iterator<Item = u32> {
        self.all.iter().map(|(number, _)| *number)
    }
}

impl Front<'_> {
    /// What is shown here: nothing of a call that is not under way.
    fn displayed(&self) -> Vec<(u32, &Expression, Value)> {
        let calls = self.calls();
        let is_under_way = |expression: &Expression| {
            expression.subjects().iter().all(|subject| match subject {
                Subject::Local(function, _) => calls.iter().any(|it| it.function == *function),
                _ => true,
            })
        };
        let here = self.displays.all.iter().filter(|(_, expression)| is_under_way(expression));
        self.session.look(|look| {
            here.map(|(number, expression)| (*number, expression, expression.value(look))).collect()
        })
    }

    /// An answer, and what is shown wherever a command leads.
    pub(super) fn shown(&self, mut answer: Answer) -> Answer {
        if self.displays.all.is_empty() {
            return answer;
        }
        let displayed = self.displayed();
        let line = |(number, expression, value): &(u32, &Expression, Value)| {
            format!("{number}: {} = {value}", expression.text())
        };
        answer.lines.extend(displayed.iter().map(line));
        let data = |(number, expression, value): &(u32, &Expression, Value)| {
            let mut data = values::data([("value", value)]);
            data.insert("number".to_owned(), json!(number));
            data.insert("text".to_owned(), json!(expression.text()));
            data
        };
        let data: Vec<Map<String, Json>> = displayed.iter().map(data).collect();
        answer.with("display", data)
    }
}

pub(super) fn display(front: &mut Front<'_>, rest: &str) -> Done {
    if rest.is_empty() {
        return Ok(match front.displays.all.is_empty() {
            true => Answer::line("nothing is shown after each command; `display EXPRESSION` adds"),
            false => front.shown(Answer::default()),
        });
    }
    if front.displays.all.len() == MAX_DISPLAYS {
        return Err(format!("{MAX_DISPLAYS} are shown already; `undisplay` drops some"));
    }
    let expression = front.expression(rest)?;
    front.displays.last += 1;
    let number = front.displays.last;
    let value = front.session.look(|look| expression.value(look));
    let line = format!("{number}: {} = {value}", expression.text());
    front.displays.all.push((number, expression));
    let answer = Answer::line(line).with("number", number);
    Ok(answer.with_all(values::data([("value", &value)])))
}

pub(super) fn undisplay(front: &mut Front<'_>, rest: &str) -> Done {
    if matches!(rest, "" | "all") {
        front.displays.all.clear();
        return Ok(Answer::default());
    }
    let known = |number: &u32| front.displays.numbers().any(|known| known == *number);
    let number = |text: &str| {
        let number = text.parse().ok().filter(known);
        number.ok_or_else(|| format!("nothing is shown by the number `{text}`"))
    };
    let dropped: Vec<u32> = rest.split_whitespace().map(number).collect::<Result<_, _>>()?;
    front.displays.all.retain(|(number, _)| !dropped.contains(number));
    Ok(Answer::default())
}

/// All of them, also those that are not shown here.
pub(super) fn info(front: &Front<'_>) -> Answer {
    let all = &front.displays.all;
    let data: Vec<Json> = all
        .iter()
        .map(|(number, expression)| json!({ "number": number, "text": expression.text() }))
        .collect();
    let line =
        |(number, expression): &(u32, Expression)| format!("{number}: {}", expression.text());
    match all.is_empty() {
        true => Answer::line("nothing is shown after each command"),
        false => Answer::lines(all.iter().map(line).collect()),
    }
    .with("displays", data)
}
