//! A small made-up report with every kind of trouble: gaps, infinities, zero variance, curves that leave, untestable points.

use super::findings::{Agreement, Best, Findings, Limit};
use super::optimum::CurveOptima;
use super::result::*;
use fairflight_document::{Claim, ClaimVerdict, Provenance};

/// The report.
pub(super) fn report() -> Report {
    Report {
        provenance: Provenance {
            seed: 1,
            revision: "0".to_owned(),
            command: "harness report --quick".to_owned(),
        },
        quick: true,
        seconds: 1.5,
        threads: 2,
        media: vec![medium()],
        images: vec![images()],
        claims: [
            ClaimVerdict::Holds,
            ClaimVerdict::HoldsUnder,
            ClaimVerdict::DoesNotHold,
            ClaimVerdict::NotTestable,
        ]
        .into_iter()
        .map(claim)
        .collect(),
        stability: vec![StabilityRow {
            number: 1,
            case: "a ray | of <length> zero".to_owned(),
            exact: "1".to_owned(),
            ours: "1".to_owned(),
            passes: true,
        }],
        unsound: Vec::new(),
    }
}

fn claim(verdict: ClaimVerdict) -> Claim {
    Claim {
        id: "S1".to_owned(),
        claim: "a claim | with a bar & σ_t < σ_samp".to_owned(),
        source: "paper, eq. 1".to_owned(),
        measured: "1.0 [0.9, 1.1]".to_owned(),
        verdict,
        comment: "a \"comment\"".to_owned(),
    }
}

fn series() -> impl Iterator<Item = Series> {
    Series::LABELLED.into_iter().map(|known| known.0).chain([Series::Entrant("adaptive ratio")])
}

/// Place of a series among all.
fn rank(of: Series) -> f64 {
    series().position(|known| known == of).unwrap() as f64
}

fn medium() -> MediumReport {
    let sweeps: Vec<SweepCurve> = series().flat_map(sweep_curves).collect();
    let s: Vec<f64> = (0..=20).map(|k| f64::from(k) / 10.0).collect();
    let transmittance: Vec<f64> = s.iter().map(|s| (-s).exp()).collect();
    MediumReport {
        id: "eq21".to_owned(),
        title: "A medium".to_owned(),
        description: "Made up.".to_owned(),
        ray: RayFacts {
            entry: [0.0; 3],
            direction: [1.0, 0.0, 0.0],
            length: 2.0,
            optical_thickness: 2.0,
            optical_thickness_error: 1e-14,
            transmittance: (-2.0_f64).exp(),
            maximum: 1.0,
            mean: 1.0,
        },
        optima: sweeps.iter().map(CurveOptima::of).collect(),
        sweeps,
        convergence: series().map(convergence).collect(),
        estimators: series().map(row).collect(),
        refused: vec![Refusal { series: Series::Entrant("regular"), reason: "made up".to_owned() }],
        findings: findings(),
        anatomy: Anatomy {
            sigma_samp: 0.8,
            sigma_t: s.iter().map(|s| 1.0 - (4.0 * s).cos()).collect(),
            sigma_main: s.iter().map(|s| 1.1 - (3.9 * s).cos()).collect(),
            transmittance: transmittance.clone(),
            sampled: s.iter().map(|s| (-0.9 * s).exp()).collect(),
            explorers: vec![[0.2, 0.3], [1.0, 1.6]],
            interactions: vec![[0.4, 1.0], [1.9, 0.7]],
            s: s.clone(),
        },
        functions: SampleFunctions {
            sigma_samp: 0.8,
            explorers: 4,
            standard_deviation: s.iter().map(|s| 0.1 * s).collect(),
            samples: (0..3)
                .map(|k| s.iter().map(|s| (-s).exp() * (1.0 + f64::from(k - 1) * 0.2 * s)).collect())
                .collect(),
            transmittance,
            s,
        },
    }
}

fn row(series: Series) -> EstimatorRow {
    let point = sweep_point(series, 8, rank(series));
    EstimatorRow {
        series,
        kind: "woodcock",
        parameters: "majorant 1".to_owned(),
        is_biased: series.is_baseline(),
        is_oracle: series.is_oracle(),
        log10_relative_variance: point.log10_relative_variance,
        is_closed: series != Series::Woodcock,
        lookups: 2.0,
        log10_efficiency_per_lookup: (series != Series::Adaptive).then_some(-1.0),
        measured: point.measured.unwrap(),
    }
}

