//! Sample transmittance functions with the band of their standard deviation: szirmay-kalos-2017 fig. 8.

use super::laws::SharedLaws;
use super::walk::{WALK_EXPLORERS, distances, trace, walker};
use super::{Run, Subject};
use crate::standard::result::SampleFunctions;
use fairflight_harness::Failure;
use fairflight_media::OpticalThickness;
use fairflight_sources::Seeded;
use fairflight_transmittance::Interaction;

/// Points at which the curves are given.
const POINTS: usize = 401;
/// Functions that are shown.
const FUNCTIONS: usize = 8;

pub(super) fn of(run: &Run<'_>, subject: &Subject, laws: &SharedLaws) -> Result<SampleFunctions, Failure> {
    let sigma_samp = subject.walk_sampling;
    let walker = walker(subject, WALK_EXPLORERS, sigma_samp)?;
    let source = Seeded::new(run.seed(format_args!("functions/{}", subject.id)));
    let walks = trace(subject, &walker, FUNCTIONS, source);
    let running = laws.running(subject, walker.control(), sigma_samp);
    let s = distances(subject.facts.length, POINTS);
    let main: Vec<f64> = s.iter().map(|&s| (-walker.control().optical_thickness(0.0, s)).exp()).collect();
    let sampled = |walk: &Vec<Interaction>| {
        s.iter().zip(&main).map(|(&s, main)| main * Interaction::weight_at(walk, s)).collect()
    };
    let (transmittance, standard_deviation) = s
        .iter()
        .map(|&s| {
            let [tau, introduced] = running.at(s);
            let transmittance = (-tau).exp();
            // Eq. 16: V(s) = T²(s) (exp ∫_0^s w − 1).
            (transmittance, transmittance * introduced.max(0.0).exp_m1().sqrt())
        })
        .unzip();
    Ok(SampleFunctions {
        sigma_samp,
        explorers: WALK_EXPLORERS,
        transmittance,
        standard_deviation,
        samples: walks.iter().map(sampled).collect(),
        s,
    })
}
