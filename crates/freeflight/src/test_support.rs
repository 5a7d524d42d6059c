//! What the tests of several samplers share.

use fairflight_collision::Version;
use fairflight_media::{Constant, Scaled};

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
