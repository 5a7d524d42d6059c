//! Free flights with an arbitrary sampling extinction: the single particle model up to its first scattering
//! (szirmay-kalos-2017 eq. 9 and 12).

use crate::theory::{HIGHEST_MOMENT, Moments, lookups_of_a_walk};
use crate::weight_law::Along;
use crate::{ClosedForm, Flight, FreeFlight, WeightLaw};
use fairflight_collision::{
    Albedo, AlbedoError, CollisionModel, Outcome, SingleOutcome, SingleParticle, Version,
};
use fairflight_media::{Extinction, InvertOpticalThickness, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// Flies through σ_samp; at each interaction point the single particle model either scatters, and the flight has
/// collided, or transmits, and the flight goes on with another weight.
///
/// ```text
/// E = 1; s = 0
/// repeat  s += free flight of sigma_samp                                      (eq. 4)
///         stop when s > length: escaped with the weight E
///         r = sigma_t(s) / sigma_samp(s)                                      (eq. 6)
///         with probability q_scat: collided at s with the weight E r / q_scat
///         else: E *= (1 − r) / q_tran                                         (eq. 9)
/// ```
///
/// The albedo is 1 here: a flight ends where it meets matter, and what matter then does with it is the business of a walk.
/// With albedo 1 nothing is absorbed: q_scat + q_tran = |r| + |1 − r| ≥ 1, and where it is 1 the sum is exactly 1 in
/// floating point too. (For r ≥ 1/2 the difference 1 − r is exact; for r < 1/2 it has an error of at most 2^-54, which
/// the addition of r rounds away.)
///
/// **Law.** In \[s, s + ds) a flight of weight E collides with probability σ_samp q_scat ds, scoring E r/q_scat = E σ_t ds on
/// average, and goes on with E (1 − σ_t ds) on average: the expected weight of the flights still under way is T(s), that of
/// collisions σ_t T ds. Unbiased for every σ_samp that is positive wherever σ_t ≠ 0; a σ_samp of 0 elsewhere is a silent
/// bias. σ_t may be negative: E and the weights of collisions then have the signs that σ_t asks for.
///
/// **Moments.** With W_scat, W_tran the weights of the two branches and M_k(s) = exp(∫_0^s σ_samp (E\[W_tran^k\] − 1)),
///
/// > E\[weight^k; collided\] = ∫ σ_samp E\[W_scat^k\] M_k ds,   E\[weight^k; escaped\] = M_k(length).
///
/// All versions: 0 ≤ r ≤ 1 gives weights of 1, Woodcock tracking. Elsewhere one collision multiplies the weight by
/// |r| + |1 − r| > 1 and, for r > 1, transmission changes its sign: E\[W_tran²\] = (r − 1)(2r − 1) exceeds 1 from r = 3/2 on.
///
/// **Cost.** ∫ σ_samp exp(−∫_0^s σ_samp (1 − q_tran)) ds look-ups; one at a collision, and before it a Poisson number of
/// mean ∫ σ_samp q_tran.
///
/// **Domain.** Non-terminating and adaptive: every σ_t where σ_samp > 0, and σ_t = 0 where σ_samp = 0. Terminating:
/// 0 ≤ r ≤ 2/(1 + 1) = 1.
///
/// The weight is a plain product. No factor is below 1 in magnitude, so that no partial product exceeds the weight that is
/// returned: what overflows on the way is no number in the end either.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracking<R> {
    model: SingleParticle,
    sampling: R,
}

impl<R: InvertOpticalThickness> Tracking<R> {
    /// Tracking by `version` of the single particle model with the sampling extinction `sampling`, which covers the profile
    /// to be sampled and no more.
    pub fn new(version: Version, sampling: R) -> Self {
        let albedo: Result<Albedo, AlbedoError> = Albedo::new(1.0);
        let model = SingleParticle { version, albedo: albedo.expect("1 is an albedo") };
        Self { model, sampling }
    }

    /// The sampling extinction.
    pub fn sampling(&self) -> &R {
        &self.sampling
    }

    /// The collision model, with albedo 1.
    pub fn model(&self) -> &SingleParticle {
        &self.model
    }

    /// σ_samp and r where a collision can happen, `None` where σ_samp = 0.
    #[inline]
    fn at(&self, s: f64, sigma_t: f64) -> Option<(f64, f64)> {
        let sampling = self.sampling.sigma_t(s);
        (sampling > 0.0).then(|| (sampling, sigma_t / sampling))
    }

