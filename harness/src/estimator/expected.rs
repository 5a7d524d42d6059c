//! Expected look-ups of an estimator, from the rates of its spec, before it is built.

use super::{CellsSpec, EstimatorSpec, SamplingSpec};
use crate::field::AnyProfile;

/// Look-ups of an estimator on one ray. An infinite number is lawful, and too many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// Look-ups of all that is done once before the first estimate.
    pub preparation: f64,
    /// The part of it that a scene does anew for each ray.
    pub on_each_ray: f64,
    /// Look-ups of one estimate, on average.
    pub estimate: Expected,
    /// The key of the spec that they come from.
    pub key: &'static str,
}

/// An expected number of look-ups.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// The same on every profile.
    Exactly(f64),
    /// At least the first number and at most the second, which holds where nothing ends a walk; between them only the closed form tells.
    Between(f64, f64),
}

/// Known facts about a ray: `from` its entry \[length\], over `length`, σ_t at most `upper_bound` where one is
/// declared, smooth but in `breakpoints` places.
#[derive(Clone, Copy, Debug)]
pub struct RayKnown {
    /// The distance of its start from the origin in which edges are given.
    pub from: f64,
    /// Length of the ray \[length\].
    pub length: f64,
    /// The declared majorant.
    pub upper_bound: Option<f64>,
    /// Pieces that a closed form has to add up, less one.
    pub breakpoints: usize,
}

impl Expected {
    /// The number, or its upper bound.
    #[must_use]
    pub fn most(self) -> f64 {
        match self {
            Self::Exactly(lookups) | Self::Between(_, lookups) => lookups,
        }
    }

    /// The number, or its lower bound.
    #[must_use]
    pub fn least(self) -> f64 {
        match self {
            Self::Exactly(lookups) | Self::Between(lookups, _) => lookups,
        }
    }
}

impl Work {
    /// Look-ups of estimates alone, from a key of the spec.
    pub(super) fn of(key: &'static str, estimate: Expected) -> Self {
        Self { preparation: 0.0, on_each_ray: 0.0, estimate, key }
    }

    /// The same work with so many look-ups before the first estimate.
    pub(super) fn after(self, preparation: f64) -> Self {
        Self { preparation, ..self }
    }

    /// The same work with so many look-ups before the first estimate, of each ray where there are many.
    pub(super) fn after_on_each_ray(self, lookups: f64) -> Self {
        Self { preparation: lookups, on_each_ray: lookups, ..self }
    }

    /// The work of an estimator on a profile.
    #[must_use]
    pub fn on(profile: &AnyProfile, spec: &EstimatorSpec) -> Self {
        let (field, from, length) = (profile.field(), profile.entry_distance(), profile.length());
        let (upper_bound, breakpoints) = (field.knowledge().upper_bound, field.breakpoints().len());
        spec.kind().work(RayKnown { from, length, upper_bound, breakpoints })
    }

    /// The look-ups of so many estimates, each with so many look-ups of its own; one that looks up nothing costs as much as
    /// one that does once.
    #[must_use]
    pub fn total(&self, estimates: u64, lookups: f64) -> f64 {
        self.preparation + estimates as f64 * lookups.max(1.0)
    }
}

impl RayKnown {
    /// The optical thickness of an extinction; 0 where either factor is, be the other infinite.
    pub(super) fn depth(self, extinction: f64) -> f64 {
        if extinction == 0.0 || self.length == 0.0 { 0.0 } else { extinction * self.length }
    }

    pub(super) fn sampled(self, sampling: &SamplingSpec) -> f64 {
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

    /// The optical thickness of the declared majorant, 0 at least; 0 without one.
    pub(super) fn declared_depth(self) -> f64 {
        self.depth(self.upper_bound.unwrap_or(0.0).max(0.0))
    }

    /// The sum over cells of what `of` makes of the optical thickness by which each may vary.
    pub(super) fn in_cells(self, cells: &CellsSpec, of: impl Fn(f64) -> f64) -> Expected {
        match cells {
            CellsSpec::Given { edges, minorants, majorants } => Expected::Exactly(
                edges
                    .windows(2)
                    .zip(minorants.iter().zip(majorants))
                    .map(|(cell, (least, most))| of(self.depth_in(cell, (most - least).max(0.0))))
                    .sum(),
            ),
            // No cell varies by more than the declared majorant.
            CellsSpec::Count(count) => {
                let count = f64::from(*count);
                Expected::Between(0.0, count * of(self.declared_depth() / count))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Expected::{Between, Exactly};
    use super::*;
    use crate::estimator::jittered_ratio::strata;
    use crate::experiment::measure_plan;
    use crate::field::MediumLibrary;
    use crate::plan::Plan;
    use crate::reference::Truth;
    use crate::spec::{Overrides, Request};
    use fairflight_media::Tolerance;

    /// Expected work by a spec for a ray of length 4 with σ_t between 0.2 and 1, and the look-ups per sample of 20 000 estimates.
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

    /// The rule for teeth takes no negative optical thickness.
    #[test]
    fn a_bound_below_0_promises_the_work_of_a_vacuum() {
        for estimator in [r#"{ "kind": "unbiased_ray_marching" }"#, r#"{ "kind": "hybrid" }"#] {
            let work = |sigma_t: f64| {
                let spec = format!(
                    r#"{{ "profile": {{ "kind": "constant", "sigma_t": {sigma_t}, "length": 1 }},
                          "estimator": {estimator}, "samples": 1, "seed": 1 }}"#
                );
                let Ok(Request::Single(experiment)) = Request::parse(&spec, Overrides::default()) else {
                    panic!("{estimator}")
                };
                let profile = experiment.profile.kind().build(&MediumLibrary::default()).unwrap();
                Work::on(&profile, &experiment.estimator).estimate.most()
            };
            assert_eq!(work(-0.1), work(0.0));
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
        let work =
            Work { preparation: f64::INFINITY, on_each_ray: 0.0, estimate: Exactly(0.0), key: "estimator" };
        assert_eq!(work.total(1, 0.0), f64::INFINITY);
    }
}
