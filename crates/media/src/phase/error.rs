//! Errors of the constructors of phase functions.

use crate::FieldError;

/// Error of a phase function that cannot be built. Each variant names the inequality that was violated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PhaseError {
    /// A parameter of anisotropy is -1 or less, or NaN.
    #[error("{what} must be above -1, found {found}")]
    NotAboveMinusOne {
        /// The parameter.
        what: &'static str,
        /// The value given.
        found: f64,
    },
    /// A parameter of anisotropy is 1 or more.
    #[error("{what} must be below 1, found {found}")]
    NotBelowOne {
        /// The parameter.
        what: &'static str,
        /// The value given.
        found: f64,
    },
    /// The cosines of a table do not reach from -1 to 1.
    #[error("cosines must reach from -1 to 1, found {first} to {last}")]
    NotFromBackToFront {
        /// The first of them.
        first: f64,
        /// The last of them.
        last: f64,
    },
    /// All values of a table are zero: nothing can be normalised.
    #[error("values must not all be zero")]
    NowherePositive,
    /// Cosines or values that are no table.
    #[error(transparent)]
    Table(#[from] FieldError),
}

impl PhaseError {
    /// -1 < `found` < 1.
    pub(super) fn check_anisotropy(what: &'static str, found: f64) -> Result<(), Self> {
        if found >= 1.0 {
            return Err(Self::NotBelowOne { what, found });
        }
        if found > -1.0 { Ok(()) } else { Err(Self::NotAboveMinusOne { what, found }) }
    }
}
