//! Lawful experiments at random: estimators of every kind and version on profiles that are thin, dense, smooth or spiky, through the
//! code path of `harness estimate`.
//!
//! Nothing in them is wrong, so that no verdict may be `false`; with every estimate times a factor something is. Spikes are
//! as narrow as a billionth of the ray: most runs on them see less than one in all their look-ups.

use fairflight_harness::experiment::{compare, measure_plan};
use fairflight_harness::field::MediumLibrary;
use fairflight_harness::plan::Plan;
use fairflight_harness::reference::{Truth, predict};
use fairflight_harness::spec::{Overrides, Request};
use fairflight_media::Tolerance;
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{DEFAULT_ALPHA, Verdict};
use serde_json::{Value, json};

/// An experiment, and what kind of profile it is on.
#[derive(Debug)]
pub(crate) struct LawfulRun {
    /// The spec.
    pub(crate) spec: Value,
    /// thin, moderate, dense, spiky, smooth or negative.
    pub(crate) family: &'static str,
}

/// Outcome of a run.
#[derive(Debug)]
pub(crate) struct Outcome {
    /// True if the estimator is a labelled biased baseline, of which nothing is asked.
    pub(crate) is_biased: bool,
    /// The verdict on the run.
    pub(crate) right: Verdict,
    /// The verdict with every estimate times the factor.
    pub(crate) wrong: Verdict,
    /// The z-score of that by the closed variance, where there is one.
    pub(crate) wrong_z: Option<f64>,
}

/// Draws and judges a run, as it is and with every estimate times `factor`; `Err` says why it was refused.
pub(crate) fn outcome(run: &LawfulRun, factor: f64) -> Result<Outcome, String> {
    let words = |failure: fairflight_harness::Failure| failure.to_string();
    let Request::Single(experiment) =
        Request::parse(&run.spec.to_string(), Overrides::default()).map_err(words)?
    else {
        return Err("no sweep is drawn".to_owned());
    };
    let mut plan = Plan::of(&experiment, &MediumLibrary::default()).map_err(words)?;
    // Look-ups are not asked for: they would double the time.
    plan.counted = 0;
    let truth = Truth::of(&plan.profile, Tolerance::TIGHT).map_err(words)?;
    let prediction = predict(&plan.profile, &plan.estimator, &truth, Tolerance::TIGHT).map_err(words)?;
    let right = measure_plan(&plan, &truth, &|_| {}).map_err(words)?;
    let wrong = fairflight_harness::measure::Measurement { moments: right.moments.scaled(factor), ..right };
    let compared = compare(&plan, &truth, &prediction, &right, DEFAULT_ALPHA);
    let scaled = wrong.moments.scaled(compared.unit.scale());
    let wrong_z = compared
        .closed
        .standard_error(scaled.count() as f64)
        .zip(scaled.mean())
        .map(|(error, mean)| (mean - compared.closed.mean) / error);
    Ok(Outcome {
        is_biased: plan.spec.is_biased_baseline(),
        right: compared.verdict,
        wrong: compare(&plan, &truth, &prediction, &wrong, DEFAULT_ALPHA).verdict,
        wrong_z,
    })
}

/// Variates for a person who makes up experiments.
struct Draw(Seeded);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.next_uniform()
    }

    /// Uniform in its logarithm.
    fn scale(&mut self, low: f64, high: f64) -> f64 {
        (self.between(low.ln(), high.ln())).exp()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.0.next_uniform() * count as f64) as usize
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    fn happens(&mut self, probability: f64) -> bool {
        self.0.next_uniform() < probability
    }
}

/// A profile, and what the parameters of an estimator are chosen by.
struct Profile {
    json: Value,
    family: &'static str,
    length: f64,
    least: f64,
    most: f64,
    /// ∫ σ_t, roughly.
    thickness: f64,
}

