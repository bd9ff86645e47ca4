//! Random programs of which most have an inverse: a sequence `work` that begins where its head
//! says, with all that inversion knows of. Now and then something has none.
//!
//! The text follows from an [`Unstructured`], as that of `programs`. Names are unique, every run
//! ends, and nothing traps.

use arbitrary::{Result, Unstructured};

/// A program, and the head of its sequence `work`.
pub struct Invertible {
    /// The text without a main sequence.
    pub source: String,
    /// The statements that bring the workcell where `work` begins.
    pub head: String,
}

/// How deep blocks are in one another.
const DEPTH: usize = 4;

const JOINTS: [&str; 4] = ["q0", "q1", "q2", "q3"];
const PLACES: [&str; 6] = ["q0", "q1", "q2", "q3", "part.grasp", "rack.above"];
/// Each heading beside the one that leads back.
const HEADINGS: [[&str; 2]; 6] = [
    ["forward", "backward"],
    ["left", "right"],
    ["up", "down"],
    ["x", "-x"],
    ["-y", "y"],
    ["-z", "z"],
];

const DECLARATIONS: &str = "\
joints q0 = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6] rad
joints q1 = [1, 2, 3, 4, 5, 6] deg
joints q2 = [-1, 0.25, 1.5, -0.5, 0, 2] rad
joints q3 = [90, -90, 45, -45, 0, 10] deg
item part { keyframe grasp = [1, 2, 3] mm; keyframe above = [1, 2, 30] mm }
item rack { keyframe above = [40, 50, 60] mm [0, 90, 0] deg }
io open { set 0 low; sleep 0.1 s } reverse close
io close { set 0 high; sleep 0.2 s } reverse open
io lamp_on { set 1 high; sleep 20 ms }
io lamp_off { set 1 low; sleep 20 ms }
io signal { sleep 10 ms; set 2 high; set 3 low; sleep 5 ms; toggle 4 }
var fixed = 3
var is_fast = true
var count = 0
var sum = 100
var mode = 1
var gap = 5 mm
var width = 0.1 mm
action pick(item_1: item, times: int) {
  move to item_1.above
  speed slow { move to q3 linearly }
  io close
  count += times
  move to item_1.above linearly
}
action nudge(by: length) {
  move by up in base
  sum -= 2 * count
  move by down in base
}
action shift { move 3 mm x in base }
action counted { repeat count times { toggle 5 } }
";

/// A random program.
///
/// # Errors
/// Only those of the randomness.
pub fn generate(u: &mut Unstructured<'_>) -> Result<Invertible> {
    let writer = Writer {
        u,
        text: String::new(),
        depth: 1,
        names: 0,
        here: String::new(),
        counters: Vec::new(),
        budget: 40,
    };
    writer.work()
}

struct Writer<'g, 'u> {
    u: &'g mut Unstructured<'u>,
    text: String,
    depth: usize,
    names: usize,
    /// The place where the arm is.
    here: String,
    /// The counters of the loops around.
    counters: Vec<String>,
    budget: usize,
}

impl Writer<'_, '_> {
    fn work(mut self) -> Result<Invertible> {
        if self.one_in(3)? {
            self.line("speed fast");
        }
        self.line("set 2 low");
        self.line("set 3 high; sleep 10 ms");
        self.line("io lamp_off");
        self.line("mode = 1");
        self.line("gap = 5 mm");
        let first = self.choose(&PLACES)?;
        let linearly = self.choose(&["", " linearly"])?;
        self.line(&format!("move to {first}{linearly}"));
        first.clone_into(&mut self.here);
        let head = self.text.clone();
        self.statements(12)?;
        let source = format!("{DECLARATIONS}sequence work {{\n{}}}\n", self.text);
        Ok(Invertible { source, head })
    }

    fn below(&mut self, bound: usize) -> Result<usize> {
        self.u.int_in_range(0..=bound.max(1) - 1)
    }

    fn one_in(&mut self, times: usize) -> Result<bool> {
        Ok(self.below(times)? == times - 1)
    }

