//! S10: how often a sample transmittance function lies within one standard deviation of the truth.
//!
//! Criterion: at five distances on every ray the fraction of traced functions within the band of eq. 16 agrees, within 4
//! standard errors of the difference, with the fraction under the law of T̂(s) drawn in another way: a Poisson number of
//! independent uniform points on [0, s], T̂(s) the product of their weights. (A walk draws its points in order, by free
//! flights.)

use super::{Evidence, SIGMAS, claim};
use crate::standard::Subject;
use crate::standard::laws::SharedLaws;
use crate::standard::walk::{WALK_EXPLORERS, Walker, trace, walker};
use fairflight_document::{Claim, ClaimVerdict};
use fairflight_harness::Failure;
use fairflight_harness::field::KnownField;
use fairflight_harness::parallel::in_parallel;
use fairflight_media::{Extinction, OpticalThickness};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::Interaction;

/// Distances at which the band is checked, in units of the ray's length.
const PLACES: [f64; 5] = [0.1, 0.3, 0.5, 0.75, 1.0];

/// T(s), the half width of its band, and the control's transmittance.
struct Place {
    s: f64,
    transmittance: f64,
    deviation: f64,
    main: f64,
}

impl Place {
    fn holds(&self, weight: f64) -> bool {
        (self.main * weight - self.transmittance).abs() <= self.deviation
    }
}

pub(super) fn s10(evidence: &Evidence<'_>) -> Result<Claim, Failure> {
    let mut parts = Vec::new();
    let (mut worst, mut all) = (0.0_f64, Vec::new());
    for subject in evidence.subjects {
        let coverage = coverage(evidence, subject)?;
        let words: Vec<String> = coverage
            .iter()
            .map(|point| {
                worst = worst.max(point.z().abs());
                all.push(point.measured);
                format!("{:.2} L: {:.4} against {:.4}", point.place, point.measured, point.law)
            })
            .collect();
        let first = &coverage[0];
        parts.push(format!("{} (± {:.4}): {}", subject.id, 1.96 * first.largest_error(), words.join(", ")));
    }
    let least = all.iter().copied().fold(1.0, f64::min);
    let most = all.iter().copied().fold(0.0, f64::max);
    let verdict = ClaimVerdict::of(worst < SIGMAS);
    Ok(claim(
        "S10",
        "Sample transmittance functions lie within the band of plus and minus one standard deviation (eq. 16) as often as \
         their law says.",
        format!(
            "Fraction of traced functions within the band at a distance, against the law drawn as a Poisson number of \
             independent uniform points. {}. Largest |z| of the differences {worst:.2}.",
            parts.join(". ")
        ),
        verdict,
        &format!(
            "As their law says, which is not the normal one: the fraction is between {least:.2} and {most:.2}, not 0.68. The \
             law is skewed, and has an atom where no collision happens."
        ),
    ))
}

struct Coverage {
    place: f64,
    measured: f64,
    law: f64,
    walks: f64,
    draws: f64,
}

impl Coverage {
    fn z(&self) -> f64 {
        let pooled = (self.measured * self.walks + self.law * self.draws) / (self.walks + self.draws);
        let variance = pooled * (1.0 - pooled) * (1.0 / self.walks + 1.0 / self.draws);
        if variance > 0.0 { (self.measured - self.law) / variance.sqrt() } else { 0.0 }
    }

    /// The standard error of a fraction of walks, where it is largest.
    fn largest_error(&self) -> f64 {
        0.5 / self.walks.sqrt()
    }
}

fn coverage(evidence: &Evidence<'_>, subject: &Subject) -> Result<Vec<Coverage>, Failure> {
    let sigma_samp = subject.walk_sampling;
    let walker = walker(subject, WALK_EXPLORERS, sigma_samp)?;
    let running = SharedLaws::of(subject).running(subject, walker.control(), sigma_samp);
    let length = subject.facts.length;
    let places = PLACES.map(|place| {
        let s = place * length;
        let [tau, introduced] = running.at(s);
        let transmittance = (-tau).exp();
        let deviation = transmittance * introduced.max(0.0).exp_m1().sqrt();
        Place { s, transmittance, deviation, main: (-walker.control().optical_thickness(0.0, s)).exp() }
    });
    // Look-ups per walk, and about twice as many for the other draws, at each place anew.
    let walk_nanoseconds = sigma_samp * length * subject.lookup_nanoseconds + 100.0;
    let walks = ((evidence.effort.claim_seconds * 1e9 / walk_nanoseconds) as usize).clamp(2_000, 1 << 16);
    let seed = |name: &str| evidence.seed(format_args!("S10/{}/{name}", subject.id));
    let traced = trace(subject, &walker, walks, Seeded::new(seed("walks")));
    Ok(in_parallel(places.len(), &|i| {
        let (place, at) = (&places[i], PLACES[i]);
        let within = traced.iter().filter(|walk| place.holds(Interaction::weight_at(walk, place.s))).count();
        let draws = walks;
        let source = Seeded::new(seed(&format!("law at {at}")));
        let by_law = unordered(subject.profile.field(), &walker, (place, draws), source);
        Coverage {
            place: at,
            measured: within as f64 / walks as f64,
            law: by_law as f64 / draws as f64,
            walks: walks as f64,
            draws: draws as f64,
        }
    }))
}

/// The number of `draws` products over a Poisson number of independent uniform points that lie within the band.
fn unordered(
    field: &dyn KnownField,
    walker: &Walker,
    (place, draws): (&Place, usize),
    mut source: Seeded,
) -> usize {
    let expected = walker.sampling().optical_thickness(0.0, place.s);
    let control = walker.control();
    (0..draws)
        .filter(|_| {
            let mut weight = 1.0;
            let mut depth = source.next_exponential();
            while depth < expected {
                let s = place.s * source.next_uniform();
                // Eq. 8: the transmitted energy of one collision is 1 − r.
                weight *= 1.0 - (field.sigma_t(s) - control.sigma_t(s)) / walker.sampling().sigma_t(s);
                depth += source.next_exponential();
            }
            place.holds(weight)
        })
        .count()
}
