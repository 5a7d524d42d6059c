//! Next-flight estimators: at each point of a walk, the probability to fly straight to the end.

use crate::estimator::bounded;
use crate::woodcock::expected_lookups;
use crate::{ClosedForm, HIGHEST_MOMENT, SignedProduct, Theory, TransmittanceEstimator};
use fairflight_elementary::{exp, ln};
use fairflight_media::{Majorant, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use std::cell::Cell;

/// Law of a walk at a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NextFlightVersion {
    /// Ends there with probability σ_t/μ, as delta tracking does: cheap in dense media, noisy.
    Delta,
    /// Goes on with its weight times 1 − σ_t/μ, as ratio tracking does.
    Ratio,
}

/// Walks through the majorant's medium and adds at each point, the start included, what would arrive if the rest were
/// flown without collision (cramer-1978; in the words of georgiev-2019).
///
/// ```text
/// T = 0; W = 1; s = 0
/// repeat  T += W exp(−mu (S − s))
///         s += exponential free flight of mu;  stop when s > S
///         W *= 1 − sigma_t(s)/mu                    ratio;  or stop with probability sigma_t(s)/mu: delta
/// ```
///
/// **Law.** (1) Let f(x) be the expectation of a walk that starts at x. With w(y) = 1 − σ_t(y)/μ on average,
///
/// > f(x) = exp(−μ(S − x)) + ∫_x^S μ exp(−μ(y − x)) w(y) f(y) dy.
///
/// (2) Differentiated, f′ = μ f − μ w f = σ_t f with f(S) = 1: f(x) = T(x, S). No majorant was used: `Ratio` admits σ_t of
/// any sign and above μ > 0 at the cost of variance. `Delta` ends walks with a probability, and admits 0 ≤ σ_t ≤ μ only.
///
/// **Variance.** (3) Follow the expectation of the estimate given the walk so far. At y, behind a collision with the weight
/// W, what is still to come without another collision is W (T(y, S) − exp(−μ(S − y))), by (1); a collision at y makes it
/// W w T(y, S). It jumps by W T(y, S) (exp(−g(y)) − 1 + w) where g(y) = ∫_y^S (μ − σ_t). (4) Jumps of a martingale are not
/// correlated and happen at the rate μ, so that, with w = 1 − σ_t/μ and E\[W²\]/T(0, y)² = exp(A(y)), A(y) = ∫_0^y σ_t²/μ,
///
/// > Var/T² = ∫_0^S exp(A) (σ_t − μ exp(−g))² / μ dy      (ratio).
///
/// (5) If the walk ends at random, w is 1 or 0, which adds its variance σ_t/μ (1 − σ_t/μ), and A(y) = ∫_0^y σ_t:
///
/// > Var/T² = ∫_0^S exp(A) ((σ_t − μ exp(−g))² / μ + σ_t (1 − σ_t/μ)) dy      (delta).
///
/// Nothing cancels in these. They vanish where σ_t = μ everywhere, and in a vacuum are (1 − exp(−2μS))/2: the wrong way
/// round for thin media behind a loose majorant. No closed form of higher moments is used; estimates are not bounded.
///
/// **Cost.** μS look-ups, a Poisson number (ratio); μ ∫ T(0, s) ds (delta).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NextFlight {
    version: NextFlightVersion,
}

impl NextFlight {
    /// The estimator of this version.
    #[must_use]
    pub fn new(version: NextFlightVersion) -> Self {
        Self { version }
    }

    /// The version of the estimator.
    #[must_use]
    pub fn version(&self) -> NextFlightVersion {
        self.version
    }
}

impl<F: Majorant> TransmittanceEstimator<F> for NextFlight {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let Some((majorant, length)) = bounded(field) else { return 1.0 };
        let mut weight = SignedProduct::ONE;
        let mut sum = 0.0;
        let mut s = 0.0;
        loop {
            sum += weight.times_exp(-majorant * (length - s));
            s += source.next_exponential() / majorant;
            if s >= length {
                return sum;
            }
            let sigma_t = field.sigma_t(s);
            match self.version {
                NextFlightVersion::Ratio => weight.multiply(1.0 - sigma_t / majorant),
                NextFlightVersion::Delta if source.next_uniform() * majorant < sigma_t => return sum,
                NextFlightVersion::Delta => {}
            }
        }
    }

    #[inline]
    fn admits(&self, field: &F, _s: f64, sigma_t: f64) -> bool {
        match self.version {
            NextFlightVersion::Delta => (0.0..=field.majorant()).contains(&sigma_t),
            NextFlightVersion::Ratio => field.majorant() > 0.0 || sigma_t == 0.0,
        }
    }
}

