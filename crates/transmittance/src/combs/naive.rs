//! exp(−X) of one comb: [`RayMarching`](crate::RayMarching) with a jittered offset. **Biased**; here is by how much.

use super::CombCumulants;
use fairflight_elementary::exp_m1;

/// E\[exp(−X)\]/T − 1 = exp(k2/2 − k3/6 + k4/24 − …) − 1 for a comb X with these cumulants (raab-2008 section 1 has
/// the sign, by Jensen's inequality). The estimator itself is [`RayMarching`](crate::RayMarching) with
/// [`Offset::Jittered`](crate::Offset::Jittered), whose theory has the expectation exactly.
#[must_use]
pub fn predicted_naive_bias(cumulants: &CombCumulants) -> f64 {
    exp_m1(cumulants.k2 / 2.0 - cumulants.k3 / 6.0 + cumulants.k4 / 24.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::seed_ray;
    use crate::{ClosedForm, Comb, CombShape, Offset, RayMarching};
    use approx::assert_relative_eq;
    use fairflight_media::{RayQuadrature, Tolerance};

    #[test]
    fn the_bias_of_ray_marching_is_that_of_its_cumulants() {
        // On the seed ray: +49 % with 8 steps, +7 % with 12.
        let ray = seed_ray();
        for (steps, bias) in [(8, 0.49), (12, 0.07)] {
            let comb = Comb::new(steps, CombShape::Uniform).unwrap();
            let predicted = predicted_naive_bias(&comb.cumulants(&ray, 0.0, 20.0, Tolerance::TIGHT));
            let marching = RayMarching::new(steps, Offset::Jittered).unwrap();
            let tau = fairflight_media::OpticalThickness::optical_thickness(&ray, 0.0, 20.0);
            let theory = marching.theory(&mut RayQuadrature::new(&ray, &[]), tau, Tolerance::TIGHT);
            let exact = theory.relative_mean - 1.0;
            assert_relative_eq!(exact, bias, epsilon = 0.005);
            // Cumulants beyond the fourth are 3 % of the bias at 8 steps.
            assert_relative_eq!(predicted, exact, max_relative = 0.04);
        }
    }
}
