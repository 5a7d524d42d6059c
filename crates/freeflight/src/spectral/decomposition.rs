//! Decomposition tracking: a control in closed form races with what is left of the field (kutz-2017).

use crate::theory::{Moments, lookups_of_a_race};
use crate::weight_law::Along;
use crate::{ClosedForm, Flight, FreeFlight, WeightLaw};
use fairflight_collision::{
    Albedo, AlbedoError, CollisionModel, Outcome, SingleOutcome, SingleParticle, Version,
};
use fairflight_media::{
    Extinction, InvertOpticalThickness, RayQuadrature, Tolerance, rounding_of_difference,
};
use fairflight_sources::UniformSource;

/// The nearer of two flights: one through a control c(s) ≥ 0 by inversion, one through the residual σ_t − c by tracking with
/// the sampling extinction σ_samp. The second is abandoned where it passes the first.
///
/// **Law.** Matter is the union of two independent Poisson processes, of rate c and σ_t − c, whose first point is the first
/// of either. Where σ_t < c the residual is negative and its flight carries a weight, by the single particle model
/// (szirmay-kalos-2017 eq. 9), of either sign: a collision with the control then counts too much, one with the residual takes
/// that away. With ρ = (σ_t − c)/σ_samp the expected weight of a flight under way changes by −c − σ_samp + σ_samp (1 − ρ) = −σ_t
/// per length, and that of a collision is (c + σ_samp ρ) = σ_t times it: unbiased for any control and any σ_samp that is
/// positive where σ_t ≠ c.
///
/// **Moments.** M_k(s) = exp(∫_0^s −c + σ_samp (E\[W_tran^k\] − 1)),
///
/// > E\[weight^k; collided\] = ∫ (c + σ_samp E\[W_scat^k\]) M_k ds,   E\[weight^k; escaped\] = M_k(length).
///
/// Where c ≤ σ_t ≤ c + σ_samp all weights are 1. Where σ_t < c the second grows by −c + 3 (c − σ_t) + 2 (c − σ_t)²/σ_samp per
/// length: a residual of either sign wants a generous σ_samp.
///
/// **Cost.** ∫ σ_samp(s) P(still under way at s) ds, that is ∫ σ_samp T where weights are 1: against ∫ majorant T of Woodcock tracking,
/// with σ_samp = majorant − c. A flight that ends at the control's collision before its first tentative one costs nothing.
///
/// **Domain.** As [`crate::Tracking`], with ρ for r: every σ_t where σ_samp > 0, σ_t = c where σ_samp = 0; the terminating
/// version 0 ≤ ρ ≤ 1 only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DecompositionTracking<C, R> {
    control: C,
    sampling: R,
    model: SingleParticle,
}

impl<C: InvertOpticalThickness, R: InvertOpticalThickness> DecompositionTracking<C, R> {
    /// A `control` and the sampling extinction of what is left, both of the profile to be sampled and no more;
    /// `version` of the single particle model weighs a residual that is no density of matter.
    pub fn new(version: Version, control: C, sampling: R) -> Self {
        debug_assert_eq!(control.length(), sampling.length(), "made for two profiles");
        let albedo: Result<Albedo, AlbedoError> = Albedo::new(1.0);
        let model = SingleParticle { version, albedo: albedo.expect("1 is an albedo") };
        Self { control, sampling, model }
    }

    /// c, σ_samp and ρ, the last 0 where nothing is sampled.
    #[inline]
    fn at(&self, s: f64, sigma_t: f64) -> (f64, f64, f64) {
        let (control, sampling) = (self.control.sigma_t(s), self.sampling.sigma_t(s));
        (control, sampling, if sampling > 0.0 { (sigma_t - control) / sampling } else { 0.0 })
    }

    /// d ln M_k/ds.
    fn growth(&self, s: f64, sigma_t: f64) -> Moments {
        let (control, sampling, ratio) = self.at(s, sigma_t);
        let transmitted = self.model.transmitted(ratio);
        std::array::from_fn(|i| sampling * (transmitted.moment(i as i32 + 1) - 1.0) - control)
    }

    /// Where the moments of a collision are not smooth in ρ.
    fn kinks<F>(&self) -> Vec<Along<'_, F, f64>> {
        let distance = |kink: f64| -> Along<'_, F, f64> {
            Box::new(move |_, s, sigma_t| {
                let (_, sampling, ratio) = self.at(s, sigma_t);
                if sampling > 0.0 { ratio - kink } else { 1.0 }
            })
        };
        self.model.kinks().into_iter().map(distance).collect()
    }
}