/// The run of an index: the same in every build.
pub(crate) fn lawful_run(index: u64) -> LawfulRun {
    let mut draw = Draw(Seeded::new(derive_seed(0x6c61_7766, index)));
    let profile = draw.profile();
    loop {
        let (estimator, lookups) = draw.estimator(&profile);
        let affordable = MOST_LOOKUPS / lookups.max(1.0);
        if affordable >= LEAST_SAMPLES {
            let samples = draw.scale(LEAST_SAMPLES, MOST_SAMPLES.min(affordable)) as u64;
            let spec = json!({
                "profile": profile.json, "estimator": estimator, "samples": samples, "seed": index,
            });
            return LawfulRun { spec, family: profile.family };
        }
    }
}

const LEAST_SAMPLES: f64 = 1000.0;
const MOST_SAMPLES: f64 = 200_000.0;
/// Greatest number of look-ups of one run.
const MOST_LOOKUPS: f64 = 4e6;

impl Draw {
    fn profile(&mut self) -> Profile {
        match self.below(10) {
            0 | 1 => self.steps("thin", 1e-3, 0.3),
            2 | 3 => self.steps("moderate", 0.3, 4.0),
            4 => self.steps("dense", 4.0, 30.0),
            5..=7 => self.spikes(),
            8 => self.smooth(),
            _ => self.negative(),
        }
    }

    /// Nodes from 0 to `length`, `count` intervals.
    fn nodes(&mut self, length: f64, count: usize) -> Vec<f64> {
        let mut nodes: Vec<f64> = (1..count).map(|_| self.between(0.0, length)).collect();
        nodes.extend([0.0, length]);
        nodes.sort_unstable_by(f64::total_cmp);
        nodes.dedup();
        nodes
    }

    fn steps(&mut self, family: &'static str, low: f64, high: f64) -> Profile {
        let (length, thickness) = (self.scale(0.1, 20.0), self.scale(low, high));
        let mean = thickness / length;
        if self.happens(0.15) {
            let json = json!({ "kind": "constant", "sigma_t": mean, "length": length });
            return Profile { json, family, length, least: mean, most: mean, thickness };
        }
        let count = 2 + self.below(8);
        let nodes = self.nodes(length, count);
        let spread = self.scale(1.1, 20.0);
        let draw = |draw: &mut Self| mean * draw.scale(1.0 / spread, spread.sqrt());
        if self.happens(0.5) {
            let values: Vec<f64> = nodes.iter().skip(1).map(|_| draw(self)).collect();
            piecewise_constant(family, &nodes, &values)
        } else {
            let values: Vec<f64> = nodes.iter().map(|_| draw(self)).collect();
            piecewise_linear(family, &nodes, &values)
        }
    }

    /// One to three spikes on a level ground.
    fn spikes(&mut self) -> Profile {
        let length = self.scale(0.1, 20.0);
        let ground = self.scale(1e-3, 3.0) / length;
        let count = 1 + self.below(3);
        let linear = self.happens(0.5);
        let (mut nodes, mut values) = (vec![0.0], vec![ground]);
        for i in 0..count {
            let from = length * (i as f64 + self.between(0.1, 0.6)) / count as f64;
            let width = length * self.scale(1e-9, 0.1) / count as f64;
            let height = ground + self.scale(1e-3, 30.0) / width;
            if linear {
                nodes.extend([from, from + 0.5 * width, from + width]);
                values.extend([ground, height, ground]);
            } else {
                nodes.extend([from, from + width]);
                values.extend([height, ground]);
            }
        }
        nodes.push(length);
        if linear {
            values.push(ground);
            piecewise_linear("spiky", &nodes, &values)
        } else {
            piecewise_constant("spiky", &nodes, &values)
        }
    }

    fn smooth(&mut self) -> Profile {
        if self.happens(0.5) {
            let scale = self.scale(0.1, 2.0);
            let aside = self.between(-6.0, 6.0);
            let json = json!({
                "kind": "ray", "medium": { "kind": "analytic_cosine", "scale": scale },
                "origin": [aside, 0.0, 0.0], "direction": [0, 0, 1], "length": 12.0,
            });
            return Profile {
                json,
                family: "smooth",
                length: 12.0,
                least: 0.0,
                most: scale,
                thickness: 2.0 * scale,
            };
        }
        let length = self.scale(0.5, 10.0);
        let level = self.scale(0.05, 3.0) / length;
        let (share, waves) = (self.between(0.0, 0.95), self.between(0.3, 6.0));
        let most = level * (1.0 + share);
        let formula = format!("{level}*(1 + {share}*sin({}*s))", std::f64::consts::TAU * waves / length);
        let json = json!({ "kind": "expression", "sigma_t": formula, "length": length, "majorant": most * 1.000_001 });
        let least = level * (1.0 - share);
        Profile { json, family: "smooth", length, least, most: most * 1.000_001, thickness: level * length }
    }

