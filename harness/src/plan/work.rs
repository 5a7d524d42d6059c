//! What an estimator is expected to look up, from the rates of its spec, before it is built.

use super::beyond::{PILOTS, TUNING};
use super::{AnyProfile, Field, FieldJob, KnownField};
use crate::spec::{
    BeyondSpec, BoundsSpec, CellsSpec, ControlSpec, EstimatorSpec, NextFlightKind, PSeriesKind, RouletteSpec,
    SamplingSpec, TeethSpec,
};
use fairflight_transmittance::{Hybrid, Pilot, Roulette, teeth_for};

/// Look-ups of an estimator on one ray. An infinite number is lawful, and too many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// Of all that is done once before the first estimate.
    pub preparation: f64,
    /// Of one estimate, on average.
    pub estimate: Expected,
    /// The key of the spec that they come from.
    pub key: &'static str,
}

/// An expected number of look-ups.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// The same on every profile.
    Exactly(f64),
    /// So many where nothing ends a walk, and never less than some; between them only the closed form tells.
    Between(f64, f64),
}

/// What is known of a ray: `from` its entry \[length\], over `length`, σ_t at most `upper_bound` where one is
/// declared, smooth but in `breakpoints` places.
#[derive(Clone, Copy, Debug)]
pub struct RayKnown {
    /// The distance of its start from the origin in which edges are given.
    pub from: f64,
    /// Its length.
    pub length: f64,
    /// The declared majorant.
    pub upper_bound: Option<f64>,
    /// Pieces that a closed form has to add up, less one.
    pub breakpoints: usize,
}

use Expected::{Between, Exactly};

impl Expected {
    /// The number, or its upper bound.
    #[must_use]
    pub fn most(self) -> f64 {
        match self {
            Exactly(lookups) | Between(_, lookups) => lookups,
        }
    }

    /// The number, or its lower bound.
    #[must_use]
    pub fn least(self) -> f64 {
        match self {
            Exactly(lookups) | Between(lookups, _) => lookups,
        }
    }
}

impl Work {
    /// The work of an estimator on a profile.
    #[must_use]
    pub fn on(profile: &AnyProfile, spec: &EstimatorSpec) -> Self {
        struct Bound;
        impl FieldJob for Bound {
            type Output = (Option<f64>, usize);
            fn run<F: KnownField>(self, field: &F) -> Self::Output
            where
                for<'a> &'a F: Field,
            {
                (field.knowledge().upper_bound, field.breakpoints().len())
            }
        }
        let (upper_bound, breakpoints) = profile.with(Bound);
        let (from, length) = (profile.entry_distance(), profile.length());
        Self::of(spec, RayKnown { from, length, upper_bound, breakpoints })
    }

    /// The work of an estimator on a ray of which no more is known.
    #[must_use]
    pub fn of(spec: &EstimatorSpec, ray: RayKnown) -> Self {
        let once = |key, estimate| Self { preparation: 0.0, estimate, key };
        let explorers = |control: &ControlSpec| match control {
            ControlSpec::Explorers { count } => *count as f64,
            _ => 0.0,
        };
        match spec {
            EstimatorSpec::Woodcock { majorant } => {
                once("estimator.majorant", Between(0.0, ray.depth(*majorant)))
            }
            EstimatorSpec::DoubleParticle { sampling, control } => Self {
                preparation: explorers(control),
                estimate: Exactly(ray.sampled(sampling)),
                key: "estimator.sigma_samp",
            },
            EstimatorSpec::SingleParticle { sampling, control, .. } => Self {
                preparation: explorers(control),
                estimate: Between(0.0, ray.sampled(sampling)),
                key: "estimator.sigma_samp",
            },
            EstimatorSpec::LineIntegral { majorant, splits } => {
                // The first step of every flight ends on the ray, unless nothing is there to collide with.
                let (splits, flight) = (f64::from(*splits), ray.depth(*majorant));
                let least = if flight > 0.0 { splits } else { 0.0 };
                once("estimator.splits", Between(least, splits * flight.max(1.0)))
            }
            EstimatorSpec::RayMarching { steps, .. } => once("estimator.steps", Exactly(f64::from(*steps))),
            EstimatorSpec::Beyond(spec) => Self::beyond(spec, ray),
        }
    }

