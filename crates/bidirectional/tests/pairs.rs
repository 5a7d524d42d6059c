//! Any two strategies find the same light: E_a[w_a w_b C_a] = E_b[w_a w_b C_b], of paths of each length by themselves. The products
//! of weights are bounded where one strategy alone has no second moment.

mod common;

use common::{Scene, mixed, sample, sky};
use fairflight_bidirectional::laws::Path;
use fairflight_bidirectional::{Bidirectional, Exact, Subpath, Walking};
use fairflight_media::LineThickness;
use fairflight_paths::Heuristic;
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::{Moments, Reference, judge};
use fairflight_transmittance::Regular;

/// False alarm of one pair: 1e-3 for the 19 of either scene together.
const ALPHA: f64 = 2.6e-5;

/// Edges of the longest paths: 2, 3 and 4 have 3, 4 and 5 strategies.
const LONGEST: usize = 4;

/// [k − 2][t − 1][t' − 1].
type Products = [[[f64; LONGEST + 1]; LONGEST + 1]; LONGEST - 1];

/// One sample's w_a w_b C_a of all pairs. `splat` changes what the light image finds of a path: a mistake, or none.
fn products<M: LineThickness>(
    scene: &Scene<M>,
    samples: u64,
    seed: u64,
    splat: impl Fn(&Path<'_>) -> f64,
    mut each: impl FnMut(&Products),
) {
    let emitters = scene.emitters::<Regular>();
    let world = scene.world::<Regular>();
    let laws = scene.weigh::<Regular, _>(&emitters, Heuristic::Balance, Exact);
    let weigh = scene.weigh(&emitters, Heuristic::Balance, Exact);
    let mut integrator = Bidirectional::new(weigh, Walking::new(scene.walk), Regular);
    let (mut light, mut source) = (Subpath::empty(), Seeded::new(seed));
    for _ in 0..samples {
        let mut found_products = Products::default();
        sample(&mut integrator, &mut light, [0, 0], &mut source, |found, eye, light| {
            let (s, t) = (found.strategy.light as usize, found.strategy.eye as usize);
            let k = s + t - 1;
            if (2..=LONGEST).contains(&k) {
                let path = Path::of((&world, &emitters), &found, eye, light);
                let factor = if t == 1 { splat(&path) } else { 1.0 };
                let weights = laws.recursive(&path, |_, _, _| {});
                for (other, weight) in weights.iter().enumerate() {
                    found_products[k - 2][t - 1][other] += factor * found.value * weight;
                }
            }
        });
        each(&found_products);
    }
}

/// The pairs that disagree, and the number of pairs that could be judged.
fn disagreeing<M: LineThickness>(
    scene: &Scene<M>,
    (samples, seed): (u64, u64),
    splat: impl Fn(&Path<'_>) -> f64,
) -> (Vec<String>, usize) {
    let mut scales = Products::default();
    products(scene, samples / 4, derive_seed(seed, 1), &splat, |found| {
        for k in 0..LONGEST - 1 {
            for a in 0..=LONGEST {
                for b in 0..=LONGEST {
                    scales[k][a][b] += found[k][a][b] / (samples / 4) as f64;
                }
            }
        }
    });
    let pairs: Vec<[usize; 3]> = (0..LONGEST - 1)
        .flat_map(|k| (0..k + 3).flat_map(move |a| (a + 1..k + 3).map(move |b| [k, a, b])))
        .collect();
    let mut moments = vec![Moments::new(); pairs.len()];
    products(scene, samples, derive_seed(seed, 2), splat, |found| {
        for (moments, &[k, a, b]) in moments.iter_mut().zip(&pairs) {
            moments.push(scales[k][a][b] + found[k][a][b] - found[k][b][a]);
        }
    });
    let mut judged = 0;
    let mut wrong = Vec::new();
    for (moments, &[k, a, b]) in moments.iter().zip(&pairs) {
        let scale = scales[k][a][b];
        let verdict = judge(moments, &Reference::exact(scale).with_mild_tails(), ALPHA);
        let detectable = verdict.detectable_relative_bias.unwrap_or(f64::INFINITY);
        judged += usize::from(detectable < 0.35);
        if verdict.sound == Some(false) {
            wrong.push(format!("k = {}, t = {} and {}: {}", k + 2, a + 1, b + 1, verdict.reason));
        }
    }
    (wrong, judged)
}

fn agree<M: LineThickness>(scene: &Scene<M>, samples: u64, least: usize) {
    let (wrong, judged) = disagreeing(scene, (samples, 1), |_| 1.0);
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(judged >= least, "{judged}");
}

#[test]
fn pairs_of_strategies_with_mirrors_and_lamps() {
    agree(&mixed(), 30_000, 6);
}

#[test]
fn pairs_of_strategies_under_a_sky() {
    agree(&sky(), 60_000, 5);
}

#[test]
fn a_light_image_without_its_cosines_is_found() {
    // bdpt_no_cos3.
    let scene = mixed();
    let axis = scene.camera.ray([0, 0], [0.5, 0.5]).direction;
    let origin = scene.camera.origin();
    let cosine = |path: &Path<'_>| (path.places[0].position - origin).normalize().dot(axis);
    let (wrong, _) = disagreeing(&scene, (30_000, 1), |path| cosine(path).powi(3));
    assert!(wrong.iter().any(|pair| pair.contains("t = 1")), "{wrong:#?}");
}
