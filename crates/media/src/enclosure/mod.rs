//! Profiles of which something is proved on every stretch: their range, and their integral with a bound of its error.
//!
//! Quadrature from values at nodes knows nothing of what lies between them. A field that is [`Enclosed`] says what σ_t cannot leave on a
//! stretch, and how far its integral is off at most; [`Certificate`] bisects the profile until the whole is known well enough, or says
//! what is not proved.

mod certificate;
mod certified;
mod range;

pub use certificate::{Certificate, Doubt};
pub use certified::Certified;

use crate::{Extinction, Line, Medium, Ray};
use std::sync::Arc;

/// Proved facts about σ_t on a stretch of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Lower bound of σ_t, as far as it has a value \[1/length\]; minus infinity where no bound is known.
    pub low: f64,
    /// Upper bound of σ_t, as far as it has a value \[1/length\]; infinite where no bound is known.
    pub high: f64,
    /// ∫ σ_t over the stretch, to the two errors below \[1\].
    pub integral: f64,
    /// The part of the bound of its error that a finer partition lowers; infinite where nothing is known.
    pub truncation: f64,
    /// The part that is rounding: it adds up, however fine the partition.
    pub rounding: f64,
    /// True if σ_t may have no value somewhere on the stretch.
    pub may_be_undefined: bool,
    /// Distance at which σ_t is probably not smooth, strictly inside \[length\]: a better place to cut than the middle.
    pub kink: Option<f64>,
    /// Arithmetic operations that this took.
    pub cost: u64,
}

impl Stretch {
    /// Encloses by the range of σ_t alone: the integral is the middle of it times the width.
    pub(crate) fn from_range(from: f64, to: f64, (low, high): (f64, f64)) -> Self {
        let width = to - from;
        let middle = 0.5 * low + 0.5 * high;
        let unbounded = !(low.is_finite() && high.is_finite());
        let size = low.abs().max(high.abs());
        Self {
            low: if low.is_nan() { f64::NEG_INFINITY } else { low },
            high: if high.is_nan() { f64::INFINITY } else { high },
            integral: if unbounded { f64::NAN } else { middle * width },
            // The width is rounded once, the middle twice, the product once; so is the half range.
            truncation: if unbounded {
                f64::INFINITY
            } else {
                0.5 * (high - low) * width * (1.0 + 4.0 * f64::EPSILON)
            },
            rounding: if unbounded { 0.0 } else { 4.0 * f64::EPSILON * size * width + f64::MIN_POSITIVE },
            may_be_undefined: low.is_nan(),
            kink: None,
            cost: 1,
        }
    }
}

/// A profile of which something is proved on every stretch.
///
/// **Law.** σ_t(s), for every s with `from ≤ s ≤ to` at which it has a value, lies within the range of `enclose(from, to)`, and ∫ σ_t over the
/// stretch within its two errors of its integral. Where a field has no bounds the answer says so; it is never wrong.
pub trait Enclosed: Extinction {
    /// Encloses σ_t and its integral between two distances of the profile, `from < to`.
    fn enclose(&self, from: f64, to: f64) -> Stretch;

    /// Distances to cut at before anything else, strictly inside the profile, in any order: borders of pieces that the field knows.
    fn known_borders(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Lower and upper bound of σ_t between two distances \[1/length\]: the hull over the stretch cut where its range is
    /// decided, until a cut changes little. Infinite where no bound is known.
    fn range_between(&self, from: f64, to: f64) -> (f64, f64) {
        range::between(self, from, to)
    }
}

/// A medium that is [`Enclosed`] along every straight line.
pub trait LineEnclosed: Medium {
    /// Encloses σ_t and its integral between two distances on a line in the medium's own coordinates.
    fn enclose_line(&self, local: &Line, from: f64, to: f64) -> Stretch;

    /// See [`Enclosed::known_borders`].
    fn known_line_borders(&self, local: &Line, length: f64) -> Vec<f64>;
}

impl<M: LineEnclosed> Enclosed for Ray<M> {
    fn enclose(&self, from: f64, to: f64) -> Stretch {
        self.medium().enclose_line(self.local_line(), from, to)
    }
    fn known_borders(&self) -> Vec<f64> {
        self.medium().known_line_borders(self.local_line(), self.length())
    }
}

impl<F: Enclosed + ?Sized> Enclosed for &F {
    fn enclose(&self, from: f64, to: f64) -> Stretch {
        (**self).enclose(from, to)
    }
    fn known_borders(&self) -> Vec<f64> {
        (**self).known_borders()
    }
    fn range_between(&self, from: f64, to: f64) -> (f64, f64) {
        (**self).range_between(from, to)
    }
}

/// A medium behind a pointer is the medium.
macro_rules! behind_a_pointer {
    ($($pointer:ty),*) => {$(
        impl<M: LineEnclosed + ?Sized> LineEnclosed for $pointer {
            fn enclose_line(&self, local: &Line, from: f64, to: f64) -> Stretch {
                (**self).enclose_line(local, from, to)
            }
            fn known_line_borders(&self, local: &Line, length: f64) -> Vec<f64> {
                (**self).known_line_borders(local, length)
            }
        }
    )*};
}

behind_a_pointer!(&M, Arc<M>);

#[cfg(test)]
mod tests;
