//! Ratio tracking and next flight combined by multiple importance sampling, from one end or from both.
//!
//! **Path space.** (1) With w(s) = 1 − σ_t(s)/μ the transmittance is a sum over n of integrals over n ordered points,
//! points of null collisions in the medium of the majorant μ:
//!
//! > T = exp(−μS) exp(∫ (μ − σ_t)) = Σ_n ∫_{0 < x_1 < … < x_n < S} exp(−μS) μ^n w(x_1) … w(x_n) dx.
//!
//! (2) An estimator draws such paths. A walk of exponential flights from x_0 = 0 reaches x_n < S with the density
//! μ^n exp(−μ x_n): divided by it, a prefix of a walk scores w_1 … w_n exp(−μ(S − x_n)): next flight, one score for each
//! n. A walk that has just the points x_1 … x_n and then leaves has the density μ^n exp(−μS), and scores w_1 … w_n: ratio
//! tracking. (3) Shares that add up to 1 over all techniques that draw a path leave the sum (1): unbiased, whatever the
//! shares and however the techniques share their walks, by linearity. The balance heuristic (veach-1995) takes them
//! proportional to the densities: with d = S − x_n, 1/(1 + exp(−μd)) for next flight and exp(−μd)/(1 + exp(−μd)) for ratio
//! tracking.
//!
//! (4) From both ends: walks forward from 0 and, independently, backward from S. A prefix of s points of the one and of t
//! points of the other, the last of them at y < z, are a path of n = s + t points; its density is μ^n exp(−μ(S − (z − y))).
//! Each of the n + 1 gaps d_i between consecutive points (ends included) is one such technique, with a density
//! proportional to exp(μ d_i); either whole walk is one more, proportional to 1. Under the balance heuristic all score alike,
//!
//! > w_1 … w_n / (2 + Σ_i exp(μ d_i)).

use crate::estimator::bounded;
use crate::next_flight::of_variance;
use crate::{ClosedForm, SignedProduct, Theory, TransmittanceEstimator};
use fairflight_elementary::{exp, ln_1p};
use fairflight_media::{Majorant, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use smallvec::SmallVec;

/// Next flight and ratio tracking over one walk, shares by the balance heuristic (georgiev-2019).
///
/// **Law.** Unbiased by (1) to (3) of this file. No majorant was used: σ_t of any sign and above μ > 0 is admitted, at the
/// cost of variance.
///
/// **Variance.** (5) As for [`NextFlight`](crate::NextFlight), but what a gap contributes depends on where it began. With
/// b_x = e_x/(1 + e_x), e_x = exp(−μ(S − x)), the score at x is W b_x, and the same again if the walk leaves from there.
/// Behind a collision at x, what is still to come without another up to y is W (T(y, S) − e_y + e_y b_x); a collision at y
/// makes it W w T(y, S): a jump of W T(y, S) (h − b_x exp(−g)), h = exp(−g) − σ_t/μ, g(y) = ∫_y^S (μ − σ_t). (6) Squared, and
/// averaged over x, the last collision before y (0 if none), with E\[W²\]/T(0, x)² = exp(A(x)), A = ∫ σ_t²/μ:
///
/// > Var/T² = ∫_0^S μ (exp(A) h² − 2 p_1 h exp(−g) + p_2 exp(−2g)) dy,
/// > p_k(y) = exp(2τ(0, y) − μy) (b_0^k + ∫_0^y μ w² exp(A(x) + μx − 2τ(0, x)) b_x^k dx).
///
/// In a vacuum behind a thick majorant this is 1 − ln 2 = 0.307, where next flight has 1/2 and ratio tracking nothing: the
/// heuristic knows densities, not weights. Higher moments have no closed form here; estimates are not bounded.
///
/// **Cost.** μS look-ups, a Poisson number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unidirectional;

impl<F: Majorant> TransmittanceEstimator<F> for Unidirectional {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let Some((majorant, length)) = bounded(field) else { return 1.0 };
        let mut weight = SignedProduct::ONE;
        let mut sum = 0.0;
        let mut s = 0.0;
        loop {
            let straight = -majorant * (length - s);
            let score = weight.times_exp(straight) / (1.0 + exp(straight));
            sum += score;
            s += source.next_exponential() / majorant;
            if s >= length {
                return sum + score;
            }
            weight.multiply(1.0 - field.sigma_t(s) / majorant);
        }
    }

    #[inline]
    fn admits(&self, field: &F, _s: f64, sigma_t: f64) -> bool {
        field.majorant() > 0.0 || sigma_t == 0.0
    }
}