    fn negative(&mut self) -> Profile {
        let length = self.scale(0.5, 5.0);
        let count = 2 + self.below(4);
        let nodes = self.nodes(length, count);
        let values: Vec<f64> = nodes.iter().skip(1).map(|_| self.between(-0.5, 1.5) / length).collect();
        piecewise_constant("negative", &nodes, &values)
    }

    /// An estimator that is lawful there, and about how many look-ups an estimate takes.
    fn estimator(&mut self, profile: &Profile) -> (Value, f64) {
        let &Profile { length, least, most, thickness, .. } = profile;
        let looseness = if self.happens(0.5) { 1.0 } else { self.scale(1.0, 3.0) };
        let majorant = most.max(0.0) * looseness;
        let depth = majorant * length;
        let is_negative = least < 0.0;
        let teeth = 1 + self.scale(1.0, 24.0) as u32;
        let lookups = f64::from(teeth);
        match self.below(if is_negative { 10 } else { 23 }) {
            0 | 1 => {
                // Ratio tracking, also below the extinction, and residual ratio tracking.
                let sigma_samp = (most.abs().max(least.abs())).max(1e-3 / length) * self.scale(0.5, 2.0);
                let control = match self.below(4) {
                    0 => {
                        json!({ "kind": "constant", "sigma_main": thickness / length * self.between(0.0, 1.2) })
                    }
                    1 => json!({ "kind": "explorers", "count": 2 + self.below(10) }),
                    _ => json!({ "kind": "none" }),
                };
                (
                    json!({ "kind": "double_particle", "sigma_samp": sigma_samp, "control": control }),
                    sigma_samp * length + 10.0,
                )
            }
            2 | 3 => {
                let version = self.one_of(&["cmf", "cumulative", "ratio", "next_flight"]);
                let near = thickness.abs() * self.scale(0.5, 2.0) + 0.05;
                let pivot = if self.happens(0.5) { near } else { depth.max(1e-6) };
                (json!({ "kind": "p_series", "version": version, "pivot": pivot }), 2.0 * pivot + 4.0)
            }
            4 => {
                let rate = self.scale(0.3, 2.0) * (1.0 + thickness.abs());
                let pivot = thickness + rate * self.between(0.5, 1.5);
                (json!({ "kind": "generalised_poisson", "pivot": pivot, "rate": rate }), rate)
            }
            5..=7 => self.marching(teeth),
            8 => {
                let level_ratio = self.one_of(&[0.65, 0.8, 0.9]);
                let matched = self.happens(0.5);
                (
                    json!({
                        "kind": "telescoping", "teeth": teeth, "level_ratio": level_ratio,
                        "endpoint_matching": matched,
                    }),
                    4.0 * lookups,
                )
            }
            9 => self.baseline(teeth, majorant, depth),
            10 => (json!({ "kind": "woodcock", "majorant": majorant }), depth),
            11 => {
                let version = self.one_of(&["terminating", "non_terminating", "adaptive"]);
                let albedo = self.between(0.0, 1.0);
                // A ratio of at most 1, which every version takes.
                (
                    json!({
                        "kind": "single_particle", "version": version, "albedo": albedo,
                        "sigma_samp": majorant.max(1e-3 / length),
                    }),
                    depth,
                )
            }
            12 => {
                let splits = 1 + self.below(8);
                (
                    json!({ "kind": "line_integral", "majorant": majorant, "splits": splits }),
                    depth * splits as f64,
                )
            }
            13..=15 => {
                let version =
                    self.one_of(&["delta", "ratio", "unidirectional", "bidirectional", "bidirectional"]);
                // Pairs of points are connected.
                let pairs = if version == "bidirectional" { depth * depth } else { 0.0 };
                (
                    json!({ "kind": "next_flight", "majorant": majorant, "version": version }),
                    2.0 * depth + pairs,
                )
            }
            16 | 17 => {
                let epsilon = self.scale(0.1, 1.0);
                if self.happens(0.5) {
                    let cells = 1 + self.below(12);
                    (
                        json!({ "kind": "jittered_ratio", "cells": cells, "epsilon": epsilon }),
                        10.0 * most * length / epsilon + cells as f64,
                    )
                } else {
                    (
                        json!({ "kind": "jittered_ratio", "majorant": majorant, "epsilon": epsilon }),
                        depth / epsilon + 1.0,
                    )
                }
            }
            18 => {
                let (cells, rate) = (1 + self.below(12), self.scale(0.7, 2.0));
                (json!({ "kind": "residual_cells", "cells": cells, "rate": rate }), most * length * rate)
            }
            19 | 20 => {
                let floor = self.scale(0.05, 1.0);
                (json!({ "kind": "adaptive_ratio", "majorant": majorant, "floor": floor }), depth)
            }
            21 => (json!({ "kind": "regular" }), 1.0),
            _ => (json!({ "kind": "hybrid", "majorant": majorant }), 10.0 * depth + 10.0),
        }
    }

