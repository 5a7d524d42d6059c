//! A majorant that somebody claims for a field that knows none, or knows a looser one.

use crate::of_field::of_field;
use crate::{Breakpoints, Extinction, FieldError, Majorant, OpticalThickness};

/// A field together with a claimed majorant.
///
/// The claim is a parameter, not knowledge: watch it at every look-up with [`crate::Watched`]. An estimator run with a
/// majorant that is none is biased.
#[derive(Clone, Copy, Debug)]
pub struct Bounded<F> {
    field: F,
    majorant: f64,
}

impl<F: Extinction> Bounded<F> {
    /// `field` with the claimed `majorant` \[1/length\].
    ///
    /// # Errors
    /// If the majorant is negative or not finite.
    pub fn new(field: F, majorant: f64) -> Result<Self, FieldError> {
        FieldError::check_at_least("majorant", 0.0, majorant)?;
        Ok(Self { field, majorant })
    }

    /// Another field with the same claim, which is not checked again.
    #[inline]
    pub fn with_field<G: Extinction>(&self, field: G) -> Bounded<G> {
        Bounded { field, majorant: self.majorant }
    }
}

of_field!(Extinction, [F: Extinction] Bounded<F>);

impl<F: Extinction> Majorant for Bounded<F> {
    #[inline]
    fn majorant(&self) -> f64 {
        self.majorant
    }
}

of_field!(OpticalThickness, [F: OpticalThickness] Bounded<F>);
of_field!(Breakpoints, [F: Breakpoints] Bounded<F>);