    fn choose<T: Clone>(&mut self, choices: &[T]) -> Result<T> {
        Ok(self.u.choose(choices)?.clone())
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(&"  ".repeat(self.depth));
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn name(&mut self, kind: &str) -> String {
        self.names += 1;
        format!("{kind}{}", self.names)
    }

    fn statements(&mut self, most: usize) -> Result<()> {
        for _ in 0..=self.below(most)? {
            if self.budget > 0 {
                self.budget -= 1;
                self.statement()?;
            }
        }
        Ok(())
    }

    /// Statements that end where they begin.
    fn excursion(&mut self) -> Result<()> {
        let here = self.here.clone();
        self.statements(3)?;
        if self.here != here {
            self.line(&format!("move to {here}"));
            self.here = here;
        }
        Ok(())
    }

    fn statement(&mut self) -> Result<()> {
        match self.below(20)? {
            0..=2 => self.motion()?,
            3 => self.there_and_back()?,
            4 | 5 => self.output()?,
            6..=8 => self.update()?,
            9 => {
                let value = self.below(9)?;
                if self.depth == 1 {
                    let line = self.choose(&["mode = {}", "gap = 0.{} mm"])?;
                    self.line(&line.replace("{}", &value.to_string()));
                }
            }
            10 => {
                let time = self.choose(&["wait 5 ms", "sleep 5 ms", "checkpoint mark"])?;
                self.line(time);
            }
            11 | 12 => self.call()?,
            13 => self.reversed()?,
            14 => self.stubborn()?,
            _ if self.depth <= DEPTH => self.control()?,
            _ => self.update()?,
        }
        Ok(())
    }

    fn motion(&mut self) -> Result<()> {
        let place = self.choose(&PLACES)?;
        let linearly = self.choose(&["", " linearly"])?;
        self.line(&format!("move to {place}{linearly}"));
        place.clone_into(&mut self.here);
        Ok(())
    }

    fn there_and_back(&mut self) -> Result<()> {
        let [there, back] = self.choose(&HEADINGS)?;
        let distance = self.choose(&["2 mm", "(gap + 1 mm)", "gap"])?;
        let frame = self.choose(&["", " in tcp", " in base", " in toolmount"])?;
        self.line(&format!("move {distance} {there}{frame}"));
        self.output()?;
        self.line(&format!("move {distance} {back}{frame}"));
        Ok(())
    }

    fn output(&mut self) -> Result<()> {
        let line = self.choose(&[
            "set 2 high",
            "set 2 low; sleep 5 ms; sleep 1 ms",
            "toggle 3",
            "toggle 5; sleep 2 ms",
            "io lamp_on",
            "io lamp_off",
            "io open",
            "io close",
            "io signal",
        ])?;
        self.line(line);
        Ok(())
    }

    fn update(&mut self) -> Result<()> {
        let name = self.choose(&["count", "sum"])?;
        let operator = self.choose(&["+=", "-="])?;
        // A real comes back rounded, so that this has no inverse.
        if self.one_in(80)? {
            let value = self.choose(&["0.3 mm", "2.3 mm", "1.1 mm * real(fixed)"])?;
            self.line(&format!("width {operator} {value}"));
            return Ok(());
        }
        let value = match self.counters.last().cloned() {
            Some(counter) if self.one_in(2)? => format!("{counter} * 2 + fixed"),
            _ if name == "sum" => self.choose(&["1", "count", "-count * 3"])?.to_owned(),
            _ => self.choose(&["1", "fixed - 5", "2"])?.to_owned(),
        };
        self.line(&format!("{name} {operator} {value}"));
        Ok(())
    }

    fn call(&mut self) -> Result<()> {
        match self.below(3)? {
            0 => {
                self.line("call nudge(2 mm)");
            }
            1 => self.line("call nudge(gap * 2)"),
            _ => {
                let times = self.choose(&["1", "fixed", "sum"])?;
                self.line(&format!("call pick(part, {times})"));
                "part.above".clone_into(&mut self.here);
            }
        }
        Ok(())
    }

    /// What has perhaps no inverse, or is no program in normal form.
    fn stubborn(&mut self) -> Result<()> {
        let line = match self.below(14)? {
            0 => "sum = sum * 2",
            1 => "call shift",
            2 => "wait random(1 ms, 2 ms)",
            3 => "if input 3 { sum += 1 }",
            4 => "if count > 2 { count += 1 }",
            5 => "position here_0",
            6 => "move 2 mm up in base",
            7 => "var unused_0 = 3",
            8 => "set 6 high",
            9 => "fork { count += 1; wait 1 ms; count += 1 } and { wait 1 ms; call counted }",
            _ => "checkpoint mark",
        };
        let is_declaration = line.ends_with("here_0") || line.starts_with("var");
        if self.text.contains(line) && is_declaration || self.one_in(2)? {
            return self.update();
        }
        self.line(line);
        Ok(())
    }

    fn open(&mut self, line: &str) {
        self.line(&format!("{line} {{"));
        self.depth += 1;
    }

    fn close(&mut self, rest: &str) {
        self.depth -= 1;
        self.line(&format!("}}{rest}"));
    }

    fn control(&mut self) -> Result<()> {
        match self.below(8)? {
            7 => self.fork(),
            0 => self.branch(""),
            1 => self.branch(" ending when is_fast and fixed == 3"),
            2 => self.while_loop(),
            3 => {
                let times = self.choose(&["2", "fixed", "fixed - 3"])?;
                self.repeated(&format!("repeat {times} times"))
            }
            4 => {
                let counter = self.name("i");
                let ends =
                    self.choose(&["1 to 3", "fixed down to 1", "2 to 1", "-1 down to -2"])?;
                self.counters.push(counter.clone());
                self.repeated(&format!("for {counter} from {ends}"))?;
                self.counters.pop();
                Ok(())
            }
            _ => self.scope(),
        }
    }

    fn branch(&mut self, assertion: &str) -> Result<()> {
        let condition = match assertion {
            "" => self.choose(&[
                "is_fast",
                "fixed > 5",
                "not is_fast or fixed == 3",
                "gap <= 5 mm",
                "gap > 0.3 mm",
                "width <= 0.1 mm",
            ])?,
            _ => "is_fast and fixed == 3",
        };
        self.open(&format!("if {condition}"));
        self.excursion()?;
        if self.one_in(2)? {
            self.close(" else {");
            self.depth += 1;
            self.excursion()?;
        }
        self.close(assertion);
        Ok(())
    }

    /// Branches that share no device and no variable: one has the arm.
    fn fork(&mut self) -> Result<()> {
        self.open("fork");
        for _ in 0..=self.below(2)? {
            match self.one_in(4)? {
                true => self.line("call nudge(2 mm)"),
                false => self.motion()?,
            }
        }
        self.close(" and {");
        self.depth += 1;
        let (first, second) = (
            self.choose(&["toggle 5; sleep 2 ms", "wait 3 ms", "set 2 high"])?,
            self.choose(&["repeat fixed times { toggle 3 }", "io lamp_on", "checkpoint mark"])?,
        );
        self.line(first);
        self.line(second);
        if self.one_in(2)? {
            self.close(" and {");
            self.depth += 1;
            self.line("count += 1");
            let between = self.choose(&["wait 2 ms", "toggle 6"])?;
            self.line(between);
            self.line("count -= fixed * 2");
        }
        self.close("");
        Ok(())
    }

    fn repeated(&mut self, head: &str) -> Result<()> {
        self.open(head);
        self.excursion()?;
        self.close("");
        Ok(())
    }

    fn while_loop(&mut self) -> Result<()> {
        let counter = self.name("k");
        let (first, rounds) = (self.below(3)?, self.below(3)?);
        self.line(&format!("var {counter} = {first}"));
        let last = first + rounds;
        self.open(&format!("while {counter} != {last} entered when {counter} == {first}"));
        self.counters.push(counter.clone());
        self.excursion()?;
        self.counters.pop();
        self.line(&format!("{counter} += 1"));
        self.close("");
        Ok(())
    }

    fn scope(&mut self) -> Result<()> {
        let setting = self.choose(&["speed slow", "speed very fast", "tool probe"])?;
        // With another tool a keyframe is another place.
        if setting == "tool probe" {
            let there = self.choose(&JOINTS)?;
            self.line(&format!("move to {there}"));
            there.clone_into(&mut self.here);
        }
        self.open(setting);
        self.statements(3)?;
        let there = self.choose(&JOINTS)?;
        self.line(&format!("move to {there}"));
        there.clone_into(&mut self.here);
        self.close("");
        Ok(())
    }

    fn reversed(&mut self) -> Result<()> {
        if self.one_in(2)? {
            self.open("skip in reverse");
            self.line("repeat 3 times { toggle 6; sleep 1 ms }");
            self.output()?;
            return {
                self.close("");
                Ok(())
            };
        }
        self.open("do");
        self.line("set 6 high");
        self.line("wait 3 ms");
        let there = self.choose(&JOINTS)?;
        let moves = self.one_in(2)?;
        if moves {
            self.line(&format!("move to {there}"));
        }
        self.close(" in reverse {");
        self.depth += 1;
        self.line("set 7 high");
        self.line("toggle 6");
        if moves {
            self.line(&format!("move to {}", self.here));
            there.clone_into(&mut self.here);
        }
        self.close("");
        Ok(())
    }
}
