//! What is told of the moment that is shown: calls, variables, what was done, and why going back
//! ends where it does.

use super::Session;
use crate::notes::Note;
use crate::place::{SourcePlace, source_place};
use crate::recording::Moment;
use crate::subject::{Subject, Value, count, loops_around, measured, variable};
use crate::writers::commands;
use obverse_bytecode::{ActionKind, Module};
use obverse_isa::{Class, LocalId, Setting};
use obverse_reach::{Reach, Verdict, reason};
use obverse_vm::Direction;
use obverse_workcell::Workcell;

/// A call under way.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameView {
    /// Which, from the outermost.
    pub index: usize,
    /// The function, as an index into the module's.
    pub function: u16,
    /// Its name.
    pub name: String,
    /// The instruction that is next in it.
    pub pc: u32,
    /// Its source.
    pub place: Option<SourcePlace>,
}

/// A variable and what it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// What it is asked for by; of a call that is not the innermost of its function, none.
    pub subject: Option<Subject>,
    /// What it is.
    pub value: Value,
}

/// Something that the robot did.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// When it began.
    pub moment: Moment,
    /// Its first command.
    pub pc: u32,
    /// What it is.
    pub kind: Option<ActionKind>,
    /// Which way.
    pub direction: Direction,
    /// Its source.
    pub place: Option<SourcePlace>,
    /// The first line of it.
    pub text: String,
    /// When it was over, in seconds of the workcell's clock.
    pub end_s: f64,
}

/// A part of the history, around what is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Around {
    /// What the robot did, oldest first.
    pub actions: Vec<Action>,
    /// Before which of these what is shown stands; none if nothing came later.
    pub here: Option<usize>,
}

/// What stops going back from a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Why {
    /// The newest instruction before it that cannot be taken back, when that was, and why; none if
    /// nothing stops it before the start.
    pub never: Option<Stopper>,
    /// What could stop it, on whatever way a run comes there.
    pub verdict: Verdict,
    /// How many things that the robot did lie between.
    pub actions: usize,
    /// Whether the very next step back is refused.
    pub is_refused_here: bool,
}

/// Something that cannot be taken back.
#[derive(Clone, Debug, PartialEq)]
pub struct Stopper {
    /// The instruction.
    pub pc: u32,
    /// When.
    pub moment: Moment,
    /// Its source.
    pub place: Option<SourcePlace>,
    /// Why, in the words of the program if it has any.
    pub reason: String,
}

