//! Section 3.2: one distance for two wavelengths.

use crate::Failure;
use crate::report::document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use crate::report::run::Run;
use fairflight_laws::measure;
use fairflight_sources::{Seeded, UniformSource};
use fairflight_stats::{ClosedMoments, Reference, Scores, Verdict, judge};

/// σ₂/σ₁, with σ₁ = 1.
const RATIOS: [f64; 10] = [0.25, 0.5, 0.8, 1.0, 1.1, 1.3, 1.5, 1.7, 1.9, 1.99];
/// Those from which on the variance is infinite.
const INFINITE: [f64; 3] = [2.0, 2.5, 4.0];
/// Samples over which the sample variance is followed.
const GROWING: [u64; 4] = [1 << 12, 1 << 16, 1 << 20, 1 << 24];

pub(super) fn steps() -> u64 {
    (RATIOS.len() + INFINITE.len()) as u64
}

/// One ratio with a finite variance.
pub(super) struct Point {
    pub(super) ratio: f64,
    pub(super) variance: f64,
    pub(super) closed_form: f64,
    interval: [f64; 2],
    pub(super) verdict: Verdict,
}

pub(super) struct Wavelengths {
    pub(super) points: Vec<Point>,
    /// Sample variances over [`GROWING`], per ratio of [`INFINITE`].
    pub(super) growing: Vec<(f64, Vec<f64>)>,
    pub(super) section: Section,
    pub(super) unsound: Vec<String>,
}

/// exp(−σ₁ t)/(σ₂ exp(−σ₂ t)) at a distance t with the density σ₂ exp(−σ₂ t): an estimate of ∫ exp(−σ₁ t) dt = 1/σ₁, σ₁ = 1.
fn weight(ratio: f64, source: &mut Seeded) -> f64 {
    let t = source.next_exponential() / ratio;
    ((ratio - 1.0) * t).exp() / ratio
}

/// E\[X^k\] = ∫ exp(−k t) (σ₂ exp(−σ₂ t))^(1 − k) dt = σ₂^(1 − k)/(k − (k − 1) σ₂), infinite where the denominator is not positive.
fn raw_moment(ratio: f64, k: i32) -> f64 {
    let rest = f64::from(k) - f64::from(k - 1) * ratio;
    if rest > 0.0 { ratio.powi(1 - k) / rest } else { f64::INFINITY }
}

/// raab-2008 section 3.2, σ₁ = 1.
fn closed_form(ratio: f64) -> f64 {
    1.0 / (2.0 * ratio - ratio * ratio) - 1.0
}

/// The moments that are finite: the law is known as far as those go.
fn reference(ratio: f64) -> Reference {
    let raw: Vec<f64> =
        (1..=8).map(|k| raw_moment(ratio, k)).take_while(|moment| moment.is_finite()).collect();
    Reference {
        moments: Some(ClosedMoments::from_raw(&raw)),
        scores: Scores::Unbounded,
        ..Reference::exact(1.0)
    }
}

pub(super) fn study(run: &Run<'_>) -> Result<Wavelengths, Failure> {
    let samples = if run.options.quick { 200_000 } else { 4_000_000 };
    let mut points = Vec::new();
    for (k, &ratio) in RATIOS.iter().enumerate() {
        let moments = measure(run.seed(5, k as u64), samples, |source| weight(ratio, source))
            .map_err(Failure::refused)?;
        let reference = reference(ratio);
        let verdict = judge(&moments, &reference, 1e-7);
        let variance = moments.sample_variance().unwrap_or(f64::NAN);
        let error = reference
            .moments
            .and_then(|closed| closed.variance_standard_error(samples as f64))
            .filter(|error| error.is_finite())
            .or_else(|| moments.variance_standard_error())
            .unwrap_or(f64::NAN);
        points.push(Point {
            ratio,
            variance,
            closed_form: closed_form(ratio),
            interval: [variance - 1.96 * error, variance + 1.96 * error],
            verdict,
        });
        run.advance();
    }
    let mut growing = Vec::new();
    for (k, &ratio) in INFINITE.iter().enumerate() {
        let mut variances = Vec::new();
        for (m, &n) in GROWING.iter().enumerate() {
            let seed = run.seed(6, 10 * k as u64 + m as u64);
            let moments = measure(seed, n, |source| weight(ratio, source)).map_err(Failure::refused)?;
            variances.push(moments.sample_variance().unwrap_or(f64::NAN));
        }
        growing.push((ratio, variances));
        run.advance();
    }
    let unsound = points
        .iter()
        .filter(|point| point.verdict.sound == Some(false))
        .map(|point| format!("two wavelengths at ratio {}: {}", point.ratio, point.verdict.reason))
        .collect();
    let section = section(&points, &growing, samples);
    Ok(Wavelengths { points, growing, section, unsound })
}

