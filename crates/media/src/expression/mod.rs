//! Extinction written as a formula.
//!
//! The language: numbers (`2`, `.5`, `2.`, `1e-3`), the variables, `pi` and `e`, `+ - * / ^`, parentheses, and the
//! functions sin cos tan exp ln sqrt abs floor ceil (of one argument), min max (of two). As in mathematics `-s^2` is
//! −(s²) and `2^3^2` is 2⁹; `1-2-3` and `8/4*2` go from left to right. There is no implicit multiplication.
//!
//! A formula is parsed once into a program for a stack machine, with constants folded, and run at each look-up without
//! allocation. It cannot fail there: a logarithm of a negative number is NaN, a division by zero infinite or NaN, and NaN
//! passes through every function including min and max. Whoever looks up checks.
//!
//! The parser is our own: of the ready-made ones that were tried none has this precedence, numbers with exponents, nested
//! calls of two arguments, and the place of an error.

mod enclosure;
mod medium;
mod names;
mod parser;
mod profile;
mod program;

pub use medium::ExpressionMedium;
pub use profile::ExpressionProfile;

use crate::FieldError;

#[cfg(test)]
mod certainty_tests;

/// A formula that is none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message} (column {column} of \"{expression}\")")]
pub struct ExpressionError {
    /// The formula as given.
    pub expression: String,
    /// Position of the first offence, in characters from 1; one past the last where something is missing at the end.
    pub column: usize,
    /// Description of the offence.
    pub message: String,
}

/// Error of a field that cannot be built from a formula.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExpressionFieldError {
    /// The formula is none.
    #[error(transparent)]
    Expression(#[from] ExpressionError),
    /// A number beside it is not lawful.
    #[error(transparent)]
    Field(#[from] FieldError),
}
