//! The laws of the estimators as functions, their wrong twins, and the hard cases as data.
//!
//! * [`transmittance::check`], [`collision::check`], [`freeflight::check`], [`phase::check`]: one law each, for any
//!   implementer.
//! * [`spectral`]: the law of free flight for each of several wavelengths.
//! * [`paths`]: radiance against quadrature, slabs and closed forms.
//! * [`vpl`]: virtual point lights, what bounding them takes away, and light among surfaces.
//! * [`exact`]: what a decision, a density or a closed form must be, without chance.
//! * [`scores`]: which values an estimate can take, derived from what is known of a profile.
//! * [`twins()`]: estimators with one line wrong, each of which the same check must reject.
//! * [`hard_cases()`]: numerically hard inputs with their exact answers.
//! * [`catalogue()`]: all of these by name, over a set of media: what `verify` runs.
//!
//! Nothing here knows files, clocks, threads or plots. Every check is a function of its [`Run`] alone, so that a caller
//! may run many at once.

mod batch;
mod catalogue;
mod dense;
mod hard_cases;
mod kind;
mod p_value;
mod result;
mod run;
mod truth;
mod twins;

pub mod collision;
pub mod exact;
pub mod freeflight;
pub mod lookups;
pub mod paths;
pub mod phase;
pub mod scores;
pub mod spectral;
pub mod transmittance;
pub mod vpl;

pub use batch::{BATCH, NotFinite, batch_count, batch_moments, batch_size, draw_batch, measure};
pub use catalogue::{Check, Effort, FAMILY_LEVEL, FAMILY_SIZE, Law, catalogue, check_level};
pub use dense::DenseLattice;
pub use hard_cases::{HardCase, Outcome, hard_cases};
pub use kind::Kind;
pub use p_value::{Level, PValue};
pub use result::CheckResult;
pub use run::Run;
pub use transmittance::{Evidence, Expectation, Refusal};
pub use truth::{Truth, Unit};
pub use twins::{Evident, Rejection, Twin, twins};
