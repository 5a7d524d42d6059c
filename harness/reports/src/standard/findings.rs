//! Answers of the report, made of its numbers: the estimator to take, the sampling extinction to take, and whether all is sound.

use super::Subject;
use super::result::{EstimatorRow, MediumReport, Series, StabilityRow, SweepCurve, SweepMeasurement};
use fairflight_harness::result::number;
use serde::Serialize;

/// Answers on one ray.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Findings {
    /// The most efficient estimators per look-up, the best first.
    pub(crate) per_lookup: Vec<Best>,
    /// The most efficient estimators per CPU second, the best first.
    pub(crate) per_second: Vec<Best>,
    /// Limits of variance times look-ups of the double particle model.
    pub(crate) limits: Vec<Limit>,
    /// Verdicts on the measured points of unbiased estimators, of the sweeps and of the table.
    pub(crate) agreement: Agreement,
}

/// An efficient estimator that is unbiased and does not presume the answer.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Best {
    /// The estimator.
    pub(crate) series: Series,
    /// Its parameters in words.
    pub(crate) parameters: String,
    /// log10 of its efficiency, in units of 1/T².
    pub(crate) log10_efficiency: f64,
    /// Its efficiency over that of ratio tracking at the majorant.
    #[serde(serialize_with = "number")]
    pub(crate) gain: Option<f64>,
    /// Its look-ups per estimate.
    pub(crate) lookups: f64,
}

/// Limit of variance times look-ups of the double particle model for great sampling extinctions.
///
/// With J := ∫ (σ_t − σ_main)² ds, Var/T² = exp(J/σ_samp) − 1 (szirmay-kalos-2017 eq. 16), and a walk makes σ_samp·L look-ups, n more through
/// explorers. The product (exp(J/σ_samp) − 1)(σ_samp·L + n) falls in σ_samp to J·L: there is no best sampling extinction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Limit {
    /// The estimator.
    pub(crate) series: Series,
    /// J·L, the limit of Var/T² times look-ups \[1\].
    pub(crate) product: f64,
    /// The product at σ_samp = majorant over its limit.
    pub(crate) at_majorant: f64,
    /// The σ_samp from which on the product is at most a tenth above its limit \[1/length\].
    pub(crate) within_a_tenth_from: f64,
}

/// Verdicts on measured points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub(crate) struct Agreement {
    /// Points.
    pub(crate) measured: usize,
    /// Points that agree with the closed forms.
    pub(crate) agree: usize,
    /// Points that do not.
    pub(crate) disagree: usize,
}

impl Agreement {
    /// The verdicts of many points.
    pub(super) fn of<'a>(points: impl Iterator<Item = &'a SweepMeasurement>) -> Self {
        points.fold(Self::default(), |sum, point| Self {
            measured: sum.measured + 1,
            agree: sum.agree + usize::from(point.sound == Some(true)),
            disagree: sum.disagree + usize::from(point.sound == Some(false)),
        })
    }

    /// The sum of two.
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            measured: self.measured + other.measured,
            agree: self.agree + other.agree,
            disagree: self.disagree + other.disagree,
        }
    }
}

/// Estimators that are told.
const TOLD: usize = 3;

pub(super) fn of(subject: &Subject, sweeps: &[SweepCurve], rows: &[EstimatorRow]) -> Findings {
    let best = |efficiency: fn(&EstimatorRow) -> Option<f64>| {
        let reference = rows.iter().find(|row| row.series == Series::DoubleParticle).and_then(efficiency);
        let mut best: Vec<Best> = rows
            .iter()
            .filter(|row| !row.is_biased && !row.is_oracle)
            .filter_map(|row| {
                let log10_efficiency = efficiency(row)?;
                Some(Best {
                    series: row.series,
                    parameters: row.parameters.clone(),
                    log10_efficiency,
                    gain: reference.map(|reference| 10_f64.powf(log10_efficiency - reference)),
                    lookups: row.lookups,
                })
            })
            .collect();
        best.sort_by(|a, b| b.log10_efficiency.total_cmp(&a.log10_efficiency));
        best.truncate(TOLD);
        best
    };
    let double = [Series::DoubleParticle, Series::DoubleParticleMean, Series::DoubleParticleExplorers];
    let of_double = sweeps.iter().filter(|curve| double.contains(&curve.series));
    Findings {
        per_lookup: best(|row| row.log10_efficiency_per_lookup),
        per_second: best(|row| row.measured.log10_efficiency_per_second),
        limits: of_double.filter_map(|curve| limit(subject, curve)).collect(),
        agreement: Agreement::of(unbiased(sweeps, rows)),
    }
}

fn unbiased<'a>(
    sweeps: &'a [SweepCurve],
    rows: &'a [EstimatorRow],
) -> impl Iterator<Item = &'a SweepMeasurement> {
    let curves = sweeps.iter().filter(|curve| !curve.series.is_baseline());
    let points = curves.flat_map(|curve| &curve.points).filter_map(|point| point.measured.as_ref());
    points.chain(rows.iter().filter(|row| !row.is_biased).map(|row| &row.measured))
}

fn limit(subject: &Subject, curve: &SweepCurve) -> Option<Limit> {
    let last = curve.points.iter().rfind(|point| point.log10_relative_variance.is_some())?;
    let length = subject.facts.length;
    let walk = last.sigma_samp * length;
    let explorers = last.lookups? - walk;
    let introduced = last.sigma_samp * 10_f64.powf(last.log10_relative_variance?).ln_1p();
    let product = introduced * length;
    // (exp(x) − 1)/x · (1 + n x/(J L)) with x = J/σ_samp, which rises from 1.
    let over_limit = |x: f64| x.exp_m1() / x * (1.0 + explorers * x / product);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if over_limit(middle) > 1.1 { high = middle } else { low = middle }
    }
    Some(Limit {
        series: curve.series,
        product,
        at_majorant: over_limit(introduced / subject.majorant),
        within_a_tenth_from: introduced / high,
    })
}

/// Sentences on what contradicts a closed form or a hard case.
pub(super) fn unsound(media: &[MediumReport], stability: &[StabilityRow]) -> Vec<String> {
    let mut unsound = Vec::new();
    for medium in media {
        let off = |measured: &SweepMeasurement| {
            let z = |z: Option<f64>| z.map_or("not tested".to_owned(), |z| format!("{z:.1}"));
            format!(
                "mean {} and variance {} standard errors off over {} estimates",
                z(measured.mean_z),
                z(measured.variance_z),
                measured.samples
            )
        };
        let is_off = |measured: &&SweepMeasurement| measured.sound == Some(false);
        for curve in medium.sweeps.iter().filter(|curve| !curve.series.is_baseline()) {
            for point in &curve.points {
                if let Some(measured) = point.measured.as_ref().filter(is_off) {
                    let (label, sigma_samp) = (curve.series.label(), point.sigma_samp);
                    let off = off(measured);
                    unsound.push(format!("{}: {label} at sigma_samp = {sigma_samp:.4}: {off}.", medium.id));
                }
            }
        }
        for row in medium.estimators.iter().filter(|row| !row.is_biased && is_off(&&row.measured)) {
            unsound.push(format!("{}: {}: {}.", medium.id, row.series.label(), off(&row.measured)));
        }
    }
    let wrong = stability.iter().filter(|row| !row.passes);
    unsound.extend(wrong.map(|row| format!("Hard case {} is wrong: {}.", row.number, row.case)));
    unsound
}
