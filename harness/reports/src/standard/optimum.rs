//! The sampling extinction at which a curve is most efficient.

use super::result::{Series, SweepCurve, SweepPoint};
use serde::Serialize;

/// Position of an optimum on its curve. At an end it says less: a wider sweep could find a better one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Place {
    /// Between its ends.
    Inside,
    /// At its least sampling extinction, which is the end of the sweep or of the estimator's domain.
    LowerEnd,
    /// At its greatest one.
    UpperEnd,
}

/// The best point of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Optimum {
    /// σ_samp there \[1/length\].
    pub(crate) sigma_samp: f64,
    /// log10 of the efficiency there, in units of 1/T².
    pub(crate) log10_efficiency: f64,
    /// Its position.
    pub(crate) place: Place,
}

/// The best points of a curve of a sweep.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CurveOptima {
    /// The estimator.
    pub(crate) series: Series,
    /// Its parameters in words.
    pub(crate) parameters: String,
    /// The albedo, where the estimator depends on it.
    pub(crate) albedo: Option<f64>,
    /// The best closed-form efficiency per look-up.
    pub(crate) per_lookup: Option<Optimum>,
    /// The best efficiency per CPU second among the measured points.
    pub(crate) per_second: Option<Optimum>,
}

impl CurveOptima {
    /// The best points of a curve.
    pub(super) fn of(curve: &SweepCurve) -> Self {
        Self {
            series: curve.series,
            parameters: curve.parameters.clone(),
            albedo: curve.albedo,
            per_lookup: best(curve, |point| point.log10_efficiency_per_lookup),
            per_second: best(curve, |point| point.measured.as_ref()?.log10_efficiency_per_second),
        }
    }
}

fn best(curve: &SweepCurve, efficiency: impl Fn(&SweepPoint) -> Option<f64>) -> Option<Optimum> {
    // Zero variance makes the efficiency infinite: there is no optimum to speak of.
    let points: Vec<(f64, f64)> = curve
        .points
        .iter()
        .filter(|point| point.in_domain)
        .filter_map(|point| Some((point.sigma_samp, efficiency(point).filter(|x| x.is_finite())?)))
        .collect();
    let index = (0..points.len()).max_by(|&a, &b| points[a].1.total_cmp(&points[b].1))?;
    let place = match index {
        0 => Place::LowerEnd,
        last if last + 1 == points.len() => Place::UpperEnd,
        _ => Place::Inside,
    };
    Some(Optimum { sigma_samp: points[index].0, log10_efficiency: points[index].1, place })
}
