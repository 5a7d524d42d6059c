//! The jackknife of a comb, a biased baseline.

use super::Kind;
use super::on_profile::estimator;
use super::add;
use super::profiles::{rough_cells, seed_ray, tent};
use super::unbiased_ray_marching::four_teeth;
use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use fairflight_laws::lookups::LookupLaw;
use fairflight_stats::Scores;
use fairflight_transmittance::{Comb, CombShape, Jackknife};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "jackknife", checks, twins: Vec::new, subjects, spared: &[] };

fn checks() -> Vec<Check> {
    vec![on(&tent(), 2), on(&seed_ray(), 8), on(&rough_cells(), 12)]
}

/// The expectation of its own.
fn on<F: SpecimenField>(specimen: &Arc<Specimen<F>>, teeth: u32) -> Check {
    let comb = Comb::new(teeth, CombShape::Uniform).expect(LAWFUL);
    add(specimen, "jackknife", Law::OwnExpectation, 250_000, move |specimen, run| {
        let jackknife = Jackknife::new(comb);
        let result = specimen.examine_in_lanes(&jackknife, &[], |_| Scores::Unbounded, |_| LookupLaw::Fixed, run);
        specimen.baseline(&jackknife, result)
    })
    .about([KIND.name])
}

fn subjects() -> Vec<Subject> {
    vec![estimator!("jackknife", above: true, below: true, |_| Jackknife::new(four_teeth()))]
}
