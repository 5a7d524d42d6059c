//! Sine and cosine.

use crate::parts::{nearest, polynomial};
use std::f64::consts::FRAC_2_PI;

/// π/2 in three parts, the first two of 33 bits: their products with a quadrant of at most 20 bits are exact.
const FRAC_PI_2: [f64; 3] =
    [1.570_796_326_734_125_614_17, 6.077_100_506_303_965_976_60e-11, 2.022_266_248_795_950_631_54e-21];

/// Arguments from here on have a quadrant of more bits: 2^20 π/2.
const FAR: f64 = 1_647_099.0;

/// Coefficients of (sin r/r − 1)/r² and (cos r − 1 + r²/2)/r⁴ by r², for |r| ≤ π/4: the minimax polynomials of fdlibm's `k_sin.c` and `k_cos.c`
/// (Sun Microsystems 1993), in error by less than 2^−58.
const SINE: [f64; 6] = [
    -1.666_666_666_666_663_243_48e-1,
    8.333_333_333_322_489_461_24e-3,
    -1.984_126_982_985_794_931_34e-4,
    2.755_731_370_707_006_767_89e-6,
    -2.505_076_025_340_686_341_95e-8,
    1.589_690_995_211_550_102_21e-10,
];
const COSINE: [f64; 6] = [
    4.166_666_666_666_660_190_37e-2,
    -1.388_888_888_887_410_957_49e-3,
    2.480_158_728_947_672_941_78e-5,
    -2.755_731_435_139_066_330_35e-7,
    2.087_572_321_298_174_827_90e-9,
    -1.135_964_755_778_819_482_65e-11,
];

/// (sin x, cos x) of arguments whose quadrant has more than 20 bits, and of those that are no numbers.
#[cold]
#[inline(never)]
pub(crate) fn far(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

#[inline(always)]
pub(crate) fn is_near(x: f64) -> bool {
    x.abs() < FAR
}

/// (sin x, cos x) of all others.
#[inline(always)]
pub(crate) fn near(x: f64) -> (f64, f64) {
    let (quadrant, bits) = nearest(x * FRAC_2_PI);
    // x − quadrant · π/2 in two parts, high and low.
    let first = x - quadrant * FRAC_PI_2[0];
    let second = quadrant * FRAC_PI_2[1];
    let difference = first - second;
    let third = quadrant * FRAC_PI_2[2] - ((first - difference) - second);
    let high = difference - third;
    let low = (difference - high) - third;
    let square = high * high;
    let cube = square * high;
    let [first, rest @ ..] = SINE;
    let sine = high - ((square * (0.5 * low - cube * polynomial(square, rest)) - low) - cube * first);
    let half = 0.5 * square;
    let one = 1.0 - half;
    let rest = square * (square * polynomial(square, COSINE)) - high * low;
    let cosine = one + (((1.0 - one) - half) + rest);
    // Quarter turns exchange them, half turns change signs.
    let is_odd = bits & 1 == 1;
    let (sine, cosine) = if is_odd { (cosine, sine) } else { (sine, cosine) };
    let sign = |bits: u64| (bits & 2) << 62;
    (
        f64::from_bits(sine.to_bits() ^ sign(bits)),
        f64::from_bits(cosine.to_bits() ^ sign(bits.wrapping_add(1))),
    )
}
