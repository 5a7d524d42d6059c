//! What can be added to make up for bounding.

use crate::{Connected, Gather};
use fairflight_media::{Medium, PhaseFunction};
use fairflight_paths::transport::Vertex;
use fairflight_paths::{RayTransmittance, SamplingExtinction};
use fairflight_scene::{Geometry, Spectrum};
use fairflight_sources::UniformSource;

/// An estimate of the light that bounded connections miss at a vertex.
///
/// **Law.** Summed over the connections of a vertex, E\[recover\] = ∫ L_s(x → y) f(y) max(G − b, 0) V dx (raab-2008 eq. 15) per albedo or
/// reflectance of y, for a correction that is not biased by design.
pub trait Correction<C: Spectrum> {
    /// Draws one estimate for these connections of `y`.
    fn recover<G, M, P, R, T, S>(
        &mut self,
        gather: &mut Gather<'_, G, M, P, C, R, T>,
        y: &Vertex,
        which: Connected,
        source: &mut S,
    ) -> C
    where
        G: Geometry<C>,
        M: Medium,
        P: PhaseFunction,
        R: SamplingExtinction,
        T: RayTransmittance<M>,
        S: UniformSource + ?Sized;
}

/// Nothing is made up for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uncorrected;

impl<C: Spectrum> Correction<C> for Uncorrected {
    #[inline]
    fn recover<G, M, P, R, T, S>(
        &mut self,
        _gather: &mut Gather<'_, G, M, P, C, R, T>,
        _y: &Vertex,
        _which: Connected,
        _source: &mut S,
    ) -> C
    where
        G: Geometry<C>,
        M: Medium,
        P: PhaseFunction,
        R: SamplingExtinction,
        T: RayTransmittance<M>,
        S: UniformSource + ?Sized,
    {
        C::ZERO
    }
}
