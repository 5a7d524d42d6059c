//! A check of an estimator on a specimen.

use crate::checks::{Check, Law, Specimen, SpecimenField};
use fairflight_laws::{CheckResult, Run};
use std::sync::Arc;

/// A check named after its medium and its estimator.
pub(crate) fn add<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    name: &str,
    law: Law,
    samples: u64,
    run: impl Fn(&Specimen<F>, Run) -> CheckResult + Send + Sync + 'static,
) -> Check {
    let (id, medium) = (format!("{}/{name}", specimen.name), specimen.name);
    let samples = samples / specimen.frugality;
    let specimen = Arc::clone(specimen);
    Check::new(id, law, name.replace('_', " "), medium.replace('_', " "), samples, move |arguments| {
        run(&specimen, arguments)
    })
}

/// The law of an estimator that is made from the field, where nothing bounds its scores. A macro, because no bound says of a type that
/// it is an estimator for every lifetime of an observed field.
macro_rules! law {
    ($specimen:expr, $name:expr, $samples:expr, $lookups:expr, |$field:pat_param| $estimator:expr) => {
        crate::estimators::add(
            $specimen,
            $name,
            crate::checks::Law::Transmittance,
            $samples,
            move |specimen, run| {
                let $field = &specimen.field;
                let estimator = $estimator;
                specimen.examine(&estimator, &[], |_| fairflight_stats::Scores::Unbounded, $lookups, run)
            },
        )
        .about([KIND.name])
    };
}
pub(crate) use law;
