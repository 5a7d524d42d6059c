//! The comb: a quadrature of the optical thickness with one random shift (kettunen-2021).

use fairflight_elementary::{asin, sin};
use fairflight_media::{Breakpoints, Extinction};

/// How the teeth of a [`Comb`] are placed and corrected. Every shape is unbiased on every profile; they differ in
/// variance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CombShape {
    /// Equidistant teeth of equal weight, the comb of kettunen-2021.
    Uniform,
    /// The uniform comb less h B_1(u) \[σ_t\], the first term of its error (the endpoint matching of kettunen-2021):
    /// it integrates a linear profile exactly. Two shared look-ups, at the ends.
    EndpointMatched,
    /// Two terms, with slopes at the ends by one-sided differences over half a tooth. Four shared look-ups.
    Bernoulli2,
    /// Three terms, with slopes and curvatures by one-sided differences over one tooth. Six shared look-ups. It pays
    /// where the teeth resolve the profile, else it costs.
    Bernoulli3,
    /// Equidistant teeth in the variable t of s = (3 t² − 2 t³) · length, weighted with ds/dt, which vanishes at both
    /// ends, so that the profile looks periodic. No shared look-ups.
    Periodised,
}

impl CombShape {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Uniform, Self::EndpointMatched, Self::Bernoulli2, Self::Bernoulli3, Self::Periodised];

    /// Look-ups of one interval that all draws share.
    fn shared(self) -> u32 {
        match self {
            Self::Uniform | Self::Periodised => 0,
            Self::EndpointMatched => 2,
            Self::Bernoulli2 => 4,
            Self::Bernoulli3 => 6,
        }
    }
}

/// A randomly shifted quadrature of ∫ σ_t over an interval, with `teeth` equidistant look-ups.
///
/// With h = (to − from)/M, one variate u and \[f\] = f(to) − f(from),
///
/// > X(u) = h Σ_{j<M} σ_t(from + (j + u) h) − Σ_{k≤K} h^k/k! B_k(u) \[σ_t^(k−1)\],
///
/// B_k the Bernoulli polynomials (u − 1/2; u² − u + 1/6; u³ − 3u²/2 + u/2) and K = 0 to 3 the order of the shape;
/// derivatives are one-sided differences. X is a *positive* optical thickness.
///
/// **Law.** E\[X(u)\] = ∫ σ_t for every profile that can be integrated. *Proof.* (j + u) h runs through tooth j's own
/// h once while u runs through \[0, 1): the intervals of all teeth together are the whole. The corrections have the
/// mean 0 whatever stands in the brackets, because ∫_0^1 B_k = 0 for k ≥ 1. The periodised comb is the uniform one
/// for ∫_0^1 σ_t(s(t)) s'(t) dt, the same integral after a change of variables with s' = 6 t (1 − t) ≥ 0, s(0) = 0
/// and s(1) = 1.
///
/// **Variance.** By Euler and Maclaurin X(u) − ∫ σ_t = Σ_{k>K} h^k/k! B_k(u) \[σ_t^(k−1)\] for a smooth profile: k2 ~
/// h^(2K+2) while its ends differ. That assumes teeth that resolve the profile; below one tooth per feature the
/// corrections only add to the variance.
///
/// A piecewise linear control with its nodes one tooth apart is the same as [`CombShape::EndpointMatched`], to the
/// last digit: what the control takes from the comb, its integral gives back, up to its ends. The same holds for any
/// interpolation that is shifted with its nodes and reproduces constants.
///
/// **Dense borders.** Corrections that could carry X below −350 are left out where σ_t is not negative at either end: see
/// `MOST_CORRECTION`.
///
/// **Cost.** `teeth` look-ups per draw, [`CombShape`]'s shared ones once per interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Comb {
    teeth: u32,
    shape: CombShape,
}

/// A comb needs at least one tooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("teeth must be at least 1, found 0")]
pub struct NoTeeth;

/// What a comb costs on one interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CombLookups {
    /// Look-ups that all draws share.
    pub shared: u32,
    /// Look-ups of one draw.
    pub per_draw: u32,
}

/// What all draws of one comb on one interval share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prepared {
    pub(crate) from: f64,
    pub(crate) to: f64,
    /// h.
    pub(crate) step: f64,
    /// σ_t(to), for the next interval; 0 where the shape does not ask for it.
    at_end: f64,
    /// h^k/k! \[σ_t^(k−1)\] for k = 1, 2, 3.
    pub(crate) corrections: [f64; 3],
}

