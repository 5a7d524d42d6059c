//! Reflection and refraction of light at a surface.

use super::Shape;
use crate::{SceneError, Spectrum};
use glam::DVec3;

/// Law by which a surface scatters.
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
    /// Shape and place of the surface.
    pub shape: Shape,
    /// Reflection and refraction of light.
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
        match material {
            Material::Diffuse { reflectance } => SceneError::check_strength("reflectance", reflectance)?,
            Material::Dielectric { ior } => SceneError::check_positive("ior", ior)?,
            Material::Mirror => {}
        }
        SceneError::check_strength("emission", emission)?;
        Ok(Self { shape, material, emission })
    }

    /// True if the surface emits light.
    #[must_use]
    pub fn emits(&self) -> bool {
        self.emission != C::ZERO
    }

    /// True if light cannot pass the surface.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        !matches!(self.material, Material::Dielectric { .. })
    }

    /// True if the surface has one direction for one direction: nothing can be connected with it.
    #[must_use]
    pub fn is_specular(&self) -> bool {
        !matches!(self.material, Material::Diffuse { .. })
    }
}

/// The share of unpolarised light that a smooth interface reflects (Fresnel). `cosine` ≥ 0 between the ray and the normal on its
/// side; `relative_ior` = index on the far side / index on the near side. 1 for total reflection, and along the interface.
#[must_use]
pub fn fresnel_reflectance(cosine: f64, relative_ior: f64) -> f64 {
    let Some(transmitted) = transmitted_cosine(cosine, relative_ior) else { return 1.0 };
    let ratio = |near: f64, far: f64| (near - far) / (near + far);
    let across_plane = ratio(cosine, relative_ior * transmitted);
    let in_plane = ratio(relative_ior * cosine, transmitted);
    0.5 * (across_plane * across_plane + in_plane * in_plane)
}

/// The mirrored direction of travel; `normal` of unit length, on either side.
#[must_use]
pub fn reflect(direction: DVec3, normal: DVec3) -> DVec3 {
    (direction - 2.0 * direction.dot(normal) * normal).normalize()
}

/// The refracted direction of travel; `normal` on the side from where the ray comes. `None` for total reflection, which is where
/// [`fresnel_reflectance`] is 1 for the cosine −direction · normal.
#[must_use]
pub fn refract(direction: DVec3, normal: DVec3, relative_ior: f64) -> Option<DVec3> {
    let cosine = -direction.dot(normal);
    let transmitted = transmitted_cosine(cosine, relative_ior)?;
    // What lies along the interface keeps its product with the index (Snell).
    let along = (direction + cosine * normal) / relative_ior;
    Some((along - transmitted * normal).normalize())
}

