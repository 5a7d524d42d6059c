//! Regular tracking: the closed form of each medium against quadrature.

use super::Kind;
use super::on_profile::estimator;
use super::add;
use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField, analytic_cosine, voxels};
use crate::hard_cases::Subject;
use crate::profiles::constant;
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::transmittance::Observed;
use fairflight_media::{OpticalThickness, PiecewiseConstant, PiecewiseLinear, Tolerance};
use fairflight_stats::Scores;
use fairflight_transmittance::{Regular, TransmittanceEstimator};
use glam::{DVec3, dvec3};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "regular", checks, twins: Vec::new, subjects, spared: &[(15, "it looks nothing up but a closed form")] };

fn checks() -> Vec<Check> {
    let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.5, 4.0], vec![1.2, 0.1, 0.6]).expect(LAWFUL);
    let signed = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 3.5], vec![1.0, -0.5, 0.4]).expect(LAWFUL);
    let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL);
    let oblique = analytic_cosine(dvec3(-9.0, 3.0, -4.0), dvec3(0.55, -0.2, 0.81));
    vec![
        on("constant", constant(0.7, 3.0)),
        on("piecewise_constant", steps),
        on("piecewise_constant_negative", signed),
        on("piecewise_linear", tent),
        on("eq21_seed_ray", analytic_cosine(DVec3::ZERO, DVec3::Z)),
        on("eq21_oblique_ray", oblique),
        on("voxels", voxels()),
    ]
}

/// The closed form against quadrature: one estimate is all there is to know.
fn on<F: SpecimenField + OpticalThickness>(name: &'static str, field: F) -> Check
where
    for<'f, 'e> &'e Regular:
        TransmittanceEstimator<&'f F> + TransmittanceEstimator<Observed<&'f F, &'e Regular>>,
{
    let specimen = Arc::new(Specimen::integrated(name, field, Tolerance::TIGHT));
    add(&specimen, "regular", Law::Transmittance, 1, |specimen, run| {
        specimen.examine(&Regular, &[], |_| Scores::Unbounded, LookupLaw::Fixed, run)
    })
    .about([KIND.name])
}

fn subjects() -> Vec<Subject> {
    vec![estimator!("regular", above: true, below: true, |_| Regular)]
}