impl<C: Workcell> Session<'_, C> {
    /// The calls under way, outermost first.
    #[must_use]
    pub fn frames(&self) -> Vec<FrameView> {
        let module = self.module();
        let state = self.machine().state();
        let frames = state.frames();
        let next = frames.iter().skip(1).map(|frame| frame.return_pc);
        let pcs = next.chain([state.pc()]);
        let view = |(index, (frame, pc)): (usize, (&obverse_vm::Frame, u32))| {
            let declared = module.functions.get(usize::from(frame.function));
            // A caller stands at its call.
            let is_caller = index + 1 < frames.len();
            let shown = pc - u32::from(is_caller && pc > 0);
            FrameView {
                index,
                function: frame.function,
                name: declared.map(|declared| declared.name.clone()).unwrap_or_default(),
                pc,
                place: source_place(module, shown),
            }
        };
        frames.iter().zip(pcs).enumerate().map(view).collect()
    }

    /// The variables of a call, counted from the outermost; hidden ones left out.
    #[must_use]
    pub fn locals(&self, frame: usize) -> Vec<Variable> {
        let module = self.module();
        let frames = self.machine().state().frames();
        let Some(called) = frames.get(frame) else { return Vec::new() };
        let Some(function) = module.functions.get(usize::from(called.function)) else {
            return Vec::new();
        };
        let is_newest = frames.iter().rposition(|it| it.function == called.function) == Some(frame);
        let shown = self.frames().get(frame).map_or(0, |shown| shown.pc);
        // A caller stands behind its call.
        let is_caller = frame + 1 < frames.len();
        let around = loops_around(module, shown.saturating_sub(u32::from(is_caller)));
        let counters = around.map(|around| Variable {
            name: around.name.clone(),
            subject: variable(module, usize::from(called.function), &around.name)
                .map(|(subject, ..)| subject)
                .filter(|_| is_newest),
            value: Value::Int(count(module, around, called)),
        });
        let locals = (0_u8..).zip(&function.locals).filter(|(_, it)| !it.name.starts_with('$'));
        let local = |(index, declared): (u8, &obverse_bytecode::Variable)| Variable {
            name: declared.name.clone(),
            subject: is_newest.then_some(Subject::Local(called.function, LocalId(index))),
            value: measured(module, declared, called.local(index)),
        };
        locals.map(local).chain(counters).collect()
    }

    /// The variables of the program; hidden ones left out.
    #[must_use]
    pub fn globals(&self) -> Vec<Variable> {
        let module = self.module();
        let subjects = (0..).zip(&module.globals).filter(|(_, it)| !it.name.starts_with('$'));
        let subjects = subjects.map(|(index, _)| Subject::Global(obverse_isa::GlobalId(index)));
        self.variables(subjects)
    }

    /// What is seen of the workcell, and the settings.
    #[must_use]
    pub fn workcell(&self) -> Vec<Variable> {
        let outputs = self.recording().facts.outputs;
        let plain = [Subject::Joints, Subject::Force, Subject::Held, Subject::Time];
        let settings = Setting::ALL.iter().map(|setting| Subject::Setting(*setting));
        self.variables(plain.into_iter().chain((0..outputs).map(Subject::Output)).chain(settings))
    }

    fn variables(&self, subjects: impl Iterator<Item = Subject>) -> Vec<Variable> {
        let module = self.module();
        self.look(|look| {
            let variable = |subject: Subject| Variable {
                name: subject.name(module),
                value: subject.read(look),
                subject: Some(subject),
            };
            subjects.map(variable).collect()
        })
    }

    /// What the robot did, oldest first: of the whole recording, also behind what is shown.
    #[must_use]
    pub fn history(&self) -> Vec<Action> {
        let module = self.module();
        let mut actions: Vec<Action> = Vec::new();
        let mut newest: Option<&Note> = None;
        for note in self.run().notes() {
            if module.source_at(note.pc).is_none() {
                continue;
            }
            let is_on = newest.is_some_and(|before| goes_on(module, before, note));
            newest = Some(note);
            match actions.last_mut() {
                Some(action) if is_on => action.end_s = note.now_s,
                _ => actions.push(action(module, note)),
            }
        }
        actions
    }

    /// So many of these before what is shown, and half as many of what came later.
    #[must_use]
    pub fn history_around(&self, count: usize) -> Around {
        let mut actions = self.history();
        let now = self.moment();
        let behind = actions.partition_point(|action| action.moment < now);
        let here = (behind < actions.len()).then_some(behind.min(count));
        actions.truncate(behind + count / 2);
        actions.drain(..behind.saturating_sub(count));
        Around { actions, here }
    }

    /// What stops going back from what is shown.
    #[must_use]
    pub fn why(&self) -> Why {
        let module = self.module();
        let standing = self.standing();
        let is_never = |note: &&&Note| {
            let class = module.code.get(note.pc as usize).map(|instr| instr.info().class);
            matches!(class, Some(Class::Never(_))) && note.open_blocks == 0
        };
        let never = standing.iter().rev().find(is_never).copied();
        let since = never.map_or(0, |note| note.steps);
        let state = self.machine().state();
        let stopper = never.map(|note| Stopper {
            pc: note.pc,
            moment: note.moment,
            place: source_place(module, note.pc),
            reason: reason(module, note.pc).to_owned(),
        });
        let is_behind = |note: &Note| state.steps() == note.steps && state.pc() == note.pc + 1;
        let mut newest: Option<&Note> = None;
        let mut actions = 0;
        for note in standing.iter().copied().filter(|note| note.steps > since) {
            let is_action = module.code.get(note.pc as usize).is_some_and(commands);
            let is_on = newest.is_some_and(|before| goes_on(module, before, note));
            actions += usize::from(is_action && !is_on);
            newest = Some(note);
        }
        Why {
            is_refused_here: never.is_some_and(is_behind),
            never: stopper,
            verdict: Reach::of(module).at(state.pc()),
            actions,
        }
    }

    /// What was done before what is shown and has not been taken back, oldest first.
    fn standing(&self) -> Vec<&Note> {
        let now = self.moment();
        let mut standing: Vec<&Note> = Vec::new();
        // Done again, it is not what was done before it was taken back.
        let cut = |standing: &mut Vec<&Note>, steps: u64| {
            while standing.last().is_some_and(|last| last.steps > steps) {
                standing.pop();
            }
        };
        for note in self.run().notes().iter().filter(|note| note.moment < now) {
            match note.direction {
                Direction::Forward => {
                    cut(&mut standing, note.steps.saturating_sub(1));
                    standing.push(note);
                }
                Direction::Reverse => cut(&mut standing, note.steps),
            }
        }
        cut(&mut standing, self.machine().state().steps());
        standing
    }
}

/// Whether a note is of the same action as the one before it.
fn goes_on(module: &Module, before: &Note, note: &Note) -> bool {
    let first = |note: &Note| module.source_at(note.pc).map(|entry| entry.first);
    let is_on = match note.direction {
        Direction::Forward => note.pc > before.pc,
        Direction::Reverse => note.pc < before.pc,
    };
    is_on
        && first(before) == first(note)
        && before.direction == note.direction
        && before.depth == note.depth
}

fn action(module: &Module, note: &Note) -> Action {
    let entry = module.source_at(note.pc);
    let text = entry.and_then(|entry| {
        let source = module.sources.get(usize::from(entry.file))?;
        let text = source.text.get(entry.start as usize..entry.end as usize)?;
        text.lines().next().map(str::trim)
    });
    Action {
        moment: note.moment,
        pc: note.pc,
        kind: entry.and_then(|entry| entry.action),
        direction: note.direction,
        place: source_place(module, note.pc),
        text: text.unwrap_or_default().to_owned(),
        end_s: note.now_s,
    }
}
