//! Next flight estimation after ratio tracking and delta tracking, and its weighted relatives.

use super::Kind;
use super::on_profile::{ONE_MAJORANT, estimator, one_lookup_a_mean_free_path};
use super::on_specimen::law;
use super::profiles::{SAMPLED, SKEWED, on_series};
use crate::checks::{Check, LAWFUL, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use crate::profiles::unit_cells;
use crate::twins::trial::{Wrong, judged_as};
use crate::twins::{Evident, Twin};
use fairflight_laws::lookups::LookupLaw::{MeanOnly, Poisson};
use fairflight_media::{Bounded, Majorant};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{Bidirectional, NextFlight, NextFlightVersion, Unidirectional};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "next_flight", checks, twins, subjects, spared: &[ONE_MAJORANT] };

fn checks() -> Vec<Check> {
    on_series!(on)
}

fn on<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Vec<Check> {
    let mut checks = vec![
        law!(specimen, "next_flight_ratio", SKEWED, Poisson, |_| NextFlight::new(NextFlightVersion::Ratio)),
        law!(specimen, "unidirectional", SKEWED, Poisson, |_| Unidirectional),
        law!(specimen, "bidirectional", SAMPLED, Poisson, |_| Bidirectional),
    ];
    if specimen.field.minorant() >= 0.0 {
        checks.push(law!(specimen, "next_flight_delta", SKEWED, MeanOnly, |_| NextFlight::new(
            NextFlightVersion::Delta
        )));
    }
    checks
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("delta", above: false, below: false, |_| NextFlight::new(NextFlightVersion::Delta))
            .tried_where(one_lookup_a_mean_free_path),
        estimator!("ratio", above: true, below: true, |_| NextFlight::new(NextFlightVersion::Ratio))
            .tried_where(one_lookup_a_mean_free_path),
        estimator!("unidirectional", above: true, below: true, |_| Unidirectional)
            .tried_where(one_lookup_a_mean_free_path),
        // It connects all points of two walks.
        estimator!("bidirectional", above: true, below: true, |_| Bidirectional)
            .tried_where(|profile| profile.depth() <= 100.0),
    ]
}

/// Next flight after ratio tracking that adds from its first collision on.
struct WithoutTheStart;

impl<F: Majorant> Wrong<F> for WithoutTheStart {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let (majorant, length) = (field.majorant(), field.length());
        let (mut sum, mut weight, mut s) = (0.0, 1.0, 0.0); // right: sum = exp(−majorant · length)
        loop {
            s += source.next_exponential() / majorant;
            if s >= length {
                return sum;
            }
            weight *= 1.0 - field.sigma_t(s) / majorant;
            sum += weight * (-majorant * (length - s)).exp();
        }
    }
}

fn twins() -> Vec<Twin> {
    vec![
        // The term of the start is not random: exp(−2·1.25)/exp(−1.25) = 0.287 of T is missing, and the variance is right.
        Twin::new(
            "next flight",
            "without_the_start",
            "next flight added at collisions only, the start forgotten: exp(−majorant · length) too low, 28.7 % here",
            "sigma_t 1, 0.25 (length 1 each), majorant 1.25",
            (400_000, Evident::Mean { z: 179.0 }),
            |run| {
                let right = NextFlight::new(NextFlightVersion::Ratio);
                let field = Bounded::new(unit_cells(&[1.0, 0.25]), 1.25).expect(LAWFUL);
                judged_as(&right, &WithoutTheStart, &field, run)
            },
        )
        .answers(|vector, source| {
            let field = vector.bounded(KIND.name)?;
            let is_ratio = (vector.word)("/estimator/version")? == "ratio";
            is_ratio.then(|| WithoutTheStart.draw(&field, source).into())
        }),
    ]
}
