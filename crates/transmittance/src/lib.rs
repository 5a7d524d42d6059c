//! Estimators of transmittance, T = exp(−∫ σ_t ds), each beside the closed form of its moments.
//!
//! An estimator is a small value prepared for one profile; [`TransmittanceEstimator::estimate`] draws. Its file holds
//! the algorithm, its [`Theory`] (E\[T^k\], expected look-ups), its domain of validity and its source: that file is what
//! one ports.
//!
//! | estimator | source | assumes |
//! |---|---|---|
//! | [`Woodcock`] | raab-2008 algorithm 1 | a majorant |
//! | [`Tracking`] with the double particle model | szirmay-kalos-2017 4.2 | nothing (ratio and residual ratio tracking are special cases) |
//! | [`Tracking`] with the single particle model | szirmay-kalos-2017 eq. 9 | the domain of its version |
//! | [`ResidualCells`] | novak-2014, in cells | bounds in cells |
//! | [`JitteredRatio`] | ours | a majorant; estimates in \[0, 1\] |
//! | [`JitteredRatioInCells`] | ours | bounds in cells; estimates in \[0, 1\] where σ_t ≥ 0 |
//! | [`LineIntegral`] | raab-2008 algorithm 2 | a majorant |
//! | [`NextFlight`], after delta or ratio tracking | cramer-1978 | a majorant; with ratio tracking, any rate |
//! | [`Unidirectional`], [`Bidirectional`]: ratio tracking and next flight by multiple importance sampling | georgiev-2019 | any rate |
//! | [`PSeries`] in four versions | georgiev-2019 | nothing: any pivot |
//! | [`GeneralisedPoisson`] | fearnhead-2008 | nothing: any pivot and rate |
//! | [`AdaptiveRatio`] | misso-2023 | any rate; a majorant keeps it between 0 and 1 |
//! | [`ProgressiveMajorant`] | misso-2023 | nothing; biased, consistent |
//! | [`Regular`] | the integral itself | a closed-form optical thickness |
//! | [`UnbiasedRayMarching`] | kettunen-2021 | nothing; any [`Comb`], any [`Roulette`], any number of segments |
//! | [`Telescoping`] | misso-2022 | nothing |
//! | [`RayMarching`] | perlin-1989 | a biased baseline |
//! | [`Jackknife`] | peters-2025 | a biased baseline |
//!
//! **Law.** E\[estimate\] = T for every field that the estimator knows enough of (the bounds of its type) and admits
//! ([`TransmittanceEstimator::admits`]); a biased baseline says so. Its variance is finite where [`Theory`] says it is, and of ratio and residual
//! ratio tracking it is exp(∫ σ_diff² / σ_samp ds) − 1 in units of T² (szirmay-kalos-2017 eq. 16).
//!
//! # Porting
//!
//! | estimator | in specs and vectors | what it makes of given variates |
//! |---|---|---|
//! | [`Tracking`], double particle: ratio and residual ratio tracking | `double_particle` | `tests/vectors/double_particle.jsonl` |
//! | [`Woodcock`] | `woodcock` | `tests/vectors/woodcock.jsonl` |
//! | [`JitteredRatio`] | `jittered_ratio` | `tests/vectors/jittered_ratio.jsonl` |
//! | [`UnbiasedRayMarching`] | `unbiased_ray_marching` | `tests/vectors/unbiased_ray_marching.jsonl` |
//!
//! Of a kind beyond these the file, where there is one, is `tests/vectors/KIND.jsonl` as well. The page `docs/PORTING.md` has the loop of each in
//! pseudo-code, what it must know, the precision that it bears, and its traps with the bias that each makes. `harness check-port COMMAND` holds a
//! program in any language to the vectors and names the mistake that it sees; ports that pass, to C++, Python and WGSL among others, are in
//! `tests/ports`.
//!
//! A case of the vectors, `double_particle/1/0053`, replayed:
//!
//! ```
//! use fairflight_collision::{Albedo, DoubleParticle};
//! use fairflight_media::{Constant, PiecewiseLinear, Vacuum};
//! use fairflight_sources::Scripted;
//! use fairflight_transmittance::{Tracking, TransmittanceEstimator};
//!
//! let field = PiecewiseLinear::new(vec![0.0, 1.0, 2.0, 4.0, 8.0], vec![0.25, 1.0, 0.0, 0.75, 0.5]).unwrap();
//! let model = DoubleParticle { albedo: Albedo::new(0.0).unwrap() };
//! let estimator = Tracking::new(model, Vacuum::new(8.0), Constant::new(1.0, 8.0).unwrap());
//! let draws = [8970981406146560_u64, 4190746156466176, 8939886916665344];
//! let mut source = Scripted::new(draws.map(|k| k as f64 * 2.0_f64.powi(-53)));
//! let (value, tolerance) = (0.13235096881578548, 1.7e-15);
//! assert!((estimator.estimate(&field, &mut source) - value).abs() <= tolerance);
//! ```
//!
//! And many estimates of another field:
//!
//! ```
//! use fairflight_collision::{Albedo, DoubleParticle};
//! use fairflight_media::{Constant, PiecewiseLinear, Vacuum};
//! use fairflight_sources::Seeded;
//! use fairflight_transmittance::{Tracking, TransmittanceEstimator};
//!
//! // A ray of length 3 whose extinction rises and falls, sampled with an extinction below its maximum of 2.
//! let field = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.0]).unwrap();
//! let model = DoubleParticle { albedo: Albedo::new(0.0).unwrap() };
//! let estimator = Tracking::new(model, Vacuum::new(3.0), Constant::new(1.5, 3.0).unwrap());
//! let mut source = Seeded::new(1);
//! let n = 200_000;
//! let mean = (0..n).map(|_| estimator.estimate(&field, &mut source)).sum::<f64>() / f64::from(n);
//! assert!((mean - (-3.0_f64).exp()).abs() < 0.004);
//! ```

