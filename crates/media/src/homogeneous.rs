//! The same extinction everywhere in space.

use crate::{FieldError, Line, LineThickness, Medium, MediumBreakpoints};
use glam::DVec3;

/// σ_t(p) = σ_t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homogeneous {
    sigma_t: f64,
}

impl Homogeneous {
    /// A medium with `sigma_t` \[1/length\] of any sign, or zero.
    ///
    /// # Errors
    /// If `sigma_t` is not finite.
    pub fn new(sigma_t: f64) -> Result<Self, FieldError> {
        FieldError::check_finite("sigma_t", sigma_t)?;
        Ok(Self { sigma_t })
    }
}

impl Medium for Homogeneous {
    #[inline]
    fn sigma_t_local(&self, _point: DVec3) -> f64 {
        self.sigma_t
    }
    fn upper_bound(&self) -> Option<f64> {
        Some(self.sigma_t)
    }
    fn lower_bound(&self) -> Option<f64> {
        Some(self.sigma_t)
    }
}

impl LineThickness for Homogeneous {
    fn line_thickness(&self, _local: &Line, from: f64, to: f64) -> f64 {
        self.sigma_t * (to - from)
    }
    #[inline(always)]
    fn everywhere(&self) -> Option<f64> {
        Some(self.sigma_t)
    }
}

impl MediumBreakpoints for Homogeneous {
    fn line_breakpoints(&self, _local: &Line, _length: f64) -> Vec<f64> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extinction_times_length() {
        let medium = Homogeneous::new(-0.5).unwrap();
        let line = Line { origin: DVec3::ZERO, direction: DVec3::X };
        assert_eq!(medium.sigma_t(DVec3::ONE), -0.5);
        assert_eq!(medium.line_thickness(&line, 1.0, 3.0), -1.0);
        assert_eq!((medium.upper_bound(), medium.lower_bound()), (Some(-0.5), Some(-0.5)));
        assert!(matches!(Homogeneous::new(f64::NAN), Err(FieldError::NotFinite { .. })));
    }
}
