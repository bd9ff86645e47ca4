//! What would have been: a run of its own, and what is changed in it.

use super::{Answer, Done, Front, values};
use obverse_debugger::{Declined, Expression, Subject};
use obverse_isa::Instr;

pub(super) fn what_if(front: &mut Front<'_>, _: &str) -> Done {
    front.session.what_if().map_err(|why| why.to_string())?;
    let hint = "what follows is tried in a copy of the workcell: `set`, `input` and `seed` change \
                it, `leave` drops it";
    Ok(front.jumped(vec![hint.to_owned()]))
}

pub(super) fn leave(front: &mut Front<'_>, _: &str) -> Done {
    front.session.leave_what_if().map_err(|why| why.to_string())?;
    Ok(front.jumped(Vec::new()))
}

pub(super) fn set(front: &mut Front<'_>, rest: &str) -> Done {
    front.require_try()?;
    let Some((name, text)) = rest.split_once('=') else {
        return Err("say `set NAME = VALUE`".to_owned());
    };
    let (name, text) = (name.trim(), text.trim());
    let is_name = name.chars().all(|c| c.is_alphanumeric() || "_$.".contains(c));
    let place: Expression = front.expression(name)?;
    let subject = match place.subjects()[..] {
        [subject @ (Subject::Global(_) | Subject::Local(..))] if is_name => subject.clone(),
        _ => return Err(format!("`{name}` is no variable")),
    };
    let given = front.expression(text)?;
    let value = front.session.look(|look| given.value(look));
    front.session.assign(&subject, &value).map_err(|why| match why {
        Declined::NotAssignable => format!("`{name}` cannot be {value}"),
        why => why.to_string(),
    })?;
    let now = front.session.look(|look| subject.read(look));
    let mut lines = vec![format!("{name} is {now}")];
    if front.is_yet_to_begin(&subject) {
        lines.push(format!(
            "the program has yet to give `{name}` its first value, and does so on its way into \
             the first sequence: `step` leads there, and a `set` after it holds"
        ));
    }
    Ok(Answer::lines(lines).with_all(values::data([("value", &now)])))
}

impl Front<'_> {
    /// Whether the start of the program has yet to give a variable its first value.
    fn is_yet_to_begin(&self, subject: &Subject) -> bool {
        let (Subject::Global(of), Some(start)) = (subject, self.calls().pop()) else {
            return false;
        };
        let end = self.module.functions.get(usize::from(start.function)).map_or(0, |it| it.end);
        let mut code = self.module.code.iter().take(end as usize).skip(start.pc as usize);
        code.any(|instr| matches!(instr, Instr::StoreGlobal { global, .. } if global == of))
    }
}

pub(super) fn input(front: &mut Front<'_>, rest: &str) -> Done {
    front.require_try()?;
    let (name, level) = rest.rsplit_once(' ').unwrap_or((rest, ""));
    let level = match level {
        "high" => Some(true),
        "low" => Some(false),
        "real" => None,
        _ => return Err("say `input NAME high`, `low`, or `real` for what it is".to_owned()),
    };
    let asked = front.expression(&format!("input {}", name.trim()))?;
    let [Subject::Input(bit)] = asked.subjects()[..] else {
        return Err(format!("`{name}` is no input"));
    };
    let bit = *bit;
    front.session.force_input(bit, level).map_err(|why| why.to_string())?;
    Ok(Answer::line(match level {
        Some(true) => format!("input {bit} reads high from here on"),
        Some(false) => format!("input {bit} reads low from here on"),
        None => format!("input {bit} reads as it is"),
    }))
}

pub(super) fn seed(front: &mut Front<'_>, rest: &str) -> Done {
    front.require_try()?;
    let seed: u64 = rest.parse().map_err(|_| format!("`{rest}` is no seed: say a whole number"))?;
    front.session.change_workcell(|cell| cell.reseed(seed)).map_err(|why| why.to_string())?;
    Ok(Answer::line(format!("chance and noise follow from seed {seed} from here on")))
}
