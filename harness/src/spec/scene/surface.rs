//! The surfaces of a scene.

use super::ColourSpec;
use crate::Failure;
use crate::reader::Node;
use fairflight_scene::surface::{Rectangle, Sphere};
use fairflight_scene::{SceneError, Shape};
use glam::DVec3;

/// A surface as given.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceSpec {
    /// Where it is.
    pub shape: ShapeSpec,
    /// What it does with light.
    pub material: MaterialSpec,
    /// The radiance that it emits from both sides; 0 without the key.
    pub emission: ColourSpec,
}

/// A shape as given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShapeSpec {
    /// A parallelogram.
    Rectangle {
        /// One of its corners.
        corner: DVec3,
        /// From there to a neighbour.
        edge_u: DVec3,
        /// From there to the other one.
        edge_v: DVec3,
    },
    /// A sphere.
    Sphere {
        /// Its center.
        center: DVec3,
        /// Its radius \[length\], above 0.
        radius: f64,
    },
}

/// A material as given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MaterialSpec {
    /// Lambert.
    Diffuse {
        /// Above 1 only with `allow_gain`.
        reflectance: ColourSpec,
    },
    /// All light, into one direction.
    Mirror,
    /// A smooth interface.
    Dielectric {
        /// Index of refraction of the inner side, above 0.
        ior: f64,
    },
}

impl SurfaceSpec {
    /// Reads one of `surfaces`. A reflectance above 1 needs `allow_gain`.
    ///
    /// # Errors
    /// If a key is missing, unknown or of the wrong kind, or the shape is degenerate.
    pub fn read(node: &Node<'_>, allow_gain: bool) -> Result<Self, Failure> {
        let object = node.object()?;
        let kind = object.required("kind")?;
        let shape = match kind.text()? {
            "rectangle" => {
                let corner = object.required("corner")?.vector()?;
                let (edge_u, edge_v) = (object.required("edge_u")?, object.required("edge_v")?);
                let shape =
                    ShapeSpec::Rectangle { corner, edge_u: edge_u.vector()?, edge_v: edge_v.vector()? };
                shape.build().map_err(|error| refuse_rectangle(node, [&edge_u, &edge_v], &error))?;
                shape
            }
            "sphere" => {
                let center = object.required("center")?.vector()?;
                let shape = ShapeSpec::Sphere { center, radius: object.required("radius")?.positive()? };
                shape.build().map_err(|error| node.reject(error))?;
                shape
            }
            _ => return Err(kind.refuse("must be rectangle or sphere")),
        };
        let material = MaterialSpec::read(&object.required("material")?, allow_gain)?;
        let emission = object
            .optional("emission")
            .map_or(Ok(ColourSpec::Gray(0.0)), |node| ColourSpec::read(&node, f64::INFINITY))?;
        object.finish()?;
        Ok(Self { shape, material, emission })
    }

    /// Whether it shines.
    #[must_use]
    pub fn emits(&self) -> bool {
        self.emission.rgb() != [0.0; 3]
    }

    /// Whether one channel says it all.
    #[must_use]
    pub fn is_gray(&self) -> bool {
        let reflects_gray = match &self.material {
            MaterialSpec::Diffuse { reflectance } => reflectance.is_gray(),
            MaterialSpec::Mirror | MaterialSpec::Dielectric { .. } => true,
        };
        reflects_gray && self.emission.is_gray()
    }
}

/// The edge that is to blame, as far as one is.
fn refuse_rectangle(node: &Node<'_>, [edge_u, edge_v]: [&Node<'_>; 2], error: &SceneError) -> Failure {
    match error {
        SceneError::Degenerate { what: "edge_u", because } => edge_u.refuse(format!("must not be {because}")),
        SceneError::Degenerate { what: "edge_v", because } => edge_v.refuse(format!("must not be {because}")),
        _ => node.reject(error),
    }
}

impl ShapeSpec {
    /// The shape.
    ///
    /// # Errors
    /// If it is degenerate.
    pub fn build(&self) -> Result<Shape, SceneError> {
        Ok(match *self {
            Self::Rectangle { corner, edge_u, edge_v } => {
                Shape::Rectangle(Rectangle::new(corner, edge_u, edge_v)?)
            }
            Self::Sphere { center, radius } => Shape::Sphere(Sphere::new(center, radius)?),
        })
    }

    /// Whether it is a sphere with `point` strictly inside; nothing lies inside a rectangle.
    #[must_use]
    pub fn encloses(&self, point: DVec3) -> bool {
        match *self {
            Self::Rectangle { .. } => false,
            Self::Sphere { center, radius } => center.distance(point) < radius,
        }
    }

    /// Whether it is a sphere with all of `other` strictly inside.
    #[must_use]
    pub fn encloses_all_of(&self, other: &Self) -> bool {
        match (*self, *other) {
            (Self::Rectangle { .. }, _) => false,
            // A ball is convex: the corners tell.
            (_, Self::Rectangle { corner, edge_u, edge_v }) => {
                let corners = [corner, corner + edge_u, corner + edge_v, corner + edge_u + edge_v];
                corners.into_iter().all(|corner| self.encloses(corner))
            }
            (Self::Sphere { center, radius }, Self::Sphere { center: inner, radius: inner_radius }) => {
                center.distance(inner) + inner_radius < radius
            }
        }
    }
}

impl MaterialSpec {
    fn read(node: &Node<'_>, allow_gain: bool) -> Result<Self, Failure> {
        let object = node.object()?;
        let kind = object.required("kind")?;
        let material = match kind.text()? {
            "diffuse" => {
                let most = if allow_gain { f64::INFINITY } else { 1.0 };
                Self::Diffuse { reflectance: ColourSpec::read(&object.required("reflectance")?, most)? }
            }
            "mirror" => Self::Mirror,
            "dielectric" => Self::Dielectric { ior: object.required("ior")?.positive()? },
            _ => return Err(kind.refuse("must be diffuse, mirror or dielectric")),
        };
        object.finish()?;
        Ok(material)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sphere(x: f64, radius: f64) -> ShapeSpec {
        ShapeSpec::Sphere { center: DVec3::X * x, radius }
    }

    #[test]
    fn what_lies_inside_a_sphere() {
        let ball = sphere(1.0, 2.0);
        assert!(ball.encloses(DVec3::X * 2.9) && !ball.encloses(DVec3::X * 3.0));
        assert!(ball.encloses_all_of(&sphere(2.0, 0.9)) && !ball.encloses_all_of(&sphere(2.0, 1.0)));
        // Around it, not inside.
        assert!(!sphere(2.0, 0.9).encloses_all_of(&ball) && !ball.encloses_all_of(&ball));
        let square = |side: f64| ShapeSpec::Rectangle {
            corner: DVec3::X,
            edge_u: DVec3::Y * side,
            edge_v: DVec3::Z * side,
        };
        // The far corner lies √2 sides away.
        assert!(ball.encloses_all_of(&square(1.41)) && !ball.encloses_all_of(&square(1.42)));
        assert!(!square(9.0).encloses(DVec3::X) && !square(9.0).encloses_all_of(&ball));
    }
}
