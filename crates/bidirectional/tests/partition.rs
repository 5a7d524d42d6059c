//! Weights of every path that any strategy finds: each is the one by all densities, and together they are one. A mistake that no
//! mean shows, shows here.

mod common;

use common::{ALL, Scene, bulb, defects, forward, glass, mixed, sky};
use fairflight_bidirectional::laws::{Path, Side};
use fairflight_bidirectional::{Exact, LightEnd, Midpoint, Neglected, Node, Place, Site, WeightThickness};
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, Homogeneous, LineThickness};
use fairflight_paths::Heuristic;
use fairflight_paths::transport::Light;
use fairflight_sources::Seeded;
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};
use std::collections::BTreeSet;
use std::num::NonZeroU32;

/// Rounding of sums of logarithms of a few hundred, relative to each weight.
const EXACT: f64 = 1e-12;

fn right(_: Side, _: usize, _: &mut Node) {}

fn check<M: LineThickness, K: WeightThickness<M> + Copy>(
    (name, scene): (&str, &Scene<M>),
    how: (Heuristic, K),
    samples: u32,
) {
    let found = defects(scene, how, samples, right);
    assert!(found.paths > 300, "{name}: {found:?}");
    // What the integrator used, what the path says, and what all densities say.
    for defect in [found.walked, found.direct, found.sum] {
        assert!(defect < EXACT, "{name} {:?}: {found:?}", how.0);
    }
}

#[test]
fn weights_are_those_by_all_densities_and_sum_to_one() {
    for heuristic in ALL {
        let how = (heuristic, Exact);
        check(("mixed", &mixed()), how, 100);
        check(("glass", &glass()), how, 100);
        check(("sky", &sky()), how, 400);
        check(("forward", &forward()), how, 100);
        check(("bulb", &bulb()), how, 100);
        // Four light paths for four pixels.
        check(("four pixels", &mixed().in_pixels([2, 2])), how, 100);
    }
}

#[test]
fn without_a_light_image_its_strategies_weigh_nothing() {
    for heuristic in ALL {
        for (name, scene) in [("mixed", mixed()), ("bulb", bulb())] {
            check((name, &Scene { light_paths_per_pixel: 0.0, ..scene }), (heuristic, Exact), 100);
        }
    }
}

#[test]
fn any_thickness_will_do() {
    let nodes = |n| Midpoint(NonZeroU32::new(n).unwrap());
    check(("one node", &glass()), (Heuristic::Balance, nodes(1)), 100);
    check(("four nodes", &glass()), (Heuristic::Power, nodes(4)), 100);
    check(("neglected", &glass()), (Heuristic::Balance, Neglected), 100);
}

/// The greatest defects of a path made by hand.
fn by_hand(scene: &Scene<Homogeneous>, places: &[Place], light: Light, at: DVec3) -> f64 {
    let emitters = scene.emitters::<Regular>();
    let end = LightEnd::new(&scene.world::<Regular>(), &emitters, light, at);
    let path = Path { places: places.to_vec(), end };
    let mut worst = 0.0f64;
    for heuristic in ALL {
        let weigh = scene.weigh::<Regular, _>(&emitters, heuristic, Exact);
        let (recursive, direct) = (weigh.recursive(&path, right), weigh.direct(&path));
        let sum: f64 = recursive.iter().sum();
        worst = worst.max((sum - 1.0).abs());
        for (a, b) in recursive.iter().zip(&direct) {
            worst = worst.max((a - b).abs() / b.max(1e-100));
        }
    }
    worst
}

/// In a medium of this extinction and phase function, with the point light of the other scene.
fn thick(sigma_t: f64, g: f64) -> Scene<Homogeneous> {
    let mut scene = forward();
    scene.volume.medium = Homogeneous::new(sigma_t).unwrap();
    scene.volume.bounds = Bounds::aligned_box(DVec3::splat(-90.0), DVec3::splat(90.0)).unwrap();
    scene.volume.phase = HenyeyGreenstein::new(g).unwrap();
    scene
}

fn in_medium(scene: &Scene<Homogeneous>, position: DVec3) -> Place {
    let emitters = scene.emitters::<Regular>();
    scene.weigh::<Regular, _>(&emitters, Heuristic::Balance, Exact).place_in_medium(position)
}

#[test]
fn forty_edges_of_an_optical_thickness_of_fifty_each() {
    // No product of their transmittances is a number.
    let scene = thick(50.0, 0.3);
    for edges in [3u32, 17, 40] {
        let at = |i: u32| dvec3(0.6 * f64::from(i), 0.5 * f64::from(i % 2), 0.62 * f64::from(i % 3) - 1.3);
        let places: Vec<Place> = (1..edges).map(|i| in_medium(&scene, at(i))).collect();
        let worst = by_hand(&scene, &places, Light::Source(0), DVec3::ZERO);
        assert!(worst < EXACT, "{edges}: {worst:e}");
    }
}

#[test]
fn forward_peaks_and_near_vertices() {
    for g in [0.999, 0.999_999, -0.999] {
        let scene = thick(2.0, g);
        let origin = scene.camera.origin();
        // Almost straight on, then back; and vertices as near to the camera and to each other as positions can say.
        for near in [1e-3, 1e-6, 1e-9, 1e-12] {
            let at = [
                origin + dvec3(0.0, 0.3 * near, near),
                dvec3(0.2, 0.1, 0.4),
                dvec3(0.2, 0.1 + near, 0.4),
                dvec3(0.3, 0.2, 0.9),
            ];
            let places = at.map(|position| in_medium(&scene, position));
            let worst = by_hand(&scene, &places, Light::Source(0), DVec3::ZERO);
            assert!(worst < EXACT, "{g}, {near:e}: {worst:e}");
        }
    }
}

