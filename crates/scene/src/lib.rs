//! The least geometry that the papers' figures need: a pinhole camera, one medium in its bounds, lights, a few surfaces.
//!
//! A [`Scene`] is generic over its medium, its phase function and its [`Spectrum`], so that it compiles to what it has: a
//! gray scene carries no colour, a homogeneous medium no look-up, a scene without surfaces no intersection.
//!
//! Directions of travel are those of importons (from the camera) unless said otherwise; radiance is symmetric.

mod background;
mod camera;
mod directions;
mod environment_map;
mod error;
mod light;
mod spectrum;
pub mod surface;
#[cfg(test)]
mod variates;
mod volume;

pub use background::Background;
pub use camera::{Camera, Projection};
pub use directions::cosine_hemisphere;
pub use environment_map::EnvironmentMap;
pub use error::SceneError;
pub use light::{Connection, Emission, Lights, Source};
pub use spectrum::Spectrum;
pub use surface::{Geometry, Hit, Material, NoSurfaces, Segment, Shape, Surface, Surfaces};
pub use volume::Volume;

/// A camera that looks at a medium among lights.
#[derive(Clone, Debug)]
pub struct Scene<M, P, C> {
    /// Who looks.
    pub camera: Camera,
    /// What scatters.
    pub volume: Volume<M, P, C>,
    /// What shines.
    pub lights: Lights<C>,
}
