//! A proposal, made vertex by vertex.

use super::coordinates::{Made, ln_product};
use super::vertex::Continuation;
use super::{PathEdge, PathSite, PathState, PathVertex, PathWorld, Towards};
use fairflight_elementary::{exp, ln, pow, sin_cos};
use fairflight_media::Line;
use fairflight_paths::transport::Light;
use fairflight_scene::{Material, Segment};
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::f64::consts::TAU;
use std::ops::Range;

/// Sizes of steps, each a symmetric move in its coordinates: of any size the ratio is the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepSizes {
    /// Least and greatest distance of a move on the film \[pixels\]; its logarithm is uniform.
    pub film: [f64; 2],
    /// Least and greatest angle by which a direction is turned \[rad\]; likewise.
    pub turn: [f64; 2],
    /// Greatest |ln r'/r| of a distance in the medium, which is uniform.
    pub stretch: f64,
}

impl StepSizes {
    /// From a tenth of a pixel to a tenth of the image's size on the film; turns of 0.001 to 0.3, and distances up to e^±0.5.
    #[must_use]
    pub fn of_image(resolution: [u32; 2]) -> Self {
        let [columns, rows] = resolution.map(f64::from);
        let greatest = 0.1 * (columns * rows).sqrt();
        Self { film: [0.1f64.min(0.1 * greatest), greatest], turn: [1e-3, 0.3], stretch: 0.5 }
    }

    fn size([least, greatest]: [f64; 2], u: f64) -> f64 {
        greatest * pow(least / greatest, u)
    }

    /// A point of the film near `film`, in any direction from it.
    pub(super) fn moved(&self, film: [f64; 2], source: &mut dyn UniformSource) -> [f64; 2] {
        let radius = Self::size(self.film, source.next_uniform());
        let (sine, cosine) = sin_cos(TAU * source.next_uniform());
        [film[0] + radius * cosine, film[1] + radius * sine]
    }

    /// A direction near `direction`, in any plane through it.
    pub(super) fn turned(&self, direction: DVec3, source: &mut dyn UniformSource) -> DVec3 {
        let (off, along) = sin_cos(Self::size(self.turn, source.next_uniform()));
        let (x, y) = direction.any_orthonormal_pair();
        let (sine, cosine) = sin_cos(TAU * source.next_uniform());
        (along * direction + off * (cosine * x + sine * y)).normalize()
    }
}

/// A proposal `y` in the making, which is `x` where it was not changed.
pub(super) struct Proposal<'p> {
    pub(super) world: &'p dyn PathWorld,
    pub(super) x: &'p PathState,
    pub(super) y: &'p mut PathState,
    pub(super) source: &'p mut dyn UniformSource,
    /// The greatest |ln r'/r| of a distance in the medium; none where it is kept.
    pub(super) stretch: Option<f64>,
}

impl<'p> Proposal<'p> {
    /// A copy of `x`.
    pub(super) fn new(
        world: &'p dyn PathWorld,
        (x, y): (&'p PathState, &'p mut PathState),
        stretch: Option<f64>,
        source: &'p mut dyn UniformSource,
    ) -> Self {
        y.clone_from(x);
        Self { world, x, y, source, stretch }
    }

