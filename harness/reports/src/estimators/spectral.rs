//! Several wavelengths at once: what sharing one path costs each of them.

use super::seed_ray;
use crate::measured::Measured;
use crate::run::{Part, Run};
use fairflight_document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use fairflight_freeflight::spectral::{
    AverageScheme, HeroWavelength, MaxScheme, SeparateSolve, SharedDistance, SpectralFlight,
    SpectralFreeFlight, SpectralTracking,
};
use fairflight_harness::Failure;
use fairflight_harness::field::AnyProfile;
use fairflight_harness::parallel::in_parallel;
use fairflight_media::{
    AnalyticCosine, Constant, Extinction, OpticalThickness, Ray, Scaled, SpectralExtinction,
    SpectralOpticalThickness,
};
use fairflight_sources::{Seeded, named_seed};
use fairflight_stats::Moments;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Extinctions of the second wavelength over the first.
const RATIOS: [f64; 8] = [1.0, 1.25, 1.5, 1.75, 1.9, 2.1, 3.0, 4.0];
/// Flights of a batch.
const BATCH: u64 = 1 << 14;

pub(super) fn steps() -> u64 {
    RATIOS.len() as u64 + 1
}

/// Distances at the mean extinction of the densest wavelength, weighted for all: its weights have no bound, so that its means cannot be
/// judged.
const BASELINE: &str = "the densest one's distances";

/// Scores of flights of N wavelengths: their weights over T where they escape, over 1 − T where they collide.
struct Scored<const N: usize> {
    escaped: [Moments; N],
    collided: [Moments; N],
    lookups: f64,
}

impl<const N: usize> Scored<N> {
    /// The greatest weight, in units of what it estimates.
    fn greatest(&self) -> f64 {
        let scores = self.escaped.iter().chain(&self.collided);
        let ends = scores.flat_map(|scores| [scores.minimum(), scores.maximum()]).flatten();
        ends.map(f64::abs).fold(0.0, f64::max)
    }
}

/// A spectrum whose evaluations are counted: all wavelengths at once are one look-up.
struct CountedSpectrum<'a, F> {
    field: &'a F,
    lookups: &'a AtomicU64,
}

impl<F: SpectralExtinction<N>, const N: usize> SpectralExtinction<N> for CountedSpectrum<'_, F> {
    fn sigma_t(&self, s: f64) -> [f64; N] {
        self.lookups.fetch_add(1, Ordering::Relaxed);
        self.field.sigma_t(s)
    }

    fn length(&self) -> f64 {
        self.field.length()
    }
}

impl<F: SpectralOpticalThickness<N>, const N: usize> SpectralOpticalThickness<N> for CountedSpectrum<'_, F> {
    fn optical_thickness(&self, from: f64, to: f64) -> [f64; N] {
        self.field.optical_thickness(from, to)
    }
}

fn score<F, E, const N: usize>(
    field: &F,
    thickness: [f64; N],
    sampler: &E,
    (flights, seed): (u64, u64),
) -> Scored<N>
where
    F: SpectralExtinction<N> + Sync,
    E: for<'a> SpectralFreeFlight<&'a F, N> + for<'a> SpectralFreeFlight<CountedSpectrum<'a, F>, N> + Sync,
{
    let batches = flights.div_ceil(BATCH);
    let per_batch = in_parallel(batches as usize, &|batch| {
        let mut source = Seeded::for_batch(seed, batch as u64);
        let mut scores = [[Moments::new(); N]; 2];
        for _ in 0..BATCH {
            let (end, weights) = match sampler.sample(&field, &mut source) {
                SpectralFlight::Escaped { weights } => (0, weights),
                SpectralFlight::Collided { weights, .. } => (1, weights),
            };
            scores[end].iter_mut().zip(weights).for_each(|(scores, weight)| scores.push(weight));
        }
        scores
    });
    let lookups = AtomicU64::new(0);
    let counted = CountedSpectrum { field, lookups: &lookups };
    let mut source = Seeded::new(seed);
    for _ in 0..BATCH {
        sampler.sample(&counted, &mut source);
    }
    let scores = |end: usize, l: usize| {
        let mut scores = Moments::new();
        per_batch.iter().for_each(|batch| scores.merge(&batch[end][l]));
        let transmittance = (-thickness[l]).exp();
        let exact = if end == 0 { transmittance } else { 1.0 - transmittance };
        // Flights that end otherwise score 0.
        scores.with_zeros(batches * BATCH - scores.count()).scaled(1.0 / exact)
    };
    Scored {
        escaped: std::array::from_fn(|l| scores(0, l)),
        collided: std::array::from_fn(|l| scores(1, l)),
        lookups: lookups.into_inner() as f64 / BATCH as f64,
    }
}

