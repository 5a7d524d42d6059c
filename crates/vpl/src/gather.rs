//! Gathering: what virtual point lights add at a vertex (engelhardt-2013 section 3.3).

use crate::Vpl;
use fairflight_media::{Line, Medium, PhaseFunction};
use fairflight_paths::transport::{Scattered, Vertex, World};
use fairflight_paths::{Heuristic, RayTransmittance, SamplingExtinction, Walk};
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::UniformSource;

/// How much of the geometric term G a connection takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Term {
    /// min(G, b) \[1/length²\] (raab-2008 eq. 14); b = ∞ takes all of it.
    Bounded(f64),
    /// max(G − b, 0): what bounding takes away.
    Excess(f64),
}

impl Term {
    /// Of a geometric term.
    #[inline]
    #[must_use]
    pub fn of(self, geometric: f64) -> f64 {
        match self {
            Self::Bounded(bound) => geometric.min(bound),
            Self::Excess(bound) => (geometric - bound).max(0.0),
        }
    }
}

/// Which virtual point lights a vertex is connected with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Connected {
    /// All of them.
    All,
    /// One of them.
    One(usize),
}

/// Virtual point lights, and how one sees them.
///
/// **Law.** For a fixed set the expectation of [`one`](Self::one) is power · f(v) · f(y) · G' · V, where f has no albedo or reflectance of
/// y, G' is as [`Term`] says and V is the attenuated visibility (raab-2008 eq. 9). Over sets, the sum over all with b = ∞ has the expectation
/// ∫ L_s(x → y) f(y) G V dx: the light at y that was scattered at least once before.
///
/// **Variance.** With b = ∞ there is no second moment in a medium: a virtual point light at the distance r counts 1/r², and
/// r² dr of them lie there. With a bound one adds at most power · f · f · b.
///
/// A light exactly at the vertex adds nothing: a set of measure zero, in which no direction is defined.
#[derive(Debug)]
pub struct Gather<'s, G, M, P, C, R, T> {
    /// Where.
    pub world: World<'s, G, M, P, C>,
    /// The lights.
    pub vpls: &'s [Vpl<C>],
    /// How much of G a connection takes.
    pub term: Term,
    /// How emitters are sampled.
    pub heuristic: Heuristic,
    /// Flights through the medium.
    pub walk: Walk<R>,
    /// Transmittance of connections.
    pub shadow: T,
}

impl<G, M, P, C, R, T> Gather<'_, G, M, P, C, R, T>
where
    G: Geometry<C>,
    M: Medium,
    P: PhaseFunction,
    C: Spectrum,
    R: SamplingExtinction,
    T: RayTransmittance<M>,
{
    /// What one virtual point light adds.
    #[inline]
    pub fn one<S: UniformSource + ?Sized>(&mut self, y: &Vertex, index: usize, source: &mut S) -> C {
        let vpl = &self.vpls[index];
        let offset = vpl.vertex.position - y.position;
        let squared = offset.length_squared();
        if squared == 0.0 {
            return C::ZERO;
        }
        let distance = squared.sqrt();
        let direction = offset / distance;
        // raab-2008 eq. 8: a cosine at each end that lies on a surface.
        let geometric = y.cosine(direction) * vpl.vertex.cosine(-direction) / squared;
        let term = self.term.of(geometric);
        if term == 0.0 || geometric == 0.0 {
            return C::ZERO;
        }
        let (from, to) = (y.surface(), vpl.vertex.surface());
        let surfaces = self.world.surfaces.surfaces();
        // A plane does not light itself; the cosines say so but for rounding.
        if from == to
            && let Some(index) = from
            && !surfaces[index].shape.is_closed()
        {
            return C::ZERO;
        }
        let segment = Segment { line: Line { origin: y.position, direction }, length: distance, from, to };
        let visibility = self.world.attenuated_visibility(&segment, &mut self.shadow, source);
        if visibility == 0.0 {
            return C::ZERO;
        }
        let phase = &self.world.volume.phase;
        let scattering = y.eval(phase, direction) * vpl.eval(phase, -direction);
        vpl.power * (scattering * term * visibility)
    }

    /// What several of them add.
    #[inline]
    pub fn connected<S: UniformSource + ?Sized>(
        &mut self,
        y: &Vertex,
        which: Connected,
        source: &mut S,
    ) -> C {
        match which {
            Connected::One(index) => self.one(y, index, source),
            Connected::All => {
                let mut sum = C::ZERO;
                for index in 0..self.vpls.len() {
                    sum += self.one(y, index, source);
                }
                sum
            }
        }
    }

    /// The share of the light of emitters that goes with these connections, so that all of them together count it once.
    #[must_use]
    pub fn share(&self, which: Connected) -> f64 {
        match which {
            Connected::All => 1.0,
            Connected::One(_) => 1.0 / self.vpls.len() as f64,
        }
    }

    /// The light that `y` scatters and that no virtual point light stands for, per albedo or reflectance: from emitters, by next-event
    /// estimation and by one direction that the vertex chooses; and what that direction sees in a smooth surface, by one path, since nothing
    /// is connected through it.
    ///
    /// Never bounded: an emitter of some size is left to the weights, and a point cannot be compensated.
    pub fn emitters<S: UniformSource + ?Sized>(&mut self, y: &Vertex, source: &mut S) -> C {
        let Self { world, heuristic, walk, shadow, .. } = self;
        let mut radiance = world.emitters_at(*heuristic, y, shadow, source);
        let is_chosen_in_vain = world.lights.background.is_dark()
            && world.surfaces.emitters().is_empty()
            && !world.surfaces.has_specular();
        if is_chosen_in_vain {
            return radiance;
        }
        let phase = &world.volume.phase;
        let direction = y.sample(phase, source.next_uniform(), source.next_uniform());
        let from = Scattered { vertex: *y, pdf_solid_angle: y.pdf_solid_angle(phase, direction) };
        let mut segment = y.leave(direction, f64::INFINITY);
        let hit = world.surfaces.intersect(&segment);
        segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
        let mut arriving = match &hit {
            Some(hit) => world.emission(*heuristic, Some(&from), direction, hit),
            None => world.background(*heuristic, Some(&from), direction),
        };
        if let Some(hit) = hit
            && let Some(passage) = world.pass(&hit, direction, source)
        {
            let line = Line { origin: hit.position, direction: passage.direction };
            let next = Segment { line, length: f64::INFINITY, from: Some(hit.index), to: None };
            let behind = world.trace(walk, (*heuristic, MOST_VERTICES), next, shadow, source);
            arriving += behind.radiance * passage.radiance_scale;
        }
        if arriving != C::ZERO {
            radiance += arriving * world.transmittance(&segment, shadow, source);
        }
        radiance
    }
}

/// Of a path behind a smooth surface: only a scene without absorption has longer ones.
const MOST_VERTICES: u32 = 10_000;
