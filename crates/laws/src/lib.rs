//! The laws of the estimators as functions.
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
pub use p_value::{Level, PValue};
pub use result::CheckResult;
pub use run::Run;
pub use transmittance::{Evidence, Expectation, Refusal};
pub use truth::{Truth, Unit};
