//! Laws of one step, judged without a chain: independent states, no start-up, one mutation at a time.
//!
//! A step keeps the target f if E\[W a (g(Y) − g(X))\] = 0 for every bounded g, where X is drawn with any density p > 0 where f > 0, W =
//! f/p, and Y is what is proposed for X and accepted with the probability a. It is reversible if E\[W a h(X, Y)\] = 0 for every antisymmetric
//! h, of which g(Y) − g(X) is one; here also h = g(Y) g'(X) − g(X) g'(Y).
//!
//! Samples are independent, so that the errors of means are those of their variances, as of any estimator.

pub mod modes;

use crate::{Mutation, acceptance};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::family::sidak_level;
use fairflight_stats::{Moments, Reference, Verdict, judge};
use std::fmt;

/// A bounded function of a state.
pub type Probe<'p, X> = &'p dyn Fn(&X) -> f64;

/// Functions of a state by which a step is judged.
///
/// A function that the mutation leaves as it is has a drift of 0 but for rounding, whose sign may be the same each time: it is named as one of `kept`, and
/// serves as g' only.
pub struct Probes<'p, X> {
    /// Functions that change.
    pub moved: &'p [Probe<'p, X>],
    /// Functions that the mutation leaves as they are, by its algebra.
    pub kept: &'p [Probe<'p, X>],
}

impl<X> Clone for Probes<'_, X> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<X> Copy for Probes<'_, X> {}

impl<X> fmt::Debug for Probes<'_, X> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (moved, kept) = (self.moved.len(), self.kept.len());
        formatter.debug_struct("Probes").field("moved", &moved).field("kept", &kept).finish()
    }
}

/// Result of independent steps for one antisymmetric function.
#[derive(Clone, Debug)]
pub struct Drift {
    /// Indices of g and g', those of `kept` behind those of `moved`; without g' the function is g(Y) − g(X).
    pub probes: (usize, Option<usize>),
    /// E\[W a h\]/E\[W a |h|\], at most 1.
    pub relative: f64,
    /// z-score of the mean; 0 where nothing moved.
    pub z: f64,
    /// Judgement, relative to E\[W a |h|\] of a pilot.
    pub verdict: Verdict,
}

/// Result of independent steps of a mutation.
#[derive(Clone, Debug)]
pub struct Judged {
    /// E\[W a\]/E\[W\]: the share of steps of a stationary chain that are accepted.
    pub acceptance: f64,
    /// One of each antisymmetric function.
    pub drifts: Vec<Drift>,
}

impl Judged {
    /// The drift with the greatest |z|.
    ///
    /// # Panics
    /// If there were no probes.
    #[must_use]
    pub fn worst(&self) -> &Drift {
        self.drifts
            .iter()
            .max_by(|a, b| a.z.abs().total_cmp(&b.z.abs()))
            .expect("there is a probe that moves")
    }

    /// True if some function is rejected.
    #[must_use]
    pub fn is_rejected(&self) -> bool {
        self.drifts.iter().any(|drift| drift.verdict.sound == Some(false))
    }

    /// True if no function is rejected, and all would have shown a relative drift of `detectable` with a probability of 0.99.
    #[must_use]
    pub fn agrees_within(&self, detectable: f64) -> bool {
        let reach = |drift: &Drift| drift.verdict.detectable_relative_bias.unwrap_or(f64::INFINITY);
        !self.is_rejected() && self.drifts.iter().all(|drift| reach(drift) <= detectable)
    }
}

/// Number, seed and level of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// Independent samples; the pilot has a quarter of them besides.
    pub samples: u64,
    /// Seed of all streams of the run.
    pub seed: u64,
    /// False alarm of all functions together.
    pub alpha: f64,
}

