//! Corrections that make up for bounding.

use crate::{Connected, Gather};
use fairflight_paths::transport::{Types, Vertex};
use fairflight_scene::Spectrum;
use fairflight_sources::UniformSource;

/// Connections of a vertex, and what makes them.
#[derive(Debug)]
pub struct Connections<'a, 's, W: Types> {
    /// The gatherer.
    pub gather: &'a mut Gather<'s, W>,
    /// The vertex that is connected.
    pub y: &'a Vertex,
    /// The lights that it is connected with.
    pub which: Connected,
}

/// An estimate of the light that bounded connections miss at a vertex.
///
/// **Law.** Summed over the connections of a vertex, E\[recover\] = ∫ L_s(x → y) f(y) max(G − b, 0) V dx (raab-2008 eq. 15) per albedo or
/// reflectance of y, for a correction that is not biased by design.
pub trait Correction<W: Types> {
    /// Draws one estimate for these connections.
    fn recover(&mut self, at: Connections<'_, '_, W>, source: &mut impl UniformSource) -> W::Spectrum;
}

/// Correction by nothing: what bounding takes away is lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uncorrected;

impl<W: Types> Correction<W> for Uncorrected {
    #[inline]
    fn recover(&mut self, _at: Connections<'_, '_, W>, _source: &mut impl UniformSource) -> W::Spectrum {
        W::Spectrum::ZERO
    }
}

/// A correction or none: one branch per vertex, and half of the integrators to compile.
impl<W: Types, C: Correction<W>> Correction<W> for Option<C> {
    fn recover(&mut self, at: Connections<'_, '_, W>, source: &mut impl UniformSource) -> W::Spectrum {
        self.as_mut().map_or(W::Spectrum::ZERO, |correction| correction.recover(at, source))
    }
}
