//! The same in all directions.

use super::PhaseFunction;
use std::f64::consts::PI;

/// eval = 1/(4π).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Isotropic;

impl PhaseFunction for Isotropic {
    #[inline(always)]
    fn eval(&self, _cosine: f64) -> f64 {
        1.0 / (4.0 * PI)
    }
    #[inline]
    fn sample_cosine(&self, u: f64) -> f64 {
        1.0 - 2.0 * u
    }
    fn mean_cosine(&self) -> f64 {
        0.0
    }
}
