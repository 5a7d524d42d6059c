//! Parts of numbers, without a branch and without a conversion between integers and floating point, which few instruction sets have for 64 bits.

/// 1.5 · 2^52: added to a number of at most 2^51 it leaves the nearest integer in the lowest bits, ties to even.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// 2^52, whose lowest bits are an integer.
const WHOLE: f64 = 4_503_599_627_370_496.0;
const EXPONENT_BITS: u32 = 52;
const BIAS: u64 = 1023;
const EXPONENT: u64 = 0x7FF0_0000_0000_0000;

/// ln 2 in two parts, of which the first has 33 bits: its product with an exponent is exact.
pub(crate) const LN_2: [f64; 2] = [6.931_471_803_691_238_164_90e-1, 1.908_214_929_270_587_700_02e-10];

/// A number next to an integer, of at most 2^51: the integer, and the same in the lowest bits of a word.
#[inline(always)]
pub(crate) fn nearest(x: f64) -> (f64, u64) {
    let sum = x + ROUND;
    (sum - ROUND, sum.to_bits())
}

/// 2^k of an integer in the lowest bits of a word, −1022 ≤ k ≤ 1023.
#[inline(always)]
pub(crate) fn power_of_two(k: u64) -> f64 {
    f64::from_bits((k << EXPONENT_BITS).wrapping_add(BIAS << EXPONENT_BITS))
}

/// x = 2^k m with m in \[√½, √2), of a normal number above 0: k and m.
#[inline(always)]
pub(crate) fn exponent_and_mantissa(x: f64) -> (f64, f64) {
    /// The bits of 1 less those of √½: moves the border between exponents there.
    const TO_ROOT: u64 = 0x0009_5F61_9980_C433;
    let moved = x.to_bits().wrapping_add(TO_ROOT);
    let k = f64::from_bits((moved >> EXPONENT_BITS) | WHOLE.to_bits()) - (WHOLE + BIAS as f64);
    let mantissa = x.to_bits().wrapping_sub((moved & EXPONENT).wrapping_sub(BIAS << EXPONENT_BITS));
    (k, f64::from_bits(mantissa))
}

/// a + b and what rounding took off it (knuth-1969 4.2.2, theorem B).
#[inline(always)]
pub(crate) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// c_0 + x (c_1 + x (…)).
#[inline(always)]
pub(crate) fn polynomial<const N: usize>(x: f64, coefficients: [f64; N]) -> f64 {
    let mut sum = coefficients[N - 1];
    for &coefficient in coefficients[..N - 1].iter().rev() {
        sum = coefficient + x * sum;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_and_mantissas_of_either_side() {
        for (x, k, m) in [
            (1.0, 0.0, 1.0),
            (1.5, 1.0, 0.75),
            (0.7, -1.0, 1.4),
            (0.75, 0.0, 0.75),
            (f64::MAX, 1024.0, f64::MAX / 2.0_f64.powi(1023) / 2.0),
            (f64::MIN_POSITIVE, -1022.0, 1.0),
        ] {
            assert_eq!(exponent_and_mantissa(x), (k, m), "{x}");
        }
    }

    #[test]
    fn integers_and_powers() {
        assert_eq!(nearest(-2.5).0, -2.0);
        assert_eq!(nearest(1023.4).0, 1023.0);
        assert_eq!(power_of_two(nearest(-1022.0).1), f64::MIN_POSITIVE);
        assert_eq!(power_of_two(nearest(10.2).1), 1024.0);
    }

    #[test]
    fn sums_lose_nothing() {
        assert_eq!(two_sum(1.0, 1e-20), (1.0, 1e-20));
        assert_eq!(two_sum(1e-20, -1.0), (-1.0, 1e-20));
    }

    #[test]
    fn polynomials_by_hand() {
        assert_eq!(polynomial(2.0, [1.0, 10.0, 100.0]), 421.0);
    }
}
