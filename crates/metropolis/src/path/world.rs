//! Scenes as mutations see them, whatever they are made of.

use fairflight_bidirectional::Exact;
use fairflight_media::{Extinction, LineThickness, Medium, OpticalThickness, PhaseFunction, Ray};
use fairflight_paths::transport::{Light, Types, World};
use fairflight_scene::{Camera, Geometry, Material, Segment, Source, Spectrum, Volume};
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::f64::consts::PI;
use std::fmt;

/// A scene behind one pointer: mutations are compiled once and not for each medium, since it is intersections that they spend their time
/// with. Colours are three numbers, three times the same in a gray scene.
pub trait PathWorld {
    /// The camera.
    fn camera(&self) -> &Camera;

    /// The nearest surface on a segment.
    fn intersect(&self, segment: &Segment) -> Option<Met>;

    /// Returns true if a surface lies between the ends of a segment ([`Geometry::is_occluded`]).
    fn is_occluded(&self, segment: &Segment) -> bool;

    /// The logarithm of the transmittance of a segment, or of an estimate of it that stays with the path ([`NullCollisions`](super::NullCollisions)).
    fn ln_transmittance(&self, segment: &Segment, source: &mut dyn UniformSource) -> f64;

    /// The same for an edge of a path that was found elsewhere ([`EdgeTransmittance::ln_found`]).
    fn ln_found(&self, segment: &Segment, source: &mut dyn UniformSource) -> f64;

    /// The extinction at a point, 0 outside the medium \[1/length\].
    fn sigma_t(&self, point: DVec3) -> f64;

    /// The albedo of the medium \[1\].
    fn albedo(&self) -> DVec3;

    /// The phase function \[1/sr\].
    fn phase(&self, cosine: f64) -> f64;

    /// Material and emission of a surface.
    fn surface(&self, index: usize) -> (Material<DVec3>, DVec3);

    /// Normal of the outer side of a surface at one of its points, of unit length, and true if the surface encloses a volume.
    fn outer_side(&self, index: usize, point: DVec3) -> (DVec3, bool);

    /// The place of a light without extent; `None` of a directional one.
    fn point_light(&self, index: usize) -> Option<DVec3>;

    /// The strength of a light at a point, or from a direction where it is infinitely far: radiance, power/4π of a point light, irradiance of a
    /// directional one.
    fn strength(&self, light: Light, at: DVec3) -> DVec3;
}

/// Point of a surface that a ray met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Distance from the start of the ray \[length\].
    pub distance: f64,
    /// The point.
    pub position: DVec3,
    /// Normal of unit length, on the side from where the ray comes.
    pub normal: DVec3,
    /// True if that is the outer side.
    pub outside: bool,
    /// The surface.
    pub surface: usize,
}

/// Transmittance of the edges of paths.
///
/// **Law.** The exponential of what is returned has the expectation exp(−∫ σ_t), and is nowhere negative. An estimate is part of the state: it
/// is drawn when an edge changes, and stays with the edge as long as that does not.
pub trait EdgeTransmittance<M> {
    /// Its logarithm along a ray in the medium, of an edge that a mutation makes.
    fn ln_transmittance(&self, ray: &Ray<&M>, source: &mut dyn UniformSource) -> f64;

    /// The same of an edge of a path that was found with a weight: drawn with a density that is the estimate itself over the transmittance, times that of
    /// [`ln_transmittance`](Self::ln_transmittance). Where nothing is drawn the two are one.
    fn ln_found(&self, ray: &Ray<&M>, source: &mut dyn UniformSource) -> f64 {
        self.ln_transmittance(ray, source)
    }
}

/// The closed form: nothing is drawn.
impl<M: LineThickness> EdgeTransmittance<M> for Exact {
    #[inline]
    fn ln_transmittance(&self, ray: &Ray<&M>, _source: &mut dyn UniformSource) -> f64 {
        -ray.optical_thickness(0.0, ray.length())
    }
}

/// A scene with its camera, and the transmittance of edges.
pub struct View<'s, W: Types, E> {
    /// The scene.
    pub world: World<'s, W>,
    /// The camera.
    pub camera: &'s Camera,
    /// Transmittance of edges.
    pub edges: E,
}

impl<W: Types, E: fmt::Debug> fmt::Debug for View<'_, W, E> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("View").field("edges", &self.edges).finish_non_exhaustive()
    }
}

impl<W: Types, E> View<'_, W, E> {
    fn enter(&self, segment: &Segment) -> Option<Ray<&W::Medium>> {
        let length = segment.length.is_finite().then_some(segment.length);
        self.world.volume.enter(&segment.line, length)
    }
}

fn colour(value: impl Spectrum) -> DVec3 {
    DVec3::from_array(value.rgb())
}

impl<W: Types, E: EdgeTransmittance<W::Medium>> PathWorld for View<'_, W, E> {
    fn camera(&self) -> &Camera {
        self.camera
    }

    fn intersect(&self, segment: &Segment) -> Option<Met> {
        let hit = self.world.surfaces.intersect(segment)?;
        Some(Met {
            distance: hit.distance,
            position: hit.position,
            normal: hit.normal,
            outside: hit.outside,
            surface: hit.index,
        })
    }

    fn is_occluded(&self, segment: &Segment) -> bool {
        self.world.surfaces.is_occluded(segment)
    }

    fn ln_transmittance(&self, segment: &Segment, source: &mut dyn UniformSource) -> f64 {
        self.enter(segment).map_or(0.0, |ray| self.edges.ln_transmittance(&ray, source))
    }

    fn ln_found(&self, segment: &Segment, source: &mut dyn UniformSource) -> f64 {
        self.enter(segment).map_or(0.0, |ray| self.edges.ln_found(&ray, source))
    }

    fn sigma_t(&self, point: DVec3) -> f64 {
        let Volume { medium, bounds, .. } = self.world.volume;
        if !W::Medium::IS_EMPTY && bounds.contains(point) { medium.sigma_t(point) } else { 0.0 }
    }

    fn albedo(&self) -> DVec3 {
        colour(self.world.volume.albedo)
    }

    fn phase(&self, cosine: f64) -> f64 {
        self.world.volume.phase.eval(cosine)
    }

    fn surface(&self, index: usize) -> (Material<DVec3>, DVec3) {
        let surface = &self.world.surfaces.surfaces()[index];
        let material = match surface.material {
            Material::Diffuse { reflectance } => Material::Diffuse { reflectance: colour(reflectance) },
            Material::Mirror => Material::Mirror,
            Material::Dielectric { ior } => Material::Dielectric { ior },
        };
        (material, colour(surface.emission))
    }

    fn outer_side(&self, index: usize, point: DVec3) -> (DVec3, bool) {
        let shape = &self.world.surfaces.surfaces()[index].shape;
        (shape.normal(point), shape.is_closed())
    }

    fn point_light(&self, index: usize) -> Option<DVec3> {
        match self.world.lights.sources[index] {
            Source::Point { position, .. } => Some(position),
            Source::Directional { .. } => None,
        }
    }

    fn strength(&self, light: Light, at: DVec3) -> DVec3 {
        let background = &self.world.lights.background;
        match light {
            Light::Constant => colour(background.constant),
            Light::Map(index) => colour(background.maps[index].radiance(at)),
            Light::Source(index) => match self.world.lights.sources[index] {
                Source::Point { power, .. } => colour(power) * (0.25 / PI),
                Source::Directional { irradiance, .. } => colour(irradiance),
            },
            Light::Surface(index) => colour(self.world.surfaces.surfaces()[index].emission),
        }
    }
}
