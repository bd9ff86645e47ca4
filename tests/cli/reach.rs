//! `obverse reach`, beyond what is drawn: statements of one line, and the chain of reasons.

use crate::support::Bench;

const ONE_LINE: &str = r#"
sequence a { toggle 1 barrier "x" toggle 2 }
sequence main { call a }
"#;

#[test]
fn reach_tells_statements_of_one_line_apart() {
    let bench = Bench::new("reach_one_line");
    bench.write("line.obv", ONE_LINE);
    let drawn = bench.ends(0, &["reach", "line.obv"]).stdout;
    assert!(drawn.starts_with("2  A,B╶ ✗ sequence a {"), "{drawn}");
    assert!(drawn.contains("A  2-3    the start\nB  2      just after line 2: x\n"), "{drawn}");
    let ran = bench.ends(0, &["reach", "--json", "--at", "2", "line.obv"]);
    let found: Vec<_> =
        ran.json().iter().filter(|one| one["type"] == "statement").cloned().collect();
    let of = |key: &str| found.iter().map(|one| one[key].clone()).collect::<Vec<_>>();
    assert_eq!(of("statement"), ["toggle 1", "barrier \"x\"", "toggle 2"]);
    assert_eq!(of("column"), [14, 23, 35]);
    assert_eq!(of("stretch"), ["A", "A", "B"]);
    assert_eq!(of("class"), ["always", "never", "always"]);
    let told = |at: &str| bench.ends(0, &["reach", "--at", at, "line.obv"]).stdout;
    assert_eq!(told("2").matches("goes back to").count(), 3);
    assert!(
        told("2:36").starts_with("line 2 `toggle 2`, in sequence a: always\n\ngoes back to just")
    );
    assert!(told("2:1").starts_with("line 2 `toggle 1`"));
    bench.ends(2, &["reach", "--at", "2:x", "line.obv"]);
}

const ROUNDS: &str = r#"
error anew { recover using fix; then restart program }
error again { recover using fix; then return to sequence }
sequence fix { barrier "fixed" }
sequence work { if input 1 { throw again } }
sequence main {
  toggle 0
  repeat 3 times { toggle 1 barrier "round" }
  call work
  if input 2 { throw anew }
}
"#;

#[test]
fn reach_says_what_has_begun_again() {
    let bench = Bench::new("reach_rounds");
    bench.write("rounds.obv", ROUNDS);
    let told = |at: &str| bench.ends(0, &["reach", "--at", at, "rounds.obv"]).stdout;
    let program = "back into the round before: the program has begun again\n";
    assert!(told("7").contains(program), "{}", told("7"));
    let round = "back into the round before: line 8 `repeat 3`\n  to line 8 `barrier";
    assert!(told("8:20").contains(round), "{}", told("8:20"));
    let sequence = "back into the round before: sequence work has begun again\n";
    assert!(told("5:17").contains(sequence), "{}", told("5:17"));
}
