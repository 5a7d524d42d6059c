//! The law of one draw of a comb: integrals over its variate.

use super::{Comb, Prepared};
use crate::allowance::Allowance;
use fairflight_media::{Breakpoints, Extinction, Integral, RayQuadrature, Tolerance};

/// Mean and cumulants of X(u), one draw of a comb: what bias and variance of every estimate of exp(−X) are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CombCumulants {
    /// E\[X\] \[1\].
    pub mean: f64,
    /// The variance.
    pub k2: f64,
    /// The third cumulant, E\[(X − E)³\].
    pub k3: f64,
    /// The fourth cumulant, E\[(X − E)⁴\] − 3 k2².
    pub k4: f64,
}

impl Comb {
    /// The cumulants of X(u) on `from ≤ s ≤ to`, by quadrature over u: a reference, not an estimate. NaN where they take too many look-ups.
    pub fn cumulants<F: Breakpoints>(
        &self,
        field: &F,
        from: f64,
        to: f64,
        tolerance: Tolerance,
    ) -> CombCumulants {
        let prepared = self.prepare(field, from, to);
        let allowance = Allowance::usual();
        DeviationLaw::new((self, field, &prepared), tolerance, &allowance)
            .and_then(|mut law| law.cumulants())
            .unwrap_or(CombCumulants { mean: f64::NAN, k2: f64::NAN, k3: f64::NAN, k4: f64::NAN })
    }
}

/// D(u) = E\[X\] − X(u), the deviation of the logarithm of an estimate, as a function on \[0, 1\].
struct Deviation<'a, F> {
    comb: &'a Comb,
    field: &'a F,
    prepared: &'a Prepared,
    mean: f64,
    allowance: &'a Allowance,
}

impl<F: Extinction> Extinction for Deviation<'_, F> {
    fn sigma_t(&self, u: f64) -> f64 {
        self.allowance.spend(f64::from(self.comb.teeth()));
        self.mean - self.comb.thickness(self.field, self.prepared, u)
    }
    fn length(&self) -> f64 {
        1.0
    }
}

impl<F: Breakpoints> Breakpoints for Deviation<'_, F> {
    fn breakpoints(&self) -> Vec<f64> {
        self.comb.folded_breakpoints(self.field, self.prepared)
    }
}

/// Expectations of functions of D. Powers are those of x = D/max |D|, which are at most 1: their integrals are as
/// exact as they need to be at any order. What is `None` is beyond the allowance.
pub(super) struct DeviationLaw<'a, F> {
    quadrature: RayQuadrature<Deviation<'a, F>>,
    mean: f64,
    /// max |D| over the nodes of the quadrature; 0 where D is nothing but rounding.
    unit: f64,
    k2: f64,
    relative_error: f64,
    tolerance: Tolerance,
}

