//! A medium among surfaces and lights, and how light travels in it.

use super::{Lobe, Vertex};
use crate::walk::Leg;
use crate::{RayTransmittance, SamplingExtinction, Walk};
use fairflight_collision::SingleParticle;
use fairflight_media::{Medium, PhaseFunction};
use fairflight_scene::surface::{fresnel_reflectance, reflect, refract};
use fairflight_scene::{Geometry, Hit, Lights, Material, Segment, Spectrum, Volume};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// What paths meet. A scene without surfaces has [`NoSurfaces`](fairflight_scene::NoSurfaces), one without a medium a medium that is
/// empty by its type: neither compiles to code of the other.
#[derive(Debug)]
pub struct World<'s, G, M, P, C> {
    /// What scatters on the way.
    pub volume: &'s Volume<M, P, C>,
    /// What ends the way.
    pub surfaces: &'s G,
    /// What shines, apart from surfaces.
    pub lights: &'s Lights<C>,
}

impl<G, M, P, C> Clone for World<'_, G, M, P, C> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<G, M, P, C> Copy for World<'_, G, M, P, C> {}

/// Where a particle got to along a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event<C> {
    /// It was scattered in the medium.
    Scattered {
        /// Where.
        vertex: Vertex,
        /// Its energy behind the collision, relative to that at the start; the expected energy per length is σ_s T.
        energy: C,
    },
    /// It met the end of the segment.
    Passed {
        /// Its energy; on average the transmittance T.
        weight: f64,
    },
    /// It was absorbed, or lost at roulette.
    Absorbed,
    /// It met as many collisions as it was allowed: a bias.
    Truncated,
}

/// How light goes on behind a smooth surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Of travel.
    pub direction: DVec3,
    /// Radiance in front of the surface for radiance behind it; 1 for power, and for mirrors.
    pub radiance_scale: f64,
}

impl<G, M, P, C> World<'_, G, M, P, C>
where
    C: Spectrum,
    G: Geometry<C>,
    M: Medium,
    P: PhaseFunction,
{
    /// A ball that holds medium and surfaces: its center and its radius \[length\]; a point where there is nothing.
    pub fn enclosing_ball(&self) -> (DVec3, f64) {
        let surfaces = self.surfaces.surfaces();
        if surfaces.is_empty() {
            return self.volume.bounds.enclosing_ball();
        }
        let medium = (!M::IS_EMPTY).then(|| self.volume.bounds.corners());
        let corners = surfaces.iter().map(|surface| surface.shape.corners()).chain(medium);
        let (min, max) = corners
            .reduce(|(min, max), (low, high)| (min.min(low), max.max(high)))
            .expect("there is at least one surface");
        (0.5 * (min + max), 0.5 * (max - min).length())
    }

    /// The collisions of a walk in this medium, to be handed to [`follow`](Self::follow).
    pub fn collisions<R: SamplingExtinction>(&self, walk: &Walk<R>) -> (SingleParticle, C) {
        walk.collisions(self.volume)
    }

    /// Follows a particle of energy 1 along a segment, whose end is the nearest surface or whatever else one is interested in.
    #[inline]
    pub fn follow<R, S>(
        &self,
        walk: &Walk<R>,
        (model, ratio): &(SingleParticle, C),
        segment: &Segment,
        source: &mut S,
    ) -> Event<C>
    where
        R: SamplingExtinction,
        S: UniformSource + ?Sized,
    {
        let length = segment.length.is_finite().then_some(segment.length);
        let Some(ray) = self.volume.enter(&segment.line, length) else {
            return Event::Passed { weight: 1.0 };
        };
        let mut left = walk.max_collisions();
        match walk.fly(model, &ray, 1.0, &mut left, source) {
            Leg::Scattered { s, weight } => {
                let lobe = Lobe::Phase { incident: segment.line.direction };
                let vertex = Vertex { position: ray.world_point(s), lobe };
                Event::Scattered { vertex, energy: *ratio * weight }
            }
            Leg::Passed { weight } => Event::Passed { weight },
            Leg::Absorbed => Event::Absorbed,
            Leg::Truncated => Event::Truncated,
        }
    }

    /// An unbiased estimate of the transmittance of a segment \[1\], whatever surfaces lie on it.
    #[inline]
    pub fn transmittance<T, S>(&self, segment: &Segment, shadow: &mut T, source: &mut S) -> f64
    where
        T: RayTransmittance<M>,
        S: UniformSource + ?Sized,
    {
        let length = segment.length.is_finite().then_some(segment.length);
        match self.volume.enter(&segment.line, length) {
            Some(ray) => shadow.estimate(&ray, source),
            None => 1.0,
        }
    }

    /// V of raab-2008 eq. 9: 0 if a surface is between the ends, else an unbiased estimate of the transmittance \[1\].
    #[inline]
    pub fn attenuated_visibility<T, S>(&self, segment: &Segment, shadow: &mut T, source: &mut S) -> f64
    where
        T: RayTransmittance<M>,
        S: UniformSource + ?Sized,
    {
        if self.surfaces.is_occluded(segment) { 0.0 } else { self.transmittance(segment, shadow, source) }
    }

    /// The vertex where a ray meets a diffuse surface, and the reflectance; `None` on a smooth one.
    #[inline]
    pub fn diffuse_vertex(&self, hit: &Hit<'_, C>) -> Option<(Vertex, C)> {
        let Material::Diffuse { reflectance } = hit.surface.material else { return None };
        let lobe = Lobe::Diffuse { normal: hit.normal, surface: hit.index };
        Some((Vertex { position: hit.position, lobe }, reflectance))
    }

    /// Whether a segment meets the medium at all.
    #[inline]
    pub fn meets_medium(&self, segment: &Segment) -> bool {
        let length = segment.length.is_finite().then_some(segment.length);
        self.volume.enter(&segment.line, length).is_some()
    }

    /// How light goes on behind a smooth surface; `None` for a diffuse one. Reflection and refraction are chosen in proportion to
    /// Fresnel's equations, so that either weighs 1.
    ///
    /// Radiance is compressed by refraction: L/n² is what stays the same along a ray.
    #[inline]
    pub fn pass<S: UniformSource + ?Sized>(
        &self,
        hit: &Hit<'_, C>,
        direction: DVec3,
        source: &mut S,
    ) -> Option<Passage> {
        let reflected = || Passage { direction: reflect(direction, hit.normal), radiance_scale: 1.0 };
        match hit.surface.material {
            Material::Diffuse { .. } => None,
            Material::Mirror => Some(reflected()),
            Material::Dielectric { ior } => {
                let relative = if hit.outside { ior } else { 1.0 / ior };
                if source.next_uniform() < fresnel_reflectance(-hit.normal.dot(direction), relative) {
                    return Some(reflected());
                }
                // Where nothing is refracted everything was reflected above, but for rounding.
                Some(match refract(direction, hit.normal, relative) {
                    Some(direction) => Passage { direction, radiance_scale: 1.0 / (relative * relative) },
                    None => reflected(),
                })
            }
        }
    }
}
