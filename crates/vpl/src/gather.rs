//! Gathering: what virtual point lights add at a vertex (engelhardt-2013 section 3.3).

use crate::Vpl;
use fairflight_elementary::InstructionSet;
use fairflight_media::Line;
use fairflight_paths::extend::PathSampling;
use fairflight_paths::transport::{Scattered, Types, Vertex, World};
use fairflight_paths::{Heuristic, Walk};
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::fmt;

/// Part of the geometric term G that a connection takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Term {
    /// min(G, b) \[1/length²\] (raab-2008 eq. 14); b = ∞ takes all of it.
    Bounded(f64),
    /// max(G − b, 0): what bounding takes away.
    Excess(f64),
}

impl Term {
    /// The part of a geometric term \[1/length²\].
    #[inline]
    #[must_use]
    pub fn of(self, geometric: f64) -> f64 {
        match self {
            Self::Bounded(bound) => geometric.min(bound),
            Self::Excess(bound) => (geometric - bound).max(0.0),
        }
    }
}

/// Virtual point lights that a vertex is connected with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Connected {
    /// Virtual point lights of a set.
    All,
    /// One virtual point light, by its index.
    One(usize),
    /// No virtual point light: only emitters are seen.
    Nothing,
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
pub struct Gather<'s, W: Types> {
    /// Scene that the virtual point lights lie in.
    pub world: World<'s, W>,
    /// The lights.
    pub vpls: &'s [Vpl<W::Spectrum>],
    /// The part of G that a connection takes.
    pub term: Term,
    /// Combination of the techniques that sample emitters.
    pub heuristic: Heuristic,
    /// Flights through the medium.
    pub walk: Walk<W::Sampling>,
    /// Transmittance of connections.
    pub shadow: W::Shadow,
}

impl<W: Types> fmt::Debug for Gather<'_, W> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { term, heuristic, .. } = self;
        formatter
            .debug_struct("Gather")
            .field("term", term)
            .field("heuristic", heuristic)
            .finish_non_exhaustive()
    }
}

/// The segment from one vertex to another.
#[inline(always)]
pub(crate) fn connection(y: &Vertex, to: &Vertex, direction: DVec3, length: f64) -> Segment {
    Segment { line: Line { origin: y.position, direction }, length, from: y.surface(), to: to.surface() }
}

