//! Subpaths from the camera and from the lights: one walk for both.

use crate::{LightEnd, Node, Weigh, WeightThickness};
use fairflight_media::Line;
use fairflight_paths::transport::{Carried, Met, Start, Types, WalkEnd};
use fairflight_paths::{Roulette, Walk};
use fairflight_scene::{Segment, Spectrum};
use fairflight_sources::{PathEnd, Row, UniformSource};
use glam::DVec3;
use std::ops::ControlFlow;

/// A node with what the walk carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<C> {
    /// The vertex and its densities.
    pub node: Node,
    /// Energy that arrives: throughput from the camera, or power from a light.
    pub arriving: C,
    /// Energy that is scattered: that times reflectance, or the energy behind the collision; 0 on a smooth surface, where nothing is connected.
    pub scattered: C,
}

/// The vertices of a subpath behind its first one, which is the pinhole or on a light.
///
/// **Law.** E\[Σ arriving · φ(v_1 … v_t)\] = ∫ f φ over paths, f = the product of all that light meets up to the arrival at v_t,
/// for every bounded φ and every t, whatever the sampling extinction of the walk and the sign of its energies: the law of
/// [`World::follow`](fairflight_paths::transport::World::follow), step by step.
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
    /// True if the walk was cut: a bias.
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

/// Rules of the walks of subpaths.
#[derive(Clone, Copy, Debug)]
pub struct Walking<R> {
    /// Flights through the medium.
    pub walk: Walk<R>,
    /// Vertices of a subpath behind its first one; longer ones are cut, a bias.
    pub max_vertices: u32,
    /// True if light of a point or a direction is followed straight into smooth surfaces: the path tracer does not see it, since no
    /// direction meets the light by chance and no connection passes the surface.
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
        self.exactly_from_eye(u32::MAX, walking, line, subpath, source);
    }

    /// The same, ending at vertex `last` behind the pinhole.
    pub(crate) fn exactly_from_eye(
        &self,
        last: u32,
        walking: &Walking<W::Sampling>,
        line: &Line,
        subpath: &mut Subpath<W::Spectrum>,
        source: &mut impl UniformSource,
    ) {
        subpath.clear();
        let segment = Segment { line: *line, length: f64::INFINITY, from: None, to: None };
        self.extend((walking, last), subpath, None, (segment, W::Spectrum::splat(1.0)), source);
    }

    /// Fills `subpath` with a walk from a light, which carries all power.
    pub fn walk_from_light(
        &self,
        walking: &Walking<W::Sampling>,
        subpath: &mut Subpath<W::Spectrum>,
        source: &mut impl UniformSource,
    ) {
        self.exactly_from_light(u32::MAX, walking, subpath, source);
    }

    /// The same, ending at vertex `last` behind the light.
    pub(crate) fn exactly_from_light(
        &self,
        last: u32,
        walking: &Walking<W::Sampling>,
        subpath: &mut Subpath<W::Spectrum>,
        source: &mut impl UniformSource,
    ) {
        subpath.clear();
        let world = &self.world;
        source.row(Row::direction(PathEnd::Light, 0));
        let Some(start) = self.emitters.sample(world.lights, world.surfaces, source) else { return };
        subpath.start = Some(start);
        let end = self.end_of(&start);
        self.extend((walking, last), subpath, Some(&end), (start.segment, start.power), source);
    }

    /// The light end of a light subpath.
    pub fn end_of(&self, start: &Start<W::Spectrum>) -> LightEnd<'_> {
        let Line { origin, direction } = start.segment.line;
        let at = if start.segment.from.is_some() { origin } else { -direction };
        LightEnd::new(&self.world, self.emitters, start.light, at)
    }

    /// The walk of both.
    #[inline(never)]
    fn extend(
        &self,
        (walking, last): (&Walking<W::Sampling>, u32),
        subpath: &mut Subpath<W::Spectrum>,
        light: Option<&LightEnd<'_>>,
        start: (Segment, W::Spectrum),
        source: &mut impl UniformSource,
    ) {
        let (kind, first) = match light {
            Some(end) => (Carried::Power, end.position()),
            None => (Carried::Radiance, Some(self.camera.origin())),
        };
        let is_followed = |steps: &[Step<W::Spectrum>]| {
            walking.point_caustics || !steps.is_empty() || light.is_none_or(|end| end.light().has_extent())
        };
        let limits = (&walking.walk, walking.max_vertices);
        let end = self.world.random_walk(limits, start, kind, source, |met, _, arriving, _| {
            let (mut place, scattered) = match met {
                Met::Smooth { hit, passage } => {
                    if !is_followed(&subpath.steps) {
                        subpath.unseen = Some(arriving);
                        return ControlFlow::Break(());
                    }
                    // Radiance is scaled by 1/ratio².
                    (self.place_on(&hit, 1.0 / passage.radiance_scale.sqrt()), W::Spectrum::ZERO)
                }
                Met::Vertex { factor, hit: Some(hit), .. } => (self.place_on(&hit, 1.0), arriving * factor),
                Met::Vertex { vertex, factor, hit: None } => {
                    (self.place_in_medium(vertex.position), arriving * factor)
                }
            };
            if walking.walk.roulette() == Roulette::Never {
                place.survival = 1.0;
            }
            let previous = subpath.steps.last().map(|step| &step.node);
            // A step of no length has no direction: where rounding makes one, a set of measure zero, the walk ends.
            if previous.map(|node| node.place.position).or(first) == Some(place.position) {
                return ControlFlow::Break(());
            }
            let node = match (previous, light) {
                (Some(previous), _) => self.next(previous, place),
                (None, Some(end)) => self.first_of_light(end, place),
                (None, None) => self.first_of_eye(place),
            };
            subpath.steps.push(Step { node, arriving, scattered });
            if subpath.steps.len() as u32 == last {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        match end {
            WalkEnd::Escaped(direction, carried) => subpath.escape = Some((direction, carried)),
            WalkEnd::Ended => {}
            WalkEnd::Cut => subpath.is_cut = true,
        }
    }
}
