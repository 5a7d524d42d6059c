//! One chain: expected-value scores of both states of each step.

use crate::{Acceptance, Film, Proposed, Target, Which};
use fairflight_sources::UniformSource;

/// A chain of states that follows a target (antwerpen-2011 algorithm 5, raab-2008 section 4.4).
///
/// ```text
/// repeat
///     propose y from x, with acceptance a
///     score a · energy F(y)/f*(y) and (1 − a) · energy F(x)/f*(x)
///     x = y with the probability a
/// ```
///
/// **Law.** From a state x with the density f*/b, the expected score of each step is energy/b · ∫ F. Of a start with another density
/// the start-up bias remains (antwerpen-2011 section 6.5): [`Bootstrap`](crate::Bootstrap) avoids it.
///
/// **Pitfall.** antwerpen-2011 algorithm 5 prints the two scores exchanged; its algorithm 8 has them as here.
pub struct Chain<'t, C> {
    target: &'t mut dyn Target<C>,
    energy: f64,
    /// Energy that the present state was left with and has not deposited.
    held: f64,
}

impl<C> std::fmt::Debug for Chain<'_, C> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { energy, held, .. } = self;
        formatter.debug_struct("Chain").field("energy", energy).field("held", held).finish_non_exhaustive()
    }
}

/// A contribution that is no finite number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite;

impl<'t, C> Chain<'t, C> {
    /// A chain from the present state of `target` that scores `energy` per step.
    pub fn new(target: &'t mut dyn Target<C>, energy: f64) -> Self {
        Self { target, energy, held: 0.0 }
    }

    /// Makes one step, and counts it in `counts`, one for each of [`Target::kinds`].
    ///
    /// # Errors
    /// If the proposal's contribution is not finite.
    pub fn step(
        &mut self,
        film: &mut Film<'_, C>,
        counts: &mut [Acceptance],
        source: &mut dyn UniformSource,
    ) -> Result<(), NotFinite> {
        let Proposed { kind, acceptance } = self.target.propose(source);
        if acceptance.is_nan() {
            return Err(NotFinite);
        }
        debug_assert!((0.0..=1.0).contains(&acceptance), "an acceptance of {acceptance}");
        counts[kind].proposed += 1;
        counts[kind].accepted += acceptance;
        // The score of a state is kept until it is left: it is deposited once, however often it was stayed in.
        self.held += (1.0 - acceptance) * self.energy;
        if source.next_uniform() < acceptance {
            self.finish(film);
            self.target.accept();
            self.held = acceptance * self.energy;
        } else if acceptance > 0.0 {
            self.target.deposit(Which::Proposed, acceptance * self.energy, film);
        }
        Ok(())
    }

    /// ln f* of the present state ([`Target::ln_present`]).
    #[must_use]
    pub fn ln_present(&self) -> f64 {
        self.target.ln_present()
    }

    /// Deposits what the present state still holds: to be called behind the last step.
    pub fn finish(&mut self, film: &mut Film<'_, C>) {
        let held = std::mem::take(&mut self.held);
        if held > 0.0 {
            self.target.deposit(Which::Present, held, film);
        }
    }
}
