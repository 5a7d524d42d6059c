//! Profiles that several tests of combs use.

use fairflight_media::{AnalyticCosine, Clip, OpticalThickness, PiecewiseLinear, Ray};
use glam::DVec3;
use std::sync::Arc;

/// szirmay-kalos-2017 eq. 21 along +z from the origin, length 20: τ = 3.41568.
pub(crate) fn seed_ray() -> Ray<Arc<AnalyticCosine>> {
    let clip: Clip = AnalyticCosine::default_bounds().clip(DVec3::ZERO, DVec3::Z, None).unwrap().unwrap();
    Ray::new(Arc::new(AnalyticCosine::new(1.0).unwrap()), &clip)
}

pub(crate) struct Tent {
    pub(crate) field: PiecewiseLinear,
}

impl Tent {
    pub(crate) fn thickness(&self, from: f64, to: f64) -> f64 {
        self.field.optical_thickness(from, to)
    }
}

/// A rise from 0.1 to 1.5 over 1 and a fall to 0.2 over 2.
pub(crate) fn tent() -> Tent {
    Tent { field: PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).unwrap() }
}
