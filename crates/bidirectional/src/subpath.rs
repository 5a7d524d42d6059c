//! Subpaths from the camera and from the lights: one loop for both.

use crate::{LightEnd, Node, Weigh, WeightThickness};
use fairflight_media::Line;
use fairflight_paths::Walk;
use fairflight_paths::transport::{Event, Start, Types};
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// A node with what the walk carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<C> {
    /// The vertex and its densities.
    pub node: Node,
    /// What arrives: throughput from the camera, or power from a light.
    pub arriving: C,
    /// What is scattered: that times reflectance, or the energy behind the collision; 0 on a smooth surface, where nothing is connected.
    pub scattered: C,
}

/// The vertices of a subpath behind its first one, which is the pinhole or on a light.
///
/// **Law.** E\[Σ arriving · φ(v_1 … v_t)\] = ∫ f φ over paths, f = the product of all that light meets up to the arrival at v_t, for every bounded φ and every t,
/// whatever the sampling extinction of the walk and the sign of its energies: the law of [`World::follow`](fairflight_paths::transport::World::follow), step by step.
#[derive(Clone, Debug)]
pub struct Subpath<C> {
    /// v_2, v_3, ….
    pub steps: Vec<Step<C>>,
    /// The direction in which the walk left the scene, and what it carried.
    pub escape: Option<(DVec3, C)>,
    /// The start on a light; none for an eye subpath, or where nothing shines.
    pub start: Option<Start<C>>,
    /// The power of a light without extent that went straight into a smooth surface and was not followed: no other integrator sees it.
    pub unseen: Option<C>,
    /// Whether the walk was cut: a bias.
    pub is_cut: bool,
}

impl<C> Subpath<C> {
    /// No vertices: a buffer to be filled, and filled again.
    #[must_use]
    pub fn empty() -> Self {
        Self { steps: Vec::new(), escape: None, start: None, unseen: None, is_cut: false }
    }

    fn clear(&mut self) {
        self.steps.clear();
        (self.escape, self.start, self.unseen, self.is_cut) = (None, None, None, false);
    }
}

impl<C> Default for Subpath<C> {
    fn default() -> Self {
        Self::empty()
    }
}

/// How walks of subpaths go.
#[derive(Clone, Copy, Debug)]
pub struct Walking<R> {
    /// Flights through the medium.
    pub walk: Walk<R>,
    /// Vertices of a subpath behind its first one; longer ones are cut, a bias.
    pub max_vertices: u32,
    /// Whether light of a point or a direction is followed straight into smooth surfaces: the path tracer does not see it, since no direction meets the light by chance
    /// and no connection passes the surface.
    pub point_caustics: bool,
}

impl<R> Walking<R> {
    /// Subpaths of any length, and the paths that a path tracer finds.
    pub fn new(walk: Walk<R>) -> Self {
        Self { walk, max_vertices: u32::MAX, point_caustics: false }
    }
}

impl<W: Types, K: WeightThickness<W::Medium>> Weigh<'_, W, K> {
    /// Fills `subpath` with a walk along a ray from the camera.
    pub fn walk_from_eye(
        &self,
        walking: &Walking<W::Sampling>,
        line: &Line,
        subpath: &mut Subpath<W::Spectrum>,
        source: &mut impl UniformSource,
    ) {
        subpath.clear();
        let segment = Segment { line: *line, length: f64::INFINITY, from: None, to: None };
        self.extend(walking, subpath, None, segment, W::Spectrum::splat(1.0), source);
    }

    /// Fills `subpath` with a walk from a light, which carries all power.
    pub fn walk_from_light(
        &self,
        walking: &Walking<W::Sampling>,
        subpath: &mut Subpath<W::Spectrum>,
        source: &mut impl UniformSource,
    ) {
        subpath.clear();
        let world = &self.world;
        let Some(start) = self.emitters.sample(world.lights, world.surfaces, source) else { return };
        subpath.start = Some(start);
        let end = self.end_of(&start);
        self.extend(walking, subpath, Some(&end), start.segment, start.power, source);
    }

    /// The light end of a light subpath.
    pub fn end_of(&self, start: &Start<W::Spectrum>) -> LightEnd<'_> {
        let Line { origin, direction } = start.segment.line;
        let at = if start.segment.from.is_some() { origin } else { -direction };
        LightEnd::new(&self.world, self.emitters, start.light, at)
    }

    /// The loop of both: as that of a path tracer, but for what smooth surfaces do to radiance from the camera and not to power from a light.
    #[inline(never)]
    fn extend(
        &self,
        walking: &Walking<W::Sampling>,
        subpath: &mut Subpath<W::Spectrum>,
        light: Option<&LightEnd<'_>>,
        mut segment: Segment,
        mut throughput: W::Spectrum,
        source: &mut impl UniformSource,
    ) {
        let world = &self.world;
        let walk = &walking.walk;
        let collisions = world.collisions(walk);
        let first = match light {
            Some(end) => end.position(),
            None => Some(self.camera.origin()),
        };
        for _ in 0..walking.max_vertices {
            let hit = world.surfaces.intersect(&segment);
            segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
            let incident = segment.line.direction;
            let mut passage = None;
            let (place, scattering) = match world.follow(walk, &collisions, &segment, source) {
                Event::Scattered { vertex, energy } => {
                    (self.place_in_medium(vertex.position), Some((vertex, energy)))
                }
                Event::Passed { weight } => {
                    throughput = throughput * weight;
                    let Some(hit) = hit else {
                        subpath.escape = Some((incident, throughput));
                        return;
                    };
                    passage = world.pass(&hit, incident, source);
                    let ratio = passage.map_or(1.0, |passage| 1.0 / passage.radiance_scale.sqrt());
                    (self.place_on(&hit, ratio), world.diffuse_vertex(&hit))
                }
                Event::Absorbed => return,
                Event::Truncated => {
                    subpath.is_cut = true;
                    return;
                }
            };
            let is_first = subpath.steps.is_empty();
            if let Some(end) = light
                && passage.is_some()
                && is_first
                && !end.light().has_extent()
                && !walking.point_caustics
            {
                subpath.unseen = Some(throughput);
                return;
            }
            // A step of no length has no direction: where rounding makes one, the walk ends.
            let before = subpath.steps.last().map(|step| step.node.place.position).or(first);
            if before == Some(place.position) {
                return;
            }
            let node = match (subpath.steps.last(), light) {
                (Some(step), _) => self.next(&step.node, place),
                (None, Some(end)) => self.first_of_light(end, place),
                (None, None) => self.first_of_eye(place),
            };
            let scattered =
                scattering.map_or(W::Spectrum::ZERO, |(_, factor): (_, W::Spectrum)| throughput * factor);
            subpath.steps.push(Step { node, arriving: throughput, scattered });
            if let Some(passage) = passage {
                if light.is_none() {
                    throughput = throughput * passage.radiance_scale;
                }
                let line = Line { origin: place.position, direction: passage.direction };
                segment = Segment { line, length: f64::INFINITY, from: place.surface(), to: None };
                continue;
            }
            let (vertex, factor) = scattering.expect("what is not smooth scatters");
            let survival = factor.magnitude().min(1.0);
            if source.next_uniform() >= survival {
                return;
            }
            throughput = scattered * (1.0 / survival);
            let direction =
                vertex.sample(&world.volume.phase, source.next_uniform(), source.next_uniform());
            segment = vertex.leave(direction, f64::INFINITY);
        }
        subpath.is_cut = true;
    }
}
