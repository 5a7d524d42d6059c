//! Free flights: how far a particle flies before it collides with matter.
//!
//! A sampler is a small value prepared for one profile; [`FreeFlight::sample`] draws a [`Flight`]. Its file holds the
//! algorithm, the closed form of its weights ([`ClosedForm`]), its expected look-ups, its domain of validity and its source:
//! that file is what one ports.
//!
//! | sampler | source | assumes | weight |
//! |---|---|---|---|
//! | [`Inversion`] | szirmay-kalos-2017 eq. 4 | an inverse of the optical thickness in closed form | 1 |
//! | [`Newton`] | szirmay-kalos-2017 eq. 4 | an optical thickness in closed form | 1 |
//! | [`Regular`] | szirmay-kalos-2017 eq. 4, cell by cell | cells with a cubic in each | 1 |
//! | [`Woodcock`] | raab-2008 algorithm 1 | a majorant, constant or in cells | 1 |
//! | [`JitteredFlight`] | ours, beside jittered ratio tracking | a majorant | 1 |
//! | [`Tracking`] | szirmay-kalos-2017 eq. 9 and 12 | nothing: any sampling extinction, either sign | 1 where σ_samp ≥ σ_t ≥ 0 |
//! | [`spectral`] | kutz-2017, wilkie-2014, raab-2008 section 3.2 | look-ups of N wavelengths | one for each wavelength |
//!
//! **Law.** Weighted flights integrate any test function f as collisions do: E\[weight · f(distance); collided\] = ∫ f σ_t T ds, T(s) being the
//! transmittance to s, and E\[weight; escaped\] = T(length) ([`FreeFlight`]). With a weight of 1 the distance has the density σ_t T.
//!
//! # Porting
//!
//! Event, distance and weights of given variates: `tests/vectors/woodcock_flight.jsonl` ([`Woodcock`], with one majorant or one for each cell),
//! `tests/vectors/tracking_flight.jsonl` (below and above the extinction, with weights), `tests/vectors/inversion_flight.jsonl`,
//! `tests/vectors/jittered_flight.jsonl`; of three wavelengths by one walk `tests/vectors/spectral_tracking.jsonl`, and by other schemes
//! `tests/vectors/spectral_flight.jsonl`. Distances towards a point light are `tests/vectors/equiangular.jsonl` (kulla-2012). Loops, traps and
//! precisions: `docs/PORTING.md`, `docs/porting/flights.md`.
//!
//! ```
//! use fairflight_freeflight::{Flight, FreeFlight, Woodcock};
//! use fairflight_media::{Constant, PiecewiseLinear};
//! use fairflight_sources::Seeded;
//!
//! // A ray of length 3 whose extinction rises to 2 and falls: optical thickness 3.
//! let field = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.0]).unwrap();
//! let woodcock = Woodcock::new(Constant::new(2.0, 3.0).unwrap());
//! let mut source = Seeded::new(1);
//! let n = 100_000;
//! let escaped = (0..n)
//!     .filter(|_| matches!(woodcock.sample(&field, &mut source), Flight::Escaped { .. }))
//!     .count();
//! assert!((escaped as f64 / f64::from(n) - (-3.0_f64).exp()).abs() < 0.004);
//! ```

mod flight;
mod inversion;
mod jittered;
mod newton;
mod regular;
mod root;
pub mod spectral;
#[cfg(test)]
mod test_support;
mod theory;
mod tracking;
mod weight_law;
mod woodcock;

pub use flight::{Flight, FreeFlight};
pub use inversion::Inversion;
pub use jittered::JitteredFlight;
pub use newton::Newton;
pub use regular::Regular;
pub use theory::{ClosedForm, HIGHEST_MOMENT, Moments, lookups_of_a_walk};
pub use tracking::Tracking;
pub use weight_law::{WeightLaw, WeightProducts};
pub use woodcock::Woodcock;