/// All samplers by name, on one field of majorant 1 for its greatest coefficient.
fn all<F: SpectralOpticalThickness<N> + Sync, const N: usize>(
    field: &F,
    (thickness, coefficients): ([f64; N], [f64; N]),
    flights: (u64, u64),
) -> Result<Vec<(&'static str, Scored<N>)>, Failure> {
    let constant = |sigma: f64| {
        Constant::new(sigma, field.length()).map_err(|error| Failure::refused(format!("spectral: {error}")))
    };
    let greatest = coefficients.into_iter().fold(0.0, f64::max);
    let majorants: Result<Vec<Constant>, Failure> =
        coefficients.iter().map(|&sigma| constant(sigma)).collect();
    let majorants: [Constant; N] =
        majorants?.try_into().map_err(|_| Failure::refused("spectral: a majorant per wavelength"))?;
    let densest = thickness.into_iter().fold(0.0, f64::max) / field.length();
    let separate = SeparateSolve::new(majorants);
    let max = SpectralTracking::new(MaxScheme, constant(greatest)?);
    let average = SpectralTracking::new(AverageScheme, constant(greatest)?);
    let hero = HeroWavelength::new(constant(greatest)?);
    let shared = SharedDistance::new(constant(densest)?);
    let go = |name: &str| (flights.0, named_seed(flights.1, name));
    Ok(vec![
        ("separate solves", score(field, thickness, &separate, go("separate solves"))),
        ("spectral tracking, max scheme", score(field, thickness, &max, go("max scheme"))),
        ("spectral tracking, average scheme", score(field, thickness, &average, go("average scheme"))),
        ("hero wavelength", score(field, thickness, &hero, go("hero wavelength"))),
        (BASELINE, score(field, thickness, &shared, go(BASELINE))),
    ])
}

pub(super) fn study(run: &Run<'_>) -> Result<Part, Failure> {
    let AnyProfile::AnalyticCosine(ray) = seed_ray::ray(run)?.profile else {
        return Err(Failure::refused("profile: the seed ray is one of eq. 21"));
    };
    let text = "One flight counts for all wavelengths, with a weight for each; every wavelength has its own law E[escaped weight] = T_l and E[collided \
         weight] = 1 − T_l. The baseline is one flight per wavelength, which makes as many walks. A look-up is one evaluation of all \
         wavelengths.";
    let (table, unsound) = tinted(run, &ray)?;
    run.advance();
    let section =
        Section::new("spectral", "Several wavelengths at once").with(text).with(two(run, &ray)?).with(table);
    Ok(Part { section, unsound })
}

/// The seed ray in N wavelengths.
type Tinted<'a, const N: usize> = Scaled<&'a Ray<Arc<AnalyticCosine>>, N>;

fn scaled<const N: usize>(
    ray: &Ray<Arc<AnalyticCosine>>,
    coefficients: [f64; N],
) -> Result<(Tinted<'_, N>, [f64; N]), Failure> {
    let field =
        Scaled::new(ray, coefficients).map_err(|error| Failure::refused(format!("spectral: {error}")))?;
    let gray = ray.optical_thickness(0.0, ray.length());
    Ok((field, coefficients.map(|c| c * gray)))
}

