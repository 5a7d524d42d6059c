//! Ray marching, a biased baseline.

use super::Kind;
use super::on_profile::estimator;
use super::add;
use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use fairflight_laws::CheckResult;
use fairflight_transmittance::{Offset, RayMarching};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "ray_marching", checks: Vec::new, twins: Vec::new, subjects, spared: &[] };

/// The expectation of its own on a medium, with fixed points.
pub(crate) fn fixed<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Check {
    marching(specimen, "ray_marching_fixed", Offset::Fixed)
}

/// With a random offset, whose own law is an integral over the offset: cheap where the field has few cells. The naive estimator is
/// the same, by its other name.
pub(crate) fn jittered<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Check {
    marching(specimen, "ray_marching_jittered", Offset::Jittered).about([super::naive::KIND.name])
}

fn marching<F: SpecimenField>(specimen: &Arc<Specimen<F>>, name: &str, offset: Offset) -> Check {
    const STEPS: u32 = 8;
    add(specimen, name, Law::OwnExpectation, 80_000, move |specimen, run| {
        match RayMarching::new(STEPS, offset) {
            Ok(estimator) => specimen.ray_marching(&estimator, run),
            Err(error) => CheckResult::exact(false, format!("refused: {error}")),
        }
    })
    .about([KIND.name])
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("midpoints", above: true, below: true, |_| RayMarching::new(4, Offset::Fixed).expect(LAWFUL)),
        estimator!("one offset", above: true, below: true, |_| {
            RayMarching::new(4, Offset::Jittered).expect(LAWFUL)
        }),
    ]
}
