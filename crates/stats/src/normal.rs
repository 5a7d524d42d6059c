//! Tail probabilities and quantiles of the standard normal law, accurate far into the tails.
//!
//! The relative error of the complementary error function of statrs 0.19 is 1e-10 almost everywhere (some of its
//! constants have single precision), in the tail as in the middle: nothing to a p-value. Its inverse is accurate to 1e-14.

use statrs::function::erf::{erfc, erfc_inv};
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

/// P(|Z| > |z|) = erfc(|z|/sqrt(2)): the two-sided p-value of a z-score. 1 at z = 0, NaN for NaN.
///
/// Relative error about 1e-10 up to |z| = 37, beyond which the probability leaves the range of f64.
#[must_use]
pub fn two_sided_tail(z: f64) -> f64 {
    erfc(z.abs() * FRAC_1_SQRT_2)
}

/// Q(z) = P(Z > z), the upper tail, as accurate as [`two_sided_tail`].
#[must_use]
pub fn upper_tail(z: f64) -> f64 {
    0.5 * erfc(z * FRAC_1_SQRT_2)
}

/// The z >= 0 with P(|Z| > z) = probability, for a probability in [0, 1]; infinite for zero.
#[must_use]
pub fn two_sided_quantile(probability: f64) -> f64 {
    debug_assert!((0.0..=1.0).contains(&probability), "a probability lies in [0, 1], found {probability}");
    SQRT_2 * erfc_inv(probability)
}

/// The z with P(Z > z) = probability, for a probability in [0, 1]; infinite for zero and one.
#[must_use]
pub fn upper_quantile(probability: f64) -> f64 {
    debug_assert!((0.0..=1.0).contains(&probability), "a probability lies in [0, 1], found {probability}");
    SQRT_2 * erfc_inv(2.0 * probability)
}

#[cfg(test)]
mod tests {
    use super::{two_sided_quantile, two_sided_tail, upper_quantile, upper_tail};
    use approx::assert_relative_eq;

    // Both tables: mpmath 1.3 with 40 digits.
    const TAILS: [(f64, f64); 15] = [
        (0.1, 0.920_344_325_445_942),
        (0.5, 0.617_075_077_451_973_8),
        (1.0, 0.317_310_507_862_914_1),
        (1.5, 0.133_614_402_537_716_12),
        (2.0, 0.045_500_263_896_358_42),
        (3.0, 0.002_699_796_063_260_189),
        (4.0, 6.334_248_366_623_984e-5),
        (5.0, 5.733_031_437_583_878e-7),
        (6.0, 1.973_175_290_075_396e-9),
        (8.0, 1.244_192_114_854_356_8e-15),
        (10.0, 1.523_970_604_832_105e-23),
        (15.0, 7.341_932_398_625_502e-51),
        (20.0, 5.507_248_237_212_467e-89),
        (30.0, 9.813_427_854_296_374e-198),
        (37.0, 1.145_114_244_504_915_4e-299),
    ];
    const QUANTILES: [(f64, f64); 13] = [
        (0.5, 0.674_489_750_196_081_7),
        (0.3, 1.036_433_389_493_789_6),
        (0.1, 1.644_853_626_951_472_7),
        (0.01, 2.575_829_303_548_901),
        (1e-3, 3.290_526_731_491_895),
        (1e-6, 4.891_638_475_698_59),
        (1.25e-7, 5.286_029_126_116_257),
        (1e-9, 6.109_410_204_869_397),
        (1e-12, 7.130_506_848_171_324),
        (1e-15, 8.026_858_882_534_54),
        (1e-30, 11.523_883_577_380_25),
        (1e-100, 21.305_940_069_351_53),
        (1e-300, 37.065_787_880_772_13),
    ];

    #[test]
    fn tails_are_accurate_out_to_z_of_37() {
        for (z, expected) in TAILS {
            assert_relative_eq!(two_sided_tail(z), expected, max_relative = 1.2e-10);
            assert_relative_eq!(two_sided_tail(-z), expected, max_relative = 1.2e-10);
            assert_relative_eq!(upper_tail(z), 0.5 * expected, max_relative = 1.2e-10);
            assert_relative_eq!(upper_tail(-z), 1.0 - 0.5 * expected, max_relative = 1e-10);
        }
        assert_eq!((two_sided_tail(0.0), two_sided_tail(f64::INFINITY)), (1.0, 0.0));
        assert!(two_sided_tail(f64::NAN).is_nan());
    }

    #[test]
    fn quantiles_are_accurate_down_to_1e_minus_300() {
        for (probability, z) in QUANTILES {
            assert_relative_eq!(two_sided_quantile(probability), z, max_relative = 1e-14);
            assert_relative_eq!(upper_quantile(0.5 * probability), z, max_relative = 1e-14);
        }
        assert_eq!((two_sided_quantile(1.0), two_sided_quantile(0.0)), (0.0, f64::INFINITY));
        assert_relative_eq!(upper_quantile(0.99), -upper_quantile(0.01), max_relative = 1e-13);
    }
}
