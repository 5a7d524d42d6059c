//! The law of a collision model as a function: exact algebra, no sampling.

use fairflight_collision::{Branch, CollisionModel};
use fairflight_sources::Scripted;

/// Ratios of every kind: both signs, next to the kinks at 0 and 1, tiny and huge.
pub const RATIOS: [f64; 16] =
    [-1e3, -2.0, -0.5, -1e-9, 0.0, 1e-9, 0.25, 0.5, 1.0 - 1e-8, 1.0, 1.0 + 1e-8, 1.05, 1.5, 2.0, 7.0, 1e3];

/// How a model breaks its law.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Broken {
    /// E\[energy\] of a branch is not what eq. 8 asks for.
    #[error("at r = {r} the {branch} energy is {found} on average, not {expected}")]
    Mean {
        /// The ratio.
        r: f64,
        /// Which of the two particles.
        branch: &'static str,
        /// What it has.
        found: f64,
        /// What it should have.
        expected: f64,
    },
    /// A probability outside \[0, 1\].
    #[error("at r = {r} the {branch} particle has the probability {found}")]
    Probability {
        /// The ratio.
        r: f64,
        /// Which of the two particles.
        branch: &'static str,
        /// What it has.
        found: f64,
    },
    /// Drawn weights are not those of the stated branch.
    #[error("at r = {r} the drawn weights are {found} on average, not {expected}")]
    Draw {
        /// The ratio.
        r: f64,
        /// What is drawn.
        found: f64,
        /// What is stated.
        expected: f64,
    },
}

/// How many equidistant variates stand for all of \[0, 1).
const STRATA: u32 = 1000;

/// Checks szirmay-kalos-2017 eq. 8, E\[scattered\] = a r and E\[transmitted\] = 1 − r, at every one of `ratios` that the
/// model admits, and that `transmit` draws what `transmitted` states.
///
/// # Errors
/// At the first ratio that breaks the law.
pub fn check<M: CollisionModel>(model: &M, albedo: f64, ratios: &[f64]) -> Result<(), Broken> {
    for &r in ratios.iter().filter(|&&r| model.admits(r)) {
        let transmitted = model.transmitted(r);
        check_branch("scattered", r, model.scattered(r), albedo * r)?;
        check_branch("transmitted", r, transmitted, 1.0 - r)?;
        // One variate in the middle of each stratum: a threshold moves the share of survivors by one stratum at most.
        let drawn: f64 = (0..STRATA)
            .map(|i| (f64::from(i) + 0.5) / f64::from(STRATA))
            .filter_map(|u| model.transmit(r, &mut Scripted::new([u])))
            .sum();
        let (found, expected) = (drawn / f64::from(STRATA), transmitted.moment(1));
        let granted = transmitted.energy.abs() / f64::from(STRATA);
        if (found - expected).abs() > granted + 1e-9 * expected.abs() {
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
            }
        }
    }
}
