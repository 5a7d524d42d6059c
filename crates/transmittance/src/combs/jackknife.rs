//! Jackknife transmittance (peters-2025). **Biased**, and labelled so wherever it appears.

use super::deviation::DeviationLaw;
use super::{Comb, CombCumulants};
use crate::allowance::Allowance;
use crate::{ClosedForm, HIGHEST_MOMENT, Theory, TransmittanceEstimator};
use fairflight_elementary::{cos, exp, exp_m1, ln, sin};
use fairflight_media::{Breakpoints, Extinction, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// cos((X_1 − X_2)/2) exp(−(X_1 + X_2)/2) of two independent combs.
///
/// **Law.** None but for normal X: with complex exponents it is the real part of exp(−(1 + i) X_1/2) exp(−(1 − i)
/// X_2/2), so that its expectation is
/// |E\[exp(−(1 + i) X/2)\]|², by cumulants T exp(k3/12 − k4/48 + …): k2 is gone, and for a normal X all else. [`Theory`] states the expectation it
/// has instead, exactly.
///
/// **Variance.** Half that of E\[(cos)² …\] in closed form: cos² = (1 + cos 2·)/2 gives E\[T̂²\] = (|E\[e^{−(1+i)
/// X}\]|² + E\[e^{−X}\]²)/2.
///
/// **Cost.** 2 M look-ups and the comb's shared ones, always. Estimates may be negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Jackknife {
    comb: Comb,
}

impl Jackknife {
    /// The baseline with two draws of `comb`.
    #[must_use]
    pub fn new(comb: Comb) -> Self {
        Self { comb }
    }

    /// The comb.
    #[must_use]
    pub fn comb(&self) -> Comb {
        self.comb
    }

    /// E\[estimate\]/T − 1 = exp(k3/12 − k4/48) − 1 up to the fourth cumulant of a comb X.
    #[must_use]
    pub fn predicted_bias(cumulants: &CombCumulants) -> f64 {
        exp_m1(cumulants.k3 / 12.0 - cumulants.k4 / 48.0)
    }
}

impl<F: Extinction> TransmittanceEstimator<F> for Jackknife {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let prepared = self.comb.prepare(field, 0.0, field.length());
        let [x1, x2] = [(); 2].map(|()| self.comb.thickness(field, &prepared, source.next_uniform()));
        cos(0.5 * (x1 - x2)) * exp(-0.5 * (x1 + x2))
    }

    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

impl<F: Breakpoints> ClosedForm<F> for Jackknife {
    /// Mean, variance and look-ups; the higher central moments are not worked out.
    fn theory(&self, quadrature: &mut RayQuadrature<F>, _tau: f64, tolerance: Tolerance) -> Theory {
        let allowance = Allowance::usual();
        let lookups = self.comb.lookups();
        let lookups = f64::from(lookups.shared) + 2.0 * f64::from(lookups.per_draw);
        self.theory_within(&allowance, quadrature.field(), tolerance, lookups)
            .unwrap_or_else(|| Theory::without(allowance.unreached(1), lookups))
    }
}

impl Jackknife {
    /// The law, if its quadratures are within the allowance.
    fn theory_within<F: Breakpoints>(
        &self,
        allowance: &Allowance,
        field: &F,
        tolerance: Tolerance,
        lookups: f64,
    ) -> Option<Theory> {
        let prepared = self.comb.prepare(field, 0.0, field.length());
        let mut law = DeviationLaw::new((&self.comb, field, &prepared), tolerance, allowance)?;
        if law.unit() == 0.0 {
            return Some(Theory { lookups, ..Theory::exact() });
        }
        if law.greatest() > MOST_EXPONENT {
            return of_great_deviations(&mut law, lookups);
        }
        // z − 1 of z = E[exp((1 + i) D/2)], E[exp((1 + i) D)] and E[exp(D)]; E[D] = 0 is taken off where it would
        // cancel.
        let [half_re, half_im, full_re, full_im, plain] = law.expect(|d, _| {
            let [half_re, half_im] = exp_m1_of_diagonal(0.5 * d);
            let [full_re, full_im] = exp_m1_of_diagonal(d);
            [half_re - 0.5 * d, half_im - 0.5 * d, full_re - d, full_im - d, exp_m1(d) - d]
        })?;
        // |1 + z|² − 1
        let excess = |re: f64, im: f64| 2.0 * re + re * re + im * im;
        let mean = excess(half_re, half_im);
        let square = 0.5 * (excess(full_re, full_im) + excess(plain, 0.0));
        // E[R²] − E[R]² = square − 2 mean − mean²
        let variance = square - mean * (2.0 + mean);
        let mut relative_central = [f64::NAN; HIGHEST_MOMENT - 1];
        relative_central[0] = variance;
        Some(Theory {
            relative_mean: 1.0 + mean,
            relative_central,
            log_relative_variance: ln(variance),
            relative_variance_error: law.relative_error(),
            ..Theory::mean_only(lookups)
        })
    }
}

/// Rounds in which a greater deviation may be found: each halves the panels around it.
const MOST_ROUNDS: u32 = 60;

/// Deviations D beyond which exp(D) is taken in units of exp(max D).
const MOST_EXPONENT: f64 = 300.0;

