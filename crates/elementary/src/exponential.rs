//! The exponential.

use crate::parts::{LN_2, each, nearest, polynomial, power_of_two, two_sum};
use crate::table_of_powers::{ENTRIES, ENTRY_BITS, TABLE};
use std::f64::consts::LOG2_E;

/// ln 2/128 in two parts, of which the first has 33 bits: its product with a number of at most 20 bits is exact.
const STEP: [f64; 2] = [LN_2[0] / ENTRIES as f64, LN_2[1] / ENTRIES as f64];
/// 128/ln 2.
const STEPS: f64 = LOG2_E * ENTRIES as f64;

/// Coefficients of 6/r (1/(e^r − 1) − 1/r + 1/2) · 2 by r²/2, of fdlibm's `s_expm1.c`, in error by less than 2^−61.
const RATIO_M1: [f64; 6] = [
    1.0,
    -3.333_333_333_333_313_164_28e-2,
    1.587_301_587_254_814_601_65e-3,
    -7.936_507_578_674_879_424_73e-5,
    4.008_217_827_329_362_395_52e-6,
    -2.010_992_181_836_243_713_26e-7,
];

/// x = n ln 2/128 + r, n = 128 k + i, |r| ≤ ln 2/256: then e^x = 2^k 2^(i/128) e^r.
///
/// The table has 2^(i/128) = t + l to twice the digits; e^x = 2^k (t + (l + t (e^r − 1))) is rounded once up to |r|/2 and r⁶/720, 0.506 ulp.
#[derive(Clone, Copy)]
struct Parted {
    n: f64,
    bits: u64,
    r: f64,
}

impl Parted {
    #[inline(always)]
    fn of(x: f64) -> Self {
        let (n, bits) = nearest(x * STEPS);
        Self { n, bits, r: (x - n * STEP[0]) - n * STEP[1] }
    }

    #[inline(always)]
    fn entry(self) -> [f64; 2] {
        TABLE[self.bits as usize % ENTRIES]
    }

    /// e^x/2^k, from 1 to 2.
    #[inline(always)]
    fn mantissa(self, [high, low]: [f64; 2]) -> f64 {
        let r = self.r;
        let rest = r + r * r * polynomial(r, [0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0]);
        high + (low + high * rest)
    }

    /// e^x where 2^k is a normal number.
    #[inline(always)]
    fn exp(self, entry: [f64; 2]) -> f64 {
        self.mantissa(entry) * power_of_two(self.bits >> ENTRY_BITS)
    }
}

/// e^x where 2^k is a normal number.
#[inline(always)]
pub(crate) fn near(x: f64) -> f64 {
    let parted = Parted::of(x);
    parted.exp(parted.entry())
}

/// The same in all lanes. The table is read in a loop of its own, as that of logarithms.
#[inline(always)]
pub(crate) fn near_lanes<const N: usize>(x: &[f64; N]) -> [f64; N] {
    let (mut high, mut low) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        [high[i], low[i]] = Parted::of(x[i]).entry();
    }
    let mut values = [0.0; N];
    for i in 0..N {
        values[i] = Parted::of(x[i]).exp([high[i], low[i]]);
    }
    values
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
    let parted = Parted::of(x.clamp(-746.0, 710.0));
    let k = (parted.n / ENTRIES as f64).floor();
    // In two factors, each of which is a normal number.
    let (half, bits) = nearest(0.5 * k);
    let (_, other) = nearest(k - half);
    parted.mantissa(parted.entry()) * power_of_two(bits) * power_of_two(other)
}

/// x = k ln 2 + r: k in the lowest bits of a word, and the parts of r = high − low.
#[inline(always)]
fn reduced(x: f64) -> (u64, [f64; 2]) {
    let (k, bits) = nearest(x * LOG2_E);
    (bits, [x - k * LN_2[0], k * LN_2[1]])
}

/// e^x − 1 where 1 is told from it; not of 0.
///
/// With x = k ln 2 + r and e^r − 1 = r − E, e^x − 1 = (2^k − 1) + 2^k r − 2^k E: the first two are summed without a loss, and E is at most r²/2 or so.
#[inline(always)]
pub(crate) fn near_m1(x: f64) -> f64 {
    let (bits, parts) = reduced(x);
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
    let (bits, parts) = reduced(x.clamp(-40.0, 710.0));
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