fn findings() -> Findings {
    let best = |gain| Best {
        series: Series::Adaptive,
        parameters: "albedo 0.5".to_owned(),
        log10_efficiency: -1.0,
        gain,
        lookups: 2.0,
    };
    Findings {
        per_lookup: vec![best(Some(3.0))],
        per_second: vec![best(None)],
        limits: vec![Limit {
            series: Series::DoubleParticle,
            product: 40.0,
            at_majorant: 2.0,
            within_a_tenth_from: 5.0,
        }],
        agreement: Agreement { measured: 9, agree: 7, disagree: 0 },
    }
}

fn sweep_curves(series: Series) -> Vec<SweepCurve> {
    let single = matches!(series, Series::Terminating | Series::NonTerminating | Series::Adaptive);
    let albedos: Vec<Option<f64>> = if single { vec![Some(0.0), Some(0.5), Some(0.9)] } else { vec![None] };
    let shift = rank(series) / 3.0;
    albedos
        .into_iter()
        .map(|albedo| SweepCurve {
            series,
            parameters: "a parameter, with a comma".to_owned(),
            albedo,
            points: (0..=12).map(|k| sweep_point(series, k, shift + albedo.unwrap_or(0.0))).collect(),
        })
        .collect()
}

fn sweep_point(series: Series, k: u32, shift: f64) -> SweepPoint {
    let sigma_samp = 10_f64.powf(f64::from(k) / 6.0 - 1.0);
    let in_domain = series != Series::Woodcock || sigma_samp > 0.9;
    // From far above the figure down to no variance at all.
    let log10_variance = if k == 12 { f64::NEG_INFINITY } else { 16.0 - 2.0 * f64::from(k) + shift };
    let variance = 10_f64.powf(log10_variance);
    let testable = k.is_multiple_of(4);
    let measured = (in_domain && k.is_multiple_of(2)).then(|| SweepMeasurement {
        samples: 1000,
        relative_mean: 1.0,
        relative_variance: variance,
        relative_variance_interval: [0.5 * variance, 2.0 * variance],
        testable,
        mean_z: Some(0.5),
        variance_z: testable.then_some(-0.5),
        sound: testable.then_some(k != 4),
        lookups: 2.0 * sigma_samp,
        nanoseconds: 100.0,
        log10_efficiency_per_second: (variance > 0.0).then_some(7.0 - log10_variance),
    });
    SweepPoint {
        sigma_samp,
        in_domain,
        log10_relative_variance: in_domain.then_some(log10_variance),
        lookups: in_domain.then_some(2.0 * sigma_samp),
        log10_efficiency_per_lookup: in_domain.then_some(-log10_variance - sigma_samp.log10()),
        measured,
    }
}

fn convergence(series: Series) -> ConvergenceCurve {
    let shift = rank(series) / 4.0;
    let points = (0..6).map(|k| {
        let lookups = 10_f64.powi(k);
        let relative_bias = if series.is_baseline() { 0.01 } else { 0.0 };
        let rmse = 10_f64.powf(shift) / lookups.sqrt() + relative_bias;
        ConvergencePoint {
            estimates: 1 << k,
            replicas: 100,
            lookups,
            seconds: 1e-7 * lookups,
            relative_rmse: rmse,
            interval: [0.8 * rmse, 1.2 * rmse],
            relative_bias,
            predicted: (series != Series::Woodcock).then_some(rmse),
        }
    });
    ConvergenceCurve { series, parameters: String::new(), points: points.collect() }
}

fn images() -> ImageStudy {
    let exact: Vec<f64> = (0..12 * 8).map(|k| f64::from(k) / 95.0).collect();
    let panel = |series| ImagePanel {
        series,
        name: series.label(),
        parameters: "a parameter".to_owned(),
        pixels: exact.iter().enumerate().map(|(k, t)| t + if k % 2 == 0 { 0.1 } else { -0.1 }).collect(),
        lookups_per_pixel: 10.0,
        rmse: 0.1,
        rmse_interval: [0.09, 0.11],
        seconds: 0.1,
    };
    ImageStudy {
        medium: "eq21".to_owned(),
        budget: 10.0,
        resolution: [12, 8],
        exact_error: 1e-13,
        panels: series().map(panel).collect(),
        exact,
    }
}