/// What rounding leaves of a comb's sum, per unit of 1 + its thickness.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl<'a, F: Breakpoints> DeviationLaw<'a, F> {
    pub(super) fn new(
        (comb, field, prepared): (&'a Comb, &'a F, &'a Prepared),
        tolerance: Tolerance,
        allowance: &'a Allowance,
    ) -> Option<Self> {
        let teeth = f64::from(comb.teeth());
        let breaks = comb.folded_breakpoints(field, prepared);
        let mean = allowance.integral(&breaks, tolerance, teeth, |u| [comb.thickness(field, prepared, u)])?;
        let mean_error = if mean.converged { 0.0 } else { mean.error[0] };
        let mean = mean.value[0];
        // Of the deviations: one panel of all, then one between any two breakpoints.
        allowance.tolerance(tolerance, teeth, breaks.len() + 2)?;
        let deviation = Deviation { comb, field, prepared, mean, allowance };
        let quadrature = RayQuadrature::new(deviation, &[]);
        let mut law = Self { quadrature, mean, unit: 0.0, k2: 0.0, relative_error: 0.0, tolerance };
        // Below the rounding of a comb's sum its variance is no variance; above, D itself has only so many digits.
        let noise = ROUNDING * (1.0 + mean.abs());
        let coarse = Tolerance { absolute: noise * noise, relative: 1e-3, ..tolerance };
        let rough = law.integrate(coarse, |_, d| [d * d])?.value[0];
        if rough <= noise * noise {
            return Some(law);
        }
        let exactness = tolerance.relative.max(8.0 * noise / rough.sqrt());
        let fine = Tolerance { absolute: 0.0, relative: exactness, ..tolerance };
        let k2 = law.integrate(fine, |_, d| [d * d])?;
        law.unit = law.quadrature.nodes().fold(0.0_f64, |greatest, (_, d)| greatest.max(d.abs()));
        law.tolerance = Tolerance { absolute: exactness, relative: exactness, ..tolerance };
        law.k2 = k2.value[0];
        // E[D²] about another centre is greater by the square of what lies between.
        law.relative_error = (k2.error[0] + mean_error * mean_error) / law.k2;
        Some(law)
    }

    /// ∫ g(u, D), with the error of what the allowance suffices for.
    fn integrate<const K: usize>(
        &mut self,
        tolerance: Tolerance,
        g: impl Fn(f64, f64) -> [f64; K],
    ) -> Option<Integral<K>> {
        let Deviation { allowance, comb, .. } = *self.quadrature.field();
        let (teeth, panels) = (f64::from(comb.teeth()), self.quadrature.borders().count() + 1);
        // At the nodes that there are, an integrand is all that is evaluated.
        allowance.tolerance(tolerance, 1.0, panels)?;
        let tolerance = allowance.tolerance(tolerance, teeth, 0)?;
        Some(self.quadrature.integrate(tolerance, |u, d| {
            allowance.spend(1.0);
            g(u, d)
        }))
    }

    /// max |D|; 0 for a comb without variance.
    pub(super) fn unit(&self) -> f64 {
        self.unit
    }

    /// max D over the nodes so far: what the greatest estimate is the exponential of, in units of T.
    pub(super) fn greatest(&self) -> f64 {
        self.quadrature.nodes().fold(0.0_f64, |greatest, (_, d)| greatest.max(d))
    }

    /// Var D.
    pub(super) fn k2(&self) -> f64 {
        self.k2
    }

    /// The error of k2, relative to it, or that of an expectation which has not converged.
    pub(super) fn relative_error(&self) -> f64 {
        self.relative_error
    }

    pub(super) fn cumulants(&mut self) -> Option<CombCumulants> {
        let Self { mean, unit, k2, .. } = *self;
        if unit == 0.0 {
            return Some(CombCumulants { mean, k2: 0.0, k3: 0.0, k4: 0.0 });
        }
        let [third, fourth] = self.expect(|_, x| [x * x * x, x * x * x * x])?;
        // D = E[X] − X: odd moments change their sign.
        Some(CombCumulants { mean, k2, k3: -third * unit.powi(3), k4: fourth * unit.powi(4) - 3.0 * k2 * k2 })
    }

    /// E\[g(D, x)\], x = D/max |D|; for a comb with a variance.
    pub(super) fn expect<const K: usize>(&mut self, g: impl Fn(f64, f64) -> [f64; K]) -> Option<[f64; K]> {
        self.expect_to(self.tolerance, g)
    }

    /// As [`expect`](Self::expect), of numbers of any size: exact relative to themselves or to `size`, whichever is greater.
    pub(super) fn expect_within<const K: usize>(
        &mut self,
        size: f64,
        g: impl Fn(f64, f64) -> [f64; K],
    ) -> Option<[f64; K]> {
        let tolerance = Tolerance { absolute: self.tolerance.relative * size, ..self.tolerance };
        self.expect_to(tolerance, g)
    }

    fn expect_to<const K: usize>(
        &mut self,
        tolerance: Tolerance,
        g: impl Fn(f64, f64) -> [f64; K],
    ) -> Option<[f64; K]> {
        let scale = 1.0 / self.unit;
        let found = self.integrate(tolerance, |_, d| g(d, d * scale))?;
        if !found.converged {
            // What is made of powers of x is compared with E[x²], what is greater with itself.
            let square = self.k2 * scale * scale;
            let relative =
                found.value.iter().zip(found.error).map(|(value, error)| error / (square + value.abs()));
            self.relative_error = relative.fold(self.relative_error, f64::max);
        }
        Some(found.value)
    }

    /// E\[x^p g(D)\] for p = 0 … `highest`.
    pub(super) fn moments(&mut self, highest: usize, g: impl Fn(f64) -> f64) -> Option<Vec<f64>> {
        const BATCH: usize = 8;
        let mut moments = Vec::with_capacity(highest + BATCH);
        while moments.len() <= highest {
            let first = moments.len() as i32;
            moments.extend(self.expect::<BATCH>(|d, x| {
                let mut power = x.powi(first) * g(d);
                std::array::from_fn(|_| {
                    let next = power * x;
                    std::mem::replace(&mut power, next)
                })
            })?);
        }
        Some(moments)
    }
}

#[cfg(test)]
mod tests {
    use super::super::CombShape;
    use super::*;
    use crate::test_support::{seed_ray, tent};
    use approx::assert_relative_eq;
    use fairflight_media::Constant;

    #[test]
    fn one_tooth_on_a_line_is_uniform() {
        // X(u) = 2 (1 + 2 u) h-free: uniform between 2 and 6, k2 = 16/12, k3 = 0, k4 = −16²/120.
        let line = fairflight_media::PiecewiseLinear::new(vec![0.0, 2.0], vec![1.0, 3.0]).unwrap();
        let comb = Comb::new(1, CombShape::Uniform).unwrap();
        let found = comb.cumulants(&line, 0.0, 2.0, Tolerance::TIGHT);
        assert_relative_eq!(found.mean, 4.0, max_relative = 1e-13);
        assert_relative_eq!(found.k2, 4.0 / 3.0, max_relative = 1e-12);
        assert_relative_eq!(found.k3, 0.0, epsilon = 1e-11);
        assert_relative_eq!(found.k4, -256.0 / 120.0, max_relative = 1e-10);
    }

    #[test]
    fn a_constant_profile_has_no_variance() {
        let field = Constant::new(0.7, 3.0).unwrap();
        for shape in [CombShape::Uniform, CombShape::EndpointMatched, CombShape::Bernoulli3] {
            let found = Comb::new(5, shape).unwrap().cumulants(&field, 0.0, 3.0, Tolerance::TIGHT);
            assert_eq!([found.k2, found.k3, found.k4], [0.0; 3]);
            assert_relative_eq!(found.mean, 2.1, max_relative = 1e-14);
        }
    }

    #[test]
    fn variances_of_the_seed_ray() {
        // Measured by the prototype of these estimators on tables of 20000 variates.
        let ray = seed_ray();
        let k2 =
            |teeth, shape| Comb::new(teeth, shape).unwrap().cumulants(&ray, 0.0, 20.0, Tolerance::TIGHT).k2;
        assert_relative_eq!(k2(8, CombShape::Uniform), 0.90, max_relative = 0.01);
        assert_relative_eq!(k2(8, CombShape::EndpointMatched), 1.36, max_relative = 0.01);
        let tent = tent();
        let law = Comb::new(4, CombShape::Periodised).unwrap();
        assert!(law.cumulants(&tent, 0.0, 3.0, Tolerance::TIGHT).k2 < 0.05);
    }
}
