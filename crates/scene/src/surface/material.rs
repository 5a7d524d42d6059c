//! What a surface does with light.

use super::Shape;
use crate::{SceneError, Spectrum};
use glam::DVec3;

/// How a surface scatters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material<C> {
    /// Lambert: the same radiance into all directions of the side that is lit; nothing passes.
    Diffuse {
        /// Share of the light that is not absorbed \[1\].
        reflectance: C,
    },
    /// All light, into one direction.
    Mirror,
    /// A smooth interface between index 1 on the outer side and `ior` on the inner one: Fresnel's equations.
    Dielectric {
        /// Index of refraction of the inner side \[1\].
        ior: f64,
    },
}

/// A shape with what it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface<C> {
    /// Where it is.
    pub shape: Shape,
    /// What it does with light.
    pub material: Material<C>,
    /// The radiance that it emits from both sides into all directions.
    pub emission: C,
}

impl<C: Spectrum> Surface<C> {
    /// A surface.
    ///
    /// # Errors
    /// If reflectance or emission are negative or not finite, or `ior` is not positive and finite. A reflectance above 1 is a gain,
    /// which the caller permits or not.
    pub fn new(shape: Shape, material: Material<C>, emission: C) -> Result<Self, SceneError> {
        let _ = (shape, material, emission);
        todo!()
    }

    /// Whether it shines.
    #[must_use]
    pub fn emits(&self) -> bool {
        self.emission != C::ZERO
    }

    /// Whether light cannot pass.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        !matches!(self.material, Material::Dielectric { .. })
    }

    /// Whether it has one direction for one direction: nothing can be connected with it.
    #[must_use]
    pub fn is_specular(&self) -> bool {
        !matches!(self.material, Material::Diffuse { .. })
    }
}

/// The share of unpolarised light that a smooth interface reflects (Fresnel). `cosine` ≥ 0 between the ray and the normal on its
/// side; `relative_ior` = index on the far side / index on the near side. 1 for total reflection.
#[must_use]
pub fn fresnel_reflectance(cosine: f64, relative_ior: f64) -> f64 {
    let _ = (cosine, relative_ior);
    todo!()
}

/// The mirrored direction of travel; `normal` of unit length, on either side.
#[must_use]
pub fn reflect(direction: DVec3, normal: DVec3) -> DVec3 {
    let _ = (direction, normal);
    todo!()
}

/// The refracted direction of travel; `normal` on the side from where the ray comes. `None` for total reflection.
#[must_use]
pub fn refract(direction: DVec3, normal: DVec3, relative_ior: f64) -> Option<DVec3> {
    let _ = (direction, normal, relative_ior);
    todo!()
}
