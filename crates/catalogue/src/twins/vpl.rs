//! Mistakes in compensation, in one compact loop of its own.
//!
//! The right loop passes the check that rejects the others, the law of [`Local`] with one step; z-values are measured. Estimates of
//! the right loop are bounded, which is what bounds the values that a sample can lack.

use super::trial::LAWFUL;
use super::{Evident, Rejection, Twin};
use crate::vpl::local::Local;
use crate::vpl::tiny;
use fairflight_collision::Version;
use fairflight_laws::{Run, measure};
use fairflight_media::Line;
use fairflight_paths::transport::{Lobe, Vertex};
use fairflight_paths::{Uniform, Walk};
use fairflight_scene::{Geometry, Source};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_stats::{Reference, Scores, judge};
use fairflight_transmittance::Regular;
use fairflight_vpl::{Connected, Term, Vpl};
use glam::{DVec3, dvec3};

/// Mistake of a twin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mistake {
    #[cfg(test)]
    None,
    /// One vertex with all lights, divided by their number.
    DividedByLights,
    /// Only virtual point lights shine on a compensation vertex.
    NoPrimaryLight,
    /// Virtual point lights count without a bound at a compensation vertex.
    UnboundedBehind,
    /// exp(−σs) for (e^{−σs} − e^{−σR})/(1 − e^{−σR}).
    SurfaceByFlight,
    /// The phase function alone where σ_s times it belongs.
    WithoutScattering,
    /// (1/r² − b)₊ r² for (G − b)₊/G.
    BoundAgainstDistance,
    /// σ e^{−σt} for eq. 4.
    Untruncated,
    /// Vertices lie behind surfaces too.
    BehindSurfaces,
    /// The light source leaves a virtual point light where it is.
    LightTwice,
}

/// 1-to-N with eq. 4 and the true transmittance: connections at y, and one compensation vertex.
fn estimate(scene: &Local, mistake: Mistake, source: &mut Seeded) -> f64 {
    let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).expect(LAWFUL));
    let mut gather = scene.gather(walk, Regular);
    let connections = gather.connected(&scene.y, Connected::All, source);
    let (y, bound) = (&scene.y, scene.bound);
    let direction = y.sample(&scene.volume.phase, source.next_uniform(), source.next_uniform());
    let radius = 1.0 / bound.sqrt();
    let hit = match mistake {
        Mistake::BehindSurfaces => None,
        _ => scene.surfaces.intersect(&y.leave(direction, radius)),
    };
    // eq. 4 and 5.
    let sigma_t = scene.sigma_t();
    let mass = 1.0 - (-sigma_t * radius).exp();
    let t = -(1.0 - source.next_uniform() * mass).ln() / sigma_t;
    let (x, weight) = match hit.filter(|hit| t >= hit.distance) {
        Some(hit) => {
            let (vertex, reflectance) = gather.world.diffuse_vertex(&hit).expect(LAWFUL);
            let passed = (-sigma_t * hit.distance).exp();
            let probability = match mistake {
                Mistake::SurfaceByFlight => passed,
                _ => (passed - (-sigma_t * radius).exp()) / mass,
            };
            (vertex, reflectance * passed / probability)
        }
        None => {
            let passed = (-sigma_t * t).exp();
            let pdf_distance = match mistake {
                Mistake::Untruncated => sigma_t * passed,
                _ => sigma_t * passed / mass,
            };
            let sigma_s = match mistake {
                Mistake::WithoutScattering => 1.0,
                _ => scene.volume.albedo * sigma_t,
            };
            let line = Line { origin: y.position, direction };
            let vertex = Vertex { position: line.at(t), lobe: Lobe::Phase { incident: direction } };
            (vertex, sigma_s * passed / pdf_distance)
        }
    };
    let squared = (x.position - y.position).length_squared();
    let geometric = match mistake {
        Mistake::BoundAgainstDistance => 1.0 / squared,
        _ => y.cosine(direction) * x.cosine(-direction) / squared,
    };
    let lost = 1.0 - bound / geometric;
    if lost.is_nan() || lost <= 0.0 {
        return connections;
    }
    if mistake == Mistake::UnboundedBehind {
        gather.term = Term::Bounded(f64::INFINITY);
    }
    let mut scattered = gather.connected(&x, Connected::All, source);
    if mistake == Mistake::DividedByLights {
        scattered /= scene.vpls.len() as f64;
    }
    let share = if mistake == Mistake::DividedByLights { 1.0 / scene.vpls.len() as f64 } else { 1.0 };
    if mistake != Mistake::NoPrimaryLight {
        scattered += share * gather.emitters(&x, source);
    }
    connections + weight * lost * scattered
}

/// The law of the right loop, whose estimates lie between 0 and C + 2 (C + E): C bounds the connections at a vertex, E what it gets of
/// the light sources. In the medium the vertex weighs a · mass ≤ 1. On a surface at the distance d < R it
/// weighs ρ mass (1 − b/G)/(1 − exp(−σ (R − d))) with 1 − b/G ≤ 1 − (d/R)² ≤ 2 (1 − d/R), and 1 − exp(−z) ≥ z mass/(σR) for
/// z ≤ σR: 2ρ at most.
fn right(scene: &Local) -> Reference {
    let (connections, emitters) = scene.greatest();
    let scores = Scores::Bounded { minimum: 0.0, maximum: connections + 2.0 * (connections + emitters) };
    Reference { scores, ..scene.reference() }
}

