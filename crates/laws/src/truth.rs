//! The optical thickness that estimates are judged against, and the unit that they are judged in.

use fairflight_media::{Breakpoints, Certificate, OpticalThickness, RayQuadrature, Tolerance};

/// τ = ∫ σ_t over a whole profile, with its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// τ \[1\].
    pub optical_thickness: f64,
    /// A bound of its absolute error; rounding is granted apart.
    pub error: f64,
}

impl Truth {
    /// The truth by a closed form.
    pub fn closed_form<F: OpticalThickness>(field: &F) -> Self {
        Self { optical_thickness: field.optical_thickness(0.0, field.length()), error: 0.0 }
    }

    /// The truth by quadrature of a profile that knows all its breakpoints, with the error that it estimated: what a closed form is checked
    /// against.
    pub fn quadrature<F: Breakpoints>(quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> Self {
        let integral = quadrature.integrate(tolerance, |_, sigma_t| [sigma_t]);
        Self { optical_thickness: integral.value[0], error: integral.error[0] }
    }

    /// The truth by a certificate, with the error that it proves; infinite where it proves none.
    #[must_use]
    pub fn certified(certificate: &Certificate) -> Self {
        Self { optical_thickness: certificate.thickness, error: certificate.error }
    }
}

/// The unit in which estimates of a transmittance are kept: T itself wherever T is a number that can be divided by.
///
/// The fourth power of T = 1e-90 is no number any more, that of an estimate in units of T is. A mean of 1 also makes the
/// detectable bias a relative one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    ln: f64,
}

/// 1e±290: beyond, T or its reciprocal comes too near to the ends of the range of numbers.
const GREATEST_LOGARITHM: f64 = 290.0 * std::f64::consts::LN_10;

impl Unit {
    /// The unit for the profile with this optical thickness: exp(−τ), or 1 where that is out of the range of numbers.
    #[must_use]
    pub fn of(optical_thickness: f64) -> Self {
        let ln = if optical_thickness.abs() <= GREATEST_LOGARITHM { -optical_thickness } else { 0.0 };
        Self { ln }
    }

    /// Factor of an estimate.
    #[must_use]
    pub fn scale(self) -> f64 {
        (-self.ln).exp()
    }

    /// exp(`logarithm`) in this unit, rounded once.
    #[must_use]
    pub fn exp(self, logarithm: f64) -> f64 {
        (logarithm - self.ln).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Constant, ExpressionProfile};

    #[test]
    fn a_transmittance_is_one_in_its_own_unit_where_it_is_a_number() {
        for tau in [-600.0, 0.0, 1e-12, 3.0, 660.0] {
            assert_eq!(Unit::of(tau).exp(-tau), 1.0);
        }
        for tau in [700.0, 1e6] {
            assert_eq!(Unit::of(tau).exp(-tau), f64::exp(-tau));
            assert_eq!(Unit::of(tau).scale(), 1.0);
        }
    }

    #[test]
    fn a_certificate_knows_its_error() {
        let field = ExpressionProfile::new("exp(-s)", 2.5, None).unwrap();
        let truth = Truth::certified(&Certificate::of(&field, Tolerance::TIGHT));
        let exact = -(-2.5_f64).exp_m1();
        assert!((truth.optical_thickness - exact).abs() <= truth.error && truth.error < 1e-11);
        assert_eq!(Truth::closed_form(&Constant::new(2.0, 3.0).unwrap()).optical_thickness, 6.0);
    }
}
