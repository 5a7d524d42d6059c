//! Integrators: estimators of the radiance of a pixel.

use fairflight_media::Line;
use fairflight_sources::UniformSource;

/// A random estimate of the radiance that arrives along a ray.
///
/// **Law.** E\[radiance\] is the radiance that arrives at `line.origin` from the direction `line.direction`, as far as the
/// integrator's documentation says that it models it. Estimates may be negative; clamping them is a bias.
///
/// An integrator keeps buffers of its own between rays, hence `&mut self`: one per worker. Estimates do not depend on the
/// rays before, except where the integrator says so (a control fitted to neighbouring rays, which changes no expectation).
pub trait Integrator<C> {
    /// Draws one estimate \[radiance\] for a ray whose direction has unit length.
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> C;
}
