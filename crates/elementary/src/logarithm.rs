//! The natural logarithm.

use crate::parts::{LN_2, exponent_and_mantissa, polynomial, two_sum};

/// Coefficients of R = (ln(1 + s) − ln(1 − s))/s − 2, an even function of s, for |s| ≤ (√2 − 1)/(√2 + 1): the minimax polynomial of fdlibm's
/// `e_log.c` (Sun Microsystems 1993), in error by less than 2^−58.45. Those of s², s⁶, …, and those of s⁴, s⁸, ….
const ODD: [f64; 4] = [
    6.666_666_666_666_735_130e-1,
    2.857_142_874_366_239_149e-1,
    1.818_357_216_161_805_012e-1,
    1.479_819_860_511_658_591e-1,
];
const EVEN: [f64; 3] =
    [3.999_999_999_940_941_908e-1, 2.222_219_843_214_978_396e-1, 1.531_383_769_920_937_332e-1];

/// ln x of normal numbers above 0.
///
/// With x = 2^k (1 + f), 1 + f in \[√½, √2), and s = f/(2 + f), so that 1 + f = (1 + s)/(1 − s):
///
/// > ln(1 + f) = 2s + s R(s²) = f − (f²/2 − s (f²/2 + R)),
///
/// of which f is exact and the rest small.
#[inline(always)]
pub(crate) fn near(x: f64) -> f64 {
    of_parts(exponent_and_mantissa(x), 0.0)
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
        let (k, mantissa) = exponent_and_mantissa(x * LIFT);
        of_parts((k - 54.0, mantissa), 0.0)
    }
}

/// ln(1 + x) for finite x above −1, but for 0.
///
/// The sum u = 1 + x is rounded by c: ln(1 + x) = ln u + c/u up to (c/u)².
#[inline(always)]
pub(crate) fn near_1p(x: f64) -> f64 {
    let (u, c) = two_sum(1.0, x);
    of_parts(exponent_and_mantissa(u), c / u)
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

/// ln(2^k m) + `correction`.
#[inline(always)]
fn of_parts((k, m): (f64, f64), correction: f64) -> f64 {
    let f = m - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let rest = z * polynomial(w, ODD) + w * polynomial(w, EVEN);
    let half = 0.5 * f * f;
    k * LN_2[0] - ((half - (s * (half + rest) + (k * LN_2[1] + correction))) - f)
}
