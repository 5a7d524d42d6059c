//! Residual ratio tracking between bounds in cells.

use super::Kind;
use super::on_profile::estimator;
use super::in_cells::{Celled, add, minorant_thickness, on_all};
use crate::checks::{Check, LAWFUL, SpecimenField};
use crate::hard_cases::Subject;
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::scores;
use fairflight_media::OpticalThickness;
use fairflight_transmittance::ResidualCells;

pub(super) const KIND: Kind = Kind { name: "residual_cells", checks, twins: Vec::new, subjects, spared: &[] };

fn checks() -> Vec<Check> {
    on_all!(on)
}

fn on<F: SpecimenField + OpticalThickness>(specimen: &Celled<F>) -> Vec<Check> {
    [("residual_cells", 1.0), ("residual_cells_rate_2", 2.0)]
        .map(|(name, rate)| {
            let estimator = ResidualCells::new(rate).expect(LAWFUL);
            add(specimen, name, move |specimen, run| {
                let main = minorant_thickness(&specimen.field);
                let scores = |unit| scores::in_cells(main, unit);
                specimen.examine(&estimator, &[], scores, LookupLaw::Poisson, run)
            })
            .about([KIND.name])
        })
        .into()
}

fn subjects() -> Vec<Subject> {
    vec![estimator!("residual cells", above: false, below: true, |_| ResidualCells::default())]
}
