//! The sampling extinction at which a curve is most efficient.

use super::super::result::{SweepCurve, SweepPoint};

/// Where an optimum lies on its curve. At an end it says less: a wider sweep could find a better one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    Inside,
    LowerEnd,
    UpperEnd,
}

/// The best point of a curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Optimum<'a> {
    pub(crate) curve: &'a SweepCurve,
    pub(crate) sigma_samp: f64,
    pub(crate) log10_efficiency: f64,
    pub(crate) place: Place,
}

/// Best closed-form efficiency per look-up.
pub(crate) fn per_lookup(curve: &SweepCurve) -> Option<Optimum<'_>> {
    best(curve, |point| point.log10_efficiency_per_lookup)
}

/// Best efficiency per CPU second among the measured points.
pub(crate) fn per_second(curve: &SweepCurve) -> Option<Optimum<'_>> {
    best(curve, |point| point.measured.as_ref().and_then(|measured| measured.log10_efficiency_per_second))
}

fn best(curve: &SweepCurve, efficiency: impl Fn(&SweepPoint) -> Option<f64>) -> Option<Optimum<'_>> {
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
    Some(Optimum { curve, sigma_samp: points[index].0, log10_efficiency: points[index].1, place })
}
