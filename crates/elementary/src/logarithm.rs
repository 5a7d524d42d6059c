//! The natural logarithm.

use crate::parts::{BIAS, EXPONENT, EXPONENT_BITS, LN_2, exponent, two_sum};
use crate::table_of_logarithms::{ENTRIES, ENTRY_BITS, TABLE};

/// Bits of the least mantissa, 0.6875: those of an argument less these are its exponent and its interval.
const LEAST: u64 = 0x3FE6_0000_0000_0000;

/// An argument x = 2^k m, m in \[0.6875, 1.375), with its interval.
///
/// With c a number of 12 bits close to 1/m over the whole interval, and r = c m − 1, |r| ≤ 2^−7,
///
/// > ln x = k ln 2 − ln c + ln(1 + r),   ln(1 + r) = r − r²/2 + r³/3 − … − r⁸/8
///
/// of which the next term is below 2^−59 of r. m is parted into 26 and 27 bits, whose products with c are exact; k ln 2 − ln c is the sum of a part that is
/// exact and one that is small. Next to 1 c is 1, so that ln x = ln(1 + r) there and nothing cancels.
#[derive(Clone, Copy)]
struct Parted {
    /// The bits of x less those of [`LEAST`], with the bias of exponents.
    moved: u64,
    mantissa: u64,
}

impl Parted {
    #[inline(always)]
    fn of(x: f64) -> Self {
        let one = BIAS << EXPONENT_BITS;
        let moved = x.to_bits().wrapping_sub(LEAST).wrapping_add(one);
        Self { moved, mantissa: x.to_bits().wrapping_sub((moved & EXPONENT).wrapping_sub(one)) }
    }

    /// c, and −ln c in two parts.
    #[inline(always)]
    fn entry(self) -> [f64; 3] {
        TABLE[(self.moved >> (EXPONENT_BITS - ENTRY_BITS)) as usize & (ENTRIES - 1)]
    }

    /// ln x + `correction`, where k is less by `lifted`.
    #[inline(always)]
    fn ln(self, [c, ln_high, ln_low]: [f64; 3], (lifted, correction): (f64, f64)) -> f64 {
        const LOW_BITS: u64 = (1 << 27) - 1;
        let m = f64::from_bits(self.mantissa);
        let high = f64::from_bits(self.mantissa & !LOW_BITS);
        let r = (high * c - 1.0) + (m - high) * c;
        let k = exponent(self.moved) - lifted;
        let whole = k * LN_2[0] + ln_high;
        let sum = whole + r;
        // 0, or more than r: what rounding took off is a difference.
        let lost = (whole - sum) + r;
        let square = r * r;
        let series = (-1.0 / 2.0 + r * (1.0 / 3.0))
            + square
                * ((-1.0 / 4.0 + r * (1.0 / 5.0))
                    + square * ((-1.0 / 6.0 + r * (1.0 / 7.0)) + square * (-1.0 / 8.0)));
        sum + (((k * LN_2[1] + ln_low) + (lost + correction)) + square * series)
    }
}

/// ln x of normal numbers above 0.
#[inline(always)]
pub(crate) fn near(x: f64) -> f64 {
    let parted = Parted::of(x);
    parted.ln(parted.entry(), (0.0, 0.0))
}

/// The same in all lanes.
#[inline(always)]
pub(crate) fn near_lanes<const N: usize>(x: &[f64; N]) -> [f64; N] {
    corrected_lanes(x, &[0.0; N])
}

/// ln x + a correction in all lanes. The table is read in a loop of its own, since few instruction sets read several places at once.
#[inline(always)]
fn corrected_lanes<const N: usize>(x: &[f64; N], corrections: &[f64; N]) -> [f64; N] {
    let (mut c, mut ln_high, mut ln_low) = ([0.0; N], [0.0; N], [0.0; N]);
    for i in 0..N {
        let entry = Parted::of(x[i]).entry();
        (c[i], ln_high[i], ln_low[i]) = (entry[0], entry[1], entry[2]);
    }
    let mut values = [0.0; N];
    for i in 0..N {
        values[i] = Parted::of(x[i]).ln([c[i], ln_high[i], ln_low[i]], (0.0, corrections[i]));
    }
    values
}

#[inline(always)]
pub(crate) fn is_near(x: f64) -> bool {
    (f64::MIN_POSITIVE..f64::INFINITY).contains(&x)
}

/// ln x of all other numbers: −∞ of 0, and no number of those below.
#[cold]
#[inline(never)]
pub(crate) fn far(x: f64) -> f64 {
    /// 2^54, by which denormalised numbers become normal.
    const LIFT: f64 = 18_014_398_509_481_984.0;
    if x == 0.0 {
        f64::NEG_INFINITY
    } else if x < 0.0 || x.is_nan() {
        f64::NAN
    } else if x == f64::INFINITY {
        x
    } else {
        let parted = Parted::of(x * LIFT);
        parted.ln(parted.entry(), (54.0, 0.0))
    }
}

/// ln(1 + x) for finite x above −1, but for 0.
///
/// The sum u = 1 + x is rounded by e: ln(1 + x) = ln u + e/u up to (e/u)².
#[inline(always)]
pub(crate) fn near_1p(x: f64) -> f64 {
    let (u, e) = two_sum(1.0, x);
    let parted = Parted::of(u);
    parted.ln(parted.entry(), (0.0, e / u))
}

/// The same in all lanes.
#[inline(always)]
pub(crate) fn near_1p_lanes<const N: usize>(x: &[f64; N]) -> [f64; N] {
    let (mut sums, mut corrections) = ([0.0; N], [0.0; N]);
    for lane in 0..N {
        let (u, e) = two_sum(1.0, x[lane]);
        (sums[lane], corrections[lane]) = (u, e / u);
    }
    corrected_lanes(&sums, &corrections)
}

#[inline(always)]
pub(crate) fn is_near_1p(x: f64) -> bool {
    (x > -1.0) & (x < f64::INFINITY) & (x != 0.0)
}

/// ln(1 + x) of all other numbers: 0 with its sign, −∞ of −1, and no number of those below.
#[cold]
#[inline(never)]
pub(crate) fn far_1p(x: f64) -> f64 {
    if x == 0.0 { x } else { far(1.0 + x) }
}
