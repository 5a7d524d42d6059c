//! The seed ray: every figure of the numerical study that preceded this code, measured again.

use crate::measured::Measured;
use crate::run::{Part, Run};
use fairflight_document::{Cell, Section, Table};
use fairflight_harness::Failure;
use fairflight_harness::comparison::{Bout, Effort, TestRay, fight};
use fairflight_harness::estimator::{
    AdaptiveRatioSpec, CellsSpec, ControlSpec, DoubleParticleSpec, EstimatorSpec, HybridSpec, JackknifeSpec,
    JitteredRatioSpec, NaiveSpec, NextFlightKind, NextFlightSpec, PSeriesSpec, RegularSpec,
    ResidualCellsSpec, RouletteSpec, SamplingSpec, TelescopingSpec, UnbiasedRayMarchingSpec, WoodcockSpec,
};
use fairflight_harness::field::AnyProfile;
use fairflight_harness::field::{AnalyticCosineSpec, MediumKind};
use fairflight_harness::reference::Truth;
use fairflight_media::Tolerance;
use fairflight_transmittance::{CombShape, PSeriesVersion, Roulette};
use glam::DVec3;

/// The length of the ray.
const LENGTH: f64 = 20.0;
/// Cells of the grid estimators.
const CELLS: usize = 20;

/// A figure of the study: Var/T² and look-ups as it printed them, and its number of samples.
struct Figure {
    variance: f64,
    /// Half a unit of its last digit.
    rounding: f64,
    lookups: f64,
    samples: f64,
}

/// An estimator with the study's figure, if it has one.
struct Row {
    name: &'static str,
    ours: bool,
    spec: EstimatorSpec,
    figure: Option<Figure>,
    /// Where ours differs from the study's.
    remark: &'static str,
}

/// What the seed ray came to.
pub(super) struct SeedRay {
    pub(super) part: Part,
    /// Rows, and those of them that agree with the study.
    pub(super) compared: usize,
    pub(super) reproduced: usize,
}

/// The ray through the centre of szirmay-kalos-2017 eq. 21.
pub(super) fn ray(run: &Run<'_>) -> Result<TestRay, Failure> {
    let spec = AnalyticCosineSpec { scale: 1.0, bounds: None };
    let (medium, bounds) = spec.build(&run.media, "medium")?;
    let clip = bounds
        .clip(DVec3::ZERO, DVec3::Z, Some(LENGTH))
        .map_err(|error| Failure::refused(format!("profile: {error}")))?
        .ok_or_else(|| Failure::refused("profile: the ray misses its medium"))?;
    let profile = AnyProfile::ray(&medium, &clip)?;
    let truth = Truth::of(&profile, Tolerance::TIGHT)?;
    Ok(TestRay { profile, truth, majorant: 1.0 })
}

pub(super) fn steps() -> u64 {
    40
}

