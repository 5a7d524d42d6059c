//! Estimators driven by point sets: what evenly spread variates gain.

use super::seed_ray;
use crate::measured::{Measured, mean_and_error};
use crate::run::{Part, Run};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_document::{Axis, Cell, Chart, Curve, Section, Table};
use fairflight_harness::Failure;
use fairflight_harness::comparison::TestRay;
use fairflight_harness::field::AnyProfile;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_media::{Bounded, Constant, Extinction, Vacuum};
use fairflight_sources::{
    Halton, Hammersley, LatinHypercube, PointSet, PointSetError, Seeded, Sobol, UniformSource, named_seed,
};
use fairflight_transmittance::{
    Comb, CombShape, JitteredRatio, Roulette, Tracking, TransmittanceEstimator, UnbiasedRayMarching,
};

/// Replicas of a point set: what its variance is measured over.
const REPLICAS: usize = 256;
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

pub(super) fn study(run: &Run<'_>) -> Result<Part, Failure> {
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
    let estimates: [(&str, &'static str, &Estimate<'_>); 3] = [
        ("ratio", "ratio tracking", &|mut source| unit * ratio.estimate(&field, &mut source)),
        ("marching", "unbiased ray marching, 25 teeth", &|mut source| {
            unit * marching.estimate(&field, &mut source)
        }),
        ("jittered", "jittered ratio tracking, ε = 0.5", &|mut source| {
            unit * jittered.estimate(&field, &mut source)
        }),
    ];
    let replicas = run.quick_or(REPLICAS / 8, REPLICAS);
    let text = format!(
        "The seed ray again. A replica is one randomised point set of n points, one estimate per point; each estimate is unbiased by itself, and \
         the variance of their mean is measured over {replicas} replicas: never over the points of one, which depend on each other. The \
         sets order the first {DIMENSIONS} variates of an estimate; what it draws beyond is independent."
    );
    let (mut rows, mut charts) = (Vec::new(), Vec::new());
    for (id, name, estimate) in estimates {
        let measure = |source: &Source| -> Result<Vec<Row>, Failure> {
            let row = |&points: &u64| {
                let seed = run.seed(format_args!("variates/{id}/{}/{points}", source.name));
                let means = try_in_parallel(replicas, &|k| {
                    let seed = named_seed(seed, &format!("replica {k}"));
                    (source.replica)(estimate, points, seed).map_err(|error| refuse(&error))
                })?;
                let (mean, error) = mean_and_error(&means);
                let (variance, z) = (Measured::variance(&means), (mean - 1.0) / error);
                Ok(Row { estimator: name, source: source.name, points, variance, z })
            };
            POINTS.iter().map(row).collect()
        };
        let by_source = SOURCES.iter().map(measure).collect::<Result<Vec<_>, Failure>>()?;
        let curve = |rows: &Vec<Row>| {
            let marks = rows.iter().map(|row| row.variance.mark(row.points as f64));
            Curve::joined(rows[0].source, marks)
        };
        charts.push(
            Chart::new(
                &format!("variates-{id}"),
                &format!("Variance of a mean: {name}"),
                Axis::logarithmic("points [1]"),
                Axis::logarithmic("variance of the mean / T² [1]"),
            )
            .with_curves(by_source.iter().map(curve).collect()),
        );
        let independent: Vec<Measured> = by_source[0].iter().map(|row| row.variance).collect();
        for (row, independent) in by_source.into_iter().flat_map(|rows| rows.into_iter().zip(&independent)) {
            rows.push((row.variance.over(independent), row));
        }
        run.advance();
    }
    // Means of many estimates over hundreds of replicas, of laws whose tails are mild: close to normal.
    let unsound = rows.iter().filter(|(_, row)| row.z.abs() > 6.0 && row.points >= 64).map(|(_, row)| {
        let Row { estimator, source, z, .. } = row;
        format!("{estimator} by {source} points: its mean is off by {z:.1} standard errors")
    });
    let unsound = unsound.collect();
    let table = Table::of(
        [
            "variates-variance",
            "Variance of a mean of n over that of independent variates",
            "With the 95 % interval of a ratio of two variances of as many replicas.",
        ],
        rows,
        &[
            ("estimator", "", &|(_, row)| Cell::text(row.estimator)),
            ("variates", "", &|(_, row)| Cell::text(row.source)),
            ("n", "1", &|(_, row)| Cell::Count(row.points)),
            ("relative variance", "1", &|(relative, _)| relative.cell()),
            ("z of the mean", "1", &|(_, row)| Cell::Number(row.z)),
        ],
    );
    let section =
        Section::new("variates", "Variates from point sets").with(text).with_all(charts).with(table);
    Ok(Part { section, unsound })
}

/// An estimator driven by sets of so many points.
struct Row {
    estimator: &'static str,
    source: &'static str,
    points: u64,
    /// Of the mean over the points of a set, in units of T².
    variance: Measured,
    z: f64,
}
