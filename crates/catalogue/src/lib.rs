//! Checks of Fairflight as data: every law on every medium, wrong twins, hard cases.
//!
//! * [`catalogue()`]: all checks by name, what `verify` runs.
//! * [`twins()`]: estimators with one line wrong, each of which the same check must reject.
//! * [`hard_cases()`]: numerically hard inputs with their exact answers.
//! * [`paths`]: the laws of walks in space: radiance against quadrature, slabs and closed forms.
//! * [`bidirectional`]: weights of paths joined from both ends, pairs of strategies, their expectation.
//! * [`vpl`]: the laws of virtual point lights: what bounding them takes away, and light among surfaces.
//!
//! The laws of estimators, free flights and phase functions are functions of `fairflight-laws`. Nothing here knows files, clocks,
//! threads or plots. Every check is a function of its [`Run`](fairflight_laws::Run) alone, so that a caller may run many at once.
//!
//! ```
//! use fairflight_catalogue::{Effort, catalogue, check_level};
//!
//! // The decision of delta tracking at a collision, checked without chance.
//! let check = catalogue().into_iter().find(|check| check.id == "exact/decision/woodcock").unwrap();
//! assert_eq!(check.kinds, ["woodcock"]);
//! assert_eq!(check.run(Effort::Quick, 1, check_level()).holds, Some(true));
//! ```

mod checks;
mod estimators;
mod extensions;
mod function;
mod hard_cases;
mod metropolis;
mod twins;

pub mod bidirectional;
pub mod paths;
mod profiles;
pub mod vectors;
pub mod vpl;

pub use checks::{Check, Effort, FAMILY_LEVEL, FAMILY_SIZE, Law, catalogue, check_level};
pub use hard_cases::{HardCase, Outcome, ROWS, SAMPLERS, hard_cases, spared};
pub use twins::{Evident, Rejection, Twin, twins};
