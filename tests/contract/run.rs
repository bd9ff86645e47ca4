//! Holding the machine to a contract.

use super::cell::Cell;
use super::picture::{self, Picture, Words};
use super::{Back, Case, Clause, Contract, Value};
use obverse_bytecode::{Verified, assemble, verify};
use obverse_geometry::JointConfiguration;
use obverse_isa::{Class, Instr, OpInfo, RecordKind};
use obverse_vm::{Direction, Machine, Refusal, Stop, Trap, TrapKind};
use obverse_workcell::Safety;

/// The longest way to the instruction of a case, in steps.
const MAX_STEPS: usize = 2_000;
/// What restores less than was there, by the programmer's own word.
const MAY_DIFFER: [&str; 3] = ["move.always", "block.skip", "block.replace"];
/// Clauses that say how a step ended, and what it commanded, rather than what there is.
const OF_THE_STEP: [&str; 8] =
    ["commands", "trap", "fault", "raises", "due", "stop", "refused", "lands"];

/// Whether a contract is of a row, and holds.
pub(crate) fn holds(row: &OpInfo, contract: &Contract) -> Result<(), String> {
    if contract.op != row.mnemonic {
        return Err(format!("it says that it is of `{}`", contract.op));
    }
    if contract.class != row.class.to_string() {
        return Err(format!("the class is {}, and it says {}", row.class, contract.class));
    }
    for case in &contract.cases {
        run(row, case).map_err(|broken| format!("case `{}`: {broken}", case.title))?;
    }
    let goes_back = |case: &Case| {
        let refused = case.back.iter().any(|back| clause(&back.clauses, "refused").is_some());
        !case.back.is_empty() && refused == matches!(row.class, Class::Never(_))
    };
    let shown = contract.cases.iter().any(goes_back);
    shown.then_some(()).ok_or_else(|| "no case shows what its class means going back".to_owned())
}

fn run(row: &OpInfo, case: &Case) -> Result<(), String> {
    let module = assemble(&case.source).map_err(|errors| listed(&errors))?;
    let program = verify(module).map_err(|errors| listed(&errors))?;
    let mut trial = Trial::begin(row, case, &program)?;
    trial.approach()?;
    trial.before()?;
    trial.forward()?;
    for back in &case.back {
        trial.back(back).map_err(|broken| format!("back: {broken}"))?;
    }
    Ok(())
}

fn listed(errors: &[impl ToString]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

fn clause<'c>(clauses: &'c [Clause], key: &str) -> Option<&'c Value> {
    clauses.iter().find(|clause| clause.key == key).map(|clause| &clause.value)
}

/// A case being run.
struct Trial<'t> {
    row: &'t OpInfo,
    case: &'t Case,
    words: Words<'t>,
    program: &'t Verified,
    machine: Machine<'t>,
    cell: Cell,
    /// The instruction that is stepped over.
    pc: u32,
    /// What there was at each step up to the one before the last.
    history: Vec<Picture>,
}

impl<'t> Trial<'t> {
    fn begin(row: &'t OpInfo, case: &'t Case, program: &'t Verified) -> Result<Self, String> {
        let words = Words { module: program.module(), labels: &case.labels };
        let mut cell = Cell::new();
        for clause in &case.given {
            given(&mut cell, &words, clause)?;
        }
        let machine = Machine::new(program, &cell).map_err(|errors| listed(&errors))?;
        let pc = case.pc.ok_or("it has no `before`")?;
        let mut trial = Self { row, case, words, program, machine, cell, pc, history: Vec::new() };
        trial.history.push(trial.picture());
        Ok(trial)
    }

    fn picture(&self) -> Picture {
        picture::of(&self.machine, &self.cell)
    }

    fn step(&mut self, direction: Direction) -> Result<(), Stop> {
        self.machine.step(direction, &mut self.cell, &mut ())
    }