/// The cosine of the refracted ray: √(1 − (1 − c²)/η²), as (η − 1)(η + 1)/η² + (c/η)², which does not cancel for indices near 1. `None`
/// where that is not above 0.
fn transmitted_cosine(cosine: f64, relative_ior: f64) -> Option<f64> {
    debug_assert!(cosine >= 0.0, "the normal lies on the far side: {cosine}");
    debug_assert!(relative_ior > 0.0, "{relative_ior}");
    let scaled = cosine / relative_ior;
    let squared =
        ((relative_ior - 1.0) / relative_ior) * ((relative_ior + 1.0) / relative_ior) + scaled * scaled;
    (squared > 0.0).then(|| squared.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Sphere;
    use crate::variates::Variates;

    #[test]
    fn at_right_angles_the_share_is_that_of_the_indices() {
        for n in [1.0 + 1e-9, 1.33, 1.5, 2.4, 1.0 / 1.5, 0.1] {
            let expected = ((n - 1.0) / (n + 1.0)) * ((n - 1.0) / (n + 1.0));
            assert!((fresnel_reflectance(1.0, n) - expected).abs() <= 1e-14 * expected, "{n}");
        }
        assert_eq!(fresnel_reflectance(0.3, 1.0), 0.0);
        assert_eq!(fresnel_reflectance(0.0, 1.5), 1.0);
    }

    #[test]
    fn at_brewsters_angle_one_polarisation_is_left() {
        // tan θ = n. What is polarised in the plane passes; of the other, ((1 − n²)/(1 + n²))² is reflected.
        for n in [1.33, 1.5, 1.0 / 1.5] {
            let cosine = 1.0 / f64::hypot(1.0, n);
            let amplitude = (1.0 - n * n) / (1.0 + n * n);
            assert!((fresnel_reflectance(cosine, n) - 0.5 * amplitude * amplitude).abs() < 1e-15);
        }
    }

    #[test]
    fn beyond_the_critical_angle_nothing_passes() {
        let n = 1.0 / 1.5;
        let critical = (1.0f64 - n * n).sqrt();
        assert_eq!(fresnel_reflectance(critical - 1e-9, n), 1.0);
        assert!(fresnel_reflectance(critical + 1e-3, n) < 0.9);
        let slanted = |cosine: f64| DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, -cosine);
        assert!(refract(slanted(critical - 1e-9), DVec3::Z, n).is_none());
        assert!(refract(slanted(critical + 1e-9), DVec3::Z, n).is_some());
    }

    #[test]
    fn directions_obey_snell_and_return_the_way_they_came() {
        let mut next = Variates::new(51);
        for _ in 0..20_000 {
            let (direction, normal) = (next.vector().normalize(), next.vector().normalize());
            let normal = if direction.dot(normal) > 0.0 { -normal } else { normal };
            let cosine = -direction.dot(normal);

            // One reflection is some fifteen roundings of up to 1.1e-16, those of the unit vectors included.
            let mirrored = reflect(direction, normal);
            assert!((mirrored.length() - 1.0).abs() < 4e-16);
            assert!((mirrored.dot(normal) - cosine).abs() < 2e-15);
            assert!((mirrored - reflect(direction, -normal)).length() < 2e-15);
            assert!((reflect(mirrored, normal) - direction).length() < 4e-15);

            let n = 0.4 + 2.0 * next.draw();
            let Some(refracted) = refract(direction, normal, n) else {
                assert_eq!(fresnel_reflectance(cosine, n), 1.0);
                assert!(cosine * cosine < 1.0 - n * n + 1e-15);
                continue;
            };
            assert!((refracted.length() - 1.0).abs() < 4e-16);
            assert!(refracted.dot(normal) < 0.0);
            let sines = [direction, refracted].map(|d| d.cross(normal));
            assert!((sines[0] - n * sines[1]).length() < 1e-14);
            let transmitted = -refracted.dot(normal);
            if transmitted > 1e-3 {
                // A cosine is the root of a number that is rounded by 1e-16: its error is that over the cosine.
                let back = refract(-refracted, -normal, 1.0 / n).unwrap();
                assert!((back + direction).length() < 1e-14 / cosine.min(transmitted));
                let both = [fresnel_reflectance(cosine, n), fresnel_reflectance(transmitted, 1.0 / n)];
                assert!((both[0] - both[1]).abs() < 1e-10 && (0.0..1.0).contains(&both[0]), "{both:?}");
            }
        }
    }

    #[test]
    fn extreme_indices_are_no_numbers_gone_wrong() {
        assert!(fresnel_reflectance(0.5, 1e200) > 1.0 - 1e-15);
        assert_eq!(fresnel_reflectance(0.5, 1e-200), 1.0);
        assert_eq!(refract(DVec3::NEG_Z, DVec3::Z, 1e200), Some(DVec3::NEG_Z));
    }

    #[test]
    fn bad_surfaces_are_refused() {
        let shape = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap());
        let diffuse = |reflectance| Surface::new(shape, Material::Diffuse { reflectance }, 0.0);
        let dielectric = |ior| Surface::new(shape, Material::Dielectric { ior }, 0.0);
        assert_eq!(diffuse(-0.5), Err(SceneError::Negative { what: "reflectance", found: -0.5 }));
        assert_eq!(diffuse(f64::NAN), Err(SceneError::NotFinite { what: "reflectance" }));
        assert!(diffuse(1.5).is_ok(), "a gain is the caller's to permit");
        assert_eq!(dielectric(0.0), Err(SceneError::NotPositive { what: "ior", found: 0.0 }));
        assert_eq!(dielectric(f64::INFINITY), Err(SceneError::NotFinite { what: "ior" }));
        let emission = DVec3::new(1.0, -2.0, 0.0);
        assert_eq!(
            Surface::new(shape, Material::Mirror, emission),
            Err(SceneError::Negative { what: "emission", found: -2.0 })
        );
        let mirror = Surface::new(shape, Material::Mirror, 0.0).unwrap();
        assert!(mirror.is_opaque() && mirror.is_specular() && !mirror.emits());
        let glass = Surface::new(shape, Material::Dielectric { ior: 1.5 }, 1.0).unwrap();
        assert!(!glass.is_opaque() && glass.is_specular() && glass.emits());
    }
}
