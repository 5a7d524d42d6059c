//! Debiasing by a telescoping sum of nested combs (misso-2022; blanchet-2015).

use super::{Comb, CombShape, NoTeeth, Prepared};
use crate::TransmittanceEstimator;
use fairflight_elementary::{exp, exp_m1, exp2, ln, sinh};
use fairflight_media::Extinction;
use fairflight_sources::UniformSource;

/// exp(−X) of a comb of k teeth, and the difference that a comb of 2^l k teeth makes, at a random level l.
///
/// With T_l = exp(−X) of a comb of 2^l k teeth, E\[T_l\] → T, and T = E\[T_0\] + Σ_{l≥1} E\[T_l − T_{l−1}\]. Level l
/// is drawn with p_l = r (1 − r)^l, and only its difference is computed:
///
/// > T̂ = T_0 + Δ_l/p_l (Δ_0 = 0).
///
/// One comb of 2^l k teeth with the variate u contains 2^l combs of k teeth (variates (u + a)/2^l), over which T_0 is
/// averaged, and two of 2^{l−1} k teeth, the even and the odd ones. With X_even and X_odd their thicknesses, that of
/// all is their mean, and
///
/// > Δ_l = e^{−X} − (e^{−X_even} + e^{−X_odd})/2 = −2 e^{−X} sinh²((X_odd − X_even)/4):
///
/// never positive, and without cancellation at any level. Bernoulli's multiplication theorem, mean_a B_n((u + a)/N) =
/// B_n(u)/N^n, makes corrected combs nest as uniform ones do.
///
/// **Law.** Unbiased for every r in (0, 1) on a profile whose Riemann sums converge. The published codes stop at a
/// level of 4, a bias (1e-5 on the seed ray), and draw the level from one variate, whose lattice ends the levels in
/// its own way; here a variate decides on each level.
///
/// **Variance.** (`telescoping_law.rs`) All moments are sums over levels of integrals over u. Δ_l is quadratic in X_odd − X_even, the error
/// of a comb of step h ~ 2^{−l}, so that E\[Δ_l²\] ~ 2^{−bl} goes like its fourth power: b = 4 where σ_t jumps, or
/// differs at its ends (then endpoint matching helps); 8 where only its slope does; 2 where it is noise finer than
/// the teeth, whose error is that of h^{1/2}; faster than any power where it is smooth and matched at all orders. The
/// variance is finite if 1 − r > 2^{−b}.
///
/// **Cost.** k r/(2r − 1) look-ups, infinite for r ≤ 1/2, which the constructor refuses; and the comb's shared ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telescoping {
    comb: Comb,
    /// r.
    level_ratio: f64,
}

/// Why a telescoping estimator was refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TelescopingError {
    /// No teeth.
    #[error(transparent)]
    NoTeeth(#[from] NoTeeth),
    /// Twice the look-ups at no less than half the probability: their expected number is infinite. NaN belongs here.
    #[error("the level ratio must be above 1/2, found {0}")]
    LevelRatioNotAboveHalf(f64),
    /// There would be no levels: a bias.
    #[error("the level ratio must be below 1, found {0}")]
    LevelRatioNotBelowOne(f64),
}

impl Telescoping {
    /// The estimator with `teeth` teeth at level 0, whose levels are geometric: level l with probability r (1 − r)^l,
    /// r = `level_ratio`.
    ///
    /// # Errors
    /// If `teeth` is 0, or r not in (1/2, 1).
    pub fn new(teeth: u32, level_ratio: f64, shape: CombShape) -> Result<Self, TelescopingError> {
        if level_ratio >= 1.0 {
            return Err(TelescopingError::LevelRatioNotBelowOne(level_ratio));
        }
        if level_ratio > 0.5 {
            Ok(Self { comb: Comb::new(teeth, shape)?, level_ratio })
        } else {
            Err(TelescopingError::LevelRatioNotAboveHalf(level_ratio))
        }
    }

    /// The r that makes variance times cost least where E\[Δ_l²\] ~ 2^{−bl}: variance and cost of level l are then in
    /// proportion to 2^{−bl}/(1 − r)^l and 2^l (1 − r)^l, and equal shares of both, 1 − r = 2^{−(b+1)/2}, are the
    /// optimum (rhee-2015). 0.82 for b = 4, 0.65 for b = 2.
    #[must_use]
    pub fn matched_ratio(decay: f64) -> f64 {
        debug_assert!(decay > 1.0, "finite variance at finite cost needs a decay above 1: {decay}");
        1.0 - exp2(-0.5 * (decay + 1.0))
    }

