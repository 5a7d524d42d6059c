//! Numbers that err in each operation: the arithmetic of ports.

use crate::Number;
use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A precision that ports may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Doubles, with fused multiply-add and sums in another order.
    Binary64,
    /// Single precision, with the logarithm that WGSL allows.
    Binary32,
}

impl Precision {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Binary64, Self::Binary32];

    /// Name in tolerances.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Binary64 => "binary64",
            Self::Binary32 => "binary32",
        }
    }

    /// Distance from 1 to the number above \[1\].
    #[must_use]
    pub fn unit(self) -> f64 {
        match self {
            Self::Binary64 => 2.0_f64.powi(-52),
            Self::Binary32 => 2.0_f64.powi(-23),
        }
    }

    /// Largest relative error of an operation \[1\]: two of those of rounding to nearest (WGSL grants division 2.5).
    fn of_operation(self) -> f64 {
        match self {
            Self::Binary64 => self.unit(),
            Self::Binary32 => 1.25 * self.unit(),
        }
    }

    /// Largest relative error of a function, a look-up or an exponential \[1\].
    fn of_function(self) -> f64 {
        4.0 * self.unit()
    }

    /// Largest absolute error of an exponential \[1\]: WGSL grants log 2^−21 between 1/2 and 2.
    fn of_exponential(self) -> f64 {
        match self {
            Self::Binary64 => 0.0,
            Self::Binary32 => 2.0_f64.powi(-20),
        }
    }
}

/// Errors of one run: signs from a generator of its own (splitmix64, steele-2014), so that no other part of the project moves a vector.
#[derive(Debug)]
pub struct Noise {
    state: Cell<u64>,
    precision: Precision,
    /// The size of all errors, of those of the precision \[1\].
    share: f64,
}

impl Noise {
    /// Errors of this precision, the run of this number.
    #[must_use]
    pub fn new(precision: Precision, number: u64) -> Self {
        Self { state: Cell::new(number.wrapping_mul(0xD134_2543_DE82_EF95)), precision, share: 1.0 }
    }

    /// None: doubles with the functions of a library, whose bits are the same on every machine.
    pub(crate) fn none() -> Self {
        Self { share: 0.0, ..Self::new(Precision::Binary64, 0) }
    }

    /// Either sign.
    fn sign(&self) -> f64 {
        let next = self.state.get().wrapping_add(0x9E37_79B9_7F4A_7C15);
        self.state.set(next);
        let mixed = (next ^ (next >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        if mixed >> 63 == 0 { self.share } else { -self.share }
    }

    fn off(&self, x: f64, relative: f64) -> f64 {
        x * (1.0 + self.sign() * relative)
    }

    /// An exponential as a port may have it; never below 0.
    pub(crate) fn exponential(&self, exact: f64) -> Perturbed<'_> {
        let precision = self.precision;
        let off = self.off(exact, precision.of_function()) + self.sign() * precision.of_exponential();
        self.number(off.max(0.0))
    }

    /// A look-up as a port may have it.
    pub(crate) fn looked_up<'a>(&'a self, x: &Perturbed<'a>) -> Perturbed<'a> {
        self.number(self.off(x.value, self.precision.of_function()))
    }

    /// A number that makes whatever is reckoned with it err.
    pub(crate) fn number(&self, value: f64) -> Perturbed<'_> {
        Perturbed { value, noise: Some(self) }
    }
}

/// A double that errs in each operation, unless both operands are constants.
#[derive(Clone, Debug)]
pub struct Perturbed<'a> {
    value: f64,
    noise: Option<&'a Noise>,
}

impl<'a> Perturbed<'a> {
    fn operation(self, other: &Self, exact: f64) -> Self {
        let noise = self.noise.or(other.noise);
        let value = noise.map_or(exact, |noise| noise.off(exact, noise.precision.of_operation()));
        Self { value, noise }
    }

    fn function(&self, exact: f64, noise: Option<&'a Noise>) -> Self {
        let noise = self.noise.or(noise);
        let value = noise.map_or(exact, |noise| noise.off(exact, noise.precision.of_function()));
        Self { value, noise }
    }
}

impl PartialEq for Perturbed<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl PartialOrd for Perturbed<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

macro_rules! operations {
    ($($operation:ident, $method:ident;)*) => {$(
        impl $operation for Perturbed<'_> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                let exact = $operation::$method(self.value, other.value);
                self.operation(&other, exact)
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

impl Neg for Perturbed<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl Number for Perturbed<'_> {
    fn of(x: f64) -> Self {
        Self { value: x, noise: None }
    }

    fn to_f64(&self) -> f64 {
        self.value
    }

    // Of a library with the same bits on every machine, so that tolerances are the same too; its errors are within what is granted.
    fn exp(&self) -> Self {
        self.function(libm::exp(self.value), None)
    }

    fn sqrt(&self) -> Self {
        self.function(self.value.sqrt(), None)
    }

    fn tan(&self) -> Self {
        self.function(libm::tan(self.value), None)
    }

    fn atan2(&self, x: &Self) -> Self {
        self.function(libm::atan2(self.value, x.value), x.noise)
    }

    fn exp_m1(&self) -> Self {
        self.function(libm::expm1(self.value), None)
    }

    fn ln_1p(&self) -> Self {
        self.function(libm::log1p(self.value), None)
    }

    fn cos(&self) -> Self {
        self.function(libm::cos(self.value), None)
    }

    fn sinh(&self) -> Self {
        self.function(libm::sinh(self.value), None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_err_by_no_more_than_is_granted() {
        let noise = Noise::new(Precision::Binary32, 1);
        let mut found = [false; 2];
        for _ in 0..100 {
            let sum = noise.number(1.0) + Perturbed::of(2.0);
            let error = sum.to_f64() / 3.0 - 1.0;
            assert!((error.abs() / Precision::Binary32.of_operation() - 1.0).abs() < 1e-6, "{error}");
            found[usize::from(error > 0.0)] = true;
        }
        assert_eq!(found, [true; 2]);
        assert_eq!((Perturbed::of(0.1) + Perturbed::of(0.2)).to_f64(), 0.1 + 0.2);
    }
}
