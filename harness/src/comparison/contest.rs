//! All entrants on all rays of a set.

use super::{Bout, Effort, Entrant, Facts, RaySet, TestRay, fight};
use crate::Failure;
use crate::estimator::pilot;
use crate::parallel::{in_parallel, try_in_parallel};
use fairflight_sources::named_seed;
use fairflight_transmittance::{Experience, Pilot};

/// Results of all entrants on all rays.
#[derive(Clone, Debug)]
pub struct Contest {
    /// The entrants.
    pub entrants: Vec<Entrant>,
    /// Results of each entrant, in the order of the rays.
    pub bouts: Vec<Vec<Bout>>,
    /// Look-ups of the pilots, per ray.
    pub pilot_lookups: f64,
}

/// Facts that are known before each ray: the pilots of the rays before it, those of the last rays before the first; never its own.
///
/// Each ray is looked at once by a pilot with variates of its own; look-ups of pilots are not charged to estimates.
#[must_use]
pub fn facts(set: &RaySet, seed: u64) -> Vec<Facts> {
    let count = set.rays.len();
    let pilots: Vec<Pilot> = in_parallel(count, &|i| {
        let ray = &set.rays[i];
        pilot(&ray.profile, ray.majorant, named_seed(seed, &format!("ray {i}")))
    });
    (0..count)
        .map(|ray| {
            let mut experience = Experience::default();
            // All others, the one just before it last.
            (1..count).for_each(|k| experience.observe(&pilots[(ray + k) % count]));
            Facts { mean: set.mean, experience }
        })
        .collect()
}

/// Facts about a ray from a few pilots of that ray, with variates of their own.
#[must_use]
pub fn facts_of(ray: &TestRay, seed: u64) -> Facts {
    const PILOTS: u64 = 8;
    let mut experience = Experience::default();
    for k in 0..PILOTS {
        let seed = named_seed(seed, &format!("pilot {k}"));
        experience.observe(&pilot(&ray.profile, ray.majorant, seed));
    }
    Facts { mean: ray.truth.optical_thickness / ray.profile.length(), experience }
}

/// Runs all entrants on all rays, each with a stream of its name on each ray. `advance` is told of each result.
///
/// # Errors
/// If an entrant is not defined on a ray.
pub fn contest(
    set: &RaySet,
    entrants: Vec<Entrant>,
    effort: Effort,
    seed: u64,
    advance: &(dyn Fn() + Sync),
) -> Result<Contest, Failure> {
    let facts = facts(set, named_seed(seed, "facts"));
    let mut bouts = Vec::with_capacity(entrants.len());
    for entrant in &entrants {
        bouts.push(bouts_of(entrant, set, &facts, effort, named_seed(seed, entrant.name), advance)?);
    }
    let lookups: u64 = set.rays.iter().map(|ray| Pilot::lookups(ray.majorant * ray.profile.length())).sum();
    Ok(Contest { entrants, bouts, pilot_lookups: lookups as f64 / set.rays.len().max(1) as f64 })
}

/// Runs an entrant on the rays of a set, of which it knows the `facts`: each with a stream of its own. `advance` is told of each result.
///
/// # Errors
/// If it is not defined on a ray.
pub fn bouts_of(
    entrant: &Entrant,
    set: &RaySet,
    facts: &[Facts],
    effort: Effort,
    seed: u64,
    advance: &(dyn Fn() + Sync),
) -> Result<Vec<Bout>, Failure> {
    try_in_parallel(set.rays.len(), &|i| {
        let ray = &set.rays[i];
        let estimator = entrant.on(ray, &facts[i])?;
        let bout = fight(ray, &estimator, effort, named_seed(seed, &format!("ray {i}")))?;
        advance();
        Ok(bout)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::{entrants, others};
    use crate::field::AnyProfile;
    use fairflight_media::{PiecewiseLinear, Tolerance};

    #[test]
    fn an_entrant_keeps_its_numbers_when_others_are_added_or_moved() {
        let ramp = PiecewiseLinear::new(vec![0.0, 2.0], vec![0.2, 1.0]).unwrap();
        let profiles = vec![AnyProfile::PiecewiseLinear(ramp); 2];
        let set = RaySet::of("ramp", profiles, 1.0, Tolerance::to(1e-9)).unwrap();
        let effort = Effort { samples: 64, counted: 64, closed: false };
        let numbers = |names: &[&str]| {
            let mut chosen = entrants();
            chosen.retain(|entrant| names.contains(&entrant.name));
            chosen.sort_by_key(|entrant| names.iter().position(|name| *name == entrant.name));
            let contest = contest(&set, chosen, effort, 7, &|| ()).unwrap();
            move |name: &str| -> Vec<Bout> {
                let entrant = contest.entrants.iter().position(|entrant| entrant.name == name).unwrap();
                contest.bouts[entrant].iter().map(|bout| Bout { seconds: 0.0, ..*bout }).collect()
            }
        };
        let before = numbers(&["ratio tracking", "hybrid"]);
        let after = numbers(&["track length", "hybrid", "jittered ratio, 0.5", "ratio tracking"]);
        for name in ["ratio tracking", "hybrid"] {
            assert_eq!(before(name), after(name), "{name}");
        }
        // Rays have streams of their own.
        assert_ne!(before("ratio tracking")[0], before("ratio tracking")[1]);
    }

    #[test]
    fn names_are_not_shared() {
        let all = || entrants().into_iter().chain(others());
        let mut names: Vec<&str> = all().map(|entrant| entrant.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all().count());
    }
}
