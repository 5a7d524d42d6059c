//! The law of a telescoping sum of nested combs: moments level by level, and what the levels beyond those add.

use super::{Comb, Prepared, Telescoping};
use crate::allowance::{Allowance, NODES};
use crate::{ClosedForm, HIGHEST_MOMENT, Theory};
use fairflight_elementary::{exp, exp_m1, ln, pow};
use fairflight_media::{Breakpoints, RayQuadrature, Tolerance};
use std::cell::Cell;

/// Look-ups of one level, as far as the allowance of all goes: what follows from several levels is worth more than a digit of one.
const LEVEL: f64 = 3e6;

/// A share of the variance that is negligible.
const NEGLIGIBLE: f64 = 1e-13;

/// What one level adds: E\[b\] and E\[Δ\], E\[Δ²\]/p² and E\[(b + Δ/p)^n\], n = 2 … 8, in units of the deviation at
/// level 0, b the T_0 of that level less 1.
struct Level {
    base: f64,
    difference: f64,
    square: f64,
    moments: [f64; HIGHEST_MOMENT - 1],
    /// The error of the second moment, where its integral has not converged.
    error: f64,
}

impl Telescoping {
    /// The moments of a level in units of `unit` exp(`scale.log`); `None` where they cost too much.
    fn moments_at<F: Breakpoints>(
        &self,
        (field, allowance): (&F, &Allowance),
        prepared: &Prepared,
        level: u32,
        (scale, unit): (Scale, f64),
        tolerance: Tolerance,
    ) -> Option<Level> {
        let teeth = self.comb().teeth().checked_mul(1_u32.checked_shl(level)?)?;
        // Its teeth stand on a breakpoint at the same variates as those of the comb that it makes up.
        let breaks = Comb::new(teeth, self.comb().shape()).ok()?.folded_breakpoints(field, prepared);
        let most_panels = tolerance.most_panels.min((LEVEL / NODES / f64::from(teeth)) as usize);
        if breaks.len() >= most_panels {
            return None;
        }
        let probability = self.probability(level);
        let exactness = tolerance.relative.max(1e-12);
        let tolerance =
            Tolerance { absolute: exactness / probability.sqrt(), relative: exactness, most_panels };
        let integral = allowance.integral(&breaks, tolerance, f64::from(teeth), |u| {
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
        let integral = integral?;
        let error = if integral.converged { 0.0 } else { integral.error[3] };
        let [base, difference, square, moments @ ..] = integral.value;
        Some(Level { base, difference, square, moments, error })
    }
}

impl<F: Breakpoints> ClosedForm<F> for Telescoping {
    /// All moments where the levels that matter can be summed. Where they cannot (a profile with kinks has some at
    /// every level), the variance alone, its tail continued as a geometric series, whose sum is the error that is
    /// stated; infinite where the levels add more and more.
    fn theory(&self, quadrature: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        let allowance = Allowance::usual();
        self.theory_within(&allowance, quadrature.field(), tau, tolerance)
            .unwrap_or_else(|| Theory::without(allowance.unreached(2), self.expected_lookups()))
    }
}

impl Telescoping {
    /// The law, if the quadratures of its first levels are within the allowance.
    fn theory_within<F: Breakpoints>(
        &self,
        allowance: &Allowance,
        field: &F,
        tau: f64,
        tolerance: Tolerance,
    ) -> Option<Theory> {
        let prepared = self.comb().prepare(field, 0.0, field.length());
        let lookups = self.expected_lookups();
        let breaks = self.comb().folded_breakpoints(field, &prepared);
        let noise = 8.0 * f64::EPSILON * (1.0 + tau.abs());
        let rough = |scale: Scale| {
            let absolute = if scale.log == 0.0 { noise * noise } else { 0.0 };
            let coarse = Tolerance { absolute, relative: 1e-3, ..tolerance };
            let greatest = Cell::new(f64::NEG_INFINITY);
            let teeth = f64::from(self.comb().teeth());
            let square = allowance.integral(&breaks, coarse, teeth, |u| {
                let x = self.comb().thickness(field, &prepared, u);
                greatest.set(greatest.get().max(tau - x));
                let relative = scale.deviation(x);
                [relative * relative]
            })?;
            Some((square.value[0], greatest.get()))
        };
        let mut scale = Scale { thickness: tau, log: 0.0 };
        let (mut square, greatest) = rough(scale)?;
        if greatest > MOST_EXPONENT {
            scale.log = greatest;
            square = f64::INFINITY;
        }
        // Finer nodes may find greater ones: beyond 354 more they overflow, and are the new unit.
        for _ in 0..MOST_ROUNDS {
            if square.is_finite() {
                break;
            }
            let (found, greatest) = rough(scale)?;
            square = found;
            if !square.is_finite() {
                scale.log = greatest;
            }
        }
        let with = |moments, error| scale.theory(moments, error, lookups);
        if square <= noise * noise && scale.log == 0.0 {
            return Some(with(([0.0; HIGHEST_MOMENT - 1], 0.0), 0.0));
        }
        let unit = square.sqrt();
        // exp(τ − X) is off by the rounding of its exponent; in units of the greatest one that is what counts.
        let exactness =
            tolerance.relative.max(8.0 * noise / if scale.log == 0.0 { unit } else { unit.min(1.0) });
        let tolerance = Tolerance { relative: exactness, ..tolerance };

        let beyond = |level: u32| (1.0 - self.level_ratio()).powi(level as i32 + 1);
        let mut sums = [0.0; HIGHEST_MOMENT - 1];
        let (mut base, mut remaining, mut error) = (0.0, 0.0, 0.0);
        let mut shares: Vec<f64> = Vec::new();
        for level in 0.. {
            let Some(found) = self.moments_at((field, allowance), &prepared, level, (scale, unit), tolerance)
            else {
                break;
            };
            let probability = self.probability(level);
            for (sum, moment) in sums.iter_mut().zip(found.moments) {
                *sum += probability * moment;
            }
            error += probability * found.error;
            base = found.base;
            remaining = if level == 0 { base } else { remaining + found.difference };
            shares.push(probability * found.square);
            // Two levels in a row, since one may be small by chance; beyond, every level has the same T_0 and no
            // difference.
            if level >= 2 && shares[level as usize - 1..].iter().all(|share| *share <= NEGLIGIBLE * sums[0]) {
                for (sum, moment) in sums.iter_mut().zip(found.moments) {
                    *sum += beyond(level) * moment;
                }
                error += beyond(level) * found.error;
                return Some(with((sums, unit), exactness.max(error / sums[0])));
            }
        }
        let [before, .., last] = shares.get(shares.len().checked_sub(5)?..)? else { return None };
        let mut unknown = [f64::NAN; HIGHEST_MOMENT - 1];
        // Over four levels: where a jump stands in the binary fractions of a step repeats after two or four, if at all.
        let ratio = pow(last / before, 0.25);
        if ratio >= 1.0 {
            unknown[0] = f64::INFINITY;
            return Some(with((unknown, unit), f64::NAN));
        }
        // Σ over the levels that are left of p b² + 2 b E[Δ] + E[Δ²]/p.
        let tail = last * ratio / (1.0 - ratio);
        sums[0] += beyond(shares.len() as u32 - 1) * base * base - 2.0 * base * remaining + tail;
        unknown[0] = sums[0];
        Some(Theory {
            unreached: Some(allowance.unreached(3)),
            ..with((unknown, unit), (tail + error) / sums[0])
        })
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
            exp_m1(self.thickness - x)
        } else {
            exp(self.thickness - self.log - x) - exp(-self.log)
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
            let log = ln(moments[i].abs()) + f64::from(n) * (ln(unit) + self.log);
            moments[i].signum() * exp(log)
        });
        let log_relative_variance = if self.log == 0.0 {
            ln(relative_central[0])
        } else {
            ln(moments[0]) + 2.0 * (ln(unit) + self.log)
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
    use crate::combs::CombShape;
    use crate::test_support::tent;
    use fairflight_media::{Extinction, OpticalThickness};

    /// Where levels shrink as those before them, what is left is worth adding: the variance comes out nearer than without it.
    #[test]
    fn levels_that_are_left_follow_from_those_before() {
        let kinked = tent();
        let tau = kinked.optical_thickness(0.0, kinked.length());
        // Its ends differ: a level adds 1/(16 · 0.15) = 0.42 times what the one before did.
        let estimator = Telescoping::new(2, 0.85, CombShape::Uniform).unwrap();
        let within = |most: f64| {
            let allowance = Allowance::of(most);
            estimator.theory_within(&allowance, &kinked, tau, Tolerance::to(1e-9)).unwrap()
        };
        let all = within(1e8);
        for most in [3e5, 1e6] {
            let found = within(most);
            let [variance, exact] = [found, all].map(|theory| theory.relative_central[0]);
            let left = found.relative_variance_error * variance;
            assert!(left > 10.0 * all.relative_variance_error * exact, "{most}: {left}");
            assert!((variance - exact).abs() < 0.5 * left, "{most}: {variance} for {exact}, {left} left");
        }
    }

    /// The law is that of the estimate, whatever unit its moments are taken in.
    #[test]
    fn the_unit_of_moments_does_not_matter() {
        let moments: [f64; HIGHEST_MOMENT - 1] = [1.5, -0.2, 3.0, 0.0, 7.0, 1.0, 40.0];
        let of = |log: f64, unit: f64| Scale { thickness: 90.0, log }.theory((moments, unit), 0.0, 1.0);
        let plain = of(0.0, 3.0 * 9.0_f64.exp());
        let scaled = of(9.0, 3.0);
        for (a, b) in plain.relative_central.into_iter().zip(scaled.relative_central) {
            assert!((a - b).abs() <= 1e-12 * a.abs(), "{a} {b}");
        }
        for theory in [plain, scaled] {
            assert!((theory.log_relative_variance - theory.relative_central[0].ln()).abs() < 1e-12);
        }
    }
}
