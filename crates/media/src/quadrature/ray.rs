//! Integrals over a profile of functions of s and σ_t(s).

use super::cumulative::{Cumulative, running_at_nodes};
use super::panels::{Integral, Panels, Tolerance};
use crate::{Breakpoints, Extinction};

/// Quadrature of one profile: σ_t is evaluated once per node and kept for every further integrand.
#[derive(Clone, Debug)]
pub struct RayQuadrature<F> {
    field: F,
    panels: Panels<f64>,
}

impl<F> RayQuadrature<F> {
    /// The same panels and values under another type of the same profile: σ_t is not evaluated again. With a bound put on
    /// a field, or the field taken away to be put back.
    pub fn with_field<G>(&self, field: G) -> RayQuadrature<G> {
        RayQuadrature { field, panels: self.panels.clone() }
    }
}

impl<F: Breakpoints> RayQuadrature<F> {
    /// Panels between the field's breakpoints, and at `also`: the breakpoints of a control or of a sampling extinction.
    pub fn new(field: F, also: &[f64]) -> Self {
        let mut breakpoints = field.breakpoints();
        breakpoints.extend_from_slice(also);
        let panels = Panels::new(field.length(), &breakpoints, &|s| field.sigma_t(s));
        Self { field, panels }
    }
}

impl<F: Extinction> RayQuadrature<F> {
    /// The profile.
    pub fn field(&self) -> &F {
        &self.field
    }

    /// Makes further points borders between panels.
    pub fn split_at(&mut self, points: &[f64]) {
        let Self { field, panels } = self;
        panels.split_at(points, &|s| field.sigma_t(s));
    }

    /// Makes the places at which `function(s, sigma_t)` changes its sign borders between panels: where an integrand takes its size, or
    /// decides by its sign, it has a kink there. The function must be as smooth between the borders as σ_t is.
    pub fn split_at_zeros(&mut self, tolerance: Tolerance, function: &dyn Fn(f64, f64) -> f64) {
        /// The place of a kink enters an integral by the square of its error.
        const PLACE: f64 = 1e-9;
        let Self { field, panels } = self;
        let tolerance = Tolerance { absolute: PLACE, relative: PLACE, ..tolerance };
        panels.settle(&|s| field.sigma_t(s), tolerance, &|s, &sigma_t| [function(s, sigma_t)]);
        let zeros = panels.zeros(&|s, &sigma_t| function(s, sigma_t));
        self.split_at(&zeros);
    }

    /// ∫ of each component of `integrand(s, sigma_t)` over the profile.
    pub fn integrate<const K: usize>(
        &mut self,
        tolerance: Tolerance,
        integrand: impl Fn(f64, f64) -> [f64; K],
    ) -> Integral<K> {
        let Self { field, panels } = self;
        panels.integrate(&|s| field.sigma_t(s), tolerance, &|s, &sigma_t| integrand(s, sigma_t))
    }

    /// ∫ of each component of `integrand(part, s, sigma_t)` over each part of the profile, and over the whole. The parts lie
    /// between 0 and the `ends` in increasing order, of which the last is the length. The tolerance is that of the whole.
    pub fn integrate_parts<const K: usize>(
        &mut self,
        tolerance: Tolerance,
        ends: &[f64],
        integrand: impl Fn(usize, f64, f64) -> [f64; K],
    ) -> (Vec<[f64; K]>, Integral<K>) {
        let Self { field, panels } = self;
        let integrand = |part: usize, s: f64, &sigma_t: &f64| integrand(part, s, sigma_t);
        panels.integrate_parts(&|s| field.sigma_t(s), tolerance, ends, &integrand)
    }

    /// ∫ of each component of `outer(s, sigma_t, I(s))`, where `I(s) = ∫_0^s inner`.
    pub fn integrate_nested<const M: usize, const K: usize>(
        &mut self,
        tolerance: Tolerance,
        inner: impl Fn(f64, f64) -> [f64; M],
        outer: impl Fn(f64, f64, [f64; M]) -> [f64; K],
    ) -> Integral<K> {
        let Self { field, panels } = self;
        nested(panels, &|s| field.sigma_t(s), tolerance, &inner, &outer)
    }

    /// `I(s) = ∫_0^s integrand` as a function of s.
    pub fn cumulative<const K: usize>(
        &mut self,
        tolerance: Tolerance,
        integrand: impl Fn(f64, f64) -> [f64; K],
    ) -> Cumulative<K> {
        let Self { field, panels } = self;
        panels.settle(&|s| field.sigma_t(s), tolerance, &|s, &sigma_t| integrand(s, sigma_t));
        Cumulative::of(&panels.panels, &|s, &sigma_t| integrand(s, sigma_t))
    }

    /// Every node at which σ_t was evaluated so far, in order, with the value found there.
    pub fn nodes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.panels
            .panels
            .iter()
            .flat_map(|panel| panel.values.iter().enumerate().map(|(i, &sigma_t)| (panel.node(i), sigma_t)))
    }

    /// The borders between panels.
    pub fn borders(&self) -> impl Iterator<Item = f64> + '_ {
        self.panels.panels.iter().skip(1).map(|panel| panel.from)
    }
}

/// An integrand of s, σ_t and the inner integral up to s.
type Outer<'a, const M: usize, const K: usize> = &'a dyn Fn(f64, f64, [f64; M]) -> [f64; K];

