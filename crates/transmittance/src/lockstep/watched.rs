//! Look-ups in lanes that are watched.

use super::Lockstep;
use fairflight_elementary::lanes::Lanes;
use fairflight_media::{BoundCell, BoundedInCells, Extinction, Majorant};
use std::cell::Cell;

/// A field that remembers whether each value that was looked up is finite, within the declared majorant, and admitted by the estimator.
///
/// Lanes whose walk has ended look something up too, so that what is not lawful here need not have been met by any walk.
#[derive(Debug)]
pub struct Watched<'a, F, E> {
    field: &'a F,
    estimator: &'a E,
    upper_bound: f64,
    all_lawful: Cell<bool>,
}

impl<'a, F, E> Watched<'a, F, E> {
    /// Watches the look-ups of `estimator`; `upper_bound` \[1/length\] may be infinite.
    pub fn new(field: &'a F, estimator: &'a E, upper_bound: f64) -> Self {
        Self { field, estimator, upper_bound, all_lawful: Cell::new(true) }
    }

    /// True if every value was lawful.
    pub fn all_lawful(&self) -> bool {
        self.all_lawful.get()
    }
}

impl<F: Extinction, E: Lockstep<F>> Extinction for Watched<'_, F, E> {
    fn sigma_t(&self, s: f64) -> f64 {
        let sigma_t = self.field.sigma_t(s);
        let bounded = sigma_t.is_finite() && sigma_t <= self.upper_bound;
        if !(bounded && self.estimator.admits(self.field, s, sigma_t)) {
            self.all_lawful.set(false);
        }
        sigma_t
    }

    #[inline(always)]
    fn sigma_t_lanes(&self, s: &Lanes) -> Lanes {
        let sigma_t = self.field.sigma_t_lanes(s);
        let mut all_bounded = true;
        for value in &sigma_t {
            all_bounded &= value.is_finite() & (*value <= self.upper_bound);
        }
        if !(all_bounded && self.estimator.admits_lanes(self.field, s, &sigma_t)) {
            self.all_lawful.set(false);
        }
        sigma_t
    }

    fn length(&self) -> f64 {
        self.field.length()
    }
}

impl<F: Majorant, E: Lockstep<F>> Majorant for Watched<'_, F, E> {
    fn majorant(&self) -> f64 {
        self.field.majorant()
    }
}

impl<F: BoundedInCells, E: Lockstep<F>> BoundedInCells for Watched<'_, F, E> {
    fn bound_cells(&self) -> &[BoundCell] {
        self.field.bound_cells()
    }
}