    /// Finds the vertex next to `at` along `direction`, of the kind that it has in `x`: the first surface, or a point of the medium by the rule of
    /// distances. Returns the direction behind it where it is smooth; `None` where there is no such vertex.
    pub(super) fn extend(&mut self, at: usize, towards: Towards, direction: DVec3) -> Option<Option<DVec3>> {
        let (next, edge) = match towards {
            Towards::Light => (at + 1, at),
            Towards::Eye => (at - 1, at - 1),
        };
        let start = &self.y.vertices[at];
        let line = Line { origin: start.position, direction };
        let mut segment = Segment { line, length: f64::INFINITY, from: start.surface(), to: None };
        let mut onwards = None;
        let (position, site, colour) = match self.x.vertices[next].site {
            PathSite::Medium { .. } => {
                let scale =
                    self.stretch.map_or(1.0, |most| exp(most * (2.0 * self.source.next_uniform() - 1.0)));
                segment.length = self.x.edges[edge].length * scale;
                if self.world.is_occluded(&segment) {
                    return None;
                }
                let position = line.at(segment.length);
                let sigma_t = self.world.sigma_t(position);
                if sigma_t == 0.0 {
                    return None;
                }
                (position, PathSite::Medium { sigma_t }, self.world.albedo())
            }
            PathSite::Diffuse { .. } => {
                let met = self.world.intersect(&segment)?;
                let Material::Diffuse { reflectance } = self.world.surface(met.surface).0 else {
                    return None;
                };
                segment.length = met.distance;
                (met.position, PathSite::Diffuse { normal: met.normal, surface: met.surface }, reflectance)
            }
            PathSite::Smooth { reflects, .. } => {
                let met = self.world.intersect(&segment)?;
                segment.length = met.distance;
                let Continuation { site, direction } =
                    Continuation::at(self.world, &met, direction, reflects, towards)?;
                onwards = Some(direction);
                (met.position, site, DVec3::ONE)
            }
            PathSite::Lamp { .. } => {
                let met = self.world.intersect(&segment)?;
                segment.length = met.distance;
                let site = PathSite::Lamp { normal: met.normal, surface: met.surface };
                (met.position, site, self.world.strength(Light::Surface(met.surface), met.position))
            }
            PathSite::Far(light) if !matches!(light, Light::Source(_)) => {
                if self.world.intersect(&segment).is_some() {
                    return None;
                }
                (direction, PathSite::Far(light), self.world.strength(light, direction))
            }
            PathSite::Pinhole | PathSite::Point(_) | PathSite::Far(_) => return None,
        };
        self.y.vertices[next] = PathVertex { position, site, colour };
        let forward = if towards == Towards::Light { direction } else { -direction };
        self.set_edge(edge, forward, &segment);
        Some(onwards)
    }

    /// The same through smooth vertices up to the first that is not. Returns its index.
    pub(super) fn extend_on(
        &mut self,
        mut at: usize,
        towards: Towards,
        mut direction: DVec3,
    ) -> Option<usize> {
        loop {
            let onwards = self.extend(at, towards, direction)?;
            at = if towards == Towards::Light { at + 1 } else { at - 1 };
            match onwards {
                Some(onwards) => direction = onwards,
                None => return Some(at),
            }
        }
    }

    /// Connects the ends of an edge as they are; `None` where one does not see the other, or the image does not show x_1.
    pub(super) fn connect(&mut self, edge: usize) -> Option<()> {
        let segment = self.y.segment(edge);
        // Two vertices at one point, a set of measure zero, or a plane that would see itself but for rounding.
        if segment.length == 0.0 {
            return None;
        }
        if let (Some(one), Some(other)) = (segment.from, segment.to)
            && one == other
            && !self.world.outer_side(one, segment.line.origin).1
        {
            return None;
        }
        if edge == 0 {
            self.y.film = self.world.camera().film(self.y.vertices[1].position)?;
        }
        if self.world.is_occluded(&segment) {
            return None;
        }
        self.set_edge(edge, segment.line.direction, &segment);
        Some(())
    }

    fn set_edge(&mut self, edge: usize, direction: DVec3, segment: &Segment) {
        let ln_transmittance = self.world.ln_transmittance(segment, self.source);
        self.y.edges[edge] = PathEdge { direction, length: segment.length, ln_transmittance };
    }

    /// ln of f J of the proposal over f J, of which all factors outside of `edges` and their ends cancel.
    pub(super) fn ln_ratio(&self, edges: Range<usize>, made: impl Fn(usize) -> Made) -> Option<f64> {
        let is_scaled = self.stretch.is_some();
        let of = |path: &PathState| ln_product(self.world, path, edges.clone(), &made, is_scaled);
        let colours = [&*self.y, self.x].map(|path| path.colour().max_element());
        let proposed = of(self.y);
        let exists = colours[0] > 0.0 && proposed > f64::NEG_INFINITY;
        exists.then(|| proposed - of(self.x) + ln(colours[0] / colours[1]))
    }
}
