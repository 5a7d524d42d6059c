//! The exponential.

use crate::parts::{LN_2, each, nearest, polynomial, power_of_two, two_sum};
use std::f64::consts::LOG2_E;

/// Coefficients of P = (2 − r (e^r + 1)/(e^r − 1))/r² + …, an even function of r, for |r| ≤ ln 2/2: the minimax polynomial of fdlibm's `e_exp.c` (Sun
/// Microsystems 1993), in error by less than 2^−59.
const RATIO: [f64; 5] = [
    1.666_666_666_666_660_190_37e-1,
    -2.777_777_777_701_559_338_42e-3,
    6.613_756_321_437_934_361_17e-5,
    -1.653_390_220_546_525_153_90e-6,
    4.138_136_797_057_238_460_39e-8,
];

/// Coefficients of 6/r (1/(e^r − 1) − 1/r + 1/2) · 2 by r²/2, of fdlibm's `s_expm1.c`, in error by less than 2^−61.
const RATIO_M1: [f64; 6] = [
    1.0,
    -3.333_333_333_333_313_164_28e-2,
    1.587_301_587_254_814_601_65e-3,
    -7.936_507_578_674_879_424_73e-5,
    4.008_217_827_329_362_395_52e-6,
    -2.010_992_181_836_243_713_26e-7,
];

/// x = k ln 2 + r: k, the same in the lowest bits of a word, and the parts of r = high − low.
#[inline(always)]
fn reduced(x: f64) -> (f64, u64, [f64; 2]) {
    let (k, bits) = nearest(x * LOG2_E);
    (k, bits, [x - k * LN_2[0], k * LN_2[1]])
}

/// e^r: with c = r − r² P(r²), e^r = 1 + r + r c/(2 − c).
#[inline(always)]
fn of_rest([high, low]: [f64; 2]) -> f64 {
    let r = high - low;
    let square = r * r;
    let c = r - square * polynomial(square, RATIO);
    1.0 - ((low - r * c / (2.0 - c)) - high)
}

/// e^x where 2^k is a normal number.
#[inline(always)]
pub(crate) fn near(x: f64) -> f64 {
    let (_, bits, rest) = reduced(x);
    of_rest(rest) * power_of_two(bits)
}

/// The same in all lanes.
#[inline(always)]
pub(crate) fn near_lanes<const N: usize>(x: &[f64; N]) -> [f64; N] {
    each(x, near)
}

#[inline(always)]
pub(crate) fn is_near(x: f64) -> bool {
    x.abs() < 708.0
}

/// e^x of all other numbers: 0 below −745.2, ∞ above 709.8.
#[cold]
#[inline(never)]
pub(crate) fn far(x: f64) -> f64 {
    if x.is_nan() {
        return x;
    }
    let (k, _, rest) = reduced(x.clamp(-746.0, 710.0));
    // In two factors, each of which is a normal number.
    let (half, bits) = nearest(0.5 * k);
    let (_, other) = nearest(k - half);
    of_rest(rest) * power_of_two(bits) * power_of_two(other)
}

/// e^x − 1 where 1 is told from it; not of 0.
///
/// With x = k ln 2 + r and e^r − 1 = r − E, e^x − 1 = (2^k − 1) + 2^k r − 2^k E: the first two are summed without a loss, and E is at most r²/2 or so.
#[inline(always)]
pub(crate) fn near_m1(x: f64) -> f64 {
    let (_, bits, parts) = reduced(x);
    let (r, lost) = rest_m1(parts);
    let scale = power_of_two(bits);
    let (sum, rounded) = two_sum(scale - 1.0, scale * r);
    sum + (rounded - scale * lost)
}

/// The same in all lanes.
#[inline(always)]
pub(crate) fn near_m1_lanes<const N: usize>(x: &[f64; N]) -> [f64; N] {
    each(x, near_m1)
}

#[inline(always)]
pub(crate) fn is_near_m1(x: f64) -> bool {
    (x.abs() < 37.0) & (x != 0.0)
}

/// e^x − 1 of all other numbers.
#[cold]
#[inline(never)]
pub(crate) fn far_m1(x: f64) -> f64 {
    if x == 0.0 || x.is_nan() {
        return x;
    }
    let (_, bits, parts) = reduced(x.clamp(-40.0, 710.0));
    let (r, lost) = rest_m1(parts);
    // In halves: 2^1024 is no number.
    let scale = power_of_two(bits.wrapping_sub(1));
    let (sum, rounded) = two_sum(scale - 0.5, scale * r);
    2.0 * (sum + (rounded - scale * lost))
}

/// r and E of e^r − 1 = r − E.
#[inline(always)]
fn rest_m1([high, low]: [f64; 2]) -> (f64, f64) {
    let r = high - low;
    let rounded = (high - r) - low;
    let half = 0.5 * r;
    let half_square = r * half;
    let ratio = polynomial(half_square, RATIO_M1);
    let t = 3.0 - ratio * half;
    let e = half_square * ((ratio - t) / (6.0 - r * t));
    (r, (r * (e - rounded) - rounded) - half_square)
}
