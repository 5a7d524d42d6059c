//! Ratio tracking whose rate follows its look-ups.

use super::Kind;
use super::on_profile::{ONE_MAJORANT, estimator, one_lookup_a_mean_free_path};
use super::on_specimen::law;
use super::profiles::{SAMPLED, on_series};
use crate::checks::{Check, LAWFUL, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use crate::profiles::unit_cells;
use crate::twins::trial::{Wrong, judged_as};
use crate::twins::{Evident, Twin};
use fairflight_laws::lookups::LookupLaw::Unknown;
use fairflight_media::{Bounded, Majorant};
use fairflight_sources::UniformSource;
use fairflight_transmittance::AdaptiveRatio;
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "adaptive_ratio", checks, twins, subjects, spared: &[ONE_MAJORANT] };

fn checks() -> Vec<Check> {
    on_series!(on)
}

fn on<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Vec<Check> {
    vec![law!(specimen, "adaptive_ratio", SAMPLED, Unknown, |_| AdaptiveRatio::new(0.1).expect(LAWFUL))]
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("adaptive ratio", above: true, below: true, |_| AdaptiveRatio::new(0.1).expect(LAWFUL))
            .tried_where(one_lookup_a_mean_free_path),
    ]
}

/// Adaptive ratio tracking that changes its rate before it divides by it.
struct KnowsTheLookup {
    floor: f64,
}

impl<F: Majorant> Wrong<F> for KnowsTheLookup {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let (majorant, length) = (field.majorant(), field.length());
        let (mut weight, mut x, mut rate) = (1.0, 0.0, majorant);
        loop {
            let flight = source.next_exponential() / rate;
            if x + flight >= length {
                return weight * ((rate - majorant) * (length - x)).exp();
            }
            x += flight;
            weight *= ((rate - majorant) * flight).exp();
            let null = majorant - field.sigma_t(x);
            rate = null.max(self.floor * majorant);
            weight *= null / rate; // right: by the rate that drew the flight, before it changes
        }
    }
}

fn twins() -> Vec<Twin> {
    vec![
        // Every factor is then (μ − σ_t)/(μ − σ_t) = 1 here. In (2) of `AdaptiveRatio` r no longer cancels: behind a collision
        // in the second cell f is right, in the first it is a(x) = 0.4096 exp(x − 1), with a′ = a and
        // a(1) = exp(−1.25) + 0.25 exp(−0.25) (1 − exp(−1)); from the start E = 0.425 for 0.287. The z is measured.
        Twin::new(
            "adaptive ratio",
            "rate_of_the_current_lookup",
            "the rate is adapted before the weight is divided by it and so depends on the look-up that it weighs: 48 % too high",
            "sigma_t 1, 0.25 (length 1 each), majorant 1.25, floor 0.1",
            (50_000, Evident::Mean { z: 97.5 }),
            |run| {
                let right = AdaptiveRatio::new(0.1).expect(LAWFUL);
                let field = Bounded::new(unit_cells(&[1.0, 0.25]), 1.25).expect(LAWFUL);
                judged_as(&right, &KnowsTheLookup { floor: 0.1 }, &field, run)
            },
        )
        .answers(|vector, source| {
            let (field, floor) = (vector.bounded(KIND.name)?, vector.estimator("floor")?);
            Some(KnowsTheLookup { floor }.draw(&field, source).into())
        }),
    ]
}