/// Three wavelengths on the seed ray.
fn tinted(run: &Run<'_>, ray: &Ray<Arc<AnalyticCosine>>) -> Result<(Table, Vec<String>), Failure> {
    let coefficients = [1.0, 0.6, 0.25];
    let (field, thickness) = scaled(ray, coefficients)?;
    let flights = run.quick_or(50_000, 2_000_000);
    let samplers = all(&field, (thickness, coefficients), (flights, run.seed("spectral/tinted")))?;
    let rows: Vec<_> =
        samplers.iter().flat_map(|(name, scored)| (0..3).map(move |l| (*name, scored, l))).collect();
    let unsound = rows.iter().flat_map(|(name, scored, l)| {
        let z = [scored.escaped[*l], scored.collided[*l]].map(|scores| {
            let (mean, error) = mean(&scores);
            (mean - 1.0) / error
        });
        let off = z.into_iter().filter(|z| z.abs() > 6.0 && *name != BASELINE);
        off.map(move |z| format!("{name}, wavelength {}: a mean is off by {z:.1} standard errors", l + 1))
    });
    let unsound = unsound.collect();
    let variance = |scores: &Moments| Cell::maybe(scores.population_variance());
    let measured = |scores: &Moments| {
        let (mean, error) = mean(scores);
        Measured::normal(mean, error).cell()
    };
    let table = Table::of(
        [
            "spectral-tinted",
            "Three wavelengths on the seed ray",
            "Extinctions 1, 0.6 and 0.25 times that of eq. 21. Variances of one flight, in units of what is estimated.",
        ],
        rows,
        &[
            ("sampler", "", &|(name, ..)| Cell::text(*name)),
            ("wavelength", "", &|(.., l)| Cell::Count(*l as u64 + 1)),
            ("look-ups", "1", &|(_, scored, _)| Cell::Number(scored.lookups)),
            ("escaped: Var/T²", "1", &|(_, scored, l)| variance(&scored.escaped[*l])),
            ("collided: Var/(1 − T)²", "1", &|(_, scored, l)| variance(&scored.collided[*l])),
            ("escaped mean / T", "1", &|(_, scored, l)| measured(&scored.escaped[*l])),
            ("collided mean / (1 − T)", "1", &|(_, scored, l)| measured(&scored.collided[*l])),
            ("greatest weight", "1", &|(_, scored, _)| Cell::Number(scored.greatest())),
        ],
    );
    Ok((table, unsound))
}

fn mean(scores: &Moments) -> (f64, f64) {
    (scores.mean().unwrap_or(f64::NAN), scores.standard_error().unwrap_or(f64::NAN))
}

/// Two wavelengths, further and further apart.
fn two(run: &Run<'_>, ray: &Ray<Arc<AnalyticCosine>>) -> Result<Chart, Failure> {
    let flights = run.quick_or(50_000, 500_000);
    let mut curves: Vec<(&'static str, Vec<Mark>)> = Vec::new();
    for &ratio in &RATIOS {
        let coefficients = [0.25, 0.25 * ratio];
        let (field, thickness) = scaled(ray, coefficients)?;
        let seed = run.seed(format_args!("spectral/two/{ratio}"));
        let scored = all(&field, (thickness, coefficients), (flights, seed))?;
        curves.resize_with(scored.len(), Default::default);
        for ((label, marks), (name, scored)) in curves.iter_mut().zip(scored) {
            let worst = scored.collided.iter().filter_map(Moments::population_variance).fold(0.0, f64::max);
            let mark = Mark::at(ratio, worst * scored.lookups);
            *label = name;
            marks.push(if name == BASELINE && ratio >= 2.0 { mark.hollow() } else { mark });
        }
        run.advance();
    }
    Ok(Chart::new(
            "spectral-ratio",
            "Two wavelengths: the worse variance of what collides",
            Axis::linear("σ_2 / σ_1 [1]"),
            Axis::logarithmic("Var · look-ups / (1 − T)² [1]"),
        ).with_caption("With the distances of the densest wavelength the weights of the thinner one grow along the ray; in an endless medium their variance \
                  is infinite from a factor of 2 on (raab-2008 3.2). This ray ends: what is measured beyond is hollow."
            .to_owned()).with_curves(curves.into_iter().map(|(name, marks)| Curve::joined(name, marks)).collect()))
}
