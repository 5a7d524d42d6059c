//! The closed form of a profile, as an estimator.

use super::erased::{AnyField, AnyPieces, Erased};
use crate::Failure;
use crate::plan::{AnyProfile, Field, FieldJob, KnownField};
use fairflight_media::{RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{HIGHEST_MOMENT, Theory};

/// exp(−τ) from the closed form that the profile has: evaluated anew for each estimate, so that its seconds are those of the closed form.
#[derive(Debug)]
pub(super) struct Exact {
    profile: AnyProfile,
}

impl Exact {
    pub(super) fn of(profile: &AnyProfile) -> Result<Self, Failure> {
        match profile.with(Thickness) {
            Some(_) => Ok(Self { profile: profile.clone() }),
            None => Err(Failure::refused(
                "estimator: regular needs a profile whose optical thickness has a closed form (constant, piecewise_constant, \
                 piecewise_linear, or a ray through a homogeneous, analytic_cosine or vdb medium); use unbiased_ray_marching, which \
                 needs look-ups only",
            )),
        }
    }
}

struct Thickness;

impl FieldJob for Thickness {
    type Output = Option<f64>;
    fn run<F: KnownField>(self, field: &F) -> Option<f64>
    where
        for<'a> &'a F: Field,
    {
        field.knowledge().optical_thickness
    }
}

impl Erased for Exact {
    fn estimate(&self, _field: AnyField<'_>, _source: &mut dyn UniformSource) -> f64 {
        self.profile.with(Thickness).map_or(f64::NAN, |tau| (-tau).exp())
    }

    fn admits(&self, _field: AnyField<'_>, _s: f64, sigma_t: f64) -> bool {
        sigma_t.is_finite()
    }

    fn theory(&self, _quadrature: &RayQuadrature<AnyPieces<'_>>, _tau: f64, _tolerance: Tolerance) -> Theory {
        Theory {
            relative_mean: 1.0,
            relative_central: [0.0; HIGHEST_MOMENT - 1],
            log_relative_variance: f64::NEG_INFINITY,
            relative_variance_error: 0.0,
            relative_variance_bound: f64::INFINITY,
            lookups: 0.0,
        }
    }
}
