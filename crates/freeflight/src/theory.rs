//! What is known of a sampler before a flight is drawn.

use fairflight_media::{Extinction, Integral, RayQuadrature, Tolerance};

/// The highest power of a score whose moment is computed: what the tests of a mean (4) and of a variance (8) want.
pub const HIGHEST_MOMENT: usize = 8;

/// A sampler whose weights have a law in closed form, up to quadrature over the ray.
pub trait ClosedForm<F: Extinction> {
    /// E\[1{collided} (weight · score(distance))^k\] for k = 1 … 8 (index k − 1). With a score of 1, the moments of the
    /// weight of a collision; the second is then what a wasteful sampler is known by.
    ///
    /// Where `score` jumps, the `quadrature` must have a border.
    fn collided(
        &self,
        quadrature: &mut RayQuadrature<F>,
        tolerance: Tolerance,
        score: impl Fn(f64) -> f64,
    ) -> Integral<HIGHEST_MOMENT>;

    /// E\[1{escaped} weight^k\] for k = 1 … 8 (index k − 1).
    fn escaped(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> [f64; HIGHEST_MOMENT];

    /// The expected number of look-ups of one flight; `None` where no closed form is known.
    fn lookups(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> Option<f64>;
}

impl<F: Extinction, E: ClosedForm<F>> ClosedForm<F> for &E {
    fn collided(
        &self,
        quadrature: &mut RayQuadrature<F>,
        tolerance: Tolerance,
        score: impl Fn(f64) -> f64,
    ) -> Integral<HIGHEST_MOMENT> {
        (**self).collided(quadrature, tolerance, score)
    }
    fn escaped(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> [f64; HIGHEST_MOMENT] {
        (**self).escaped(quadrature, tolerance)
    }
    fn lookups(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> Option<f64> {
        (**self).lookups(quadrature, tolerance)
    }
}

/// ∫ σ_t T score^k ds for k = 1 … 8: [`ClosedForm::collided`] of every sampler whose weights are 1.
pub(crate) fn unweighted_collided<F: Extinction>(
    quadrature: &mut RayQuadrature<F>,
    tolerance: Tolerance,
    score: impl Fn(f64) -> f64,
) -> Integral<HIGHEST_MOMENT> {
    quadrature.integrate_nested(
        tolerance,
        |_, sigma_t| [sigma_t],
        |s, sigma_t, [tau]| powers(score(s)).map(|power| sigma_t * (-tau).exp() * power),
    )
}

/// T(length), whatever the power: [`ClosedForm::escaped`] of every sampler whose weights are 1.
pub(crate) fn unweighted_escaped<F: Extinction>(
    quadrature: &mut RayQuadrature<F>,
    tolerance: Tolerance,
) -> [f64; HIGHEST_MOMENT] {
    let tau = quadrature.integrate(tolerance, |_, sigma_t| [sigma_t]).value[0];
    [(-tau).exp(); HIGHEST_MOMENT]
}

/// x, x², …, x⁸.
pub(crate) fn powers(x: f64) -> [f64; HIGHEST_MOMENT] {
    let mut power = 1.0;
    std::array::from_fn(|_| {
        power *= x;
        power
    })
}
