//! One ray taken apart: szirmay-kalos-2017 fig. 5.

use super::laws::SharedLaws;
use super::walk::{WALK_EXPLORERS, distances, looked_up, trace, walker};
use super::{Run, Subject};
use crate::standard::result::Anatomy;
use fairflight_harness::Failure;
use fairflight_media::{Extinction, OpticalThickness};
use fairflight_sources::Seeded;
use fairflight_transmittance::Interaction;

/// Points at which the curves are given.
const POINTS: usize = 801;

pub(super) fn of(run: &Run<'_>, subject: &Subject, laws: &SharedLaws) -> Result<Anatomy, Failure> {
    let sigma_samp = subject.walk_sampling;
    let walker = walker(subject, WALK_EXPLORERS, sigma_samp)?;
    let control = walker.control();
    let source = Seeded::new(run.seed(format_args!("anatomy/{}", subject.id)));
    let walk = trace(subject, &walker, 1, source).remove(0);
    let running = laws.running(subject, control, sigma_samp);
    let s = distances(subject.facts.length, POINTS);
    Ok(Anatomy {
        sigma_samp,
        sigma_t: looked_up(subject, &s),
        sigma_main: s.iter().map(|&s| control.sigma_t(s)).collect(),
        transmittance: s.iter().map(|&s| (-running.at(s)[0]).exp()).collect(),
        sampled: s
            .iter()
            .map(|&s| (-control.optical_thickness(0.0, s)).exp() * Interaction::weight_at(&walk, s))
            .collect(),
        explorers: control.points().map(|(s, sigma_t)| [s, sigma_t]).collect(),
        interactions: walk.iter().map(|point| [point.distance, point.sigma_t]).collect(),
        s,
    })
}
