//! Estimators driven by point sets: what evenly spread variates gain.

use super::seed_ray;
use crate::Failure;
use crate::comparison::TestRay;
use crate::field::AnyProfile;
use crate::report::document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use crate::report::run::Run;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::{Bounded, Constant, Extinction, Vacuum};
use fairflight_sources::{
    Halton, Hammersley, LatinHypercube, PointSet, PointSetError, Seeded, Sobol, UniformSource, derive_seed,
};
use fairflight_transmittance::{
    Comb, CombShape, JitteredRatio, Roulette, Tracking, TransmittanceEstimator, UnbiasedRayMarching,
};
use rayon::prelude::*;

/// The part of the report, for its seeds.
const PART: u64 = 6;
/// Replicas of a point set: what its variance is measured over.
const REPLICAS: u64 = 256;
/// Points of a replica.
const POINTS: [u64; 5] = [4, 16, 64, 256, 1024];
/// Coordinates that a set orders; what an estimate draws beyond is independent.
const DIMENSIONS: usize = 64;

pub(super) fn steps() -> u64 {
    3
}

/// A way to draw the variates of a replica.
struct Source {
    name: &'static str,
    /// The mean over `points` estimates of the replica with this seed.
    replica: fn(&Estimate<'_>, u64, u64) -> Result<f64, PointSetError>,
}

type Estimate<'a> = dyn Fn(&mut dyn UniformSource) -> f64 + Sync + 'a;

fn over(set: &impl PointSet, points: u64, estimate: &Estimate<'_>) -> f64 {
    (0..points).map(|index| estimate(&mut set.source(index))).sum::<f64>() / points as f64
}

const SOURCES: [Source; 5] = [
    Source {
        name: "independent",
        replica: |estimate, points, seed| {
            let mut source = Seeded::new(seed);
            Ok((0..points).map(|_| estimate(&mut source)).sum::<f64>() / points as f64)
        },
    },
    Source {
        name: "Sobol, Owen-scrambled",
        replica: |estimate, points, seed| Ok(over(&Sobol::new(DIMENSIONS, seed)?, points, estimate)),
    },
    Source {
        name: "Halton, scrambled",
        replica: |estimate, points, seed| Ok(over(&Halton::new(DIMENSIONS, seed)?, points, estimate)),
    },
    Source {
        name: "Hammersley, randomised",
        replica: |estimate, points, seed| {
            Ok(over(&Hammersley::new(points, DIMENSIONS, seed)?, points, estimate))
        },
    },
    Source {
        name: "Latin hypercube",
        replica: |estimate, points, seed| {
            Ok(over(&LatinHypercube::new(points, DIMENSIONS, seed)?, points, estimate))
        },
    },
];

/// What came of the point sets.
pub(super) struct Variates {
    pub(super) section: Section,
    pub(super) unsound: Vec<String>,
}

pub(super) fn study(run: &Run<'_>) -> Result<Variates, Failure> {
    let TestRay { profile, truth, .. } = seed_ray::ray(run)?;
    let AnyProfile::AnalyticCosine(ray) = &profile else {
        return Err(Failure::refused("profile: the seed ray is one of eq. 21"));
    };
    let refuse = |error: &dyn std::fmt::Display| Failure::refused(format!("variates: {error}"));
    let length = ray.length();
    let field = Bounded::new(ray, 1.0).map_err(|error| refuse(&error))?;
    let sampling = Constant::new(1.0, length).map_err(|error| refuse(&error))?;
    let ratio = Tracking::new(DoubleParticle { albedo: Albedo::default() }, Vacuum::new(length), sampling);
    let comb = Comb::new(25, CombShape::Uniform).map_err(|error| refuse(&error))?;
    let marching = UnbiasedRayMarching::new(comb, Roulette::KETTUNEN);
    let jittered = JitteredRatio::new(0.5).map_err(|error| refuse(&error))?;
    let unit = truth.optical_thickness.exp();
    let estimates: [(&str, &str, &Estimate<'_>); 3] = [
        ("ratio", "ratio tracking", &|mut source| unit * ratio.estimate(&field, &mut source)),
        ("marching", "unbiased ray marching, 25 teeth", &|mut source| {
            unit * marching.estimate(&field, &mut source)
        }),
        ("jittered", "jittered ratio tracking, ε = 0.5", &|mut source| {
            unit * jittered.estimate(&field, &mut source)
        }),
    ];
    let mut section = Section::new("variates", "Variates from point sets");
    section.text = vec![format!(
        "The seed ray again. A replica is one randomised point set of n points, one estimate per point; each estimate is unbiased by itself, and \
         the variance of their mean is measured over {REPLICAS} replicas: never over the points of one, which depend on each other. The \
         sets order the first {DIMENSIONS} variates of an estimate; what it draws beyond is independent."
    )];
    let mut table = Table::new(
        "variates-variance",
        "Variance of a mean of n over that of independent variates",
        "With the 95 % interval of a ratio of two variances of as many replicas (normal replicas: a factor of 1.28 either way).",
        &[
            ("estimator", ""),
            ("variates", ""),
            ("n", "1"),
            ("relative variance", "1"),
            ("z of the mean", "1"),
        ],
    );
    let mut unsound = Vec::new();
    for (k, (id, name, estimate)) in (0..).zip(estimates) {
        let mut chart = Chart::new(
            &format!("variates-{id}"),
            &format!("Variance of a mean: {name}"),
            Axis::logarithmic("points [1]"),
            Axis::logarithmic("variance of the mean / T² [1]"),
        );
        let mut independent: Vec<f64> = Vec::new();
        for (s, source) in (0..).zip(&SOURCES) {
            let mut marks = Vec::new();
            for (i, &points) in POINTS.iter().enumerate() {
                let seed = derive_seed(derive_seed(run.seed(PART, k), s), points);
                let replicas = run.quick_or(REPLICAS / 8, REPLICAS);
                let means: Result<Vec<f64>, PointSetError> = (0..replicas)
                    .into_par_iter()
                    .map(|replica| (source.replica)(estimate, points, derive_seed(seed, replica)))
                    .collect();
                let means = means.map_err(|error| refuse(&error))?;
                let (mean, variance) = mean_and_variance(&means);
                let z = (mean - 1.0) / (variance / replicas as f64).sqrt();
                // Means of many estimates over hundreds of replicas, of laws whose tails are mild: close to normal.
                if z.abs() > 6.0 && points >= 64 {
                    unsound.push(format!(
                        "{name} by {} points: its mean is off by {z:.1} standard errors",
                        source.name
                    ));
                }
                if s == 0 {
                    independent.push(variance);
                }
                let factor = (1.96 * (2.0 / (replicas - 1) as f64).sqrt()).exp();
                let ratio = variance / independent[i];
                let wide = factor.powf(std::f64::consts::SQRT_2);
                table.rows.push(vec![
                    Cell::text(name),
                    Cell::text(source.name),
                    Cell::Count(points),
                    Cell::measured(ratio, [ratio / wide, ratio * wide]),
                    Cell::Number(z),
                ]);
                marks.push(Mark::measured(points as f64, variance, [variance / factor, variance * factor]));
            }
            let line: Vec<(f64, f64)> = marks.iter().map(|mark| (mark.x, mark.y)).collect();
            chart.curves.push(Curve::method(source.name).with_line(line).with_marks(marks));
        }
        run.advance();
        section.charts.push(chart);
    }
    section.tables = vec![table];
    Ok(Variates { section, unsound })
}

fn mean_and_variance(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (n - 1.0))
}
