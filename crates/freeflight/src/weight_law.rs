//! Moments of the weights of a flight, by quadrature over the ray.

use crate::theory::{HIGHEST_MOMENT, Moments, powers, times_exp};
use fairflight_elementary::exp;
use fairflight_media::{Extinction, Integral, RayQuadrature, Tolerance};

/// A function of a field, s and σ_t(s).
pub(crate) type Along<'a, F, T> = Box<dyn Fn(&F, f64, f64) -> T + 'a>;

/// The law of the weights of a flight. (Closures behind pointers: they are called seldom, and the quadrature is compiled once.)
pub enum WeightLaw<'a, F> {
    /// Weights of 1.
    One,
    /// Weights of N for one flight in N, drawn at random, of 0 for the others.
    OneIn(usize),
    /// Weights whose mean alone has a closed form, that of the law; the higher moments are NaN.
    MeanOnly,
    /// Products over events that do not depend on the past.
    Products(WeightProducts<'a, F>),
}

/// Weights whose moments M_k(s) = E\[weight^k\] of the flights still under way grow at a rate of their own place.
pub struct WeightProducts<'a, F> {
    /// Functions that pass 0 where the others are not smooth.
    pub(crate) kinks: Vec<Along<'a, F, f64>>,
    /// Rate d ln M_k/ds.
    pub(crate) growth: Along<'a, F, Moments>,
    /// The moments per length of weight times score of collisions.
    pub(crate) collided: Collided<'a, F>,
}

/// A function of a field, s, σ_t(s), ln M_k(s) and the score at s.
type Collided<'a, F> = Box<dyn Fn(&F, f64, f64, Moments, f64) -> Moments + 'a>;

impl<'a, F: Extinction + Clone> WeightLaw<'a, F> {
    /// Products whose moments grow by `growth` = d ln M_k/ds; `collisions` are the moments of the weight of a collision, times the rate of
    /// collisions, both of a flight that came with a weight of 1. The two are smooth but where one of `kinks` passes 0.
    pub fn products(
        kinks: Vec<Along<'a, F, f64>>,
        growth: impl Fn(&F, f64, f64) -> Moments + 'a,
        collisions: impl Fn(&F, f64, f64) -> Moments + 'a,
    ) -> Self {
        let collided = move |field: &F, s: f64, sigma_t: f64, growth: Moments, score: f64| {
            let (collided, scores) = (collisions(field, s, sigma_t), powers(score));
            std::array::from_fn(|i| times_exp(collided[i], growth[i], scores[i]))
        };
        Self::Products(WeightProducts { kinks, growth: Box::new(growth), collided: Box::new(collided) })
    }

    /// Makes the places where moments are not smooth borders between panels.
    pub fn split_at_kinks(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) {
        if let Self::Products(products) = self {
            let field = quadrature.field().clone();
            for kink in &products.kinks {
                quadrature.split_at_zeros(tolerance, &|s, sigma_t| kink(&field, s, sigma_t));
            }
        }
    }

    /// E\[1{collided} (weight · score(distance))^k\]. With a score of 1, the moments of the weight of a collision; the second is then
    /// what a wasteful sampler is known by. Where `score` jumps, the `quadrature` must have a border.
    pub fn collided(
        &self,
        quadrature: &mut RayQuadrature<F>,
        tolerance: Tolerance,
        score: &dyn Fn(f64) -> f64,
    ) -> Integral<HIGHEST_MOMENT> {
        self.split_at_kinks(quadrature, tolerance);
        match self {
            Self::One => quadrature.integrate_nested(
                tolerance,
                |_, sigma_t| [sigma_t],
                |s, sigma_t, [tau]| powers(score(s)).map(|power| sigma_t * exp(-tau) * power),
            ),
            Self::OneIn(n) => {
                let one = Self::One.collided(quadrature, tolerance, score);
                let [value, error] = [one.value, one.error].map(|moments| weighted(*n, moments));
                Integral { value, error, ..one }
            }
            Self::MeanOnly => {
                let mean = quadrature.integrate_nested(
                    tolerance,
                    |_, sigma_t| [sigma_t],
                    |s, sigma_t, [tau]| [sigma_t * exp(-tau) * score(s)],
                );
                let [value, error] = [mean.value, mean.error].map(|[mean]| mean_only(mean));
                Integral { value, error, converged: mean.converged }
            }
            Self::Products(WeightProducts { growth, collided, .. }) => {
                let field = quadrature.field().clone();
                quadrature.integrate_nested(
                    tolerance,
                    |s, sigma_t| growth(&field, s, sigma_t),
                    |s, sigma_t, logarithms| collided(&field, s, sigma_t, logarithms, score(s)),
                )
            }
        }
    }

    /// E\[1{escaped} weight^k\].
    pub fn escaped(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> Moments {
        self.split_at_kinks(quadrature, tolerance);
        let mut transmittance = || exp(-quadrature.integrate(tolerance, |_, sigma_t| [sigma_t]).value[0]);
        match self {
            Self::One => [transmittance(); HIGHEST_MOMENT],
            Self::OneIn(n) => weighted(*n, [transmittance(); HIGHEST_MOMENT]),
            Self::MeanOnly => mean_only(transmittance()),
            Self::Products(WeightProducts { growth, .. }) => {
                let field = quadrature.field().clone();
                let logarithms = quadrature.integrate(tolerance, |s, sigma_t| growth(&field, s, sigma_t));
                logarithms.value.map(exp)
            }
        }
    }
}

/// Moments of n times a score that one flight in n has, from those of the score.
fn weighted(n: usize, moments: Moments) -> Moments {
    std::array::from_fn(|i| (n as f64).powi(i as i32) * moments[i])
}

fn mean_only(mean: f64) -> Moments {
    std::array::from_fn(|i| if i == 0 { mean } else { f64::NAN })
}
