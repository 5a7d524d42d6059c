//! The companion sampler of jittered ratio tracking against the exact law of distances, a hundred million times.

use crate::run::{Part, Run};
use fairflight_document::{Cell, Section, Table};
use fairflight_freeflight::{FreeFlight, JitteredFlight, Woodcock};
use fairflight_harness::Failure;
use fairflight_harness::field::AnyProfile;
use fairflight_harness::parallel::in_parallel;
use fairflight_media::{AnalyticCosine, Bounded, Constant, Counted, Extinction, OpticalThickness, Ray};
use fairflight_sources::Seeded;
use fairflight_stats::chi_square;
use std::sync::Arc;

/// Classes of equal probability among flights that collide.
const CLASSES: usize = 4096;
/// Flights of a batch.
const BATCH: u64 = 1 << 20;
/// False alarm of each test.
const ALPHA: f64 = 1e-7;

pub(super) fn steps() -> u64 {
    1
}

pub(super) fn study(run: &Run<'_>, profile: &AnyProfile) -> Result<Part, Failure> {
    let AnyProfile::AnalyticCosine(ray) = profile else {
        return Err(Failure::refused("profile: the flights are tried on eq. 21"));
    };
    let flights = run.quick_or(400_000, 100_000_000_u64);
    let mut rows = Vec::new();
    let mut unsound = Vec::new();
    for (name, epsilon, flights) in [
        ("jittered, ε = 0.5", Some(0.5), flights),
        ("jittered, ε = 1", Some(1.0), flights / 10),
        ("Woodcock", None, flights / 10),
    ] {
        let seed = run.seed(format_args!("flights/{name}"));
        let sampled = match epsilon {
            Some(epsilon) => {
                let sampler = JitteredFlight::new(epsilon)
                    .map_err(|error| Failure::refused(format!("epsilon: {error}")))?;
                sample(ray, &sampler, flights, seed)
            }
            None => {
                let majorant = Constant::new(1.0, ray.length()).expect("1 is finite, and a ray has a length");
                sample(ray, &Woodcock::new(majorant), flights, seed)
            }
        };
        let collides = 1.0 - (-ray.optical_thickness(0.0, ray.length())).exp();
        let mut probabilities = vec![collides / CLASSES as f64; CLASSES];
        probabilities.push(1.0 - collides);
        let fit = chi_square(&sampled.counts, &probabilities, ALPHA);
        let distance = kolmogorov_distance(&sampled.counts, &probabilities);
        let scaled = distance * (sampled.flights as f64).sqrt();
        // massart-1990 corollary 1: a bound for every n.
        let p = (2.0 * (-2.0 * scaled * scaled).exp()).min(1.0);
        if fit.sound != Some(true) || p < ALPHA {
            unsound.push(format!("free flight, {name}: {}; Kolmogorov's p < {p:.1e}", fit.reason));
        }
        rows.push((name, sampled, fit.reason, scaled, p));
    }
    run.advance();
    let text = "One uniform candidate per stratum, accepted with the probability h σ_t, then put to a survival test: the same law as Woodcock \
         tracking, one fixed dimension per stratum, about twice the look-ups.";
    let table = Table::of(
        [
            "flights-distances",
            "Distances of jittered free flight on the seed ray",
            "Against the exact law 1 − exp(−τ(s)), in 4096 classes of equal probability and the escape; Kolmogorov's distance over the borders \
             of the classes. The false alarm of each test is 1e-7.",
        ],
        rows,
        &[
            ("sampler", "", &|(name, ..)| Cell::text(*name)),
            ("flights", "1", &|(_, sampled, ..)| Cell::Count(sampled.flights)),
            ("classes, pooled where they are too small", "", &|(_, _, reason, ..)| Cell::text(reason)),
            ("sqrt(n) · Kolmogorov's distance", "1", &|(.., scaled, _)| Cell::Number(*scaled)),
            ("p below", "1", &|(.., p)| Cell::Number(*p)),
            ("look-ups", "1", &|(_, sampled, ..)| Cell::Number(sampled.lookups)),
        ],
    );
    let section = Section::new("flights", "The companion: jittered free flight").with(text).with(table);
    Ok(Part { section, unsound })
}

struct Sampled {
    counts: Vec<u64>,
    flights: u64,
    lookups: f64,
}

/// The seed ray with its majorant.
type SeedRay<'a> = Bounded<&'a Ray<Arc<AnalyticCosine>>>;

fn sample<E: for<'a> FreeFlight<SeedRay<'a>> + for<'a> FreeFlight<Counted<SeedRay<'a>>> + Sync>(
    ray: &Ray<Arc<AnalyticCosine>>,
    sampler: &E,
    flights: u64,
    seed: u64,
) -> Sampled {
    let collides = 1.0 - (-ray.optical_thickness(0.0, ray.length())).exp();
    let batches = flights.div_ceil(BATCH);
    let per_batch = in_parallel(batches as usize, &|batch| {
        let field = Bounded::new(ray, 1.0).expect("1 is a majorant");
        let mut source = Seeded::for_batch(seed, batch as u64);
        let mut counts = vec![0_u64; CLASSES + 1];
        for _ in 0..BATCH {
            let class = match sampler.sample(&field, &mut source).distance() {
                Some(s) => {
                    let u = -(-ray.optical_thickness(0.0, s)).exp_m1() / collides;
                    ((u * CLASSES as f64) as usize).min(CLASSES - 1)
                }
                None => CLASSES,
            };
            counts[class] += 1;
        }
        counts
    });
    let counts = (0..=CLASSES).map(|class| per_batch.iter().map(|counts| counts[class]).sum()).collect();
    const COUNTED: u64 = 1 << 18;
    let counting = Counted::new(Bounded::new(ray, 1.0).expect("1 is a majorant"));
    let mut source = Seeded::new(seed);
    for _ in 0..COUNTED {
        sampler.sample(&counting, &mut source);
    }
    Sampled { counts, flights: batches * BATCH, lookups: counting.lookups() as f64 / COUNTED as f64 }
}

/// The greatest difference between the empirical and the exact distribution, at the borders of the classes.
fn kolmogorov_distance(counts: &[u64], probabilities: &[f64]) -> f64 {
    let n = counts.iter().sum::<u64>() as f64;
    let (mut empirical, mut exact, mut greatest) = (0.0, 0.0, 0.0_f64);
    for (&count, &probability) in counts.iter().zip(probabilities) {
        empirical += count as f64 / n;
        exact += probability;
        greatest = greatest.max((empirical - exact).abs());
    }
    greatest
}
