//! Campaigns in which a stop holds the arm: what brought a person is in a table, whether the
//! program names an error for it or not, and what a person released was not recovered without one.

use crate::support::Bench;
use serde_json::Value;

const CELL: &str = "
[arm]
home_rad = [0.3, -1.3, 1.6, -1.9, -1.5708, 0.2]
[chance]
protective_stop = 0.1
stops_short = 0.05
";
/// An error that names stops, and none that does.
const NAMED: &str = "error halted { on stopped short, protective stop
  recover by reversing learned up to start of sequence; otherwise operator }";
const UNNAMED: &str = "error halted { on stopped short
  recover by reversing learned up to start of sequence; otherwise operator }";

/// A bench with a program in which stops are an error, `named.obv`, and one in which they are not.
fn bench(test: &str) -> Bench {
    let bench = Bench::new(test);
    bench.write("stops.toml", CELL);
    for (file, error) in [("named.obv", NAMED), ("unnamed.obv", UNNAMED)] {
        let text = format!(
            "cell \"stops.toml\"\n{error}\nsequence main {{\n  move 40 mm up in base\n  move 30 mm \
             down in base\n  move 20 mm up in base\n  move 30 mm down in base\n}}\n"
        );
        bench.write(file, text);
    }
    bench
}

/// The lines of the runs and the strategies of the summary, of a campaign in a bench.
fn campaign(bench: &Bench, program: &str, strategies: &str, more: &[&str]) -> (Vec<Value>, Value) {
    let first = ["trials", program, "--runs", "80", "--learn", "64", "--json", "--strategy"];
    let all = [first.as_slice(), &[strategies], more].concat();
    let ran = bench.ends(0, &all);
    let runs = ran.json().into_iter().filter(|line| line["type"] == "run").collect();
    (runs, ran.summary()["strategies"].clone())
}

fn count(of: &Value) -> u64 {
    of.as_u64().unwrap_or_else(|| panic!("{of} is no number"))
}

/// A fault that a stop holds is an error like any other where the program names it.
#[test]
fn a_stop_that_nobody_releases_is_an_incident_of_the_error_that_names_it() {
    let bench = bench("stops_held");
    let (runs, strategies) = campaign(&bench, "named.obv", "stop,learned", &[]);
    let held: Vec<&Value> = runs.iter().filter(|run| run["why"] == "protective_stop").collect();
    assert!(held.len() > 20, "stops are frequent: {}", held.len());
    for run in held {
        let last = run["incidents"].as_array().and_then(|all| all.last()).expect("an incident");
        assert_eq!((&last["error"], &last["stop"]), (&"halted".into(), &"held".into()), "{run}");
        assert_eq!(last["recovered"], false, "{run}");
    }
    let stop = &strategies[0];
    assert_eq!(stop["in_error"], stop["to_a_person"], "every error brings a person: {stop}");
    assert!(stop["brought_a_person"]["held by a stop: protective_stop"].is_u64(), "{stop}");
}

/// Each assembly that took a person is in one row of what brought one.
#[test]
fn what_brought_a_person_adds_up() {
    let bench = bench("stops_sum");
    for program in ["named.obv", "unnamed.obv"] {
        for release in ["0", "1", "20"] {
            let more = ["--release", release];
            let (runs, strategies) = campaign(&bench, program, "stop,learned,oracle", &more);
            for tally in strategies.as_array().expect("strategies") {
                let rows = tally["brought_a_person"].as_object().expect("rows").values();
                let sum: u64 = rows.map(count).sum();
                assert_eq!(sum, count(&tally["to_a_person"]), "{program} {release}: {tally}");
                let came = runs
                    .iter()
                    .filter(|run| run["strategy"] == tally["strategy"] && run["person_s"] != 0.0);
                assert_eq!(sum, came.count() as u64, "{program} {release}: {tally}");
            }
        }
    }
    let (_, strategies) = campaign(&bench, "unnamed.obv", "stop", &[]);
    let by = &strategies[0]["brought_a_person"];
    assert!(by["ended in a fault: protective_stop"].is_u64(), "no error names it: {by}");
    let table = bench.ends(0, &["trials", "unnamed.obv", "--runs", "80"]).stdout;
    assert!(table.contains("what brought a person"), "{table}");
    assert!(table.contains("ended in a fault: protective_stop"), "{table}");
}

#[test]
fn what_a_person_released_was_not_recovered_without_one() {
    let bench = bench("stops_released");
    let (runs, strategies) = campaign(&bench, "named.obv", "learned", &["--release", "20"]);
    let incidents = runs.iter().flat_map(|run| run["incidents"].as_array().expect("incidents"));
    let (released, others): (Vec<&Value>, Vec<&Value>) =
        incidents.partition(|incident| incident["stop"] == "released");
    assert!(released.len() > 10 && others.len() > 5, "{} {}", released.len(), others.len());
    assert!(released.iter().all(|incident| incident["recovered"] == true), "they were got past");
    let recovered = others.iter().filter(|incident| incident["recovered"] == true).count();
    assert_eq!(count(&strategies[0]["recovered"]), recovered as u64);
    for run in &runs {
        let released = run["incidents"].as_array().expect("incidents").iter();
        let released = released.filter(|incident| incident["stop"] == "released").count() as u64;
        assert_eq!(released > 0, count(&run["releases"]) > 0, "{run}");
        assert!(released <= count(&run["releases"]), "{run}");
    }
}

/// Who knows what chance has in store is not much worse off than who does not, where a person
/// releases the arm.
#[test]
fn the_oracle_sees_past_a_stop() {
    let bench = bench("stops_oracle");
    bench.write("stops.toml", CELL.replace("protective_stop = 0.1", "protective_stop = 0.3"));
    let (runs, _) = campaign(&bench, "named.obv", "learned,oracle", &["--release", "8"]);
    let succeeded = |strategy: &str| {
        let its = runs.iter().filter(|run| run["strategy"] == strategy);
        its.filter(|run| run["ending"] == "succeeded").count()
    };
    let (learned, oracle) = (succeeded("learned"), succeeded("oracle"));
    assert!(oracle + 4 >= learned && oracle > 60, "oracle {oracle}, learned {learned}");
}
