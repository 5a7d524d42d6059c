//! Statistics of estimators: mergeable moments, tests of a mean, a variance and a distribution, and their verdicts.
//!
//! [`Moments`] observes, [`Reference`] says what should have come out, [`judge`] compares: sound, unsound, or not
//! testable at this N. The parts are open to other uses: [`binomial`], [`bernstein`], [`normal`] and [`approximation`]
//! are the tests of a mean and when they hold, [`family`] keeps the false alarm of many checks. Samplers are tested
//! against a whole distribution: [`chi_square()`] by cells, [`kolmogorov_smirnov()`] by its distribution function.
//!
//! The crate knows numbers only: no light transport, no files, clocks, threads or random sources.
//!
//! **Law.** A right estimator is called unsound with a probability of at most α, whatever its distribution and for every N: a normal approximation is
//! used only where its error is bounded from closed moments ([`approximation`]), elsewhere the binomial law or an exponential inequality
//! ([`bernstein`]). A call is sound only if a relative bias of [`MAX_DETECTABLE_RELATIVE_BIAS`] would have been found with probability [`POWER`];
//! what neither test can tell is not testable, and says the N that it would take. Moments are streamed and merged without cancellation (pebay-2008).
//!
//! # Porting
//!
//! Vectors (`tests/vectors/KIND.jsonl`) show that a port computes what its original computes of the same variates; that it draws them rightly only a
//! statistical test shows. For that a port needs this crate's three steps: the moments of its estimates, the mean and variance that they should have
//! (`harness estimate` tells them for any profile and estimator, closed form first), and the verdict. From Python it is one call,
//! `fairflight.judge(estimates, mean, variance)` (`docs/PYTHON.md`). The page for ports is
//! `docs/PORTING.md`.
//!
//! ```
//! use fairflight_stats::{Moments, Reference, Scores, judge};
//!
//! // Estimates of T = 0.1 that are 0 or 1: the number of ones has a binomial law, and the test is exact.
//! let estimates: Moments = (0..100_000).map(|i| f64::from(i % 10 == 0)).collect();
//! let reference = Reference { scores: Scores::TwoValued { high: 1.0 }, ..Reference::exact(0.1) };
//! let verdict = judge(&estimates, &reference, 1e-6);
//! assert_eq!(verdict.sound, Some(true));
//! // A bias of this size would have been found with a probability of 0.99.
//! assert!(verdict.detectable_relative_bias.unwrap() < 0.07);
//! ```

mod evidence;
mod halving;
mod inequalities;
mod judge;
mod mean_test;
mod normal_test;
mod policy;
mod sample_size;
mod variance_test;

pub mod approximation;
pub mod autocorrelation;
pub mod bernstein;
pub mod binomial;
pub mod binomial_inference;
pub mod chi_square;
pub mod closed_moments;
pub mod family;
pub mod goodness;
pub mod kolmogorov_smirnov;
pub mod moments;
pub mod normal;
pub mod reference;
pub mod student;
pub mod verdict;

pub use approximation::NormalApproximation;
pub use autocorrelation::Autocorrelation;
pub use bernstein::Bernstein;
pub use binomial::{Binomial, BinomialError};
pub use binomial_inference::{clopper_pearson, trials_needed};
pub use chi_square::chi_square;
pub use closed_moments::ClosedMoments;
pub use family::{holm_rejections, sidak_level};
pub use goodness::GoodnessOfFit;
pub use judge::judge;
pub use kolmogorov_smirnov::kolmogorov_smirnov;
pub use moments::Moments;
pub use policy::{DEFAULT_ALPHA, MAX_DETECTABLE_RELATIVE_BIAS, POWER};
pub use reference::{Certainty, Reference, Scores, Tails};
pub use sample_size::samples_needed;
pub use student::student_two_sided_quantile;
pub use verdict::{MeanTest, StandardErrorSource, Verdict};

#[cfg(test)]
mod test_support;