/// Corrections that can shift X by more than this are left out where σ_t is not negative at either end.
///
/// X = h Σ σ_t − corrections may then be as far below 0, and exp(−X) is no number from 709 on: at the border of a dense cloud a corrected comb
/// would be infinite, on two neighbouring segments that share the border from half of it on. Whatever stands in the brackets, their mean
/// is 0, and they depend on no variate: the law is the same. What is lost is nothing: where a profile is so smooth that such
/// corrections serve (on a line h \[σ_t\]/2 is at most τ per tooth), T is below exp(−350).
const MOST_CORRECTION: f64 = 350.0;

/// The most that corrections can shift X by: |B_1| ≤ 1/2, |B_2| ≤ 1/6 and |B_3| ≤ √3/36 on \[0, 1\].
fn reach([first, second, third]: [f64; 3]) -> f64 {
    0.5 * first.abs() + second.abs() / 6.0 + third.abs() * 0.048_112_522_432_468_81
}

impl Comb {
    /// A comb of `teeth` teeth.
    ///
    /// # Errors
    /// If `teeth` is 0.
    pub fn new(teeth: u32, shape: CombShape) -> Result<Self, NoTeeth> {
        if teeth == 0 { Err(NoTeeth) } else { Ok(Self { teeth, shape }) }
    }

    /// The number of teeth.
    #[must_use]
    pub fn teeth(&self) -> u32 {
        self.teeth
    }

    /// The shape.
    #[must_use]
    pub fn shape(&self) -> CombShape {
        self.shape
    }

    /// The look-ups on one interval.
    #[must_use]
    pub fn lookups(&self) -> CombLookups {
        CombLookups { shared: self.shape.shared(), per_draw: self.teeth }
    }

    /// The shared look-ups of `intervals` neighbours prepared one after the other: each border is looked up once.
    #[must_use]
    pub fn shared_lookups(&self, intervals: u32) -> f64 {
        match (self.shape.shared(), intervals) {
            (0, _) | (_, 0) => 0.0,
            (shared, _) => f64::from(shared - 1) * f64::from(intervals) + 1.0,
        }
    }

    /// Does the shared look-ups of `from ≤ s ≤ to`.
    pub fn prepare<F: Extinction + ?Sized>(&self, field: &F, from: f64, to: f64) -> Prepared {
        let at_start = if self.shape.shared() == 0 { 0.0 } else { field.sigma_t(from) };
        self.prepared(field, from, at_start, to)
    }

    /// As [`Self::prepare`] for the interval from the end of `before` to `to`; the border is not looked up again.
    pub fn prepare_next<F: Extinction + ?Sized>(&self, field: &F, before: &Prepared, to: f64) -> Prepared {
        self.prepared(field, before.to, before.at_end, to)
    }

    #[inline]
    fn prepared<F: Extinction + ?Sized>(&self, field: &F, from: f64, start: f64, to: f64) -> Prepared {
        debug_assert!(from <= to && to <= field.length(), "an interval within the profile: [{from}, {to}]");
        let step = (to - from) / f64::from(self.teeth);
        let at_end = if self.shape.shared() == 0 { 0.0 } else { field.sigma_t(to) };
        let jump = step * (at_end - start);
        // The differences are taken over half a tooth, 2/h times a difference of values: h cancels, no step is too
        // small.
        let inner = |halves: f64| {
            let reach = 0.5 * halves * step;
            (field.sigma_t((from + reach).min(to)), field.sigma_t((to - reach).max(from)))
        };
        let corrections = match self.shape {
            CombShape::Uniform | CombShape::Periodised => [0.0; 3],
            CombShape::EndpointMatched => [jump, 0.0, 0.0],
            CombShape::Bernoulli2 => {
                let (after, before) = inner(1.0);
                [jump, step * ((at_end - before) - (after - start)), 0.0]
            }
            CombShape::Bernoulli3 => {
                let ((after, before), (after_2, before_2)) = (inner(1.0), inner(2.0));
                // Three points each: h times the slope, and h²/4 times the curvature.
                let slope_start = 4.0 * (after - start) - (after_2 - start);
                let slope_end = 4.0 * (at_end - before) - (at_end - before_2);
                let curved_start = (start - after) + (after_2 - after);
                let curved_end = (at_end - before) + (before_2 - before);
                [jump, 0.5 * step * (slope_end - slope_start), 2.0 / 3.0 * step * (curved_end - curved_start)]
            }
        };
        let nowhere_negative = start >= 0.0 && at_end >= 0.0;
        let corrections =
            if nowhere_negative && reach(corrections) > MOST_CORRECTION { [0.0; 3] } else { corrections };
        Prepared { from, to, step, at_end, corrections }
    }

