//! Photons, stored by place.

use crate::tree::{Near, Placed, Tree};
use fairflight_media::Line;
use fairflight_scene::Spectrum;
use fairflight_vpl::Vpl;
use glam::DVec3;
use std::collections::BinaryHeap;

/// A vertex of a light path: light that arrived there, and was scattered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Photon<C> {
    /// Place of the vertex.
    pub position: DVec3,
    /// The direction in which the light arrived, of unit length.
    pub incident: DVec3,
    /// The power that is scattered, albedo or reflectance included; of either sign where the walk has weights of either sign.
    pub power: C,
    /// The surface; none in the medium.
    pub surface: Option<u32>,
}

impl<C> Placed for Photon<C> {
    fn position(&self) -> DVec3 {
        self.position
    }
}

/// Photons of surfaces and medium, each found by its place.
///
/// **Law.** The sum of power · g over photons of light paths that share all power has the expectation ∫ g of the light that is scattered:
/// that of [`LightPaths`](fairflight_vpl::LightPaths), whose vertices they are.
#[derive(Clone, Debug)]
pub struct PhotonMap<C> {
    medium: Tree<Photon<C>>,
    surfaces: Tree<Photon<C>>,
}

impl<C: Spectrum> PhotonMap<C> {
    /// The map of the vertices of light paths.
    #[must_use]
    pub fn new(vertices: impl IntoIterator<Item = Vpl<C>>) -> Self {
        let photons = vertices.into_iter().map(|vpl| Photon {
            position: vpl.vertex.position,
            incident: vpl.incident,
            power: vpl.power,
            surface: vpl.vertex.surface().map(|surface| surface as u32),
        });
        let (medium, surfaces) = photons.partition(|photon| photon.surface.is_none());
        Self { medium: Tree::new(medium), surfaces: Tree::new(surfaces) }
    }

    /// The photons in the medium.
    #[must_use]
    pub fn in_medium(&self) -> &[Photon<C>] {
        self.medium.points()
    }

    /// The photons on surfaces.
    #[must_use]
    pub fn on_surfaces(&self) -> &[Photon<C>] {
        self.surfaces.points()
    }

    /// Shows `each` the `count` photons nearest to a point, of those on surfaces or of those in the medium.
    pub(crate) fn nearest(
        &self,
        (center, on_surface): (DVec3, bool),
        count: usize,
        found: &mut BinaryHeap<Near>,
        mut each: impl FnMut(&Photon<C>),
    ) {
        let tree = if on_surface { &self.surfaces } else { &self.medium };
        tree.nearest(center, count, found);
        found.iter().for_each(|near| each(tree.at(near)));
    }

    /// Shows `each` every photon in the medium nearer to a ray than `radius` whose projection lies on its first `length`, and that distance.
    pub(crate) fn along(&self, line: &Line, length: f64, radius: f64, mut each: impl FnMut(&Photon<C>, f64)) {
        self.medium.along(line, length, radius, &mut each);
    }

    /// Shows `each` every photon of a surface nearer to a point of it than `radius`.
    pub(crate) fn on_surface(
        &self,
        (center, surface): (DVec3, usize),
        radius: f64,
        mut each: impl FnMut(&Photon<C>),
    ) {
        self.surfaces.within(center, radius, &mut |photon: &Photon<C>| {
            if photon.surface == Some(surface as u32) {
                each(photon);
            }
        });
    }
}
