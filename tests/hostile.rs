//! Whatever comes from outside, nothing panics and nothing takes long: random bytes, and valid
//! modules, recordings, assembly, sources and workcell files with random alterations.
//! `HOSTILE_RUNS` sets how many of each; a failure prints the number of the input, and
//! `HOSTILE_SEED` runs that one alone.

use arbitrary::Unstructured;
use obverse_bytecode::codec::HEADER_BYTES;
use obverse_bytecode::{Verified, disassemble, encode, verify};
use obverse_debugger::{Taped, Writer, taped};
use obverse_recovery::Driven;
use obverse_tape::{Note, Noted};
use obverse_testkit::code::{self, Options};
use obverse_testkit::{Ledger, altered, hostile, programs};
use obverse_vm::{Direction, Machine};
use std::path::Path;

/// How many inputs each door sees.
const RUNS: u64 = 3_000;

/// Random numbers that follow from a seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ x >> 31
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound.max(1) as u64) as usize
    }

    fn bytes(&mut self, length: usize) -> Vec<u8> {
        (0..length).map(|_| self.next() as u8).collect()
    }

    /// A few bytes overwritten, removed, repeated.
    fn altered(&mut self, valid: &[u8]) -> Vec<u8> {
        let mut bytes = valid.to_vec();
        for _ in 0..=self.below(3) {
            if bytes.is_empty() {
                break;
            }
            let at = self.below(bytes.len());
            let end = (at + 1 + self.below(12)).min(bytes.len());
            match self.below(6) {
                0 => drop(bytes.drain(at..end)),
                1 => bytes.extend_from_within(at..end),
                2 => bytes[at..end].fill(0xff),
                3 => bytes.truncate(at.max(1)),
                4 => bytes[at] ^= 1 << self.below(8),
                _ => bytes[at] = self.next() as u8,
            }
        }
        bytes
    }

    /// A word of a text by another one of it.
    fn reworded(&mut self, text: &str) -> Vec<u8> {
        let mut words: Vec<&str> = text.split_inclusive([' ', '\n']).collect();
        for _ in 0..=self.below(3) {
            let (at, other) = (self.below(words.len()), self.below(words.len()));
            match self.below(4) {
                0 => drop(words.remove(at)),
                1 => words.insert(at, words[other]),
                2 => words.swap(at, other),
                _ => words[at] = words[other],
            }
            if words.is_empty() {
                words.push(text);
            }
        }
        words.concat().into_bytes()
    }
}

/// Give a door many inputs; at least so many of a hundred must come in.
fn withstands(door: fn(&[u8]) -> bool, least: u64, mut input: impl FnMut(&mut Random) -> Vec<u8>) {
    let number = |variable: &str| std::env::var(variable).ok().and_then(|text| text.parse().ok());
    let alone: Option<u64> = number("HOSTILE_SEED");
    let runs = number("HOSTILE_RUNS").unwrap_or(RUNS);
    let mut came_in = 0;
    for seed in alone.map_or(0..runs, |seed| seed..seed + 1) {
        let bytes = input(&mut Random(seed));
        let held = std::panic::catch_unwind(|| door(&bytes));
        assert!(held.is_ok(), "it panics: HOSTILE_SEED={seed}");
        came_in += u64::from(held.unwrap_or(false));
    }
    let enough = alone.is_some() || came_in * 100 >= least * runs;
    assert!(enough, "only {came_in} of {runs} came in");
}

/// The texts of a folder's files, by extension.
fn texts(folder: &str, extension: &str) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = std::fs::read_dir(folder).expect("a folder of the project");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    let wanted = paths.iter().filter(|path| path.extension().is_some_and(|it| it == extension));
    wanted.map(|path| std::fs::read_to_string(path).expect("a text")).collect()
}

fn module(random: &mut Random) -> obverse_bytecode::Module {
    let bytes = random.bytes(900);
    let options = Options { never: true, blocks: true };
    code::module(&mut Unstructured::new(&bytes), options).expect("a module")
}

