//! Light paths, whose vertices are virtual point lights (engelhardt-2013 section 3.2, raab-2008 section 4.2).

use crate::{KeepNear, Vpl};
use fairflight_paths::Walk;
use fairflight_paths::transport::{Carried, Emitters, Ledger, Met, Types, WalkEnd, World};
use fairflight_scene::Spectrum;
use fairflight_sources::UniformSource;
use std::ops::ControlFlow;

/// Light paths through surfaces and medium.
///
/// ```text
/// start on an emitter, with its power
/// repeat
///     fly to a collision or a surface                      (raab-2008 algorithm 1, or any other sampling extinction)
///     at a smooth surface: go on behind it, unless straight from a light without extent
///     else: leave a virtual point light with the power that is scattered
///     roulette with the share that is scattered
///     choose a direction by BRDF · cosine or phase function
/// ```
///
/// **Law.** With N paths, each light of power Φ/N, the sum over all virtual point lights of power · f(x) · g(x) has the expectation
/// ∫ L_s(x → ·) g(x) dx: they are samples of the light that is scattered at x, whatever g. In particular the power that they absorb and
/// the power that escapes are those of the emitters ([`Ledger`]).
///
/// **Lights without extent** are not seen behind smooth surfaces: no direction meets them by chance, no connection passes. Neither path tracing
/// nor the light of emitters at a vertex has that light; were it in the virtual point lights, connections and their compensation would
/// estimate different things.
///
/// **Variance.** A sampling extinction below the extinction gives powers of either sign; subcriticality is that of the
/// [`Walk`].
#[derive(Debug)]
pub struct LightPaths<'s, W: Types> {
    world: World<'s, W>,
    emitters: &'s Emitters<W::Spectrum>,
    walk: Walk<W::Sampling>,
    keep_near: Option<KeepNear>,
    max_vertices: u32,
}

/// Longer paths are cut, and counted: only a scene without absorption has them.
const MOST_VERTICES: u32 = 10_000;

impl<'s, W: Types> LightPaths<'s, W> {
    /// Light paths from `emitters` through `world` that fly by `walk`.
    pub fn new(world: World<'s, W>, emitters: &'s Emitters<W::Spectrum>, walk: Walk<W::Sampling>) -> Self {
        Self { world, emitters, walk, keep_near: None, max_vertices: MOST_VERTICES }
    }

    /// The same, thinned far away from a point.
    #[must_use]
    pub fn keeping_near(self, keep_near: Option<KeepNear>) -> Self {
        Self { keep_near, ..self }
    }

    /// The same with at most `max_vertices` vertices on a path.
    #[must_use]
    pub fn with_max_vertices(self, max_vertices: u32) -> Self {
        Self { max_vertices, ..self }
    }

    /// Traces one path that carries `share` of all power (1/N for N paths); `deposit` takes its virtual point lights.
    pub fn trace(
        &self,
        share: f64,
        ledger: &mut Ledger<W::Spectrum>,
        source: &mut impl UniformSource,
        mut deposit: impl FnMut(Vpl<W::Spectrum>),
    ) {
        let world = &self.world;
        ledger.paths += 1;
        let Some(start) = self.emitters.sample(world.lights, world.surfaces, source) else { return };
        let power = start.power * share;
        ledger.emitted += power;
        let mut bounce = 0;
        let walk = (&self.walk, self.max_vertices);
        let begin = (start.segment, power);
        let end = world.random_walk(walk, begin, Carried::Power, source, |met, incident, power, source| {
            let (vertex, factor, hit) = match met {
                Met::Vertex { vertex, factor, hit } => (vertex, factor, hit),
                Met::Smooth { .. } if bounce == 0 && !start.light.has_extent() => {
                    ledger.unseen += power;
                    return ControlFlow::Break(());
                }
                Met::Smooth { .. } => return ControlFlow::Continue(()),
            };
            let scattered = power * factor;
            ledger.absorbed += match hit {
                None => share_absorbed(scattered, world.volume.albedo),
                Some(_) => power * (W::Spectrum::splat(1.0) + factor * -1.0),
            };
            bounce += 1;
            ledger.scattered += scattered;
            if factor.magnitude() > 0.0 {
                let kept = self.keep_near.map_or(1.0, |near| near.probability(vertex.position));
                if kept >= 1.0 || source.next_uniform() < kept {
                    deposit(Vpl { vertex, incident, power: scattered * (1.0 / kept), bounce });
                }
            }
            ControlFlow::Continue(())
        });
        match end {
            WalkEnd::Escaped(_, power) => ledger.escaped += power,
            WalkEnd::Ended => {}
            WalkEnd::Cut => ledger.truncated += 1,
        }
    }
}

