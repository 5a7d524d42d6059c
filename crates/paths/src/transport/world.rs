//! A medium among surfaces and lights, and how light travels in it.

use super::{Lobe, MadeOf, Types, Vertex};
use crate::walk::Leg;
use crate::{RayTransmittance, SamplingExtinction, Walk};
use fairflight_collision::SingleParticle;
use fairflight_media::{Medium, PhaseFunction};
use fairflight_scene::surface::{fresnel_reflectance, reflect, refract};
use fairflight_scene::{Geometry, Hit, Lights, Material, Segment, Spectrum, Volume};
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::fmt;

/// A medium, surfaces and lights, as paths meet them. A scene without surfaces has [`NoSurfaces`](fairflight_scene::NoSurfaces), one without a medium a medium that is
/// empty by its type: neither compiles to code of the other.
pub struct World<'s, W: Types> {
    /// The scattering medium.
    pub volume: &'s Volume<W::Medium, W::Phase, W::Spectrum>,
    /// The surfaces.
    pub surfaces: &'s W::Geometry,
    /// The lights, apart from surfaces.
    pub lights: &'s Lights<W::Spectrum>,
}

impl<W: Types> Clone for World<'_, W> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<W: Types> Copy for World<'_, W> {}

impl<W: Types> fmt::Debug for World<'_, W> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("World").finish_non_exhaustive()
    }
}

impl<
    's,
    C: Spectrum,
    M: Medium,
    P: PhaseFunction,
    G: Geometry<C>,
    R: SamplingExtinction,
    T: RayTransmittance<M>,
> World<'s, MadeOf<C, M, P, G, R, T>>
{
    /// The world of a volume, surfaces and lights; its sampling extinction and transmittance are of the types of what is used in it.
    pub fn new(volume: &'s Volume<M, P, C>, surfaces: &'s G, lights: &'s Lights<C>) -> Self {
        Self { volume, surfaces, lights }
    }
}

/// End of a particle's flight along a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event<C> {
    /// The particle was scattered in the medium.
    Scattered {
        /// The vertex at which it was scattered.
        vertex: Vertex,
        /// Energy behind the collision, relative to that at the start; the expected energy per length is σ_s T.
        energy: C,
    },
    /// The particle met the end of the segment.
    Passed {
        /// Energy relative to that at the start; on average the transmittance T.
        weight: f64,
    },
    /// The particle was absorbed, or lost at roulette.
    Absorbed,
    /// The particle met as many collisions as it was allowed: a bias.
    Truncated,
}

/// Continuation of a ray behind a smooth surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Direction of travel, of unit length.
    pub direction: DVec3,
    /// Radiance in front of the surface for radiance behind it; 1 for power, and for mirrors.
    pub radiance_scale: f64,
}

