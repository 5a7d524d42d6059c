//! Common parts of the tests of several samplers.

use crate::ClosedForm;
use approx::assert_relative_eq;
use fairflight_collision::Version;
use fairflight_media::{Breakpoints, Constant, RayQuadrature, Scaled, Tolerance};

/// All versions of the single particle model.
pub(crate) const VERSIONS: [Version; 3] = [Version::Terminating, Version::NonTerminating, Version::Adaptive];

/// σ_t = `sigma` on a length of 1.
pub(crate) fn constant(sigma: f64) -> Constant {
    Constant::new(sigma, 1.0).unwrap()
}

/// One value for each wavelength, on a length of 1.
pub(crate) fn spectrum<const N: usize>(sigma: [f64; N]) -> Scaled<Constant, N> {
    Scaled::new(constant(1.0), sigma).unwrap()
}

/// The first moments of a sampler's weights are the law itself, on a field of the optical thickness `tau`.
pub(crate) fn assert_law<F: Breakpoints + Clone, E: ClosedForm<F>>(field: F, sampler: &E, tau: f64) {
    let (mut quadrature, weights) = (RayQuadrature::new(field, &[]), sampler.weights());
    let collided = weights.collided(&mut quadrature, Tolerance::TIGHT, &|_| 1.0).value[0];
    assert_relative_eq!(collided, -(-tau).exp_m1(), max_relative = 1e-11);
    let escaped = weights.escaped(&mut quadrature, Tolerance::TIGHT)[0];
    assert_relative_eq!(escaped, (-tau).exp(), max_relative = 1e-12);
}
