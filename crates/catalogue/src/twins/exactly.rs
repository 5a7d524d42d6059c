//! Mistakes too small for a sample: found without chance.

use super::trial::{LAWFUL, Misstated};
use super::{Evident, Rejection, Twin};
use crate::profiles::constant;
use fairflight_freeflight::{Flight, FreeFlight, Newton};
use fairflight_laws::exact::decisions::expectation;
use fairflight_laws::exact::densities::{self, deviation};
use fairflight_laws::exact::renewal::{self, Scoring, relative_variance};
use fairflight_laws::exact::thickness::{self, deviation_of_integral, deviation_of_inverse};
use fairflight_media::{Bounded, Constant, Extinction, OpticalThickness, PiecewiseLinear};
use fairflight_sources::{LARGEST_VARIATE, Scripted, UniformSource};
use fairflight_transmittance::{NextFlight, NextFlightVersion, Regular, TransmittanceEstimator};
use glam::{DVec3, dvec3};
use std::f64::consts::{PI, TAU};

fn tent() -> PiecewiseLinear {
    PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL)
}

/// A root that is left after a fixed number of digits.
struct Early;

impl<F: OpticalThickness> FreeFlight<F> for Early {
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        match Newton.sample(field, source) {
            // Right: the number nearest to the root.
            Flight::Collided { distance, weight } => {
                Flight::Collided { distance: (distance * 1e4).round() / 1e4, weight }
            }
            escaped @ Flight::Escaped { .. } => escaped,
        }
    }
    fn admits(&self, _field: &F, _s: f64, sigma_t: f64) -> bool {
        sigma_t >= 0.0
    }
}

/// A thickness by the midpoint rule on many cells.
fn midpoints<F: Extinction>(field: &F, from: f64, to: f64) -> f64 {
    const CELLS: u32 = 1000;
    let step = (to - from) / f64::from(CELLS);
    // Right: the closed form, or borders where the slope jumps.
    (0..CELLS).map(|i| step * field.sigma_t(from + (f64::from(i) + 0.5) * step)).sum()
}

/// A source of 256 levels.
struct EightBits<S>(S);

impl<S: UniformSource> UniformSource for EightBits<S> {
    fn next_uniform(&mut self) -> f64 {
        (256.0 * self.0.next_uniform()).floor() / 256.0 // right: the variate itself
    }
    fn next_exponential(&mut self) -> f64 {
        self.0.next_exponential()
    }
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    vec![
        twin(
            "free flight by newton",
            "newton_early",
            "the root to four digits after the point, for the one that is nearest",
            "piecewise linear",
            || (deviation_of_inverse(&tent(), &Early), thickness::GRANTED),
        )
        .answers(|vector, source| vector.flown(Early.sample(vector.of("inversion_flight")?, source))),
        twin(
            "optical thickness",
            "thickness_by_midpoints",
            "the midpoint rule on a thousand cells, whose error at a kink is taken for none",
            "piecewise linear",
            || {
                let wrong = Misstated { field: tent(), thickness: midpoints };
                (deviation_of_integral(&wrong), thickness::GRANTED)
            },
        )
        .answers(|vector, source| {
            let wrong = Misstated {
                field: vector.of("regular")?,
                thickness: |field, from, to| midpoints(field, from, to),
            };
            Some(Regular.estimate(&wrong, source).into())
        }),
        twin(
            "directions of an environment map",
            "pixel_without_a_border",
            "columns u (width − 1)/width for u, as if pixels were points",
            "a map of 1024 columns",
            || {
                let width = 1024.0;
                let map = |u: f64, v: f64| {
                    let (y, azimuth) = (1.0 - 2.0 * v, TAU * u * (width - 1.0) / width); // right: TAU * u
                    let horizontal = (1.0 - y * y).sqrt();
                    Some(dvec3(horizontal * azimuth.sin(), y, horizontal * azimuth.cos()))
                };
                (deviation(map, |_: DVec3| 1.0 / (4.0 * PI)), densities::GRANTED)
            },
        ),
        twin(
            "next flight",
            "acceptance_in_eight_bits",
            "the variate of a decision as one of 256 levels",
            "constant",
            || {
                let (share, majorant) = (0.37, 1.7);
                let levels = |u: f64| (256.0 * u).floor() / 256.0; // right: u
                let straight = |distance: f64| (-majorant * distance).exp();
                let found = expectation(|u| {
                    let field = Bounded::new(constant(share * majorant, 1.0), majorant);
                    let there = -(-0.4 * majorant).exp_m1();
                    let mut source = Scripted::new([there, levels(u), LARGEST_VARIATE]);
                    delta(&field.expect(LAWFUL), &mut source)
                });
                ((found / (straight(1.0) + (1.0 - share) * straight(0.6)) - 1.0).abs(), 1e-13)
            },
        )
        .answers(|vector, source| {
            let field = vector.bounded("next_flight")?;
            let is_delta = (vector.word)("/estimator/version")? == "delta";
            let delta = NextFlight::new(NextFlightVersion::Delta);
            is_delta.then(|| delta.estimate(&field, &mut EightBits(source)).into())
        }),
        twin(
            "next flight",
            "variance_of_delta_without_ends",
            "the variance of next flight after ratio tracking, for that after delta tracking",
            "piecewise linear",
            || {
                let field = Bounded::new(tent(), 2.0).expect(LAWFUL);
                let [wrong, right] =
                    [Scoring::Ratio, Scoring::Delta].map(|scoring| relative_variance(&field, scoring));
                ((wrong / right - 1.0).abs(), renewal::GRANTED)
            },
        ),
    ]
}

fn delta(field: &Bounded<Constant>, source: &mut impl UniformSource) -> f64 {
    NextFlight::new(NextFlightVersion::Delta).estimate(field, source)
}

/// A twin that is off by more than is granted.
fn twin(
    of: &'static str,
    id: &'static str,
    mistake: &'static str,
    profile: &'static str,
    off: impl Fn() -> (f64, f64) + Send + Sync + 'static,
) -> Twin {
    Twin::new(of, id, mistake, profile, (0, Evident::Exactly), move |_| {
        let (worst, granted) = off();
        // Far beyond rounding, and no failure of the comparison itself.
        Rejection::exact(worst > 100.0 * granted, format!("off by {worst:.1e} of {granted:.0e} granted"))
    })
}

#[cfg(test)]
mod tests {
    use fairflight_laws::Run;

    #[test]
    fn all_are_rejected() {
        for twin in super::twins() {
            let rejection = twin.run(Run { samples: 0, seed: 1, alpha: 1e-9 });
            assert!(rejection.rejected, "{}: {}", twin.id, rejection.reason);
        }
    }
}