impl<W: Types> Gather<'_, W> {
    /// True if both ends lie on one plane, which does not light itself; the cosines say so but for rounding.
    #[inline(always)]
    pub(crate) fn is_on_one_plane(&self, segment: &Segment) -> bool {
        let is_closed = |index: usize| self.world.surfaces.surfaces()[index].shape.is_closed();
        segment.from == segment.to && segment.from.is_some_and(|index| !is_closed(index))
    }

    /// The contribution of one virtual point light.
    #[inline]
    pub fn one(&mut self, y: &Vertex, index: usize, source: &mut impl UniformSource) -> W::Spectrum {
        let vpl = &self.vpls[index];
        let offset = vpl.vertex.position - y.position;
        let squared = offset.length_squared();
        if squared == 0.0 {
            return W::Spectrum::ZERO;
        }
        let distance = squared.sqrt();
        let direction = offset / distance;
        // raab-2008 eq. 8: a cosine at each end that lies on a surface.
        let geometric = y.cosine(direction) * vpl.vertex.cosine(-direction) / squared;
        let term = self.term.of(geometric);
        if term == 0.0 {
            return W::Spectrum::ZERO;
        }
        let segment = connection(y, &vpl.vertex, direction, distance);
        if self.is_on_one_plane(&segment) {
            return W::Spectrum::ZERO;
        }
        let visibility = self.world.attenuated_visibility(&segment, &mut self.shadow, source);
        if visibility == 0.0 {
            return W::Spectrum::ZERO;
        }
        let phase = &self.world.volume.phase;
        let scattering = y.eval(phase, direction) * vpl.eval(phase, -direction);
        vpl.power * (scattering * term * visibility)
    }

    /// The contribution of several virtual point lights.
    #[inline(never)]
    pub fn connected(
        &mut self,
        y: &Vertex,
        which: Connected,
        source: &mut impl UniformSource,
    ) -> W::Spectrum {
        match which {
            Connected::Nothing => W::Spectrum::ZERO,
            Connected::One(index) => self.one(y, index, source),
            Connected::All => self.all_by(InstructionSet::widest(), y, source),
        }
    }

    /// The share of the light of emitters that goes with these connections, so that all of them together count it once.
    #[must_use]
    pub fn share(&self, which: Connected) -> f64 {
        match which {
            Connected::All | Connected::Nothing => 1.0,
            Connected::One(_) => 1.0 / self.vpls.len() as f64,
        }
    }

    /// The light that `y` scatters and that no virtual point light stands for, per albedo or reflectance: from emitters, by next-event
    /// estimation and by one direction that the vertex chooses; and what that direction sees in a smooth surface, by one path, since nothing
    /// is connected through it.
    ///
    /// Never bounded: an emitter of some size is left to the weights, and a point cannot be compensated.
    #[inline(never)]
    pub fn emitters(&mut self, y: &Vertex, source: &mut impl UniformSource) -> W::Spectrum {
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
            let sampling = &mut PathSampling::by(*heuristic);
            let behind = world.trace(walk, (sampling, MOST_VERTICES), (next, None), shadow, source);
            arriving += behind.radiance * passage.radiance_scale;
        }
        if arriving != W::Spectrum::ZERO {
            radiance += arriving * world.transmittance(&segment, shadow, source);
        }
        radiance
    }
}