    /// The comb of level 0.
    #[must_use]
    pub fn comb(&self) -> Comb {
        self.comb
    }

    /// r.
    #[must_use]
    pub fn level_ratio(&self) -> f64 {
        self.level_ratio
    }

    /// The expected number of look-ups, the same on every profile.
    #[must_use]
    pub fn expected_lookups(&self) -> f64 {
        let lookups = self.comb.lookups();
        let r = self.level_ratio;
        f64::from(lookups.shared) + f64::from(lookups.per_draw) * (r / (2.0 * r - 1.0))
    }

    /// p_l.
    pub(crate) fn probability(&self, level: u32) -> f64 {
        self.level_ratio * (1.0 - self.level_ratio).powi(level as i32)
    }

    /// Draws a level, by a variate for each that is reached.
    #[inline]
    pub(crate) fn sample_level(&self, source: &mut impl UniformSource) -> u32 {
        let mut level = 0;
        while source.next_uniform() >= self.level_ratio {
            level += 1;
        }
        level
    }

    /// The combs inside that of `level` with the variate u: the mean of `each`(X) over those of level 0, and the
    /// difference Δ_level times exp(`offset`).
    #[inline]
    pub(super) fn nested<F: Extinction>(
        &self,
        field: &F,
        prepared: &Prepared,
        (level, u): (u32, f64),
        offset: f64,
        each: impl Fn(f64) -> f64,
    ) -> (f64, f64) {
        if level == 0 {
            return (each(self.comb.thickness(field, prepared, u)), 0.0);
        }
        let combs = 1_u64 << level;
        let scale = 1.0 / combs as f64;
        let (mut base, mut even, mut odd) = (0.0, 0.0, 0.0);
        for pair in 0..combs / 2 {
            let first = (2 * pair) as f64 + u;
            let x_even = self.comb.thickness(field, prepared, first * scale);
            let x_odd = self.comb.thickness(field, prepared, (first + 1.0) * scale);
            base += each(x_even) + each(x_odd);
            even += x_even;
            odd += x_odd;
        }
        (scale * base, difference(offset - scale * (even + odd), 0.5 * scale * (odd - even)))
    }
}

/// −2 exp(`exponent`) sinh²(`half`), 0 or infinite only where that itself is: exp(exponent) and sinh² may under- and overflow where their
/// product does neither. With 2 sinh²(b) = exp(2|b|) (1 − exp(−2|b|))²/2 it is one exponential.
#[inline]
pub(crate) fn difference(exponent: f64, half: f64) -> f64 {
    if exponent.abs() < 700.0 && half.abs() < 350.0 {
        let sine = sinh(half);
        return -2.0 * exp(exponent) * sine * sine;
    }
    if half == 0.0 {
        return 0.0;
    }
    let both = 2.0 * half.abs();
    -exp(exponent + both + 2.0 * ln(-exp_m1(-both)) - std::f64::consts::LN_2)
}

