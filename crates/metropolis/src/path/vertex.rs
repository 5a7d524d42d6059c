//! Vertices and edges of a path.

use super::{Met, PathWorld};
use fairflight_paths::transport::Light;
use fairflight_scene::Material;
use fairflight_scene::surface::{fresnel_reflectance, reflect, refract};
use glam::DVec3;

/// A vertex of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathVertex {
    /// Point in space; the direction towards an infinitely far light, of unit length.
    pub position: DVec3,
    /// Scattering there, or the end of the path.
    pub site: PathSite,
    /// Reflectance, albedo, or strength of a light ([`PathWorld::strength`]).
    pub colour: DVec3,
}

/// Scattering at a vertex, or an end of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathSite {
    /// The pinhole.
    Pinhole,
    /// A point of the medium.
    Medium {
        /// σ_t there \[1/length\].
        sigma_t: f64,
    },
    /// A diffuse surface.
    Diffuse {
        /// Normal of unit length, on either side.
        normal: DVec3,
        /// The surface.
        surface: usize,
    },
    /// A mirror, or an interface.
    Smooth {
        /// Normal of unit length, on either side.
        normal: DVec3,
        /// The surface.
        surface: usize,
        /// Index of refraction on the side of the light over that on the side of the camera; 1 for a reflection.
        ratio: f64,
        /// Reflection, or refraction.
        reflects: bool,
        /// F, or 1 − F: the share of light that goes this way.
        share: f64,
    },
    /// A point of a surface that emits.
    Lamp {
        /// Normal of unit length, on either side.
        normal: DVec3,
        /// The surface.
        surface: usize,
    },
    /// A point light, by its index.
    Point(usize),
    /// A direction from which light comes: constant background, map, or directional light.
    Far(Light),
}

/// An edge of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathEdge {
    /// The direction from the vertex on the camera's side, of unit length.
    pub direction: DVec3,
    /// Distance of its ends \[length\]; infinite where the light is.
    pub length: f64,
    /// ln T, or of the estimate of it that belongs to this edge.
    pub ln_transmittance: f64,
}

impl PathVertex {
    /// The surface that it lies on.
    #[inline]
    #[must_use]
    pub fn surface(&self) -> Option<usize> {
        match self.site {
            PathSite::Diffuse { surface, .. }
            | PathSite::Smooth { surface, .. }
            | PathSite::Lamp { surface, .. } => Some(surface),
            PathSite::Pinhole | PathSite::Medium { .. } | PathSite::Point(_) | PathSite::Far(_) => None,
        }
    }

    /// D: |cosine| on a surface, 1 elsewhere.
    #[inline]
    #[must_use]
    pub fn facing(&self, direction: DVec3) -> f64 {
        match self.site {
            PathSite::Diffuse { normal, .. }
            | PathSite::Smooth { normal, .. }
            | PathSite::Lamp { normal, .. } => normal.dot(direction).abs(),
            PathSite::Pinhole | PathSite::Medium { .. } | PathSite::Point(_) | PathSite::Far(_) => 1.0,
        }
    }

    /// Returns true on a mirror or an interface: the direction on one side follows from that on the other.
    #[inline]
    #[must_use]
    pub fn is_smooth(&self) -> bool {
        matches!(self.site, PathSite::Smooth { .. })
    }

    /// Returns true in the medium.
    #[inline]
    #[must_use]
    pub fn is_in_medium(&self) -> bool {
        matches!(self.site, PathSite::Medium { .. })
    }

    /// f_s, without the colour, for the directions of the edges before and behind, from the camera to the light; 1 at the ends of a path.
    #[inline]
    #[must_use]
    pub fn scatter(&self, world: &dyn PathWorld, before: DVec3, behind: DVec3) -> f64 {
        match self.site {
            PathSite::Medium { sigma_t } => sigma_t * world.phase(before.dot(behind)),
            PathSite::Diffuse { normal, .. } => {
                if normal.dot(before) * normal.dot(behind) < 0.0 {
                    std::f64::consts::FRAC_1_PI
                } else {
                    0.0
                }
            }
            PathSite::Smooth { ratio, share, .. } => share / ratio,
            PathSite::Pinhole | PathSite::Lamp { .. } | PathSite::Point(_) | PathSite::Far(_) => 1.0,
        }
    }
}

/// Continuation behind a smooth surface in a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Continuation {
    /// The vertex.
    pub(super) site: PathSite,
    /// The direction of travel behind it.
    pub(super) direction: DVec3,
}

/// The way to an end of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Towards {
    /// To the camera: x_k to x_0.
    Eye,
    /// To the light: x_0 to x_k.
    Light,
}

impl Continuation {
    /// Reflects or refracts what comes along `direction`; `None` where that material does not, or for total reflection.
    pub(super) fn at(
        world: &dyn PathWorld,
        met: &Met,
        direction: DVec3,
        reflects: bool,
        towards: Towards,
    ) -> Option<Self> {
        let Met { normal, surface, outside, .. } = *met;
        let relative = match world.surface(surface).0 {
            Material::Diffuse { .. } => return None,
            Material::Mirror => {
                let site = PathSite::Smooth { normal, surface, ratio: 1.0, reflects, share: 1.0 };
                return reflects.then(|| Self { site, direction: reflect(direction, normal) });
            }
            Material::Dielectric { ior } => {
                if outside {
                    ior
                } else {
                    1.0 / ior
                }
            }
        };
        let reflected = fresnel_reflectance(-normal.dot(direction), relative);
        let (direction, ratio, share) = if reflects {
            (reflect(direction, normal), 1.0, reflected)
        } else {
            let ratio = if towards == Towards::Light { relative } else { 1.0 / relative };
            (refract(direction, normal, relative)?, ratio, 1.0 - reflected)
        };
        let site = PathSite::Smooth { normal, surface, ratio, reflects, share };
        Some(Self { site, direction })
    }
}
