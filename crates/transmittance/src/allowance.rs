//! The look-ups that a closed form may spend.
//!
//! A closed form may take many quadratures: of a comb one for each of its moments, for each segment or level, and each evaluation takes
//! as many look-ups as the comb has teeth. All of them draw on one allowance.

use crate::Unreached;
use fairflight_media::{Integral, Tolerance, adaptive_integral};
use std::cell::Cell;

/// Look-ups of one closed form: ten seconds of those that take 100 ns.
const MOST_LOOKUPS: f64 = 1e8;

/// Nodes of a panel.
pub(crate) const NODES: f64 = 21.0;

/// Look-ups that the quadratures of one closed form spend together. An integrand at a node whose look-ups are kept counts as one.
#[derive(Debug)]
pub(crate) struct Allowance {
    most: f64,
    spent: Cell<f64>,
}

impl Allowance {
    /// The allowance of every closed form.
    pub(crate) fn usual() -> Self {
        Self::of(MOST_LOOKUPS)
    }

    /// An allowance of `most` look-ups.
    pub(crate) fn of(most: f64) -> Self {
        Self { most, spent: Cell::new(0.0) }
    }

    /// Takes look-ups that are being made.
    pub(crate) fn spend(&self, lookups: f64) {
        self.spent.set(self.spent.get() + lookups);
    }

    /// True where so many look-ups more are within the allowance.
    pub(crate) fn has(&self, lookups: f64) -> bool {
        self.spent.get() + lookups <= self.most
    }

    /// The moment that is not reached, with the look-ups that were made for it and those below.
    pub(crate) fn unreached(&self, moment: u32) -> Unreached {
        Unreached { moment, lookups: self.spent.get() }
    }

    /// `tolerance` with no more panels than are affordable, where a node takes `each` look-ups and there are `panels` already; `None`
    /// where their nodes alone are too many.
    ///
    /// A refinement ends with at most twice the panels that it may have, after sampling each of them at most twice and evaluating
    /// integrands at most six times as often as it may have nodes (`Tolerance::most_panels`).
    pub(crate) fn tolerance(&self, tolerance: Tolerance, each: f64, panels: usize) -> Option<Tolerance> {
        if !self.has(NODES * panels as f64 * each) {
            return None;
        }
        let affordable = (self.most - self.spent.get()) / (NODES * (4.0 * each + 6.0));
        Some(Tolerance { most_panels: tolerance.most_panels.min(affordable as usize), ..tolerance })
    }

    /// The integral over [0, 1] of an integrand that takes `each` look-ups; `None` where it is not affordable. One that has not converged
    /// has its error.
    pub(crate) fn integral<const K: usize>(
        &self,
        breaks: &[f64],
        tolerance: Tolerance,
        each: f64,
        integrand: impl Fn(f64) -> [f64; K],
    ) -> Option<Integral<K>> {
        // That without borders is the first of all.
        let panels = breaks.len() + 1 + usize::from(!breaks.is_empty());
        let tolerance = self.tolerance(tolerance, each, panels)?;
        Some(adaptive_integral(1.0, breaks, tolerance, |u| {
            self.spend(each);
            integrand(u)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A jump in each of 97 stretches, none at a border of panels.
    fn rough(u: f64) -> [f64; 1] {
        [if (97.0 * u).fract() < 0.317 { 1.0 } else { 0.0 }]
    }

    #[test]
    fn quadratures_share_what_there_is_and_never_take_more() {
        let tight = Tolerance::TIGHT;
        let first = Allowance::of(1e9).integral(&[], tight, 1.0, rough).unwrap();
        assert!(first.converged);
        for (most, each) in [(3e4, 1.0), (1e6, 40.0), (1e5, 1.0)] {
            let allowance = Allowance::of(most);
            let mut taken = 0;
            while let Some(integral) = allowance.integral(&[0.5], tight, each, rough) {
                // What is not exact says so.
                assert!(integral.converged || integral.error[0] > (integral.value[0] - first.value[0]).abs());
                taken += 1;
                assert!(taken < 100_000 && allowance.has(0.0), "{most}: {allowance:?}");
            }
            assert!(taken > 1 && !allowance.has(63.0 * each));
            assert_eq!(allowance.unreached(2), Unreached { moment: 2, lookups: allowance.spent.get() });
        }
    }

    #[test]
    fn what_is_not_affordable_is_not_begun() {
        let allowance = Allowance::of(1e3);
        let breaks: Vec<f64> = (1..100).map(|i| f64::from(i) / 100.0).collect();
        assert!(allowance.integral(&breaks, Tolerance::TIGHT, 1.0, rough).is_none());
        assert!(allowance.has(1e3) && !allowance.has(1001.0));
        assert!(allowance.integral(&[], Tolerance::TIGHT, 1.0, |u| [u]).unwrap().converged);
        assert!(!allowance.has(1e3));
    }
}