impl<F: Majorant> ClosedForm<F> for NextFlight {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        let Some((majorant, length)) = bounded(quadrature.field()) else {
            return of_variance(0.0, 0.0, 0.0, 0.0);
        };
        let ratio = self.version == NextFlightVersion::Ratio;
        let lookups = if ratio { majorant * length } else { expected_lookups(quadrature, tolerance) };
        // dA/ds, and the variance that ending at random adds.
        let growth = |sigma_t: f64| if ratio { sigma_t * sigma_t / majorant } else { sigma_t };
        let ending = |sigma_t: f64| if ratio { 0.0 } else { sigma_t * (1.0 - sigma_t / majorant) };
        let total = quadrature.integrate(tolerance, |_, sigma_t| [growth(sigma_t)]).value[0];
        let steepest = Cell::new(0.0_f64);
        let variance = quadrature.integrate_nested(
            tolerance,
            |_, sigma_t| [sigma_t, growth(sigma_t)],
            |s, sigma_t, [before, grown]| {
                let g = majorant * (length - s) - (tau - before);
                steepest.set(steepest.get().max(-g));
                let jump = sigma_t - majorant * exp(-g);
                // In units of exp(A(S)), which may overflow.
                [exp(grown - total) * (jump * jump / majorant + ending(sigma_t))]
            },
        );
        if steepest.get() < MOST_EXPONENT {
            return of_variance(total, variance.value[0], variance.error[0], lookups);
        }
        // The greatest exponent of exp(A − 2g), and where: it is A(S) at the end.
        let greatest = Cell::new((0.0_f64, length));
        quadrature.integrate_nested(
            Tolerance::to(0.1),
            |_, sigma_t| [sigma_t, growth(sigma_t)],
            |s, _, [before, grown]| {
                let g = majorant * (length - s) - (tau - before);
                let exponent = grown - total - 2.0 * g.min(0.0);
                if exponent > greatest.get().0 {
                    greatest.set((exponent, s));
                }
                [exponent]
            },
        );
        // The integrand is a boundary layer there, of a width that no refinement would find by itself.
        let (exponent, layer) = greatest.get();
        let around = (1..=48).flat_map(|k| [-1.0, 1.0].map(|side| layer + side * length * 0.5_f64.powi(k)));
        quadrature.split_at(&around.collect::<Vec<_>>());
        let tolerance = Tolerance { absolute: 0.0, ..tolerance };
        // σ_t far above μ: g < 0, and exp(A − 2g) is what has to be split off. μ exp(−g) − σ_t is then μ exp(−g) (1 − σ_t exp(g)/μ).
        let scale = total + exponent;
        let variance = quadrature.integrate_nested(
            tolerance,
            |_, sigma_t| [sigma_t, growth(sigma_t)],
            |s, sigma_t, [before, grown]| {
                let g = majorant * (length - s) - (tau - before);
                let (below, above) = (g.min(0.0), g.max(0.0));
                let jump = exp(-above) - sigma_t / majorant * exp(below);
                [exp(grown - scale - 2.0 * below) * majorant * jump * jump
                    + exp(grown - scale) * ending(sigma_t)]
            },
        );
        of_variance(scale, variance.value[0], variance.error[0], lookups)
    }
}

/// exp of twice this is still a number: beyond, the exponent is split off.
const MOST_EXPONENT: f64 = 300.0;