    fn beyond(spec: &BeyondSpec, ray: RayKnown) -> Self {
        let once = |key, estimate| Self { preparation: 0.0, estimate, key };
        let declared = ray.upper_bound.unwrap_or(0.0);
        match spec {
            BeyondSpec::NextFlight { majorant, version } => {
                let depth = ray.depth(*majorant);
                once(
                    "estimator.majorant",
                    match version {
                        NextFlightKind::Delta => Between(0.0, depth),
                        NextFlightKind::Ratio | NextFlightKind::Unidirectional => Exactly(depth),
                        // Two walks, and about depth²/2 pairs of their points that are connected.
                        NextFlightKind::Bidirectional => Exactly(2.0 * depth + 0.5 * depth * depth),
                    },
                )
            }
            BeyondSpec::PSeries { version, pivot } => {
                let pivot = pivot.unwrap_or_else(|| ray.depth(declared));
                let estimate = match version {
                    PSeriesKind::Ratio | PSeriesKind::NextFlight => Exactly(pivot),
                    // Up to the 99th percentile of a Poisson law for sure, and a tail about as wide as that law.
                    PSeriesKind::Cmf => Exactly(pivot + 4.0 * pivot.sqrt() + 2.0),
                    // |Y| is at most y := max(t_c, X − t_c): y^k/k! falls below 1 near k = e y.
                    PSeriesKind::Cumulative => {
                        Between(0.0, std::f64::consts::E * pivot.max(ray.depth(declared) - pivot) + 2.0)
                    }
                };
                once("estimator.pivot", estimate)
            }
            BeyondSpec::GeneralisedPoisson { rate, .. } => once("estimator.rate", Exactly(*rate)),
            BeyondSpec::UnbiasedRayMarching { teeth, roulette, segments, .. } => {
                let teeth = match teeth {
                    TeethSpec::Given(teeth) => f64::from(*teeth),
                    TeethSpec::Rule { pivot } => {
                        f64::from(teeth_for(pivot.unwrap_or_else(|| ray.depth(declared))))
                    }
                };
                // Ends, shared between segments, are no more than a few for each.
                let combs = |stop: f64| {
                    let order = Roulette::new(stop).map_or(0.0, |roulette| roulette.expected_order());
                    f64::from(*segments) * (1.0 + order) * teeth
                };
                let (preparation, estimate) = match roulette {
                    RouletteSpec::Stop(stop) => (0.0, Exactly(combs(*stop))),
                    RouletteSpec::SelfTuned => (f64::from(TUNING) * combs(0.0), Between(0.0, combs(0.0))),
                };
                Self { preparation, estimate, key: "estimator.teeth" }
            }
            BeyondSpec::Telescoping { teeth, level_ratio: r, .. } => {
                // Level l has 2^l combs, and is reached with the probability r (1 − r)^l.
                let combs = if *r > 0.5 { r / (2.0 * r - 1.0) } else { 1.0 };
                once("estimator.level_ratio", Exactly(f64::from(*teeth) * combs))
            }
            BeyondSpec::JitteredRatio { bounds: BoundsSpec::Majorant(majorant), epsilon } => {
                once("estimator.majorant", Exactly(strata(ray.depth(*majorant), *epsilon)))
            }
            BeyondSpec::JitteredRatio { bounds: BoundsSpec::Cells(cells), epsilon } => {
                once("estimator.cells", ray.in_cells(cells, |range| strata(range, *epsilon)))
            }
            BeyondSpec::ResidualCells { cells, rate } => {
                once("estimator.cells", ray.in_cells(cells, |range| (rate * range).max(1.0)))
            }
            BeyondSpec::AdaptiveRatio { majorant, .. } => {
                once("estimator.majorant", Between(0.0, ray.depth(*majorant)))
            }
            BeyondSpec::Regular => once("profile", Exactly(ray.breakpoints as f64 + 1.0)),
            BeyondSpec::Hybrid { majorant } => {
                let depth = ray.depth(majorant.unwrap_or(declared));
                Self {
                    preparation: f64::from(PILOTS) * Pilot::lookups(depth) as f64,
                    estimate: Between(0.0, (Hybrid::USUAL_BUDGET * depth).max(f64::from(teeth_for(depth)))),
                    key: "estimator.majorant",
                }
            }
            BeyondSpec::Jackknife { teeth } => once("estimator.teeth", Exactly(2.0 * f64::from(*teeth))),
            BeyondSpec::Naive { teeth } => once("estimator.teeth", Exactly(f64::from(*teeth))),
            BeyondSpec::ProgressiveMajorant { start } => {
                once("estimator.start", Between(0.0, ray.depth(start.max(declared))))
            }
        }
    }

