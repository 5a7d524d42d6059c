//! Bidirectional path tracing: weights of every path, pairs of strategies, and its expectation.

use super::paths::{LAWFUL, result};
use super::{Check, Law};
use crate::bidirectional::means::{self, Options};
use crate::bidirectional::partition::{Change, HEURISTICS, defects};
use crate::bidirectional::scenes::{
    bulb, forward, glowing, haze_in_the_sun, lit_by_a_point, mixed, sky, uneven,
};
use crate::bidirectional::{View, pairs};
use fairflight_bidirectional::{Exact, Midpoint, Neglected, Place, Site, WeightThickness};
use fairflight_laws::exact::{agree, greatest};
use fairflight_laws::{CheckResult, Run};
use fairflight_media::{LineThickness, Medium};
use fairflight_paths::{Heuristic, Ratio, RayTransmittance, Uniform};
use fairflight_sources::derive_seed;
use fairflight_transmittance::Regular;
use std::num::NonZeroU32;

const KIND: &str = "bidirectional path tracing";

/// Rounding of sums of logarithms of a few hundred, relative to each weight.
const GRANTED: f64 = 1e-11;

/// Samples of an exact check, whose paths are drawn: the law holds for each.
const DRAWN: u32 = 100;

/// Checks of weights, pairs, expectations and the light image.
pub(super) fn checks() -> Vec<Check> {
    let mut checks = partitions();
    checks.push(paired("lamps and a mirror", mixed, &[(2, 1, 2), (3, 1, 3)], 130_000));
    checks.push(paired("glass, a lamp and a point light", uneven, &[(2, 1, 2), (3, 2, 3)], 130_000));
    checks.extend(expectations());
    checks.push(of(Law::Adjoint, "adjoint/directional", "eq21", 150_000, |run| {
        means::light_image(&haze_in_the_sun(), run)
            .unwrap_or_else(|error| CheckResult::exact(false, error.to_string()))
    }));
    checks.into_iter().map(|check| check.about(["bidirectional"])).collect()
}

fn of(
    law: Law,
    name: &str,
    medium: &str,
    samples: u64,
    function: impl Fn(Run) -> CheckResult + Send + Sync + 'static,
) -> Check {
    Check::new(format!("bidirectional/{name}"), law, KIND, medium, samples, function)
}

fn partition<M: LineThickness + 'static, K: WeightThickness<M> + Clone + Send + Sync + 'static>(
    name: &str,
    view: fn() -> View<M>,
    thickness: K,
    change: Change<'static>,
) -> Check {
    let medium = name.to_owned();
    of(Law::Partition, &format!("partition/{name}"), &medium, 0, move |run| {
        let by = |(index, heuristic): (usize, Heuristic)| {
            let drawn = (DRAWN, derive_seed(run.seed, index as u64));
            defects(&view(), (heuristic, thickness.clone()), drawn, change).greatest()
        };
        agree(greatest(HEURISTICS.into_iter().enumerate().map(by)), GRANTED)
    })
}

/// Weights of all paths by three heuristics, in scenes with every kind of light; and with surrogates of densities that look wrong and are
/// lawful: a density of collisions without the extinction, a subpath that is never absorbed, nothing between vertices.
fn partitions() -> Vec<Check> {
    const WITHOUT_EXTINCTION: &(dyn Fn(&mut Place) + Send + Sync) = &|place| {
        if let Site::Medium { sigma_t } = &mut place.site {
            *sigma_t = 1.0;
        }
    };
    const WITHOUT_ABSORPTION: &(dyn Fn(&mut Place) + Send + Sync) = &|place| place.survival = 1.0;
    let four = Midpoint(NonZeroU32::new(4).expect(LAWFUL));
    let nothing = Change::Nothing;
    vec![
        partition("lamps and a mirror", mixed, Exact, nothing),
        partition("four pixels", || mixed().in_pixels([2, 2]), Exact, nothing),
        partition("glass, a lamp and a point light", uneven, Exact, nothing),
        partition("sky", sky, Exact, nothing),
        partition("forward scattering", forward, Exact, nothing),
        partition("a lamp in glass", bulb, Exact, nothing),
        partition("four nodes", uneven, four, nothing),
        partition("nothing between vertices", uneven, Neglected, nothing),
        partition("without the extinction", mixed, Exact, Change::Places(WITHOUT_EXTINCTION)),
        partition("without absorption", mixed, Exact, Change::Places(WITHOUT_ABSORPTION)),
    ]
}

fn paired<M: LineThickness + 'static>(
    name: &str,
    view: fn() -> View<M>,
    of_lengths: &'static [pairs::Pair],
    samples: u64,
) -> Check {
    of(Law::Pair, &format!("pairs/{name}"), name, samples, move |run| {
        pairs::check(&view(), of_lengths, &|_| 1.0, run)
    })
}

fn usual() -> Options<Exact, Regular> {
    let heuristic = Heuristic::Balance;
    Options { heuristic, thickness: Exact, shadow: Regular, roulette: None, light_paths: 1 }
}

fn equal<
    M: Medium + 'static,
    K: WeightThickness<M> + Clone + Send + Sync + 'static,
    T: RayTransmittance<M> + Clone + Send + Sync + 'static,
>(
    name: &str,
    view: fn() -> View<M>,
    options: Options<K, T>,
    samples: u64,
) -> Check {
    of(Law::Radiance, &format!("paths/{name}"), name, samples, move |run| {
        result(&means::against_paths(&view(), &options, run), run)
    })
    .about(["path_tracer"])
}

fn expectations() -> Vec<Check> {
    let two = Midpoint(NonZeroU32::new(2).expect(LAWFUL));
    let ratio = Options {
        thickness: two,
        shadow: Ratio(Uniform::new(0.8).expect(LAWFUL)),
        heuristic: Heuristic::Power,
        roulette: None,
        light_paths: 1,
    };
    let roulette = Options { roulette: Some(0.05), heuristic: Heuristic::Maximum, ..usual() };
    let mut checks = vec![
        equal("lamps and a mirror", mixed, usual(), 140_000),
        equal("glass by ratio tracking, power", uneven, ratio, 60_000),
        equal("sky by roulette, maximum", sky, roulette, 40_000),
        equal("sky, two light paths", sky, Options { light_paths: 2, ..usual() }, 30_000),
        equal("sky, no light image", sky, Options { light_paths: 0, ..usual() }, 20_000),
        of(Law::Radiance, "furnace", "a ball that glows", 350_000, |run| {
            result(&means::furnace(&glowing(), &usual(), 1.0, run), run)
        }),
    ];
    for vertices in [1, 2, 3] {
        let name = format!("lengths/{vertices} vertices at most");
        let check = of(Law::Radiance, &name, "a floor in haze", 80_000, move |run| {
            result(&means::up_to(&lit_by_a_point(), &usual(), vertices, run), run)
        });
        checks.push(check.about(["path_tracer"]));
    }
    checks
}
