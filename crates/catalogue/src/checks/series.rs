//! Next flight, power series and their relatives: each on a bump, on noise, on a chord of szirmay-kalos-2017's medium, and, where it
//! admits that, on a field of both signs.

use super::estimators::add;
use super::media::{LAWFUL, analytic_cosine};
use super::specimen::{Specimen, SpecimenField};
use super::{Check, Law};
use fairflight_laws::CheckResult;
use fairflight_laws::lookups::LookupLaw::{MeanOnly, Poisson, Unknown};
use fairflight_media::{PiecewiseConstant, PiecewiseLinear};
use fairflight_stats::Scores;
use fairflight_transmittance::{
    AdaptiveRatio, Bidirectional, GeneralisedPoisson, NextFlight, NextFlightVersion, PSeries, PSeriesVersion,
    Unidirectional,
};
use glam::{DVec3, dvec3};
use std::sync::Arc;

/// Lists the checks.
pub(super) fn checks() -> Vec<Check> {
    let bump = PiecewiseLinear::new(vec![0.0, 0.5, 1.5], vec![0.1, 1.0, 0.2]).expect(LAWFUL);
    let signed = PiecewiseConstant::new(vec![0.0, 0.4, 0.8, 1.2], vec![1.0, -0.2, 0.4]).expect(LAWFUL);
    // 3.9 units of szirmay-kalos-2017 eq. 21, near the surface of its sphere.
    let chord = analytic_cosine(dvec3(9.8, -3.0, 10.0), DVec3::Y);
    let mut checks = on(&Arc::new(Specimen::closed("series/bump", bump)));
    checks.extend(on(&Arc::new(Specimen::closed("series/noise", noise()))));
    checks.extend(on(&Arc::new(Specimen::closed("series/signed", signed))));
    checks.extend(on(&Arc::new(Specimen::closed("series/eq21_chord", chord))));
    checks
}

/// Sixteen cells that follow no pattern, between 0.1 and 1.5.
fn noise() -> PiecewiseConstant {
    let edges = (0..=16).map(|i| 0.1 * f64::from(i)).collect();
    let values = (0..16_u32).map(|i| 0.1 + 0.2 * f64::from((7 * i * i + 5 * i) % 11 % 8)).collect();
    PiecewiseConstant::new(edges, values).expect(LAWFUL)
}

/// Samples of a quick run, where all moments are known; where the shape is taken from the sample, which asks for a larger one;
/// and for what is most skewed: 1.6 times what the shape of a sample asks for at least ([`super::paths`]). The media are thin for
/// the same reason.
const KNOWN: u64 = 80_000;
const SAMPLED: u64 = 300_000;
const SKEWED: u64 = 900_000;

/// A check of `estimator`, a function of the field that gives a result. A macro, because no bound says of a type that it is an
/// estimator for every lifetime of an observed field.
macro_rules! law {
    ($kind:literal, $specimen:expr, $name:expr, $samples:expr, $lookups:expr, $estimator:expr) => {
        add($specimen, $name, Law::Transmittance, $samples, move |specimen, run| {
            match $estimator(&specimen.field) {
                Ok(estimator) => specimen.examine(&estimator, &[], |_| Scores::Unbounded, $lookups, run),
                Err(error) => CheckResult::exact(false, format!("refused: {error}")),
            }
        })
        .about([$kind])
    };
}

fn on<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Vec<Check> {
    type Never = std::convert::Infallible;
    let positive = specimen.field.minorant() >= 0.0;
    let mut checks = vec![
        law!("next_flight", specimen, "next_flight_ratio", SKEWED, Poisson, |_: &F| Ok::<_, Never>(
            NextFlight::new(NextFlightVersion::Ratio)
        )),
        law!("next_flight", specimen, "unidirectional", SKEWED, Poisson, |_: &F| Ok::<_, Never>(
            Unidirectional
        )),
        law!("next_flight", specimen, "bidirectional", SAMPLED, Poisson, |_: &F| Ok::<_, Never>(
            Bidirectional
        )),
        law!("adaptive_ratio", specimen, "adaptive_ratio", SAMPLED, Unknown, |_: &F| AdaptiveRatio::new(0.1)),
        law!("generalised_poisson", specimen, "generalised_poisson", KNOWN, Poisson, |field: &F| {
            let thickness = field.majorant() * field.length();
            // The residual of a control of a fifth of the majorant.
            GeneralisedPoisson::new(1.2 * thickness, thickness)
        }),
    ];
    if positive {
        checks.push(law!("next_flight", specimen, "next_flight_delta", SKEWED, MeanOnly, |_: &F| Ok::<
            _,
            Never,
        >(
            NextFlight::new(NextFlightVersion::Delta)
        )));
    }
    for (name, version, samples, lookups) in [
        ("p_series_cmf", PSeriesVersion::Cmf, SKEWED, MeanOnly),
        ("p_series_cumulative", PSeriesVersion::Cumulative, SAMPLED, Unknown),
        ("p_series_ratio", PSeriesVersion::Ratio, KNOWN, Poisson),
        ("p_series_next_flight", PSeriesVersion::NextFlight, SKEWED, Poisson),
    ] {
        checks.push(law!("p_series", specimen, name, samples, lookups, |field: &F| PSeries::with_majorant(
            version, field
        )));
    }
    checks
}