    /// Of so many estimates, each with so many look-ups of its own; one that looks up nothing costs as much as
    /// one that does once.
    #[must_use]
    pub fn total(&self, estimates: u64, lookups: f64) -> f64 {
        self.preparation + estimates as f64 * lookups.max(1.0)
    }
}

/// Expected look-ups of jittered ratio tracking below a majorant of this optical thickness: (e^h − 1)/h in each
/// stratum of thickness h ≤ ε.
fn strata(depth: f64, epsilon: f64) -> f64 {
    let strata = (depth / epsilon).ceil().max(1.0);
    let h = depth / strata;
    if h > 0.0 { strata * h.exp_m1() / h } else { strata }
}

impl RayKnown {
    /// The optical thickness of an extinction; 0 where either factor is, be the other infinite.
    fn depth(self, extinction: f64) -> f64 {
        if extinction == 0.0 || self.length == 0.0 { 0.0 } else { extinction * self.length }
    }

    fn sampled(self, sampling: &SamplingSpec) -> f64 {
        match sampling {
            SamplingSpec::Constant(sigma_samp) => self.depth(*sigma_samp),
            SamplingSpec::PiecewiseConstant { edges, values } => {
                edges.windows(2).zip(values).map(|(cell, value)| self.depth_in(cell, *value)).sum()
            }
        }
    }

    /// The optical thickness of an extinction between two distances from the origin, as far as they are on the
    /// ray.
    fn depth_in(self, cell: &[f64], extinction: f64) -> f64 {
        let width = cell[1].min(self.from + self.length) - cell[0].max(self.from);
        if width > 0.0 && extinction != 0.0 { extinction * width } else { 0.0 }
    }

