//! A majorant that is found while tracking (misso-2023). **Biased** at every moment, consistent in the long run, and labelled so.

use crate::SignedProduct;
use fairflight_elementary::exp_m1;
use fairflight_media::{Extinction, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// Ratio tracking with a guess in the place of a majorant, raised to every σ_t that is found above it.
///
/// ```text
/// T = 1; s = 0
/// repeat  s += exponential free flight of mu;  return T when s > S
///         if sigma_t(s) > mu:  mu = sigma_t(s);  return 0       (the factor 1 − sigma_t/mu < 0, clamped)
///         T *= 1 − sigma_t(s)/mu
/// ```
///
/// It is no [`TransmittanceEstimator`](crate::TransmittanceEstimator): what it knows changes from estimate to estimate.
///
/// **Law.** (1) As the walk ends where the guess changes, an estimate drawn with the guess μ multiplies factors
/// 1 − min(σ_t, μ)/μ at the rate μ: given μ,
///
/// > E\[T̂ | μ\] = exp(−∫ min(σ_t, μ)) = T · exp(∫ max(σ_t − μ, 0)) ≥ T.
///
/// Too high, never too low: the medium above the guess is overlooked ([`relative_bias`](Self::relative_bias)). (2) The guess
/// only rises, and only to values of σ_t: once it is a majorant all later estimates are unbiased. While it is none, the
/// places with σ_t > μ are hit by the next estimate with a probability of at least that of the first collision being there, which is positive
/// and does not fall with the number of estimates: μ rises to the supremum of σ_t with probability 1, and the bias to 0. (3)
/// Estimates lie in \[0, 1\] for σ_t ≥ 0, so that the mean of n of them, less the mean of their conditional expectations, goes to 0
/// (bounded martingale differences), and the latter goes to T by (2) (Cesàro). The running mean is *consistent*; its early members
/// never leave it, and their bias falls like 1/n.
///
/// Without the clamp ratio tracking is unbiased with any rate (misso-2023 reports its variance as explosive; exp(∫ σ_t²/μ) − 1
/// here). σ_t may be negative: the variance then has no bound, (1) and (2) hold.
///
/// **Cost.** At most μS look-ups on average, μ the current guess.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProgressiveMajorant {
    majorant: f64,
}

/// A first guess that finds nothing: without a collision there is no look-up.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("start must be finite and greater than 0, found {0}")]
pub struct StartError(f64);

impl ProgressiveMajorant {
    /// Begins with the guess `start` \[1/length\].
    ///
    /// # Errors
    /// If the guess is not finite and above 0.
    pub fn new(start: f64) -> Result<Self, StartError> {
        if start > 0.0 && start.is_finite() { Ok(Self { majorant: start }) } else { Err(StartError(start)) }
    }

    /// The guess now: the start, or the greatest σ_t that ended a walk.
    #[must_use]
    pub fn majorant(&self) -> f64 {
        self.majorant
    }

    /// Draws one estimate with the guess as it is, and raises the guess where σ_t exceeds it.
    #[inline]
    pub fn estimate<F: Extinction>(&mut self, field: &F, source: &mut impl UniformSource) -> f64 {
        let (mut weight, mut s) = (SignedProduct::ONE, 0.0);
        loop {
            s += source.next_exponential() / self.majorant;
            if s >= field.length() {
                return weight.value();
            }
            let sigma_t = field.sigma_t(s);
            if sigma_t > self.majorant {
                self.majorant = sigma_t;
                return 0.0;
            }
            weight.multiply(1.0 - sigma_t / self.majorant);
        }
    }

    /// E\[estimate | the guess as it is\]/T − 1 = exp(∫ max(σ_t − μ, 0)) − 1.
    pub fn relative_bias<F: Extinction>(
        &self,
        quadrature: &mut RayQuadrature<F>,
        tolerance: Tolerance,
    ) -> f64 {
        quadrature.split_at_zeros(tolerance, &|_, sigma_t| sigma_t - self.majorant);
        let above = quadrature.integrate(tolerance, |_, sigma_t| [(sigma_t - self.majorant).max(0.0)]);
        exp_m1(above.value[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::mean;
    use fairflight_media::{OpticalThickness, PiecewiseConstant};
    use fairflight_sources::{Scripted, Seeded};

    fn field() -> PiecewiseConstant {
        PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 2.5], vec![0.3, 0.9, 1.6]).unwrap()
    }

    #[test]
    fn a_value_above_the_guess_ends_the_walk_and_raises_it() {
        let mut progressive = ProgressiveMajorant::new(0.5).unwrap();
        // At 0.8 the factor 0.4, at 1.6 a value of 0.9.
        let variates = [0.4_f64, 0.4].map(|depth| 1.0 - (-depth).exp());
        assert_eq!(progressive.estimate(&field(), &mut Scripted::new(variates)), 0.0);
        assert_eq!(progressive.majorant(), 0.9);
        // At 0.8 the factor 2/3, then out.
        let variates = [0.72_f64, 1.8].map(|depth| 1.0 - (-depth).exp());
        let found = progressive.estimate(&field(), &mut Scripted::new(variates));
        assert!((found - (1.0 - 0.3 / 0.9)).abs() < 1e-15);
        assert!(ProgressiveMajorant::new(0.0).is_err() && ProgressiveMajorant::new(f64::NAN).is_err());
    }

    #[test]
    fn an_estimate_has_the_bias_of_its_guess() {
        let field = field();
        let transmittance = (-field.optical_thickness(0.0, 2.5)).exp();
        let mut quadrature = RayQuadrature::new(&field, &[]);
        for guess in [0.4, 1.0] {
            let start = ProgressiveMajorant::new(guess).unwrap();
            let bias = start.relative_bias(&mut quadrature, Tolerance::TIGHT);
            let mut source = Seeded::new(5);
            // Each estimate from the same guess.
            let (found, error) =
                mean(200_000, || start.clone().estimate(&field, &mut source) / transmittance);
            assert!((found - 1.0 - bias).abs() < 5.0 * error, "{found} for {}, error {error}", 1.0 + bias);
            assert!(bias > 20.0 * error, "a bias of {bias} shows");
        }
        let found = ProgressiveMajorant::new(1.6).unwrap();
        assert_eq!(found.relative_bias(&mut quadrature, Tolerance::TIGHT), 0.0);
    }

    #[test]
    fn the_first_images_are_too_bright_and_the_running_mean_converges() {
        let field = field();
        let transmittance = (-field.optical_thickness(0.0, 2.5)).exp();
        let mut source = Seeded::new(6);
        // The first 3 estimates of 100 000 renderers.
        let (early, error) = mean(100_000, || {
            let mut progressive = ProgressiveMajorant::new(0.2).unwrap();
            (0..3).map(|_| progressive.estimate(&field, &mut source)).sum::<f64>() / 3.0 / transmittance
        });
        assert!(early - 1.0 > 20.0 * error, "{early}, standard error {error}");
        // One renderer: what it found stays found, and what it missed is forgotten.
        let mut progressive = ProgressiveMajorant::new(0.2).unwrap();
        let (late, error) = mean(400_000, || progressive.estimate(&field, &mut source) / transmittance);
        assert_eq!(progressive.majorant(), 1.6);
        assert!((late - 1.0).abs() < 5.0 * error, "{late}, standard error {error}");
    }
}
