//! The error of ray marching in closed form, also where it is far below that of any quadrature over its offset.

use super::Subject;
use fairflight_harness::Failure;
use fairflight_media::{Tolerance, adaptive_integral};
use fairflight_sources::Scripted;
use fairflight_transmittance::{Offset, RayMarching, TransmittanceEstimator};

/// Bias and root mean squared error of one march, in units of T.
pub(super) struct MarchingLaw {
    pub(super) relative_bias: f64,
    pub(super) relative_rmse: f64,
}

/// The law of one march of `steps` steps.
///
/// With δ = X − τ, the error of the Riemann sum, the estimate is T exp(−δ). Under a uniform offset E\[δ\] = 0, so that the
/// bias E\[exp(−δ)\] − 1 is E\[exp(−δ) − 1 + δ\]: an integrand that is nowhere negative, and of second order in δ.
///
/// # Errors
/// If there are no steps.
pub(super) fn law(subject: &Subject, offset: Offset, steps: u32) -> Result<MarchingLaw, Failure> {
    let marching = RayMarching::new(steps, offset).map_err(Failure::refused)?;
    let (field, tau) = (subject.profile.field(), subject.truth.optical_thickness);
    let error = |offset: f64| -marching.estimate(&field, &mut Scripted::new([offset])).ln() - tau;
    if offset == Offset::Fixed {
        let relative_bias = (-error(0.5)).exp_m1().abs();
        return Ok(MarchingLaw { relative_bias, relative_rmse: relative_bias });
    }
    let tolerance =
        Tolerance { absolute: 1e-15, relative: 1e-3, most_panels: (LOOKUPS / steps).clamp(1, 64) as usize };
    let [bias, square] = adaptive_integral(1.0, &[], tolerance, |offset| {
        let delta = error(offset);
        let relative = (-delta).exp_m1();
        [relative + delta, relative * relative]
    })
    .value;
    Ok(MarchingLaw { relative_bias: bias, relative_rmse: square.sqrt() })
}

/// Panels of the integral over the offset: fewer for more steps, so that every point costs about as much.
const LOOKUPS: u32 = 1 << 11;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::standard::laws::SharedLaws;
    use crate::standard::subject;
    use fairflight_harness::estimator::RayMarchingSpec;
    use fairflight_harness::field::MediumLibrary;
    use fairflight_harness::plan::Plan;

    #[test]
    fn it_agrees_with_the_estimators_own_theory() {
        let subject = subject::analytic(&MediumLibrary::default()).unwrap();
        let laws = SharedLaws::of(&subject);
        for (offset, steps) in [(Offset::Fixed, 8), (Offset::Jittered, 8), (Offset::Jittered, 20)] {
            let spec = RayMarchingSpec::at(steps, offset).into();
            let plan = Plan::on(subject.profile.clone(), spec, 1, 1).unwrap();
            let theory = laws.law(&subject, &plan.estimator).unwrap().unwrap().theory;
            let found = law(&subject, offset, steps).unwrap();
            let bias = theory.relative_mean - 1.0;
            let rmse = (theory.relative_central[0] + bias * bias).sqrt();
            assert!((found.relative_bias - bias.abs()).abs() < 1e-3 * rmse, "{offset:?} {steps}");
            assert!((found.relative_rmse - rmse).abs() < 1e-3 * rmse, "{offset:?} {steps}");
        }
    }
}
