//! Tracking with an arbitrary sampling extinction and a control: szirmay-kalos-2017 section 4.2.
//!
//! Ratio tracking is the double particle model without control, residual ratio tracking (novak-2014) the same with a
//! constant one; neither needs a majorant here.

use crate::{
    ClosedForm, Interaction, ProductLaw, SignedProduct, Theory, TransmittanceEstimator, TransmittanceFunction,
};
use fairflight_collision::CollisionModel;
use fairflight_elementary::exp;
use fairflight_media::{
    Extinction, InvertOpticalThickness, OpticalThickness, RayQuadrature, Tolerance, rounding_of_difference,
};
use fairflight_sources::UniformSource;

/// Follows one particle through the profile and returns its weight at the end.
///
/// The listing *Transmittance* of section 4.2 (missing from the printed paper):
///
/// ```text
/// T = T_main(S); s = 0
/// repeat  s += free flight of sigma_samp                                 (eq. 4)
///         stop when s > S
///         r = (sigma_t(s) − sigma_main(s)) / sigma_samp(s)               (eq. 5, 6)
///         T *= weight of the transmitted particle, on average 1 − r      (eq. 8 or 9)
/// ```
///
/// **Law.** Unbiased for every control and every σ_samp that is positive wherever σ_t ≠ σ_main; a σ_samp of 0 elsewhere
/// is a silent bias. The control may be built from anything that is independent of the interaction points.
///
/// **Variance.** [`ProductLaw`] with J_j = ∫ σ_samp E\[(W(r) − 1)^j\] ds; for the double particle model Var/T² =
/// exp(∫ σ_diff²/σ_samp) − 1 (eq. 16 and 17).
///
/// **Cost.** ∫ σ_samp look-ups for the double particle model; less where walks end,
/// ∫ σ_samp(s) exp(−∫_0^s σ_samp · P(no transmitted particle)) ds.
#[derive(Clone, Debug)]
pub struct Tracking<M, C, R> {
    model: M,
    control: C,
    sampling: R,
    /// ∫ σ_main over the profile, and exp(−that).
    main_thickness: f64,
    main_transmittance: f64,
}

impl<M: CollisionModel, C: OpticalThickness, R: InvertOpticalThickness> Tracking<M, C, R> {
    /// Tracking with the collisions of `model`, the `control` σ_main and the sampling extinction `sampling`, which both
    /// cover the profile to be estimated and no more.
    pub fn new(model: M, control: C, sampling: R) -> Self {
        let main_thickness = control.optical_thickness(0.0, sampling.length());
        let main_transmittance = exp(-main_thickness);
        Self { model, control, sampling, main_thickness, main_transmittance }
    }

    /// The collision model.
    pub fn model(&self) -> &M {
        &self.model
    }

    /// The control.
    pub fn control(&self) -> &C {
        &self.control
    }

    /// The sampling extinction.
    pub fn sampling(&self) -> &R {
        &self.sampling
    }

    /// r = σ_diff / σ_samp where a collision can happen, `None` where σ_samp = 0.
    pub fn ratio_at(&self, s: f64, sigma_t: f64) -> Option<f64> {
        (self.sampling.sigma_t(s) > 0.0).then(|| self.ratio(s, sigma_t))
    }

    /// The estimate of a walk of this weight: that and the control's own transmittance.
    #[inline]
    pub(crate) fn behind_control(&self, weight: &SignedProduct) -> f64 {
        weight.times_known_exp(-self.main_thickness, self.main_transmittance)
    }

    /// r = σ_diff / σ_samp at `s` (eq. 5, 6).
    #[inline]
    fn ratio(&self, s: f64, sigma_t: f64) -> f64 {
        (sigma_t - self.control.sigma_t(s)) / self.sampling.sigma_t(s)
    }