#[test]
fn random_bytes_at_every_door() {
    let doors = [
        hostile::module_bytes,
        hostile::tape_bytes,
        hostile::assembly,
        hostile::source,
        hostile::workcell,
    ];
    for door in doors {
        withstands(door, 0, |random| {
            let length = random.below(400);
            random.bytes(length)
        });
    }
}

#[test]
fn modules_with_altered_bytes() {
    withstands(hostile::module_bytes, 1, |random| {
        let bytes = encode(&module(random)).expect("its bytes");
        // Without the header: it is sealed again, so that the alteration reaches what it says.
        random.altered(&bytes[HEADER_BYTES..])
    });
}

#[test]
fn modules_with_altered_parts() {
    withstands(hostile::altered_module, 10, |random| random.bytes(900));
}

#[test]
fn tapes_with_altered_bytes() {
    withstands(hostile::tape_bytes, 5, |random| {
        let program = verify(module(random)).expect("it verifies");
        let bytes = taped(&program, random.next());
        // Its parts without their headers: they are sealed again.
        let mut parts: Vec<&[u8]> = Vec::new();
        let mut rest = &bytes[..];
        while let Some((header, after)) = rest.split_at_checked(HEADER_BYTES) {
            let length = u64::from_le_bytes(header[20..28].try_into().expect("eight bytes"));
            let (part, after) = after.split_at(length as usize);
            parts.push(part);
            rest = after;
        }
        let chosen = random.below(parts.len());
        let altered = random.altered(parts[chosen]);
        parts[chosen] = &altered;
        let behind_its_length = |part: &&[u8]| [&(part.len() as u16).to_le_bytes(), *part].concat();
        parts.iter().flat_map(behind_its_length).collect()
    });
}

/// The tape file of a run, a little there and back.
fn taped(program: &Verified, seed: u64) -> Vec<u8> {
    let mut cell = Ledger::new(seed);
    let mut machine = Machine::new(program, &cell).expect("it links");
    let names = ("m.obv".to_owned(), None);
    let head = taped::head(program.module(), &cell, names, seed).expect("it is no larger");
    let mut file = Vec::new();
    let mut taped = Taped::new(&mut machine, &mut cell, Writer::begin(&mut file, head));
    for (direction, most) in [(Direction::Forward, 200), (Direction::Reverse, 50)] {
        taped.run(direction, most, &mut ());
    }
    let what = Noted::Back { actions: 2, to: 1 };
    taped.note(Note { steps: 1, time_s: 0.5, error: 0, pc: 1, attempts: 1, what });
    taped.end("stopped").expect("memory can be written");
    file
}

#[test]
fn recordings_with_altered_parts() {
    withstands(hostile::altered_recording, 20, |random| random.bytes(900));
}

#[test]
fn assembly_with_altered_words() {
    withstands(hostile::assembly, 5, |random| {
        let text = disassemble(&module(random));
        if random.below(2) == 0 { random.reworded(&text) } else { random.altered(text.as_bytes()) }
    });
}

#[test]
fn sources_with_altered_words() {
    let shown = texts("programs", "obv");
    withstands(hostile::source, 5, |random| {
        let bytes = random.bytes(700);
        let made = programs::generate(&mut Unstructured::new(&bytes), programs::Options::default());
        let made = made.expect("a program");
        let text = if random.below(3) == 0 { &made } else { &shown[random.below(shown.len())] };
        if random.below(2) == 0 { random.reworded(text) } else { random.altered(text.as_bytes()) }
    });
}

#[test]
fn workcells_with_altered_words() {
    let mut cells = texts("programs", "toml");
    cells.extend(texts("crates/sim/tests", "toml"));
    withstands(hostile::workcell, 5, |random| {
        let text = &cells[random.below(cells.len())];
        if random.below(2) == 0 { random.reworded(text) } else { random.altered(text.as_bytes()) }
    });
}

/// An alteration that alters nothing would show nothing.
#[test]
fn alterations_alter() {
    let altered = (0..100).filter(|&seed| {
        let bytes = Random(seed).bytes(900);
        let module = altered::module(&mut Unstructured::new(&bytes)).ok();
        module.is_some_and(|module| verify(module).is_err())
    });
    assert!(altered.count() >= 20);
}
