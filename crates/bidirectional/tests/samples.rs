//! Single samples: their values per seed, and what they cost.

mod common;

use common::{Scene, bulb, forward, glass, mixed, sample, sky};
use fairflight_bidirectional::{Bidirectional, Exact, Subpath, Walking};
use fairflight_media::LineThickness;
use fairflight_paths::Heuristic;
use fairflight_sources::Seeded;
use fairflight_transmittance::Regular;

/// The sum of the samples of one stream, and the number of contributions that were found.
fn sum<M: LineThickness>(
    scene: &Scene<M>,
    (heuristic, samples, seed): (Heuristic, u32, u64),
    measured: impl Fn(&mut dyn FnMut()),
) -> (f64, u32) {
    let emitters = scene.emitters::<Regular>();
    let weigh = scene.weigh(&emitters, heuristic, Exact);
    let mut integrator = Bidirectional::new(weigh, Walking::new(scene.walk), Regular);
    let mut light = Subpath::empty();
    let (mut sum, mut found) = (0.0, 0);
    let mut run = || {
        (sum, found) = (0.0, 0);
        let mut source = Seeded::new(seed);
        for _ in 0..samples {
            sample(&mut integrator, &mut light, [0, 0], &mut source, |one, _, _| {
                sum += one.value;
                found += 1;
            });
        }
    };
    // Once, so that the buffers are as long as these paths.
    run();
    measured(&mut run);
    (sum, found)
}

#[test]
fn a_sample_allocates_nothing() {
    for heuristic in [Heuristic::Balance, Heuristic::Maximum] {
        let (_, found) = sum(&mixed(), (heuristic, 500, 1), |run| {
            let allocated = allocation_counter::measure(run);
            assert_eq!(allocated.count_total, 0);
        });
        assert!(found > 1000, "{found}");
    }
}

#[test]
fn golden_values() {
    let of = |seed| {
        let how = (Heuristic::Balance, 20, seed);
        let again = |run: &mut dyn FnMut()| run();
        [
            sum(&mixed(), how, again),
            sum(&glass(), how, again),
            sum(&sky(), how, again),
            sum(&forward(), how, again),
            sum(&bulb(), how, again),
        ]
    };
    let expected: [[(f64, u32); 5]; 2] = [
        [
            (3.07670645697808, 161),
            (2.9448899804274022, 87),
            (12.186089779588892, 78),
            (4.520902233868391, 378),
            (7.778137192157381, 429),
        ],
        [
            (3.992068580081467, 281),
            (3.2766417803436303, 81),
            (12.571860088231151, 120),
            (6.232102558928071, 386),
            (2.938308295428075, 251),
        ],
    ];
    for (seed, expected) in [1, 2].into_iter().zip(expected) {
        for (found, expected) in of(seed).into_iter().zip(expected) {
            assert_eq!(found.1, expected.1, "seed {seed}: {found:?}");
            assert!((found.0 / expected.0 - 1.0).abs() < 1e-12, "seed {seed}: {found:?}");
        }
    }
}
