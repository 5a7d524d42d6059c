//! Radiance from virtual point lights (instant radiosity, raab-2008 section 4.2, engelhardt-2013 section 3.3).

use crate::{Connected, Connections, Correction, Gather};
use fairflight_media::Line;
use fairflight_paths::Integrator;
use fairflight_paths::transport::{Event, Types, Vertex};
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::UniformSource;

/// Virtual point lights that each point on the eye ray is connected with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pairing {
    /// Every virtual point light of the set.
    Every,
    /// One, which counts for all; those of the points of one ray are stratified over the set.
    One,
}

/// The part of the light that is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Component {
    /// The whole light.
    #[default]
    All,
    /// Connections alone. With [`Term::Excess`](crate::Term::Excess) that is the energy that bounding takes away, seen by the
    /// virtual point lights themselves: without a second moment in a medium.
    Connections,
    /// The correction alone: the same energy, recovered.
    Correction,
}

/// All light: emitters seen directly and lit by them, and virtual point lights for what was scattered before.
///
/// ```text
/// L = emitter or background behind the medium
///   + mean over S flights of   albedo or reflectance at the vertex y where the flight ends
///       · ( light of emitters scattered at y + Σ_k connection(y, k) + correction(y) )
/// ```
///
/// engelhardt-2013 section 3.3, with points y sampled by transmittance; its sum runs over S points and M lights (the printed bounds run
/// one too far). With [`Pairing::One`] the sum over k is M times one term.
///
/// **Law.** Over sets of light paths E\[radiance\] solves the three point form (raab-2008 eq. 5), if nothing is bounded or the correction is
/// unbiased. Given one set it does not: pixels of an image share their error, and only independent sets tell it.
///
/// Smooth surfaces are followed: no virtual point light lies on them and no connection passes them.
#[derive(Debug)]
pub struct VplIntegrator<'s, W: Types, K> {
    gather: Gather<'s, W>,
    eye_samples: u32,
    pairing: Pairing,
    correction: K,
    component: Component,
    truncated: u64,
}

/// Smooth surfaces on one path from the camera; longer ones are cut, and counted.
const MOST_SMOOTH: u32 = 1000;

impl<'s, W: Types, K> VplIntegrator<'s, W, K> {
    /// `eye_samples` ≥ 1 flights by `walk` along each camera ray.
    pub fn new(gather: Gather<'s, W>, (eye_samples, pairing): (u32, Pairing), correction: K) -> Self {
        Self {
            gather,
            eye_samples: eye_samples.max(1),
            pairing,
            correction,
            component: Component::All,
            truncated: 0,
        }
    }

    /// The same, one part of the light only.
    #[must_use]
    pub fn component(self, component: Component) -> Self {
        Self { component, ..self }
    }

    /// The number of flights and chains of smooth surfaces that were cut so far: each is a bias.
    pub fn truncated(&self) -> u64 {
        self.truncated
    }

    /// The correction, with what it counted.
    pub fn correction(&self) -> &K {
        &self.correction
    }
}

