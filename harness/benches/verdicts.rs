//! Verdicts on lawful runs at random: `cargo bench --bench verdicts -- [COUNT] [EARLIER]`.
//!
//! A line per run on standard output, as soon as it is done: index, profile, estimator, N, the verdict, the verdict with every estimate
//! times 1.01 and its z-score by the closed variance, CPU seconds, and the reason. The table on standard error counts them by kind; with
//! the output of an EARLIER build, it lists what that rejected and this one does not.

#[path = "../program/tests/commands/lawful_runs.rs"]
mod lawful_runs;

use cpu_time::ThreadTime;
use lawful_runs::{LawfulRun, Outcome, lawful_run, outcome};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Factor of every estimate: a bias of one percent.
const FACTOR: f64 = 1.01;

fn word(sound: Option<bool>) -> &'static str {
    match sound {
        Some(true) => "true",
        Some(false) => "false",
        None => "null",
    }
}

/// The kind of the estimator with its version.
fn kind(run: &LawfulRun) -> String {
    let estimator = &run.spec["estimator"];
    let text = |key: &str| estimator[key].as_str().unwrap_or("");
    format!("{} {}", text("kind"), text("version")).trim().to_owned()
}

fn line(index: u32, run: &LawfulRun, outcome: &Result<Outcome, String>, seconds: f64) -> String {
    let samples = &run.spec["samples"];
    let head = format!("{index}\t{}\t{}\t{samples}", run.family, kind(run));
    match outcome {
        Err(why) => format!("{head}\trefused\trefused\t-\t{seconds:.2}\t{why}"),
        Ok(Outcome { is_biased, right, wrong, wrong_z }) => {
            let sound = if *is_biased { "baseline" } else { word(right.sound) };
            let z = wrong_z.map_or("-".to_owned(), |z| format!("{z:.2}"));
            let reason = if right.sound == Some(false) { &right.reason } else { &wrong.reason };
            format!("{head}\t{sound}\t{}\t{z}\t{seconds:.2}\t{reason}", word(wrong.sound))
        }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let count: u32 = arguments.first().map_or(2000, |count| count.parse().expect("a number of runs"));
    let lines: Vec<String> = (0..count)
        .into_par_iter()
        .with_max_len(1)
        .map(|index| {
            let clock = ThreadTime::now();
            let run = lawful_run(u64::from(index));
            let outcome = outcome(&run, FACTOR);
            let line = line(index, &run, &outcome, clock.elapsed().as_secs_f64());
            println!("{line}");
            line
        })
        .collect();

    // By kind: runs, refused, true, null, false, rejected at 1.01.
    let mut table: BTreeMap<&str, [u32; 6]> = BTreeMap::new();
    for line in &lines {
        let field: Vec<&str> = line.split('\t').collect();
        for name in [field[2], "all but baselines"] {
            if name != field[2] && field[4] == "baseline" {
                continue;
            }
            let counts = table.entry(name).or_default();
            let of = |word: &str| u32::from(field[4] == word);
            let all = [1, of("refused"), of("true"), of("null"), of("false"), u32::from(field[5] == "false")];
            counts.iter_mut().zip(all).for_each(|(count, one)| *count += one);
        }
    }
    eprintln!(
        "{:34} {:>6} {:>8} {:>6} {:>6} {:>6} {:>9}",
        "estimator", "runs", "refused", "true", "null", "false", "1.01: no"
    );
    for (name, [runs, refused, sound, null, unsound, rejected]) in table {
        eprintln!("{name:34} {runs:>6} {refused:>8} {sound:>6} {null:>6} {unsound:>6} {rejected:>9}");
    }
    let Some(earlier) = arguments.get(1) else { return };
    let earlier = std::fs::read_to_string(earlier).expect("the lines of an earlier build");
    let fields = |line: &'_ str| line.split('\t').map(str::to_owned).collect::<Vec<_>>();
    let earlier: BTreeMap<String, Vec<String>> =
        earlier.lines().map(fields).map(|fields| (fields[0].clone(), fields)).collect();
    for new in &lines {
        let now = fields(new);
        let Some(before) = earlier.get(&now[0]) else { continue };
        assert_eq!(before[..4], now[..4], "the same runs");
        if before[4] == "true" && now[4] != "true" {
            eprintln!("no longer true: {new}");
        }
        if before[4] == "false" {
            eprintln!("was false, is {}: {new}", now[4]);
        }
        if before[4] != "baseline" && before[5] == "false" && now[5] != "false" {
            eprintln!("no longer rejected at 1.01: {new}");
        }
    }
}