/// Power absorbed at a vertex that scattered `scattered`, per channel: (1 − a)/a of it.
fn share_absorbed<C: Spectrum>(scattered: C, albedo: C) -> C {
    let ratio = albedo.map(|a| if a > 0.0 { (1.0 - a) / a } else { 0.0 });
    scattered * ratio
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::{Hazy, Scene, ball, diffuse, hazy, on_surface, square, vacuum, walk};
    use fairflight_collision::Version;
    use fairflight_media::LineThickness;
    use fairflight_scene::{Material, Source};
    use fairflight_sources::{Scripted, Seeded};
    use glam::{DVec3, dvec3};
    use std::f64::consts::LN_2;

    /// Power of the point light of each test; each path carries a quarter of it.
    const POWER: f64 = 8.0;
    const CARRIED: f64 = 2.0;

    /// Lights and ledger of one path of these variates, all of which it must use.
    fn traced<M: LineThickness, C: Spectrum>(
        scene: &Scene<M, C>,
        change: impl FnOnce(Paths<'_, M, C>) -> Paths<'_, M, C>,
        script: &[f64],
    ) -> (Vec<Vpl<C>>, Ledger<C>) {
        let emitters = emitters(scene);
        let paths = change(LightPaths::new(scene.world(), &emitters, walk()));
        let (mut vpls, mut ledger) = (Vec::new(), Ledger::empty());
        let mut source = Scripted::new(script.iter().copied());
        paths.trace(CARRIED / POWER, &mut ledger, &mut source, |vpl| vpls.push(vpl));
        assert_eq!(source.remaining(), 0);
        (vpls, ledger)
    }

    type Paths<'s, M, C> = LightPaths<'s, Hazy<M, C>>;

    fn emitters<M, C: Spectrum>(scene: &Scene<M, C>) -> Emitters<C> {
        Emitters::new(&scene.lights, &scene.surfaces, (DVec3::ZERO, 20.0), DVec3::ZERO)
    }

    fn light<C: Spectrum>(z: f64) -> Vec<Source<C>> {
        vec![Source::point(z * DVec3::Z, C::splat(POWER)).unwrap()]
    }

    /// The choice of the only light, and its direction: cosine 1 − 2u with the z axis, towards x.
    fn from_light(u: f64) -> [f64; 6] {
        [0.5, u, 0.0, 0.5, 0.5, 0.5]
    }

    fn script(u: f64, rest: &[f64]) -> Vec<f64> {
        [&from_light(u)[..], rest].concat()
    }

    #[test]
    fn the_first_bounce_on_a_floor_under_a_point_light() {
        // A cosine of 1/2 downwards, from the height 1: distance 2, √3 aside. From below it is the other side.
        for (z, u, normal) in [(1.0, 0.75, DVec3::Z), (-1.0, 0.25, DVec3::NEG_Z)] {
            let scene = vacuum(vec![square(0.0, 5.0, diffuse(0.25), 0.0)], light(z));
            let (vpls, ledger) = traced(&scene, |paths| paths, &script(u, &[0.25]));
            let [vpl] = vpls[..] else { panic!("{vpls:?}") };
            let incident = dvec3(0.75f64.sqrt(), 0.0, -0.5 * z);
            assert!((vpl.incident - incident).length() < 1e-15);
            let expected = on_surface(dvec3(3f64.sqrt(), 0.0, 0.0), normal, 0);
            assert!((vpl.vertex.position - expected.position).length() < 1e-15);
            assert_eq!((vpl.vertex.lobe, vpl.bounce), (expected.lobe, 1));
            assert!((vpl.power - 0.25 * CARRIED).abs() < 1e-15 && !vpl.is_in_medium());
            assert_eq!((ledger.emitted, ledger.escaped, ledger.truncated), (CARRIED, 0.0, 0));
            assert_eq!((ledger.scattered, ledger.absorbed, ledger.paths), (0.5, 1.5, 1));
        }
    }

    #[test]
    fn roulette_keeps_the_power_of_those_that_survive() {
        let surfaces = vec![square(0.0, 5.0, diffuse(0.25), 0.0), square(3.0, 5.0, diffuse(0.5), 0.0)];
        let scene = vacuum(surfaces, light(1.0));
        let path = script(0.75, &[0.249, 0.0, 0.0, 0.5]);
        let (vpls, ledger) = traced(&scene, |paths| paths, &path);
        assert_eq!(vpls.iter().map(|vpl| vpl.power).collect::<Vec<_>>(), [0.5, 1.0]);
        assert_eq!(vpls.iter().map(|vpl| vpl.bounce).collect::<Vec<_>>(), [1, 2]);
        assert_eq!(vpls[1].incident, DVec3::Z);
        assert_eq!((ledger.scattered, ledger.absorbed, ledger.emitted), (1.5, 2.5, CARRIED));
        // The same path, cut behind its first vertex: where the rest would go is not known.
        let (vpls, ledger) = traced(&scene, |paths| paths.with_max_vertices(1), &path[..9]);
        assert_eq!((vpls.len(), ledger.truncated), (1, 1));
    }

    #[test]
    fn the_ledger_of_a_path_that_always_survives_adds_up_per_channel() {
        // The greatest channel is 1, so that roulette never ends it.
        let [floor, ceiling] = [dvec3(1.0, 0.5, 0.25), dvec3(0.125, 1.0, 0.75)].map(diffuse);
        let scene = vacuum(
            vec![square(0.0, 5.0, floor, DVec3::ZERO), square(3.0, 5.0, ceiling, DVec3::ZERO)],
            light(1.0),
        );
        // Floor, straight up to the ceiling, and out between the two.
        let (vpls, ledger) =
            traced(&scene, |paths| paths, &script(0.75, &[0.999, 0.0, 0.0, 0.999, 0.999, 0.3]));
        assert_eq!(vpls[0].power, CARRIED * dvec3(1.0, 0.5, 0.25));
        assert_eq!(vpls[1].power, CARRIED * dvec3(0.125, 0.5, 0.1875));
        assert_eq!(ledger.escaped, vpls[1].power);
        assert_eq!(ledger.absorbed + ledger.escaped, ledger.emitted);
        assert_eq!(ledger.scattered, vpls[0].power + vpls[1].power);
    }

    #[test]
    fn smooth_surfaces_are_passed_with_all_power() {
        // A lamp of area 4 that shines up with the power 8 on both sides, onto a mirror and back up from the ceiling's other side.
        let lamp = || square(0.0, 1.0, diffuse(0.0), 1.0 / std::f64::consts::PI);
        let ceiling = || square(-2.0, 9.0, diffuse(0.5), 0.0);
        let pass = |material, sine_squared, rest: &[f64]| {
            let from_lamp = [0.5, 0.0, 0.0, 0.9, sine_squared, 0.0];
            let scene = vacuum(vec![lamp(), square(1.0, 5.0, material, 0.0), ceiling()], vec![]);
            traced(&scene, |paths| paths, &[&from_lamp[..], rest].concat())
        };
        // At 60° to the normal: past the lamp, √3 beside its corner, and on to z = −2.
        let (vpls, ledger) = pass(Material::Mirror, 0.75, &[0.5]);
        let [vpl] = vpls[..] else { panic!("{vpls:?}") };
        let aside = (vpl.vertex.position - dvec3(-1.0, -1.0, -2.0)).length();
        assert!((aside - 4.0 * 3f64.sqrt()).abs() < 1e-14, "{aside}");
        assert!((vpl.power - 0.5 * CARRIED).abs() < 1e-14 && vpl.bounce == 1);
        assert!((ledger.emitted - CARRIED).abs() < 1e-14 && ledger.unseen == 0.0);
        // Refraction compresses radiance, not power.
        let (vpls, ledger) = pass(Material::Dielectric { ior: 1.5 }, 0.2, &[0.9]);
        assert!(vpls.is_empty() && (ledger.escaped - CARRIED).abs() < 1e-14);
    }

    #[test]
    fn light_of_a_point_does_not_pass_smooth_surfaces_unscattered() {
        let surfaces = vec![square(0.0, 9.0, Material::Mirror, 0.0), square(2.0, 9.0, diffuse(0.5), 0.0)];
        let scene = vacuum(surfaces, light(1.0));
        let (vpls, ledger) = traced(&scene, |paths| paths, &script(0.75, &[]));
        assert_eq!((vpls.len(), ledger.unseen, ledger.emitted), (0, CARRIED, CARRIED));
        // Once scattered it is like any other: up to the ceiling, down to the mirror, up again.
        let (vpls, ledger) = traced(&scene, |paths| paths, &script(0.25, &[0.49, 0.0, 0.0, 0.5]));
        assert_eq!((vpls.len(), ledger.unseen), (2, 0.0));
        assert_eq!((vpls[1].bounce, vpls[1].vertex.surface()), (2, Some(1)));
    }

    #[test]
    fn a_collision_leaves_what_is_scattered_there() {
        let scene = hazy(vec![], light(0.0));
        // Terminating: the particle that is scattered keeps its energy, and counts for those that were absorbed. Flight (2 ln 2),
        // scattered, roulette that all survive, a direction, and a flight out.
        let path = script(0.5, &[0.5, 0.49, 0.999, 0.3, 0.3, 0.9999]);
        let (vpls, ledger) = traced(&scene, |paths| paths, &path);
        assert!(vpls[0].is_in_medium() && vpls.len() == 1);
        assert!((vpls[0].vertex.position - 2.0 * LN_2 * DVec3::X).length() < 1e-15);
        assert!((vpls[0].incident - DVec3::X).length() < 1e-15);
        assert_eq!((vpls[0].power, ledger.escaped, ledger.absorbed), (CARRIED, CARRIED, CARRIED));
        let (vpls, ledger) = traced(&scene, |paths| paths, &script(0.5, &[0.5, 0.5]));
        assert_eq!((vpls.len(), ledger.emitted, ledger.absorbed), (0, CARRIED, 0.0));
        // Non-terminating: nothing is absorbed by chance, and the ledger of a path adds up.
        let (vpls, ledger) = traced(
            &scene,
            |paths| LightPaths { walk: Walk::new(Version::NonTerminating, *walk().sampling()), ..paths },
            &script(0.5, &[0.5, 0.7, 0.5]),
        );
        assert_eq!((vpls[0].power, ledger.absorbed), (0.5 * CARRIED, 0.5 * CARRIED));
        let (vpls, ledger) = traced(
            &scene,
            |paths| LightPaths { walk: walk().with_max_collisions(0), ..paths },
            &script(0.5, &[0.5]),
        );
        assert_eq!((vpls.len(), ledger.truncated), (0, 1));
    }

    #[test]
    fn far_lights_are_thinned_and_weigh_more() {
        let near = KeepNear { point: DVec3::ZERO, radius: 0.75f64.sqrt() };
        let scene = vacuum(vec![square(0.0, 5.0, diffuse(0.25), 0.0)], light(1.0));
        let traced = |u| traced(&scene, |paths| paths.keeping_near(Some(near)), &script(0.75, &[u, 0.9]));
        let (kept, ledger) = traced(0.2499);
        assert!((kept[0].power - 4.0 * 0.25 * CARRIED).abs() < 1e-14);
        let (dropped, same) = traced(0.2501);
        assert!(dropped.is_empty());
        assert_eq!(ledger, same);
    }

    #[test]
    fn no_light_leaves_nothing() {
        let scene = vacuum(vec![square(0.0, 5.0, diffuse(0.5), 0.0)], vec![]);
        let (vpls, ledger) = traced(&scene, |paths| paths, &[]);
        assert!(vpls.is_empty());
        assert_eq!(ledger, Ledger { paths: 1, ..Ledger::empty() });
    }

    #[test]
    fn on_average_what_is_emitted_is_absorbed_or_escapes() {
        let surfaces = vec![square(-1.0, 3.0, diffuse(0.7), 0.5), ball(DVec3::Z, 0.7, diffuse(0.4), 0.0)];
        let scene = hazy(surfaces, light(0.0));
        let emitters = emitters(&scene);
        let paths = LightPaths::new(scene.world(), &emitters, walk());
        let mut source = Seeded::new(5);
        let missing: Vec<f64> = (0..20_000)
            .map(|_| {
                let mut ledger = Ledger::empty();
                paths.trace(1.0, &mut ledger, &mut source, |_| {});
                assert_eq!(ledger.truncated, 0);
                ledger.emitted - ledger.absorbed - ledger.escaped
            })
            .collect();
        let n = missing.len() as f64;
        let mean = missing.iter().sum::<f64>() / n;
        let variance = missing.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
        // Five standard errors: false alarm 6e-7.
        assert!(variance > 0.0 && mean.abs() < 5.0 * (variance / n).sqrt(), "{mean}, variance {variance}");
    }
}