impl<W: Types, K: Correction<W>> VplIntegrator<'_, W, K> {
    /// Light that is scattered at `y`, per albedo or reflectance, as the `j`-th of `of` points of a ray.
    fn shade(&mut self, y: &Vertex, (j, of): (u32, u32), source: &mut impl UniformSource) -> W::Spectrum {
        let Self { gather, correction, component, .. } = self;
        let count = gather.vpls.len();
        let (which, scale) = match self.pairing {
            // Without virtual point lights there is no one to choose; the correction still has emitters to see.
            _ if count == 0 => (Connected::All, 1.0),
            Pairing::Every => (Connected::All, 1.0),
            Pairing::One => {
                let place = (f64::from(j) + source.next_uniform()) / f64::from(of);
                (Connected::One(((place * count as f64) as usize).min(count - 1)), count as f64)
            }
        };
        let mut radiance = W::Spectrum::ZERO;
        if *component != Component::Correction {
            radiance += gather.connected(y, which, source) * scale;
        }
        if *component != Component::Connections {
            radiance += correction.recover(Connections { gather, y, which }, source) * scale;
        }
        if *component == Component::All {
            radiance += gather.emitters(y, source);
        }
        radiance
    }

    /// The radiance that arrives along a ray; `smooth` surfaces were met before.
    fn arriving(
        &mut self,
        mut segment: Segment,
        smooth: u32,
        source: &mut impl UniformSource,
    ) -> W::Spectrum {
        let world = self.gather.world;
        let hit = world.surfaces.intersect(&segment);
        segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
        let heuristic = self.gather.heuristic;
        let mut behind = W::Spectrum::ZERO;
        if self.component == Component::All {
            let direction = segment.line.direction;
            behind += match &hit {
                Some(hit) => world.emission(heuristic, None, direction, hit),
                None => world.background(heuristic, None, direction),
            };
        }
        if let Some(hit) = hit
            && let Some(passage) = world.pass(&hit, segment.line.direction, source)
        {
            if smooth < MOST_SMOOTH {
                let line = Line { origin: hit.position, direction: passage.direction };
                let next = Segment { line, length: f64::INFINITY, from: Some(hit.index), to: None };
                behind += self.arriving(next, smooth + 1, source) * passage.radiance_scale;
            } else {
                self.truncated += 1;
            }
        }
        let mut radiance = W::Spectrum::ZERO;
        if behind != W::Spectrum::ZERO {
            radiance += behind * world.transmittance(&segment, &mut self.gather.shadow, source);
        }

        let surface = hit.as_ref().and_then(|hit| world.diffuse_vertex(hit));
        let collisions = world.collisions(&self.gather.walk);
        // Where nothing scatters on the way all flights end alike.
        let scatters = world.meets_medium(&segment);
        let flights = if scatters || self.pairing == Pairing::One { self.eye_samples } else { 1 };
        if !scatters && surface.is_none() {
            return radiance;
        }
        let mut scattered = W::Spectrum::ZERO;
        for j in 0..flights {
            let (vertex, factor) = match world.follow(&self.gather.walk, &collisions, &segment, source) {
                Event::Scattered { vertex, energy } => (vertex, energy),
                Event::Passed { weight } => match surface {
                    Some((vertex, reflectance)) => (vertex, reflectance * weight),
                    None => continue,
                },
                Event::Absorbed => continue,
                Event::Truncated => {
                    self.truncated += 1;
                    continue;
                }
            };
            scattered += factor * self.shade(&vertex, (j, flights), source);
        }
        radiance + scattered * (1.0 / f64::from(flights))
    }
}