/// Judges the loop on a scene by the law of the right one.
fn tried(scene: &Local, mistake: Mistake, run: Run) -> Rejection {
    let reference = right(scene);
    let mut seen = scene.clone();
    if mistake == Mistake::LightTwice {
        let Some(&Source::Point { position, power }) = scene.lights.sources.first() else {
            return Rejection::exact(false, "no light to be counted twice");
        };
        // Even in all directions, as a point light is: the scene of this twin is isotropic.
        let lobe = Lobe::Phase { incident: DVec3::Z };
        let vertex = Vertex { position, lobe };
        seen.vpls.push(Vpl { vertex, incident: DVec3::Z, power, bounce: 0 });
    }
    let measured = match measure(run.seed, run.samples, |source| estimate(&seen, mistake, source)) {
        Ok(measured) => measured,
        Err(error) => return Rejection::exact(true, error.to_string()),
    };
    Rejection::of_mean(judge(&measured, &reference, run.alpha))
}

/// A second light below the floor: what lies there is bright.
fn lit_from_below() -> Local {
    let mut scene = tiny::near_floor(tiny::SIGMA_T);
    scene.lights.sources.push(Source::point(dvec3(0.3, 0.0, -0.7), 100.0).expect(LAWFUL));
    scene
}

/// One light just outside of the region, which compensation vertices come close to, but not too close.
fn beside() -> Local {
    let mut scene = tiny::medium(1);
    scene.vpls[0].vertex.position = dvec3(0.2, 0.1, 0.57);
    scene
}

/// Samples that the tails of the twins ask for.
const SAMPLES: u64 = 400_000;
const MORE: u64 = 900_000;

/// A medium so thin that the floor counts.
const THIN: f64 = 1.0;

/// A scene in words, and as it is.
type Described = (&'static str, fn() -> Local);

const TWO_LIGHTS: Described = ("two lights in a medium", || tiny::medium(2));

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    let twin = |id, text, ((profile, scene), mistake, z): (Described, Mistake, f64)| {
        let is_skewed =
            [Mistake::UnboundedBehind, Mistake::SurfaceByFlight, Mistake::BehindSurfaces].contains(&mistake);
        let samples = if is_skewed { MORE } else { SAMPLES };
        Twin::new("compensation", id, text, profile, (samples, Evident::Mean { z }), move |run| {
            tried(&scene(), mistake, run)
        })
        .about(["vpl"])
    };
    vec![
        twin(
            "vpl_divided_by_lights",
            "N-to-1 of engelhardt-2013's appendix called once per eye sample: divided by the number of lights",
            (TWO_LIGHTS, Mistake::DividedByLights, 657.4),
        ),
        twin(
            "vpl_no_primary_light",
            "compensation vertices gather virtual point lights and no light source (engelhardt-2013, appendix A)",
            (TWO_LIGHTS, Mistake::NoPrimaryLight, 1038.3),
        ),
        twin(
            "vpl_unbounded_behind",
            "compensation vertices gather virtual point lights without the bound",
            (("a light beside the region of a point in a medium", beside), Mistake::UnboundedBehind, 59.9),
        ),
        twin(
            "vpl_surface_by_free_flight",
            "a surface before the end of eq. 4 with the probability exp(-sigma s) of a free flight",
            (
                ("a thin medium and lights on a floor and in it", || tiny::near_floor(THIN)),
                Mistake::SurfaceByFlight,
                277.3,
            ),
        ),
        twin(
            "vpl_without_sigma_s",
            "the phase function without sigma_s at compensation vertices (engelhardt-2013, appendix A)",
            (TWO_LIGHTS, Mistake::WithoutScattering, 1711.3),
        ),
        twin(
            "vpl_bound_against_distance",
            "b compared with 1/r^2 where G has cosines",
            (("a floor and lights in a medium", tiny::above_floor), Mistake::BoundAgainstDistance, 98.4),
        ),
        twin(
            "vpl_untruncated_density",
            "distances by eq. 5, their density without the truncation of eq. 4",
            (TWO_LIGHTS, Mistake::Untruncated, 90.4),
        ),
        twin(
            "vpl_behind_surfaces",
            "compensation vertices behind a surface, which they do not see",
            (
                ("a floor lit from both sides, lights on it and above", lit_from_below),
                Mistake::BehindSurfaces,
                236.6,
            ),
        ),
        twin(
            "vpl_light_source_twice",
            "light sources leave virtual point lights where they are, and are seen by next-event estimation as well",
            (("two lights in an isotropic medium", || tiny::isotropic(2)), Mistake::LightTwice, 665.7),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_right_loop_passes_the_check_that_rejects_the_wrong_ones() {
        let scenes: [fn() -> Local; 6] = [
            || tiny::medium(2),
            beside,
            || tiny::near_floor(THIN),
            tiny::above_floor,
            lit_from_below,
            || tiny::isotropic(2),
        ];
        for (index, scene) in scenes.iter().enumerate() {
            let run = Run { samples: MORE, seed: index as u64, alpha: 1e-9 };
            let scene = scene();
            let measured = measure(run.seed, run.samples, |source| estimate(&scene, Mistake::None, source));
            let verdict = judge(&measured.unwrap(), &right(&scene), run.alpha);
            assert_eq!(verdict.sound, Some(true), "{index}: {verdict:?}");
        }
    }
}