    /// X(u) for the variate u in \[0, 1): `teeth` look-ups.
    #[inline]
    pub fn thickness<F: Extinction + ?Sized>(&self, field: &F, prepared: &Prepared, u: f64) -> f64 {
        let Prepared { from, to, step, corrections, .. } = *prepared;
        if self.shape == CombShape::Periodised {
            return self.periodised(field, prepared, u);
        }
        let first = from + u * step;
        let mut sum = 0.0;
        for tooth in 0..self.teeth {
            // Rounding may put the last tooth beyond the end.
            sum += field.sigma_t((first + f64::from(tooth) * step).min(to));
        }
        let [b1, b2, b3] = Self::bernoulli(u);
        step * sum - (corrections[0] * b1 + corrections[1] * b2 + corrections[2] * b3)
    }

    /// B_1, B_2 and B_3 at u.
    #[inline(always)]
    pub(crate) fn bernoulli(u: f64) -> [f64; 3] {
        let b1 = u - 0.5;
        [b1, u * (u - 1.0) + 1.0 / 6.0, u * b1 * (u - 1.0)]
    }

    fn periodised<F: Extinction + ?Sized>(&self, field: &F, prepared: &Prepared, u: f64) -> f64 {
        let Prepared { from, to, step, .. } = *prepared;
        let (length, scale) = (to - from, 1.0 / f64::from(self.teeth));
        let mut sum = 0.0;
        for tooth in 0..self.teeth {
            let t = (f64::from(tooth) + u) * scale;
            let s = (from + t * t * (3.0 - 2.0 * t) * length).min(to);
            sum += t * (1.0 - t) * field.sigma_t(s);
        }
        6.0 * step * sum
    }

