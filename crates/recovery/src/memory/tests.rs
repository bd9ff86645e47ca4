//! What a memory comes to believe, and what of its text is believed.

use super::*;

const COSTS_S: [f64; 6] = [2.0, 4.0, 8.0, 12.0, 20.0, 30.0];

fn choose(memory: &mut Memory, tried: &[usize]) -> Choice {
    let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 300.0, attempts_left: 8 };
    memory.choose("jam", "here", tried, costs)
}

#[test]
fn who_knows_nothing_begins_near_goes_further_and_gives_up_only_at_the_end() {
    let mut memory = Memory::default();
    let mut tried = Vec::new();
    for attempts_left in (1..=12).rev() {
        let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 300.0, attempts_left };
        tried.push(memory.choose("jam", "here", &tried, costs).actions.unwrap());
    }
    assert_eq!(tried[0], 1, "{tried:?}");
    assert_eq!(tried.iter().max(), Some(&COSTS_S.len()), "{tried:?}");
    let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 300.0, attempts_left: 0 };
    assert_eq!(memory.choose("jam", "here", &tried, costs).actions, None);
}

#[test]
fn who_has_given_up_early_has_not_learned_that_it_is_in_vain() {
    let mut memory = Memory::default();
    for _ in 0..100 {
        memory.learn("jam", "here", &[1, 3], false);
    }
    assert!(choose(&mut memory, &[1, 3]).actions.is_some());
}

#[test]
fn where_four_was_always_enough_and_three_never_it_goes_back_four_at_once() {
    let mut memory = Memory::default();
    for _ in 0..30 {
        memory.learn("jam", "here", &[1, 3, 4], true);
    }
    assert_eq!(choose(&mut memory, &[]).actions, Some(4));
    // Elsewhere, and for another error, nothing is known.
    let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 300.0, attempts_left: 8 };
    assert!(memory.choose("jam", "there", &[], costs).actions.unwrap() <= 2);
}

#[test]
fn where_going_back_never_helped_it_gives_up_at_once() {
    let mut memory = Memory::default();
    for _ in 0..50 {
        memory.learn("jam", "here", &[1, 2, 4, 6], false);
    }
    let costs = Costs { by_depth_s: &COSTS_S, give_up_s: 60.0, attempts_left: 8 };
    assert_eq!(memory.choose("jam", "here", &[], costs).actions, None);
}

#[test]
fn half_near_and_half_far_goes_near_first_if_that_is_cheap() {
    let mut memory = Memory::default();
    for _ in 0..40 {
        memory.learn("jam", "here", &[1], true);
        memory.learn("jam", "here", &[1, 2, 4, 5], true);
    }
    let first = choose(&mut memory, &[]);
    assert_eq!(first.actions, Some(1));
    assert!((0.3..0.6).contains(&first.chance), "{}", first.chance);
    assert_eq!(choose(&mut memory, &[1]).actions, Some(5));
}

#[test]
fn a_search_near_goes_on_as_long_as_it_is_worth_it_and_then_what_is_far_is_done_anew() {
    // Half need the third point of a search, half what only four actions back does anew, which
    // two and three are known not to. A near attempt gains 0.083 * 0.67^n a second and a far one
    // 0.042, so that it is two or three near ones and then a far one.
    let mut memory = Memory::default();
    for _ in 0..40 {
        memory.learn("jam", "here", &[1, 1, 1], true);
        memory.learn("jam", "here", &[1, 1, 1, 1, 2, 3, 4], true);
    }
    let mut tried = Vec::new();
    for _ in 0..6 {
        tried.push(choose(&mut memory, &tried).actions.unwrap());
    }
    assert_eq!(tried[..2], [1, 1], "{tried:?}");
    assert!(tried.contains(&4), "{tried:?}");
}

#[test]
fn where_each_attempt_helps_seldom_but_near_ones_as_much_as_far_it_stays_near() {
    // A search that takes its time: one attempt in three helps, however far back.
    let mut memory = Memory::default();
    for round in 0..60 {
        let depths: Vec<usize> = (0..1 + round % 5).map(|index| 1 + index % 3).collect();
        memory.learn("jam", "here", &depths, true);
    }
    let mut tried = Vec::new();
    for _ in 0..6 {
        let choice = choose(&mut memory, &tried);
        tried.push(choice.actions.unwrap());
    }
    assert!(tried.iter().all(|&depth| depth <= 3), "{tried:?}");
}

#[test]
fn a_memory_is_the_same_after_its_text() {
    let mut memory = Memory::default();
    memory.learn("jam", "sequence \"main\": advance insert", &[1, 2], true);
    memory.learn("jam", "sequence \"main\": advance insert", &[1, 2], false);
    memory.learn("empty", "elsewhere", &[40], true);
    assert_eq!(Memory::from_text(&memory.to_text()), Ok(memory));
}

#[test]
fn what_no_run_can_have_learned_is_refused() {
    let text = |incident: &str| {
        format!("version = 1\n[[place]]\nerror = \"jam\"\nat = \"here\"\nincident = [{incident}]\n")
    };
    let what = |incident: &str| Memory::from_text(&text(incident)).unwrap_err().to_string();
    let of = |depths: &str| what(&format!("{{ depths = [{depths}], enough = true, times = 1 }}"));
    assert!(of("").contains("nothing was tried"));
    assert!(of("1, 0").contains("0 actions"));
    assert!(of("99").contains("further"));
    assert!(of("-1").contains("no memory"));
    assert!(of(&"1,".repeat(17)).contains("more attempts"));
    let other = Memory::from_text("version = 7\n").unwrap_err();
    assert_eq!(other, MemoryError::Version { found: 7 });
    let torn = &Memory::from_text(&text("{ depths = [1],")[..60]);
    assert!(matches!(torn, Err(MemoryError::Malformed { .. })));
}

#[test]
fn memories_add_up() {
    let (mut one, mut both) = (Memory::default(), Memory::default());
    let mut other = Memory::default();
    one.learn("jam", "here", &[1], true);
    other.learn("jam", "here", &[1], true);
    other.learn("jam", "there", &[2], false);
    for memory in [&one.clone(), &other] {
        both.merge(memory);
    }
    one.merge(&other);
    assert_eq!(one, both);
    assert_eq!(one.known("jam", "here"), 2);
}
