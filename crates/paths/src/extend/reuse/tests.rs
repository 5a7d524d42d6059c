//! Laws of path re-use: each pixel of any group has the expectation of the path tracer; what is not the density of the group is rejected.

use super::*;
use crate::transport::fixtures::{Scene, ball, diffuse, hazy, square, vacuum};
use crate::{PathTracer, Uniform};
use fairflight_media::{EmptySpace, Homogeneous};
use fairflight_scene::{EnvironmentMap, Material, Source};
use fairflight_sources::{Scripted, Seeded, derive_seed};
use fairflight_stats::{Moments, Reference, Verdict, judge};
use fairflight_transmittance::Regular;
use glam::dvec3;
use std::f64::consts::{FRAC_1_PI, PI};

const SEEDS: std::ops::Range<u64> = 1..2;

/// False alarm of one check; there are about fifty.
const ALPHA: f64 = 1e-4;

fn walk(sigma_samp: f64) -> Walk<Uniform> {
    Walk::new(Version::NonTerminating, Uniform::new(sigma_samp).unwrap())
}

/// Floor, lid, a lamp that reflects, a round one, a mirror and glass in haze under a sky of a constant and a map.
fn court() -> Scene<Homogeneous> {
    let surfaces = vec![
        square(0.0, 2.0, diffuse(0.7), 0.0),
        square(2.0, 0.7, diffuse(0.4), 1.5),
        square(2.5, 3.0, diffuse(0.5), 0.0),
        ball(dvec3(0.0, 2.2, 0.8), 1.0, diffuse(0.15), 0.0),
        ball(dvec3(-1.2, -0.6, 0.5), 0.4, Material::Mirror, 0.0),
        ball(dvec3(1.0, -0.8, 0.5), 0.3, Material::Dielectric { ior: 1.5 }, 0.0),
        ball(dvec3(0.1, -0.9, 1.2), 0.2, diffuse(0.2), 1.0),
    ];
    let mut scene = hazy(0.4, surfaces, vec![Source::directional(dvec3(0.5, 0.8, -0.4), 0.3).unwrap()]);
    scene.lights.background.constant = 0.4;
    scene.lights.background.maps.push(EnvironmentMap::new(2, 2, vec![0.5, 1.0, 0.2, 0.1]).unwrap());
    scene
}

/// Rays to the floor, to the round wall, into the mirror, into the glass and into the haze alone.
fn lines(count: usize) -> Vec<Line> {
    let towards = [
        dvec3(0.3, 0.4, 0.0),
        dvec3(-0.5, 0.1, 0.0),
        dvec3(0.0, 1.2, 0.7),
        dvec3(-1.0, -0.6, 0.5),
        dvec3(0.9, -0.8, 0.5),
        dvec3(0.2, -0.3, 0.0),
        dvec3(0.5, -5.0, 2.2),
        dvec3(-0.2, 0.6, 0.0),
    ];
    let origin = dvec3(0.1, -1.5, 1.4);
    towards[..count].iter().map(|point| Line { origin, direction: (*point - origin).normalize() }).collect()
}

/// Samples of the constant that is added to a difference so that power can be told as a relative bias.
const PILOT: u32 = 5_000;

/// Verdicts of each pixel: a group's estimate less that of a path tracer, of which the means agree, with the mean of the latter added.
fn verdicts<W: Types<Spectrum = f64, Medium: LineThickness>>(
    (mut reuse, mut plain): (PathReuse<'_, W>, PathTracer<'_, W>),
    lines: &[Line],
    density: impl Fn(Factors) -> f64,
    (samples, seed): (u32, u64),
) -> Vec<Verdict> {
    let [mut source, mut other, mut pilot] = [1, 2, 3].map(|stream| Seeded::new(derive_seed(seed, stream)));
    let scales: Vec<f64> = lines
        .iter()
        .map(|line| (0..PILOT).map(|_| plain.radiance(line, &mut pilot)).sum::<f64>() / f64::from(PILOT))
        .collect();
    let mut moments = vec![Moments::new(); lines.len()];
    let mut radiances = vec![0.0; lines.len()];
    for _ in 0..samples {
        reuse.radiances_by(lines, &mut radiances, &density, &mut source);
        for (pixel, moments) in moments.iter_mut().enumerate() {
            moments.push(scales[pixel] + radiances[pixel] - plain.radiance(&lines[pixel], &mut other));
        }
    }
    assert_eq!((reuse.truncated(), reuse.unlawful()), (0, 0));
    let judged = moments
        .iter()
        .zip(&scales)
        .map(|(moments, &scale)| judge(moments, &Reference::exact(scale).with_mild_tails(), ALPHA));
    judged.collect()
}

