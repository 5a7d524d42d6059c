//! A formula of the distance, as a profile.

use super::program::Program;
use super::{ExpressionFieldError, enclosure, parser};
use crate::{
    Breakpoints, Certificate, Enclosed, Extinction, FieldError, Majorant, Minorant, Stretch, Tolerance,
};

/// σ_t(s) as a formula in the variable `s`, the distance from the start of the profile.
///
/// Its integral and its range are found by interval arithmetic ([`Enclosed`]). A majorant that somebody declares is a fact about the
/// field, to be checked at each look-up ([`crate::Watched`]).
///
/// ```
/// use fairflight_media::{Extinction, ExpressionProfile};
/// let profile = ExpressionProfile::new("0.3 + 0.25*sin(7*s)*exp(-0.2*s)", 9.0, Some(0.6))?;
/// assert_eq!(profile.sigma_t(0.0), 0.3);
/// # Ok::<(), fairflight_media::ExpressionFieldError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ExpressionProfile {
    program: Program,
    length: f64,
    majorant: Option<f64>,
}

impl ExpressionProfile {
    /// The profile of a formula over `length` \[length\], with a declared `majorant` \[1/length\].
    ///
    /// # Errors
    /// If the formula is none or has a variable other than `s`; `length` or `majorant` is not finite; or `length < 0`.
    pub fn new(sigma_t: &str, length: f64, majorant: Option<f64>) -> Result<Self, ExpressionFieldError> {
        let program = parser::parse(sigma_t, &["s"])?;
        FieldError::check_at_least("length", 0.0, length)?;
        majorant.map_or(Ok(()), |majorant| FieldError::check_finite("majorant", majorant))?;
        Ok(Self { program, length, majorant })
    }

    /// The majorant that was declared \[1/length\].
    #[must_use]
    pub fn declared_majorant(&self) -> Option<f64> {
        self.majorant
    }
}

/// NaN or infinite where the formula has no value.
impl Extinction for ExpressionProfile {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        self.program.eval(&[s])
    }
    #[inline]
    fn length(&self) -> f64 {
        self.length
    }
}

/// The declared majorant, infinite where none is.
impl Majorant for ExpressionProfile {
    #[inline]
    fn majorant(&self) -> f64 {
        self.majorant.unwrap_or(f64::INFINITY)
    }
}

/// Minus infinity: no lower bound is known.
impl Minorant for ExpressionProfile {
    fn minorant(&self) -> f64 {
        f64::NEG_INFINITY
    }
}

impl Enclosed for ExpressionProfile {
    fn enclose(&self, from: f64, to: f64) -> Stretch {
        enclosure::stretch(&self.program, &[(0.0, 1.0)], from, to)
    }
}

/// The borders of its [`Certificate`], made anew at each call: [`crate::Certified`] remembers them.
impl Breakpoints for ExpressionProfile {
    fn breakpoints(&self) -> Vec<f64> {
        Certificate::of(self, Tolerance::TIGHT).borders
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_of_the_distance() {
        let profile = ExpressionProfile::new("1 + s^2", 4.0, None).unwrap();
        assert_eq!((profile.sigma_t(2.0), profile.length()), (5.0, 4.0));
        assert_eq!((profile.declared_majorant(), profile.majorant()), (None, f64::INFINITY));
        let bounded = ExpressionProfile::new("2 - s", 4.0, Some(2.0)).unwrap();
        assert_eq!((bounded.declared_majorant(), bounded.majorant()), (Some(2.0), 2.0));
    }

    #[test]
    fn what_is_refused_is_told() {
        let refused =
            |sigma_t, length, majorant| ExpressionProfile::new(sigma_t, length, majorant).unwrap_err();
        assert!(refused("2*x", 1.0, None).to_string().contains("unknown name 'x'"));
        assert!(refused("2*x", 1.0, None).to_string().ends_with("(column 3 of \"2*x\")"));
        assert!(matches!(refused("s", -1.0, None), ExpressionFieldError::Field(FieldError::TooSmall { .. })));
        assert!(matches!(
            refused("s", 1.0, Some(f64::NAN)),
            ExpressionFieldError::Field(FieldError::NotFinite { .. })
        ));
    }
}