impl<W: Types, K: Correction<W>> Integrator<W::Spectrum> for VplIntegrator<'_, W, K> {
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> W::Spectrum {
        let segment = Segment { line: *line, length: f64::INFINITY, from: None, to: None };
        self.arriving(segment, 0, source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::{Hazy, Scene, diffuse, hazy, on_surface, square, vacuum, vpl};
    use crate::{Term, Uncorrected, Vpl};
    use fairflight_scene::{Material, Source};
    use fairflight_sources::Scripted;
    use glam::{DVec3, dvec3};
    use std::f64::consts::{FRAC_1_PI, PI};

    /// Adds the same everywhere, and keeps what it was asked for.
    #[derive(Debug)]
    struct Spy {
        adds: f64,
        asked: Vec<Connected>,
    }

    fn spy(adds: f64) -> Spy {
        Spy { adds, asked: Vec::new() }
    }

    impl<W: Types> Correction<W> for Spy {
        fn recover(&mut self, at: Connections<'_, '_, W>, _source: &mut impl UniformSource) -> W::Spectrum {
            self.asked.push(at.which);
            W::Spectrum::splat(self.adds)
        }
    }

    const ALL: Term = Term::Bounded(f64::INFINITY);

    fn down() -> Line {
        Line { origin: DVec3::Z, direction: DVec3::NEG_Z }
    }

    /// Virtual point lights on a ceiling at the height 2, above the floor at 0.
    fn lights(count: usize) -> Vec<Vpl<f64>> {
        (0..count)
            .map(|i| vpl(on_surface(dvec3(0.5 * i as f64, 0.0, 2.0), DVec3::NEG_Z, 1), 1.0 + i as f64))
            .collect()
    }

    fn room() -> Scene<fairflight_media::EmptySpace, f64> {
        let surfaces = vec![square(0.0, 5.0, diffuse(0.5), 0.0), square(2.0, 5.0, diffuse(0.5), 0.0)];
        vacuum(surfaces, vec![Source::point(dvec3(0.0, 0.0, 0.5), PI).unwrap()])
    }

    /// The contribution of the light of [`room`] at the origin.
    const DIRECT: f64 = 0.5 * FRAC_1_PI;

    fn by_hand(vpls: &[Vpl<f64>]) -> Vec<f64> {
        let floor = on_surface(DVec3::ZERO, DVec3::Z, 0);
        let room = room();
        let mut gather = room.gather(vpls, ALL);
        (0..vpls.len()).map(|i| 0.5 * gather.one(&floor, i, &mut Scripted::new([]))).collect()
    }

    fn render<M: fairflight_media::LineThickness>(
        gather: Gather<'_, Hazy<M, f64>>,
        how: (u32, Pairing),
        component: Component,
        (correction, script): (Spy, &[f64]),
    ) -> (f64, Vec<Connected>, u64) {
        let mut integrator = VplIntegrator::new(gather, how, correction).component(component);
        let mut source = Scripted::new(script.iter().copied());
        let radiance = integrator.radiance(&down(), &mut source);
        assert_eq!(source.remaining(), 0);
        (radiance, integrator.correction().asked.clone(), integrator.truncated())
    }

    #[test]
    fn every_light_once_from_one_point() {
        let (room, vpls) = (room(), lights(3));
        // Where nothing scatters on the way all flights end alike: one is enough.
        let found = render(room.gather(&vpls, ALL), (7, Pairing::Every), Component::All, (spy(0.25), &[]));
        let expected = by_hand(&vpls).iter().sum::<f64>() + 0.5 * 0.25 + DIRECT;
        assert!((found.0 - expected).abs() < 1e-15, "{found:?}");
        assert_eq!((found.1, found.2), (vec![Connected::All], 0));
    }

    #[test]
    fn one_light_per_point_is_stratified_and_counts_for_all() {
        let (room, vpls) = (room(), lights(8));
        let variates = [0.0, 0.999, 0.5, 0.49];
        let found =
            render(room.gather(&vpls, ALL), (4, Pairing::One), Component::All, (spy(0.25), &variates));
        let chosen = [0, 3, 5, 6];
        assert_eq!(found.1, chosen.map(Connected::One));
        let each = by_hand(&vpls);
        let mean = chosen.iter().map(|&i| each[i]).sum::<f64>() / 4.0;
        assert!((found.0 - 8.0 * (mean + 0.5 * 0.25) - DIRECT).abs() < 1e-14);
        // More points than lights: two for each.
        let vpls = lights(2);
        let found =
            render(room.gather(&vpls, ALL), (4, Pairing::One), Component::All, (spy(0.25), &[0.999; 4]));
        assert_eq!(found.1, [0, 0, 1, 1].map(Connected::One));
    }

    #[test]
    fn without_lights_emitters_and_the_correction_remain() {
        for pairing in [Pairing::Every, Pairing::One] {
            let room = room();
            let found = render(room.gather(&[], ALL), (1, pairing), Component::All, (spy(0.25), &[]));
            assert!((found.0 - 0.5 * 0.25 - DIRECT).abs() < 1e-15);
            assert_eq!(found.1, [Connected::All]);
        }
    }

    #[test]
    fn components_are_the_parts_of_all() {
        let (room, vpls) = (room(), lights(3));
        let part = |component, term| {
            render(room.gather(&vpls, term), (1, Pairing::Every), component, (spy(0.25), &[])).0
        };
        let bounded = Term::Bounded(0.2);
        let (all, connected, corrected) = (
            part(Component::All, bounded),
            part(Component::Connections, bounded),
            part(Component::Correction, bounded),
        );
        assert!((all - connected - corrected - DIRECT).abs() < 1e-15);
        assert_eq!(corrected, 0.5 * 0.25);
        // What bounding takes away, seen by the lights themselves.
        let lost = part(Component::Connections, Term::Excess(0.2));
        assert!(lost > 0.0);
        assert!((connected + lost - part(Component::Connections, ALL)).abs() < 1e-15);
    }

    #[test]
    fn a_lamp_is_seen_once_directly_or_in_a_mirror() {
        let lamp = |z| square(z, 5.0, diffuse(0.0), 3.0);
        // The lamp reflects nothing, but where it is seen a direction is drawn all the same.
        for surfaces in [vec![lamp(0.0)], vec![square(0.0, 5.0, Material::Mirror, 0.0), lamp(4.0)]] {
            let scene = vacuum(surfaces, vec![]);
            let seen = |component, script: &[f64]| {
                let mut integrator =
                    VplIntegrator::new(scene.gather(&[], ALL), (1, Pairing::Every), Uncorrected)
                        .component(component);
                let mut source = Scripted::new(script.iter().copied());
                let radiance = integrator.radiance(&down(), &mut source);
                assert_eq!((source.remaining(), integrator.truncated()), (0, 0));
                radiance
            };
            // Straight away from the lamp into nothing, or into the mirror and back to the lamp, where roulette ends it.
            let has_mirror = scene.surfaces.has_specular();
            assert_eq!(seen(Component::All, if has_mirror { &[0.0, 0.0, 0.0] } else { &[0.0, 0.0] }), 3.0);
            assert_eq!(seen(Component::Connections, &[]), 0.0);
            assert_eq!(seen(Component::Correction, &[]), 0.0);
        }
    }

    #[test]
    fn the_mean_over_flights() {
        let scene = hazy(vec![square(0.0, 5.0, diffuse(0.5), 0.0)], vec![]);
        let hazy = |script: &[f64]| {
            let gather = scene.gather(&[], ALL);
            render(gather, (2, Pairing::Every), Component::Correction, (spy(1.0), script))
        };
        // Of optical thickness 1/2: u below 0.39 collides, and the albedo is 1/2.
        assert_eq!(hazy(&[0.2, 0.4, 0.5]).0, 0.5 * (1.0 + 0.5));
        assert_eq!(hazy(&[0.2, 0.6, 0.5]).0, 0.25);
        assert_eq!(hazy(&[0.5, 0.2, 0.4]).1, [Connected::All; 2]);
        let mut gather = scene.gather(&[], ALL);
        gather.walk = gather.walk.with_max_collisions(0);
        let cut = render(gather, (2, Pairing::Every), Component::Correction, (spy(1.0), &[0.2, 0.5]));
        assert_eq!((cut.0, cut.2), (0.25, 1));
    }

    #[test]
    fn an_endless_chain_of_mirrors_is_cut_and_counted() {
        let mirrors = vec![square(0.0, 5.0, Material::Mirror, 0.0), square(2.0, 5.0, Material::Mirror, 0.0)];
        let scene = vacuum(mirrors, vec![]);
        let found = render(scene.gather(&[], ALL), (1, Pairing::Every), Component::All, (spy(1.0), &[]));
        assert_eq!(found, (0.0, vec![], 1));
    }
}