fn nested<const M: usize, const K: usize>(
    panels: &mut Panels<f64>,
    sample: &dyn Fn(f64) -> f64,
    tolerance: Tolerance,
    inner: &dyn Fn(f64, f64) -> [f64; M],
    outer: Outer<'_, M, K>,
) -> Integral<K> {
    // The inner integral first: where it has converged, an error of the outer one is its own.
    panels.settle(sample, tolerance, &|s, &sigma_t| inner(s, sigma_t));
    panels.refine(sample, tolerance, &|panels| {
        let running = running_at_nodes(panels, &|s, &sigma_t| inner(s, sigma_t));
        panels
            .iter()
            .zip(&running)
            .map(|(panel, running)| {
                panel.integrals(&|i, s, &sigma_t| outer(s, sigma_t, std::array::from_fn(|m| running[m][i])))
            })
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Constant, PiecewiseConstant};

    /// sigma_t(s) = 1 + sin(s), without breakpoints.
    struct Wave;
    impl Extinction for Wave {
        fn sigma_t(&self, s: f64) -> f64 {
            1.0 + s.sin()
        }
        fn length(&self) -> f64 {
            7.0
        }
    }
    impl Breakpoints for Wave {
        fn breakpoints(&self) -> Vec<f64> {
            Vec::new()
        }
    }

    #[test]
    fn smooth_functions_and_kinks_reach_their_tolerance() {
        let mut quadrature = RayQuadrature::new(Wave, &[]);
        let integral =
            quadrature.integrate(Tolerance::TIGHT, |_, sigma| [sigma, sigma * sigma, (sigma - 1.0).abs()]);
        let exact = [
            8.0 - 7.0_f64.cos(),
            10.5 + 2.0 * (1.0 - 7.0_f64.cos()) - 14.0_f64.sin() / 4.0,
            4.0 + 1.0 - 7.0_f64.cos(),
        ];
        assert!(integral.converged);
        for (value, exact) in integral.value.into_iter().zip(exact) {
            assert!((value - exact).abs() < 1e-11, "{exact}: {integral:?}");
        }
    }

    #[test]
    fn a_nested_integral_is_exact() {
        // ∫ exp(-∫_0^s sigma) ds for sigma = 0.3 is (1 - exp(-0.3 L)) / 0.3.
        let field = Constant::new(0.3, 20.0).unwrap();
        let mut quadrature = RayQuadrature::new(field, &[5.0]);
        let nested =
            quadrature.integrate_nested(Tolerance::TIGHT, |_, sigma| [sigma], |_, _, [tau]| [(-tau).exp()]);
        assert!((nested.value[0] - (-(-6.0_f64).exp_m1()) / 0.3).abs() < 1e-12);
    }

    #[test]
    fn a_cumulative_integral_follows_the_closed_form() {
        let mut quadrature = RayQuadrature::new(Wave, &[]);
        let cumulative = quadrature.cumulative(Tolerance::TIGHT, |_, sigma| [sigma]);
        for i in 0..=70 {
            let s = 0.1 * f64::from(i);
            assert!((cumulative.at(s)[0] - (s + 1.0 - s.cos())).abs() < 1e-12, "s = {s}");
        }
    }

    #[test]
    fn parts_add_up_and_know_their_index() {
        let mut quadrature = RayQuadrature::new(Wave, &[2.5]);
        let ends = [1.0, 1.5, 6.0, 7.0];
        let (parts, total) = quadrature.integrate_parts(Tolerance::TIGHT, &ends, |part, _, sigma| {
            [sigma, part as f64, (sigma - 1.0).abs()]
        });
        let mut from = 0.0_f64;
        for (i, (part, to)) in parts.iter().zip(ends).enumerate() {
            assert!((part[0] - (to - from + from.cos() - to.cos())).abs() < 1e-12);
            assert!((part[1] - i as f64 * (to - from)).abs() < 1e-12);
            from = to;
        }
        let sum: f64 = parts.iter().map(|part| part[2]).sum();
        assert!((sum - total.value[2]).abs() < 1e-12 && total.converged);
        let mut empty = RayQuadrature::new(Constant::new(1.0, 0.0).unwrap(), &[]);
        assert_eq!(empty.integrate_parts(Tolerance::TIGHT, &[], |_, _, sigma| [sigma]).0.len(), 0);
    }

    #[test]
    fn breakpoints_make_steps_exact() {
        let steps = PiecewiseConstant::new(vec![0.0, 0.1, 0.100_001, 3.0], vec![1.0, 1e6, 2.0]).unwrap();
        let mut quadrature = RayQuadrature::new(&steps, &[]);
        let integral = quadrature.integrate(Tolerance::TIGHT, |_, sigma| [sigma]);
        assert!((integral.value[0] - (0.1 + 1.0 + 2.0 * 2.899_999)).abs() < 1e-9);
        assert_eq!(quadrature.borders().count(), 2);
    }

    #[test]
    fn an_integrand_that_is_not_finite_is_reported() {
        let mut quadrature = RayQuadrature::new(Wave, &[]);
        let integral = quadrature.integrate(Tolerance::TIGHT, |_, _| [f64::NAN]);
        assert!(!integral.converged && integral.error[0].is_infinite());
    }

    #[test]
    fn an_empty_profile_integrates_to_zero() {
        let mut quadrature = RayQuadrature::new(Constant::new(1.0, 0.0).unwrap(), &[]);
        assert_eq!(quadrature.integrate(Tolerance::TIGHT, |_, sigma| [sigma]).value, [0.0]);
    }
}
