//! Statistics of this project's estimators, judged by the exact moments that headers state.

use crate::case::as_vector;
use crate::replay;
use fairflight_sources::{Seeded, derive_seed};
use fairflight_vectors::{KINDS, asked_statistics, judge_statistics};
use serde_json::{Value, json};

/// The score of an answer: its value, the cosine, or the weight of a flight that escaped.
fn score(of: &str, values: &[f64], collided: Option<bool>) -> f64 {
    match (of, collided) {
        ("escaped", Some(true)) => 0.0,
        // Behind the distance, where there is one.
        ("escaped", _) => values[usize::from(values.len() != 3)],
        _ => values[0],
    }
}

/// Mean, variance and look-ups of as many estimates as are asked for.
fn estimated(asked: &Value, seed: u64) -> Value {
    let (samples, of) = (asked["samples"].as_u64().unwrap(), asked["expect"]["of"].as_str().unwrap());
    let mut source = Seeded::new(derive_seed(seed, asked["seed"].as_u64().unwrap()));
    as_vector(asked, |vector| {
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..samples {
            let answer = replay::answer(asked, vector, &mut source);
            let x = score(of, &answer.values, answer.collided);
            (sum, squares) = (sum + x, squares + x * x);
        }
        let n = samples as f64;
        let mean = sum / n;
        let lookups = vector.field.map_or(0, |field| field.lookups().len());
        json!({ "mean": mean, "variance": (squares - n * mean * mean) / (n - 1.0), "lookups": lookups as f64 / n })
    })
}

#[test]
fn estimators_have_the_moments_that_headers_state() {
    let mut faults = Vec::new();
    for kind in KINDS {
        for asked in asked_statistics(kind, 20_000) {
            for seed in 1..=SEEDS {
                match judge_statistics(&asked, &estimated(&asked, seed)) {
                    Ok(scores) => println!("{}: {scores:?}", asked["id"]),
                    Err(fault) => faults.push(format!("{}: {fault}", asked["id"])),
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Runs of each.
const SEEDS: u64 = 1;