    /// The variates u at which a tooth stands on a breakpoint of the field in `[from, to]`: between them X(u) is
    /// smooth.
    pub(super) fn folded_breakpoints<F: Breakpoints>(&self, field: &F, prepared: &Prepared) -> Vec<f64> {
        let (from, length) = (prepared.from, prepared.to - prepared.from);
        let inside = |s: &f64| prepared.from < *s && *s < prepared.to;
        let fold = |s: f64| {
            let x = (s - from) / length;
            let t = match self.shape {
                // The root in [0, 1] of 3 t² − 2 t³ = x.
                CombShape::Periodised => 0.5 - sin(asin(1.0 - 2.0 * x) / 3.0),
                _ => x,
            };
            (t * f64::from(self.teeth)).fract()
        };
        field.breakpoints().into_iter().filter(inside).map(fold).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{seed_ray, tent};
    use approx::assert_relative_eq;
    use fairflight_media::{
        Constant, Counted, OpticalThickness, PiecewiseLinear, Tolerance, adaptive_integral,
    };

    #[test]
    fn every_shape_has_the_integral_as_its_mean() {
        let (ray, tent) = (seed_ray(), tent());
        for shape in CombShape::ALL {
            for teeth in [1, 3, 8] {
                let comb = Comb::new(teeth, shape).unwrap();
                for (from, to, exact) in [
                    (0.0, 3.0, tent.optical_thickness(0.0, 3.0)),
                    (0.4, 1.7, tent.optical_thickness(0.4, 1.7)),
                ] {
                    let prepared = comb.prepare(&tent, from, to);
                    let breaks = comb.folded_breakpoints(&tent, &prepared);
                    let mean = adaptive_integral(1.0, &breaks, Tolerance::TIGHT, |u| {
                        [comb.thickness(&tent, &prepared, u)]
                    });
                    assert_relative_eq!(mean.value[0], exact, max_relative = 1e-12);
                }
                let prepared = comb.prepare(&ray, 0.0, 20.0);
                let mean =
                    adaptive_integral(1.0, &[], Tolerance::TIGHT, |u| [comb.thickness(&ray, &prepared, u)]);
                assert_relative_eq!(mean.value[0], 3.415_684, max_relative = 1e-6);
            }
        }
    }

    #[test]
    fn each_order_integrates_its_polynomials_exactly() {
        // 1 + s and 1 + s + s² + s³ look alike to a comb of order 1 only in the former.
        struct Cubic([f64; 4]);
        impl Extinction for Cubic {
            fn sigma_t(&self, s: f64) -> f64 {
                let [a, b, c, d] = self.0;
                a + s * (b + s * (c + s * d))
            }
            fn length(&self) -> f64 {
                2.0
            }
        }
        let exact = |[a, b, c, d]: [f64; 4]| 2.0 * a + 2.0 * b + 8.0 / 3.0 * c + 4.0 * d;
        // One-sided differences are exact for the slope of a line and, in three points, for a parabola.
        let cases = [
            (CombShape::Uniform, [1.0, 0.0, 0.0, 0.0]),
            (CombShape::EndpointMatched, [1.0, 0.5, 0.0, 0.0]),
            (CombShape::Bernoulli2, [1.0, 0.5, 0.0, 0.0]),
            (CombShape::Bernoulli3, [1.0, 0.5, 0.25, 0.0]),
        ];
        for (shape, coefficients) in cases {
            for teeth in [1, 2, 5] {
                let comb = Comb::new(teeth, shape).unwrap();
                let field = Cubic(coefficients);
                let prepared = comb.prepare(&field, 0.0, 2.0);
                for u in [0.0, 0.3, 0.5, 0.99] {
                    let x = comb.thickness(&field, &prepared, u);
                    assert_relative_eq!(x, exact(coefficients), max_relative = 1e-14);
                }
            }
        }
    }

    #[test]
    fn an_aligned_piecewise_linear_control_is_endpoint_matching() {
        let ray = seed_ray();
        let teeth = 25;
        let nodes: Vec<f64> = (0..=teeth).map(|i| 20.0 * f64::from(i) / f64::from(teeth)).collect();
        let values: Vec<f64> = nodes.iter().map(|&s| ray.sigma_t(s)).collect();
        let trapezium: f64 = 0.8 * (values.iter().sum::<f64>() - 0.5 * (values[0] + values[teeth as usize]));
        let control = PiecewiseLinear::new(nodes, values).unwrap();
        let uniform = Comb::new(teeth, CombShape::Uniform).unwrap();
        let matched = Comb::new(teeth, CombShape::EndpointMatched).unwrap();
        let (plain, ends) = (uniform.prepare(&ray, 0.0, 20.0), matched.prepare(&ray, 0.0, 20.0));
        for i in 0..100 {
            let u = f64::from(i) / 100.0;
            let of_control = uniform.thickness(&control, &plain, u);
            let residual = uniform.thickness(&ray, &plain, u) - of_control;
            let x = matched.thickness(&ray, &ends, u);
            assert_relative_eq!(residual + trapezium, x, max_relative = 1e-12);
        }
    }

    #[test]
    fn a_border_that_no_tooth_resolves_is_not_corrected() {
        let border = |dense: f64| PiecewiseLinear::new(vec![0.0, 1.9, 2.0], vec![0.1, 0.1, dense]).unwrap();
        for shape in [CombShape::EndpointMatched, CombShape::Bernoulli2, CombShape::Bernoulli3] {
            let comb = Comb::new(1, shape).unwrap();
            let x =
                |field: &PiecewiseLinear, u: f64| comb.thickness(field, &comb.prepare(field, 0.0, 2.0), u);
            // Corrected as ever, and then not at all: no thickness is far below 0.
            assert!(x(&border(100.0), 0.9) < -20.0);
            assert_eq!(x(&border(4e4), 0.9), 2.0 * border(4e4).sigma_t(1.8));
        }
        // Where the ends have different signs a correction may be all that keeps exp(−X) small: a line through zero stays exact.
        let line = PiecewiseLinear::new(vec![0.0, 2.0], vec![-4e4, 4e4]).unwrap();
        let comb = Comb::new(1, CombShape::EndpointMatched).unwrap();
        assert!(comb.thickness(&line, &comb.prepare(&line, 0.0, 2.0), 0.3).abs() < 1e-10);
    }

    #[test]
    fn look_ups_are_as_stated() {
        let field = Counted::new(Constant::new(0.4, 3.0).unwrap());
        for (shape, shared) in CombShape::ALL.into_iter().zip([0, 2, 4, 6, 0]) {
            let comb = Comb::new(7, shape).unwrap();
            let before = field.lookups();
            let first = comb.prepare(&field, 0.0, 1.0);
            assert_eq!(field.lookups() - before, u64::from(shared));
            let second = comb.prepare_next(&field, &first, 3.0);
            assert_eq!((field.lookups() - before) as f64, comb.shared_lookups(2));
            assert_eq!(comb.lookups(), CombLookups { shared, per_draw: 7 });
            let before = field.lookups();
            assert_relative_eq!(
                comb.thickness(&field, &second, 0.3),
                0.8,
                max_relative = if shape == CombShape::Periodised { 0.1 } else { 1e-15 }
            );
            assert_eq!(field.lookups() - before, 7);
        }
        assert_eq!(Comb::new(0, CombShape::Uniform), Err(NoTeeth));
    }
}