/// The court by a group of so many pixels.
fn in_court(count: usize, density: impl Fn(Factors) -> f64, run: (u32, u64)) -> Vec<Verdict> {
    let scene = court();
    let reuse = PathReuse::new(scene.world(), walk(0.5), Regular, Heuristic::Balance);
    let plain = PathTracer::new(scene.world(), walk(0.5), Regular, Heuristic::Balance);
    verdicts((reuse, plain), &lines(count), density, run)
}

#[test]
fn any_group_has_the_expectation_of_the_path_tracer() {
    for seed in SEEDS {
        for (count, samples) in [(1, 60_000), (3, 60_000), (8, 60_000)] {
            let found = in_court(count, Factors::density, (samples, seed));
            assert_eq!(found.len(), count);
            for Verdict { sound, reason, .. } in found {
                assert_eq!(sound, Some(true), "{count} pixels, seed {seed}: {reason}");
            }
        }
    }
}

#[test]
fn twins_are_rejected() {
    type Twin = fn(Factors) -> f64;
    let twins: [(&str, Twin); 4] = [
        // reuse_receiver: each pixel counts by its own density, over their number.
        ("receiver", |_| 1.0),
        // reuse_no_t.
        ("transmittance", |factors| factors.density() / factors.transmittance),
        ("Jacobian", |factors| factors.density() / factors.geometric),
        ("direction", |factors| factors.density() / factors.scattered),
    ];
    for seed in SEEDS {
        for (name, twin) in twins {
            let found = in_court(8, twin, (100_000, seed));
            let is_rejected = found.iter().any(|verdict| verdict.sound == Some(false));
            assert!(is_rejected, "{name}, seed {seed}: {found:?}");
        }
    }
}

/// A dark plate on a bright floor under an even sky of radiance 1, in a group of a pixel on either: each reflects its reflectance, but for
/// the square of a millionth of the sky that the plate hides.
fn on_dark_and_bright(density: impl Fn(Factors) -> f64, seed: u64) -> [Verdict; 2] {
    let reflectances = [0.1, 0.9];
    let [dark, bright] = reflectances.map(diffuse);
    let mut scene: Scene<EmptySpace> =
        vacuum(vec![square(0.0, 5.0, bright, 0.0), square(1e-6, 0.5, dark, 0.0)], vec![]);
    scene.lights.background.constant = 1.0;
    let lines = [0.3, 0.7].map(|x| Line { origin: dvec3(x, 0.0, 1.0), direction: DVec3::NEG_Z });
    let mut reuse = PathReuse::new(scene.world(), walk(1.0), Regular, Heuristic::Balance);
    let (mut source, mut radiances) = (Seeded::new(derive_seed(seed, 6)), [0.0; 2]);
    let mut moments = [Moments::new(); 2];
    for _ in 0..100_000 {
        reuse.radiances_by(&lines, &mut radiances, &density, &mut source);
        moments.iter_mut().zip(radiances).for_each(|(moments, radiance)| moments.push(radiance));
    }
    [0, 1]
        .map(|pixel| judge(&moments[pixel], &Reference::exact(reflectances[pixel]).with_mild_tails(), ALPHA))
}

#[test]
fn survival_belongs_to_the_density() {
    for seed in SEEDS {
        for Verdict { sound, reason, .. } in on_dark_and_bright(Factors::density, seed) {
            assert_eq!(sound, Some(true), "seed {seed}: {reason}");
        }
        // Each has the mean of both survivals over its own too much.
        for Verdict { sound, reason, .. } in
            on_dark_and_bright(|factors| factors.density() / factors.survival, seed)
        {
            assert_eq!(sound, Some(false), "seed {seed}: {reason}");
        }
    }
}

