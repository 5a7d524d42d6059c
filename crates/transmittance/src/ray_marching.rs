//! Ray marching: the exponential of a Riemann sum (perlin-1989). **Biased**, and labelled so wherever it appears.

use crate::allowance::Allowance;
use crate::{ClosedForm, MOMENTS, Theory, TransmittanceEstimator};
use fairflight_elementary::{exp, ln};
use fairflight_media::{Breakpoints, Extinction, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use std::cell::Cell;

/// Offset of each look-up in its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Offset {
    /// In the middle: the midpoint rule, deterministic.
    Fixed,
    /// At one random offset, the same in every step. The Riemann sum is then unbiased, its exponential is not: by
    /// Jensen's inequality E\[exp(−X)\] > exp(−E\[X\]) (raab-2008 section 1; szirmay-kalos-2017 section 2).
    Jittered,
}

/// exp(−h Σ σ_t((k + offset) h)) with h = length / steps: a baseline that real estimators are compared with.
///
/// **Law.** None: its expectation is exp(−τ) only in the limit of many steps, or on a constant profile. [`Theory`] states
/// the expectation it has instead.
///
/// **Cost.** `steps` look-ups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayMarching {
    pub(crate) steps: u32,
    pub(crate) offset: Offset,
}

/// Ray marching needs at least one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("steps must be at least 1, found 0")]
pub struct NoSteps;

impl RayMarching {
    /// The baseline with `steps` equal steps.
    ///
    /// # Errors
    /// If `steps` is 0.
    pub fn new(steps: u32, offset: Offset) -> Result<Self, NoSteps> {
        if steps == 0 { Err(NoSteps) } else { Ok(Self { steps, offset }) }
    }

    /// The Riemann sum with this offset in \[0, 1).
    #[inline]
    fn thickness<F: Extinction>(&self, field: &F, offset: f64) -> f64 {
        let step = field.length() / f64::from(self.steps);
        let sum: f64 = (0..self.steps).map(|k| field.sigma_t((f64::from(k) + offset) * step)).sum();
        sum * step
    }
}

impl<F: Extinction> TransmittanceEstimator<F> for RayMarching {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let offset = match self.offset {
            Offset::Fixed => 0.5,
            Offset::Jittered => source.next_uniform(),
        };
        exp(-self.thickness(field, offset))
    }

    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

impl<F: Breakpoints> ClosedForm<F> for RayMarching {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        let field = quadrature.field();
        // In units of T: exp(tau − X), which does not underflow with T.
        let relative = |offset: f64| exp(tau - self.thickness(field, offset));
        let lookups = f64::from(self.steps);
        if self.offset == Offset::Fixed || field.length() == 0.0 {
            return Theory { relative_mean: relative(0.5), lookups, ..Theory::exact() };
        }
        let allowance = Allowance::usual();
        self.jittered((&allowance, field), tau, tolerance)
            .unwrap_or_else(|| Theory::without(allowance.unreached(1), lookups))
    }
}

impl RayMarching {
    /// The law with random offsets, if its quadratures are within the allowance.
    fn jittered<F: Breakpoints>(
        &self,
        (allowance, field): (&Allowance, &F),
        tau: f64,
        tolerance: Tolerance,
    ) -> Option<Theory> {
        let relative = |offset: f64| exp(tau - self.thickness(field, offset));
        let lookups = f64::from(self.steps);
        let steps = lookups / field.length();
        let breaks: Vec<f64> = field.breakpoints().iter().map(|s| (s * steps).fract()).collect();
        let greatest = Cell::new(f64::NEG_INFINITY);
        let mean = allowance.integral(&breaks, tolerance, lookups, |offset| {
            let exponent = tau - self.thickness(field, offset);
            greatest.set(greatest.get().max(exponent));
            [exp(exponent)]
        })?;
        if greatest.get() > MOST_EXPONENT {
            let exponent = |offset: f64| tau - self.thickness(field, offset);
            return of_great_exponents((&breaks, tolerance), greatest.get(), &exponent, (lookups, allowance));
        }
        if mean.error[0] > UNKNOWN * mean.value[0] {
            return None;
        }
        let mean = mean.value[0];
        let central = allowance.integral(&breaks, tolerance, lookups, |offset| -> [f64; MOMENTS] {
            let deviation = relative(offset) - mean;
            std::array::from_fn(|i| deviation.powi(i as i32 + 2))
        });
        let Some(central) = central else {
            return Some(Theory { relative_mean: mean, ..Theory::without(allowance.unreached(2), lookups) });
        };
        Some(Theory {
            relative_mean: mean,
            relative_central: central.value,
            log_relative_variance: ln(central.value[0]),
            relative_variance_error: central.error[0] / central.value[0],
            ..Theory::mean_only(lookups)
        })
    }
}

/// A mean with a relative error above this is not known.
const UNKNOWN: f64 = 1e-2;

/// Exponent from which on estimates are taken in units of the greatest: their eighth powers would overflow, and soon they themselves.
const MOST_EXPONENT: f64 = 80.0;

/// Rounds in which a greater exponent may be found: each halves the panels around it.
const MOST_ROUNDS: u32 = 60;