fn section(points: &[Point], growing: &[(f64, Vec<f64>)], samples: u64) -> Section {
    let mut section = Section::new("wavelengths", "raab-2008 section 3.2: two wavelengths at once");
    section.text = vec![format!(
        "∫ exp(−σ₁ t) dt in an endless homogeneous medium, by distances of another wavelength's σ₂: {samples} estimates for each ratio, \
         σ₁ = 1. The variance is 1/(2σ₁σ₂ − σ₂²) − 1/σ₁², and infinite from σ₂ = 2σ₁ on. A hollow mark is a sample variance that this number \
         cannot test: near 2 its own fourth moment is infinite."
    )];
    let mut chart = Chart::new(
        "wavelengths-variance",
        "Variance of one wavelength sampled by another",
        Axis::linear("σ₂/σ₁ [1]"),
        Axis::logarithmic("variance · σ₁² [1]").within(1e-3, 1e3),
    );
    let marks = points.iter().filter(|point| point.closed_form > 0.0).map(|point| {
        let mark = Mark::measured(point.ratio, point.variance, point.interval);
        if point.verdict.variance_p.is_some() { mark } else { mark.hollow() }
    });
    let line = (5..=399).map(|i| f64::from(i) * 0.005).filter(|ratio| (ratio - 1.0).abs() > 0.02);
    chart.curves = vec![
        Curve::method("measured").with_marks(marks.collect::<Vec<_>>()),
        Curve::reference("formula of 3.2", line.map(|ratio| (ratio, closed_form(ratio)))),
    ];
    section.charts = vec![chart];
    let mut table = Table::new(
        "wavelengths-table",
        "Variance against the formula",
        "",
        &[
            ("σ₂/σ₁", "1"),
            ("formula", "1"),
            ("measured", "1"),
            ("z of the mean", "1"),
            ("z of the variance", "1"),
            ("verdict", ""),
        ],
    );
    for point in points {
        table.rows.push(vec![
            Cell::Number(point.ratio),
            Cell::Number(point.closed_form),
            Cell::measured(point.variance, point.interval),
            Cell::maybe(point.verdict.mean_z),
            Cell::maybe(point.verdict.variance_z),
            Cell::text(match (point.verdict.sound, point.verdict.variance_p.is_some()) {
                (Some(false), _) => "does not hold",
                (Some(true), true) => "holds",
                (Some(true), false) => "mean holds, variance not testable",
                (None, _) => "not testable",
            }),
        ]);
    }
    let mut infinite = Table::new(
        "wavelengths-infinite",
        "Where the variance is infinite",
        "The sample variance of more and more estimates: it settles nowhere.",
        &[("σ₂/σ₁", "1"), ("estimates", "1"), ("sample variance", "1")],
    );
    for (ratio, variances) in growing {
        for (n, variance) in GROWING.iter().zip(variances) {
            infinite.rows.push(vec![Cell::Number(*ratio), Cell::Count(*n), Cell::Number(*variance)]);
        }
    }
    section.tables = vec![table, infinite];
    section
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_moment_is_the_formula() {
        for ratio in [0.3, 0.9, 1.5, 1.99] {
            let variance = raw_moment(ratio, 2) - raw_moment(ratio, 1).powi(2);
            assert!((variance - closed_form(ratio)).abs() < 1e-12 * (1.0 + variance), "{ratio}");
        }
        assert_eq!(raw_moment(2.0, 2), f64::INFINITY);
        assert_eq!(raw_moment(1.34, 4), f64::INFINITY);
    }
}
