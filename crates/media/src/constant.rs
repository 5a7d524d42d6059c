//! The same extinction everywhere on the profile.

use crate::{
    Breakpoints, Extinction, FieldError, InvertOpticalThickness, Majorant, Minorant, OpticalThickness,
};
use fairflight_elementary::lanes::{LANES, Lanes};

/// σ_t(s) = σ_t. As a profile, a control, or a sampling extinction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant {
    sigma_t: f64,
    mean_free_path: f64,
    length: f64,
}

impl Constant {
    /// A constant profile; `sigma_t` \[1/length\] may be zero or negative, `length` may be zero.
    ///
    /// # Errors
    /// If a number is not finite, or `length < 0`.
    pub fn new(sigma_t: f64, length: f64) -> Result<Self, FieldError> {
        FieldError::check_finite("sigma_t", sigma_t)?;
        FieldError::check_at_least("length", 0.0, length)?;
        Ok(Self { sigma_t, mean_free_path: 1.0 / sigma_t, length })
    }
}

impl Extinction for Constant {
    #[inline]
    fn sigma_t(&self, _s: f64) -> f64 {
        self.sigma_t
    }
    #[inline]
    fn length(&self) -> f64 {
        self.length
    }
}

impl Majorant for Constant {
    #[inline]
    fn majorant(&self) -> f64 {
        self.sigma_t
    }
}

impl Minorant for Constant {
    fn minorant(&self) -> f64 {
        self.sigma_t
    }
}

impl OpticalThickness for Constant {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        self.sigma_t * (to - from)
    }
}

impl InvertOpticalThickness for Constant {
    #[inline]
    fn invert(&self, from: f64, depth: f64) -> Option<f64> {
        debug_assert!(self.sigma_t >= 0.0, "a sampling extinction is not negative");
        // For sigma_t = 0 this is infinite, or NaN where depth = 0: both fail the comparison, and the flight escapes.
        let s = from + depth * self.mean_free_path;
        (s < self.length).then_some(s)
    }
    #[inline(always)]
    fn invert_lanes(&self, from: &Lanes, depth: &Lanes) -> Lanes {
        let mut distances = [0.0; LANES];
        for i in 0..LANES {
            let s = from[i] + depth[i] * self.mean_free_path;
            distances[i] = if s < self.length { s } else { f64::INFINITY };
        }
        distances
    }
}

impl Breakpoints for Constant {
    fn breakpoints(&self) -> Vec<f64> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inversion_undoes_the_optical_thickness() {
        let field = Constant::new(0.5, 10.0).unwrap();
        assert_eq!(field.invert(2.0, 1.5), Some(5.0));
        assert_eq!(field.optical_thickness(2.0, 5.0), 1.5);
        assert_eq!(field.invert(2.0, 4.0), None);
    }

    #[test]
    fn a_flight_through_nothing_escapes() {
        let empty = Constant::new(0.0, 1e300).unwrap();
        assert_eq!(empty.invert(0.0, 0.0), None);
        assert_eq!(empty.invert(0.0, 36.0), None);
        assert_eq!(empty.optical_thickness(0.0, 1e300), 0.0);
    }

    #[test]
    fn bad_numbers_are_refused() {
        assert!(matches!(Constant::new(f64::NAN, 1.0), Err(FieldError::NotFinite { .. })));
        assert!(matches!(Constant::new(1.0, f64::INFINITY), Err(FieldError::NotFinite { .. })));
        assert!(matches!(Constant::new(1.0, -1.0), Err(FieldError::TooSmall { .. })));
    }

    #[test]
    fn it_breaks_nowhere() {
        assert!(Constant::new(0.5, 10.0).unwrap().breakpoints().is_empty());
    }
}
