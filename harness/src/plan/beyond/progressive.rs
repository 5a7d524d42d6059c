//! A majorant that is learned from estimate to estimate.

use super::erased::{AnyField, AnyPieces, Erased};
use fairflight_media::{RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{ProgressiveMajorant, Theory};
use std::sync::{Mutex, PoisonError};

/// The learner, behind a lock: estimates are drawn one after another.
#[derive(Debug)]
pub(super) struct Progressive(pub(super) Mutex<ProgressiveMajorant>);

impl Erased for Progressive {
    fn estimate(&self, field: AnyField<'_>, mut source: &mut dyn UniformSource) -> f64 {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).estimate(&field, &mut source)
    }

    fn admits(&self, _field: AnyField<'_>, _s: f64, _sigma_t: f64) -> bool {
        true
    }

    /// Biased as long as it learns; how much depends on what it has learned.
    fn theory(&self, _quadrature: &RayQuadrature<AnyPieces<'_>>, _tau: f64, _tolerance: Tolerance) -> Theory {
        Theory::mean_only(f64::NAN)
    }
}