#[test]
fn light_paths_start_with_the_density_that_weights_have() {
    fn starts(scene: &Scene<Homogeneous>) -> usize {
        let emitters = scene.emitters::<Regular>();
        let weigh = scene.weigh::<Regular, _>(&emitters, Heuristic::Balance, Exact);
        let mut source = Seeded::new(3);
        let mut seen = BTreeSet::new();
        for _ in 0..500 {
            let start = emitters.sample(&scene.lights, &scene.surfaces, &mut source).unwrap();
            let pdf = weigh.end_of(&start).pdf_start();
            assert!((pdf / start.pdf - 1.0).abs() < 1e-12, "{start:?}: {pdf}");
            seen.insert(format!("{:?}", start.light));
        }
        seen.len()
    }
    // A constant, a map, a direction and a point; two lamps; a lamp and a globe that glows.
    assert_eq!([starts(&sky()), starts(&mixed()), starts(&bulb())], [4, 2, 2]);
}

#[test]
fn surrogates_of_densities_are_lawful() {
    // Without the extinction at a collision, without survival, without transmittance: other densities, and still one.
    let scene = forward();
    let emitters = scene.emitters::<Regular>();
    let weigh = scene.weigh::<Regular, _>(&emitters, Heuristic::Balance, Neglected);
    let at = [dvec3(0.1, -0.2, 0.0), dvec3(0.4, 0.1, 0.3), dvec3(-0.3, 0.4, 0.5), dvec3(0.0, 0.2, -0.4)];
    let change: [fn(&mut Place); 3] =
        [|_| {}, |place| place.site = Site::Medium { sigma_t: 1.0 }, |place| place.survival = 1.0];
    let weights = change.map(|change| {
        let mut places: Vec<Place> = at.map(|position| in_medium(&scene, position)).to_vec();
        places.iter_mut().for_each(change);
        let end =
            LightEnd::new(&scene.world::<Regular>(), &emitters, Light::Surface(5), dvec3(0.3, 0.9, 0.1));
        let weights = weigh.recursive(&Path { places, end }, right);
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < EXACT);
        weights
    });
    assert!(weights[0] != weights[1] && weights[0] != weights[2]);
}

#[test]
fn the_law_rejects_a_weight_without_next_event_estimation_of_light_paths() {
    // chi_1 = 1 where it is P_dir/P_sub.
    let twin = |side: Side, index: usize, node: &mut Node| {
        if (side, index) == (Side::Light, 0) && node.ln_connectable.is_finite() {
            node.ln_connectable = 0.0;
        }
    };
    rejects("bdpt_light_without_direct", &mixed(), twin, 1e-2);
}

#[test]
fn the_law_rejects_the_edge_before() {
    // The printed algorithms 2 and 3 of antwerpen-2011 have G of the edge before the one that is drawn backwards.
    let mut before = [0.0; 2];
    let twin = move |side: Side, index: usize, node: &mut Node| {
        let last = std::mem::replace(&mut before[side as usize], node.ln_geometry);
        if index > 0 && last.is_finite() {
            node.ln_geometry = last;
        }
    };
    rejects("bdpt_previous_edge", &mixed(), twin, 1e-2);
}

#[test]
fn the_law_rejects_strategies_through_mirrors() {
    let twin = |_: Side, index: usize, node: &mut Node| {
        if index > 0 && node.ln_connectable == f64::NEG_INFINITY {
            node.ln_connectable = 0.0;
        }
    };
    rejects("bdpt_through_mirrors", &mixed(), twin, 1e-4);
}

#[test]
fn the_law_rejects_a_zero_that_is_taken_for_one() {
    // What ends at the pinhole, or on a point light by chance, has the density 0.
    let twin = |_: Side, _: usize, node: &mut Node| {
        if node.ln_before == f64::NEG_INFINITY {
            node.ln_before = 0.0;
            node.ln_geometry = node.ln_geometry.max(0.0);
        }
    };
    rejects("bdpt_zero_is_one", &glass(), twin, 1e-4);
}

#[test]
fn the_law_rejects_an_inverted_camera() {
    // The Jacobian of antwerpen-2011 eq. 3.18 as it is printed, for the eye subpath.
    let scene = mixed();
    let camera = scene.camera;
    let twin = |side: Side, index: usize, node: &mut Node| {
        if (side, index) == (Side::Eye, 0) {
            node.ln_forward -= 2.0 * camera.importance(node.place.position).ln();
        }
    };
    rejects("bdpt_inverted_camera", &scene, twin, 1e-2);
}

#[test]
fn the_law_rejects_a_forgotten_number_of_light_paths() {
    let scene = mixed().in_pixels([4, 4]);
    let twin = |side: Side, index: usize, node: &mut Node| {
        if (side, index) == (Side::Eye, 0) && node.place.is_connectable() {
            node.ln_connectable = 0.0;
        }
    };
    rejects("bdpt_pixel_count", &scene, twin, 1e-3);
}

/// A mistake whose sums are off by at least so much on average.
fn rejects<M: LineThickness>(
    name: &str,
    scene: &Scene<M>,
    twin: impl FnMut(Side, usize, &mut Node),
    least: f64,
) {
    let found = defects(scene, (Heuristic::Balance, Exact), 300, twin);
    assert!(found.mean() > least, "{name}: {found:?}");
}
