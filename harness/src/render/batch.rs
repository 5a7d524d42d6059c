//! Virtual point lights and photons that all tiles of a pass share.

use super::photons::PhotonLayer;
use fairflight_vpl::Vpl;

/// Virtual point lights and photons of a pass, shared by all its tiles.
#[derive(Clone, Debug)]
pub(super) struct Batch<C> {
    /// Virtual point lights; none for an integrator that does not gather.
    pub vpls: Vec<Vpl<C>>,
    /// The bound of their geometric term \[1/length²\].
    pub bound: f64,
    /// The mean radiance that the passes before found; `None` without any.
    pub mean: Option<f64>,
    /// Light that is not drawn pixel by pixel.
    pub photons: Option<PhotonLayer<C>>,
}

impl<C> Batch<C> {
    /// A batch without anything that is shared.
    pub(super) fn none() -> Self {
        Self { vpls: Vec::new(), bound: f64::INFINITY, mean: None, photons: None }
    }
}
