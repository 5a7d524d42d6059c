//! The law of a collision model as a function: exact algebra, no sampling.

use crate::exact::decisions::expectations;
use fairflight_collision::{Branch, CollisionModel, Outcome, SingleOutcome};
use fairflight_sources::Scripted;

/// Ratios of every kind: both signs, next to the kinks at 0 and 1, tiny and huge.
pub const RATIOS: [f64; 16] =
    [-1e3, -2.0, -0.5, -1e-9, 0.0, 1e-9, 0.25, 0.5, 1.0 - 1e-8, 1.0, 1.0 + 1e-8, 1.05, 1.5, 2.0, 7.0, 1e3];

/// Violation of the law of a collision model.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Broken {
    /// E\[energy\] of a branch is not what eq. 8 asks for.
    #[error("at r = {r} the {branch} energy is {found} on average, not {expected}")]
    Mean {
        /// The ratio.
        r: f64,
        /// The name of the particle, scattered or transmitted.
        branch: &'static str,
        /// The expected energy that it has.
        found: f64,
        /// The expected energy that it should have.
        expected: f64,
    },
    /// A probability outside \[0, 1\].
    #[error("at r = {r} the {branch} particle has the probability {found}")]
    Probability {
        /// The ratio.
        r: f64,
        /// The name of the particle, scattered or transmitted.
        branch: &'static str,
        /// The probability that it has.
        found: f64,
    },
    /// Drawn weights, or their squares, are not those of the stated branch.
    #[error("at r = {r} the drawn weights, or their squares, are {found} on average, not {expected}")]
    Draw {
        /// The ratio.
        r: f64,
        /// The mean of the drawn weights, or of their squares.
        found: f64,
        /// The mean of the stated branch.
        expected: f64,
    },
}

/// Rounding of a mean by that of a threshold and of the sum over its two sides, per unit of 1 + |energy|.
const THRESHOLD: f64 = 1e-12;

/// Checks szirmay-kalos-2017 eq. 8, E\[scattered\] = a r and E\[transmitted\] = 1 − r, at every one of `ratios` that the
/// model admits, and that `transmit` draws what `transmitted` states: over all of its variate, exactly.
///
/// # Errors
/// At the first ratio that breaks the law.
pub fn check<M: CollisionModel>(model: &M, albedo: f64, ratios: &[f64]) -> Result<(), Broken> {
    for &r in ratios.iter().filter(|&&r| model.admits(r)) {
        let transmitted = model.transmitted(r);
        check_branch("scattered", r, model.scattered(r), albedo * r)?;
        check_branch("transmitted", r, transmitted, 1.0 - r)?;
        let drawn = expectations(|u| powers(model.transmit(r, &mut Scripted::new([u]))));
        check_draws(r, transmitted, drawn)?;
    }
    Ok(())
}

/// Checks that `collide` scatters and transmits with the probabilities and energies that `scattered` and `transmitted` state, at
/// every one of `ratios` that the model admits.
///
/// # Errors
/// At the first ratio that breaks the law.
pub fn check_outcomes<M: SingleOutcome>(model: &M, ratios: &[f64]) -> Result<(), Broken> {
    for &r in ratios.iter().filter(|&&r| model.admits(r)) {
        let [s, s2, t, t2] = expectations(|u| {
            let (scattered, transmitted) = match model.collide(r, &mut Scripted::new([u])) {
                Outcome::Scattered(energy) => (Some(energy), None),
                Outcome::Transmitted(energy) => (None, Some(energy)),
                Outcome::Absorbed => (None, None),
            };
            let ([s, s2], [t, t2]) = (powers(scattered), powers(transmitted));
            [s, s2, t, t2]
        });
        check_draws(r, model.scattered(r), [s, s2])?;
        check_draws(r, model.transmitted(r), [t, t2])?;
    }
    Ok(())
}

/// An energy and its square; 0 for a particle that does not leave.
fn powers(energy: Option<f64>) -> [f64; 2] {
    energy.map_or([0.0; 2], |energy| [energy, energy * energy])
}

/// Mean and mean square of what is drawn against those of the branch.
fn check_draws(r: f64, branch: Branch, drawn: [f64; 2]) -> Result<(), Broken> {
    for (k, found) in [1, 2].into_iter().zip(drawn) {
        let expected = branch.moment(k);
        let granted = THRESHOLD * (1.0 + branch.energy.abs().powi(k));
        if found.is_nan() || (found - expected).abs() > granted {
            return Err(Broken::Draw { r, found, expected });
        }
    }
    Ok(())
}

fn check_branch(name: &'static str, r: f64, branch: Branch, expected: f64) -> Result<(), Broken> {
    const ROUNDING: f64 = 8.0 * f64::EPSILON;
    let found = branch.moment(1);
    if !(0.0..=1.0 + ROUNDING).contains(&branch.probability) {
        return Err(Broken::Probability { r, branch: name, found: branch.probability });
    }
    // 1 − r is rounded at the size of r, or of 1.
    let granted = ROUNDING * (expected.abs() + f64::EPSILON * (1.0 + r.abs()));
    if found.is_nan() || (found - expected).abs() > granted {
        return Err(Broken::Mean { r, branch: name, found, expected });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version, Woodcock};

    #[test]
    fn every_model_obeys_its_law() {
        for a in [0.0, 0.3, 0.9, 1.0] {
            let albedo = Albedo::new(a).unwrap();
            check(&Woodcock { albedo }, a, &RATIOS).unwrap();
            check(&DoubleParticle { albedo }, a, &RATIOS).unwrap();
            for version in [Version::Terminating, Version::NonTerminating, Version::Adaptive] {
                check(&SingleParticle { version, albedo }, a, &RATIOS).unwrap();
                check_outcomes(&SingleParticle { version, albedo }, &RATIOS).unwrap();
            }
            check_outcomes(&Woodcock { albedo }, &RATIOS).unwrap();
        }
    }
}
