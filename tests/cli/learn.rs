//! Learning by its command: the file that it writes is used by other commands, follows from the
//! seed alone, and what is wrong with one is said.

use crate::support::Bench;

const ACTION: &str = "insert_with_spiral_search";

fn learn<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let first =
        ["learn", "peg_search.obv", ACTION, "--runs", "240", "--candidates", "12", "--out", "best"];
    first.iter().chain(more).copied().collect()
}

#[test]
fn what_is_learned_is_used_and_better_than_the_defaults() {
    let bench = Bench::new("learn");
    let ran = bench.ends(0, &learn(&["--json"]));
    let lines = ran.json();
    assert_eq!(lines.iter().filter(|line| line["type"] == "candidate").count(), 12);
    let evidence = ran.summary()["evidence"].clone();
    let count = |name: &str| evidence[name].as_u64().expect("a count");
    assert!(count("successes") > count("successes_of_defaults"), "{evidence}");
    assert!(count("runs") + count("search_runs") <= 240, "{evidence}");

    let shares = |more: &[&str]| {
        let trials = ["trials", "peg_search.obv", "--strategy", "stop", "--runs", "100", "--json"];
        let arguments: Vec<&str> = trials.iter().chain(more).copied().collect();
        let summary = bench.ends(0, &arguments).summary();
        summary["strategies"][0]["to_a_person"].as_u64().expect("a count")
    };
    let (by_default, learned) = (shares(&[]), shares(&["--parameters", "best"]));
    assert!(learned < by_default, "{learned} and {by_default} to a person");

    bench.ends(0, &["check", "peg_search.obv", "--parameters", "best"]);
    let run = ["run", "peg_search.obv", "--seed", "1"];
    let plain = bench.ends(0, &run);
    let with: Vec<&str> = run.iter().copied().chain(["--parameters", "best"]).collect();
    assert_ne!(bench.run(&with).stdout, plain.stdout, "the parameters change the run");
}

#[test]
fn what_is_learned_depends_on_the_seed_alone() {
    let bench = Bench::new("learn_seed");
    let one = bench.ends(0, &learn(&["--jobs", "1"]));
    let file = bench.read("best");
    let five = bench.ends(0, &learn(&["--jobs", "5"]));
    assert_eq!((one.stdout, file), (five.stdout, bench.read("best")));
}

#[test]
fn a_wrong_parameter_file_is_refused() {
    let bench = Bench::new("learn_files");
    bench.ends(0, &learn(&[]));
    let whole = String::from_utf8(bench.read("best")).expect("text");
    let half = &whole[..whole.len() / 2];
    let digest = |line: &&str| line.starts_with("program_digest = ");
    let digest = whole.lines().find(digest).expect("a digest");
    let other = whole.replace(digest, "program_digest = \"0\"");
    let cases: [(&str, String, &str); 8] = [
        ("torn", half.to_owned(), "not a whole parameter file"),
        ("foreign", "[arm]\nhome_rad = [0, 0, 0, 0, 0, 0]\n".to_owned(), "not a parameter file"),
        ("newer", whole.replace("format_version = 1", "format_version = 9"), "version 9"),
        ("other", other.replace("peg_search.obv", "tower.obv"), "learned for `tower.obv`"),
        ("changed", other.clone(), "before it was changed"),
        ("action", whole.replace(ACTION, "screw"), "has no action `screw`"),
        ("unknown", whole.replace("parameters.pitch", "parameters.tone"), "no parameter `tone`"),
        ("unit", whole.replace("\"mm\"", "\"m\""), "is in `m`"),
    ];
    for (name, text, word) in cases {
        bench.write(name, text);
        bench.refuses(&["run", "peg_search.obv", "--parameters", name], &[name, word]);
    }
    let value = |value: &str| {
        let lines = whole.lines().map(|line| match line.starts_with("value = ") {
            true => format!("value = {value}"),
            false => line.to_owned(),
        });
        lines.collect::<Vec<_>>().join("\n")
    };
    bench.write("far", value("5000.0"));
    bench.refuses(&["run", "peg_search.obv", "--parameters", "far"], &["its range is"]);
    bench.write("none", value("nan"));
    bench.refuses(&["run", "peg_search.obv", "--parameters", "none"], &["not finite"]);
    let twice = ["run", "peg_search.obv", "--parameters", "best", "--parameters", "best"];
    bench.refuses(&twice, &["a second file"]);
    bench.refuses(&["run", "peg_search.obv", "--parameters", "nowhere"], &["nowhere"]);
}