/// A hollow ball that glows and reflects, 1 in sum, a lamp and a mirror in it, with haze that absorbs nothing: 1 everywhere.
#[test]
fn a_furnace_is_equally_bright() {
    let surfaces = vec![
        ball(DVec3::ZERO, 1.0, diffuse(0.6), 0.4),
        ball(dvec3(0.4, 0.2, 0.3), 0.2, Material::Mirror, 0.0),
        ball(dvec3(-0.2, 0.4, 0.4), 0.25, diffuse(0.2), 0.8),
    ];
    let mut scene = hazy(0.8, surfaces, vec![]);
    scene.volume.albedo = 1.0;
    let lines: Vec<Line> = [DVec3::X, dvec3(0.4, 0.2, 0.4), dvec3(-0.2, 0.3, 0.4), DVec3::NEG_Z]
        .map(|towards| Line { origin: DVec3::ZERO, direction: towards.normalize() })
        .to_vec();
    let mut reuse = PathReuse::new(scene.world(), walk(0.8), Regular, Heuristic::Power);
    for seed in SEEDS {
        let (mut source, mut radiances) = (Seeded::new(derive_seed(seed, 4)), [0.0; 4]);
        let mut moments = [Moments::new(); 4];
        for _ in 0..120_000 {
            reuse.radiances(&lines, &mut radiances, &mut source);
            moments.iter_mut().zip(radiances).for_each(|(moments, radiance)| moments.push(radiance));
        }
        for moments in &moments {
            let verdict = judge(moments, &Reference::exact(1.0).with_mild_tails(), ALPHA);
            assert_eq!(verdict.sound, Some(true), "{}", verdict.reason);
        }
    }
}

/// The part of the light of a square lamp of radiance 1 and half width 1 at the height 2, that a point (x, y) of the floor receives (Lambert):
/// irradiance/π.
fn received(x: f64, y: f64) -> f64 {
    let corner = |a: f64, b: f64| {
        let (p, q) = (a.hypot(2.0), b.hypot(2.0));
        (a / p * (b / p).atan() + b / q * (a / q).atan()) / (2.0 * PI)
    };
    let along = |b: f64| corner(1.0 - x, b) - corner(-1.0 - x, b);
    along(1.0 - y) - along(-1.0 - y)
}

#[test]
fn a_lamp_on_a_floor_is_its_form_factor_in_every_pixel() {
    let scene: Scene<EmptySpace> =
        vacuum(vec![square(0.0, 9.0, diffuse(0.5), 0.0), square(2.0, 1.0, diffuse(0.0), 1.0)], vec![]);
    let points = [[0.0, 0.0], [0.8, 0.1], [-1.5, 0.6], [0.3, 2.0]];
    let lines = points.map(|[x, y]| {
        let offset = dvec3(0.3, 0.0, 1.0);
        Line { origin: dvec3(x, y, 0.0) + offset, direction: -offset.normalize() }
    });
    for (seed, heuristic) in
        SEEDS.flat_map(|seed| [Heuristic::Balance, Heuristic::Maximum].map(|heuristic| (seed, heuristic)))
    {
        let mut reuse = PathReuse::new(scene.world(), walk(1.0), Regular, heuristic);
        let (mut source, mut radiances) = (Seeded::new(derive_seed(seed, 5)), [0.0; 4]);
        let mut moments = [Moments::new(); 4];
        for _ in 0..60_000 {
            reuse.radiances(&lines, &mut radiances, &mut source);
            moments.iter_mut().zip(radiances).for_each(|(moments, radiance)| moments.push(radiance));
        }
        for ([x, y], moments) in points.into_iter().zip(&moments) {
            let expected = Reference::exact(0.5 * received(x, y)).with_mild_tails();
            let verdict = judge(moments, &expected, ALPHA);
            assert_eq!(verdict.sound, Some(true), "{heuristic:?}: {}", verdict.reason);
        }
    }
}