pub(super) fn study(run: &Run<'_>) -> Result<SeedRay, Failure> {
    let ray = ray(run)?;
    let samples = run.quick_or(30_000, 1_000_000);
    let effort = Effort { samples, counted: samples.min(1 << 16), closed: true };
    let rows = rows(&ray);
    let bouts: Result<Vec<Bout>, Failure> = rows
        .iter()
        .map(|row| {
            let seed = run.seed(format_args!("seed-ray/{}", row.name));
            run.advance();
            fight(&ray, &row.spec.kind().prepare(&ray.profile)?, effort, seed)
        })
        .collect();
    let bouts = bouts?;
    let price = |bout: &Bout| bout.relative_variance * bout.lookups;
    let baseline = price(&bouts[1]);
    let rows: Vec<(Row, Bout)> = rows.into_iter().zip(bouts).collect();
    let agreement = |(row, bout): &(Row, Bout)| row.figure.as_ref().map(|figure| agrees(figure, bout));
    let compared = rows.iter().filter_map(agreement).count();
    let reproduced = rows.iter().filter_map(agreement).filter(|agrees| *agrees).count();
    let unsound = rows.iter().filter_map(|(row, bout)| {
        let z = (bout.relative_mean - 1.0) / bout.mean_error;
        let is_off = z.abs() > 6.0 && !row.name.contains("biased") && bout.mean_error > 1e-13;
        is_off.then(|| format!("{} on the seed ray: its mean is off by {z:.1} standard errors", row.name))
    });
    let unsound = unsound.collect();
    let figure = |row: &Row, of: fn(&Figure) -> f64| Cell::maybe(row.figure.as_ref().map(of));
    let variance = |bout: &Bout, value: f64| Measured::normal(value, bout.variance_error).cell();
    let table = Table::of(
        [
            "seed-ray",
            "The seed ray",
            "szirmay-kalos-2017 eq. 21 along z from the origin, length 20, optical thickness 3.41568, T = 0.0328539, majorant 1. The variance is the \
             closed form where there is one, measured where not; the study's figures are those of a numerical study of one million samples (250 \
             thousand for some). They agree where they differ by no more than the rounding of the printed digits and four standard errors of the \
             study.",
        ],
        &rows,
        &[
            ("estimator", "", &|(row, _)| Cell::text(row.name)),
            ("ours", "", &|(row, _)| Cell::Flag(row.ours)),
            ("look-ups", "1", &|(_, bout)| Cell::Number(bout.lookups)),
            ("study", "1", &|(row, _)| figure(row, |figure| figure.lookups)),
            ("Var/T²", "1", &|(_, bout)| match bout.is_closed {
                true => Cell::Number(bout.relative_variance),
                false => variance(bout, bout.relative_variance),
            }),
            ("measured", "1", &|(_, bout)| variance(bout, bout.measured_variance)),
            ("study", "1", &|(row, _)| figure(row, |figure| figure.variance)),
            ("agrees", "", &|row| agreement(row).map_or(Cell::Empty, Cell::Flag)),
            ("Var · look-ups/T²", "1", &|(_, bout)| Cell::Number(price(bout))),
            ("gain", "1", &|(_, bout)| Cell::Number(baseline / price(bout))),
            ("mean / T", "1", &|(_, bout)| Measured::normal(bout.relative_mean, bout.mean_error).cell()),
            ("negative", "1", &|(_, bout)| Cell::Number(bout.negative)),
            ("maximum / T", "1", &|(_, bout)| Cell::Number(bout.maximum)),
            ("time", "ns", &|(_, bout)| Cell::Number(1e9 * bout.seconds)),
            ("remark", "", &|(row, _)| Cell::text(row.remark)),
        ],
    );
    let section = Section::new("seed", "The seed ray: all estimators, and a study repeated")
        .with(format!("{reproduced} of {compared} variances of the study are reproduced."))
        .with(table);
    Ok(SeedRay { part: Part { section, unsound }, compared, reproduced })
}

/// Whether a figure of the study can be ours: its rounding, four standard errors of its sample, and four of ours where ours is measured.
fn agrees(figure: &Figure, bout: &Bout) -> bool {
    let relative = |samples: f64| match bout.kurtosis {
        Some(kurtosis) => ((kurtosis + 2.0) / samples).sqrt(),
        None => 0.0,
    };
    let ours = if bout.is_closed { 0.0 } else { bout.variance_error };
    let allowed = figure.rounding + 4.0 * (bout.relative_variance * relative(figure.samples)).hypot(ours);
    (figure.variance - bout.relative_variance).abs() <= allowed
}