    /// One walk. `visit` sees each interaction point, σ_t there and the weight behind it; the walk's weight at the end is returned,
    /// or `None` where it ended before.
    #[inline]
    fn walk<F: Extinction>(
        &self,
        field: &F,
        source: &mut impl UniformSource,
        mut visit: impl FnMut(f64, f64, Option<&SignedProduct>),
    ) -> Option<SignedProduct> {
        let mut weight = SignedProduct::ONE;
        let mut s = 0.0;
        while let Some(next) = self.sampling.invert(s, source.next_exponential()) {
            s = next;
            let sigma_t = field.sigma_t(s);
            let Some(transmitted) = self.model.transmit(self.ratio(s, sigma_t), source) else {
                visit(s, sigma_t, None);
                return None;
            };
            weight.multiply(transmitted);
            visit(s, sigma_t, Some(&weight));
        }
        Some(weight)
    }
}

impl<F: Extinction, M: CollisionModel, C: OpticalThickness, R: InvertOpticalThickness>
    TransmittanceEstimator<F> for Tracking<M, C, R>
{
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        debug_assert_eq!(field.length(), self.sampling.length(), "prepared for another profile");
        self.walk(field, source, |_, _, _| {}).map_or(0.0, |weight| self.behind_control(&weight))
    }

    #[inline]
    fn admits(&self, _field: &F, s: f64, sigma_t: f64) -> bool {
        let (main, sampling) = (self.control.sigma_t(s), self.sampling.sigma_t(s));
        let rounding = rounding_of_difference(sigma_t, main);
        if sampling > 0.0 {
            let ratio = self.ratio(s, sigma_t);
            // A domain that ends where σ_t is the control, or at a multiple of σ_samp, holds what rounding carried over its end.
            return self.model.admits(ratio)
                || [-1.0, 1.0].iter().any(|side| self.model.admits(ratio + side * rounding / sampling));
        }
        // No collision can happen here: right only if there is nothing to collide with.
        (sigma_t - main).abs() <= rounding
    }
}

impl<F: Extinction, M: CollisionModel, C: OpticalThickness, R: InvertOpticalThickness>
    TransmittanceFunction<F> for Tracking<M, C, R>
{
    fn trace(&self, field: &F, source: &mut impl UniformSource, walk: &mut Vec<Interaction>) {
        self.walk(field, source, |distance, sigma_t, weight| {
            let weight = weight.map_or(0.0, |weight| weight.times_exp(0.0));
            walk.push(Interaction { distance, sigma_t, weight });
        });
    }

    fn main_transmittance(&self, s: f64) -> f64 {
        exp(-self.control.optical_thickness(0.0, s))
    }
}

impl<F: Extinction, M: CollisionModel, C: OpticalThickness, R: InvertOpticalThickness> ClosedForm<F>
    for Tracking<M, C, R>
{
    fn theory(&self, quadrature: &mut RayQuadrature<F>, _tau: f64, tolerance: Tolerance) -> Theory {
        // Where σ_samp = 0 nothing happens: no variance, no look-up.
        let at = |s: f64, sigma_t: f64| {
            let sampling = self.sampling.sigma_t(s);
            (sampling > 0.0).then(|| (sampling, self.model.transmitted(self.ratio(s, sigma_t))))
        };
        for kink in self.model.kinks() {
            quadrature.split_at_zeros(tolerance, &|s, sigma_t| {
                self.ratio_at(s, sigma_t).map_or(1.0, |ratio| ratio - kink)
            });
        }
        let collisions = quadrature.integrate(tolerance, |s, sigma_t| match at(s, sigma_t) {
            Some((sampling, transmitted)) => {
                std::array::from_fn(|i| sampling * transmitted.moment_about_one(i as i32 + 2))
            }
            None => [0.0; crate::MOMENTS],
        });
        let lookups = quadrature.integrate_nested(
            tolerance,
            |s, sigma_t| [at(s, sigma_t).map_or(0.0, |(sampling, t)| sampling * (1.0 - t.probability))],
            |s, _, [ended]| [self.sampling.sigma_t(s) * exp(-ended)],
        );
        ProductLaw::new(collisions.value).theory(collisions.error[0], lookups.value[0])
    }
}
