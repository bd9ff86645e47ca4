//! Campaigns by their command: the same bytes on any number of threads and from any shards, files
//! that are whole or not there, and what is refused.

use crate::support::Bench;
use serde_json::Value;

/// A campaign of so many runs in which some assemblies fail, with further arguments.
fn trials<'a>(runs: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let first = ["trials", "reversal_policy.obv", "--runs", runs, "--strategy", "stop,explicit"];
    first.iter().chain(more).copied().collect()
}

#[test]
fn a_campaign_tells_each_run_with_its_seed_and_sums_up() {
    let bench = Bench::new("trials_json");
    let ran = bench.ends(0, &trials("60", &["--json"]));
    let lines = ran.json();
    assert_eq!(lines[0]["type"], "campaign");
    let runs: Vec<&Value> = lines.iter().filter(|line| line["type"] == "run").collect();
    assert_eq!(runs.len(), 120);
    let failed = runs.iter().find(|run| run["ending"] == "given_up").expect("some are hard");
    assert_eq!(failed["strategy"], "stop");
    assert_eq!(failed["incidents"][0]["error"], "peg_meets_rim");
    // The seed of a line is that of the same run by itself.
    let seed = failed["seed"].to_string();
    let same = bench.run(&["run", "reversal_policy.obv", "--seed", &seed, "--json"]);
    assert!(same.stdout.contains("peg_meets_rim"), "{}", same.stdout);
    let summary = ran.summary();
    let stop = &summary["strategies"][0];
    let left = runs.iter().filter(|run| run["strategy"] == "stop" && run["ending"] == "given_up");
    assert_eq!(stop["to_a_person"], left.count());
    assert_eq!((&stop["runs"], &stop["recovered"]), (&Value::from(60), &Value::from(0)));
}