impl<F: Majorant> ClosedForm<F> for Unidirectional {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        let Some((majorant, length)) = bounded(quadrature.field()) else {
            return of_variance(0.0, 0.0, 0.0, 0.0);
        };
        let grown = quadrature.cumulative(tolerance, |_, sigma_t| [sigma_t, sigma_t * sigma_t / majorant]);
        let b = |x: f64| 1.0 / (1.0 + exp(majorant * (length - x)));
        // In units of exp(A(S)), and the exponents of p_k in those of their end.
        let [thickness, total] = grown.at(length);
        let end = majorant * length - 2.0 * thickness;
        let variance = quadrature.integrate_nested(
            tolerance,
            |x, sigma_t| {
                let [before, a] = grown.at(x);
                let w = 1.0 - sigma_t / majorant;
                let density = majorant * w * w * exp(a - total + majorant * x - 2.0 * before - end);
                [density * b(x), density * b(x) * b(x)]
            },
            |y, sigma_t, inner| {
                let [before, a] = grown.at(y);
                let straight = exp(tau - before - majorant * (length - y));
                let h = straight - sigma_t / majorant;
                let square = exp(a - total) * h * h;
                let scale = exp(end - (majorant * y - 2.0 * before));
                if scale > 1e280 {
                    return [majorant * square]; // p_k ≤ exp(A) b_y^k: far below rounding
                }
                let first = exp(2.0 * before - majorant * y - total);
                let p = |k: usize| first * b(0.0).powi(k as i32) + scale * inner[k - 1];
                [majorant * (square - 2.0 * p(1) * h * straight + p(2) * straight * straight)]
            },
        );
        of_variance(total, variance.value[0], variance.error[0], majorant * length)
    }
}

/// All connections of a walk from either end, shares by the balance heuristic (georgiev-2019).
///
/// **Law.** Unbiased by (1) to (4) of this file, for σ_t of any sign and above μ > 0.
///
/// **Variance.** No closed form. Scores are not bounded: the number of connections is not.
///
/// **Cost.** 2μS look-ups, a Poisson number: both walks are drawn whole. About (μS)²/2 connections are added up, at one
/// exponential each; the backward walk is kept in place up to 128 points and allocates beyond.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bidirectional;

/// A point of a walk.
#[derive(Clone, Copy, Debug)]
struct Point {
    s: f64,
    /// The product of 1 − σ_t/μ over the walk up to here.
    weight: SignedProduct,
    /// Σ exp(μ d) over the gaps d up to here.
    gaps: f64,
}

impl Point {
    fn at(s: f64) -> Self {
        Self { s, weight: SignedProduct::ONE, gaps: 0.0 }
    }

    /// Goes on by a flight of the optical distance `depth` in the direction `sign`.
    #[inline]
    fn next<F: Majorant>(self, field: &F, depth: f64, sign: f64) -> Option<Self> {
        let s = self.s + sign * depth / field.majorant();
        (0.0 < s && s < field.length()).then(|| {
            let mut weight = self.weight;
            weight.multiply(1.0 - field.sigma_t(s) / field.majorant());
            Self { s, weight, gaps: self.gaps + exp(depth) }
        })
    }

