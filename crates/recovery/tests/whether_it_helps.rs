//! Whether going back helps is asked first: learned from a kind of error that nothing helps, the
//! policy gives up at once, and from one that is helped half the time it does not.

use obverse_recovery::memory::{Costs, Memory};

/// What an attempt costs by depth, in seconds, and a person.
const CHEAP_S: [f64; 6] = [2.0, 4.0, 8.0, 12.0, 20.0, 30.0];
const DEAR_S: [f64; 4] = [10.0, 25.0, 40.0, 80.0];
const LONG_S: [f64; 12] = [3.0, 4.0, 5.0, 8.0, 9.0, 14.0, 20.0, 22.0, 30.0, 31.0, 40.0, 60.0];

/// Uniform in [0, 1), by number.
fn unit(number: u64) -> f64 {
    let mut x = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x >> 11) as f64 / (1_u64 << 53) as f64
}

/// A kind of error and what is paid for it.
struct Kind<'k> {
    costs_s: &'k [f64],
    person_s: f64,
    attempts: u32,
    /// The chance that an attempt helps, at whatever depth.
    chance: f64,
}

impl Kind<'_> {
    fn next(&self, memory: &mut Memory, tried: &[usize]) -> Option<usize> {
        let attempts_left = self.attempts - tried.len() as u32;
        let (by_depth_s, give_up_s) = (self.costs_s, self.person_s);
        memory.choose("e", "here", tried, Costs { by_depth_s, give_up_s, attempts_left }).actions
    }

    /// How often each of so many incidents was tried.
    fn learn(&self, memory: &mut Memory, incidents: u64) -> Vec<usize> {
        let mut number = 0;
        let one = |_| {
            let (mut tried, mut is_enough) = (Vec::new(), false);
            while !is_enough && let Some(actions) = self.next(memory, &tried) {
                tried.push(actions);
                number += 1;
                is_enough = unit(number) < self.chance;
            }
            memory.learn("e", "here", &tried, is_enough);
            tried.len()
        };
        (0..incidents).map(one).collect()
    }
}

#[test]
fn what_never_helps_is_given_up_at_once_after_sixty_incidents() {
    for costs_s in [&CHEAP_S[..], &DEAR_S, &LONG_S] {
        for attempts in [3, 8] {
            let kind = Kind { costs_s, person_s: 300.0, attempts, chance: 0.0 };
            let mut memory = Memory::default();
            let tried = kind.learn(&mut memory, 60);
            assert_eq!(kind.next(&mut memory, &[]), None, "{costs_s:?}, {attempts}: {tried:?}");
        }
    }
}

#[test]
fn what_helps_half_the_time_is_never_given_up_at_once() {
    for costs_s in [&CHEAP_S[..], &DEAR_S, &LONG_S] {
        let kind = Kind { costs_s, person_s: 300.0, attempts: 8, chance: 0.5 };
        let mut memory = Memory::default();
        let tried = kind.learn(&mut memory, 60);
        assert!(tried.iter().all(|attempts| *attempts > 0), "{costs_s:?}: {tried:?}");
        assert!(kind.next(&mut memory, &[]).is_some());
    }
}