impl<F: Extinction, C: InvertOpticalThickness, R: InvertOpticalThickness> FreeFlight<F>
    for DecompositionTracking<C, R>
{
    #[inline]
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        debug_assert_eq!(field.length(), self.sampling.length(), "prepared for another profile");
        let control = self.control.invert(0.0, source.next_exponential());
        let end = control.unwrap_or(f64::INFINITY);
        let (mut weight, mut s) = (1.0, 0.0);
        while let Some(next) = self.sampling.invert(s, source.next_exponential()) {
            if next >= end {
                break;
            }
            s = next;
            let ratio = (field.sigma_t(s) - self.control.sigma_t(s)) / self.sampling.sigma_t(s);
            match self.model.collide(ratio, source) {
                Outcome::Scattered(energy) => {
                    return Flight::Collided { distance: s, weight: weight * energy };
                }
                Outcome::Transmitted(energy) => weight *= energy,
                // With albedo 1 only a ratio that is no number gets here; the weight says so.
                Outcome::Absorbed => return Flight::Collided { distance: s, weight: ratio * f64::NAN },
            }
        }
        match control {
            Some(distance) => Flight::Collided { distance, weight },
            None => Flight::Escaped { weight },
        }
    }

    #[inline]
    fn admits(&self, _field: &F, s: f64, sigma_t: f64) -> bool {
        let (control, sampling, ratio) = self.at(s, sigma_t);
        let rounding = rounding_of_difference(sigma_t, control);
        if sampling > 0.0 {
            // A domain that ends at the control, or σ_samp above it, holds what rounding carried over its end.
            return self.model.admits(ratio)
                || [-1.0, 1.0].iter().any(|side| self.model.admits(ratio + side * rounding / sampling));
        }
        (sigma_t - control).abs() <= rounding
    }
}

impl<F: Extinction + Clone, C: InvertOpticalThickness, R: InvertOpticalThickness> ClosedForm<F>
    for DecompositionTracking<C, R>
{
    fn weights(&self) -> WeightLaw<'_, F> {
        WeightLaw::products(
            self.kinks(),
            |_, s, sigma_t| self.growth(s, sigma_t),
            |_, s, sigma_t| {
                let (control, sampling, ratio) = self.at(s, sigma_t);
                let scattered = self.model.scattered(ratio);
                std::array::from_fn(|i| control + sampling * scattered.moment(i as i32 + 1))
            },
        )
    }

    fn lookups(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> Option<Moments> {
        self.weights().split_at_kinks(quadrature, tolerance);
        Some(lookups_of_a_race(quadrature, tolerance, &|s, sigma_t| {
            let (control, sampling, ratio) = self.at(s, sigma_t);
            let [ends, passes] =
                [self.model.scattered(ratio), self.model.transmitted(ratio)].map(|branch| branch.probability);
            [control, sampling * ends, sampling * passes]
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{VERSIONS, assert_law, constant};
    use approx::assert_relative_eq;
    use fairflight_media::PiecewiseConstant;
    use fairflight_sources::Scripted;

    #[test]
    fn the_nearer_of_both_flights() {
        for version in VERSIONS {
            let tracking = DecompositionTracking::new(version, constant(0.5), constant(0.5));
            let field = constant(0.75);
            // The control collides at 0.446, the residual at 0.211 (ratio 1/2) or not at all.
            let sample = |u: f64| tracking.sample(&field, &mut Scripted::new([0.2, 0.1, u, 0.9]));
            assert_relative_eq!(sample(0.49).distance().unwrap(), -2.0 * 0.9_f64.ln(), max_relative = 1e-14);
            assert_relative_eq!(sample(0.51).distance().unwrap(), -2.0 * 0.8_f64.ln(), max_relative = 1e-14);
            assert_eq!([sample(0.49).weight(), sample(0.51).weight()], [1.0; 2]);
        }
    }

    #[test]
    fn where_the_control_is_all_there_is_no_look_up() {
        let tracking = DecompositionTracking::new(Version::Adaptive, constant(0.5), constant(0.0));
        assert!(tracking.admits(&constant(0.5), 0.3, 0.5) && !tracking.admits(&constant(0.5), 0.3, 0.6));
        let flight = tracking.sample(&constant(0.5), &mut Scripted::new([0.2, 0.9]));
        assert_relative_eq!(flight.distance().unwrap(), -2.0 * 0.8_f64.ln(), max_relative = 1e-14);
    }

    /// The first moments are the law itself: for a control below, above and on both sides of the field.
    #[test]
    fn the_expected_weights_are_those_of_the_law() {
        let field = PiecewiseConstant::new(vec![0.0, 0.3, 1.0], vec![1.0, 0.4]).unwrap();
        for (version, control, sampling) in [
            (Version::Terminating, 0.4, 0.6),
            (Version::NonTerminating, 0.8, 0.5),
            (Version::Adaptive, 1.2, 0.7),
            (Version::Adaptive, 0.1, 0.4),
        ] {
            let tracking = DecompositionTracking::new(version, constant(control), constant(sampling));
            assert_law(&field, &tracking, 0.58);
        }
    }

    /// A control of 1 on a field of 1/2: −c + 3 (c − σ) + 2 (c − σ)²/σ_samp = −1 + 3/2 + 1/2.
    #[test]
    fn the_second_moment_of_a_control_above_the_field() {
        let tracking = DecompositionTracking::new(Version::NonTerminating, constant(1.0), constant(1.0));
        let mut quadrature = RayQuadrature::new(constant(0.5), &[]);
        let escaped = tracking.weights().escaped(&mut quadrature, Tolerance::TIGHT)[1];
        assert_relative_eq!(escaped, 1.0_f64.exp(), max_relative = 1e-12);
    }

    #[test]
    fn expected_look_ups_are_those_of_the_residual() {
        let tracking = DecompositionTracking::new(Version::Adaptive, constant(0.5), constant(0.5));
        let mut quadrature = RayQuadrature::new(constant(0.75), &[]);
        let lookups = tracking.lookups(&mut quadrature, Tolerance::TIGHT).unwrap();
        // 0.5 ∫ exp(−3 s/4).
        assert_relative_eq!(lookups[0], 0.5 / 0.75 * -(-0.75_f64).exp_m1(), max_relative = 1e-12);
    }
}
