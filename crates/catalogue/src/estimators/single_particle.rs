//! The three versions of the single particle model at several albedos, below and above r = 1.

use super::Kind;
use super::on_profile::estimator;
use super::add;
use super::woodcock::ENDING;
use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField};
use crate::hard_cases::{Profile, Subject};
use crate::profiles::constant;
use crate::twins::trial::{Wrong, judged, judged_as, theory_on};
use crate::twins::{Evident, Rejection, Twin};
use crate::vectors::{Answer, Variates, Vector};
use fairflight_collision::{Albedo, CollisionModel, SingleParticle, Version};
use fairflight_laws::{CheckResult, Run};
use fairflight_media::{Constant, Extinction, Vacuum};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{SignedProduct, Tracking, TransmittanceEstimator};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "single_particle", checks: Vec::new, twins, subjects, spared: &[] };

const VERSIONS: [(Version, &str); 3] = [
    (Version::Terminating, "terminating"),
    (Version::NonTerminating, "non_terminating"),
    (Version::Adaptive, "adaptive"),
];

/// All versions at these albedos, with σ_samp above the `majorant` (r < 1) and below it: at the middle of 1 and
/// 2/(1 + a) for the maximum, the end of the terminating domain, so that all three are defined.
pub(crate) fn all_versions<F: SpecimenField>(
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
pub(crate) fn of_any_sign<F: SpecimenField>(specimen: &Arc<Specimen<F>>, majorant: f64) -> Vec<Check> {
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
    .about([KIND.name])
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("terminating", above: false, below: false, |profile| of_profile(profile, Version::Terminating)),
        estimator!("non-terminating", above: true, below: true, |profile| {
            of_profile(profile, Version::NonTerminating)
        }),
        estimator!("adaptive", above: true, below: true, |profile| of_profile(profile, Version::Adaptive)),
    ]
}

fn of_profile(profile: &Profile, version: Version) -> Tracking<SingleParticle, Vacuum, Profile> {
    Tracking::new(single(version, 0.5), Vacuum::new(profile.length()), profile.rates(1.0))
}

/// The loop runs while E > 0 instead of while |E| > 0.
struct StopsBelowZero {
    model: SingleParticle,
    sampling: Constant,
}

impl<F: Extinction> Wrong<F> for StopsBelowZero {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        use fairflight_media::InvertOpticalThickness;
        let mut weight = SignedProduct::ONE;
        let mut s = 0.0;
        while let Some(next) = self.sampling.invert(s, source.next_exponential()) {
            s = next;
            let Some(energy) = self.model.transmit(field.sigma_t(s) / self.sampling.sigma_t(s), source)
            else {
                return 0.0;
            };
            weight.multiply(energy);
            if weight.sign() <= 0.0 {
                return 0.0; // right: go on with a negative weight
            }
        }
        weight.times_exp(0.0)
    }
}

fn single(version: Version, albedo: f64) -> SingleParticle {
    SingleParticle { version, albedo: Albedo::new(albedo).expect(LAWFUL) }
}

/// The terminating version judged as the non-terminating one, which admits every r.
fn outside_the_terminating_domain(sigma_t: f64, length: f64, sampling: f64, run: Run) -> Rejection {
    let field = constant(sigma_t, length);
    let sampling = constant(sampling, length);
    let of = |version| Tracking::new(single(version, 0.0), Vacuum::new(length), sampling);
    let theory = theory_on(field, &of(Version::NonTerminating), &[]);
    let refused = !TransmittanceEstimator::admits(&of(Version::Terminating), &field, 0.0, sigma_t);
    let rejection = judged(&field, &of(Version::Terminating), theory, run);
    // A watched run refuses it before any statistics.
    Rejection { rejected: rejection.rejected && refused, ..rejection }
}

/// The terminating version on a test vector of another.
fn terminating(vector: &Vector<'_>, source: &mut Variates<'_>) -> Option<Answer> {
    let (field, sampling, control) = vector.tracked(KIND.name)?;
    (vector.word)("/estimator/version").filter(|version| *version != "terminating")?;
    let model = single(Version::Terminating, vector.estimator("albedo")?);
    Some(Tracking::new(model, control, sampling).estimate(field, source).into())
}

fn twins() -> Vec<Twin> {
    vec![
        // |1 − r| = 1.5 is no probability: the weight is −1 for sure, E = exp(−2 · 0.2) for exp(−0.5). Judged with the
        // moments of the version that is defined there, Var/T² = exp(0.2 · 2.5²) − 1 = 2.49.
        Twin::new(
            "single particle",
            "terminating_above_its_domain",
            "the terminating version at r = 2.5 > 2/(1 + a): |1 − r| taken for a probability",
            "sigma_t 1, length 0.5, sigma_samp 0.4, albedo 0",
            (200_000, Evident::Mean { z: 29.8 }),
            |run| outside_the_terminating_domain(1.0, 0.5, 0.4, run),
        )
        .answers(terminating),
        // E = 1, what a renderer makes of hard case 5, for e; Var/T² = exp(4 · 0.25²) − 1 = 0.284.
        Twin::new(
            "single particle",
            "terminating_below_its_domain",
            "the terminating version at r < 0: negative extinction ignored (hard case 5: 1.0 for 2.718)",
            "sigma_t −0.5, length 2, sigma_samp 2, albedo 0",
            (50_000, Evident::Mean { z: 265.0 }),
            |run| outside_the_terminating_domain(-0.5, 2.0, 2.0, run),
        )
        .answers(terminating),
        // a = 0.5, r = 1.25: only walks without a collision survive, E = exp(−1.6) for exp(−2).
        Twin::new(
            "single particle",
            "stops_below_zero",
            "while E > 0 for while |E| > 0: the walk ends at a negative weight (bars lost in SimulateParticle, errata)",
            "sigma_t 1, length 2, sigma_samp 0.8, albedo 0.5",
            (50_000, Evident::Mean { z: 28.7 }),
            |run| {
                // As in hard case 3.
                let field = constant(1.0, 2.0);
                let sampling = constant(0.8, 2.0);
                let model = single(Version::NonTerminating, 0.5);
                let right = Tracking::new(model, Vacuum::new(2.0), sampling);
                judged_as(&right, &StopsBelowZero { model, sampling }, &field, run)
            },
        )
        .answers(|vector, source| {
            let (field, sampling, control) = vector.tracked(KIND.name)?;
            let version = match (vector.word)("/estimator/version")? {
                "non_terminating" => Version::NonTerminating,
                "adaptive" => Version::Adaptive,
                _ => Version::Terminating,
            };
            let model = single(version, vector.estimator("albedo")?);
            let has_control = control.sigma_t(0.0) > 0.0;
            (!has_control).then(|| StopsBelowZero { model, sampling }.draw(field, source).into())
        }),
    ]
}