impl Steps {
    /// Judges `mutation` by independent samples: each call of `sample` shows any number of states with their weights f/p to the function
    /// that it is given, of which the sum counts as one sample.
    ///
    /// A drift is measured in units of E\[W a |h|\]: the pilot's estimate of that is added to each sample, so that the power of the test
    /// is told as a relative bias.
    pub fn judge<X: Default>(
        &self,
        probes: Probes<'_, X>,
        mut sample: impl FnMut(&mut Seeded, &mut dyn FnMut(&X, f64, &mut Seeded)),
        mutation: &mut dyn Mutation<X>,
    ) -> Judged {
        let all: Vec<Probe<'_, X>> = probes.moved.iter().chain(probes.kept).copied().collect();
        let pairs: Vec<(usize, Option<usize>)> = (0..probes.moved.len())
            .flat_map(|g| (g + 1..all.len()).map(Some).chain([None]).map(move |other| (g, other)))
            .collect();
        let mut y = X::default();
        let mut values = vec![[0.0; 2]; all.len()];
        let mut weights = [0.0; 2];
        let mut run = |seed: u64, samples: u64, each: &mut dyn FnMut(&[[f64; 2]])| {
            let mut source = Seeded::new(seed);
            let mut sums = vec![[0.0; 2]; pairs.len()];
            for _ in 0..samples {
                sums.fill([0.0; 2]);
                sample(&mut source, &mut |x, weight, source| {
                    let accepted = weight * acceptance(mutation.propose(x, &mut y, source));
                    weights[0] += weight;
                    weights[1] += accepted;
                    if accepted == 0.0 {
                        return;
                    }
                    for (value, probe) in values.iter_mut().zip(&all) {
                        *value = [probe(x), probe(&y)];
                    }
                    for (sum, &(g, other)) in sums.iter_mut().zip(&pairs) {
                        let [from, to] = values[g];
                        let [other_from, other_to] = other.map_or([1.0; 2], |other| values[other]);
                        let drift = accepted * (to * other_from - from * other_to);
                        *sum = [sum[0] + drift, sum[1] + drift.abs()];
                    }
                });
                each(&sums);
            }
        };
        let mut scales = vec![0.0; pairs.len()];
        let pilot = (self.samples / 4).max(1);
        run(derive_seed(self.seed, 1), pilot, &mut |sums| {
            for (scale, [_, size]) in scales.iter_mut().zip(sums) {
                *scale += size / pilot as f64;
            }
        });
        let mut moments = vec![(Moments::new(), 0.0); pairs.len()];
        run(derive_seed(self.seed, 2), self.samples, &mut |sums| {
            for (((moments, moved), scale), [drift, size]) in moments.iter_mut().zip(&scales).zip(sums) {
                moments.push(scale + drift);
                *moved += size / self.samples as f64;
            }
        });
        let level = sidak_level(self.alpha, pairs.len());
        let drifts = pairs.iter().zip(&moments).zip(&scales).map(|((&probes, (moments, moved)), &scale)| {
            let verdict = judge(moments, &Reference::exact(scale).with_mild_tails(), level);
            let drift = moments.mean().unwrap_or(scale) - scale;
            let relative = if *moved > 0.0 { drift / moved } else { 0.0 };
            Drift { probes, relative, z: verdict.mean_z.unwrap_or(0.0), verdict }
        });
        Judged { drifts: drifts.collect(), acceptance: weights[1] / weights[0] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_sources::UniformSource;

    /// x → x e^(±ε), a symmetric move of ln x with J = x, and a part of that Jacobian. Target x on (0, 1).
    struct Scaled {
        power: f64,
    }

    impl Mutation<f64> for Scaled {
        fn propose(&mut self, x: &f64, y: &mut f64, source: &mut dyn UniformSource) -> Option<f64> {
            *y = x * (source.next_uniform() - 0.5).exp();
            (*y < 1.0).then(|| (1.0 + self.power) * (*y / x).ln())
        }
    }

    /// x → x + 1/3 mod 1: keeps a uniform target, and is not reversible.
    struct Turning;

    impl Mutation<f64> for Turning {
        fn propose(&mut self, x: &f64, y: &mut f64, _source: &mut dyn UniformSource) -> Option<f64> {
            *y = (x + 1.0 / 3.0).fract();
            Some(0.0)
        }
    }

    fn judged(target: impl Fn(f64) -> f64, mutation: &mut dyn Mutation<f64>) -> Judged {
        let probes = Probes::<f64> { moved: &[&|x| *x, &|x| (7.0 * x).cos()], kept: &[] };
        let steps = Steps { samples: 20_000, seed: 1, alpha: 1e-6 };
        steps.judge(
            probes,
            |source, each| {
                let x = source.next_uniform();
                each(&x, target(x), source);
            },
            mutation,
        )
    }

    #[test]
    fn a_step_that_keeps_its_target_agrees() {
        let judged = judged(|x| x, &mut Scaled { power: 1.0 });
        assert!(judged.agrees_within(0.15), "{:#?}", judged.drifts);
        assert_eq!(judged.drifts.len(), 3);
        // E[x a]/E[x], by quadrature over the step: a = min(1, e^(2 s)) where x e^s < 1.
        let mean = |f: &dyn Fn(f64) -> f64| {
            (0..10_000).map(|i| f((f64::from(i) + 0.5) / 10_000.0)).sum::<f64>() / 1e4
        };
        let inside = |s: f64| (-2.0 * s.max(0.0)).exp();
        let expected = mean(&|u| inside(u - 0.5) * (2.0 * (u - 0.5)).min(0.0).exp());
        assert!((judged.acceptance - expected).abs() < 0.01, "{} {expected}", judged.acceptance);
    }

    #[test]
    fn a_jacobian_left_out_is_found() {
        let judged = judged(|x| x, &mut Scaled { power: 0.0 });
        assert!(judged.is_rejected() && judged.worst().z.abs() > 8.5, "{:?}", judged.worst());
    }

    #[test]
    fn a_step_that_is_not_reversible_is_found_though_it_keeps_its_target() {
        let judged = judged(|_| 1.0, &mut Turning);
        let stationary = |drift: &&Drift| drift.probes.1.is_none();
        assert!(judged.drifts.iter().filter(stationary).all(|drift| drift.verdict.sound == Some(true)));
        assert!(judged.is_rejected());
    }
}