    /// The score of a walk that ends here, the last gap being from here to `end`.
    #[inline]
    fn whole(self, end: f64, majorant: f64) -> f64 {
        score(self.weight, self.gaps, majorant * (end - self.s).abs())
    }
}

/// weight/(2 + gaps + exp(μ d)), where `depth` = μ d may be beyond the exponential of a number.
#[inline]
fn score(weight: SignedProduct, gaps: f64, depth: f64) -> f64 {
    if depth < 700.0 {
        return weight.over(&SignedProduct::of(2.0 + (gaps + exp(depth))));
    }
    weight.times_exp(-depth - ln_1p((2.0 + gaps) * exp(-depth)))
}

impl<F: Majorant> TransmittanceEstimator<F> for Bidirectional {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let Some((majorant, length)) = bounded(field) else { return 1.0 };
        let mut backward: SmallVec<[Point; 128]> = SmallVec::new();
        let mut point = Point::at(length);
        backward.push(point);
        while let Some(next) = point.next(field, source.next_exponential(), -1.0) {
            point = next;
            backward.push(point);
        }
        let mut sum = point.whole(0.0, majorant);
        point = Point::at(0.0);
        loop {
            // Connections with all backward points that lie beyond.
            for other in backward.iter().take_while(|other| other.s > point.s) {
                let weight = point.weight.times(&other.weight);
                sum += score(weight, point.gaps + other.gaps, majorant * (other.s - point.s));
            }
            match point.next(field, source.next_exponential(), 1.0) {
                Some(next) => point = next,
                None => return sum + point.whole(length, majorant),
            }
        }
    }

    #[inline]
    fn admits(&self, field: &F, _s: f64, sigma_t: f64) -> bool {
        field.majorant() > 0.0 || sigma_t == 0.0
    }
}

impl<F: Majorant> ClosedForm<F> for Bidirectional {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, _tau: f64, _tolerance: Tolerance) -> Theory {
        Theory::mean_only(2.0 * quadrature.field().majorant().max(0.0) * quadrature.field().length())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{agrees, seed_ray, theory_of, variate};
    use approx::assert_relative_eq;
    use fairflight_media::{Bounded, Constant, PiecewiseConstant};
    use fairflight_sources::{Scripted, Seeded};

    #[test]
    fn one_walk_by_hand() {
        let field = Bounded::new(PiecewiseConstant::new(vec![0.0, 1.0, 3.0], vec![0.5, -0.4]).unwrap(), 2.0);
        // Collisions at 0.5 and 2, then beyond 3.
        let mut source = Scripted::new([1.0, 3.0, 2.1].map(variate));
        let share = |d: f64| 1.0 / (1.0 + (-2.0 * d).exp());
        let exact = (-6.0_f64).exp() * share(3.0)
            + 0.75 * (-5.0_f64).exp() * share(2.5)
            + 0.9 * ((-2.0_f64).exp() * share(1.0) + (1.0 - share(1.0)));
        assert_relative_eq!(
            Unidirectional.estimate(&field.unwrap(), &mut source),
            exact,
            max_relative = 1e-12
        );
        assert_eq!(source.remaining(), 0);
    }

    #[test]
    fn two_walks_by_hand() {
        let field = PiecewiseConstant::new(vec![0.0, 1.0, 3.0], vec![0.5, -0.4]).unwrap();
        let field = Bounded::new(field, 1.0).unwrap();
        // Backward: a point at 2.25 (weight 1.4), then out; forward: a point at 0.5 (weight 0.5), then out.
        let mut source = Scripted::new([0.75, 2.4, 0.5, 2.6].map(variate));
        let path = |weight: f64, gaps: &[f64]| weight / (2.0 + gaps.iter().map(|d| d.exp()).sum::<f64>());
        let exact = path(1.0, &[3.0])
            + 2.0 * path(1.4, &[2.25, 0.75])
            + 2.0 * path(0.5, &[0.5, 2.5])
            + path(0.7, &[0.5, 1.75, 0.75]);
        assert_relative_eq!(Bidirectional.estimate(&field, &mut source), exact, max_relative = 1e-12);
        assert_eq!(source.remaining(), 0);
        // A backward point before the forward one is not connected with it: it would be no path.
        let mut source = Scripted::new([2.75, 0.5, 0.5, 2.6].map(variate));
        let exact = path(1.0, &[3.0]) + 2.0 * path(0.5, &[0.25, 2.75]) + 2.0 * path(0.5, &[0.5, 2.5]);
        assert_relative_eq!(Bidirectional.estimate(&field, &mut source), exact, max_relative = 1e-12);
    }

