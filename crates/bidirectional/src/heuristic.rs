//! How weights follow from logarithms of densities.

use fairflight_elementary::{exp, ln_1p};
use fairflight_paths::Heuristic;

/// A heuristic (veach-1995, antwerpen-2011 section 3.6) on logarithms, which do not underflow.
///
/// With b = 1 (balance), b = 2 (power) or b → ∞ (maximum) the weight of a strategy of density p is p^b/Σ p_j^b. Logarithms are
/// scaled once, by b; from then on sums of powers are [`add`](Self::add), whatever b is.
///
/// **Law.** The weights of all strategies of a path sum to 1.
pub trait LogHeuristic: Copy {
    /// ln d^b of ln d.
    fn scale(self, ln: f64) -> f64;

    /// ln(e^a + e^b); the greater one for the maximum.
    fn add(self, a: f64, b: f64) -> f64;

    /// The weight of a strategy, where the others have the sums `fewer` and `more` of scaled densities relative to its own: those
    /// with fewer vertices on the eye subpath, and those with more.
    fn weight(self, fewer: f64, more: f64) -> f64;
}

/// Logarithms of equal densities differ by rounding: 1e3 roundings of sums of the size 1e3, with room. Of two that are nearer the
/// maximum takes the one with fewer vertices on the eye subpath. Densities of paths at random are as near with a probability of
/// that size.
const TIE: f64 = 1e-9;

impl LogHeuristic for Heuristic {
    #[inline]
    fn scale(self, ln: f64) -> f64 {
        match self {
            Self::Power => 2.0 * ln,
            Self::Balance | Self::Maximum => ln,
        }
    }

    #[inline]
    fn add(self, a: f64, b: f64) -> f64 {
        let (least, most) = if a < b { (a, b) } else { (b, a) };
        if self == Self::Maximum || least == f64::NEG_INFINITY {
            most
        } else {
            most + ln_1p(exp(least - most))
        }
    }

    #[inline]
    fn weight(self, fewer: f64, more: f64) -> f64 {
        match self {
            Self::Maximum => f64::from(u8::from(fewer < -TIE && more <= TIE)),
            Self::Balance | Self::Power => 1.0 / (1.0 + exp(fewer) + exp(more)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Heuristic; 3] = [Heuristic::Balance, Heuristic::Power, Heuristic::Maximum];

    #[test]
    fn a_pair_in_logarithms_is_the_pair_itself() {
        for heuristic in ALL {
            for (own, other) in [(1.0f64, 3.0f64), (2.0, 0.5), (1e-150, 1e-152)] {
                let ratio = heuristic.scale(other.ln() - own.ln());
                for weight in
                    [heuristic.weight(ratio, f64::NEG_INFINITY), heuristic.weight(f64::NEG_INFINITY, ratio)]
                {
                    assert!((weight - heuristic.mis_weight(own, other)).abs() < 1e-13, "{heuristic:?}");
                }
            }
        }
    }

    #[test]
    fn sums_of_logarithms_know_zero_and_do_not_underflow() {
        for heuristic in ALL {
            assert_eq!(heuristic.add(f64::NEG_INFINITY, f64::NEG_INFINITY), f64::NEG_INFINITY);
            assert_eq!(heuristic.add(-3.0, f64::NEG_INFINITY), -3.0);
            assert_eq!(heuristic.weight(f64::NEG_INFINITY, f64::NEG_INFINITY), 1.0);
        }
        let sum = Heuristic::Balance.add(-2000.0, -2000.0);
        assert!((sum - (2f64.ln() - 2000.0)).abs() < 1e-12);
        assert_eq!(Heuristic::Maximum.add(-2000.0, -1999.0), -1999.0);
    }

    #[test]
    fn of_equal_ones_the_maximum_takes_the_one_with_fewer_eye_vertices() {
        for rounding in [-1e-13, 0.0, 1e-13] {
            // Two strategies; seen from the first the other has more eye vertices, from the second fewer.
            assert_eq!(Heuristic::Maximum.weight(f64::NEG_INFINITY, rounding), 1.0);
            assert_eq!(Heuristic::Maximum.weight(-rounding, f64::NEG_INFINITY), 0.0);
        }
    }
}