/// The law of estimates exp(`exponent`(offset)) in units of T, of which `greatest` is the greatest exponent found so far.
fn of_great_exponents(
    (breaks, tolerance): (&[f64], Tolerance),
    greatest: f64,
    exponent: &dyn Fn(f64) -> f64,
    (lookups, allowance): (f64, &Allowance),
) -> Option<Theory> {
    let tolerance = Tolerance { absolute: 0.0, ..tolerance };
    let found = Cell::new(greatest);
    let (mut greatest, mut mean) = (greatest, f64::NAN);
    // Finer nodes may find greater ones: beyond 709 more they overflow, and are the new unit.
    for _ in 0..MOST_ROUNDS {
        greatest = found.get();
        let integral = allowance.integral(breaks, tolerance, lookups, |offset| {
            let exponent = exponent(offset);
            found.set(found.get().max(exponent));
            [exp(exponent - greatest)]
        })?;
        mean = integral.value[0];
        if mean.is_finite() {
            break;
        }
    }
    let central = allowance.integral(breaks, tolerance, lookups, |offset| -> [f64; MOMENTS] {
        let deviation = exp(exponent(offset) - greatest) - mean;
        std::array::from_fn(|i| deviation.powi(i as i32 + 2))
    });
    let relative_mean = exp(greatest + ln(mean));
    let Some(central) = central else {
        return Some(Theory { relative_mean, ..Theory::without(allowance.unreached(2), lookups) });
    };
    let log = |i: usize| ln(central.value[i].abs()) + (i as f64 + 2.0) * greatest;
    let moment = |i: usize| central.value[i].signum() * exp(log(i));
    Some(Theory {
        relative_mean,
        relative_central: std::array::from_fn(|i| if central.value[i] == 0.0 { 0.0 } else { moment(i) }),
        log_relative_variance: log(0),
        relative_variance_error: central.error[0] / central.value[0],
        ..Theory::mean_only(lookups)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use fairflight_media::{OpticalThickness, PiecewiseConstant};

    /// On steps X is constant between the offsets at which a look-up meets an edge: all moments are sums, and few panels suffice.
    #[test]
    fn offsets_are_split_where_a_look_up_meets_an_edge() {
        let field = PiecewiseConstant::new(vec![0.0, 0.9, 2.3, 3.1], vec![0.4, 1.7, 0.2]).unwrap();
        let tau = field.optical_thickness(0.0, 3.1);
        let marching = RayMarching::new(4, Offset::Jittered).unwrap();
        let mut borders = [0.0, (0.9 * 4.0 / 3.1_f64).fract(), (2.3 * 4.0 / 3.1_f64).fract(), 1.0];
        borders.sort_unstable_by(f64::total_cmp);
        let moment = |power: i32, centre: f64| -> f64 {
            let between = |pair: &[f64]| {
                let middle = 0.5 * (pair[0] + pair[1]);
                let x: f64 = (0..4).map(|k| field.sigma_t((f64::from(k) + middle) * 3.1 / 4.0)).sum();
                (pair[1] - pair[0]) * ((tau - x * 3.1 / 4.0).exp() - centre).powi(power)
            };
            borders.windows(2).map(between).sum()
        };
        let tolerance = Tolerance { most_panels: 4, ..Tolerance::TIGHT };
        let theory = marching.theory(&mut RayQuadrature::new(field.clone(), &[]), tau, tolerance);
        let mean = moment(1, 0.0);
        assert_relative_eq!(theory.relative_mean, mean, max_relative = 1e-12);
        assert_relative_eq!(theory.relative_central[0], moment(2, mean), max_relative = 1e-11);
        assert_relative_eq!(theory.relative_central[2], moment(4, mean), max_relative = 1e-11);
    }

    /// In a medium so dense that exp(tau − X) is taken in units of the greatest, the law is still that of its two values.
    #[test]
    fn great_exponents_have_the_moments_of_their_sums() {
        // One look-up meets 250 with probability 1/4, nothing otherwise.
        let field = PiecewiseConstant::new(vec![0.0, 0.25, 1.0], vec![250.0, 0.0]).unwrap();
        let marching = RayMarching::new(1, Offset::Jittered).unwrap();
        for tau in [62.5_f64, 90.0] {
            let theory = marching.theory(&mut RayQuadrature::new(field.clone(), &[]), tau, Tolerance::TIGHT);
            let mean = 0.75 * tau.exp();
            assert_relative_eq!(theory.relative_mean, mean, max_relative = 1e-12);
            // Of a coin: the second to the fourth central moment.
            let coin = [3.0 / 16.0, -6.0 / 64.0, 21.0 / 256.0];
            for (i, expected) in coin.into_iter().enumerate() {
                let expected = expected * (tau * (i as f64 + 2.0)).exp();
                assert_relative_eq!(theory.relative_central[i], expected, max_relative = 1e-11);
            }
            assert_relative_eq!(
                theory.log_relative_variance,
                (3.0_f64 / 16.0).ln() + 2.0 * tau,
                max_relative = 1e-12
            );
        }
    }
}
