//! The functions of one number and of lanes: the common range without a branch, the rest apart.

use crate::{exponential, logarithm, sine};

macro_rules! functions {
    ($($(#[$docs:meta])* $name:ident = $module:ident, $is_near:ident, $near:ident, $lanes:ident, $far:ident;)*) => {
        $(
            $(#[$docs])*
            #[inline(always)]
            #[must_use]
            pub fn $name(x: f64) -> f64 {
                if $module::$is_near(x) { $module::$near(x) } else { $module::$far(x) }
            }
        )*

        /// The same for arrays.
        pub(crate) mod of_lanes {
            use super::*;
            $(
                #[doc = concat!("[`", stringify!($name), "`](crate::", stringify!($name), ") of each lane.")]
                #[inline(always)]
                #[must_use]
                pub fn $name<const N: usize>(x: &[f64; N]) -> [f64; N] {
                    let mut values = $module::$lanes(x);
                    let mut all_near = true;
                    for &x in x {
                        all_near &= $module::$is_near(x);
                    }
                    if !all_near {
                        again(x, &mut values, $module::$is_near, $module::$far);
                    }
                    values
                }
            )*
        }
    };
}

functions! {
    /// ln x: −∞ of 0, and no number of those below.
    ln = logarithm, is_near, near, near_lanes, far;
    /// ln(1 + x): accurate where x is small, −∞ of −1, and no number of those below.
    ln_1p = logarithm, is_near_1p, near_1p, near_1p_lanes, far_1p;
    /// e^x: 0 below −745.2, ∞ above 709.8.
    exp = exponential, is_near, near, near_lanes, far;
    /// e^x − 1: accurate where x is small.
    exp_m1 = exponential, is_near_m1, near_m1, near_m1_lanes, far_m1;
}

/// The lanes that the common range does not hold.
#[cold]
#[inline(never)]
fn again(x: &[f64], values: &mut [f64], is_near: fn(f64) -> bool, far: fn(f64) -> f64) {
    for (value, &x) in values.iter_mut().zip(x) {
        if !is_near(x) {
            *value = far(x);
        }
    }
}

/// (sin x, cos x), each with the bits of its own function.
#[inline(always)]
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if sine::is_near(x) { sine::near(x) } else { sine::far(x) }
}

/// sin x; no number of an infinite one.
#[inline(always)]
#[must_use]
pub fn sin(x: f64) -> f64 {
    sin_cos(x).0
}

/// cos x; no number of an infinite one.
#[inline(always)]
#[must_use]
pub fn cos(x: f64) -> f64 {
    sin_cos(x).1
}
