//! A formula of the position, as a medium.

use super::program::Program;
use super::{ExpressionFieldError, parser};
use crate::{FieldError, Line, Medium, MediumBreakpoints};
use glam::DVec3;

/// σ_t(p) as a formula in the variables `x`, `y` and `z`, the position in world space.
///
/// Nothing is known of it but a majorant that somebody declares: a fact about the field, to be checked at each look-up
/// ([`crate::Watched`]).
#[derive(Clone, Debug)]
pub struct ExpressionMedium {
    program: Program,
    majorant: Option<f64>,
}

impl ExpressionMedium {
    /// The medium of a formula, with a declared `majorant` \[1/length\].
    ///
    /// # Errors
    /// If the formula is none or has a variable other than `x`, `y` and `z`, or `majorant` is not finite.
    pub fn new(sigma_t: &str, majorant: Option<f64>) -> Result<Self, ExpressionFieldError> {
        let program = parser::parse(sigma_t, &["x", "y", "z"])?;
        majorant.map_or(Ok(()), |majorant| FieldError::check_finite("majorant", majorant))?;
        Ok(Self { program, majorant })
    }

    /// The majorant that was declared \[1/length\].
    #[must_use]
    pub fn declared_majorant(&self) -> Option<f64> {
        self.majorant
    }
}

impl Medium for ExpressionMedium {
    /// NaN or infinite where the formula has no value.
    #[inline]
    fn sigma_t_local(&self, point: DVec3) -> f64 {
        self.program.eval(&point.to_array())
    }
    /// The declared majorant.
    fn upper_bound(&self) -> Option<f64> {
        self.majorant
    }
    fn lower_bound(&self) -> Option<f64> {
        None
    }
}

/// None: a formula does not know its kinks.
impl MediumBreakpoints for ExpressionMedium {
    fn line_breakpoints(&self, _local: &Line, _length: f64) -> Vec<f64> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn a_formula_of_the_position() {
        let medium = ExpressionMedium::new("z - x*y", Some(7.0)).unwrap();
        assert_eq!(medium.sigma_t(dvec3(2.0, 3.0, 11.0)), 5.0);
        assert_eq!((medium.upper_bound(), medium.lower_bound()), (Some(7.0), None));
        // A variable that does not occur changes nothing for the others.
        assert_eq!(ExpressionMedium::new("z", None).unwrap().sigma_t(dvec3(2.0, 3.0, 11.0)), 11.0);
    }

    #[test]
    fn what_is_refused_is_told() {
        let message = ExpressionMedium::new("x + s", None).unwrap_err().to_string();
        assert!(message.starts_with("unknown name 's': the variables are x, y, z;"), "{message}");
        assert!(matches!(ExpressionMedium::new("x", Some(f64::NAN)), Err(ExpressionFieldError::Field(_))));
    }
}