impl<W: Types> World<'_, W> {
    /// A ball that holds medium and surfaces: its center and its radius \[length\]; a point where there is nothing.
    pub fn enclosing_ball(&self) -> (DVec3, f64) {
        let surfaces = self.surfaces.surfaces();
        if surfaces.is_empty() {
            return self.volume.bounds.enclosing_ball();
        }
        let medium = (!W::Medium::IS_EMPTY).then(|| self.volume.bounds.corners());
        let corners = surfaces.iter().map(|surface| surface.shape.corners()).chain(medium);
        let (min, max) = corners
            .reduce(|(min, max), (low, high)| (min.min(low), max.max(high)))
            .expect("there is at least one surface");
        (0.5 * (min + max), 0.5 * (max - min).length())
    }

    /// The collisions of a walk in this medium, to be handed to [`follow`](Self::follow).
    pub fn collisions(&self, walk: &Walk<W::Sampling>) -> (SingleParticle, W::Spectrum) {
        walk.collisions(self.volume)
    }

    /// Follows a particle of energy 1 along a segment, whose end is the nearest surface or whatever else one is interested in.
    // One copy per scene type: inlined into every integrator it is minutes of compilation, and a call costs next to nothing.
    #[inline(never)]
    pub fn follow(
        &self,
        walk: &Walk<W::Sampling>,
        (model, ratio): &(SingleParticle, W::Spectrum),
        segment: &Segment,
        source: &mut impl UniformSource,
    ) -> Event<W::Spectrum> {
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
    #[inline(never)]
    pub fn transmittance(
        &self,
        segment: &Segment,
        shadow: &mut W::Shadow,
        source: &mut impl UniformSource,
    ) -> f64 {
        let length = segment.length.is_finite().then_some(segment.length);
        match self.volume.enter(&segment.line, length) {
            Some(ray) => shadow.estimate(&ray, source),
            None => 1.0,
        }
    }

    /// V of raab-2008 eq. 9: 0 if a surface is between the ends, else an unbiased estimate of the transmittance \[1\].
    #[inline]
    pub fn attenuated_visibility(
        &self,
        segment: &Segment,
        shadow: &mut W::Shadow,
        source: &mut impl UniformSource,
    ) -> f64 {
        if self.surfaces.is_occluded(segment) { 0.0 } else { self.transmittance(segment, shadow, source) }
    }

    /// The vertex where a ray meets a diffuse surface, and the reflectance; `None` on a smooth one.
    #[inline]
    pub fn diffuse_vertex(&self, hit: &Hit<'_, W::Spectrum>) -> Option<(Vertex, W::Spectrum)> {
        let Material::Diffuse { reflectance } = hit.surface.material else { return None };
        let lobe = Lobe::Diffuse { normal: hit.normal, surface: hit.index };
        Some((Vertex { position: hit.position, lobe }, reflectance))
    }

    /// True if a segment meets the medium.
    #[inline]
    pub fn meets_medium(&self, segment: &Segment) -> bool {
        let length = segment.length.is_finite().then_some(segment.length);
        self.volume.enter(&segment.line, length).is_some()
    }

    /// Draws the continuation of a ray behind a smooth surface; `None` for a diffuse one. Reflection and refraction are chosen in
    /// proportion to Fresnel's equations, so that either weighs 1.
    ///
    /// Radiance is compressed by refraction: L/n² is what stays the same along a ray.
    #[inline]
    pub fn pass(
        &self,
        hit: &Hit<'_, W::Spectrum>,
        direction: DVec3,
        source: &mut impl UniformSource,
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

#[cfg(test)]
mod tests {
    use super::super::fixtures::{ALBEDO, Scene, ball, diffuse, hazy, ray, square, vacuum};
    use super::*;
    use crate::Uniform;
    use fairflight_collision::Version;
    use fairflight_media::EmptySpace;
    use fairflight_scene::NoSurfaces;
    use fairflight_sources::Scripted;
    use fairflight_transmittance::Regular;
    use glam::dvec3;

    fn walk(sigma_samp: f64) -> Walk<Uniform> {
        Walk::new(Version::Terminating, Uniform::new(sigma_samp).unwrap())
    }

    fn none() -> Scripted {
        Scripted::new([])
    }

    #[test]
    fn the_ball_holds_surfaces_and_the_medium_if_there_is_one() {
        let floor = || vec![square(1.0, 3.0, diffuse(0.5), 0.0)];
        let (center, radius) = vacuum(floor(), vec![]).world().enclosing_ball();
        assert_eq!((center, radius), (DVec3::Z, 18f64.sqrt()));
        let (center, radius) = hazy(1.0, floor(), vec![]).world().enclosing_ball();
        assert_eq!((center, radius), (DVec3::ZERO, 300f64.sqrt()));
        let alone = hazy(1.0, vec![], vec![]);
        let world = World::<MadeOf<_, _, _, _, Uniform>>::new(&alone.volume, &NoSurfaces, &alone.lights);
        assert_eq!(world.enclosing_ball(), alone.volume.bounds.enclosing_ball());
    }

    #[test]
    fn a_flight_scatters_ends_or_passes_as_the_variates_say() {
        let scene = hazy(0.5, vec![], vec![]);
        let (world, walk) = (scene.world(), walk(0.5));
        let collisions = world.collisions(&walk);
        let segment = Segment { length: 3.0, ..ray(DVec3::ZERO, dvec3(0.0, 0.6, 0.8)) };
        let follow = |script: &[f64]| {
            let mut source = Scripted::new(script.iter().copied());
            let event = world.follow(&walk, &collisions, &segment, &mut source);
            assert_eq!(source.remaining(), 0);
            event
        };
        // −ln(1 − u)/σ = 2 ln 2 for u = 1/2, and 4 ln 2 < 3 < 6 ln 2 for the next; the albedo decides what happens there.
        let Event::Scattered { vertex, energy } = follow(&[0.75, 0.49]) else { panic!() };
        let expected = segment.line.at(4.0 * std::f64::consts::LN_2);
        assert!((vertex.position - expected).length() < 1e-15);
        assert_eq!(vertex.lobe, Lobe::Phase { incident: segment.line.direction });
        assert_eq!(energy, 1.0);
        assert_eq!(follow(&[0.75, ALBEDO]), Event::Absorbed);
        assert_eq!(follow(&[0.875]), Event::Passed { weight: 1.0 });
        let short = walk.with_max_collisions(0);
        let cut = world.follow(&short, &collisions, &segment, &mut Scripted::new([0.75]));
        assert_eq!(cut, Event::Truncated);
    }

    #[test]
    fn nothing_is_drawn_where_there_is_no_medium() {
        let (scene, walk) = (vacuum(vec![], vec![]), walk(0.5));
        let world = scene.world();
        let collisions = world.collisions(&walk);
        let segment = ray(DVec3::ZERO, DVec3::Z);
        assert_eq!(world.follow(&walk, &collisions, &segment, &mut none()), Event::Passed { weight: 1.0 });
        assert_eq!(world.transmittance(&segment, &mut Regular, &mut none()), 1.0);
        assert!(!world.meets_medium(&segment));
        // Beside the bounds of a medium it is the same.
        let scene = hazy(0.5, vec![], vec![]);
        let beside = ray(dvec3(11.0, 0.0, 0.0), DVec3::Z);
        let world = scene.world();
        let collisions = world.collisions(&walk);
        assert_eq!(world.follow(&walk, &collisions, &beside, &mut none()), Event::Passed { weight: 1.0 });
        assert!(!world.meets_medium(&beside) && world.meets_medium(&segment));
    }

    #[test]
    fn visibility_is_the_transmittance_or_nothing() {
        let scene = hazy(0.5, vec![ball(DVec3::ZERO, 1.0, diffuse(0.5), 0.0)], vec![]);
        let world = scene.world();
        let beside = Segment { length: 4.0, ..ray(dvec3(1.5, 0.0, -2.0), DVec3::Z) };
        let through = Segment { length: 4.0, ..ray(dvec3(0.5, 0.0, -2.0), DVec3::Z) };
        let t = (-2.0f64).exp();
        for (segment, visibility) in [(beside, t), (through, 0.0)] {
            let found = world.attenuated_visibility(&segment, &mut Regular, &mut none());
            assert!((found - visibility).abs() < 1e-16);
            assert!((world.transmittance(&segment, &mut Regular, &mut none()) - t).abs() < 1e-16);
        }
        // Out of the bounds and on: 12 of 20 are hazy, where the last 8 are not.
        let out = ray(dvec3(1.5, 0.0, -2.0), DVec3::Z);
        let found = world.attenuated_visibility(&out, &mut Regular, &mut none());
        assert!((found - (-6.0f64).exp()).abs() < 1e-17);
    }

    /// Continuation of a ray where it meets a square in the plane z = 0.
    fn pass(material: Material<f64>, origin: DVec3, direction: DVec3, u: &[f64]) -> Option<Passage> {
        let scene: Scene<EmptySpace> = vacuum(vec![square(0.0, 9.0, material, 0.0)], vec![]);
        let segment = ray(origin, direction);
        let hit = scene.surfaces.intersect(&segment).unwrap();
        let mut source = Scripted::new(u.iter().copied());
        let passage = scene.world().pass(&hit, segment.line.direction, &mut source);
        assert_eq!(source.remaining(), 0);
        passage
    }

    #[test]
    fn smooth_surfaces_reflect_and_refract() {
        let slanted = dvec3(0.6, 0.0, -0.8);
        assert_eq!(pass(diffuse(0.5), DVec3::Z, slanted, &[]), None);
        let mirrored = pass(Material::Mirror, DVec3::Z, slanted, &[]).unwrap();
        assert!((mirrored.direction - dvec3(0.6, 0.0, 0.8)).length() < 1e-15);
        assert_eq!(mirrored.radiance_scale, 1.0);

        let glass = Material::Dielectric { ior: 1.5 };
        let reflected = fresnel_reflectance(0.8, 1.5);
        let Passage { direction, radiance_scale } =
            pass(glass, DVec3::Z, slanted, &[reflected - 1e-9]).unwrap();
        assert!((direction - dvec3(0.6, 0.0, 0.8)).length() < 1e-15 && radiance_scale == 1.0);
        // Into the glass Snell gives the sine 0.4, and radiance behind the surface is n² times as dense.
        let inwards = pass(glass, DVec3::Z, slanted, &[reflected]).unwrap();
        assert!((inwards.direction - dvec3(0.4, 0.0, -(0.84f64.sqrt()))).length() < 1e-15);
        assert!((inwards.radiance_scale - 1.0 / 2.25).abs() < 1e-16);
        // And back the way it came: both factors cancel.
        let back = pass(glass, DVec3::NEG_Z, -inwards.direction, &[0.999]).unwrap();
        assert!((back.direction + slanted).length() < 1e-14);
        assert!((back.radiance_scale * inwards.radiance_scale - 1.0).abs() < 1e-15);
        // Beyond the critical angle nothing is refracted, whatever is drawn.
        let total = pass(glass, DVec3::NEG_Z, dvec3(0.8, 0.0, 0.6), &[0.999_999]).unwrap();
        assert!((total.direction - dvec3(0.8, 0.0, -0.6)).length() < 1e-15 && total.radiance_scale == 1.0);
    }

    #[test]
    fn a_diffuse_vertex_faces_where_the_path_came_from() {
        let glass = Material::Dielectric { ior: 1.5 };
        let scene = vacuum(vec![square(0.0, 9.0, diffuse(0.25), 0.0), square(-5.0, 9.0, glass, 0.0)], vec![]);
        let hit_from = |z: f64| {
            let segment = ray(dvec3(0.0, 0.0, z), DVec3::NEG_Z * z.signum());
            scene.world().diffuse_vertex(&scene.surfaces.intersect(&segment).unwrap())
        };
        for (z, normal) in [(2.0, DVec3::Z), (-2.0, DVec3::NEG_Z)] {
            let (vertex, reflectance) = hit_from(z).unwrap();
            assert_eq!(vertex.lobe, Lobe::Diffuse { normal, surface: 0 });
            assert_eq!((vertex.position, reflectance), (DVec3::ZERO, 0.25));
        }
        assert_eq!(hit_from(-9.0), None);
    }
}
