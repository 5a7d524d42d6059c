//! Virtual point lights and photons that all tiles of a pass share.

use super::replicas::ReplicaLayer;
use fairflight_photons::PhotonMap;
use fairflight_scene::Spectrum;
use fairflight_vpl::Vpl;

/// Virtual point lights and photons of a pass, shared by all its tiles.
#[derive(Clone, Debug)]
pub(super) struct Batch<C> {
    /// Virtual point lights; none for an integrator that does not gather.
    pub vpls: Vec<Vpl<C>>,
    /// The bound of their geometric term \[1/length²\].
    pub bound: f64,
    /// Photons found by place; none for an integrator that does not ask them.
    pub map: PhotonMap<C>,
    /// The mean radiance that the passes before found; `None` without any.
    pub mean: Option<f64>,
    /// Light that is not drawn pixel by pixel.
    pub replicas: Option<ReplicaLayer<C>>,
}

impl<C: Spectrum> Batch<C> {
    /// A batch without anything that is shared.
    pub(super) fn none() -> Self {
        let (vpls, map) = (Vec::new(), PhotonMap::new([]));
        Self { vpls, map, bound: f64::INFINITY, mean: None, replicas: None }
    }
}