/// Greatest number of vertices of a path behind a smooth surface: only a scene without absorption has longer ones.
const MOST_VERTICES: u32 = 10_000;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::{ball, diffuse, hazy, in_medium, on_surface, square, vacuum, vpl};
    use fairflight_media::PhaseFunction;
    use fairflight_scene::{Material, Source};
    use fairflight_sources::Scripted;
    use glam::dvec3;
    use std::f64::consts::{FRAC_1_PI, PI};

    const WHOLE: Term = Term::Bounded(f64::INFINITY);

    fn none() -> Scripted {
        Scripted::new([])
    }

    #[test]
    fn what_is_bounded_and_what_exceeds_are_the_whole() {
        for geometric in [0.0, 0.3, 1.0, 1.7, 1e9, f64::INFINITY] {
            for bound in [0.0, 1.0, 4.0] {
                let sum = Term::Bounded(bound).of(geometric) + Term::Excess(bound).of(geometric);
                assert_eq!(sum, geometric);
                assert!(Term::Bounded(bound).of(geometric) <= bound);
            }
            assert_eq!(WHOLE.of(geometric), geometric);
        }
    }

    #[test]
    fn two_points_of_the_medium_by_hand() {
        let scene = hazy(vec![], vec![]);
        let y = in_medium(DVec3::ZERO, DVec3::Z);
        let vpls = [vpl(in_medium(dvec3(0.0, 1.2, 1.6), DVec3::Y), 7.0)];
        // The light arrives at the virtual light along +y, leaves it along (0, −0.6, −0.8); y's path arrived along +z.
        let phase = |cosine| scene.volume.phase.eval(cosine);
        let whole = 7.0 * phase(-0.6) * phase(0.8) / 4.0 * (-1.0f64).exp();
        let one = |term| scene.gather(&vpls, term).one(&y, 0, &mut none());
        assert!((one(WHOLE) - whole).abs() < 1e-16);
        assert!((one(Term::Bounded(0.1)) - 0.4 * whole).abs() < 1e-16);
        assert!((one(Term::Excess(0.1)) - 0.6 * whole).abs() < 1e-16);
        // At and above G = 1/4 nothing is bounded, and nothing exceeds.
        assert!((one(Term::Bounded(0.26)) - whole).abs() < 1e-16);
        assert_eq!((one(Term::Excess(0.25)), one(Term::Bounded(0.0))), (0.0, 0.0));
    }

    #[test]
    fn each_end_on_a_surface_has_its_cosine() {
        let floor = square(0.0, 5.0, diffuse(0.5), 0.0);
        let ceiling = square(2.0, 5.0, diffuse(0.5), 0.0);
        let scene = hazy(vec![floor, ceiling], vec![]);
        // 2.5 apart, at the cosine 0.8 to either normal.
        let y = on_surface(DVec3::ZERO, DVec3::Z, 0);
        let x = on_surface(dvec3(1.5, 0.0, 2.0), DVec3::NEG_Z, 1);
        let in_haze = in_medium(x.position - 1e-9 * DVec3::Z, DVec3::X);
        let way = (-1.25f64).exp() / 6.25;
        let seen = |y: &Vertex, v: Vertex| {
            let vpls = [vpl(v, 3.0)];
            scene.gather(&vpls, WHOLE).one(y, 0, &mut none())
        };
        assert!((seen(&y, x) - 3.0 * 0.64 * FRAC_1_PI * FRAC_1_PI * way).abs() < 1e-15);
        let mixed = 3.0 * 0.8 * FRAC_1_PI * scene.volume.phase.eval(-0.6) * way;
        assert!((seen(&y, in_haze) - mixed).abs() < 1e-9);
        let y_haze = in_medium(1e-9 * DVec3::Z, DVec3::NEG_X);
        assert!((seen(&y_haze, x) - mixed).abs() < 1e-9);
        // Behind either surface there is nothing.
        assert_eq!(seen(&on_surface(DVec3::ZERO, DVec3::NEG_Z, 0), x), 0.0);
        assert_eq!(seen(&y, on_surface(x.position, DVec3::Z, 1)), 0.0);
    }

    #[test]
    fn a_plane_does_not_light_itself_but_a_sphere_does() {
        let hollow = ball(dvec3(0.0, 0.0, 20.0), 1.0, diffuse(0.5), 0.0);
        // A tilted normal, as rounding may leave it: only the index says that nothing is seen.
        let scene = vacuum(vec![square(0.0, 5.0, diffuse(0.5), 0.0), hollow], vec![]);
        let tilted = dvec3(1e-3, 0.0, 1.0).normalize();
        let on_floor = [vpl(on_surface(DVec3::X, dvec3(-1e-3, 0.0, 1.0).normalize(), 0), 1.0)];
        let y = on_surface(DVec3::ZERO, tilted, 0);
        assert_eq!(scene.gather(&on_floor, WHOLE).one(&y, 0, &mut none()), 0.0);
        // From side to side of a sphere of radius 1: G = 1/4.
        let inside = [vpl(on_surface(dvec3(1.0, 0.0, 20.0), DVec3::NEG_X, 1), 1.0)];
        let y = on_surface(dvec3(-1.0, 0.0, 20.0), DVec3::X, 1);
        let seen = scene.gather(&inside, WHOLE).one(&y, 0, &mut none());
        assert!((seen - 0.25 * FRAC_1_PI * FRAC_1_PI).abs() < 1e-16);
    }

    #[test]
    fn spheres_are_in_the_way_and_points_do_not_light_themselves() {
        let scene = hazy(vec![ball(DVec3::Z, 0.5, diffuse(0.5), 0.0)], vec![]);
        let y = in_medium(DVec3::ZERO, DVec3::Z);
        let vpls = [2.0 * DVec3::Z, DVec3::ZERO, 2.0 * DVec3::X].map(|at| vpl(in_medium(at, DVec3::X), 1.0));
        let mut gather = scene.gather(&vpls, WHOLE);
        let each: Vec<f64> = (0..3).map(|i| gather.connected(&y, Connected::One(i), &mut none())).collect();
        assert_eq!(each[..2], [0.0, 0.0]);
        assert!(each[2] > 0.0);
        assert_eq!(gather.connected(&y, Connected::All, &mut none()), each[2]);
        // Nothing is left of a light of no power, or of one at the vertex, however little is bounded.
        for term in [Term::Bounded(3.0), Term::Excess(3.0), Term::Excess(0.0)] {
            assert_eq!(scene.gather(&vpls, term).one(&y, 1, &mut none()), 0.0);
        }
    }

    #[test]
    fn shares_count_emitters_once() {
        let scene = vacuum(vec![], vec![]);
        let vpls = [0.1, 0.2, 0.3, 0.4].map(|z| vpl(in_medium(z * DVec3::Z, DVec3::X), 1.0));
        let gather = scene.gather(&vpls, WHOLE);
        assert_eq!(gather.share(Connected::All), 1.0);
        assert_eq!((0..4).map(|i| gather.share(Connected::One(i))).sum::<f64>(), 1.0);
        assert_eq!(scene.gather(&[], WHOLE).share(Connected::All), 1.0);
    }

    #[test]
    fn light_of_emitters_is_never_bounded() {
        let y = on_surface(DVec3::ZERO, DVec3::Z, 0);
        let floor = square(0.0, 5.0, diffuse(0.5), 0.0);
        // A point light: no direction could meet it, and none is drawn.
        let light = Source::point(0.1 * DVec3::Z, 4.0 * PI).unwrap();
        let scene = vacuum(vec![floor], vec![light]);
        for term in [WHOLE, Term::Bounded(0.0)] {
            let lit = scene.gather(&[], term).emitters(&y, &mut none());
            assert!((lit - 100.0 * FRAC_1_PI).abs() < 1e-12);
        }
        // A lamp right above, by both techniques on the same direction: what one leaves the other takes.
        let scene = vacuum(vec![floor, square(2.0, 1.0, diffuse(0.0), 3.0)], vec![]);
        let lit = |script: [f64; 4]| scene.gather(&[], WHOLE).emitters(&y, &mut Scripted::new(script));
        let (sampled, scattered) = (1.0, FRAC_1_PI);
        let by_sample = 3.0 * scattered / (sampled + scattered);
        assert!((lit([0.5, 0.5, 0.0, 0.0]) - 2.0 * by_sample).abs() < 1e-15);
        // The direction misses the lamp.
        assert!((lit([0.5, 0.5, 0.9, 0.0]) - by_sample).abs() < 1e-15);
    }

    #[test]
    fn what_is_seen_in_a_mirror_is_found_by_a_path() {
        // A mirror above the floor and a lamp below it: a direction that is chosen straight up sees the lamp's top.
        let floor = square(0.0, 1.0, diffuse(0.5), 0.0);
        let surfaces =
            vec![floor, square(2.0, 9.0, Material::Mirror, 0.0), square(-1.0, 9.0, diffuse(0.0), 3.0)];
        let scene = vacuum(surfaces, vec![]);
        let y = on_surface(DVec3::ZERO, DVec3::Z, 0);
        let slanted = cosine_of(1.0 / 2f64.sqrt());
        let mut gather = scene.gather(&[], WHOLE);
        // The sample of the lamp lies behind the floor; the direction at 45° goes to x = 2 in the mirror and on to x = 5 on the lamp; roulette there.
        let lit = gather.emitters(&y, &mut Scripted::new([0.5, 0.5, slanted, 0.0, 0.0]));
        assert_eq!(lit, 3.0);
        // Straight up and down again it meets the floor, which is lit by nothing but the lamp: through the mirror, and not by a connection.
        let lit = gather.emitters(&y, &mut Scripted::new([0.5, 0.5, 0.0, 0.0, 0.5, 0.5, 0.9]));
        assert_eq!(lit, 0.0);
    }

    /// The variate for which a direction of [`Vertex::sample`] has this cosine on a surface.
    fn cosine_of(cosine: f64) -> f64 {
        1.0 - cosine * cosine
    }
}
