//! Arithmetics of runs: exact, in doubles, perturbed.

use crate::number::{Number, Precise};
use crate::perturbed::{Noise, Perturbed};

/// Numbers of a run, and how those that come from outside enter it.
pub trait Arithmetic {
    /// The numbers.
    type Number: Number;

    /// The variate k 2^−53.
    fn uniform(&self, k: u64) -> Self::Number;

    /// An exponential variate.
    fn exponential(&self, exact: &Precise) -> Self::Number;

    /// An input of a function.
    fn input(&self, x: f64) -> Self::Number;

    /// A look-up of a profile.
    fn looked_up(&self, sigma_t: Self::Number) -> Self::Number;
}

/// u = k 2^−53 as a double, exactly.
fn variate(k: u64) -> f64 {
    k as f64 * 2.0_f64.powi(-53)
}

/// 160 bits.
#[derive(Clone, Copy, Debug)]
pub struct Exact;

impl Arithmetic for Exact {
    type Number = Precise;

    fn uniform(&self, k: u64) -> Precise {
        Precise::of(variate(k))
    }

    fn exponential(&self, exact: &Precise) -> Precise {
        exact.clone()
    }

    fn input(&self, x: f64) -> Precise {
        Precise::of(x)
    }

    fn looked_up(&self, sigma_t: Precise) -> Precise {
        sigma_t
    }
}

/// Doubles; exponentials are rounded once.
#[derive(Clone, Copy, Debug)]
pub struct Binary64;

impl Arithmetic for Binary64 {
    type Number = f64;

    fn uniform(&self, k: u64) -> f64 {
        variate(k)
    }

    fn exponential(&self, exact: &Precise) -> f64 {
        exact.to_f64()
    }

    fn input(&self, x: f64) -> f64 {
        x
    }

    fn looked_up(&self, sigma_t: f64) -> f64 {
        sigma_t
    }
}

/// Variates and inputs are exact in every precision; what is made of them errs.
impl<'a> Arithmetic for &'a Noise {
    type Number = Perturbed<'a>;

    fn uniform(&self, k: u64) -> Perturbed<'a> {
        self.number(variate(k))
    }

    fn exponential(&self, exact: &Precise) -> Perturbed<'a> {
        Noise::exponential(self, exact.to_f64())
    }

    fn input(&self, x: f64) -> Perturbed<'a> {
        self.number(x)
    }

    fn looked_up(&self, sigma_t: Perturbed<'a>) -> Perturbed<'a> {
        Noise::looked_up(self, &sigma_t)
    }
}