mod adaptive_law;
mod adaptive_ratio;
mod allowance;
mod bidirectional;
mod combs;
mod estimator;
mod explorers;
mod factors;
mod generalised_poisson;
mod hybrid;
mod jittered_law;
mod jittered_ratio;
mod line_integral;
pub mod lockstep;
mod next_flight;
mod p_series;
mod product_law;
mod progressive_majorant;
mod ray_marching;
mod regular;
mod residual_cells;
mod signed_product;
#[cfg(test)]
mod test_support;
mod theory;
mod tracking;
mod woodcock;

#[cfg(test)]
mod seed_ray_tests;
pub use adaptive_ratio::{AdaptiveRatio, FloorError};
pub use bidirectional::{Bidirectional, Unidirectional};
pub use combs::{
    Comb, CombCumulants, CombLookups, CombShape, Jackknife, NoSegments, NoTeeth, Prepared, Roulette,
    RouletteError, RunningCumulant, SymmetricMeans, Telescoping, TelescopingError, UnbiasedRayMarching,
    expected_order, predicted_naive_bias, predicted_relative_variance, teeth_for,
};
pub use estimator::{Interaction, TransmittanceEstimator, TransmittanceFunction};
pub use explorers::{Explorers, TooFewExplorers};
pub use factors::FactorLaw;
pub use generalised_poisson::{GeneralisedPoisson, GeneralisedPoissonError};
pub use hybrid::{Choice, Experience, Forecast, Hybrid, Pilot};
pub use jittered_ratio::{JitteredRatio, JitteredRatioInCells};
pub use line_integral::{LineIntegral, NoSplits, Starts};
pub use next_flight::{NextFlight, NextFlightVersion};
pub use p_series::{PSeries, PSeriesVersion, PivotError};
pub use product_law::{HIGHEST_MOMENT, MOMENTS, ProductLaw};
pub use progressive_majorant::{ProgressiveMajorant, StartError};
pub use ray_marching::{NoSteps, Offset, RayMarching};
pub use regular::Regular;
pub use residual_cells::{RateError, ResidualCells};
pub use signed_product::SignedProduct;
pub use theory::{ClosedForm, Theory, Unreached, theory_on};
pub use tracking::Tracking;
pub use woodcock::Woodcock;
