//! Gain of a second thread: the same measurement on one thread and on two, in turn, within one run.

use fairflight_harness::field::MediumLibrary;
use fairflight_harness::plan::Plan;
use fairflight_harness::spec::{Overrides, Request};
use fairflight_harness::{experiment, reference};
use fairflight_media::Tolerance;
use std::time::Instant;

const SPEC: &str = r#"{
    "profile": { "kind": "ray", "medium": { "kind": "analytic_cosine" }, "origin": [0, 0, 0], "direction": [0, 0, 1] },
    "estimator": { "kind": "double_particle", "sigma_samp": 1.0 }, "samples": 400000, "seed": 1 }"#;

fn main() {
    let Request::Single(spec) = Request::parse(SPEC, Overrides::default()).expect("a spec") else {
        unreachable!("the spec has no sweep")
    };
    let plan = Plan::of(&spec, &MediumLibrary::default()).expect("a plan");
    let truth = reference::Truth::of(&plan.profile, Tolerance::TIGHT).expect("integrable");
    let seconds = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let start = Instant::now();
        pool.install(|| experiment::measure_plan(&plan, &truth, &|_| {})).expect("lawful");
        start.elapsed().as_secs_f64()
    };
    seconds(2);
    let mut ratios: Vec<f64> = (0..11).map(|_| seconds(1) / seconds(2)).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    println!(
        "one thread / two threads: median {:.2}, range {:.2} to {:.2}",
        ratios[ratios.len() / 2],
        ratios[0],
        ratios[ratios.len() - 1]
    );
}
