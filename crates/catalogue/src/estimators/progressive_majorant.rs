//! A majorant that is still found: the bias of its first estimate.

use super::Kind;
use super::on_profile::{ONE_MAJORANT, estimator, one_lookup_a_mean_free_path};
use super::add;
use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use fairflight_freeflight::lookups_of_a_walk;
use fairflight_laws::lookups::LookupLaw;
use fairflight_media::{Extinction, Majorant, PiecewiseConstant, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use fairflight_stats::Scores;
use fairflight_transmittance::{ClosedForm, ProductLaw, ProgressiveMajorant, Theory, TransmittanceEstimator};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "progressive_majorant", checks, twins: Vec::new, subjects, spared: &[ONE_MAJORANT] };

fn checks() -> Vec<Check> {
    let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.5, 4.0], vec![1.2, 0.1, 0.6]).expect(LAWFUL);
    let steps = Arc::new(Specimen::closed("piecewise_constant", steps));
    [0.3, 0.9].map(|guess| on(&steps, guess)).into()
}

/// The first estimate of a run: with the guess μ of its start, whatever is learnt on the way.
#[derive(Clone, Copy)]
struct FirstEstimate {
    guess: f64,
    start: ProgressiveMajorant,
}

impl<F: Extinction> TransmittanceEstimator<F> for FirstEstimate {
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let mut progressive = self.start;
        progressive.estimate(field, source)
    }
    fn admits(&self, _field: &F, _s: f64, sigma_t: f64) -> bool {
        sigma_t >= 0.0
    }
}

/// Ratio tracking through min(σ_t, μ) at the rate μ: by szirmay-kalos-2017 eq. 16 the moments of its factors 1 − min(σ_t, μ)/μ, times
/// exp(∫ max(σ_t − μ, 0)), by which its expectation exceeds T.
impl<F: Extinction> ClosedForm<F> for FirstEstimate {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, _: f64, tolerance: Tolerance) -> Theory {
        let guess = self.guess;
        let factors = quadrature.integrate(tolerance, |_, sigma_t| {
            std::array::from_fn(|i| guess * (-sigma_t.min(guess) / guess).powi(i as i32 + 2))
        });
        let law = ProductLaw::new(factors.value);
        let relative_mean = 1.0 + self.start.relative_bias(quadrature, tolerance);
        let mut relative_central = law.relative_central();
        for (i, moment) in relative_central.iter_mut().enumerate() {
            *moment *= relative_mean.powi(i as i32 + 2);
        }
        Theory {
            relative_mean,
            relative_central,
            log_relative_variance: law.log_relative_variance() + 2.0 * relative_mean.ln(),
            relative_variance_error: factors.error[0],
            ..Theory::mean_only(lookups_of_a_walk(quadrature, tolerance, &self.rates())[0])
        }
    }
}

impl FirstEstimate {
    /// A walk ends at the first point with σ_t > μ.
    fn rates(&self) -> impl Fn(f64, f64) -> [f64; 2] {
        let guess = self.guess;
        move |_, sigma_t| if sigma_t > guess { [guess, 0.0] } else { [0.0, guess] }
    }
}

fn on<F: SpecimenField>(specimen: &Arc<Specimen<F>>, guess: f64) -> Check {
    let estimator = FirstEstimate { guess, start: ProgressiveMajorant::new(guess).expect(LAWFUL) };
    let name = format!("progressive_majorant_{guess}");
    add(specimen, &name, Law::OwnExpectation, 80_000, move |specimen, run| {
        let tolerance = specimen.tolerance;
        let lookups = |quadrature: &mut RayQuadrature<F>| {
            LookupLaw::Moments(lookups_of_a_walk(quadrature, tolerance, &estimator.rates()))
        };
        specimen.examine_with_lookups(&estimator, &[], |_| Scores::Unbounded, lookups, run)
    })
    .about([KIND.name])
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("first estimate", above: true, below: false, |profile| {
            // One look-up on average where there is no majorant to begin with.
            let guess = if profile.depth() > 0.0 { profile.majorant() } else { 1.0 / profile.length().max(1.0) };
            FirstEstimate { guess, start: ProgressiveMajorant::new(guess).expect(LAWFUL) }
        })
        .tried_where(one_lookup_a_mean_free_path),
    ]
}
