//! Look-ups in lanes that are watched.

use fairflight_elementary::lanes::Lanes;
use fairflight_media::Extinction;
use fairflight_transmittance::lockstep::Lockstep;
use std::cell::Cell;

/// A field that remembers whether each value that was looked up in lanes is finite, within the declared majorant, and admitted by the estimator.
///
/// Lanes whose walk has ended look something up too, so that what is not lawful here need not have been met by any walk.
#[derive(Debug)]
pub struct WatchedLanes<'a, F, E> {
    field: &'a F,
    estimator: &'a E,
    upper_bound: f64,
    all_lawful: Cell<bool>,
}

/// An estimator that runs in lanes on a field, also where look-ups are watched.
pub trait InLanes<F: Extinction>:
    Lockstep<F> + for<'a> Lockstep<WatchedLanes<'a, F, Self>> + Sized + 'static
{
}

impl<F: Extinction, E: Lockstep<F> + for<'a> Lockstep<WatchedLanes<'a, F, E>> + 'static> InLanes<F> for E {}

impl<'a, F, E> WatchedLanes<'a, F, E> {
    pub(super) fn new(field: &'a F, estimator: &'a E, upper_bound: f64) -> Self {
        Self { field, estimator, upper_bound, all_lawful: Cell::new(true) }
    }

    pub(super) fn all_lawful(&self) -> bool {
        self.all_lawful.get()
    }
}

impl<F: Extinction, E: Lockstep<F>> Extinction for WatchedLanes<'_, F, E> {
    fn sigma_t(&self, s: f64) -> f64 {
        self.field.sigma_t(s)
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
