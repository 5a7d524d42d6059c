//! Strategies: all ways to join an eye subpath and a light subpath.

use crate::{LightEnd, Node, Step, Subpath, Walking, Weigh, WeightThickness};
use fairflight_media::Line;
use fairflight_paths::transport::{EmitterSample, Light, Types};
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::{PathEnd, Row, UniformSource};
use glam::DVec3;
use std::fmt;

mod alone;
mod found;

pub use found::{Found, Strategy};

/// Bidirectional path tracing among surfaces and in media (lafortune-1996, antwerpen-2011 chapters 4 and 5).
///
/// ```text
/// one light subpath for the image, one eye subpath for the pixel
/// for each eye vertex y_t on an emitter, or outside               s = 0        met by chance
///     for each light                                              s = 1        a point of it drawn anew
///     for each light vertex z_s                                   s ≥ 2        connected
/// for each light vertex z_s                                       t = 1        connected with the pinhole, for whatever pixel sees it
/// each times its weight
/// ```
///
/// **Law.** The mean of [`radiance`](Self::radiance) over rays through a pixel, plus the sum of what
/// [`light_image`](Self::light_image) adds to that pixel by n_L light paths, has the expectation of
/// [`PathTracer`](fairflight_paths::PathTracer): the three point form (raab-2008 eq. 5) with all its orders. With
/// [`point_caustics`](Walking::point_caustics) light that a point or a direction sends straight into smooth surfaces comes on top
/// of that.
///
/// A light seen directly is found by s = 0 alone. Light of a point or a direction in a chain of smooth surfaces that ends at the
/// camera is found by nothing.
///
/// **Assumes** that the sampling extinction is positive where the extinction is, and nothing else of walks: densities stand in
/// weights only.
///
/// **Variance.** One connection in the medium has no second moment, 1/r². Weighted it has: by the balance heuristic w f/p = f/Σ
/// p_j, and p_j has all factors 1/r² of f but that of its own edge, so that a contribution is at most a constant/Σ r_j² over the
/// edges that may be connected; these are as long as the path together. That holds for point lights, too, of which a path tracer
/// has no second moment. Densities must have 1/r² and the extinction for that.
///
/// ```
/// use fairflight_bidirectional::{Bidirectional, Exact, Subpath, Walking, Weigh};
/// use fairflight_collision::Version;
/// use fairflight_media::{Bounds, EmptySpace, phase::Isotropic};
/// use fairflight_paths::transport::{Emitters, World};
/// use fairflight_paths::{Heuristic, Uniform, Walk};
/// use fairflight_scene::surface::Sphere;
/// use fairflight_scene::{Background, Camera, Lights, Material, Shape, Surface, Surfaces, Volume};
/// use fairflight_sources::{Seeded, UniformSource};
/// use fairflight_transmittance::Regular;
/// use glam::DVec3;
///
/// // A hollow ball that glows 1/2 and reflects 1/2: the radiance in it is 1/2 + 1/4 + … = 1.
/// let ball = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap());
/// let surfaces = Surfaces::new(vec![Surface::new(ball, Material::Diffuse { reflectance: 0.5 }, 0.5).unwrap()]);
/// let lights = Lights { background: Background::dark(), sources: vec![] };
/// let bounds = Bounds::sphere(DVec3::ZERO, 1.0).unwrap();
/// let volume = Volume { medium: EmptySpace, bounds, albedo: 0.0, phase: Isotropic };
/// let world = World::new(&volume, &surfaces, &lights);
/// let camera = Camera::new(DVec3::ZERO, DVec3::Z, DVec3::Y, 90.0, [1, 1]).unwrap();
/// let emitters = Emitters::new(&lights, &surfaces, world.enclosing_ball(), camera.origin());
///
/// let heuristic = Heuristic::Balance;
/// let weigh = Weigh { world, camera: &camera, emitters: &emitters, thickness: Exact, heuristic, light_paths: 1.0 };
/// let walking = Walking::new(Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap()));
/// let mut integrator = Bidirectional::new(weigh, walking, Regular);
/// let (mut light, mut source, mut sum) = (Subpath::empty(), Seeded::new(1), 0.0);
/// for _ in 0..10_000 {
///     integrator.trace_light(&mut light, &mut source);
///     let line = camera.ray([0, 0], [source.next_uniform(), source.next_uniform()]);
///     sum += integrator.radiance(&line, &light, &mut source);
///     integrator.light_image(&light, &mut source, |_pixel, value| sum += value);
/// }
/// // A sample has the standard deviation 0.6: five standard errors.
/// assert!((sum / 10_000.0 - 1.0).abs() < 0.03);
/// ```
pub struct Bidirectional<'s, W: Types, K> {
    weigh: Weigh<'s, W, K>,
    walking: Walking<W::Sampling>,
    shadow: W::Shadow,
    connection_roulette: Option<f64>,
    eye: Subpath<W::Spectrum>,
    truncated: u64,
}