/// The law in units of exp(max D) T: beside these numbers the 1 of an unbiased mean is nothing, and nothing cancels.
fn of_great_deviations<F: Breakpoints>(law: &mut DeviationLaw<'_, F>, lookups: f64) -> Option<Theory> {
    // Finer nodes may find greater ones: beyond 709 more they overflow, and are the new unit.
    let (mut greatest, mut plain) = (law.greatest(), f64::NAN);
    for _ in 0..MOST_ROUNDS {
        greatest = law.greatest();
        [plain] = law.expect_within(0.0, |d, _| [exp(d - greatest)])?;
        if plain.is_finite() {
            break;
        }
    }
    // Relative to the greatest of them: waves average out.
    let [half_re, half_im, full_re, full_im] = law.expect_within(plain, |d, _| {
        let (half, full) = (exp(0.5 * (d - greatest)), exp(d - greatest));
        [half * cos(0.5 * d), half * sin(0.5 * d), full * cos(d), full * sin(d)]
    })?;
    let square = |re: f64, im: f64| re * re + im * im;
    let mean = square(half_re, half_im);
    let variance = 0.5 * (square(full_re, full_im) + plain * plain) - mean * mean;
    let log_relative_variance = 2.0 * greatest + ln(variance);
    let mut relative_central = [f64::NAN; HIGHEST_MOMENT - 1];
    relative_central[0] = exp(log_relative_variance);
    Some(Theory {
        relative_mean: exp(greatest + ln(mean)),
        relative_central,
        log_relative_variance,
        relative_variance_error: law.relative_error(),
        ..Theory::mean_only(lookups)
    })
}

/// Real and imaginary part of exp((1 + i) x) − 1, without cancellation near 0.
fn exp_m1_of_diagonal(x: f64) -> [f64; 2] {
    let half = sin(0.5 * x);
    // e^x cos x − 1 = (e^x − 1) cos x − (1 − cos x)
    [exp_m1(x) * cos(x) - 2.0 * half * half, exp(x) * sin(x)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::combs::CombShape;
    use crate::test_support::{seed_ray, tent, theory_of};
    use approx::assert_relative_eq;
    use fairflight_media::OpticalThickness;
    use fairflight_sources::{Scripted, Seeded};

    #[test]
    fn bias_and_variance_on_the_seed_ray() {
        let ray = seed_ray();
        for (teeth, bias, tolerance) in [(8, 0.029, 0.001), (12, 0.0012, 0.0001)] {
            let comb = Comb::new(teeth, CombShape::Uniform).unwrap();
            let found = theory_of(ray, &Jackknife::new(comb)).relative_mean - 1.0;
            assert_relative_eq!(found, bias, epsilon = tolerance);
            let predicted = Jackknife::predicted_bias(&comb.cumulants(&ray, 0.0, 20.0, Tolerance::TIGHT));
            assert_relative_eq!(predicted, found, max_relative = 0.1);
        }
        for (teeth, variance) in [(8, 0.74), (25, 0.0136)] {
            let found = theory_of(ray, &Jackknife::new(Comb::new(teeth, CombShape::Uniform).unwrap()));
            assert_relative_eq!(found.relative_central[0], variance, max_relative = 0.01);
            assert_eq!(found.lookups, f64::from(2 * teeth));
        }
    }

    #[test]
    fn moments_are_those_of_samples() {
        let (field, mut source) = (tent(), Seeded::new(12));
        let comb = Comb::new(2, CombShape::Uniform).unwrap();
        let estimator = Jackknife::new(comb);
        let theory = theory_of(&field, &estimator);
        let (tau, n) = (field.optical_thickness(0.0, 3.0), 200_000);
        let values: Vec<f64> = (0..n)
            .map(|_| tau.exp() * estimator.estimate(&field, &mut source) - theory.relative_mean)
            .collect();
        let mean = |k: i32| values.iter().map(|x| x.powi(k)).sum::<f64>() / f64::from(n);
        let variance = theory.relative_central[0];
        assert!(mean(1).abs() < 5.0 * (variance / f64::from(n)).sqrt());
        assert!((mean(2) - variance).abs() < 5.0 * (mean(4) / f64::from(n)).sqrt());
    }

    #[test]
    fn two_equal_halves_of_very_different_thickness() {
        // One tooth: X is a or b with equal probability, so that the estimate has three values.
        let law = |a: f64, b: f64| {
            let step = fairflight_media::PiecewiseConstant::new(vec![0.0, 0.5, 1.0], vec![a, b]).unwrap();
            theory_of(step, &Jackknife::new(Comb::new(1, CombShape::Uniform).unwrap()))
        };
        let (a, b) = (0.5, 900.0);
        let found = law(a, b);
        // In units of exp(−a); T = exp(−(a + b)/2), and all but the pair (a, a) is nothing.
        let log_mean = 0.25_f64.ln() + 0.5 * (b - a);
        assert_relative_eq!(found.relative_mean.ln(), log_mean, max_relative = 1e-12);
        let log_variance = (0.25_f64 - 0.0625).ln() + (b - a);
        assert_relative_eq!(found.log_relative_variance, log_variance, max_relative = 1e-12);
        assert_eq!(law(a, 4e4).relative_mean, f64::INFINITY);
        assert_relative_eq!(
            law(a, 4e4).log_relative_variance,
            0.1875_f64.ln() + 4e4 - a,
            max_relative = 1e-12
        );
    }

    #[test]
    fn two_draws_and_nothing_else() {
        let field = fairflight_media::PiecewiseLinear::new(vec![0.0, 1.0], vec![0.0, 2.0]).unwrap();
        let estimator = Jackknife::new(Comb::new(1, CombShape::Uniform).unwrap());
        let found = estimator.estimate(&field, &mut Scripted::new([0.25, 0.5]));
        assert_relative_eq!(found, (0.25_f64).cos() * (-0.75_f64).exp(), max_relative = 1e-15);
    }
}
