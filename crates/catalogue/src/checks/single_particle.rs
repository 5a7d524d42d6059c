//! The three versions of the single particle model at several albedos, below and above r = 1.

use super::estimators::{ENDING, add};
use super::specimen::{Specimen, SpecimenField};
use super::{Check, Law};
use fairflight_collision::{Albedo, SingleParticle, Version};
use fairflight_laws::CheckResult;
use fairflight_media::{Constant, Vacuum};
use fairflight_transmittance::Tracking;
use std::sync::Arc;

const VERSIONS: [(Version, &str); 3] = [
    (Version::Terminating, "terminating"),
    (Version::NonTerminating, "non_terminating"),
    (Version::Adaptive, "adaptive"),
];

/// All versions at these albedos, with σ_samp above the `majorant` (r < 1) and below it: at the middle of 1 and
/// 2/(1 + a) for the maximum, the end of the terminating domain, so that all three are defined.
pub(super) fn all_versions<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    majorant: f64,
    albedos: &[f64],
) -> Vec<Check> {
    let mut checks = Vec::new();
    for &a in albedos {
        let greatest_ratio = 0.5 * (1.0 + 2.0 / (1.0 + a));
        for (version, version_name) in VERSIONS {
            for (side, sampling) in [("above", 1.25 * majorant), ("below", majorant / greatest_ratio)] {
                let name = format!("{version_name}_albedo_{a}_{side}_the_extinction");
                checks.push(one(specimen, &name, version, a, sampling));
            }
        }
    }
    checks
}

/// The two versions that admit every r, with σ_samp at the `majorant`: a field of either sign.
pub(super) fn of_any_sign<F: SpecimenField>(specimen: &Arc<Specimen<F>>, majorant: f64) -> Vec<Check> {
    VERSIONS[1..]
        .iter()
        .map(|&(version, name)| one(specimen, &format!("{name}_albedo_0.5"), version, 0.5, majorant))
        .collect()
}

fn one<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    name: &str,
    version: Version,
    albedo: f64,
    sampling: f64,
) -> Check {
    let length = specimen.field.length();
    add(specimen, name, Law::Transmittance, ENDING, move |specimen, run| {
        let (Ok(albedo), Ok(sampling)) = (Albedo::new(albedo), Constant::new(sampling, length)) else {
            return CheckResult::exact(false, "refused: albedo or sigma_samp");
        };
        let model = SingleParticle { version, albedo };
        specimen.tracking(&Tracking::new(model, Vacuum::new(length), sampling), run)
    })
    .about(["single_particle"])
}
