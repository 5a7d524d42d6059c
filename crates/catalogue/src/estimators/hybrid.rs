//! The hybrid, taught by pilots of the same profile: whatever it chooses, and whatever it was taught.

use super::Kind;
use super::on_profile::{ONE_MAJORANT, estimator};
use super::add;
use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField, analytic_cosine};
use crate::hard_cases::Subject;
use fairflight_laws::{CheckResult, Run};
use fairflight_laws::lookups::LookupLaw;
use fairflight_media::{Extinction, PiecewiseConstant, PiecewiseLinear};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::Scores;
use fairflight_transmittance::{Experience, Hybrid, Pilot};
use glam::DVec3;
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "hybrid", checks, twins: Vec::new, subjects, spared: &[ONE_MAJORANT, (9, STRATA), (20, STRATA)] };

const STRATA: &str = "its law is one of each stratum of one majorant, of which there would be a million";

/// Samples of a quick run: the law of the variance is that of the chosen estimator, of which only two moments may be known.
const SAMPLES: u64 = 80_000;
/// Pilots that teach.
const PILOTS: u64 = 12;

fn checks() -> Vec<Check> {
    let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 0.9, 0.2]).expect(LAWFUL);
    let smooth = Arc::new(Specimen::closed("hybrid/tent", tent));
    let edges = (0..=60).map(|i| f64::from(i) / 20.0).collect();
    // Multiples of a prime: noise.
    let values = (0..60).map(|i: i32| f64::from((i * i * 379 + i * 811) % 997) / 1000.0).collect();
    let rough =
        Arc::new(Specimen::closed("hybrid/noise", PiecewiseConstant::new(edges, values).expect(LAWFUL)));
    let ray = Arc::new(Specimen::closed("hybrid/eq21_seed_ray", analytic_cosine(DVec3::ZERO, DVec3::Z)));
    vec![taught(&smooth), untaught(&smooth), taught(&rough), untaught(&rough), taught(&ray)]
}

/// Check of a hybrid with experience from pilots of the profile itself, from a stream that no estimate draws from.
fn taught<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Check {
    add(specimen, "hybrid", Law::Transmittance, SAMPLES, move |specimen, run| {
        let mut source = Seeded::new(derive_seed(run.seed, 1 << 40));
        let mut experience = Experience::default();
        for _ in 0..PILOTS {
            experience.observe(&Pilot::of(&specimen.field, &mut source));
        }
        check(specimen, &experience, run)
    })
    .about([KIND.name])
}

/// Knowing nothing.
fn untaught<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Check {
    add(specimen, "hybrid_without_experience", Law::Transmittance, SAMPLES, |specimen, run| {
        check(specimen, &Experience::default(), run)
    })
    .about([KIND.name])
}

fn check<F: SpecimenField>(
    specimen: &Specimen<F>,
    experience: &Experience,
    run: Run,
) -> CheckResult {
    let length = specimen.field.length();
    let depth = specimen.field.majorant() * length;
    let hybrid = Hybrid::choose(experience, length, depth, Hybrid::USUAL_BUDGET);
    // A roulette that goes on once in a thousand makes look-ups too skewed to test; those of each choice are tested as its own.
    specimen.examine(&hybrid, &[], |_| Scores::Unbounded, LookupLaw::Unknown, run)
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("hybrid without experience", above: false, below: false, |profile| {
            Hybrid::choose(&Experience::default(), profile.length(), profile.depth(), Hybrid::USUAL_BUDGET)
        })
        .tried_where(|profile| profile.depth() <= 3e3),
    ]
}