    /// The sum over cells of what `of` makes of the optical thickness by which each may vary.
    fn in_cells(self, cells: &CellsSpec, of: impl Fn(f64) -> f64) -> Expected {
        match cells {
            CellsSpec::Given { edges, minorants, majorants } => Exactly(
                edges
                    .windows(2)
                    .zip(minorants.iter().zip(majorants))
                    .map(|(cell, (least, most))| of(self.depth_in(cell, (most - least).max(0.0))))
                    .sum(),
            ),
            // No cell varies by more than the declared majorant.
            CellsSpec::Count(count) => {
                let count = f64::from(*count);
                Between(0.0, count * of(self.depth(self.upper_bound.unwrap_or(0.0)) / count))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::measure_plan;
    use crate::plan::{MediumLibrary, Plan};
    use crate::reference::Truth;
    use crate::spec::{Overrides, Request};
    use fairflight_media::Tolerance;

    /// What a spec promises for a ray of length 4 with σ_t between 0.2 and 1, and what 20 000 estimates look up.
    fn promised_and_found(estimator: &str) -> (Work, f64) {
        let spec = format!(
            r#"{{ "profile": {{ "kind": "piecewise_linear", "positions": [0, 1, 4], "sigma_t": [0.2, 1, 0.4] }},
                  "estimator": {estimator}, "samples": 20000, "seed": 1 }}"#
        );
        let Ok(Request::Single(experiment)) = Request::parse(&spec, Overrides::default()) else {
            panic!("{estimator}")
        };
        let plan = Plan::of(&experiment, &MediumLibrary::default()).unwrap();
        let truth = Truth::of(&plan.profile, Tolerance::TIGHT).unwrap();
        let found = measure_plan(&plan, &truth, &|_| ()).unwrap().lookups_per_sample;
        (Work::on(&plan.profile, &experiment.estimator), found)
    }

    #[test]
    fn what_is_promised_is_looked_up() {
        for (estimator, tolerance) in [
            (r#"{ "kind": "double_particle", "sigma_samp": 3 }"#, 0.01),
            (
                r#"{ "kind": "double_particle", "sigma_samp": { "edges": [0, 2, 9], "values": [1, 4] } }"#,
                0.01,
            ),
            (r#"{ "kind": "ray_marching", "steps": 7, "jitter": true }"#, 1e-12),
            (r#"{ "kind": "next_flight", "majorant": 2, "version": "ratio" }"#, 0.01),
            (r#"{ "kind": "next_flight", "majorant": 2, "version": "unidirectional" }"#, 0.01),
            (r#"{ "kind": "p_series", "version": "ratio", "pivot": 5 }"#, 0.02),
            (r#"{ "kind": "p_series", "version": "next_flight", "pivot": 5 }"#, 0.02),
            (r#"{ "kind": "p_series", "version": "cmf", "pivot": 40 }"#, 0.4),
            (r#"{ "kind": "generalised_poisson", "pivot": 2, "rate": 6 }"#, 0.01),
            (r#"{ "kind": "unbiased_ray_marching", "teeth": 9, "endpoint_matching": false }"#, 0.02),
            (r#"{ "kind": "unbiased_ray_marching", "teeth": 5, "segments": 6, "roulette": 0.3 }"#, 0.2),
            (
                r#"{ "kind": "telescoping", "teeth": 8, "level_ratio": 0.8, "endpoint_matching": false }"#,
                0.05,
            ),
            (r#"{ "kind": "jittered_ratio", "majorant": 1.5, "epsilon": 0.5 }"#, 0.02),
            (
                r#"{ "kind": "residual_cells", "rate": 2,
                     "cells": { "edges": [0, 1, 4], "minorants": [0, 0], "majorants": [2, 3] } }"#,
                0.02,
            ),
            (r#"{ "kind": "jackknife", "teeth": 6 }"#, 1e-12),
            (r#"{ "kind": "naive", "teeth": 6 }"#, 1e-12),
        ] {
            let (work, found) = promised_and_found(estimator);
            let Exactly(promised) = work.estimate else { panic!("{estimator}: {work:?}") };
            assert!((found / promised - 1.0).abs() <= tolerance, "{estimator}: {promised}, found {found}");
        }
        for estimator in [
            r#"{ "kind": "woodcock", "majorant": 2 }"#,
            r#"{ "kind": "single_particle", "version": "adaptive", "albedo": 0.5, "sigma_samp": 2 }"#,
            r#"{ "kind": "line_integral", "majorant": 2, "splits": 5 }"#,
            r#"{ "kind": "next_flight", "majorant": 2, "version": "delta" }"#,
            r#"{ "kind": "p_series", "version": "cumulative", "pivot": 4 }"#,
            r#"{ "kind": "unbiased_ray_marching", "teeth": 4, "roulette": "self_tuned",
                 "endpoint_matching": false }"#,
            r#"{ "kind": "jittered_ratio", "cells": 5, "epsilon": 0.5 }"#,
            r#"{ "kind": "residual_cells", "cells": 5 }"#,
            r#"{ "kind": "adaptive_ratio", "majorant": 2, "floor": 0.1 }"#,
            r#"{ "kind": "hybrid", "majorant": 2 }"#,
            r#"{ "kind": "progressive_majorant", "start": 0.5 }"#,
        ] {
            let (work, found) = promised_and_found(estimator);
            let Between(least, most) = work.estimate else { panic!("{estimator}: {work:?}") };
            assert!(least <= found && found <= 1.01 * most, "{estimator}: {least} to {most}, found {found}");
        }
    }

    #[test]
    fn rates_beyond_all_numbers_are_infinite_and_never_none() {
        let ray = RayKnown { from: 0.0, length: 1e305, upper_bound: None, breakpoints: 0 };
        assert_eq!((ray.depth(0.0), ray.depth(1e10)), (0.0, f64::INFINITY));
        assert_eq!(strata(f64::INFINITY, 0.5), f64::INFINITY);
        let nowhere = RayKnown { length: 0.0, ..ray };
        assert_eq!(nowhere.depth(f64::MAX), 0.0);
        assert_eq!(strata(0.0, 1e-300), 1.0);
        let work = Work { preparation: f64::INFINITY, estimate: Exactly(0.0), key: "estimator" };
        assert_eq!(work.total(1, 0.0), f64::INFINITY);
    }
}
