//! The types that a scene is made of, in one name.

use crate::{RayTransmittance, SamplingExtinction};
use fairflight_media::{Medium, PhaseFunction, Ray};
use fairflight_scene::{Geometry, Spectrum};
use fairflight_sources::UniformSource;
use std::fmt;
use std::marker::PhantomData;

/// The types of a scene and of what travels in it, chosen once: code that is generic over them names one parameter, and compiles to
/// what this scene has and no more.
///
/// [`MadeOf`] implements it; nothing has a value of such a type.
pub trait Types {
    /// Radiance, albedo and power: gray or colour.
    type Spectrum: Spectrum;
    /// Extinction in space.
    type Medium: Medium;
    /// Phase function.
    type Phase: PhaseFunction;
    /// Surfaces; [`NoSurfaces`](fairflight_scene::NoSurfaces) without any.
    type Geometry: Geometry<Self::Spectrum>;
    /// Rate at which flights look the medium up.
    type Sampling: SamplingExtinction;
    /// Transmittance of connections.
    type Shadow: RayTransmittance<Self::Medium>;
}

/// The bundle of a spectrum, a medium, a phase function, a geometry, a sampling extinction and a transmittance of connections, which may
/// be left out where nothing is connected.
pub struct MadeOf<C, M, P, G, R, T = NoShadow>(PhantomData<(C, M, P, G, R, T)>);

impl<C: Spectrum, M: Medium, P: PhaseFunction, G: Geometry<C>, R: SamplingExtinction, T: RayTransmittance<M>>
    Types for MadeOf<C, M, P, G, R, T>
{
    type Spectrum = C;
    type Medium = M;
    type Phase = P;
    type Geometry = G;
    type Sampling = R;
    type Shadow = T;
}

impl<C, M, P, G, R, T> fmt::Debug for MadeOf<C, M, P, G, R, T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("MadeOf")
    }
}

/// Transmittance of connections where there are none.
#[derive(Debug)]
pub enum NoShadow {}

impl<M> RayTransmittance<M> for NoShadow {
    fn estimate(&mut self, _ray: &Ray<&M>, _source: &mut impl UniformSource) -> f64 {
        match *self {}
    }
}
