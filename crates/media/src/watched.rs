//! Wrappers around a field for the one who measures: count the look-ups, and watch that each is lawful.
//!
//! Wrappers are separate from the fields, so that a run without them pays nothing.

use crate::of_field::of_field;
use crate::{Extinction, InvertOpticalThickness, Majorant, OpticalThickness};
use std::cell::Cell;

/// Counts look-ups.
#[derive(Debug)]
pub struct Counted<F> {
    field: F,
    lookups: Cell<u64>,
}

impl<F> Counted<F> {
    /// Counts the look-ups of `field` from here on.
    pub fn new(field: F) -> Self {
        Self { field, lookups: Cell::new(0) }
    }

    /// The number of look-ups so far.
    pub fn lookups(&self) -> u64 {
        self.lookups.get()
    }

    /// The field that is counted.
    pub fn field(&self) -> &F {
        &self.field
    }
}

impl<F: Extinction> Extinction for Counted<F> {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        self.lookups.set(self.lookups.get() + 1);
        self.field.sigma_t(s)
    }
    #[inline]
    fn length(&self) -> f64 {
        self.field.length()
    }
}

of_field!(Majorant, [F: Majorant] Counted<F>);
of_field!(OpticalThickness, [F: OpticalThickness] Counted<F>);
of_field!(InvertOpticalThickness, [F: InvertOpticalThickness] Counted<F>);

/// The values of σ_t that an estimator is an estimator for.
pub trait Domain {
    /// True if σ_t may have this value at this distance.
    fn admits(&self, s: f64, sigma_t: f64) -> bool;
}

impl<D: Domain + ?Sized> Domain for &D {
    #[inline]
    fn admits(&self, s: f64, sigma_t: f64) -> bool {
        (**self).admits(s, sigma_t)
    }
}

/// A look-up that left the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Violation {
    /// The distance \[length\].
    pub s: f64,
    /// The value found there \[1/length\].
    pub sigma_t: f64,
}

/// Watches every look-up of a field: remembers the first one that is not finite or that its domain does not admit.
///
/// The walk goes on (with the value as it is), so that the hot loop has no early way out; whoever runs it asks for the
/// [`violation`](Self::violation) afterwards and throws the samples away. A field that is watched against a majorant
/// [`Majorant`]: the claim is checked at each look-up.
#[derive(Debug)]
pub struct Watched<F, D> {
    field: F,
    domain: D,
    violation: Cell<Option<Violation>>,
}

impl<F, D: Domain> Watched<F, D> {
    /// Watches `field` for values outside `domain`.
    pub fn new(field: F, domain: D) -> Self {
        Self { field, domain, violation: Cell::new(None) }
    }

    /// The field that is watched.
    pub fn field(&self) -> &F {
        &self.field
    }

    /// The first look-up that was not lawful, if there was one.
    pub fn violation(&self) -> Option<Violation> {
        self.violation.get()
    }

    #[cold]
    fn remember(&self, s: f64, sigma_t: f64) {
        if self.violation.get().is_none() {
            self.violation.set(Some(Violation { s, sigma_t }));
        }
    }
}

impl<F: Extinction, D: Domain> Extinction for Watched<F, D> {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        let sigma_t = self.field.sigma_t(s);
        if !(sigma_t.is_finite() && self.domain.admits(s, sigma_t)) {
            self.remember(s, sigma_t);
        }
        sigma_t
    }
    #[inline]
    fn length(&self) -> f64 {
        self.field.length()
    }
}

of_field!(Majorant, [F: Majorant, D: Domain] Watched<F, D>);
of_field!(OpticalThickness, [F: OpticalThickness, D: Domain] Watched<F, D>);
of_field!(InvertOpticalThickness, [F: InvertOpticalThickness, D: Domain] Watched<F, D>);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Constant;

    struct AtMost(f64);
    impl Domain for AtMost {
        fn admits(&self, _s: f64, sigma_t: f64) -> bool {
            sigma_t <= self.0
        }
    }

    #[test]
    fn the_first_unlawful_look_up_is_remembered() {
        let watched = Watched::new(Constant::new(2.0, 1.0).unwrap(), AtMost(1.0));
        assert_eq!(watched.violation(), None);
        assert_eq!(watched.sigma_t(0.25), 2.0);
        watched.sigma_t(0.5);
        assert_eq!(watched.violation(), Some(Violation { s: 0.25, sigma_t: 2.0 }));
    }

    #[test]
    fn look_ups_are_counted() {
        let counted = Counted::new(Constant::new(2.0, 1.0).unwrap());
        for _ in 0..3 {
            counted.sigma_t(0.0);
        }
        assert_eq!(counted.lookups(), 3);
    }
}
