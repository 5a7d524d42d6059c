//! Numbers that an estimator may be written over.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number with the operations that estimators are made of.
pub trait Number:
    Clone
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The number x, exactly.
    fn of(x: f64) -> Self;

    /// The nearest double.
    fn to_f64(&self) -> f64;

    /// e^x.
    fn exp(&self) -> Self;

    /// √x.
    fn sqrt(&self) -> Self;

    /// tan x.
    fn tan(&self) -> Self;

    /// The angle of the point (x, self) in \[−π, π\].
    fn atan2(&self, x: &Self) -> Self;

    /// e^x − 1.
    fn exp_m1(&self) -> Self;

    /// ln(1 + x).
    fn ln_1p(&self) -> Self;

    /// cos x.
    fn cos(&self) -> Self;

    /// sinh x.
    fn sinh(&self) -> Self;

    /// The lesser of two.
    #[must_use]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    /// The greater of two.
    #[must_use]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self {
        if self < Self::of(0.0) { -self } else { self }
    }
}

/// A number of 160 bits: 107 more than a double.
#[derive(Clone, Debug, PartialEq, PartialOrd)]
pub struct Precise(FBig<HalfEven, 2>);

/// Bits of a [`Precise`] number.
const BITS: usize = 160;

impl Precise {
    /// −ln(1 − k 2^−53), the exponential of the lattice variate k < 2^53.
    #[must_use]
    pub fn exponential(k: u64) -> Self {
        // 1 − u is a number of the lattice itself.
        let rest = Self::of(((1_u64 << 53) - k) as f64) * Self::of(2.0_f64.powi(-53));
        // Not −0 for the variate 0.
        if k == 0 { Self::of(0.0) } else { Self(-rest.0.ln()) }
    }

    /// So many decimal digits, as text.
    #[must_use]
    pub fn digits(&self, digits: usize) -> String {
        self.0.to_decimal().value().with_precision(digits).value().to_string()
    }
}

macro_rules! operations {
    ($($operation:ident, $method:ident;)*) => {$(
        impl $operation for Precise {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self($operation::$method(self.0, other.0))
            }
        }
    )*};
}

operations! {
    Add, add;
    Sub, sub;
    Mul, mul;
    Div, div;
}

impl Neg for Precise {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Number for Precise {
    fn of(x: f64) -> Self {
        Self(FBig::try_from(x).expect("a finite number").with_precision(BITS).value())
    }

    fn to_f64(&self) -> f64 {
        self.0.to_f64().value()
    }

    fn exp(&self) -> Self {
        Self(self.0.exp())
    }

    fn sqrt(&self) -> Self {
        Self(self.0.sqrt())
    }

    fn tan(&self) -> Self {
        Self(self.0.tan())
    }

    fn atan2(&self, x: &Self) -> Self {
        Self(self.0.atan2(&x.0))
    }

    fn exp_m1(&self) -> Self {
        Self(self.0.exp_m1())
    }

    fn ln_1p(&self) -> Self {
        Self(self.0.ln_1p())
    }

    fn cos(&self) -> Self {
        Self(self.0.cos())
    }

    fn sinh(&self) -> Self {
        Self(self.0.sinh())
    }
}

/// A double, with functions that are rounded once.
impl Number for f64 {
    fn of(x: f64) -> Self {
        x
    }

    fn to_f64(&self) -> f64 {
        *self
    }

    fn exp(&self) -> Self {
        Precise::of(*self).exp().to_f64()
    }

    fn sqrt(&self) -> Self {
        f64::sqrt(*self)
    }

    fn tan(&self) -> Self {
        Precise::of(*self).tan().to_f64()
    }

    fn atan2(&self, x: &Self) -> Self {
        Precise::of(*self).atan2(&Precise::of(*x)).to_f64()
    }

    fn exp_m1(&self) -> Self {
        Precise::of(*self).exp_m1().to_f64()
    }

    fn ln_1p(&self) -> Self {
        Precise::of(*self).ln_1p().to_f64()
    }

    fn cos(&self) -> Self {
        Precise::of(*self).cos().to_f64()
    }

    fn sinh(&self) -> Self {
        Precise::of(*self).sinh().to_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_are_rounded_once() {
        assert_eq!(Number::exp(&1.0_f64), std::f64::consts::E);
        assert_eq!(Precise::exponential(1 << 52).to_f64(), std::f64::consts::LN_2);
        assert_eq!(Precise::exponential(0).to_f64(), 0.0);
        assert_eq!(Number::atan2(&1.0_f64, &-1.0), 0.75 * std::f64::consts::PI);
    }

    #[test]
    fn digits_of_a_quotient() {
        assert_eq!((Precise::of(1.0) / Precise::of(3.0)).digits(20), "0.33333333333333333333");
    }
}
