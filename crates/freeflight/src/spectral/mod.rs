//! Free flights of several wavelengths at once, and flights against a control.
//!
//! | sampler | source | assumes | weights |
//! |---|---|---|---|
//! | [`SpectralTracking`] with [`MaxScheme`] | kutz-2017 | a sampling extinction | one event multiplies them by at most 1 + spread; a product law |
//! | [`SpectralTracking`] with [`AverageScheme`] | kutz-2017 | a sampling extinction | within \[0, N\], their sum is N, where 0 ≤ σ_l ≤ σ_samp |
//! | [`HeroWavelength`] | wilkie-2014 | a majorant of all wavelengths | as those of the average scheme: the same law |
//! | [`SeparateSolve`] | raab-2008 section 3.2 | a majorant of each wavelength | N for one wavelength, 0 for the others |
//! | [`SharedDistance`] | raab-2008 section 3.2 | optical thicknesses in closed form | unbounded: what the others are for |
//! | [`DecompositionTracking`] | kutz-2017 | a control in closed form; gray | 1 where control ≤ σ_t ≤ control + σ_samp |
//!
//! A look-up evaluates all wavelengths. The closed forms of a sampler ([`crate::ClosedForm`]) are those of one
//! [`fairflight_media::Wavelength`] of a field at a time.
//!
//! ```
//! use fairflight_freeflight::spectral::{AverageScheme, SpectralFlight, SpectralFreeFlight, SpectralTracking};
//! use fairflight_media::{Constant, Scaled};
//! use fairflight_sources::Seeded;
//!
//! // Three wavelengths over a length of 2; nothing attenuates the last one.
//! let field = Scaled::new(Constant::new(1.0, 2.0).unwrap(), [1.0, 0.5, 0.0]).unwrap();
//! let tracking = SpectralTracking::new(AverageScheme, Constant::new(1.0, 2.0).unwrap());
//! let mut source = Seeded::new(1);
//! let mut escaped = [0.0; 3];
//! for _ in 0..100_000 {
//!     if let SpectralFlight::Escaped { weights } = tracking.sample(&field, &mut source) {
//!         for (sum, weight) in escaped.iter_mut().zip(weights) {
//!             *sum += weight / 100_000.0;
//!         }
//!     }
//! }
//! for (mean, tau) in escaped.into_iter().zip([2.0, 1.0, 0.0_f64]) {
//!     assert!((mean - (-tau).exp()).abs() < 0.02);
//! }
//! ```

mod decomposition;
mod flight;
mod hero;
mod scheme;
mod separate;
mod shared;
mod tracking;
mod tracking_law;

pub use decomposition::DecompositionTracking;
pub use flight::{SpectralFlight, SpectralFreeFlight};
pub use hero::HeroWavelength;
pub use scheme::{AverageScheme, MaxScheme, Scheme};
pub use separate::SeparateSolve;
pub use shared::SharedDistance;
pub use tracking::SpectralTracking;