#[test]
fn the_bytes_are_the_same_from_threads_and_shards() {
    let bench = Bench::new("trials_shards");
    let whole = bench.ends(0, &trials("50", &["--jobs", "1", "--out", "whole", "--json"]));
    let other = bench.ends(0, &trials("50", &["--jobs", "5", "--out", "other", "--json"]));
    assert!(whole.stdout == other.stdout && bench.read("whole") == bench.read("other"));
    for shard in ["1/3", "2/3", "3/3"] {
        let out = shard.replace('/', "_");
        bench.ends(0, &trials("50", &["--shard", shard, "--out", &out]));
    }
    let files = ["--merge", "3_3", "1_3", "2_3"];
    let merge: Vec<&str> = ["trials"].into_iter().chain(files).collect();
    let with = |more: &[&'static str]| merge.iter().chain(more).copied().collect::<Vec<_>>();
    let merged = bench.ends(0, &with(&["--out", "merged", "--json", "--plots", "plots"]));
    assert!(merged.stdout == whole.stdout && bench.read("merged") == bench.read("whole"));
    let (table, again) = (bench.ends(0, &merge), bench.ends(0, &trials("50", &["--plots", "own"])));
    assert_eq!(table.stdout, again.stdout);
    for plot in ["endings.svg", "success.svg", "makespan.svg", "depth.svg"] {
        let svg = bench.read(&format!("plots/{plot}"));
        assert!(svg.starts_with(b"<svg ") && svg == bench.read(&format!("own/{plot}")));
    }
    assert!(!bench.path("merged.part").exists());
}

#[test]
fn shards_that_do_not_make_a_campaign_are_refused() {
    let bench = Bench::new("trials_merge");
    for (shard, seed, out) in [("1/2", "0", "one"), ("2/2", "0", "two"), ("2/2", "1", "foreign")] {
        bench.ends(0, &trials("9", &["--shard", shard, "--seed", seed, "--out", out]));
    }
    let two = bench.read("two");
    bench.write("torn", &two[..two.len() - 9]);
    let other = String::from_utf8(two).expect("text").replace("\"format\":4", "\"format\":7");
    bench.write("other", other);
    bench.refuses(&["trials", "--merge", "one"], &["shard 2/2 is missing"]);
    bench.refuses(&["trials", "--merge", "one", "one", "two"], &["one: this is shard 1/2"]);
    bench.refuses(&["trials", "--merge", "one", "foreign"], &["foreign: ", "seed is 1, and not 0"]);
    bench.refuses(&["trials", "--merge", "one", "torn"], &["torn: ", "not whole"]);
    bench.refuses(&["trials", "--merge", "one", "other"], &["other: ", "format 7", "format 4"]);
    bench.refuses(&["trials", "--merge", "one", "sheets.obv"], &["sheets.obv: ", "no file of a"]);
    bench.refuses(&["trials", "--merge", "one", "gone"], &["gone: "]);
    let over = ["trials", "--merge", "one", "two", "--out", "one"];
    bench.refuses(&over, &["one: ", "overwrite"]);
}

#[test]
fn a_campaign_that_was_stopped_is_gone_on_with() {
    let bench = Bench::new("trials_resume");
    bench.ends(0, &trials("40", &["--out", "whole"]));
    let whole = bench.read("whole");
    for length in [0, 17, whole.len() / 3, whole.len() - 30] {
        bench.write("again.part", &whole[..length]);
        let anew = trials("40", &["--out", "again"]);
        bench.refuses(&anew, &["again.part: ", "--resume"]);
        let foreign = trials("41", &["--out", "again", "--resume"]);
        if length > 1000 {
            bench
                .refuses(&foreign, &["again.part: ", "another campaign", "runs is 40, and not 41"]);
        }
        bench.ends(0, &trials("40", &["--out", "again", "--resume"]));
        assert!(bench.read("again") == whole, "stopped after {length} bytes");
        assert!(!bench.path("again.part").exists());
        // Once more there is nothing to do, and the same is told.
        let told = bench.ends(0, &trials("40", &["--out", "again", "--resume"])).stdout;
        assert_eq!(told, bench.ends(0, &trials("40", &[])).stdout);
        bench.refuses(&anew, &["again: ", "not overwritten"]);
        std::fs::remove_file(bench.path("again")).expect("it was there");
    }
    bench.write("again.part", "something else\n");
    let resume = trials("40", &["--out", "again", "--resume"]);
    bench.refuses(&resume, &["again.part: ", "no file of a campaign"]);
}

#[test]
fn what_another_seed_changes_is_named_by_the_seed() {
    let bench = Bench::new("trials_seed");
    for (shard, seed) in [("1/2", "0"), ("2/2", "1")] {
        let first = ["trials", "reversal_policy.obv", "--runs", "9", "--strategy", "learned"];
        let more = ["--learn", "40", "--shard", shard, "--seed", seed, "--out", seed];
        bench.ends(0, &[first.as_slice(), more.as_slice()].concat());
    }
    bench.refuses(&["trials", "--merge", "0", "1"], &["1: ", "its seed is 1, and not 0"]);
}

#[test]
fn what_says_how_a_campaign_is_made_says_nothing_of_one_that_is_merged() {
    let bench = Bench::new("trials_merge_options");
    bench.ends(0, &trials("9", &["--out", "whole"]));
    let options: [&[&str]; 13] = [
        &["--runs", "9"],
        &["--strategy", "stop"],
        &["--seed", "0"],
        &["--cell", "bench_cell.toml"],
        &["--jobs", "1"],
        &["--shard", "1/1", "--out", "x"],
        &["--resume", "--out", "x"],
        &["--memory", "m"],
        &["--learn", "1"],
        &["--parameters", "p"],
        &["--person", "1"],
        &["--release", "1"],
        &["--limit", "1"],
    ];
    for option in options {
        let merge: Vec<&str> =
            ["trials", "--merge", "whole"].iter().chain(option).copied().collect();
        bench.refuses(&merge, &["--merge", option[0], "cannot be used with"]);
    }
    bench.ends(0, &["trials", "--merge", "whole", "--out", "merged"]);
}

/// Each is found before anything is made: of the campaigns none could end in an hour.
#[test]
fn what_cannot_be_written_is_found_before_the_campaign() {
    let bench = Bench::new("trials_places");
    let refuses = |more: &[&str], words: &[&str]| {
        let first = ["trials", "reversal_policy.obv", "--runs", "10000000", "--learn", "10000000"];
        let learned = ["--strategy", "learned"];
        let all: Vec<&str> = first.iter().chain(&learned).chain(more).copied().collect();
        bench.refuses(&all, words);
    };
    refuses(&["--memory", "none/m"], &["none/m: ", "no folder none"]);
    refuses(&["--memory", "cases"], &["cases: ", "folder"]);
    refuses(&["--out", "x", "--memory", "x"], &["x: ", "overwrite"]);
    refuses(&["--plots", "none/x"], &["none/x: ", "cannot be made"]);
    if cfg!(target_os = "linux") {
        // A folder in which not even root can make a file.
        refuses(&["--memory", "/proc/m"], &["/proc/m: cannot be written"]);
        refuses(&["--out", "/proc/x"], &["/proc/x: cannot be written"]);
        refuses(&["--plots", "/proc"], &["/proc/endings.svg: cannot be written"]);
    }
    bench.write("drawn/success.svg", "<svg>by hand</svg>");
    refuses(&["--plots", "drawn"], &["drawn/success.svg: ", "not a plot", "not overwritten"]);
    assert_eq!(bench.read("drawn/success.svg"), b"<svg>by hand</svg>");
}

#[test]
fn plots_are_drawn_again_over_plots() {
    let bench = Bench::new("trials_plots");
    bench.ends(0, &trials("9", &["--plots", "plots"]));
    let first = bench.read("plots/makespan.svg");
    bench.ends(0, &trials("8", &["--plots", "plots"]));
    assert_ne!(bench.read("plots/makespan.svg"), first);
}

/// What a full disk does: the system takes so many bytes and no more.
#[cfg(unix)]
#[test]
fn on_a_full_disk_what_was_done_is_kept() {
    use std::process::Command;
    let bench = Bench::new("trials_full");
    bench.ends(0, &trials("100", &["--out", "whole"]));
    // 8 or 16 KiB, by what the shell counts in.
    let limited = "trap '' XFSZ; ulimit -f 16; exec \"$0\" \"$@\"";
    let arguments = trials("100", &["--out", "full", "--json"]);
    let output = Command::new("sh")
        .args(["-c", limited, env!("CARGO_BIN_EXE_obverse")])
        .args(&arguments)
        .current_dir(bench.path(""))
        .output()
        .expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    for words in ["full: cannot be written: ", "kept in full.part", "`--resume`"] {
        assert!(said.contains(words), "{words} in {said}");
    }
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(told.contains("\"refused\"") && told.lines().count() == 1, "{told}");
    assert!(!bench.path("full").exists());
    bench.ends(0, &trials("100", &["--out", "full", "--resume"]));
    assert!(bench.read("full") == bench.read("whole"));
}

#[test]
fn wrong_words_are_refused() {
    let bench = Bench::new("trials_wrong");
    let refuses = |more: &[&str], words: &[&str]| {
        let all: Vec<&str> =
            ["trials", "reversal_policy.obv"].iter().chain(more).copied().collect();
        bench.refuses(&all, words);
    };
    refuses(&["--runs", "0"], &["--runs is 0"]);
    refuses(&["--runs", "99999999999"], &["--runs is 99999999999", "10000000"]);
    refuses(&["--runs=-1"], &["--runs"]);
    refuses(&["--strategy", "luck"], &["no strategy `luck`", "escalating"]);
    refuses(&["--strategy", "stop,stop"], &["stop is named twice"]);
    refuses(&["--strategy", "fixed:0"], &["fixed:0", "number of actions"]);
    refuses(&["--strategy", "fixed:1001"], &["fixed:1001", "from 1 to 1000"]);
    refuses(&["--jobs", "0"], &["--jobs is 0"]);
    refuses(&["--person", "NaN"], &["--person is NaN"]);
    refuses(&["--person=-1"], &["--person is -1"]);
    refuses(&["--shard", "5/4", "--out", "x"], &["5/4", "no shard"]);
    refuses(&["--shard", "1/4"], &["--out"]);
    refuses(&["--resume"], &["--out"]);
    refuses(&["--merge", "x"], &["--merge"]);
    refuses(&["--out", "none/x"], &["no folder none"]);
    refuses(&["--out", "reversal_policy.obv"], &["reversal_policy.obv"]);
    refuses(&["--plots", "none/x"], &["none/x: ", "cannot be made"]);
    bench.refuses(&["trials"], &["PROGRAM"]);
    let messages = bench.refuses_as_json(&["trials", "gone.obv", "--json"]);
    assert_eq!(messages[0]["file"], "gone.obv");
}
