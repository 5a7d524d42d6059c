//! The surfaces of a scene.

use super::ColourSpec;
use crate::reader::rule::{Own, Positive, Ruled, Vector};
use crate::reader::{Node, Object};
use crate::{Failure, kind, registry};
use fairflight_scene::surface::{Rectangle, Sphere};
use fairflight_scene::{SceneError, Shape};
use glam::DVec3;

/// A surface as given.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceSpec {
    /// Shape of the surface.
    pub shape: ShapeSpec,
    /// The material.
    pub material: MaterialSpec,
    /// The radiance that it emits from both sides; 0 without the key.
    pub emission: ColourSpec,
}

registry! {
    /// The shape of a surface.
    ShapeSpec: ShapeKind {
        Rectangle(RectangleSpec),
        Sphere(SphereSpec),
    }
}

registry! {
    /// The material of a surface.
    MaterialSpec {
        Diffuse(DiffuseSpec),
        Mirror(MirrorSpec),
        Dielectric(DielectricSpec),
    }
}

/// A kind of shapes: how it is built, what it encloses.
pub trait ShapeKind {
    /// The shape.
    ///
    /// # Errors
    /// If it is degenerate.
    fn build(&self) -> Result<Shape, SceneError>;

    /// Points whose convex hull holds the shape, as far as it has such; a ball has none.
    fn corners(&self) -> Option<[DVec3; 4]>;

    /// The ball that it is, if it is one: centre and radius.
    fn ball(&self) -> Option<(DVec3, f64)>;
}

kind! {
    /// A parallelogram.
    RectangleSpec = "rectangle" {
        /// One of its corners.
        corner: DVec3 as Vector,
        /// From there to a neighbour.
        edge_u: DVec3 as Vector,
        /// From there to the other one.
        edge_v: DVec3 as Vector,
    }
    check RectangleSpec::check
}

kind! {
    /// A sphere.
    SphereSpec = "sphere" {
        /// Its centre.
        center: DVec3 as Vector,
        /// Its radius \[length\].
        radius: f64 as Positive,
    }
    check |sphere: &SphereSpec, object| sphere.build().map(|_| ()).map_err(|error| object.reject(error))
}

kind! {
    /// Lambert.
    DiffuseSpec = "diffuse" {
        /// The share of light that is reflected; above 1 only with `allow_gain`.
        reflectance: ColourSpec as Own,
    }
}

kind! {
    /// All light, into one direction.
    MirrorSpec = "mirror" {}
}

kind! {
    /// A smooth interface.
    DielectricSpec = "dielectric" {
        /// The index of refraction of the inner side.
        ior: f64 as Positive,
    }
}

impl SurfaceSpec {
    /// Reads one of `surfaces`. A reflectance above 1 needs `allow_gain`.
    ///
    /// # Errors
    /// If a key is missing, unknown or of the wrong kind, or the shape is degenerate.
    pub fn read(node: &Node<'_>, allow_gain: bool) -> Result<Self, Failure> {
        let object = node.object()?;
        let shape = ShapeSpec::take(&object)?;
        let given = object.required("material")?;
        if let (Some(reflectance), false) = (given.object()?.optional("reflectance"), allow_gain) {
            ColourSpec::read(&reflectance, 1.0)?;
        }
        let material = MaterialSpec::read(&given)?;
        let emission = object.optional("emission").map(|node| <ColourSpec as Ruled>::read(&node));
        let emission = emission.unwrap_or(Ok(ColourSpec::Gray(0.0)))?;
        object.finish()?;
        Ok(Self { shape, material, emission })
    }

    /// True if the surface emits light.
    #[must_use]
    pub fn emits(&self) -> bool {
        self.emission.rgb() != [0.0; 3]
    }

    /// True if one channel is enough.
    #[must_use]
    pub fn is_gray(&self) -> bool {
        let reflects_gray = match &self.material {
            MaterialSpec::Diffuse(material) => material.reflectance.is_gray(),
            MaterialSpec::Mirror(_) | MaterialSpec::Dielectric(_) => true,
        };
        reflects_gray && self.emission.is_gray()
    }
}

impl RectangleSpec {
    /// Blames the edge that is degenerate, as far as one is.
    fn check(&self, object: &Object<'_>) -> Result<(), Failure> {
        let Err(error) = self.build() else { return Ok(()) };
        Err(match &error {
            SceneError::Degenerate { what: what @ ("edge_u" | "edge_v"), because } => {
                let key = if *what == "edge_u" { "edge_u" } else { "edge_v" };
                object.required(key)?.refuse(format!("must not be {because}"))
            }
            _ => object.reject(error),
        })
    }
}

impl ShapeKind for RectangleSpec {
    fn build(&self) -> Result<Shape, SceneError> {
        Rectangle::new(self.corner, self.edge_u, self.edge_v).map(Shape::Rectangle)
    }
    fn corners(&self) -> Option<[DVec3; 4]> {
        let &Self { corner, edge_u, edge_v } = self;
        Some([corner, corner + edge_u, corner + edge_v, corner + edge_u + edge_v])
    }
    fn ball(&self) -> Option<(DVec3, f64)> {
        None
    }
}

impl ShapeKind for SphereSpec {
    fn build(&self) -> Result<Shape, SceneError> {
        Sphere::new(self.center, self.radius).map(Shape::Sphere)
    }
    fn corners(&self) -> Option<[DVec3; 4]> {
        None
    }
    fn ball(&self) -> Option<(DVec3, f64)> {
        Some((self.center, self.radius))
    }
}

impl ShapeSpec {
    /// True for a ball with `point` strictly inside; nothing lies inside a rectangle.
    #[must_use]
    pub fn encloses(&self, point: DVec3) -> bool {
        self.kind().ball().is_some_and(|(center, radius)| center.distance(point) < radius)
    }

    /// True for a ball with all of `other` strictly inside.
    #[must_use]
    pub fn encloses_all_of(&self, other: &Self) -> bool {
        let Some((center, radius)) = self.kind().ball() else { return false };
        match (other.kind().corners(), other.kind().ball()) {
            // A ball is convex: the corners tell.
            (Some(corners), _) => corners.into_iter().all(|corner| self.encloses(corner)),
            (None, Some((inner, inner_radius))) => center.distance(inner) + inner_radius < radius,
            (None, None) => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sphere(x: f64, radius: f64) -> ShapeSpec {
        SphereSpec { center: DVec3::X * x, radius }.into()
    }

    #[test]
    fn what_lies_inside_a_sphere() {
        let ball = sphere(1.0, 2.0);
        assert!(ball.encloses(DVec3::X * 2.9) && !ball.encloses(DVec3::X * 3.0));
        assert!(ball.encloses_all_of(&sphere(2.0, 0.9)) && !ball.encloses_all_of(&sphere(2.0, 1.0)));
        // Around it, not inside.
        assert!(!sphere(2.0, 0.9).encloses_all_of(&ball) && !ball.encloses_all_of(&ball));
        let square = |side: f64| {
            let (edge_u, edge_v) = (DVec3::Y * side, DVec3::Z * side);
            ShapeSpec::from(RectangleSpec { corner: DVec3::X, edge_u, edge_v })
        };
        // The far corner lies √2 sides away.
        assert!(ball.encloses_all_of(&square(1.41)) && !ball.encloses_all_of(&square(1.42)));
        assert!(!square(9.0).encloses(DVec3::X) && !square(9.0).encloses_all_of(&ball));
    }
}