#[test]
fn a_tail_of_two_pixels_by_hand() {
    // Two points of a floor, 2 apart, below a lid that glows 3 and reflects nothing; the first one's path meets it straight above, at the
    // height 2; the second one's is lost at roulette.
    let scene: Scene<EmptySpace> =
        vacuum(vec![square(0.0, 5.0, diffuse(0.5), 0.0), square(2.0, 0.5, diffuse(0.0), 3.0)], vec![]);
    let down = |x: f64| Line { origin: dvec3(x, 0.0, 1.0), direction: DVec3::NEG_Z };
    let mut reuse = PathReuse::new(scene.world(), walk(1.0), Regular, Heuristic::Balance);
    // Light points of both (behind whose direction the weights do not fall out), roulette and direction; roulette of what is met and of the other.
    let mut source = Scripted::new([0.5, 0.5, 0.5, 0.5, 0.49, 0.0, 0.0, 0.0, 0.5]);
    let mut found = [0.0; 2];
    reuse.radiances(&[down(0.0), down(2.0)], &mut found, &mut source);
    assert_eq!(source.remaining(), 0);
    // Densities of the point above: cosines and distances 1, 2 and √½, √8; the lamp's is distance²/cosine.
    let densities = [FRAC_1_PI / 4.0, FRAC_1_PI * 0.5 / 8.0];
    let whole: f64 = densities.iter().sum();
    for (found, density, scattered, lamp) in [
        (found[0], densities[0], FRAC_1_PI, 4.0),
        (found[1], densities[1], FRAC_1_PI * 0.5f64.sqrt(), 8.0 * 2f64.sqrt()),
    ] {
        let lit = 0.5 * 3.0 * scattered / (lamp + scattered);
        let met = 3.0 * scattered / (scattered + lamp) * density / whole;
        assert!((found - lit - met).abs() < 1e-14, "{found} {lit} {met}");
    }
}

#[test]
fn what_is_looked_up_too_seldom_is_counted() {
    let scene = hazy(1.0, vec![], vec![]);
    let world = scene.world();
    let line = Line { origin: DVec3::ZERO, direction: DVec3::X };
    for (rate, is_lawful) in [(1.0, true), (1.7, true), (0.9, false)] {
        let mut reuse = PathReuse::new(world, walk(rate), Regular, Heuristic::Balance);
        let mut source = Seeded::new(1);
        for _ in 0..100 {
            reuse.radiance(&line, &mut source);
        }
        assert_eq!(reuse.unlawful() == 0, is_lawful, "{rate}");
    }
}

/// Sample variance of the first pixel of a group.
fn variance(scene: &Scene<Homogeneous>, group: &[Line]) -> f64 {
    let mut reuse = PathReuse::new(scene.world(), walk(0.5), Regular, Heuristic::Balance);
    let (mut source, mut radiances) = (Seeded::new(6), vec![0.0; group.len()]);
    let mut moments = Moments::new();
    for _ in 0..40_000 {
        reuse.radiances(group, &mut radiances, &mut source);
        moments.push(radiances[0]);
    }
    let allocated = allocation_counter::measure(|| {
        (0..100).for_each(|_| reuse.radiances(group, &mut radiances, &mut source));
    });
    assert_eq!(allocated.count_total, 0);
    moments.sample_variance().unwrap()
}

#[test]
fn a_group_saves_variance_and_allocates_nothing() {
    // Pixels far from each other share little; those of a tile almost all that comes from a second vertex.
    let scene = court();
    let lines = lines(8);
    let origin = lines[0].origin;
    let tile: Vec<Line> = (0..9)
        .map(|k| {
            let at = dvec3(0.2 + 0.05 * f64::from(k % 3), 0.3 + 0.05 * f64::from(k / 3), 0.0);
            Line { origin, direction: (at - origin).normalize() }
        })
        .collect();
    let [alone, apart, tile] = [&lines[..1], &lines, &tile].map(|group| variance(&scene, group));
    assert!(apart < 0.8 * alone && tile < 0.5 * alone, "{alone}, apart {apart}, tile {tile}");
}

#[test]
fn golden_values() {
    let scene = court();
    let mut reuse = PathReuse::new(scene.world(), walk(0.5), Regular, Heuristic::Balance);
    let (mut source, mut found, mut sums) = (Seeded::new(1), [0.0; 3], [0.0; 3]);
    for _ in 0..20 {
        reuse.radiances(&lines(3), &mut found, &mut source);
        sums.iter_mut().zip(found).for_each(|(sum, found)| *sum += found);
    }
    for (index, expected) in
        [1.42580728789312, 1.2158237287278661, 15.820568974699542].into_iter().enumerate()
    {
        assert!((sums[index] / expected - 1.0f64).abs() < 1e-12, "{sums:?}");
    }
}
