//! The law of one draw of a comb: integrals over its variate.

use super::{Comb, Prepared};
use fairflight_media::{Breakpoints, Extinction, RayQuadrature, Tolerance, adaptive_integral};

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
    /// The cumulants of X(u) on `from ≤ s ≤ to`, by quadrature over u: a reference, not an estimate.
    pub fn cumulants<F: Breakpoints>(
        &self,
        field: &F,
        from: f64,
        to: f64,
        tolerance: Tolerance,
    ) -> CombCumulants {
        let prepared = self.prepare(field, from, to);
        DeviationLaw::new(self, field, &prepared, tolerance).cumulants()
    }
}

/// D(u) = E\[X\] − X(u), the deviation of the logarithm of an estimate, as a function on \[0, 1\].
struct Deviation<'a, F> {
    comb: &'a Comb,
    field: &'a F,
    prepared: &'a Prepared,
    mean: f64,
}

impl<F: Extinction> Extinction for Deviation<'_, F> {
    fn sigma_t(&self, u: f64) -> f64 {
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
/// exact as they need to be at any order.
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

/// Look-ups that one quadrature may spend.
const MOST_LOOKUPS: f64 = 3e7;

impl<'a, F: Breakpoints> DeviationLaw<'a, F> {
    pub(super) fn new(comb: &'a Comb, field: &'a F, prepared: &'a Prepared, tolerance: Tolerance) -> Self {
        let affordable = (MOST_LOOKUPS / 21.0 / f64::from(comb.teeth())) as usize;
        let tolerance = Tolerance { most_panels: tolerance.most_panels.min(affordable), ..tolerance };
        let breaks = comb.folded_breakpoints(field, prepared);
        let mean = adaptive_integral(1.0, &breaks, tolerance, |u| [comb.thickness(field, prepared, u)]);
        let mean = mean.value[0];
        let mut quadrature = RayQuadrature::new(Deviation { comb, field, prepared, mean }, &[]);
        // Below the rounding of a comb's sum its variance is no variance; above, D itself has only so many digits.
        let noise = ROUNDING * (1.0 + mean.abs());
        let coarse = Tolerance { absolute: noise * noise, relative: 1e-3, ..tolerance };
        let rough = quadrature.integrate(coarse, |_, d| [d * d]).value[0];
        if rough <= noise * noise {
            return Self { quadrature, mean, unit: 0.0, k2: 0.0, relative_error: 0.0, tolerance };
        }
        let exactness = tolerance.relative.max(8.0 * noise / rough.sqrt());
        let fine = Tolerance { absolute: 0.0, relative: exactness, ..tolerance };
        let k2 = quadrature.integrate(fine, |_, d| [d * d]);
        let unit = quadrature.nodes().fold(0.0_f64, |greatest, (_, d)| greatest.max(d.abs()));
        let tolerance = Tolerance { absolute: exactness, relative: exactness, ..tolerance };
        let (k2, relative_error) = (k2.value[0], k2.error[0] / k2.value[0]);
        Self { quadrature, mean, unit, k2, relative_error, tolerance }
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

    /// The error of k2, relative to it.
    pub(super) fn relative_error(&self) -> f64 {
        self.relative_error
    }

    pub(super) fn cumulants(&mut self) -> CombCumulants {
        let Self { mean, unit, k2, .. } = *self;
        if unit == 0.0 {
            return CombCumulants { mean, k2: 0.0, k3: 0.0, k4: 0.0 };
        }
        let [third, fourth] = self.expect(|_, x| [x * x * x, x * x * x * x]);
        // D = E[X] − X: odd moments change their sign.
        CombCumulants { mean, k2, k3: -third * unit.powi(3), k4: fourth * unit.powi(4) - 3.0 * k2 * k2 }
    }

    /// E\[g(D, x)\], x = D/max |D|; for a comb with a variance.
    pub(super) fn expect<const K: usize>(&mut self, g: impl Fn(f64, f64) -> [f64; K]) -> [f64; K] {
        let scale = 1.0 / self.unit;
        self.quadrature.integrate(self.tolerance, |_, d| g(d, d * scale)).value
    }

    /// As [`expect`](Self::expect), of numbers of any size: exact relative to themselves or to `size`, whichever is greater.
    pub(super) fn expect_within<const K: usize>(
        &mut self,
        size: f64,
        g: impl Fn(f64, f64) -> [f64; K],
    ) -> [f64; K] {
        let (scale, relative) = (1.0 / self.unit, self.tolerance.relative);
        let tolerance = Tolerance { absolute: relative * size, ..self.tolerance };
        self.quadrature.integrate(tolerance, |_, d| g(d, d * scale)).value
    }

    /// E\[x^p g(D)\] for p = 0 … `highest`.
    pub(super) fn moments(&mut self, highest: usize, g: impl Fn(f64) -> f64) -> Vec<f64> {
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
            }));
        }
        moments
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
