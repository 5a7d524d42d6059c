//! Transmittance of whatever ray comes: shadow rays.

use crate::SamplingExtinction;
use fairflight_elementary::exp;
use fairflight_media::{Extinction, LineThickness, Medium, OpticalThickness, Ray};
use fairflight_scene::{Connection, Spectrum, Volume};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{RayMarching, Regular, SignedProduct, TransmittanceEstimator};
use glam::DVec3;

/// An estimator of transmittance that needs no preparation for the ray.
///
/// **Law.** E\[estimate\] = exp(−∫ σ_t) over the profile, for an estimator that is not labelled biased.
pub trait RayTransmittance<M> {
    /// Draws one estimate \[1\].
    fn estimate(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource) -> f64;

    /// The extinction σ_t of a medium for all of whose rays the estimate is exp(−(σ_t · length)), without a variate \[1/length\].
    #[inline(always)]
    fn everywhere(&self, _medium: &M) -> Option<f64> {
        None
    }
}

/// Ratio tracking at any sampling extinction in space: the double particle model without control
/// (szirmay-kalos-2017 eq. 8; novak-2014).
#[derive(Clone, Copy, Debug)]
pub struct Ratio<R>(pub R);

impl<M: Medium, R: SamplingExtinction> RayTransmittance<M> for Ratio<R> {
    #[inline]
    fn estimate(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource) -> f64 {
        let (line, length) = (ray.world_line(), ray.length());
        let (mut weight, mut s) = (SignedProduct::ONE, 0.0);
        while let Some((next, sigma_samp)) = self.0.fly(line, s, length, source.next_exponential()) {
            s = next;
            weight.multiply(1.0 - ray.sigma_t(s) / sigma_samp);
        }
        weight.value()
    }
}

impl<M: LineThickness> RayTransmittance<M> for Regular {
    #[inline]
    fn estimate(&mut self, ray: &Ray<&M>, _source: &mut impl UniformSource) -> f64 {
        exp(-ray.optical_thickness(0.0, ray.length()))
    }
    #[inline(always)]
    fn everywhere(&self, medium: &M) -> Option<f64> {
        medium.everywhere()
    }
}

/// Biased, and labelled so.
impl<M: Medium> RayTransmittance<M> for RayMarching {
    #[inline]
    fn estimate(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource) -> f64 {
        TransmittanceEstimator::estimate(self, ray, source)
    }
}

/// The irradiance that arrives at a `point` in the volume from a light, the medium between taken into account.
#[inline]
pub fn arriving<M: Medium, P, C: Spectrum>(
    volume: &Volume<M, P, C>,
    point: DVec3,
    connection: &Connection<C>,
    shadow: &mut impl RayTransmittance<M>,
    source: &mut impl UniformSource,
) -> C {
    let ray = volume.towards(point, connection);
    connection.irradiance * shadow.estimate(&ray, source)
}
