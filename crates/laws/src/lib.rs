//! The laws of estimators and free flights as functions: what a new one of your own can be tried with.
//!
//! [`measure`] draws, [`judge`] compares with what should have come out: sound, unsound, or not testable at this N.
//!
//! ```
//! use fairflight_laws::{Reference, Scores, judge, measure};
//! use fairflight_media::{Extinction, PiecewiseLinear};
//! use fairflight_sources::UniformSource;
//!
//! /// Ratio tracking at the rate `sigma_samp`.
//! fn estimate(field: &impl Extinction, sigma_samp: f64, source: &mut impl UniformSource) -> f64 {
//!     let (mut weight, mut s) = (1.0, source.next_exponential() / sigma_samp);
//!     while s < field.length() {
//!         weight *= 1.0 - field.sigma_t(s) / sigma_samp;
//!         s += source.next_exponential() / sigma_samp;
//!     }
//!     weight
//! }
//!
//! // σ_t rises to 0.8 and falls again: an optical thickness of 1.2.
//! let field = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 0.8, 0.0]).unwrap();
//! // What is known of the estimates makes the test a sharp one: at a rate above 0.8 they lie between 0 and 1.
//! let scores = Scores::Bounded { minimum: 0.0, maximum: 1.0 };
//! let transmittance = Reference { scores, ..Reference::exact((-1.2_f64).exp()) };
//! let ours = measure(7, 200_000, |source| estimate(&field, 1.0, source)).unwrap();
//! assert_eq!(judge(&ours, &transmittance, 1e-6).sound, Some(true));
//!
//! // The exponential of one look-up anywhere, times the length: biased by Jensen's inequality, and found out.
//! let twin = |source: &mut _| (-3.0 * field.sigma_t(3.0 * UniformSource::next_uniform(source))).exp();
//! let twin = measure(7, 200_000, twin).unwrap();
//! assert_eq!(judge(&twin, &transmittance, 1e-6).sound, Some(false));
//! ```
//!
//! An estimator that states its closed form is also judged by its variance and its look-ups:
//!
//! * [`transmittance::check`], [`collision::check`], [`freeflight::check`], [`phase::check`]: one law each, for any
//!   implementer.
//! * [`spectral`]: the law of free flight for each of several wavelengths.
//! * [`exact`]: what a decision, a density or a closed form must be, without chance.
//! * [`scores`]: which values an estimate can take, derived from what is known of a profile.
//!
//! Nothing here knows files, clocks, threads or plots. Every check is a function of its [`Run`] alone, so that a caller
//! may run many at once.

mod batch;
mod dense;
mod p_value;
mod result;
mod run;
mod truth;

pub mod collision;
pub mod exact;
pub mod freeflight;
pub mod lookups;
pub mod phase;
pub mod scores;
pub mod spectral;
pub mod transmittance;

pub use batch::{BATCH, NotFinite, batch_count, batch_moments, batch_size, draw_batch, measure};
pub use dense::DenseLattice;
pub use fairflight_stats::{Reference, Scores, Verdict, judge};
pub use p_value::{Level, PValue};
pub use result::CheckResult;
pub use run::Run;
pub use transmittance::{Evidence, Expectation, Refusal};
pub use truth::{Truth, Unit};