impl<W: Types, K> fmt::Debug for Bidirectional<'_, W, K> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { weigh, connection_roulette, truncated, .. } = self;
        formatter
            .debug_struct("Bidirectional")
            .field("weigh", weigh)
            .field("connection_roulette", connection_roulette)
            .field("truncated", truncated)
            .finish_non_exhaustive()
    }
}

impl<'s, W: Types, K: WeightThickness<W::Medium>> Bidirectional<'s, W, K> {
    /// Subpaths by `walking`, connected through `shadow`, weighted by `weigh`.
    pub fn new(weigh: Weigh<'s, W, K>, walking: Walking<W::Sampling>, shadow: W::Shadow) -> Self {
        Self { weigh, walking, shadow, connection_roulette: None, eye: Subpath::empty(), truncated: 0 }
    }

    /// The same, making a connection whose contribution would be u without anything between with the probability min(1,
    /// |u|/`threshold`) only, and dividing by that.
    ///
    /// No bias for a threshold \[radiance\] above 0 that does not depend on the sample. It saves look-ups for transmittance, at the
    /// price of variance.
    #[must_use]
    pub fn with_connection_roulette(self, threshold: Option<f64>) -> Self {
        Self { connection_roulette: threshold, ..self }
    }

    /// The weights.
    pub fn weigh(&self) -> &Weigh<'s, W, K> {
        &self.weigh
    }

    /// The rules of its walks.
    pub fn walking(&self) -> &Walking<W::Sampling> {
        &self.walking
    }

    /// The eye subpath of the last sample.
    pub fn eye(&self) -> &Subpath<W::Spectrum> {
        &self.eye
    }

    /// The number of subpaths that were cut so far: each is a bias.
    pub fn truncated(&self) -> u64 {
        self.truncated
    }

    /// Fills `light` with a light subpath.
    pub fn trace_light(&mut self, light: &mut Subpath<W::Spectrum>, source: &mut impl UniformSource) {
        self.weigh.walk_from_light(&self.walking, light, source);
        self.truncated += u64::from(light.is_cut);
    }

    /// One estimate of the radiance along a camera ray, by the strategies with t ≥ 2.
    pub fn radiance(
        &mut self,
        line: &Line,
        light: &Subpath<W::Spectrum>,
        source: &mut impl UniformSource,
    ) -> W::Spectrum {
        let mut radiance = W::Spectrum::ZERO;
        self.strategies(line, light, source, |_eye, found| radiance += found.value);
        radiance
    }

    /// The same, one by one, with the eye subpath.
    pub fn strategies(
        &mut self,
        line: &Line,
        light: &Subpath<W::Spectrum>,
        source: &mut impl UniformSource,
        mut each: impl FnMut(&Subpath<W::Spectrum>, Found<W::Spectrum>),
    ) {
        let mut eye = std::mem::take(&mut self.eye);
        self.weigh.walk_from_eye(&self.walking, line, &mut eye, source);
        self.truncated += u64::from(eye.is_cut);
        for (index, step) in eye.steps.iter().enumerate() {
            let t = index as u32 + 2;
            let previous = index.checked_sub(1).map(|before| &eye.steps[before].node);
            self.met(step, previous, |found| {
                each(&eye, Found { strategy: Strategy { light: 0, eye: t }, ..found });
            });
            if step.scattered == W::Spectrum::ZERO {
                continue;
            }
            source.row(Row::connection(PathEnd::Camera, t - 1));
            let strategy = Strategy { light: 1, eye: t };
            self.next_event(step, source, |found| each(&eye, Found { strategy, ..found }));
            for (behind, other) in light.steps.iter().enumerate() {
                if let Some((value, weight)) = self.connect(step, other, source) {
                    let strategy = Strategy { light: behind as u32 + 2, eye: t };
                    each(&eye, Found { strategy, value, weight, end: None });
                }
            }
        }
        if let Some((towards, throughput)) = eye.escape {
            let strategy = Strategy { light: 0, eye: eye.steps.len() as u32 + 2 };
            let previous = eye.steps.last().map(|step| &step.node);
            self.background(previous, (towards, throughput), |found| each(&eye, Found { strategy, ..found }));
        }
        self.eye = eye;
    }

    /// t = 1: what the vertices of a light subpath add to the pixels that see them, as its share of n_L.
    pub fn light_image(
        &mut self,
        light: &Subpath<W::Spectrum>,
        source: &mut impl UniformSource,
        mut splat: impl FnMut([u32; 2], W::Spectrum),
    ) {
        for index in 0..light.steps.len() {
            if let Some((pixel, found)) = self.splat(light, index, source) {
                splat(pixel, found.value);
            }
        }
    }

    /// The same for one vertex, z_s with s = `index` + 2.
    pub fn splat(
        &mut self,
        light: &Subpath<W::Spectrum>,
        index: usize,
        source: &mut impl UniformSource,
    ) -> Option<([u32; 2], Found<W::Spectrum>)> {
        let step = &light.steps[index];
        if step.scattered == W::Spectrum::ZERO {
            return None;
        }
        let vertex = step.node.vertex()?;
        let seen = self.weigh.camera.project(vertex.position)?;
        let scattered = vertex.pdf_solid_angle(&self.weigh.world.volume.phase, seen.towards_camera);
        if scattered == 0.0 {
            return None;
        }
        let bare = step.scattered * (scattered * seen.importance / self.weigh.light_paths);
        let segment = vertex.leave(seen.towards_camera, seen.distance);
        source.row(Row::connection(PathEnd::Light, index as u32 + 1));
        let node = step.node;
        let (value, weight) = self.through(&segment, bare, |weigh| weigh.light_image(&node), source)?;
        let strategy = Strategy { light: index as u32 + 2, eye: 1 };
        Some((seen.pixel, Found { strategy, value, weight, end: None }))
    }

    /// s = 0 on a surface.
    fn met(
        &self,
        step: &Step<W::Spectrum>,
        previous: Option<&Node>,
        mut each: impl FnMut(Found<W::Spectrum>),
    ) {
        let Some(index) = step.node.place.surface() else { return };
        let emission = self.weigh.world.surfaces.surfaces()[index].emission;
        if emission != W::Spectrum::ZERO {
            let end = (Light::Surface(index), step.node.place.position);
            each(self.found(step.arriving * emission, previous, end));
        }
    }

    /// s = 0 outside: each part of the background is a light.
    fn background(
        &self,
        previous: Option<&Node>,
        (towards, throughput): (DVec3, W::Spectrum),
        mut each: impl FnMut(Found<W::Spectrum>),
    ) {
        let background = &self.weigh.world.lights.background;
        if background.constant != W::Spectrum::ZERO {
            each(self.found(throughput * background.constant, previous, (Light::Constant, towards)));
        }
        for (index, map) in background.maps.iter().enumerate() {
            let radiance = map.radiance(towards);
            if radiance != W::Spectrum::ZERO {
                each(self.found(throughput * radiance, previous, (Light::Map(index), towards)));
            }
        }
    }

    /// A light met from `previous`; whole if that is the pinhole.
    fn found(
        &self,
        bare: W::Spectrum,
        previous: Option<&Node>,
        (light, at): (Light, DVec3),
    ) -> Found<W::Spectrum> {
        let Weigh { world, emitters, .. } = &self.weigh;
        let weight = previous
            .map_or(1.0, |node| self.weigh.at_light(node, &LightEnd::new(world, emitters, light, at)).met);
        let strategy = Strategy { light: 0, eye: 0 };
        Found { strategy, value: bare * weight, weight, end: Some((light, at)) }
    }

    /// s = 1: each light in its turn, as [`World::sample_emitters`](fairflight_paths::transport::World::sample_emitters) draws them.
    fn next_event(
        &mut self,
        step: &Step<W::Spectrum>,
        source: &mut impl UniformSource,
        mut each: impl FnMut(Found<W::Spectrum>),
    ) {
        let Some(vertex) = step.node.vertex() else { return };
        let (world, emitters) = (self.weigh.world, self.weigh.emitters);
        world.sample_emitters(&vertex, source, |sampled, source| {
            let EmitterSample { light, segment, arriving, pdf_solid_angle, scattered } = sampled;
            let at = match light {
                Light::Surface(_) => segment.line.at(segment.length),
                Light::Constant | Light::Map(_) | Light::Source(_) => segment.line.direction,
            };
            let bare = step.scattered * arriving * (scattered / pdf_solid_angle.unwrap_or(1.0));
            if bare == W::Spectrum::ZERO {
                return;
            }
            let weight = |weigh: &Weigh<'_, W, K>| {
                weigh.at_light(&step.node, &LightEnd::new(&world, emitters, light, at)).sampled
            };
            if let Some((value, weight)) = self.through(&segment, bare, weight, source) {
                let strategy = Strategy { light: 1, eye: 0 };
                each(Found { strategy, value, weight, end: Some((light, at)) });
            }
        });
    }

    /// s ≥ 2, t ≥ 2: β f_s G V f_s β.
    #[inline(never)]
    fn connect(
        &mut self,
        y: &Step<W::Spectrum>,
        z: &Step<W::Spectrum>,
        source: &mut impl UniformSource,
    ) -> Option<(W::Spectrum, f64)> {
        let (from, to) = (y.node.vertex()?, z.node.vertex()?);
        let offset = to.position - from.position;
        let squared = offset.length_squared();
        // Two vertices at one point: a set of measure zero, in which no direction is defined.
        if squared == 0.0 || z.scattered == W::Spectrum::ZERO {
            return None;
        }
        let length = squared.sqrt();
        let direction = offset / length;
        // raab-2008 eq. 8: a cosine at each end that lies on a surface.
        let geometric = from.cosine(direction) * to.cosine(-direction) / squared;
        if geometric == 0.0 {
            return None;
        }
        // A plane does not light itself; the cosines say so but for rounding.
        let surfaces = self.weigh.world.surfaces.surfaces();
        if let (Some(one), Some(other)) = (from.surface(), to.surface())
            && one == other
            && !surfaces[one].shape.is_closed()
        {
            return None;
        }
        let phase = &self.weigh.world.volume.phase;
        let scattering = from.eval(phase, direction) * to.eval(phase, -direction);
        let bare = y.scattered * z.scattered * (scattering * geometric);
        let segment = Segment { to: to.surface(), ..from.leave(direction, length) };
        let (y, z) = (y.node, z.node);
        self.through(&segment, bare, |weigh| weigh.connection(&y, &z), source)
    }

    /// A contribution through what lies on its last edge, and its weight; `None` if that is 0.
    #[inline]
    fn through(
        &mut self,
        segment: &Segment,
        bare: W::Spectrum,
        weight: impl Fn(&Weigh<'s, W, K>) -> f64,
        source: &mut impl UniformSource,
    ) -> Option<(W::Spectrum, f64)> {
        let Self { weigh, shadow, connection_roulette, .. } = self;
        let mut visible = |source: &mut _| {
            let visibility = weigh.world.attenuated_visibility(segment, shadow, source);
            (visibility != 0.0).then_some(visibility)
        };
        match *connection_roulette {
            None => {
                let visibility = visible(source)?;
                let weight = weight(weigh);
                Some((bare * (weight * visibility), weight))
            }
            Some(threshold) => {
                let weight = weight(weigh);
                let kept = (weight * bare.magnitude() / threshold).min(1.0);
                if source.next_uniform() >= kept {
                    return None;
                }
                let visibility = visible(source)?;
                Some((bare * (weight / kept * visibility), weight))
            }
        }
    }
}