/// The least and the greatest σ_t in equal cells, as a careful user finds them: at very many points, and a little beyond.
fn extremes(profile: &AnyProfile) -> (Vec<f64>, Vec<f64>) {
    const POINTS: usize = 20_000;
    /// Between two points eq. 21 moves by less than this.
    const BEYOND: f64 = 1e-6;
    let field = profile.field();
    (0..CELLS)
        .map(|cell| {
            let at = |i: usize| (cell as f64 + i as f64 / POINTS as f64) * field.length() / CELLS as f64;
            let values = (0..=POINTS).map(|i| field.sigma_t(at(i).min(field.length())));
            let (low, high) =
                values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
            ((low - BEYOND).max(0.0), high + BEYOND)
        })
        .unzip()
}

fn rows(ray: &TestRay) -> Vec<Row> {
    let mean = ray.truth.optical_thickness / LENGTH;
    let (minorants, majorants) = extremes(&ray.profile);
    let edges: Vec<f64> = (0..=CELLS).map(|i| i as f64 * LENGTH / CELLS as f64).collect();
    let cells = CellsSpec::Given { edges: edges.clone(), minorants, majorants: majorants.clone() };
    let piecewise = SamplingSpec::PiecewiseConstant { edges, values: majorants };
    let double = |sigma_samp, control| EstimatorSpec::from(DoubleParticleSpec::at(sigma_samp, control));
    let constant = |sigma_samp| double(sigma_samp, ControlSpec::constant(mean));
    let explorers = |count, sigma_samp| double(sigma_samp, ControlSpec::through(count));
    let next_flight = |version| EstimatorSpec::from(NextFlightSpec { majorant: 1.0, version });
    let series = |version| EstimatorSpec::from(PSeriesSpec { version, pivot: Some(LENGTH) });
    let telescoping = |endpoint_matching| {
        EstimatorSpec::from(TelescopingSpec { teeth: 20, level_ratio: 0.9, endpoint_matching })
    };
    let comb = |teeth, shape, roulette, segments| {
        let marching = UnbiasedRayMarchingSpec::of(shape, teeth);
        EstimatorSpec::from(UnbiasedRayMarchingSpec { roulette, segments, ..marching })
    };
    let usual = |teeth, shape| comb(teeth, shape, RouletteSpec::USUAL, 1);
    // The study tuned with the true variance, here that of the closed form: 2.87e-4 for order 3, 1.2e-4 for a fifth of the ray.
    let tuned = |k2: f64| RouletteSpec::Stop(Roulette::tuned(k2).stop_probability());
    let of =
        |samples| move |variance, rounding, lookups| Some(Figure { variance, rounding, lookups, samples });
    let (figure, closed) = (of(1e6), of(f64::INFINITY));
    let published = |name, spec, figure| Row { name, ours: false, spec, figure, remark: "" };
    let ours = |name, spec, figure| Row { ours: true, ..published(name, spec, figure) };
    let with = |remark, row| Row { remark, ..row };
    use CombShape::{Bernoulli2, Bernoulli3, EndpointMatched, Periodised, Uniform};
    use NextFlightKind::{Bidirectional, Delta, Ratio, Unidirectional};
    let residual = ResidualCellsSpec { cells: cells.clone(), rate: 1.0 }.into();
    let jittered_in_cells = |epsilon| JitteredRatioSpec::in_cells(cells.clone(), epsilon).into();
    let cut = "the study cuts off at level 4";
    let ends = "the study charges 6 look-ups to the ends";
    let each = "the study tunes each segment by itself";
    let many_majorants = DoubleParticleSpec { sigma_samp: piecewise, control: ControlSpec::none() }.into();
    let third = comb(25, Bernoulli3, tuned(3.4e-4), 1);
    let in_five = comb(5, EndpointMatched, tuned(2.5e-4), 5);
    let in_single = comb(1, Uniform, tuned(0.05), 25);
    let adaptive = AdaptiveRatioSpec { majorant: 1.0, floor: 0.1 }.into();
    let jackknife = |teeth| JackknifeSpec { teeth }.into();
    let naive = |teeth| NaiveSpec { teeth }.into();
    vec![
        published("track length", WoodcockSpec { majorant: 1.0 }.into(), figure(29.4, 0.05, 5.21)),
        published("ratio tracking", double(1.0, ControlSpec::none()), figure(6.11, 0.005, 20.0)),
        published("ratio tracking, 20 majorants", many_majorants, figure(12.3, 0.05, 6.7)),
        published("residual ratio in 20 cells", residual, figure(6.54, 0.005, 6.0)),
        published("next-flight delta", next_flight(Delta), None),
        published("next-flight ratio", next_flight(Ratio), figure(8.97, 0.005, 20.0)),
        published("unidirectional", next_flight(Unidirectional), None),
        published("bidirectional", next_flight(Bidirectional), None),
        published("adaptive ratio", adaptive, figure(6.1, 0.05, 13.9)),
        published("p-series CMF", series(PSeriesVersion::Cmf), figure(3.10, 0.005, 33.4)),
        published("p-series cumulative", series(PSeriesVersion::Cumulative), figure(3.09, 0.005, 39.0)),
        published("p-series next-flight", series(PSeriesVersion::NextFlight), None),
        published("residual ratio, mean, rate 1", constant(1.0), figure(2.97, 0.005, 20.0)),
        published("residual ratio, mean, rate 2", constant(2.0), figure(0.991, 0.0005, 40.0)),
        published("10 + 1 explorers, 10 points", explorers(11, 0.5), figure(7.31, 0.005, 21.0)),
        published("16 + 1 explorers, 16 points", explorers(17, 0.8), figure(0.919, 0.0005, 33.0)),
        published("24 + 1 explorers, 8 points", explorers(25, 0.4), figure(0.0984, 5e-5, 33.0)),
        ours("jittered ratio, 0.5", JitteredRatioSpec::below(1.0, 0.5).into(), closed(0.272, 0.0005, 51.9)),
        ours("jittered ratio in 20 cells, 0.5", jittered_in_cells(0.5), closed(0.269, 0.0005, 28.4)),
        ours("jittered ratio in 20 cells, 0.25", jittered_in_cells(0.25), closed(0.0619, 5e-5, 41.2)),
        with(cut, published("telescoping", telescoping(false), figure(0.0487, 5e-5, 22.5))),
        with(cut, ours("telescoping, matched", telescoping(true), figure(0.00110, 5e-6, 24.5))),
        published("unbiased ray marching, 8 teeth", usual(8, Uniform), figure(6.7, 0.05, 10.6)),
        published("unbiased ray marching, 15 teeth", usual(15, Uniform), figure(0.589, 0.0005, 19.8)),
        published("unbiased ray marching, 25 teeth", usual(25, Uniform), figure(0.0271, 5e-5, 33.0)),
        published(
            "unbiased ray marching, 25 teeth, matched",
            usual(25, EndpointMatched),
            figure(3.59e-4, 5e-7, 35.0),
        ),
        ours("periodised comb, 25 teeth", usual(25, Periodised), None),
        ours("Bernoulli comb 2, 25 teeth", usual(25, Bernoulli2), None),
        with(ends, ours("Bernoulli comb 3, 25 teeth, tuned", third, figure(3.51e-4, 5e-7, 31.7))),
        with(each, ours("5 segments of 5 teeth, matched, tuned", in_five, of(2.5e5)(1.49e-3, 5e-6, 31.5))),
        ours("25 segments of one tooth, tuned", in_single, None),
        published("jackknife, 2 x 8 (biased)", jackknife(8), figure(0.74, 0.005, 16.0)),
        published("jackknife, 2 x 25 (biased)", jackknife(25), figure(0.0136, 5e-5, 50.0)),
        published("naive, 8 teeth (biased)", naive(8), None),
        published("naive, 25 teeth (biased)", naive(25), None),
        published("regular tracking", RegularSpec {}.into(), None),
        ours("hybrid", HybridSpec { majorant: Some(1.0) }.into(), None),
    ]
}
