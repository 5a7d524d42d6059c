//! Several wavelengths at once: what sharing one path costs each of them.

use super::seed_ray;
use crate::Failure;
use crate::field::AnyProfile;
use crate::report::document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use crate::report::run::Run;
use fairflight_freeflight::spectral::{
    AverageScheme, HeroWavelength, MaxScheme, SeparateSolve, SharedDistance, SpectralFlight,
    SpectralFreeFlight, SpectralTracking,
};
use fairflight_media::{
    AnalyticCosine, Constant, Extinction, OpticalThickness, Ray, Scaled, SpectralExtinction,
    SpectralOpticalThickness,
};
use fairflight_sources::{Seeded, derive_seed};
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The part of the report, for its seeds.
const PART: u64 = 7;
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

/// What flights of N wavelengths scored.
struct Scored<const N: usize> {
    /// Variance of the escaped weight over T², per wavelength.
    escaped: [f64; N],
    /// Variance of the collided weight over (1 − T)².
    collided: [f64; N],
    /// Means over T, and over 1 − T.
    means: [[f64; N]; 2],
    /// Standard errors of those.
    errors: [[f64; N]; 2],
    greatest: f64,
    lookups: f64,
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
    // Σ w, Σ w² of escaped and of collided weights.
    let sums = (0..batches)
        .into_par_iter()
        .map(|batch| {
            let mut source = Seeded::new(derive_seed(seed, batch));
            let (mut sums, mut greatest) = ([[0.0; N]; 4], 0.0_f64);
            for _ in 0..BATCH {
                let (row, weights) = match sampler.sample(&field, &mut source) {
                    SpectralFlight::Escaped { weights } => (0, weights),
                    SpectralFlight::Collided { weights, .. } => (2, weights),
                };
                for (l, weight) in weights.into_iter().enumerate() {
                    sums[row][l] += weight;
                    sums[row + 1][l] += weight * weight;
                    greatest = greatest.max(weight.abs());
                }
            }
            (sums, greatest)
        })
        .collect::<Vec<_>>();
    let n = (batches * BATCH) as f64;
    let total = |row: usize, l: usize| sums.iter().map(|(sums, _)| sums[row][l]).sum::<f64>() / n;
    let lookups = AtomicU64::new(0);
    let counted = CountedSpectrum { field, lookups: &lookups };
    let mut source = Seeded::new(seed);
    for _ in 0..BATCH {
        sampler.sample(&counted, &mut source);
    }
    let exact = |row: usize, l: usize| {
        let transmittance = (-thickness[l]).exp();
        if row == 0 { transmittance } else { 1.0 - transmittance }
    };
    let mean = |row: usize, l: usize| total(2 * row, l) / exact(row, l);
    let variance = |row: usize, l: usize| {
        (total(2 * row + 1, l) - total(2 * row, l) * total(2 * row, l)) / (exact(row, l) * exact(row, l))
    };
    Scored {
        escaped: std::array::from_fn(|l| variance(0, l)),
        collided: std::array::from_fn(|l| variance(1, l)),
        means: [0, 1].map(|row| std::array::from_fn(|l| mean(row, l))),
        errors: [0, 1].map(|row| std::array::from_fn(|l| (variance(row, l) / n).sqrt())),
        greatest: sums.iter().fold(0.0, |greatest: f64, (_, other)| greatest.max(*other)),
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
    let go = |k: u64| (flights.0, derive_seed(flights.1, k));
    Ok(vec![
        ("separate solves", score(field, thickness, &SeparateSolve::new(majorants), go(0))),
        (
            "spectral tracking, max scheme",
            score(field, thickness, &SpectralTracking::new(MaxScheme, constant(greatest)?), go(1)),
        ),
        (
            "spectral tracking, average scheme",
            score(field, thickness, &SpectralTracking::new(AverageScheme, constant(greatest)?), go(2)),
        ),
        ("hero wavelength", score(field, thickness, &HeroWavelength::new(constant(greatest)?), go(3))),
        (
            BASELINE,
            score(
                field,
                thickness,
                &SharedDistance::new(constant(thickness.into_iter().fold(0.0, f64::max) / field.length())?),
                go(4),
            ),
        ),
    ])
}

/// What came of the wavelengths.
pub(super) struct Spectral {
    pub(super) section: Section,
    pub(super) unsound: Vec<String>,
}

pub(super) fn study(run: &Run<'_>) -> Result<Spectral, Failure> {
    let AnyProfile::AnalyticCosine(ray) = seed_ray::ray(run)?.profile else {
        return Err(Failure::refused("profile: the seed ray is one of eq. 21"));
    };
    let mut section = Section::new("spectral", "Several wavelengths at once");
    section.text = vec![
        "One flight counts for all wavelengths, with a weight for each; every wavelength has its own law E[escaped weight] = T_l and E[collided \
         weight] = 1 − T_l. The baseline is one flight per wavelength, which makes as many walks. A look-up is one evaluation of all \
         wavelengths."
            .to_owned(),
    ];
    let (table, mut unsound) = tinted(run, &ray)?;
    run.advance();
    let (chart, more) = two(run, &ray)?;
    unsound.extend(more);
    section.charts = vec![chart];
    section.tables = vec![table];
    Ok(Spectral { section, unsound })
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
    let flights = run.quick_or(100_000, 2_000_000);
    let mut table = Table::new(
        "spectral-tinted",
        "Three wavelengths on the seed ray",
        "Extinctions 1, 0.6 and 0.25 times that of eq. 21. Variances of one flight, in units of what is estimated.",
        &[
            ("sampler", ""),
            ("wavelength", ""),
            ("look-ups", "1"),
            ("escaped: Var/T²", "1"),
            ("collided: Var/(1 − T)²", "1"),
            ("escaped mean / T", "1"),
            ("collided mean / (1 − T)", "1"),
            ("greatest weight", "1"),
        ],
    );
    let mut unsound = Vec::new();
    for (name, scored) in all(&field, (thickness, coefficients), (flights, run.seed(PART, 0)))? {
        for l in 0..3 {
            let measured = |row: usize| {
                let (mean, error) = (scored.means[row][l], 1.96 * scored.errors[row][l]);
                Cell::measured(mean, [mean - error, mean + error])
            };
            for row in 0..2 {
                let z = (scored.means[row][l] - 1.0) / scored.errors[row][l];
                if z.abs() > 6.0 && name != BASELINE {
                    unsound.push(format!(
                        "{name}, wavelength {}: a mean is off by {z:.1} standard errors",
                        l + 1
                    ));
                }
            }
            table.rows.push(vec![
                Cell::text(name),
                Cell::Count(l as u64 + 1),
                Cell::Number(scored.lookups),
                Cell::Number(scored.escaped[l]),
                Cell::Number(scored.collided[l]),
                measured(0),
                measured(1),
                Cell::Number(scored.greatest),
            ]);
        }
    }
    Ok((table, unsound))
}

/// Two wavelengths, further and further apart.
fn two(run: &Run<'_>, ray: &Ray<Arc<AnalyticCosine>>) -> Result<(Chart, Vec<String>), Failure> {
    let mut chart = Chart::new(
        "spectral-ratio",
        "Two wavelengths: the worse variance of what collides",
        Axis::linear("σ_2 / σ_1 [1]"),
        Axis::logarithmic("Var · look-ups / (1 − T)² [1]"),
    );
    chart.caption = "With the distances of the densest wavelength the weights of the thinner one grow along the ray; in an endless medium their variance \
                     is infinite from a factor of 2 on (raab-2008 3.2). This ray ends: what is measured beyond is hollow."
        .to_owned();
    let flights = run.quick_or(50_000, 500_000);
    let mut curves: Vec<(&'static str, Vec<(f64, f64)>)> = Vec::new();
    for (k, &ratio) in (0..).zip(&RATIOS) {
        let coefficients = [0.25, 0.25 * ratio];
        let (field, thickness) = scaled(ray, coefficients)?;
        for (i, (name, scored)) in
            all(&field, (thickness, coefficients), (flights, run.seed(PART, 1 + k)))?.into_iter().enumerate()
        {
            if curves.len() <= i {
                curves.push((name, Vec::new()));
            }
            let worst = scored.collided.into_iter().fold(0.0, f64::max);
            curves[i].1.push((ratio, worst * scored.lookups));
        }
        run.advance();
    }
    chart.curves = curves
        .into_iter()
        .map(|(name, points)| {
            let marks: Vec<Mark> = points
                .iter()
                .map(|&(x, y)| {
                    let mark = Mark::at(x, y);
                    if name == BASELINE && x >= 2.0 { mark.hollow() } else { mark }
                })
                .collect();
            Curve::method(name).with_line(points).with_marks(marks)
        })
        .collect();
    Ok((chart, Vec::new()))
}