    #[test]
    fn scores_of_long_walks_are_what_logarithms_say() {
        // exp(900) over exp(1000) and gaps that do not show.
        let weight = SignedProduct::exp(900.0);
        assert_relative_eq!(score(weight, 50.0, 1000.0), (-100.0_f64).exp(), max_relative = 1e-12);
        // On both sides of the border, where the gaps show.
        let at = |depth: f64| score(SignedProduct::exp(650.0), depth.exp(), depth);
        assert_relative_eq!(at(699.9), (-49.9_f64).exp() / 2.0, max_relative = 1e-12);
        assert_relative_eq!(at(700.1), (-50.1_f64).exp() / 2.0, max_relative = 1e-12);
    }

    #[test]
    fn shares_add_up_to_one_for_every_path() {
        // The densities of (4), gap by gap, over those of the heuristic.
        let gaps = [0.3_f64, 1.1, 0.05, 2.0];
        let (majorant, sum) = (1.3, gaps.iter().map(|d| (1.3 * d).exp()).sum::<f64>());
        let shares: f64 = gaps.iter().map(|d| (majorant * d).exp() / (2.0 + sum)).sum();
        assert_relative_eq!(shares + 2.0 / (2.0 + sum), 1.0, max_relative = 1e-14);
    }

    #[test]
    fn laws_of_both() {
        let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 2.5], vec![0.8, 0.1, 1.0]).unwrap();
        agrees(&field, &Unidirectional, 200_000, &mut Seeded::new(21));
        agrees(&field, &Bidirectional, 100_000, &mut Seeded::new(22));
        let signed = PiecewiseConstant::new(vec![0.0, 0.5, 1.5], vec![1.5, -0.4]).unwrap();
        let field = Bounded::new(signed, 1.0).unwrap();
        agrees(&field, &Unidirectional, 200_000, &mut Seeded::new(23));
        agrees(&field, &Bidirectional, 100_000, &mut Seeded::new(24));
        let vacuum = Bounded::new(Constant::new(0.0, 2.0).unwrap(), 1.0).unwrap();
        agrees(&vacuum, &Unidirectional, 100_000, &mut Seeded::new(25));
        agrees(&vacuum, &Bidirectional, 100_000, &mut Seeded::new(26));
    }

    #[test]
    fn the_closed_form_in_a_vacuum_behind_a_thick_majorant() {
        // At the optical distance u from the end, the last collision is at u + t: ∫ exp(−2u) ∫ exp(−t) (1 + exp(−u − t))^−2
        // = ∫_0^1 z/(1 + z) dz. Between its two steps p_k holds exp(1500), of which nothing shows.
        let field = Bounded::new(Constant::new(0.0, 3.0).unwrap(), 500.0).unwrap();
        let exact = 1.0 - std::f64::consts::LN_2;
        let variance = theory_of(field, &Unidirectional).relative_central[0];
        assert_relative_eq!(variance, exact, max_relative = 1e-9);
    }

    #[test]
    fn the_seed_ray_lies_between_its_two_techniques() {
        let theory = theory_of(seed_ray(), &Unidirectional);
        assert_relative_eq!(theory.relative_central[0], 7.637, max_relative = 1e-3);
    }
}
