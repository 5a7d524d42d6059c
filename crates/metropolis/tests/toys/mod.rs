//! Targets on [0, 1) whose image is known, and the law of replicas.

#![allow(dead_code, unreachable_pub, unused_imports)] // Each test file uses its part.

pub use fairflight_metropolis::laws::modes::{height as modes, image, integrand, pixel as half};
use fairflight_metropolis::{Film, Plan, Proposed, Target, Which};
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{Moments, Reference, Verdict, judge};

/// Seed of all laws.
pub const SEED: u64 = 1;

/// What a run deposits in the left pixel.
pub fn left(run: impl FnOnce(&mut Film<'_, f64>)) -> f64 {
    let mut sum = 0.0;
    run(&mut |pixel, value| sum += if pixel == [0, 0] { value } else { 0.0 });
    sum
}

/// What replica `seed` of a plan deposits in the left pixel, and its b.
pub fn score(plan: &Plan, target: &mut dyn Target<f64>, seed: u64) -> (f64, f64) {
    let mut brightness = 0.0;
    let left = left(|film| {
        let replica = plan.replica(target, (0, seed), film).unwrap();
        brightness = replica.bootstrap.mean().unwrap();
    });
    (left, brightness)
}

/// Law of replicas: their mean score of the left pixel is what it holds.
///
/// False alarm 1e-6.
pub fn verdict(replicas: u64, seed: u64, mut score: impl FnMut(u64) -> f64) -> Verdict {
    let moments: Moments = (0..replicas).map(|index| score(derive_seed(seed, index))).collect();
    judge(&moments, &Reference::exact(image()[0]).with_mild_tails(), 1e-6)
}

/// Asserts that a law accepts, and would have found a bias of a tenth.
pub fn accepted(name: &str, verdict: &Verdict) {
    println!("{name}: z {:+.1}, {:?}", verdict.mean_z.unwrap_or(0.0), verdict.detectable_relative_bias);
    assert_eq!(verdict.sound, Some(true), "{name}: {}", verdict.reason);
    assert!(verdict.detectable_relative_bias.is_some_and(|bias| bias < 0.2), "{name}: {}", verdict.reason);
}

/// Asserts that a law rejects.
pub fn rejected(name: &str, verdict: &Verdict) {
    println!("{name}: z {:+.1}", verdict.mean_z.unwrap_or(0.0));
    assert_eq!(verdict.sound, Some(false), "{name}: {}", verdict.reason);
}

/// A target whose proposals are what `propose` makes of them: `inner` moves as it likes before.
pub struct Altered<T, P> {
    pub inner: T,
    pub propose: P,
    /// Deposits of both states exchanged.
    pub swapped: bool,
}

impl<C, T: Target<C>, P: FnMut(&mut T, &mut dyn UniformSource) -> Proposed> Target<C> for Altered<T, P> {
    fn draw(&mut self, source: &mut dyn UniformSource) -> f64 {
        self.inner.draw(source)
    }
    fn propose(&mut self, source: &mut dyn UniformSource) -> Proposed {
        (self.propose)(&mut self.inner, source)
    }
    fn accept(&mut self) {
        self.inner.accept();
    }
    fn deposit(&self, which: Which, energy: f64, film: &mut Film<'_, C>) {
        let other = match which {
            Which::Present => Which::Proposed,
            Which::Proposed => Which::Present,
        };
        self.inner.deposit(if self.swapped { other } else { which }, energy, film);
    }
    fn kinds(&self) -> &[&'static str] {
        self.inner.kinds()
    }
}

/// A stream of its own.
pub fn stream(seed: u64, index: u64) -> Seeded {
    Seeded::new(derive_seed(seed, 1000 + index))
}