    /// d ln M_k/ds for k = 1 … 8.
    fn growth(&self, s: f64, sigma_t: f64) -> Moments {
        let Some((sampling, r)) = self.at(s, sigma_t) else { return [0.0; HIGHEST_MOMENT] };
        let transmitted = self.model.transmitted(r);
        std::array::from_fn(|i| sampling * (transmitted.moment(i as i32 + 1) - 1.0))
    }

    /// Functions along the ray whose zeros are the places at which the moments of a collision are not smooth in r.
    fn kinks<F>(&self) -> Vec<Along<'_, F, f64>> {
        let distance = |kink: f64| -> Along<'_, F, f64> {
            Box::new(move |_, s, sigma_t| self.at(s, sigma_t).map_or(1.0, |(_, r)| r - kink))
        };
        self.model.kinks().into_iter().map(distance).collect()
    }
}

impl<F: Extinction, R: InvertOpticalThickness> FreeFlight<F> for Tracking<R> {
    #[inline]
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        debug_assert_eq!(field.length(), self.sampling.length(), "prepared for another profile");
        let mut weight = 1.0;
        let mut s = 0.0;
        while let Some(next) = self.sampling.invert(s, source.next_exponential()) {
            s = next;
            let r = field.sigma_t(s) / self.sampling.sigma_t(s);
            match self.model.collide(r, source) {
                Outcome::Scattered(energy) => {
                    return Flight::Collided { distance: s, weight: weight * energy };
                }
                Outcome::Transmitted(energy) => weight *= energy,
                // With albedo 1 only an r that is no number gets here; the weight says so.
                Outcome::Absorbed => return Flight::Collided { distance: s, weight: r * f64::NAN },
            }
        }
        Flight::Escaped { weight }
    }

    #[inline]
    fn admits(&self, _field: &F, s: f64, sigma_t: f64) -> bool {
        match self.at(s, sigma_t) {
            Some((_, r)) => self.model.admits(r),
            None => sigma_t == 0.0,
        }
    }
}

