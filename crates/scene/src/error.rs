//! Refusals of the constructors of a scene.

use crate::Spectrum;

/// Error of a part of a scene that cannot be built. Each variant names the inequality that was violated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// A number is NaN or infinite.
    #[error("{what} must be finite")]
    NotFinite {
        /// The parameter.
        what: &'static str,
    },
    /// A number is negative.
    #[error("{what} must be at least 0, found {found}")]
    Negative {
        /// The parameter.
        what: &'static str,
        /// The value given.
        found: f64,
    },
    /// A number is negative or zero.
    #[error("{what} must be above 0, found {found}")]
    NotPositive {
        /// The parameter.
        what: &'static str,
        /// The value given.
        found: f64,
    },
    /// A direction of length zero, or one that another parameter makes useless.
    #[error("{what} must not be {because}")]
    Degenerate {
        /// The parameter.
        what: &'static str,
        /// The property that makes it useless.
        because: &'static str,
    },
    /// The field of view is no angle that a pinhole can have.
    #[error("vertical_fov_degrees must lie between 0 and 180, found {found}")]
    FieldOfView {
        /// The angle given \[°\].
        found: f64,
    },
    /// A picture without pixels.
    #[error("{what} must be at least 1 in both directions")]
    NoPixels {
        /// The parameter.
        what: &'static str,
    },
    /// A number of pixels that is not width times height.
    #[error("a map of {width} x {height} needs {} pixels, found {found}", width * height)]
    PixelCount {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Pixels given.
        found: usize,
    },
}

impl SceneError {
    pub(crate) fn check_finite(what: &'static str, is_finite: bool) -> Result<(), Self> {
        if is_finite { Ok(()) } else { Err(Self::NotFinite { what }) }
    }

    /// Finite and above 0.
    pub(crate) fn check_positive(what: &'static str, found: f64) -> Result<(), Self> {
        Self::check_finite(what, found.is_finite())?;
        if found > 0.0 { Ok(()) } else { Err(Self::NotPositive { what, found }) }
    }

    /// Finite and at least 0 in every channel.
    pub(crate) fn check_strength<C: Spectrum>(what: &'static str, strength: C) -> Result<(), Self> {
        Self::check_finite(what, strength.is_finite())?;
        let least = (0..C::CHANNELS).map(|i| strength.channel(i)).fold(f64::INFINITY, f64::min);
        if least < 0.0 { Err(Self::Negative { what, found: least }) } else { Ok(()) }
    }
}
