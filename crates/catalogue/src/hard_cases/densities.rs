//! Rows 16, 18 and 19 for paths that are joined from both ends: densities of forward peaks, of next to no distance, and of products
//! that no number holds.

use super::{HardCase, Outcome};
use crate::bidirectional::partition::by_hand;
use crate::bidirectional::scenes::{endless, mixed};
use fairflight_bidirectional::{Bidirectional, Exact, LightEnd, Site, Step, Subpath, Walking};
use fairflight_paths::Heuristic;
use fairflight_paths::transport::Light;
use fairflight_sources::Seeded;
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};

/// Rounding of sums of logarithms of a few thousand.
const GRANTED: f64 = 1e-12;
const TOLERANCE: &str = "1e-12";
const EXACT: &str = "weights sum to 1, each the one by all densities";
const WEIGHTS: &str = "weights of strategies";

fn weights(sigma_t: f64, g: f64, points: &[DVec3]) -> Outcome {
    let defects = by_hand(&endless(sigma_t, g), points);
    Outcome::said(defects.greatest() <= GRANTED, format!("off by {:.1e} at most", defects.greatest()))
}

/// Almost straight on from the camera, then a step of `near`, then back.
fn next_to(near: f64) -> [DVec3; 4] {
    let origin = endless(1.0, 0.0).camera.origin();
    let at = dvec3(0.2, 0.1, 0.4);
    [origin + dvec3(0.0, 0.3 * near, near), at, at + near * DVec3::Y, dvec3(0.3, 0.2, 0.9)]
}

/// A light path with one vertex at a distance from the first collision of a camera ray: finite contributions, none at distance 0.
fn connected(distance: f64) -> Outcome {
    let view = mixed();
    let emitters = view.emitters::<Regular>();
    let weigh = view.weigh::<Regular, _>(&emitters, Heuristic::Balance, Exact);
    let line = view.camera.ray([0, 0], [0.4, 0.6]);
    let walking = Walking::new(view.walk);
    let first = |seed: u64| {
        let mut eye = Subpath::empty();
        weigh.walk_from_eye(&walking, &line, &mut eye, &mut Seeded::new(seed));
        let place = eye.steps.first().map(|step| step.node.place)?;
        matches!(place.site, Site::Medium { .. }).then_some((seed, place.position))
    };
    let Some((seed, met)) = (0..100).find_map(first) else {
        return Outcome::said(false, "no collision");
    };
    // The lamp is the sixth surface.
    let end = LightEnd::new(&view.world::<Regular>(), &emitters, Light::Surface(5), dvec3(0.0, 0.95, 0.0));
    let place = weigh.place_in_medium(met + distance * DVec3::Y);
    let node = weigh.first_of_light(&end, place);
    let light =
        Subpath { steps: vec![Step { node, arriving: 1.0, scattered: 0.5 }], ..Subpath::<f64>::empty() };
    let mut integrator = Bidirectional::new(weigh, walking, Regular);
    let (mut joined, mut finite) = (0, true);
    integrator.strategies(&line, &light, &mut Seeded::new(seed), |_, found| {
        finite &= found.value.is_finite() && found.value >= 0.0;
        joined += u32::from(found.strategy.light == 2 && found.strategy.eye == 2);
    });
    Outcome::said(
        finite && joined == u32::from(distance > 0.0),
        format!("{joined} connections, finite: {finite}"),
    )
}

pub(super) fn cases() -> Vec<HardCase> {
    let mut cases = Vec::new();
    let mut exactly = |row, title: String, evaluate: Box<dyn Fn() -> Outcome + Send + Sync>| {
        cases.push(HardCase::deterministic(row, title, WEIGHTS, EXACT, TOLERANCE, evaluate));
    };
    for g in [0.999, 0.999_999, -0.999] {
        let of = move || weights(2.0, g, &next_to(1e-3));
        exactly(16, format!("a path whose scattering has g = {g}"), Box::new(of));
    }
    for near in [1e-6, 1e-9, 1e-12] {
        let of = move || weights(2.0, 0.3, &next_to(near));
        exactly(18, format!("a path with vertices {near:e} apart, and so near to the camera"), Box::new(of));
    }
    for edges in [3_u32, 17, 40] {
        let of = move || {
            let at = |i: u32| {
                let [i, odd, third] = [i, i % 2, i % 3].map(f64::from);
                dvec3(0.6 * i, 0.5 * odd, 0.62 * third - 1.3)
            };
            weights(50.0, 0.3, &(1..edges).map(at).collect::<Vec<_>>())
        };
        exactly(19, format!("{edges} edges of an optical thickness of 50 each"), Box::new(of));
    }
    for distance in [0.0, 1e-12, 1e-6] {
        cases.push(HardCase::deterministic(
            18,
            format!("a vertex of a light path {distance:e} from one of a camera path"),
            "bidirectional path tracing",
            "finite; none at distance 0",
            "finite",
            move || connected(distance),
        ));
    }
    cases.into_iter().map(|case| case.about(["bidirectional"])).collect()
}
