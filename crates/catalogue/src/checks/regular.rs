//! Estimators without variance, or with a bias of their own: the closed form of each medium against quadrature, and a majorant that is
//! still found.

use super::estimators::add;
use super::media::{LAWFUL, analytic_cosine, voxels};
use super::specimen::{Specimen, SpecimenField};
use super::{Check, Law};
use fairflight_freeflight::lookups_of_a_walk;
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::transmittance::Observed;
use fairflight_media::{
    Constant, Extinction, OpticalThickness, PiecewiseConstant, PiecewiseLinear, RayQuadrature, Tolerance,
};
use fairflight_sources::UniformSource;
use fairflight_stats::Scores;
use fairflight_transmittance::{
    ClosedForm, ProductLaw, ProgressiveMajorant, Regular, Theory, TransmittanceEstimator,
};
use glam::{DVec3, dvec3};
use std::sync::Arc;

/// Lists the checks.
pub(super) fn checks() -> Vec<Check> {
    let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.5, 4.0], vec![1.2, 0.1, 0.6]).expect(LAWFUL);
    let signed = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 3.5], vec![1.0, -0.5, 0.4]).expect(LAWFUL);
    let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL);
    let oblique = analytic_cosine(dvec3(-9.0, 3.0, -4.0), dvec3(0.55, -0.2, 0.81));
    let mut checks = vec![
        regular("constant", Constant::new(0.7, 3.0).expect(LAWFUL)),
        regular("piecewise_constant", steps.clone()),
        regular("piecewise_constant_negative", signed),
        regular("piecewise_linear", tent),
        regular("eq21_seed_ray", analytic_cosine(DVec3::ZERO, DVec3::Z)),
        regular("eq21_oblique_ray", oblique),
        regular("voxels", voxels()),
    ];
    let steps = Arc::new(Specimen::closed("piecewise_constant", steps));
    for guess in [0.3, 0.9] {
        checks.push(progressive(&steps, guess));
    }
    checks
}

/// The closed form against quadrature: one estimate is all there is to know.
fn regular<F: SpecimenField + OpticalThickness>(name: &'static str, field: F) -> Check
where
    for<'f, 'e> &'e Regular:
        TransmittanceEstimator<&'f F> + TransmittanceEstimator<Observed<&'f F, &'e Regular>>,
{
    let specimen = Arc::new(Specimen::integrated(name, field, Tolerance::TIGHT));
    add(&specimen, "regular", Law::Transmittance, 1, |specimen, run| {
        specimen.examine(&Regular, &[], |_| Scores::Unbounded, LookupLaw::Fixed, run)
    })
    .about(["regular"])
}

/// The first estimate of a run: with the guess μ of its start, whatever is learnt on the way.
#[derive(Clone, Copy)]
pub(crate) struct FirstEstimate {
    pub(crate) guess: f64,
    pub(crate) start: ProgressiveMajorant,
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

fn progressive<F: SpecimenField>(specimen: &Arc<Specimen<F>>, guess: f64) -> Check {
    let estimator = FirstEstimate { guess, start: ProgressiveMajorant::new(guess).expect(LAWFUL) };
    let name = format!("progressive_majorant_{guess}");
    add(specimen, &name, Law::OwnExpectation, 80_000, move |specimen, run| {
        let tolerance = specimen.tolerance;
        let lookups = |quadrature: &mut RayQuadrature<F>| {
            LookupLaw::Moments(lookups_of_a_walk(quadrature, tolerance, &estimator.rates()))
        };
        specimen.examine_with_lookups(&estimator, &[], |_| Scores::Unbounded, lookups, run)
    })
    .about(["progressive_majorant"])
}