    fn marching(&mut self, teeth: u32) -> (Value, f64) {
        let mut spec = match self.below(5) {
            0 | 1 => json!({ "endpoint_matching": true }),
            2 => json!({ "endpoint_matching": false }),
            3 => json!({ "comb": "periodised" }),
            _ => json!({ "comb": "bernoulli", "order": 2 + self.below(2) }),
        };
        spec["kind"] = json!("unbiased_ray_marching");
        spec["teeth"] = json!(teeth);
        match self.below(3) {
            0 => spec["roulette"] = json!("self_tuned"),
            1 => spec["roulette"] = json!(self.between(0.0, 0.95)),
            _ => {}
        }
        let segments = if self.happens(0.3) { 2 + self.below(6) } else { 1 };
        spec["segments"] = json!(segments);
        (spec, 3.0 * f64::from(teeth) * segments as f64)
    }

    fn baseline(&mut self, teeth: u32, majorant: f64, depth: f64) -> (Value, f64) {
        let combs = 2.0 * f64::from(teeth);
        match self.below(4) {
            0 => (json!({ "kind": "jackknife", "teeth": teeth }), combs),
            1 => (json!({ "kind": "naive", "teeth": teeth }), combs),
            // The guess is raised to what is met, up to the majorant.
            2 => (json!({ "kind": "progressive_majorant", "start": majorant.max(1e-6) * 0.5 }), depth),
            _ => (json!({ "kind": "ray_marching", "steps": teeth, "jitter": self.happens(0.5) }), combs),
        }
    }
}

fn integral(nodes: &[f64], value: impl Fn(usize) -> f64) -> f64 {
    nodes.windows(2).enumerate().map(|(i, ends)| (ends[1] - ends[0]) * value(i)).sum()
}

fn profile(kind: &str, family: &'static str, nodes: &[f64], values: &[f64], thickness: f64) -> Profile {
    let places = if kind == "piecewise_linear" { "positions" } else { "edges" };
    Profile {
        json: json!({ "kind": kind, places: nodes, "sigma_t": values }),
        family,
        length: nodes[nodes.len() - 1],
        least: values.iter().copied().fold(f64::INFINITY, f64::min),
        most: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        thickness,
    }
}

fn piecewise_constant(family: &'static str, nodes: &[f64], values: &[f64]) -> Profile {
    let thickness = integral(nodes, |i| values[i]);
    profile("piecewise_constant", family, nodes, values, thickness)
}

fn piecewise_linear(family: &'static str, nodes: &[f64], values: &[f64]) -> Profile {
    let thickness = integral(nodes, |i| 0.5 * (values[i] + values[i + 1]));
    profile("piecewise_linear", family, nodes, values, thickness)
}
