//! Test vectors: what an estimator makes of given variates on a given profile, for whoever ports it to another language.
//!
//! Nothing here draws from the estimators of the other crates. Each [`Kind`] is written down a second time, as plain as its paper has it, over any
//! [`Arithmetic`], and every case is run four times over:
//!
//! | arithmetic | tells |
//! |---|---|
//! | [`Exact`], 160 bits | the value, and every decision |
//! | [`Binary64`], in the stated order of operations | the bits that a port without fused multiply-add has |
//! | [`Perturbed`] by a few roundings of binary64 | the tolerance of a port in double precision, and if the case bears it |
//! | [`Perturbed`] by those of binary32 | the same in single precision |
//!
//! **Law.** A case is *robust* at a precision if no perturbed run draws, looks up or ends otherwise than the exact one. Its tolerance is twice the largest
//! deviation of 64 perturbed runs from the exact value, and at least four units of the last place: a fixed number of those would refuse right ports where
//! 1 − σ/σ_samp cancels. What decides between < and ≤ is robust at no precision; such ties are cases of their own, on dyadic numbers that every precision
//! holds exactly.
//!
//! ```
//! use fairflight_vectors::{KINDS, Precision, judge};
//! use serde_json::json;
//!
//! let woodcock = KINDS.iter().find(|kind| kind.name == "woodcock").unwrap();
//! let case = &woodcock.cases()[0];
//! // A port that looks nothing up and says 1.
//! let answer = json!({ "id": case.id, "value": 1, "draws": 1, "lookups": 0, "s": [] });
//! assert!(judge(&case.json, &answer, Precision::Binary64).is_err());
//! ```
//!
//! Headers state exact moments of each set of parameters, from the law of the estimator by quadrature over the pieces of the profile: [`ask_statistics`] judges
//! estimates that a port makes from a generator of its own.
//!
//! [`Kind::biases`] measures what known mistakes do to those means.
//!
//! Logarithms and exponentials of the exact run are rounded once. They come from no library that a later version of this project may change.

mod arithmetic;
mod bias;
mod case;
mod check;
pub mod kinds;
mod moments;
mod number;
mod perturbed;
mod profile;
mod run;
mod script;
mod statistics;
mod tolerance;

pub use arithmetic::{Arithmetic, Binary64, Exact};
pub use bias::Bias;
pub use case::{Case, FORMAT, Mistaken, VERSION, header};
pub use check::{Fault, Layer, asked, judge};
pub use kinds::{KINDS, Kind};
pub use number::{Number, Precise};
pub use perturbed::{Noise, Perturbed, Precision};
pub use profile::Profile;
pub use run::{Event, Outcome, Run};
pub use script::{Draw, Script};
pub use statistics::{Scores, ask_statistics, asked_statistics, judge_statistics};
