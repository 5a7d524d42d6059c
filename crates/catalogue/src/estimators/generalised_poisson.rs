//! The single-term estimator.

use super::Kind;
use super::on_profile::{ONE_MAJORANT, estimator, one_lookup_a_mean_free_path};
use super::on_specimen::law;
use super::profiles::{KNOWN, on_series};
use crate::checks::{Check, LAWFUL, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use crate::profiles::unit_cells;
use crate::twins::trial::{Wrong, judged_as};
use crate::twins::{Evident, Twin};
use fairflight_laws::lookups::LookupLaw::Poisson;
use fairflight_media::Extinction;
use fairflight_sources::UniformSource;
use fairflight_transmittance::GeneralisedPoisson;
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "generalised_poisson", checks, twins, subjects, spared: &[ONE_MAJORANT] };

fn checks() -> Vec<Check> {
    on_series!(on)
}

fn on<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Vec<Check> {
    vec![law!(specimen, "generalised_poisson", KNOWN, Poisson, |field| {
        let thickness = field.majorant() * field.length();
        // The residual of a control of a fifth of the majorant.
        GeneralisedPoisson::new(1.2 * thickness, thickness).expect(LAWFUL)
    })]
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("generalised poisson", above: true, below: true, |profile| {
            // Ratio tracking with its points unsorted; its rate is positive.
            let depth = if profile.depth() > 0.0 { profile.depth() } else { 1.0 };
            GeneralisedPoisson::new(depth, depth).expect(LAWFUL)
        })
        .tried_where(one_lookup_a_mean_free_path),
    ]
}

/// One term of Poisson order whose weight is that of an order drawn at the pivot itself.
struct ForgetsItsRate {
    pivot: f64,
    rate: f64,
}

impl<F: Extinction> Wrong<F> for ForgetsItsRate {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let mut weight = 1.0; // right: exp(rate − pivot)
        let mut order = source.next_exponential();
        while order < self.rate {
            let x = field.length() * field.sigma_t(field.length() * source.next_uniform());
            weight *= (self.pivot - x) / self.rate;
            order += source.next_exponential();
        }
        weight
    }
}

fn twins() -> Vec<Twin> {
    // E[Π (c − X_i)/λ] over N Poisson of mean λ is exp(c − τ − λ) = e^(c − λ) T: 63 % of T is missing. X is 2 or 1/2, so that q = 1.125 and
    // Var/T² = exp(2(τ − c) + λ + q/λ) − 1 = exp(1.875) − 1 = 5.52 ([`GeneralisedPoisson`]).
    vec![Twin::new(
        "generalised poisson",
        "weight_of_the_pivot",
        "the factor exp(rate - pivot) left out, which is 1 where the pivot is the rate: 63 % too low",
        "sigma_t 1, 0.25 (length 1 each), pivot 2, rate 3",
        (50_000, Evident::Mean { z: 60.2 }),
        |run| {
            let right = GeneralisedPoisson::new(2.0, 3.0).expect(LAWFUL);
            judged_as(&right, &ForgetsItsRate { pivot: 2.0, rate: 3.0 }, &unit_cells(&[1.0, 0.25]), run)
        },
    )
    .answers(|vector, source| {
        let (pivot, rate) = (vector.estimator("pivot")?, vector.estimator("rate")?);
        Some(ForgetsItsRate { pivot, rate }.draw(vector.of(KIND.name)?, source).into())
    })]
}