/// By what it does, and not by what its file is called.
#[test]
fn a_parameter_file_belongs_to_a_program() {
    let bench = Bench::new("learn_belongs");
    bench.ends(0, &learn(&[]));
    let source = String::from_utf8(bench.read("peg_search.obv")).expect("text");
    let check = |file: &str, text: &str| {
        bench.write(file, text);
        bench.run(&["check", file, "--parameters", "best"])
    };
    let renamed = check("renamed.obv", &source);
    assert_eq!(renamed.code, 0, "{}", renamed.stderr);
    let told = check("peg_search.obv", &format!("// What follows is as it was.\n\n{source}"));
    assert_eq!(told.code, 0, "{}", told.stderr);
    let another = source.replace("sequence main {", "sequence main {\n  wait 1 s");
    let changed = check("peg_search.obv", &another);
    assert!(changed.code == 2 && changed.stderr.contains("before it was changed"));
    // Who takes the digest out answers for it.
    let text = String::from_utf8(bench.read("best")).expect("text");
    let without = text.lines().filter(|line| !line.starts_with("program_digest"));
    bench.write("best", without.collect::<Vec<_>>().join("\n"));
    assert_eq!(check("peg_search.obv", &another).code, 0);
}

#[test]
fn what_is_learned_replaces_what_was_learned_and_nothing_else() {
    let bench = Bench::new("learn_again");
    bench.ends(0, &learn(&[]));
    bench.ends(0, &learn(&["--seed", "1"]));
    for text in ["my notes", "format = \"obverse parameters\""] {
        bench.write("best", text);
        bench.refuses(&learn(&[]), &["best: ", "not a parameter file", "not overwritten"]);
    }
}

/// Where nothing was found out nothing is written, and what was learned before stays.
#[test]
fn without_evidence_nothing_is_written() {
    let bench = Bench::new("learn_nothing");
    let few = ["learn", "peg_search.obv", ACTION, "--runs", "5", "--candidates", "24"];
    bench.refuses(&few, &["--runs is 5", "24 candidates", "at least 31"]);
    let enough = ["learn", "peg_search.obv", ACTION, "--runs", "31", "--candidates", "24"];
    assert!(bench.run(&enough).code < 2, "it is the least");
    // A push that is longer than the hole is deep never comes to its end.
    let source = String::from_utf8(bench.read("peg_search.obv")).expect("text");
    let call = "insert_with_spiral_search(";
    let deeper = source.replace(&format!("{call}depth: 30 mm"), &format!("{call}depth: 90 mm"));
    assert_ne!(source, deeper, "the call is there");
    bench.write("peg_search.obv", deeper);
    bench.ends(1, &learn(&[]));
    assert!(!bench.path("best").exists(), "nothing was learned");
    let ran = bench.ends(1, &learn(&["--json"]));
    assert_eq!(ran.summary()["outcome"], "nothing learned");
    assert_eq!(ran.summary()["out"], serde_json::Value::Null);
    let told = bench.ends(1, &learn(&[])).stdout;
    assert!(told.contains("best: not written") && told.contains("0 of "), "{told}");
}

#[test]
fn what_cannot_be_learned_is_said() {
    let bench = Bench::new("learn_refused");
    bench.refuses(&["learn", "peg_search.obv", "insert"], &["no action `insert`"]);
    bench.refuses(&["learn", "tower.obv", "pick"], &["nothing can be learned of `pick`"]);
    bench.refuses(&["learn", "peg_search.obv", ACTION, "--runs", "1"], &["--runs is 1"]);
    bench.refuses(&["learn", "peg_search.obv", ACTION, "--candidates", "0"], &["--candidates"]);
    let onto = ["learn", "peg_search.obv", ACTION, "--out", "peg_search.obv"];
    bench.refuses(&onto, &["would overwrite"]);
    bench.refuses(&["learn", "search_cell.toml", ACTION], &["source text"]);
}
