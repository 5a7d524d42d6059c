//! Extinction fields, and what is known of them.
//!
//! Everything that attenuates is seen as a [`Extinction`] field along one ray: σ_t(s) for a distance s in
//! `[0, length]`. Knowledge beyond the look-up is a trait of its own, so that the type of an estimator says exactly what
//! its paper assumes and a scene pays only for what it has:
//!
//! | trait | knowledge |
//! |---|---|
//! | [`Extinction`] | σ_t(s), by look-up |
//! | [`Majorant`], [`Minorant`] | a bound of σ_t over the whole profile |
//! | [`OpticalThickness`] | ∫ σ_t ds in closed form |
//! | [`InvertOpticalThickness`] | the distance at which an optical thickness is reached, in closed form |
//! | [`Cells`] | where one cubic ends and the next begins |
//! | [`BoundedInCells`] | both bounds in each of many cells |
//! | [`IntervalBounds`] | both bounds between any two distances, hence in cells |
//! | [`Breakpoints`] | where σ_t is not smooth, so that quadrature can be split there |
//! | [`Enclosed`] | its range and integral on any stretch, with a bound of the error |
//! | [`SpectralExtinction`] | σ_t(s) of N wavelengths by one look-up; [`SpectralMajorant`] and others as above |
//!
//! A medium with [`BoxBounds`] fills a [`BoundGrid`], which gives a ray its cells.
//!
//! A [`Medium`] is a field in space; a [`Ray`] through it is a profile. Bounds, media and profiles know no randomness.
//! Quadrature of a profile ([`RayQuadrature`]) is the reference that estimators are judged against; it is not an
//! estimator. A [`Certificate`] proves the error of an optical thickness, or says what it could not prove.
//!
//! **Law.** A field is a function: the same s gives the same σ_t(s), finite, of either sign. Knowledge is never less than the truth it bounds: σ_t ≤
//! majorant and σ_t ≥ minorant everywhere, an optical thickness is ∫ σ_t ds to rounding. An estimator is unbiased given the knowledge that its bounds
//! ask for, and biased by a majorant that is none: [`Watched`] finds that at the look-up where it happens. Of a phase function ([`phase`]) the
//! integral over the sphere is 1, and its samples have the density that it tells (henyey-1941, without the division by g that cancels near g = 0).
//!
//! # Porting
//!
//! The profile of all test vectors is [`PiecewiseLinear`], with nodes that are exact in every precision; in the layer `field` a port needs none,
//! since the vectors say what each look-up returns. Phase functions: `tests/vectors/henyey_greenstein.jsonl` (cosine and value per steradian, g = ±(1
//! − 2⁻¹²), ±2⁻²⁰, 0 and between), the others `tests/vectors/phase.jsonl`; directions about the incident one `tests/vectors/deflection.jsonl`. The
//! pages are `docs/PORTING.md` and `docs/porting/flights.md`.
//!
//! ```
//! use fairflight_media::{Certificate, ExpressionProfile, Extinction, Tolerance};
//!
//! // A peak a thousandth wide: nodes of a rule may miss it, interval arithmetic cannot.
//! let peak = "0.2 + 300*exp(-((s - 1.2345678)/1e-3)^2)";
//! let field = ExpressionProfile::new(peak, 3.0, Some(301.0)).unwrap();
//! assert_eq!(field.sigma_t(0.0), 0.2);
//! let certificate = Certificate::of(&field, Tolerance::TIGHT);
//! let exact = 0.6 + 0.3 * std::f64::consts::PI.sqrt();
//! assert!(certificate.doubt().is_none());
//! assert!((certificate.thickness - exact).abs() <= certificate.error + 1e-15);
//! ```

mod analytic_cosine;
mod bound_cells;
mod bound_grid;
mod bounded;
mod bounds;
mod cells;
mod constant;
mod empty_space;
mod enclosure;
mod entry;
mod epsilon;
mod error;
mod expression;
mod extinction;
mod gradient_noise;
mod homogeneous;
mod inside;
mod interpolation;
mod interval;
mod interval_bounds;
pub mod lanes;
mod lattice_planes;
mod medium;
mod medium_bounds;
mod observed;
mod of_field;
mod perlin;
pub mod phase;
mod piecewise_constant;
mod piecewise_linear;
mod quadrature;
mod ray;
mod rounding;
mod spectral;
#[cfg(test)]
mod test_support;
mod voxels;
mod watched;

pub use analytic_cosine::AnalyticCosine;
pub use bound_cells::{BoundCell, BoundedInCells, InCells};
pub use bound_grid::BoundGrid;
pub use bounded::Bounded;
pub use bounds::{Bounds, Clip};
pub use cells::{Cells, LineCells};
pub use constant::Constant;
pub use empty_space::EmptySpace;
pub use enclosure::{Certificate, Certified, Doubt, Enclosed, LineEnclosed, Stretch};
pub use entry::Clips;
pub use epsilon::{Epsilon, EpsilonError};
pub use error::FieldError;
pub use expression::{ExpressionError, ExpressionFieldError, ExpressionMedium, ExpressionProfile};
pub use extinction::{
    Breakpoints, Extinction, InvertOpticalThickness, Majorant, Minorant, OpticalThickness, Vacuum,
};
pub use homogeneous::Homogeneous;
pub use interpolation::lerp;
pub use interval_bounds::IntervalBounds;
pub use medium::{Line, LineThickness, Medium, MediumBreakpoints};
pub use medium_bounds::{BoxBounds, Boxes};
pub use observed::Observed;
pub use perlin::{Perlin, PerlinParameters};
pub use phase::{PhaseFunction, Scattered};
pub use piecewise_constant::PiecewiseConstant;
pub use piecewise_linear::PiecewiseLinear;
pub use quadrature::{Cumulative, Integral, RayQuadrature, Tolerance, adaptive_integral};
pub use ray::Ray;
pub use rounding::rounding_of_difference;
pub use spectral::{
    Profiles, Scaled, SpectralBreakpoints, SpectralExtinction, SpectralMajorant, SpectralOpticalThickness,
    Wavelength,
};
pub use voxels::{Lattice, Voxels};
pub use watched::{Counted, Domain, Violation, Watched};
