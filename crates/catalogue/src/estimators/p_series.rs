//! Power series about a pivot.

use super::Kind;
use super::on_profile::{ONE_MAJORANT, estimator, one_lookup_a_mean_free_path};
use super::on_specimen::law;
use super::profiles::{KNOWN, SAMPLED, SKEWED, on_series};
use crate::checks::{Check, LAWFUL, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use crate::profiles::unit_cells;
use crate::twins::trial::{Wrong, judged_as};
use crate::twins::{Evident, Twin};
use fairflight_laws::lookups::LookupLaw::{MeanOnly, Poisson, Unknown};
use fairflight_media::Extinction;
use fairflight_sources::UniformSource;
use fairflight_transmittance::{PSeries, PSeriesVersion};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "p_series", checks, twins, subjects, spared: &[ONE_MAJORANT] };

fn checks() -> Vec<Check> {
    on_series!(on)
}

fn on<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Vec<Check> {
    [
        ("p_series_cmf", PSeriesVersion::Cmf, SKEWED, MeanOnly),
        ("p_series_cumulative", PSeriesVersion::Cumulative, SAMPLED, Unknown),
        ("p_series_ratio", PSeriesVersion::Ratio, KNOWN, Poisson),
        ("p_series_next_flight", PSeriesVersion::NextFlight, SKEWED, Poisson),
    ]
    .map(|(name, version, samples, lookups)| {
        law!(specimen, name, samples, lookups, |field| PSeries::with_majorant(version, field).expect(LAWFUL))
    })
    .into()
}

fn subjects() -> Vec<Subject> {
    macro_rules! version {
        ($name:literal, $version:ident) => {
            estimator!($name, above: true, below: true, |profile| {
                PSeries::with_majorant(PSeriesVersion::$version, profile).expect(LAWFUL)
            })
            .tried_where(one_lookup_a_mean_free_path)
        };
    }
    vec![
        version!("cmf", Cmf),
        version!("cumulative", Cumulative),
        version!("ratio", Ratio),
        version!("next flight", NextFlight),
    ]
}

/// The series about a pivot with its first four orders, all of them sure, and no more.
struct CappedOrder {
    pivot: f64,
}

impl<F: Extinction> Wrong<F> for CappedOrder {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let mut term = (-self.pivot).exp();
        let mut sum = term;
        for k in 1..=4 {
            // right: until the roulette ends it
            let x = field.length() * field.sigma_t(field.length() * source.next_uniform());
            term *= (self.pivot - x) / f64::from(k);
            sum += term;
        }
        sum
    }
}

fn twins() -> Vec<Twin> {
    vec![
        // With y = t_c − τ = 2.75 the terms beyond the fourth are P(N > 4) = 0.145 of T, N Poisson of mean y: z = 0.145 √(N/V) with
        // V = Var/T² of the right series.
        Twin::new(
            "p series",
            "order_capped_at_4",
            "the power series ends at order 4 whatever the pivot (real-time codes cap it at 5 to 8): 14.5 % too low",
            "sigma_t 1, 0.25 (length 1 each), pivot 4",
            (50_000, Evident::Mean { z: 86.0 }),
            |run| {
                let right = PSeries::new(PSeriesVersion::Cmf, 4.0).expect(LAWFUL);
                judged_as(&right, &CappedOrder { pivot: 4.0 }, &unit_cells(&[1.0, 0.25]), run)
            },
        )
        .answers(|vector, source| {
            let (field, pivot) = (vector.of(KIND.name)?, vector.estimator("pivot")?);
            let is_cmf = (vector.word)("/estimator/version")? == "cmf";
            is_cmf.then(|| CappedOrder { pivot }.draw(field, source).into())
        }),
    ]
}
