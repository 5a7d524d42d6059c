//! The least geometry that the papers' figures need: a pinhole camera, one medium in its bounds, lights, a few surfaces.
//!
//! A [`Scene`] is generic over its medium, its phase function and its [`Spectrum`], so that it compiles to what it has: a
//! gray scene carries no colour, a homogeneous medium no look-up, a scene without surfaces no intersection.
//!
//! Directions of travel are those of importons (from the camera) unless said otherwise; radiance is symmetric.
//!
//! ```
//! use fairflight_media::phase::Isotropic;
//! use fairflight_media::{Bounds, Extinction, Homogeneous, OpticalThickness};
//! use fairflight_scene::{Camera, Volume};
//! use glam::DVec3;
//!
//! // A ball of haze of radius 1, seen from a distance of 5 in one pixel.
//! let volume = Volume {
//!     medium: Homogeneous::new(0.5).unwrap(),
//!     bounds: Bounds::sphere(DVec3::ZERO, 1.0).unwrap(),
//!     albedo: 0.9,
//!     phase: Isotropic,
//! };
//! let camera = Camera::new(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, DVec3::Y, 30.0, [1, 1]).unwrap();
//! let ray = volume.enter(&camera.ray([0, 0], [0.5, 0.5]), None).expect("the middle of the pixel meets the ball");
//! assert!((ray.optical_thickness(0.0, ray.length()) - 0.5 * 2.0).abs() < 1e-12);
//! ```

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
    /// The camera.
    pub camera: Camera,
    /// The medium in its bounds.
    pub volume: Volume<M, P, C>,
    /// The lights.
    pub lights: Lights<C>,
}
