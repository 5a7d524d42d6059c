//! Energy redistribution: chains from every sample that finds light, in proportion to the light.

use crate::{Acceptance, Chain, Film, NotFinite, Target};
use fairflight_sources::{Seeded, UniformSource, derive_seed};

/// Energy of independent samples, spread by chains (cline-2005, antwerpen-2011 section 6.8 and algorithm 8).
///
/// ```text
/// draw X with W = f*/p
/// n = ⌊U + W/(N e)⌋ chains of N steps from X, each step scores the energy e
/// ```
///
/// **Law.** Given X, the expected number of chains is W/(N e), and the energy of each N e: together W, at X if the chains stand still. A step that
/// keeps f* keeps the image, so that E\[film\] = ∫ F for any such step: chains need not be ergodic, and no brightness is asked for. e must be
/// fixed before, from other streams.
///
/// **Cap.** At most `most` chains per sample, without a bias: where W/(N e) is greater, each chain scores as much more. Fewer chains with the energy
/// unchanged lose light.
///
/// **Variance.** e = b/(N M) makes M chains per sample on average, b the brightness, known as roughly as one likes.
///
/// **Pitfall.** antwerpen-2011 eq. 6.12 lost its ⌊ ⌋; algorithm 8 has it. Neither U = 1/2 nor one chain at least has the expectation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Redistribution {
    steps: u64,
    energy: f64,
    most: f64,
}

/// Error of a redistribution that redistributes nothing.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RedistributionError {
    /// A chain of no steps scores nothing.
    #[error("chains need at least one step")]
    NoSteps,
    /// The energy of a step is none.
    #[error("the energy of a step must be a finite number above 0, found {0}")]
    NotEnergy(f64),
    /// A cap of no chains.
    #[error("a sample needs at least one chain at most")]
    NoChains,
}

/// Weight of one sample, and the number of chains that it started.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Redistributed {
    /// W of the sample.
    pub weight: f64,
    /// Number of chains.
    pub chains: u64,
}

impl Redistribution {
    /// Chains of `steps` steps, each of which scores `energy`.
    ///
    /// # Errors
    /// If there are no steps, or the energy is not positive and finite.
    pub fn new(steps: u64, energy: f64) -> Result<Self, RedistributionError> {
        if steps == 0 {
            Err(RedistributionError::NoSteps)
        } else if !(energy > 0.0 && energy.is_finite()) {
            Err(RedistributionError::NotEnergy(energy))
        } else {
            Ok(Self { steps, energy, most: f64::INFINITY })
        }
    }

    /// The same with at most `most` chains per sample, whose energy is raised where that is fewer.
    ///
    /// # Errors
    /// If it is 0.
    pub fn with_most_chains(self, most: u64) -> Result<Self, RedistributionError> {
        if most == 0 { Err(RedistributionError::NoChains) } else { Ok(Self { most: most as f64, ..self }) }
    }

    /// Redistributes sample `index` of the run with this `seed`, and counts steps in `counts`, one for each of [`Target::kinds`].
    ///
    /// Samples have streams of their own, and are averaged: the image is the mean of what `film` is given for each. They are independent, so
    /// that errors are those of a mean over samples.
    ///
    /// # Errors
    /// If a contribution is not finite.
    pub fn sample<C>(
        &self,
        target: &mut dyn Target<C>,
        (index, seed): (u64, u64),
        counts: &mut [Acceptance],
        film: &mut Film<'_, C>,
    ) -> Result<Redistributed, NotFinite> {
        let [start, steps] = [0, 1].map(|stream| derive_seed(derive_seed(seed, index), stream));
        let mut source = Seeded::new(steps);
        let weight = target.draw(&mut Seeded::new(start));
        if !weight.is_finite() {
            return Err(NotFinite);
        }
        if weight == 0.0 {
            return Ok(Redistributed::default());
        }
        let expected = weight / (self.steps as f64 * self.energy);
        let capped = expected.min(self.most);
        let chains = (source.next_uniform() + capped).floor() as u64;
        for chain in 0..chains {
            if chain > 0 {
                // From where the one before began.
                target.draw(&mut Seeded::new(start));
            }
            target.accept();
            let mut chain = Chain::new(target, self.energy * (expected / capped));
            for _ in 0..self.steps {
                chain.step(film, counts, &mut source)?;
            }
            chain.finish(film);
        }
        Ok(Redistributed { weight, chains })
    }
}
