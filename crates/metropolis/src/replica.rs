//! Replicas: independent estimates of an image, each a bootstrap set and its chains.

use crate::{Acceptance, Bootstrap, Chain, Film, NotFinite, Target};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::{Autocorrelation, Moments};

/// Sizes of a replica.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    bootstrap: u64,
    chains: u64,
    steps: u64,
}

/// Sizes of a replica that leave nothing to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlanError {
    /// Without independent samples there is neither a start nor a brightness.
    #[error("a replica needs at least one sample to start from")]
    NoBootstrap,
    /// A chain of no steps scores nothing.
    #[error(
        "a replica needs at least one chain, and a step for each: found {chains} chains and {steps} steps"
    )]
    NoSteps {
        /// Chains asked for.
        chains: u64,
        /// Steps asked for.
        steps: u64,
    },
}

/// A contribution that is no finite number, and where it was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a contribution is not finite: replica {replica}, {phase} {index}")]
pub struct Refused {
    /// The replica.
    pub replica: u64,
    /// Part of the replica.
    pub phase: Phase,
    /// Number of the sample or the step in it, from 0.
    pub index: u64,
}

/// Part of a replica.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Independent samples before the chains.
    Bootstrap,
    /// Steps of the chains, one after the other.
    Steps,
}

impl std::fmt::Display for Phase {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Bootstrap => "sample",
            Self::Steps => "step",
        })
    }
}

/// What a replica says of itself, beside its image.
#[derive(Clone, Debug)]
pub struct Replica {
    /// Moments of the independent samples' weights, whose mean is b̂.
    pub bootstrap: Moments,
    /// True if no independent sample found light: the image is black, and counts as any other.
    pub is_black: bool,
    /// Acceptance of each of [`Target::kinds`].
    pub acceptance: Vec<Acceptance>,
    /// Series of ln f* along the chains: how many steps are as good as one independent sample, as a diagnosis. Errors come from replicas alone.
    pub autocorrelation: Autocorrelation,
}

impl Plan {
    /// `bootstrap` independent samples, then `steps` steps in all of `chains` chains.
    ///
    /// # Errors
    /// If there is no sample, no chain, or a chain without a step.
    pub fn new(bootstrap: u64, chains: u64, steps: u64) -> Result<Self, PlanError> {
        if bootstrap == 0 {
            Err(PlanError::NoBootstrap)
        } else if chains == 0 || steps < chains {
            Err(PlanError::NoSteps { chains, steps })
        } else {
            Ok(Self { bootstrap, chains, steps })
        }
    }

    /// Evaluations of the target: samples and steps.
    #[must_use]
    pub fn evaluations(&self) -> u64 {
        self.bootstrap + self.steps
    }

    /// Runs replica `index` of a run with this `seed`.
    ///
    /// **Law.** The expectation of what `film` is given, summed for each pixel, is the image of the target ([`Bootstrap`]), for every size.
    ///
    /// **Variance.** Its error is that of a mean over replicas, of equal weight, and of nothing else: scores of one chain are correlated, as are
    /// chains of one bootstrap set. A replica that is shorter than the rarest mode is rare is of no use, though it has no bias.
    ///
    /// # Errors
    /// If a contribution is not finite.
    pub fn replica<C>(
        &self,
        target: &mut dyn Target<C>,
        (index, seed): (u64, u64),
        film: &mut Film<'_, C>,
    ) -> Result<Replica, Refused> {
        let [samples, steps] = [0, 1].map(|stream| derive_seed(derive_seed(seed, index), stream));
        let refused = |phase| move |number| Refused { replica: index, phase, index: number };
        let bootstrap = Bootstrap::draw(target, self.bootstrap, samples)
            .map_err(|(number, NotFinite)| refused(Phase::Bootstrap)(number))?;
        let mut acceptance = vec![Acceptance::default(); target.kinds().len()];
        let mut source = Seeded::new(steps);
        let energy = bootstrap.brightness() / self.steps as f64;
        let mut autocorrelation = Autocorrelation::new();
        let mut is_black = false;
        let mut number = 0;
        for chain in 0..self.chains {
            let Some(start) = bootstrap.choose(&mut source) else {
                is_black = true;
                break;
            };
            bootstrap.start(target, start);
            let mut chain_of = Chain::new(target, energy);
            let share = self.steps / self.chains + u64::from(chain < self.steps % self.chains);
            for _ in 0..share {
                let step = chain_of.step(film, &mut acceptance, &mut source);
                step.map_err(|NotFinite| refused(Phase::Steps)(number))?;
                number += 1;
                let ln_present = chain_of.ln_present();
                if ln_present.is_finite() {
                    autocorrelation.push(ln_present);
                }
            }
            chain_of.finish(film);
            autocorrelation.end();
        }
        Ok(Replica { bootstrap: *bootstrap.weights(), is_black, acceptance, autocorrelation })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_replica_that_does_nothing_is_refused() {
        assert_eq!(Plan::new(0, 1, 1), Err(PlanError::NoBootstrap));
        for (chains, steps) in [(0, 0), (0, 5), (3, 2)] {
            assert_eq!(Plan::new(1, chains, steps), Err(PlanError::NoSteps { chains, steps }));
        }
        assert_eq!(Plan::new(3, 2, 5).unwrap().evaluations(), 8);
    }
}
