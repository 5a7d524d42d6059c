//! Combs: randomly shifted quadratures of the optical thickness, and what makes an estimate of exp(−τ) of them.
//!
//! exp(−X) of a comb X is biased. Three ways remove the bias or most of it: a power series in the deviations of
//! independent combs, stopped by a roulette ([`UnbiasedRayMarching`], kettunen-2021); a telescoping sum over finer
//! and finer combs ([`Telescoping`], misso-2022); and a combination of two that is exact for normal deviations
//! ([`Jackknife`], peters-2025, biased).

mod comb;
mod deviation;
mod jackknife;
mod naive;
mod power_series;
mod roulette;
mod running_cumulant;
mod sample_count;
mod second_moment;
mod second_order;
mod symmetric_means;
mod telescoping;
mod telescoping_law;
mod unbiased_ray_marching;

pub use comb::{Comb, CombLookups, CombShape, NoTeeth, Prepared};
pub use deviation::CombCumulants;
pub use jackknife::Jackknife;
pub use naive::predicted_naive_bias;
pub(crate) use power_series::of_draws;
pub use roulette::{Roulette, RouletteError};
pub use running_cumulant::RunningCumulant;
pub use sample_count::{expected_order, teeth_for};
pub use second_order::predicted_relative_variance;
pub use symmetric_means::SymmetricMeans;
pub(crate) use telescoping::difference;
pub use telescoping::{Telescoping, TelescopingError};
pub use unbiased_ray_marching::{NoSegments, UnbiasedRayMarching};
