//! Surfaces: what a ray meets where it is not scattered.
//!
//! A handful of primitives, intersected one by one; no meshes, no textures. All of them are two-sided.

mod geometry;
mod material;
mod rectangle;
mod shape;
mod sphere;
mod surfaces;
mod towards;

pub use geometry::{Geometry, Hit, NoSurfaces, Segment};
pub use material::{Material, Surface, fresnel_reflectance, reflect, refract};
pub use rectangle::Rectangle;
pub use shape::{AreaSample, Shape, TowardsSample};
pub use sphere::Sphere;
pub use surfaces::Surfaces;
