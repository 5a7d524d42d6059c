//! Checks by exact algebra, and the variance where it is tested for sure.

use super::specimen::{Specimen, SpecimenField};
use super::{Check, Law};
use crate::estimators::add;
use fairflight_collision::{Albedo, CollisionModel, DoubleParticle, SingleParticle, Version, Woodcock};
use fairflight_laws::{CheckResult, collision};
use fairflight_media::{Constant, Vacuum};
use fairflight_transmittance::Tracking;
use std::sync::Arc;

const ALBEDOS: [f64; 5] = [0.0, 0.3, 0.5, 0.9, 1.0];

/// The law of every collision model at every albedo.
pub(super) fn checks() -> Vec<Check> {
    let single = |version| move |albedo| SingleParticle { version, albedo };
    vec![
        model("woodcock", |albedo| Woodcock { albedo }),
        model("double particle", |albedo| DoubleParticle { albedo }).about(["double_particle"]),
        model("terminating", single(Version::Terminating)).about(["single_particle"]),
        model("non-terminating", single(Version::NonTerminating)).about(["single_particle"]),
        model("adaptive", single(Version::Adaptive)).about(["single_particle"]),
    ]
}

fn model<M: CollisionModel>(name: &'static str, of: impl Fn(Albedo) -> M + Send + Sync + 'static) -> Check {
    Check::new(format!("collision/{name}"), Law::Collision, name, "any", 0, move |_| {
        for a in ALBEDOS {
            let Ok(albedo) = Albedo::new(a) else { continue };
            // The end of the terminating domain besides the common ratios.
            let ratios: Vec<f64> = collision::RATIOS.into_iter().chain([2.0 / (1.0 + a)]).collect();
            if let Err(broken) = collision::check(&of(albedo), a, &ratios) {
                return CheckResult::exact(false, format!("albedo {a}: {broken}"));
            }
        }
        CheckResult::exact(true, "eq. 8 holds at every ratio and albedo tried")
    })
}

/// The variance on a profile with a law so mild that moments up to the eighth leave no doubt about the test: whoever
/// passes here was tested.
pub(super) fn variance_checks<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Vec<Check> {
    const SAMPLES: u64 = 125_000;
    let length = specimen.field.length();
    let mild = move |main: f64, sampling: f64, run: fairflight_laws::Run, specimen: &Specimen<F>| {
        let (Ok(control), Ok(sampling)) = (Constant::new(main, length), Constant::new(sampling, length))
        else {
            return CheckResult::exact(false, "refused: control or sigma_samp");
        };
        let model = DoubleParticle { albedo: Albedo::default() };
        tested(specimen.tracking(&Tracking::new(model, control, sampling), run))
    };
    let single = move |version: Version, run: fairflight_laws::Run, specimen: &Specimen<F>| {
        let (Ok(albedo), Ok(sampling)) = (Albedo::new(0.4), Constant::new(1.0, length)) else {
            return CheckResult::exact(false, "refused: albedo or sigma_samp");
        };
        let model = SingleParticle { version, albedo };
        tested(specimen.tracking(&Tracking::new(model, Vacuum::new(length), sampling), run))
    };
    vec![
        add(specimen, "variance_positive_difference", Law::Variance, SAMPLES, move |s, run| {
            mild(0.5, 8.0, run, s)
        })
        .about(["double_particle"]),
        add(specimen, "variance_negative_difference", Law::Variance, SAMPLES, move |s, run| {
            mild(0.9, 8.0, run, s)
        })
        .about(["double_particle"]),
        add(specimen, "variance_without_control", Law::Variance, 3 * SAMPLES, move |s, run| {
            mild(0.0, 8.0, run, s)
        })
        .about(["double_particle"]),
        add(specimen, "variance_non_terminating", Law::Variance, 2 * SAMPLES, move |s, run| {
            single(Version::NonTerminating, run, s)
        })
        .about(["single_particle"]),
    ]
}

/// A variance that could not be tested is not a variance that holds.
fn tested(result: CheckResult) -> CheckResult {
    let holds = if result.variance_is_tested { result.holds } else { result.holds.filter(|holds| !holds) };
    CheckResult { holds, ..result }
}
