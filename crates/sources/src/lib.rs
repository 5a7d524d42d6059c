//! Uniform variates, and nothing else: every random decision of the project is drawn from a [`UniformSource`].
//!
//! A source is always the last argument, mutable and explicit. There is no thread-local and no operating-system
//! randomness anywhere, so that a number can be reproduced from its seed alone.
//!
//! * [`Seeded`]: xoshiro256++ (Blackman & Vigna 2021), one stream per batch.
//! * [`Scripted`]: a fixed list that panics when it is exhausted: exact algebra and draw counts in tests.
//! * [`Counting`]: how many variates a sampler draws.
//! * [`Replayed`]: the variates of a path, changed a little: steps of Metropolis sampling. A path tells it by [`Row`]s what it draws for.
//! * [`points`]: the points of [`Sobol`], [`Halton`], [`Hammersley`] and [`LatinHypercube`], randomised, each a source of its own.
//!
//! **Law.** A variate u is an integer multiple of 2⁻⁵³ in \[0, 1), uniform on that lattice, independent of those before it; an exponential one is
//! −ln(1 − u), of mean 1 and finite, since 1 − u is never 0 (inversion; [`UniformSource::next_exponential`]). All that an estimator proves of itself
//! is proved given this.
//!
//! # Porting
//!
//! A port draws what its original draws, in the same order, and of two kinds: `u`, a uniform variate, and `e`, an exponential one made of a uniform
//! one. The test vectors (`tests/vectors/KIND.jsonl`) write a variate as the integer k of u = k 2⁻⁵³, which every reader of JSON has exactly, and
//! beside an `e` its value, correctly rounded: a port need not have our logarithm. A port with a generator of its own passes the vectors just as
//! well; one that is to repeat our streams, too, begins batch b of 4096 estimates with [`Seeded::for_batch`]`(seed, b)`, the batch 0 not excepted,
//! that is from [`derive_seed`]`(seed, b)`, filled into xoshiro256++ (blackman-2021) by SplitMix64 (steele-2014), and takes the 53 high bits of each
//! word. The page is `docs/PORTING.md`; [`Scripted`] replays vectors in Rust.
//!
//! ```
//! use fairflight_sources::{Scripted, Seeded, UniformSource, derive_seed};
//!
//! // The third stream of seed 7: the same numbers on any machine and any thread.
//! let mut source = Seeded::new(derive_seed(7, 2));
//! assert!((0.0..1.0).contains(&source.next_uniform()));
//!
//! // In a test: the variates are known, so the distance is.
//! let mut source = Scripted::new([0.0]);
//! assert_eq!(source.next_exponential(), 0.0);
//! ```

mod counting;
mod lanes;
pub mod points;
mod replayed;
mod row;
mod scripted;
mod seeded;
mod small_step;

pub use counting::Counting;
pub use lanes::SeededLanes;
pub use points::{Halton, Hammersley, LatinHypercube, PointSet, PointSetError, PointSource, Sobol};
pub use replayed::{Layout, Replayed, Step, Variates};
pub use row::{PathEnd, Purpose, Row};
pub use scripted::Scripted;
pub use seeded::{Seeded, derive_seed, named_seed};
pub use small_step::{SmallStep, SmallStepError};

/// The largest variate that a source returns: 1 − 2^-53.
pub const LARGEST_VARIATE: f64 = 1.0 - f64::EPSILON / 2.0;

/// A sequence of variates, uniform on `[0, 1)` and independent within one estimate.
///
/// **Law.** Each variate is uniform on the lattice `k · 2^-53`, `k = 0 … 2^53 − 1`: 0 occurs, 1 never does, and `1 − u`
/// is exact in double precision. Those that one estimate draws are independent of each other: an estimate is unbiased
/// whatever source it draws from.
///
/// Two estimates are independent where their sources are: one stream of a generator that both draw from in turn, or streams
/// of different seeds. The sources of one [`PointSet`] are not, on purpose: their estimates may be averaged, and the
/// variance of the mean is measured over replicas ([`points`]).
pub trait UniformSource {
    /// The next variate in `[0, 1)`.
    fn next_uniform(&mut self) -> f64;

    /// The next variate of the unit exponential distribution, −ln(1 − u): an optical distance.
    ///
    /// `1 − u` is never 0 on the lattice, so that the result is finite (at most 53 ln 2 = 36.7) for every variate. The
    /// form −ln(u) that papers print is infinite at `u = 0` (szirmay-kalos-2017 eq. 4 and raab-2008 eq. 11 are right,
    /// raab-2008 algorithm 1 is not).
    #[inline]
    fn next_exponential(&mut self) -> f64 {
        -fairflight_elementary::ln(1.0 - self.next_uniform())
    }

    /// Turns to a row: what is drawn from here on belongs to it.
    ///
    /// Changes no law, and costs nothing: only a source that replays a path listens ([`Replayed`]).
    #[inline]
    fn row(&mut self, _row: Row) {}
}

impl<S: UniformSource + ?Sized> UniformSource for &mut S {
    #[inline]
    fn next_uniform(&mut self) -> f64 {
        (**self).next_uniform()
    }

    #[inline]
    fn row(&mut self, row: Row) {
        (**self).row(row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exponential_variate_is_finite_at_both_ends_of_the_lattice() {
        let mut ends = Scripted::new([0.0, LARGEST_VARIATE]);
        assert_eq!(ends.next_exponential(), 0.0);
        assert!((ends.next_exponential() - 53.0 * std::f64::consts::LN_2).abs() < 1e-12);
    }

    #[test]
    fn a_source_can_be_a_trait_object() {
        let mut seeded = Seeded::new(1);
        let expected = Seeded::new(1).next_uniform();
        let object: &mut dyn UniformSource = &mut seeded;
        assert_eq!(object.next_uniform(), expected);
    }
}