impl<F: Extinction + Clone, R: InvertOpticalThickness> ClosedForm<F> for Tracking<R> {
    fn weights(&self) -> WeightLaw<'_, F> {
        WeightLaw::products(
            self.kinks(),
            |_, s, sigma_t| self.growth(s, sigma_t),
            |_, s, sigma_t| match self.at(s, sigma_t) {
                Some((sampling, r)) => {
                    let scattered = self.model.scattered(r);
                    std::array::from_fn(|i| sampling * scattered.moment(i as i32 + 1))
                }
                None => [0.0; HIGHEST_MOMENT],
            },
        )
    }

    fn lookups(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> Option<Moments> {
        self.weights().split_at_kinks(quadrature, tolerance);
        Some(lookups_of_a_walk(quadrature, tolerance, &|s, sigma_t| {
            let Some((sampling, r)) = self.at(s, sigma_t) else { return [0.0; 2] };
            [self.model.scattered(r).probability, self.model.transmitted(r).probability].map(|q| sampling * q)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{VERSIONS, constant};
    use approx::assert_relative_eq;
    use fairflight_media::PiecewiseConstant;
    use fairflight_sources::{LARGEST_VARIATE, Scripted};

    #[test]
    fn nothing_is_absorbed_at_albedo_one() {
        // The largest variate, at ratios that are no round numbers.
        for i in 0..10_000 {
            let r = f64::from(i) * 1.000_123e-4;
            let sampling = Tracking::new(Version::Terminating, constant(1.0));
            let outcome = sampling.model().collide(r.min(1.0), &mut Scripted::new([LARGEST_VARIATE]));
            assert_ne!(outcome, Outcome::Absorbed, "r = {r}");
        }
    }

    #[test]
    fn between_zero_and_one_all_versions_are_woodcock_s() {
        for version in VERSIONS {
            let tracking = Tracking::new(version, constant(2.0));
            let field = constant(0.7);
            let sample = |u: f64| tracking.sample(&field, &mut Scripted::new([0.5, u, 0.9]));
            assert_eq!(sample(0.34).weight(), 1.0);
            assert!(sample(0.34).distance().is_some());
            assert_eq!(sample(0.36), Flight::Escaped { weight: 1.0 });
        }
    }

    #[test]
    fn above_one_transmission_turns_the_sign() {
        // r = 2: q_scat = 2/3, q_tran = 1/3, energies ±3.
        let tracking = Tracking::new(Version::Adaptive, constant(0.5));
        let field = constant(1.0);
        let near = 0.1;
        let flight = tracking.sample(&field, &mut Scripted::new([near, 0.7, near, 0.6]));
        assert_relative_eq!(flight.weight(), -9.0, max_relative = 1e-15);
        let flight = tracking.sample(&field, &mut Scripted::new([near, 0.7, 0.9]));
        assert_eq!(flight, Flight::Escaped { weight: -3.0 });
    }

    /// The first moments are the law itself, by quadrature: for every version, rate and sign of the field.
    #[test]
    fn the_expected_weights_are_those_of_the_law() {
        let edges = || vec![0.0, 0.3, 1.0];
        for (version, values, sampling) in [
            (Version::Terminating, [1.0, 0.4], 1.0),
            (Version::NonTerminating, [1.0, 0.4], 0.6),
            (Version::Adaptive, [1.0, 0.4], 0.3),
            (Version::NonTerminating, [1.0, -0.5], 0.8),
            (Version::Adaptive, [-0.2, 0.5], 0.3),
        ] {
            let field = PiecewiseConstant::new(edges(), values.to_vec()).unwrap();
            let tracking = Tracking::new(version, constant(sampling));
            let mut quadrature = RayQuadrature::new(&field, &[]);
            let score = |s: f64| 1.0 + s * s;
            let law = quadrature.integrate_nested(
                Tolerance::TIGHT,
                |_, sigma_t| [sigma_t],
                |s, sigma_t, [tau]| [sigma_t * (-tau).exp() * score(s), (-tau).exp()],
            );
            let found = tracking.weights().collided(&mut quadrature, Tolerance::TIGHT, &score).value;
            assert_relative_eq!(found[0], law.value[0], max_relative = 1e-11);
            let tau = 0.3 * values[0] + 0.7 * values[1];
            let escaped = tracking.weights().escaped(&mut quadrature, Tolerance::TIGHT);
            assert_relative_eq!(escaped[0], (-tau).exp(), max_relative = 1e-12);
        }
    }

    #[test]
    fn the_second_moment_of_a_constant_field_below_the_extinction() {
        // sigma_t 1, sigma_samp 0.5, r = 2: E[W_tran²] = 3, E[W_scat²] = 6; M_2 = e^s.
        let mut quadrature = RayQuadrature::new(constant(1.0), &[]);
        let tracking = Tracking::new(Version::NonTerminating, constant(0.5));
        let collided = tracking.weights().collided(&mut quadrature, Tolerance::TIGHT, &|_| 1.0).value[1];
        assert_relative_eq!(collided, 3.0 * 1.0_f64.exp_m1(), max_relative = 1e-12);
        let escaped = tracking.weights().escaped(&mut quadrature, Tolerance::TIGHT)[1];
        assert_relative_eq!(escaped, 1.0_f64.exp(), max_relative = 1e-12);
        // Two thirds of the collisions end the flight: 0.5 ∫ exp(−s/3).
        let lookups = tracking.lookups(&mut quadrature, Tolerance::TIGHT).unwrap();
        assert_relative_eq!(lookups[0], 1.5 * -(-1.0_f64 / 3.0).exp_m1(), max_relative = 1e-12);
    }

    #[test]
    fn a_value_that_is_no_number_is_not_hidden() {
        struct Hole;
        impl Extinction for Hole {
            fn sigma_t(&self, _s: f64) -> f64 {
                f64::NAN
            }
            fn length(&self) -> f64 {
                1.0
            }
        }
        for version in VERSIONS {
            let flight =
                Tracking::new(version, constant(1.0)).sample(&Hole, &mut Scripted::new([0.1, 0.5, 0.9]));
            assert!(flight.weight().is_nan(), "{version:?}: {flight:?}");
        }
    }

    /// r = σ_t/σ_samp passes 1 at s = 0.37, between the nodes of any panel that does not end there: told or found, the moments are the same.
    #[test]
    fn kinks_are_found() {
        let field = fairflight_media::PiecewiseLinear::new(vec![0.0, 1.0], vec![0.0, 1.0]).unwrap();
        for version in [Version::NonTerminating, Version::Adaptive] {
            let tracking = Tracking::new(version, constant(0.37));
            let moments = |told: &[f64]| {
                let mut quadrature = RayQuadrature::new(&field, told);
                let collided = tracking.weights().collided(&mut quadrature, Tolerance::TIGHT, &|_| 1.0).value;
                (collided, tracking.weights().escaped(&mut quadrature, Tolerance::TIGHT))
            };
            let (found, told) = (moments(&[]), moments(&[0.37]));
            for k in 0..4 {
                assert_relative_eq!(found.0[k], told.0[k], max_relative = 1e-12);
                assert_relative_eq!(found.1[k], told.1[k], max_relative = 1e-12);
            }
        }
    }
}
