//! Errors of the constructors of fields.

/// Error of a field that cannot be built. Each variant names the inequality that was violated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FieldError {
    /// A number is NaN or infinite.
    #[error("{what} must be finite, found {found}")]
    NotFinite {
        /// The parameter, with its index in a list.
        what: String,
        /// The value given.
        found: f64,
    },
    /// A number is below its least allowed value.
    #[error("{what} must be at least {least}, found {found}")]
    TooSmall {
        /// The parameter.
        what: &'static str,
        /// The least allowed value.
        least: f64,
        /// The value given.
        found: f64,
    },
    /// A list has too few entries.
    #[error("{what} needs at least {least} entries, found {found}")]
    TooFew {
        /// The parameter.
        what: &'static str,
        /// The least number of entries.
        least: usize,
        /// The number given.
        found: usize,
    },
    /// A list would have too many entries.
    #[error("{what} may have {most} entries, asked for {found}")]
    TooMany {
        /// The parameter.
        what: &'static str,
        /// The greatest number of entries.
        most: usize,
        /// The number given, or the greatest that can be counted.
        found: usize,
    },
    /// Edges or positions do not increase.
    #[error("{what} must increase strictly, but {what}[{index}] = {found} follows {previous}")]
    NotIncreasing {
        /// The parameter.
        what: &'static str,
        /// The index of the offending entry.
        index: usize,
        /// The entry before it.
        previous: f64,
        /// The entry.
        found: f64,
    },
    /// Edges or positions do not start where the profile does.
    #[error("{what} must start at 0, the start of the profile, found {found}")]
    NotAtStart {
        /// The parameter.
        what: &'static str,
        /// The first entry.
        found: f64,
    },
    /// Cells do not end where the profile does.
    #[error("{what} must end at {length}, the end of the profile, found {found}")]
    NotAtEnd {
        /// The parameter.
        what: &'static str,
        /// The length of the profile.
        length: f64,
        /// The end of the last one.
        found: f64,
    },
    /// Two lists do not fit together.
    #[error("{what} needs {expected} entries, found {found}")]
    LengthMismatch {
        /// The parameter.
        what: &'static str,
        /// The number of entries that the other list asks for.
        expected: usize,
        /// The number given.
        found: usize,
    },
    /// Profiles that belong together differ in their length.
    #[error("{what} must have one length, found {first} and {found}")]
    UnequalLengths {
        /// The parameter.
        what: &'static str,
        /// The length of the first \[length\].
        first: f64,
        /// Another length \[length\].
        found: f64,
    },
    /// A direction of length zero, or a map that flattens space.
    #[error("{what} must not be degenerate")]
    Degenerate {
        /// The parameter.
        what: &'static str,
    },
}

impl FieldError {
    pub(crate) fn check_finite(what: &str, found: f64) -> Result<(), Self> {
        if found.is_finite() { Ok(()) } else { Err(Self::NotFinite { what: what.to_owned(), found }) }
    }

    pub(crate) fn check_all_finite(what: &str, values: &[f64]) -> Result<(), Self> {
        values.iter().enumerate().try_for_each(|(i, &v)| Self::check_finite(&format!("{what}[{i}]"), v))
    }

    pub(crate) fn check_at_least(what: &'static str, least: f64, found: f64) -> Result<(), Self> {
        Self::check_finite(what, found)?;
        if found >= least { Ok(()) } else { Err(Self::TooSmall { what, least, found }) }
    }

    /// The nodes of a piecewise field: finite, at least two, strictly increasing.
    pub(crate) fn check_nodes(what: &'static str, nodes: &[f64]) -> Result<(), Self> {
        if nodes.len() < 2 {
            return Err(Self::TooFew { what, least: 2, found: nodes.len() });
        }
        Self::check_all_finite(what, nodes)?;
        match nodes.windows(2).position(|pair| pair[1] <= pair[0]) {
            None => Ok(()),
            Some(i) => {
                Err(Self::NotIncreasing { what, index: i + 1, previous: nodes[i], found: nodes[i + 1] })
            }
        }
    }

    pub(crate) fn check_len(what: &'static str, expected: usize, found: usize) -> Result<(), Self> {
        if expected == found { Ok(()) } else { Err(Self::LengthMismatch { what, expected, found }) }
    }
}
