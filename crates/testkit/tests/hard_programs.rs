//! Programs on which machine and reference interpreter have disagreed, or easily could.

use obverse_testkit::laws::{agrees_backward_on, agrees_forward_on};

fn agree(source: &str) {
    for seed in 0..4 {
        agrees_forward_on(source, seed);
        agrees_backward_on(source, seed);
    }
}

#[test]
fn a_setting_to_the_end_of_a_sequence_outlives_scopes_within() {
    agree("sequence main { speed slow { speed fast { wait 1 ms } speed very slow } wait 2 ms }");
}

#[test]
fn what_is_left_on_the_way_is_put_right() {
    agree(
        "joints there = [1, 2, 3, 4, 5, 6] rad
error e { severity fatal respond after current sequence }
sequence away(n: int) {
  tool probe { loop { speed fast { if n > 2 { break } if n < 0 { return } } n += 1 } throw e }
  speed slow
  move to there
}
sequence main { speed very slow call away(0) move to there call away(-1) move to there }",
    );
}

#[test]
fn an_error_is_done_again_and_given_up_in_every_way() {
    for then in ["return to action", "return to sequence", "restart program", "continue", "stop"] {
        for respond in ["at once", "after current action", "after current sequence"] {
            agree(&format!(
                "var tries = 0
error slip {{ recover using mend respond {respond} then {then} }}
error mend_failed {{ severity fatal respond after current sequence }}
sequence mend {{ tries += 10 if tries > 25 {{ throw mend_failed }} tries += 100 }}
advanced move push {{ distance 30 mm x stop if force > 5 N
  on failure {{ repeat with perturbation 1 times return to initial position throw slip }} }}
action work(n: int) {{ n += 1 advance push tries += n if tries mod 2 == 1 {{ throw slip }} }}
sequence main {{ speed fast call work(tries) call work(2) wait 1 ms }}"
            ));
        }
    }
}

#[test]
fn draws_are_taken_from_left_to_right_before_a_statement_that_may_trap() {
    agree(
        "var x = 0.0 var z = 0
sequence main {
  x = random(0, 1) - random(x + 1, 2) * random(3, 4)
  for i from int(random(0, 2)) to int(random(2, 4)) { z += i }
  z = 0
  x = random(0, 1) + real(1 / z) + random(0, 1)
}",
    );
}
