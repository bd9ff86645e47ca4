//! Generated programs: whatever compiles keeps the rules of the verifier, and nothing panics.

use crate::common::listing;
use obverse_bytecode::verify;
use obverse_compiler::compile;

/// A small generator of numbers, so that a program follows from its seed.
struct Random(u64);

impl Random {
    fn next(&mut self, below: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % below
    }

    fn pick<'w>(&mut self, words: &[&'w str]) -> &'w str {
        words[self.next(words.len())]
    }
}

const DECLARATIONS: &str = "
joints a = [0, -90, 90, -90, -90, 0] deg
joints b = [9, -90, 90, -90, -90, 0] deg
item peg { keyframe grasp = [0, 0, 20] mm keyframe above = [0, 0, 90] mm }
io open { set 0 low sleep 1 s } reverse close
io close { set 0 high sleep 1 s } reverse open
var n = 3
var gap = 2 mm
sequence fix { move to a if holding { throw late } throw act }
sequence simple { wait 1 s }
error warn { severity warning }
error fatal_one { severity fatal }
error act { recover using fix then return to action }
error next { recover using simple then continue }
error seq { recover by reversing escalating up to 3 actions otherwise using simple }
error prog { recover using simple then restart program }
error late { recover using simple respond after current sequence }
error plain { }
advanced move go {
  distance random(1 mm, 9 mm) forward stop if force > 2 N speed slow requires not holding
  on success { return to initial position throw warn }
  on failure { repeat with perturbation random(1 mm, 2 mm) 2 times throw act }
}
advanced move push { distance gap x in base on failure { throw seq } on success { throw late } }
";

/// Statements with what they need around them, to a depth.
struct Writer {
    random: Random,
    text: String,
    names: usize,
    in_loop: bool,
    in_block: bool,
    callable: Vec<String>,
}

impl Writer {
    fn int(&mut self, depth: usize) -> String {
        match self.random.next(if depth == 0 { 4 } else { 9 }) {
            0 => self.random.next(9).to_string(),
            1 => "n".to_owned(),
            2 => "x".to_owned(),
            3 => "y".to_owned(),
            4 => "40000 * x".to_owned(),
            5 => format!("int(random(0, {}.0))", 1 + self.random.next(5)),
            _ => {
                let operator = self.random.pick(&["+", "-", "*", "mod 7 +", "/ 3 -"]);
                let (left, right) = (self.int(depth - 1), self.int(depth - 1));
                format!("({left} {operator} {right})")
            }
        }
    }

    fn length(&mut self) -> String {
        self.random
            .pick(&["3 mm", "gap", "distance", "random(gap, 9 mm)", "gap * 2 + 1 um", "z"])
            .to_owned()
    }

    fn condition(&mut self, depth: usize) -> String {
        let operator = self.random.pick(&["<", "<=", ">", ">=", "==", "!="]);
        match self.random.next(if depth == 0 { 5 } else { 8 }) {
            0 => "holding".to_owned(),
            1 => "input 4".to_owned(),
            2 => [self.length(), self.length()].join(&format!(" {operator} ")),
            3 | 4 => [self.int(1), self.int(1)].join(&format!(" {operator} ")),
            5 => format!("not ({})", self.condition(depth - 1)),
            _ => {
                let word = self.random.pick(&["and", "or", "==", "!="]);
                let (left, right) = (self.condition(depth - 1), self.condition(depth - 1));
                format!("({left}) {word} ({right})")
            }
        }
    }

    fn block(&mut self, depth: usize) {
        self.text.push_str("{\n");
        for _ in 0..self.random.next(4) {
            self.statement(depth);
        }
        self.text.push_str("}\n");
    }

    fn reversed(&mut self, depth: usize) {
        let (in_loop, in_block) = (self.in_loop, self.in_block);
        (self.in_loop, self.in_block) = (false, true);
        self.block(depth);
        (self.in_loop, self.in_block) = (in_loop, in_block);
    }

    /// A branch that may do anything, beside one with an output and an error of its own.
    fn fork(&mut self, depth: usize) {
        self.names += 1;
        let output = 10 + self.names;
        let other = format!("{{ toggle {output} wait 1 s if input {output} {{ throw prog }} }}");
        let is_first = self.random.next(2) == 0;
        self.write("fork");
        if is_first {
            self.write(&other);
            self.write("and");
        }
        let (in_loop, in_block) = (self.in_loop, self.in_block);
        (self.in_loop, self.in_block) = (false, true);
        self.write("{ wait 1 s speed slow");
        self.block(depth);
        self.write("}");
        (self.in_loop, self.in_block) = (in_loop, in_block);
        if !is_first {
            self.write("and");
            self.write(&other);
        }
    }

    fn write(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }

    fn statement(&mut self, depth: usize) {
        match self.random.next(if depth == 0 { 11 } else { 26 }) {
            0 => self.motion(),
            1 => {
                let text = self.random.pick(&["io open", "advance go", "advance push", "wait 1 s"]);
                self.write(text);
            }
            2 | 3 => {
                let target = self.random.pick(&["x", "y", "n"]);
                let operator = self.random.pick(&["=", "+=", "-="]);
                let text = format!("{target} {operator} {}", self.int(2));
                self.write(&text);
            }
            4 => {
                let operator = self.random.pick(&["=", "+=", "-="]);
                let text = format!("gap {operator} {}", self.length());
                self.write(&text);
            }
            5 => {
                let error = self.random.pick(&[
                    "warn",
                    "fatal_one",
                    "act",
                    "next",
                    "seq",
                    "prog",
                    "late",
                    "plain",
                ]);
                let text = format!("if {} {{ throw {error} }}", self.condition(0));
                self.write(&text);
            }
            6 => self.leave(),
            7 => self.call(),
            8 => self.write("set 3 high sleep 1 s sleep 2 s"),
            9 => {
                let text = self.random.pick(&["speed fast", "tool gripper", "checkpoint here"]);
                self.write(text);
            }
            10 => {
                self.names += 1;
                let text = format!("position p{0} move 3 mm up move to p{0}", self.names);
                self.write(&text);
            }
            11..=13 => self.branch(depth - 1),
            14..=18 => self.any_loop(depth - 1),
            19 => {
                let text = self.random.pick(&[
                    "speed slow",
                    "tool hand",
                    "with speed slow, straight moves in reverse",
                    "with force limit 3 N in reverse",
                ]);
                self.write(text);
                self.block(depth - 1);
            }
            20 if !self.in_block => {
                self.write("irreversible \"glue\"");
                self.block(depth - 1);
            }
            21 => {
                self.write("skip in reverse");
                self.reversed(depth - 1);
            }
            22 => {
                self.write("do");
                self.reversed(depth - 1);
                self.write("in reverse { move to a var k = n if k > 3 { return } }");
            }
            23 => {
                self.write("keep in reverse { n += 1 move to b io open speed fast }");
            }
            24 | 25 => self.fork(depth - 1),
            _ => {
                self.write("wait until input 3 high for up to 2 s else");
                self.block(depth - 1);
            }
        }
    }

    fn motion(&mut self) {
        let text = match self.random.next(4) {
            0 => "move to a move to b reversible always".to_owned(),
            1 => "move to peg.grasp linearly".to_owned(),
            2 => format!("move ({}) up in base", self.length()),
            _ => "move to b linearly".to_owned(),
        };
        self.write(&text);
    }

    fn leave(&mut self) {
        let is_break = self.random.next(2) == 0;
        match is_break {
            true if self.in_loop => self.write("break"),
            false if !self.in_block => self.write("return"),
            _ => {}
        }
    }

    fn call(&mut self) {
        if !self.callable.is_empty() {
            let index = self.random.next(self.callable.len());
            let text = format!("call {}", self.callable[index]);
            self.write(&text);
        }
    }

    fn branch(&mut self, depth: usize) {
        let condition = self.condition(2);
        self.write(&format!("if {condition}"));
        self.block(depth);
        if self.random.next(2) == 0 {
            self.write("else");
            self.block(depth);
        }
        if self.random.next(4) == 0 {
            self.write("ending when x == y");
        }
    }

    fn any_loop(&mut self, depth: usize) {
        self.names += 1;
        let header = match self.random.next(5) {
            0 => format!("while {}", self.condition(1)),
            1 => format!("while {} entered when x == n", self.condition(1)),
            2 => format!("repeat {} times", self.int(1)),
            3 => format!("for i{} from 1 + {} to {}", { self.names }, self.int(1), self.int(1)),
            _ => "loop".to_owned(),
        };
        self.write(&header);
        let in_loop = std::mem::replace(&mut self.in_loop, true);
        self.block(depth);
        self.in_loop = in_loop;
    }
}

fn program(seed: u64) -> String {
    let mut writer = Writer {
        random: Random(seed),
        text: DECLARATIONS.to_owned(),
        names: 0,
        in_loop: false,
        in_block: false,
        callable: Vec::new(),
    };
    for name in ["s1", "s2", "main"] {
        writer.write(&format!("sequence {name} {{ var x = 1 var y = n var z = gap"));
        for _ in 0..1 + writer.random.next(6) {
            writer.statement(3);
        }
        writer.write("}");
        writer.callable.push(name.to_owned());
    }
    writer.text
}

#[test]
fn what_compiles_keeps_the_rules() {
    let mut compiled_count = 0;
    for seed in 0..1500 {
        let source = program(seed);
        let Some(module) = compile("test.obv", &source).module else { continue };
        compiled_count += 1;
        if let Err(errors) = verify(module.clone()) {
            panic!("seed {seed}: {errors:#?}\n{source}\n{}", listing(&module));
        }
    }
    assert!(compiled_count > 750, "only {compiled_count} of 1500 programs had no mistake");
}

#[test]
fn a_program_cut_or_jumbled_does_no_harm() {
    for seed in 0..400 {
        let source = program(seed);
        let mut random = Random(seed);
        let mut words: Vec<&str> = source.split_whitespace().collect();
        for _ in 0..1 + random.next(6) {
            let (from, to) = (random.next(words.len()), random.next(words.len()));
            words.swap(from, to);
        }
        let jumbled = words.join(" ");
        let cut = random.next(jumbled.len());
        for text in [jumbled.as_str(), &jumbled[..cut]] {
            if let Some(module) = compile("test.obv", text).module {
                verify(module).expect("what compiles keeps the rules");
            }
        }
    }
}
