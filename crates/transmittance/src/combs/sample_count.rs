//! How many teeth a comb should have (kettunen-2021).

use super::Roulette;
use fairflight_elementary::cbrt;

/// The expected order of a Bhanot–Kennedy roulette (bhanot-1985): stopped at once with probability
/// `stop_probability`, else `sure` orders, then on to order k with probability c/k:
///
/// > (1 − p_Z) (K + Σ_{i>K} c^{i−K} K!/i!) = (1 − p_Z) (K + (e^c − Σ_{i≤K} c^i/i!) K!/c^K).
///
/// The first form is summed: the second cancels. It is 0.31945 for p_Z = 0.9, K = c = 2.
#[must_use]
pub fn expected_order(stop_probability: f64, sure: u32, c: f64) -> f64 {
    debug_assert!((0.0..=1.0).contains(&stop_probability), "a probability: {stop_probability}");
    debug_assert!(c >= 0.0 && c <= f64::from(sure) + 1.0, "continuing with c/k needs c <= K + 1: {c}");
    let (mut beyond, mut reached) = (0.0, 1.0);
    for k in u64::from(sure) + 1.. {
        reached *= c / k as f64;
        beyond += reached;
        if reached < 1e-18 {
            break;
        }
    }
    (1.0 - stop_probability) * (f64::from(sure) + beyond)
}

/// The teeth of one comb for a control of this optical thickness (that of a majorant, say), with the roulette of
/// kettunen-2021:
///
/// > M = max(1, ⌊N_CMF/(1 + 0.31945) + 1/2⌋), N_CMF = ⌈((0.015 + t) (0.65 + t) (60.3 + t))^{1/3}⌉,
///
/// so that M times the expected number of combs, 1.31945, is what the power series of georgiev-2019 (its cumulative
/// mass function reached to 99 %) would have looked up. The division is missing where the rule is quoted without its
/// code. Unbiasedness needs no particular M.
#[must_use]
pub fn teeth_for(optical_thickness: f64) -> u32 {
    let t = optical_thickness;
    debug_assert!(t >= 0.0, "a control's optical thickness is not negative: {t}");
    let series = cbrt((0.015 + t) * (0.65 + t) * (60.3 + t)).ceil();
    let combs = 1.0 + Roulette::KETTUNEN.expected_order();
    // Saturates.
    ((series / combs + 0.5).floor() as u32).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_expected_order_is_that_of_the_closed_form() {
        let e = std::f64::consts::E;
        assert_relative_eq!(expected_order(0.9, 2, 2.0), 0.319_452_8, max_relative = 1e-7);
        assert_relative_eq!(expected_order(0.9, 2, 2.0), 0.1 * (2.0 + 0.5 * (e * e - 5.0)));
        assert_relative_eq!(
            expected_order(0.0, 1, 1.5),
            1.0 + (1.5_f64.exp() - 2.5) / 1.5,
            max_relative = 1e-14
        );
        assert_eq!(expected_order(1.0, 2, 2.0), 0.0);
        assert_eq!(expected_order(0.5, 3, 0.0), 1.5);
    }

    #[test]
    fn teeth_of_known_thicknesses() {
        // The seed ray's own thickness and that of its majorant.
        assert_eq!([0.0, 3.41568, 20.0].map(teeth_for), [1, 8, 25]);
        assert_eq!(teeth_for(1e300), u32::MAX);
    }
}