impl<F: Extinction> TransmittanceEstimator<F> for Telescoping {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let level = self.sample_level(source);
        let prepared = self.comb.prepare(field, 0.0, field.length());
        let at = (level, source.next_uniform());
        let (base, difference) = self.nested(field, &prepared, at, 0.0, |x| exp(-x));
        base + difference / self.probability(level)
    }

    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{agrees, seed_ray, tent, theory_of};
    use approx::assert_relative_eq;
    use fairflight_media::{Constant, PiecewiseConstant};
    use fairflight_sources::{Scripted, Seeded};

    #[test]
    fn a_difference_is_a_number_where_its_factors_are_none() {
        // exp(-800) underflows, sinh²(400) overflows: −2 · exp(−800) · exp(800)/4.
        assert_relative_eq!(difference(-800.0, 400.0), -0.5, max_relative = 1e-12);
        assert_relative_eq!(difference(-800.0, -400.0), -0.5, max_relative = 1e-12);
        assert_eq!(difference(-800.0, 0.0), 0.0);
        // On either side of where the two forms meet.
        let (below, above) = (difference(699.75, 0.75), difference(700.25, 0.75));
        assert_relative_eq!(above / below, 0.5_f64.exp(), max_relative = 1e-12);
    }

    #[test]
    fn the_difference_is_that_of_nested_combs() {
        let (ray, shape) = (seed_ray(), CombShape::EndpointMatched);
        let estimator = Telescoping::new(5, 0.8, shape).unwrap();
        let exp = |teeth: u32, u: f64| {
            let comb = Comb::new(teeth, shape).unwrap();
            (-comb.thickness(&ray, &comb.prepare(&ray, 0.0, 20.0), u)).exp()
        };
        let u = 0.3;
        // Level 2: two variates go on, one stops.
        let found = estimator.estimate(&ray, &mut Scripted::new([0.8, 0.9, 0.79, u]));
        let base = (0..4).map(|a| exp(5, (f64::from(a) + u) / 4.0)).sum::<f64>() / 4.0;
        let halves = 0.5 * (exp(10, 0.5 * u) + exp(10, 0.5 * (u + 1.0)));
        let exact = base + (exp(20, u) - halves) / (0.8 * 0.04);
        assert_relative_eq!(found, exact, max_relative = 1e-10);
        assert_eq!(estimator.estimate(&ray, &mut Scripted::new([0.7, u])), exp(5, u));
    }

    #[test]
    fn seed_ray_with_and_without_endpoint_matching() {
        // Measured 0.0487 with a cut-off at level 4 and p_4 = (1 − r)^4, 0.00110 with endpoint matching. The ends of
        // the ray differ, so that without matching every level adds 0.625 times what the one before did: those beyond
        // the fourth, 7e-4.
        let ray = seed_ray();
        for (shape, variance, lookups) in
            [(CombShape::Uniform, 0.0494, 22.5), (CombShape::EndpointMatched, 0.001_098, 24.5)]
        {
            let theory = theory_of(ray, &Telescoping::new(20, 0.9, shape).unwrap());
            assert_relative_eq!(theory.relative_central[0], variance, max_relative = 0.001);
            assert_relative_eq!(theory.lookups, lookups, max_relative = 1e-12);
        }
    }

    #[test]
    fn mean_variance_and_look_ups_are_those_of_samples() {
        for shape in [CombShape::Uniform, CombShape::EndpointMatched] {
            let estimator = Telescoping::new(2, Telescoping::matched_ratio(4.0), shape).unwrap();
            agrees(&tent(), &estimator, 200_000, &mut Seeded::new(11));
            assert!(theory_of(tent(), &estimator).relative_variance_error < 1e-4);
        }
    }

    #[test]
    fn levels_that_add_more_and_more_are_an_infinite_variance() {
        // A jump: b = 4, so that 1 − r must be above 1/16.
        let step = PiecewiseConstant::new(vec![0.0, 1.1, 3.0], vec![1.0, 0.2]).unwrap();
        let at = |r| theory_of(&step, &Telescoping::new(3, r, CombShape::Uniform).unwrap());
        assert_eq!(at(0.97).relative_central[0], f64::INFINITY);
        let finite = at(0.9);
        assert!(finite.relative_central[0] < 0.2);
    }

    #[test]
    fn a_constant_profile_has_no_variance() {
        let field = Constant::new(0.7, 3.0).unwrap();
        let found = theory_of(field, &Telescoping::new(3, 0.8, CombShape::Uniform).unwrap());
        assert_eq!((found.relative_central[0], found.log_relative_variance), (0.0, f64::NEG_INFINITY));
    }

    #[test]
    fn ratios() {
        assert_relative_eq!(Telescoping::matched_ratio(4.0), 0.823, max_relative = 1e-3);
        assert_relative_eq!(Telescoping::matched_ratio(2.0), 0.646, max_relative = 1e-3);
        let at = |r| Telescoping::new(3, r, CombShape::Uniform);
        assert_eq!(at(0.5), Err(TelescopingError::LevelRatioNotAboveHalf(0.5)));
        assert_eq!(at(1.0), Err(TelescopingError::LevelRatioNotBelowOne(1.0)));
        assert!(at(f64::NAN).is_err());
        assert_eq!(Telescoping::new(0, 0.8, CombShape::Uniform), Err(TelescopingError::NoTeeth(NoTeeth)));
    }
}
