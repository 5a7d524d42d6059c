//! Debiasing by a telescoping sum of nested combs (misso-2022; blanchet-2015).

use super::{Comb, CombShape, NoTeeth, Prepared};
use crate::{ClosedForm, HIGHEST_MOMENT, Theory, TransmittanceEstimator};
use fairflight_media::{Breakpoints, Extinction, RayQuadrature, Tolerance, adaptive_integral};
use fairflight_sources::UniformSource;
use std::cell::Cell;

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
/// **Variance.** All moments are sums over levels of integrals over u. Δ_l is quadratic in X_odd − X_even, the error
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
        1.0 - (-0.5 * (decay + 1.0)).exp2()
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
    fn probability(&self, level: u32) -> f64 {
        self.level_ratio * (1.0 - self.level_ratio).powi(level as i32)
    }

    /// The combs inside that of `level` with the variate u: the mean of `each`(X) over those of level 0, and the
    /// difference Δ_level times exp(`offset`).
    #[inline]
    fn nested<F: Extinction>(
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
fn difference(exponent: f64, half: f64) -> f64 {
    if exponent.abs() < 700.0 && half.abs() < 350.0 {
        let sinh = half.sinh();
        return -2.0 * exponent.exp() * sinh * sinh;
    }
    if half == 0.0 {
        return 0.0;
    }
    let both = 2.0 * half.abs();
    -(exponent + both + 2.0 * (-(-both).exp_m1()).ln() - std::f64::consts::LN_2).exp()
}

impl<F: Extinction> TransmittanceEstimator<F> for Telescoping {
    #[inline]
    fn estimate<S: UniformSource + ?Sized>(&self, field: &F, source: &mut S) -> f64 {
        let mut level = 0;
        while source.next_uniform() >= self.level_ratio {
            level += 1;
        }
        let prepared = self.comb.prepare(field, 0.0, field.length());
        let at = (level, source.next_uniform());
        let (base, difference) = self.nested(field, &prepared, at, 0.0, |x| (-x).exp());
        base + difference / self.probability(level)
    }

    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

/// Look-ups that the theory may spend on one level.
const MOST_LOOKUPS: f64 = 3e6;

/// A share of the variance that is negligible.
const NEGLIGIBLE: f64 = 1e-13;

/// What one level adds: E\[b\] and E\[Δ\], E\[Δ²\]/p² and E\[(b + Δ/p)^n\], n = 2 … 8, in units of the deviation at
/// level 0, b the T_0 of that level less 1.
struct Level {
    base: f64,
    difference: f64,
    square: f64,
    moments: [f64; HIGHEST_MOMENT - 1],
}

impl Telescoping {
    /// The moments of a level in units of `unit` exp(`scale.log`); `None` where they cost too much.
    fn moments_at<F: Breakpoints>(
        &self,
        field: &F,
        prepared: &Prepared,
        level: u32,
        (scale, unit): (Scale, f64),
        tolerance: Tolerance,
    ) -> Option<Level> {
        let teeth = self.comb.teeth().checked_mul(1_u32.checked_shl(level)?)?;
        // Its teeth stand on a breakpoint at the same variates as those of the comb that it makes up.
        let breaks = Comb::new(teeth, self.comb.shape()).ok()?.folded_breakpoints(field, prepared);
        let most_panels = (MOST_LOOKUPS / 21.0 / f64::from(teeth)) as usize;
        if breaks.len() >= most_panels {
            return None;
        }
        let probability = self.probability(level);
        let exactness = tolerance.relative.max(1e-12);
        let tolerance =
            Tolerance { absolute: exactness / probability.sqrt(), relative: exactness, most_panels };
        let integral = adaptive_integral(1.0, &breaks, tolerance, |u| {
            let (base, difference) =
                self.nested(field, prepared, (level, u), scale.thickness - scale.log, |x| scale.deviation(x));
            let (base, difference) = (base / unit, difference / unit);
            let weighted = difference / probability;
            let value = base + weighted;
            let mut power = value;
            let mut all = [base, difference, weighted * weighted, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            for slot in &mut all[3..] {
                power *= value;
                *slot = power;
            }
            all
        });
        let [base, difference, square, moments @ ..] = integral.value;
        Some(Level { base, difference, square, moments })
    }
}

impl<F: Breakpoints> ClosedForm<F> for Telescoping {
    /// All moments where the levels that matter can be summed. Where they cannot (a profile with kinks has some at
    /// every level), the variance alone, its tail continued as a geometric series, whose sum is the error that is
    /// stated; infinite where the levels add more and more.
    fn theory(
        &self,
        quadrature: &mut RayQuadrature<F>,
        optical_thickness: f64,
        tolerance: Tolerance,
    ) -> Theory {
        let field = quadrature.field();
        let prepared = self.comb.prepare(field, 0.0, field.length());
        let lookups = self.expected_lookups();
        let breaks = self.comb.folded_breakpoints(field, &prepared);
        let noise = 8.0 * f64::EPSILON * (1.0 + optical_thickness.abs());
        let rough = |scale: Scale| {
            let absolute = if scale.log == 0.0 { noise * noise } else { 0.0 };
            let coarse = Tolerance { absolute, relative: 1e-3, ..tolerance };
            let greatest = Cell::new(f64::NEG_INFINITY);
            let square = adaptive_integral(1.0, &breaks, coarse, |u| {
                let x = self.comb.thickness(field, &prepared, u);
                greatest.set(greatest.get().max(optical_thickness - x));
                let relative = scale.deviation(x);
                [relative * relative]
            });
            (square.value[0], greatest.get())
        };
        let mut scale = Scale { thickness: optical_thickness, log: 0.0 };
        let (mut square, greatest) = rough(scale);
        if greatest > MOST_EXPONENT {
            scale.log = greatest;
            square = f64::INFINITY;
        }
        // Finer nodes may find greater ones: beyond 354 more they overflow, and are the new unit.
        for _ in 0..MOST_ROUNDS {
            if square.is_finite() {
                break;
            }
            let (found, greatest) = rough(scale);
            square = found;
            if !square.is_finite() {
                scale.log = greatest;
            }
        }
        let with = |moments, error| scale.theory(moments, error, lookups);
        if square <= noise * noise && scale.log == 0.0 {
            return with(([0.0; HIGHEST_MOMENT - 1], 0.0), 0.0);
        }
        let unit = square.sqrt();
        // exp(τ − X) is off by the rounding of its exponent; in units of the greatest one that is what counts.
        let exactness =
            tolerance.relative.max(8.0 * noise / if scale.log == 0.0 { unit } else { unit.min(1.0) });
        let tolerance = Tolerance { relative: exactness, ..tolerance };

        let beyond = |level: u32| (1.0 - self.level_ratio).powi(level as i32 + 1);
        let mut sums = [0.0; HIGHEST_MOMENT - 1];
        let (mut base, mut remaining) = (0.0, 0.0);
        let mut shares: Vec<f64> = Vec::new();
        for level in 0.. {
            let Some(found) = self.moments_at(field, &prepared, level, (scale, unit), tolerance) else {
                break;
            };
            let probability = self.probability(level);
            for (sum, moment) in sums.iter_mut().zip(found.moments) {
                *sum += probability * moment;
            }
            base = found.base;
            remaining = if level == 0 { base } else { remaining + found.difference };
            shares.push(probability * found.square);
            // Two levels in a row, since one may be small by chance; beyond, every level has the same T_0 and no
            // difference.
            if level >= 2 && shares[level as usize - 1..].iter().all(|share| *share <= NEGLIGIBLE * sums[0]) {
                for (sum, moment) in sums.iter_mut().zip(found.moments) {
                    *sum += beyond(level) * moment;
                }
                return with((sums, unit), exactness);
            }
        }
        let mut unknown = [f64::NAN; HIGHEST_MOMENT - 1];
        let Some([before, .., last]) = shares.len().checked_sub(5).map(|from| &shares[from..]) else {
            return with((unknown, unit), f64::NAN);
        };
        // Over four levels: where a jump stands in the binary fractions of a step repeats after two or four, if at all.
        let ratio = (last / before).powf(0.25);
        if ratio >= 1.0 {
            unknown[0] = f64::INFINITY;
            return with((unknown, unit), f64::NAN);
        }
        // Σ over the levels that are left of p b² + 2 b E[Δ] + E[Δ²]/p.
        let tail = last * ratio / (1.0 - ratio);
        sums[0] += beyond(shares.len() as u32 - 1) * base * base - 2.0 * base * remaining + tail;
        unknown[0] = sums[0];
        with((unknown, unit), tail / sums[0])
    }
}

/// Beyond exp of this, deviations are taken in units of the greatest: their eighth powers would overflow, and soon they themselves.
const MOST_EXPONENT: f64 = 80.0;

/// Rounds in which a greater deviation may be found: each halves the panels around it.
const MOST_ROUNDS: u32 = 60;

/// What deviations exp(τ − X) − 1 are divided by: exp(`log`), 1 but for dense media.
#[derive(Clone, Copy)]
struct Scale {
    thickness: f64,
    log: f64,
}

impl Scale {
    /// (exp(τ − x) − 1) exp(−log).
    fn deviation(self, x: f64) -> f64 {
        if self.log == 0.0 {
            (self.thickness - x).exp_m1()
        } else {
            (self.thickness - self.log - x).exp() - (-self.log).exp()
        }
    }

    /// The law of an estimate with moments n = 2 … 8 in units of `unit` exp(log).
    fn theory(
        self,
        (moments, unit): ([f64; HIGHEST_MOMENT - 1], f64),
        relative_variance_error: f64,
        lookups: f64,
    ) -> Theory {
        let relative_central: [f64; HIGHEST_MOMENT - 1] = std::array::from_fn(|i| {
            let n = i as i32 + 2;
            if self.log == 0.0 || moments[i] == 0.0 {
                return if moments[i] == 0.0 { 0.0 } else { moments[i] * unit.powi(n) };
            }
            let log = moments[i].abs().ln() + f64::from(n) * (unit.ln() + self.log);
            moments[i].signum() * log.exp()
        });
        let log_relative_variance = if self.log == 0.0 {
            relative_central[0].ln()
        } else {
            moments[0].ln() + 2.0 * (unit.ln() + self.log)
        };
        Theory {
            relative_mean: 1.0,
            relative_central,
            log_relative_variance,
            relative_variance_error,
            ..Theory::mean_only(lookups)
        }
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
