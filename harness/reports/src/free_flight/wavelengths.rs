//! Section 3.2: one distance for two wavelengths.

use crate::measured::Measured;
use crate::run::{Part, Run};
use fairflight_document::{Axis, Cell, Chart, Curve, Section, Table};
use fairflight_harness::Failure;
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
    pub(super) variance: Measured,
    pub(super) closed_form: f64,
    pub(super) verdict: Verdict,
}

pub(super) struct Wavelengths {
    pub(super) points: Vec<Point>,
    /// Sample variances over [`GROWING`], per ratio of [`INFINITE`].
    pub(super) growing: Vec<(f64, Vec<f64>)>,
    pub(super) part: Part,
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
    let samples = run.quick_or(200_000, 4_000_000);
    let mut points = Vec::new();
    for &ratio in &RATIOS {
        let seed = run.seed(format_args!("wavelengths/{ratio}"));
        let moments = measure(seed, samples, |source| weight(ratio, source)).map_err(Failure::refused)?;
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
            variance: Measured::normal(variance, error),
            closed_form: closed_form(ratio),
            verdict,
        });
        run.advance();
    }
    let mut growing = Vec::new();
    for &ratio in &INFINITE {
        let mut variances = Vec::new();
        for &n in &GROWING {
            let seed = run.seed(format_args!("wavelengths/{ratio}/{n}"));
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
    let part = Part { section: section(&points, &growing, samples), unsound };
    Ok(Wavelengths { points, growing, part })
}

fn section(points: &[Point], growing: &[(f64, Vec<f64>)], samples: u64) -> Section {
    let text = format!(
        "∫ exp(−σ₁ t) dt in an endless homogeneous medium, by distances of another wavelength's σ₂: {samples} estimates for each ratio, \
         σ₁ = 1. The variance is 1/(2σ₁σ₂ − σ₂²) − 1/σ₁², and infinite from σ₂ = 2σ₁ on. A hollow mark is a sample variance that this number \
         cannot test: near 2 its own fourth moment is infinite."
    );
    let marks = points.iter().filter(|point| point.closed_form > 0.0).map(|point| {
        let mark = point.variance.mark(point.ratio);
        if point.verdict.variance_p.is_some() { mark } else { mark.hollow() }
    });
    let line = (5..=399).map(|i| f64::from(i) * 0.005).filter(|ratio| (ratio - 1.0).abs() > 0.02);
    let chart = Chart::new(
        "wavelengths-variance",
        "Variance of one wavelength sampled by another",
        Axis::linear("σ₂/σ₁ [1]"),
        Axis::logarithmic("variance · σ₁² [1]").within(1e-3, 1e3),
    )
    .with_curves(vec![
        Curve::method("measured").with_marks(marks),
        Curve::reference("formula of 3.2", line.map(|ratio| (ratio, closed_form(ratio)))),
    ]);
    let verdict = |point: &Point| match (point.verdict.sound, point.verdict.variance_p.is_some()) {
        (Some(false), _) => "does not hold",
        (Some(true), true) => "holds",
        (Some(true), false) => "mean holds, variance not testable",
        (None, _) => "not testable",
    };
    let table = Table::of(
        ["wavelengths-table", "Variance against the formula", ""],
        points,
        &[
            ("σ₂/σ₁", "1", &|point| Cell::Number(point.ratio)),
            ("formula", "1", &|point| Cell::Number(point.closed_form)),
            ("measured", "1", &|point| point.variance.cell()),
            ("z of the mean", "1", &|point| Cell::maybe(point.verdict.mean_z)),
            ("z of the variance", "1", &|point| Cell::maybe(point.verdict.variance_z)),
            ("verdict", "", &|point| Cell::text(verdict(point))),
        ],
    );
    let growing = growing
        .iter()
        .flat_map(|(ratio, variances)| GROWING.into_iter().zip(variances).map(move |(n, v)| (*ratio, n, *v)));
    let infinite = Table::of(
        [
            "wavelengths-infinite",
            "Where the variance is infinite",
            "The sample variance of more and more estimates: it settles nowhere.",
        ],
        growing,
        &[
            ("σ₂/σ₁", "1", &|(ratio, ..)| Cell::Number(*ratio)),
            ("estimates", "1", &|(_, n, _)| Cell::Count(*n)),
            ("sample variance", "1", &|(.., variance)| Cell::Number(*variance)),
        ],
    );
    Section::new("wavelengths", "raab-2008 section 3.2: two wavelengths at once")
        .with(text)
        .with(chart)
        .with(table)
        .with(infinite)
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
