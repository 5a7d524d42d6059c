//! Parts of numbers, without a branch and without a conversion between integers and floating point, which few instruction sets have for 64 bits.

/// 1.5 · 2^52: added to a number of at most 2^51 it leaves the nearest integer in the lowest bits, ties to even.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// 2^52, whose lowest bits are an integer.
const WHOLE: f64 = 4_503_599_627_370_496.0;
pub(crate) const EXPONENT_BITS: u32 = 52;
pub(crate) const BIAS: u64 = 1023;
pub(crate) const EXPONENT: u64 = 0x7FF0_0000_0000_0000;

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

/// The exponent that the bits of a number above 0 begin with.
#[inline(always)]
pub(crate) fn exponent(bits: u64) -> f64 {
    f64::from_bits((bits >> EXPONENT_BITS) | WHOLE.to_bits()) - (WHOLE + BIAS as f64)
}

/// A function of each lane.
#[inline(always)]
pub(crate) fn each<const N: usize>(x: &[f64; N], function: impl Fn(f64) -> f64) -> [f64; N] {
    let mut values = [0.0; N];
    for (value, &x) in values.iter_mut().zip(x) {
        *value = function(x);
    }
    values
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
    fn exponents_of_numbers() {
        for (x, k) in [(1.0, 0.0), (1.9, 0.0), (0.7, -1.0), (f64::MAX, 1023.0), (f64::MIN_POSITIVE, -1022.0)]
        {
            assert_eq!(exponent(f64::to_bits(x)), k, "{x}");
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
