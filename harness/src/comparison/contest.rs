//! All entrants on all rays of a set.

use super::{Bout, Effort, Entrant, Facts, RaySet, TestRay, fight};
use crate::Failure;
use crate::estimator::pilot;
use fairflight_sources::derive_seed;
use fairflight_transmittance::{Experience, Pilot};
use rayon::prelude::*;

/// What came of a contest.
#[derive(Clone, Debug)]
pub struct Contest {
    /// Who took part.
    pub entrants: Vec<Entrant>,
    /// For each entrant its bouts, in the order of the rays.
    pub bouts: Vec<Vec<Bout>>,
    /// Look-ups of the pilots, per ray.
    pub pilot_lookups: f64,
}

impl Contest {
    /// The bouts of the entrant of this name.
    #[must_use]
    pub fn of(&self, name: &str) -> Option<&[Bout]> {
        self.entrants.iter().position(|entrant| entrant.name == name).map(|i| self.bouts[i].as_slice())
    }
}

/// What is known before each ray: the pilots of the rays before it, those of the last rays before the first; never its own.
///
/// Each ray is looked at once by a pilot with variates of its own; look-ups of pilots are not charged to estimates.
#[must_use]
pub fn facts(set: &RaySet, seed: u64) -> Vec<Facts> {
    let pilots: Vec<Pilot> = set
        .rays
        .par_iter()
        .enumerate()
        .map(|(i, ray)| pilot(&ray.profile, ray.majorant, derive_seed(seed, i as u64)))
        .collect();
    let count = pilots.len();
    (0..count)
        .map(|ray| {
            let mut experience = Experience::default();
            // All others, the one just before it last.
            (1..count).for_each(|k| experience.observe(&pilots[(ray + k) % count]));
            Facts { mean: set.mean, experience }
        })
        .collect()
}

/// What a few pilots of the same ray tell, with variates of their own.
#[must_use]
pub fn facts_of(ray: &TestRay, seed: u64) -> Facts {
    const PILOTS: u64 = 8;
    let mut experience = Experience::default();
    (0..PILOTS).for_each(|k| experience.observe(&pilot(&ray.profile, ray.majorant, derive_seed(seed, k))));
    Facts { mean: ray.truth.optical_thickness / ray.profile.length(), experience }
}

/// Lets all entrants meet all rays. `advance` is told of each bout.
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
    let facts = facts(set, derive_seed(seed, u64::MAX));
    let mut bouts = Vec::with_capacity(entrants.len());
    for (e, entrant) in entrants.iter().enumerate() {
        let seed = derive_seed(seed, e as u64);
        let row: Result<Vec<Bout>, Failure> = set
            .rays
            .par_iter()
            .zip(&facts)
            .enumerate()
            .map(|(r, (ray, facts))| {
                let estimator = entrant.on(ray, facts)?;
                let bout = fight(ray, &estimator, effort, derive_seed(seed, r as u64))?;
                advance();
                Ok(bout)
            })
            .collect();
        bouts.push(row?);
    }
    let lookups: u64 = set.rays.iter().map(|ray| Pilot::lookups(ray.majorant * ray.profile.length())).sum();
    Ok(Contest { entrants, bouts, pilot_lookups: lookups as f64 / set.rays.len().max(1) as f64 })
}