    /// Run up to the instruction.
    fn approach(&mut self) -> Result<(), String> {
        let visits = clause(&self.case.given, "visit").map(Value::one).transpose()?.unwrap_or("1");
        let mut visits: usize = visits.parse().map_err(|_| "`visit` is a number")?;
        loop {
            visits -= usize::from(self.machine.state().pc() == self.pc);
            if visits == 0 {
                return Ok(());
            }
            match self.step(Direction::Forward) {
                Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. }) => {
                    self.history.push(self.picture());
                }
                Err(stop) => return Err(format!("on the way to it: {stop:?}")),
            }
            if self.history.len() > MAX_STEPS {
                return Err("control never comes to it".to_owned());
            }
        }
    }

    fn before(&mut self) -> Result<(), String> {
        let found = self.picture();
        let mut expected = found.clone();
        for clause in &self.case.before {
            self.words.apply(&mut expected, clause, &found, self.pc)?;
        }
        same(&expected, &found).map_err(|broken| format!("before: {broken}"))?;
        if let Some(fraction) = clause(&self.case.given, "stopped") {
            let fraction = fraction.one()?.parse().map_err(|_| "`stopped` is a fraction")?;
            self.cell.ledger.stop_at = Some((self.cell.ledger.acts, fraction));
        }
        Ok(())
    }

    fn forward(&mut self) -> Result<(), String> {
        let before = self.picture();
        self.is_of_the_row()?;
        self.cell.log.clear();
        let outcome = self.step(Direction::Forward);
        let after = self.picture();
        let clauses = &self.case.after;
        self.ended(&outcome, clauses)?;
        self.commanded(clauses)?;
        let mut expected = match &outcome {
            Ok(()) | Err(Stop::Raised { .. } | Stop::Due { .. }) => {
                self.one_step_on(&before, clauses)?
            }
            Err(Stop::Trap(_)) => self.at_statement()?,
            Err(_) => before.clone(),
        };
        for clause in clauses.iter().filter(|clause| !OF_THE_STEP.contains(&&*clause.key)) {
            self.words.apply(&mut expected, clause, &after, self.pc)?;
        }
        if let Some(landed) = clause(clauses, "lands") {
            let join = self.words.label(landed.one()?)?;
            expected.insert("at".to_owned(), vec![u64::from(join) + 1]);
        }
        if expected != before && !matches!(outcome, Err(Stop::Trap(_))) {
            // Of a state that was never there nothing but the machine knows the digest.
            expected.insert("digest".to_owned(), after["digest"].clone());
        }
        same(&expected, &after).map_err(|broken| format!("after: {broken}"))?;
        if outcome.is_ok() && self.instr(self.pc).opcode() == self.row.opcode {
            self.records_its_class(&before, &after)?;
        }
        if self.cell.is_stopped() {
            self.cell.release();
        }
        Ok(())
    }

    fn back(&mut self, back: &Back) -> Result<(), String> {
        let standing = self.picture();
        self.cell.log.clear();
        let mut outcome = self.step(Direction::Reverse);
        for _ in 1..back.steps {
            outcome.map_err(|stop| format!("{stop:?}"))?;
            outcome = self.step(Direction::Reverse);
        }
        self.ended(&outcome, &back.clauses)?;
        self.commanded(&back.clauses)?;
        let found = self.picture();
        let at = match clause(&back.clauses, "at") {
            Some(label) => self.words.label(label.one()?)?,
            None => self.pc,
        };
        let was = match outcome {
            Ok(()) => self.picture_at(at)?,
            Err(_) => standing,
        };
        let mut expected = was.clone();
        for clause in back.clauses.iter().filter(|clause| !OF_THE_STEP.contains(&&*clause.key)) {
            self.words.apply(&mut expected, clause, &found, self.pc)?;
        }
        if back.may_differ {
            let is_fault = clause(&back.clauses, "fault").is_some();
            if !is_fault && !MAY_DIFFER.contains(&self.row.mnemonic) {
                return Err(format!("`{}` goes back without difference", self.row.mnemonic));
            }
            expected.insert("digest".to_owned(), found["digest"].clone());
        } else {
            same(&was, &expected)
                .map_err(|broken| format!("it is not what was there: {broken}"))?;
        }
        same(&expected, &found)
    }

    /// The state a step further, but for what clauses say.
    fn one_step_on(&self, before: &Picture, clauses: &[Clause]) -> Result<Picture, String> {
        let mut expected = before.clone();
        expected.insert("steps".to_owned(), vec![before["steps"][0] + 1]);
        if clause(clauses, "lands").is_none() {
            expected.insert("at".to_owned(), vec![u64::from(self.pc) + 1]);
        }
        Ok(expected)
    }

    /// What there was when the statement at hand had not begun.
    fn at_statement(&self) -> Result<Picture, String> {
        let is_pure = |pc: u32| self.instr(pc).info().family.is_pure();
        let start = (1..=self.pc).rev().find(|pc| !is_pure(pc - 1)).unwrap_or(self.pc);
        self.picture_at(start)
    }

    /// What there was when control was last at an instruction.
    fn picture_at(&self, pc: u32) -> Result<Picture, String> {
        let there = self.history.iter().rev().find(|picture| picture["at"] == [u64::from(pc)]);
        there.cloned().ok_or_else(|| format!("control was never at instruction {pc}"))
    }

    fn instr(&self, pc: u32) -> Instr {
        self.program.module().code[pc as usize]
    }

    /// Whether the instruction is of the opcode, or one that lands on it.
    fn is_of_the_row(&self) -> Result<(), String> {
        let stepped = self.instr(self.pc);
        let landing = match stepped {
            Instr::Call { .. } => Some(Instr::Enter {}),
            _ => stepped.jump_target().map(|target| self.instr(target.0)),
        };
        let is_row = |instr: &Instr| instr.opcode() == self.row.opcode;
        let is_shown = is_row(&stepped) || landing.is_some_and(|landing| is_row(&landing));
        let found = stepped.info().mnemonic;
        is_shown.then_some(()).ok_or_else(|| format!("it is of `{found}`, which is another opcode"))
    }

    /// Whether the step ended as the clauses say.
    fn ended(&self, outcome: &Result<(), Stop>, clauses: &[Clause]) -> Result<(), String> {
        let module = self.program.module();
        let (key, text) = match outcome {
            Ok(()) => ("", String::new()),
            Err(Stop::Trap(Trap { kind: TrapKind::Required(reason), .. })) => {
                ("trap", module.reasons[reason.index()].clone())
            }
            Err(Stop::Trap(trap)) => ("trap", trap.kind.to_string()),
            Err(Stop::Fault { fault, .. }) => ("fault", fault.kind().code().to_owned()),
            Err(Stop::Raised { error, .. }) => {
                ("raises", module.errors[error.index()].name.clone())
            }
            Err(Stop::Due { error, .. }) => ("due", module.errors[error.index()].name.clone()),
            Err(Stop::Finished) => ("stop", "finished".to_owned()),
            Err(Stop::AtStart) => ("stop", "start".to_owned()),
            Err(Stop::Refused(Refusal { reason, why, .. })) => {
                if self.row.class != Class::Never(why) {
                    return Err(format!("it is refused since {why}"));
                }
                let reason = reason.map(|reason| module.reasons[reason.index()].clone());
                ("refused", reason.unwrap_or_default())
            }
            Err(stop @ (Stop::AtMark | Stop::OffMark | Stop::Budget)) => {
                return Err(format!("{stop:?}"));
            }
        };
        let pc = match outcome {
            Err(Stop::Trap(Trap { pc, .. }) | Stop::Refused(Refusal { pc, .. }))
            | Err(Stop::Fault { pc, .. } | Stop::Raised { pc, .. } | Stop::Due { pc, .. }) => *pc,
            _ => self.pc,
        };
        if pc != self.pc {
            return Err(format!("it stopped at instruction {pc}, and should at {}", self.pc));
        }
        for kind in ["trap", "fault", "raises", "due", "stop", "refused"] {
            let said = clause(clauses, kind).map(Value::one).transpose()?;
            if said != (kind == key).then_some(&text) {
                return Err(format!("`{kind}` is {said:?}, and the step ended so: {outcome:?}"));
            }
        }
        Ok(())
    }

    /// Whether the workcell was told what the clauses say, and nothing else.
    fn commanded(&self, clauses: &[Clause]) -> Result<(), String> {
        let told: Vec<String> =
            self.cell.log.iter().map(|command| self.words.command(command)).collect();
        let said = clause(clauses, "commands").map_or(&[][..], Value::all);
        (said == told)
            .then_some(())
            .ok_or_else(|| format!("commands should be {said:?}, are {told:?}"))
    }

    /// Whether what was recorded is of the kind that the class names.
    fn records_its_class(&self, before: &Picture, after: &Picture) -> Result<(), String> {
        let grown = |stream: &str| after[stream].len() as i64 - before[stream].len() as i64;
        let control = grown("tape control");
        let grown = [grown("tape bits"), grown("tape words"), grown("tape joints"), control];
        let expected = match self.row.class {
            Class::Always => [0, 0, 0, 0],
            Class::AfterForward(RecordKind::Bit) => [1, 0, 0, 0],
            Class::AfterForward(RecordKind::Word) => [0, 1, 0, 0],
            Class::AfterForward(RecordKind::Counter) => [0, 3, 0, 0],
            Class::AfterForward(RecordKind::Joints) => [0, 0, 6, 0],
            Class::AfterForward(RecordKind::Switch) => [0, 0, 0, 3],
            // A frame is as large as its function says, and so are tasks; a never drops what is
            // there.
            Class::AfterForward(RecordKind::Frame | RecordKind::Tasks) | Class::Never(_) => grown,
        };
        let lands_on_join = after["at"][0] != before["at"][0] + 1 && self.row.mnemonic != "join";
        let is_right = grown == expected || lands_on_join && grown == [1, 0, 0, 0];
        is_right.then_some(()).ok_or_else(|| {
            format!(
                "it recorded {grown:?} bits, words, joints and words on turns, and its class says \
                 {expected:?}"
            )
        })
    }
}

fn same(expected: &Picture, found: &Picture) -> Result<(), String> {
    let differences = picture::differences(expected, found);
    if differences.is_empty() { Ok(()) } else { Err(differences.join("\n    ")) }
}

/// Set the workcell up.
fn given(cell: &mut Cell, words: &Words<'_>, clause: &Clause) -> Result<(), String> {
    let text = clause.value.one()?;
    let (what, number) = clause.key.split_once(' ').unwrap_or((&clause.key, "0"));
    let number: u16 = number.parse().map_err(|_| format!("`{number}` is no number"))?;
    let real = || text.parse::<f64>().map_err(|_| format!("`{text}` is no real"));
    match what {
        "joints" => cell.ledger.joints = JointConfiguration(words.joints(text)?),
        "output" => cell.ledger.outputs[usize::from(number)] = text == "high",
        "input" => cell.high.extend((text == "high").then_some(number)),
        "force" => cell.force_n = real()?,
        "draw" => _ = cell.draws.insert(u64::from(number), real()?),
        "in_the_way" => cell.in_the_way = Some(real()?),
        "holds_back" => cell.holds_back = Some(real()?),
        "stopped" | "visit" => {}
        _ => return Err(format!("`{what}` cannot be given")),
    }
    Ok(())
}