/// An unbiased estimate of which variance/T² = `variance` · exp(`scale`) and look-ups are known.
pub(crate) fn of_variance(scale: f64, variance: f64, error: f64, lookups: f64) -> Theory {
    if variance == 0.0 {
        return Theory {
            relative_central: [0.0; HIGHEST_MOMENT - 1],
            log_relative_variance: f64::NEG_INFINITY,
            relative_variance_error: 0.0,
            ..Theory::mean_only(lookups)
        };
    }
    let log_relative_variance = scale + ln(variance);
    let mut relative_central = [f64::NAN; HIGHEST_MOMENT - 1];
    relative_central[0] = exp(log_relative_variance);
    let relative_variance_error = error / variance;
    Theory { relative_central, log_relative_variance, relative_variance_error, ..Theory::mean_only(lookups) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{agrees, seed_ray, theory_of, variate};
    use approx::assert_relative_eq;
    use fairflight_media::{Bounded, Constant, Extinction, PiecewiseConstant};
    use fairflight_sources::{Scripted, Seeded};

    const DELTA: NextFlight = NextFlight { version: NextFlightVersion::Delta };
    const RATIO: NextFlight = NextFlight { version: NextFlightVersion::Ratio };

    #[test]
    fn a_walk_of_two_collisions_by_hand() {
        let field = Bounded::new(PiecewiseConstant::new(vec![0.0, 1.0, 3.0], vec![0.5, -0.4]).unwrap(), 2.0);
        let field = field.unwrap();
        // Collisions at 0.5 and 2, weights 3/4 and 3/4 · 6/5, then beyond 3.
        let mut source = Scripted::new([1.0, 3.0, 2.1].map(variate));
        let exact = (-6.0_f64).exp() + 0.75 * (-5.0_f64).exp() + 0.9 * (-2.0_f64).exp();
        assert_relative_eq!(RATIO.estimate(&field, &mut source), exact, max_relative = 1e-12);
        assert_eq!(source.remaining(), 0);
        // The first collision is survived at 0.25 or above, ended at below.
        let field = Bounded::new(Constant::new(0.5, 3.0).unwrap(), 2.0).unwrap();
        let mut source = Scripted::new([variate(1.0), 0.25, variate(3.0), 0.25_f64.next_down()]);
        let exact = (-6.0_f64).exp() + (-5.0_f64).exp();
        assert_relative_eq!(DELTA.estimate(&field, &mut source), exact, max_relative = 1e-12);
    }

    #[test]
    fn a_vacuum_has_variance_and_a_full_medium_has_none() {
        let vacuum = Bounded::new(Constant::new(0.0, 3.0).unwrap(), 0.7).unwrap();
        let full = Constant::new(0.7, 3.0).unwrap();
        for version in [DELTA, RATIO] {
            let theory = theory_of(vacuum, &version);
            assert_relative_eq!(theory.relative_central[0], -0.5 * (-4.2_f64).exp_m1(), max_relative = 1e-10);
        }
        assert!(theory_of(full, &RATIO).relative_central[0] < 1e-20);
        let nothing = Constant::new(0.0, 3.0).unwrap();
        assert_eq!(theory_of(nothing, &RATIO).relative_central, [0.0; 7]);
        assert_eq!(RATIO.estimate(&nothing, &mut Scripted::new([])), 1.0);
    }

    /// The second moment as it stands without (3) and (4): M' = (μ − μ E[w²]) M + h' − μ h, solved by its integrating
    /// factor, for a constant profile.
    #[test]
    fn the_variance_is_that_of_the_differential_equation() {
        let (sigma, majorant, length) = (0.4, 1.1, 2.5);
        let field = Bounded::new(Constant::new(sigma, length).unwrap(), majorant).unwrap();
        for (version, rate) in [(RATIO, 2.0 * sigma - sigma * sigma / majorant), (DELTA, sigma)] {
            // ∫ exp(−rate y) [μ exp(−2μ(S − y)) − 2σ exp(−(μ + σ)(S − y))] dy
            let part = |k: f64| ((-rate * length).exp() - (-k * length).exp()) / (k - rate);
            let second = (-rate * length).exp() + majorant * part(2.0 * majorant)
                - 2.0 * sigma * part(majorant + sigma);
            let exact = second * (2.0 * sigma * length).exp() - 1.0;
            assert_relative_eq!(theory_of(field, &version).relative_central[0], exact, max_relative = 1e-10);
        }
    }

    #[test]
    fn the_measured_figures_of_the_seed_ray() {
        let theory = theory_of(seed_ray(), &RATIO);
        assert_relative_eq!(theory.relative_central[0], 8.97, max_relative = 1e-3);
        assert_relative_eq!(theory.lookups, 20.0);
        let theory = theory_of(seed_ray(), &crate::Woodcock);
        assert_relative_eq!(theory.relative_central[0], 29.44, max_relative = 1e-3);
        assert_relative_eq!(theory.lookups, 5.21, max_relative = 1e-3);
    }

    /// By the closed form of the test above, its exponents in logarithms.
    #[test]
    fn the_variance_far_above_the_rate() {
        let (sigma, rate, length) = (400.0_f64, 1.0, 3.0);
        let field = Bounded::new(Constant::new(sigma, length).unwrap(), rate).unwrap();
        let growth = 2.0 * sigma - sigma * sigma / rate;
        // exp(−growth length) rules: (1 + μ/(2μ − r) − 2σ/(μ + σ − r)) exp(−r S), r = growth; beside it exp(2σS).
        let factor = 1.0 + rate / (2.0 * rate - growth) - 2.0 * sigma / (rate + sigma - growth);
        let exact = factor.ln() - growth * length + 2.0 * sigma * length;
        let theory = theory_of(field, &RATIO);
        assert_relative_eq!(theory.log_relative_variance, exact, max_relative = 1e-9);
        assert_eq!(theory.relative_central[0], f64::INFINITY);
    }

    #[test]
    fn both_versions_have_the_mean_variance_and_look_ups_of_their_theory() {
        let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 2.5], vec![0.8, 0.1, 1.0]).unwrap();
        for version in [DELTA, RATIO] {
            agrees(&field, &version, 200_000, &mut Seeded::new(11));
        }
        // Above the majorant and negative: only variance.
        let signed = PiecewiseConstant::new(vec![0.0, 0.5, 1.5], vec![1.5, -0.4]).unwrap();
        let field = Bounded::new(signed, 1.0).unwrap();
        assert!(RATIO.admits(&field, 0.0, 1.5) && !DELTA.admits(&field, 0.0, 1.5));
        assert!(field.sigma_t(0.0) > field.majorant());
        agrees(&field, &RATIO, 200_000, &mut Seeded::new(12));
    }
}
