//! Profiles of many entries of the catalogue.

use fairflight_media::{Constant, PiecewiseConstant};

/// A profile that is not lawful would be a bug of the catalogue's own.
const LAWFUL: &str = "the profiles are lawful";

/// The same σ_t along a length.
pub(crate) fn constant(sigma_t: f64, length: f64) -> Constant {
    Constant::new(sigma_t, length).expect(LAWFUL)
}

/// Values of σ_t in cells of length 1.
pub(crate) fn unit_cells(sigma_t: &[f64]) -> PiecewiseConstant {
    let edges = (0..=sigma_t.len()).map(|edge| edge as f64).collect();
    PiecewiseConstant::new(edges, sigma_t.to_vec()).expect(LAWFUL)
}
