//! x
use arbitrary::Unstructured;
use obverse_testkit::{laws, logged::Logged, programs, reference};
use std::collections::BTreeMap;
fn bytes(seed: u64) -> Vec<u8> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    };
    let length = next() % 8192;
    (0..length).map(|_| next().to_le_bytes()[0]).collect()
}
fn main() {
    let a: u64 = std::env::args().nth(1).unwrap().parse().unwrap();
    let b: u64 = std::env::args().nth(2).unwrap().parse().unwrap();
    let mut endings: BTreeMap<String, u64> = BTreeMap::new();
    let (mut total, mut lines) = (0usize, 0usize);
    for seed in a..b {
        let by = bytes(seed);
        let Ok(src) = programs::generate(&mut Unstructured::new(&by), programs::Options::default())
        else {
            continue;
        };
        lines += src.lines().count();
        for (name, law) in [
            ("f", laws::agrees_forward as fn(&mut Unstructured<'_>) -> arbitrary::Result<()>),
            ("b", laws::agrees_backward),
        ] {
            let r = std::panic::catch_unwind(|| {
                let _ = law(&mut Unstructured::new(&by));
            });
            if r.is_err() {
                println!("FAIL {name} {seed}");
            }
        }
        let p = obverse_syntax::parse(&src);
        let mut cell = Logged::new(seed);
        let o = reference::run(
            &p.program,
            &mut cell,
            reference::Limits { steps: 6000, ..Default::default() },
        );
        total += o.history.len();
        let key = format!("{:?}", o.ending);
        *endings.entry(key.chars().take(40).collect()).or_default() += 1;
        if !o.last.raised.is_empty() {
            *endings.entry("(pending)".into()).or_default() += 1;
        }
    }
    println!("{endings:?} history {total} lines {lines}");
}
