//! A wrapper around a medium for the one who measures walks in space: counts look-ups, and remembers what they found.

use crate::{Line, LineThickness, Medium, MediumBreakpoints};
use fairflight_elementary::lanes::{LANES, Lanes};
use glam::DVec3;
use std::cell::Cell;

/// Counts the look-ups of a medium and keeps the range of the values found.
///
/// The conditions of a walk (a majorant that is one, the domain of a version of the single particle model, finite numbers)
/// depend on the greatest and the least σ_t that it met; their price is one comparison each per look-up.
#[derive(Debug)]
pub struct Observed<M> {
    medium: M,
    lookups: Cell<u64>,
    lowest: Cell<f64>,
    highest: Cell<f64>,
    finite: Cell<bool>,
}

impl<M> Observed<M> {
    /// Observes `medium` from here on.
    pub fn new(medium: M) -> Self {
        Self {
            medium,
            lookups: Cell::new(0),
            lowest: Cell::new(f64::INFINITY),
            highest: Cell::new(f64::NEG_INFINITY),
            finite: Cell::new(true),
        }
    }

    /// The number of look-ups so far.
    pub fn lookups(&self) -> u64 {
        self.lookups.get()
    }

    /// The least and the greatest σ_t found so far \[1/length\]; empty (∞, −∞) before the first look-up. NaN is not part of it.
    pub fn range(&self) -> (f64, f64) {
        (self.lowest.get(), self.highest.get())
    }

    /// True if all values found so far were finite.
    pub fn is_finite(&self) -> bool {
        self.finite.get()
    }

    #[cold]
    fn widen(&self, sigma_t: f64) {
        if sigma_t > self.highest.get() {
            self.highest.set(sigma_t);
        }
        if sigma_t < self.lowest.get() {
            self.lowest.set(sigma_t);
        }
        if !sigma_t.is_finite() {
            self.finite.set(false);
        }
    }

    #[cold]
    #[inline(never)]
    fn widen_by_lanes(&self, values: &Lanes, looks_up: &[bool; LANES]) {
        values
            .iter()
            .zip(looks_up)
            .filter(|(_, looks_up)| **looks_up)
            .for_each(|(&value, _)| self.widen(value));
    }

    /// The medium that is observed.
    pub fn medium(&self) -> &M {
        &self.medium
    }
}

impl<M: Medium> Medium for Observed<M> {
    const IS_EMPTY: bool = M::IS_EMPTY;

    fn local(&self, line: Line) -> Line {
        self.medium.local(line)
    }
    #[inline]
    fn sigma_t_local(&self, point: DVec3) -> f64 {
        let sigma_t = self.medium.sigma_t_local(point);
        self.lookups.set(self.lookups.get() + 1);
        // NaN is in no range, and soon nothing else is outside.
        if !(self.lowest.get()..=self.highest.get()).contains(&sigma_t) {
            self.widen(sigma_t);
        }
        sigma_t
    }
    #[inline(always)]
    fn sigma_t_local_lanes(&self, points: &[Lanes; 3]) -> Lanes {
        self.sigma_t_local_where(points, &[true; LANES])
    }
    #[inline(always)]
    fn sigma_t_local_where(&self, points: &[Lanes; 3], looks_up: &[bool; LANES]) -> Lanes {
        let values = self.medium.sigma_t_local_where(points, looks_up);
        let (lowest, highest) = self.range();
        let (mut lookups, mut some_outside) = (0, false);
        for i in 0..LANES {
            lookups += u64::from(looks_up[i]);
            let is_inside = (lowest <= values[i]) & (values[i] <= highest);
            some_outside |= looks_up[i] & !is_inside;
        }
        self.lookups.set(self.lookups.get() + lookups);
        if some_outside {
            self.widen_by_lanes(&values, looks_up);
        }
        values
    }
    fn upper_bound(&self) -> Option<f64> {
        self.medium.upper_bound()
    }
    fn lower_bound(&self) -> Option<f64> {
        self.medium.lower_bound()
    }
}

/// The closed form costs no look-up.
impl<M: LineThickness> LineThickness for Observed<M> {
    fn line_thickness(&self, local: &Line, from: f64, to: f64) -> f64 {
        self.medium.line_thickness(local, from, to)
    }
    #[inline(always)]
    fn everywhere(&self) -> Option<f64> {
        self.medium.everywhere()
    }
}

impl<M: MediumBreakpoints> MediumBreakpoints for Observed<M> {
    fn line_breakpoints(&self, local: &Line, length: f64) -> Vec<f64> {
        self.medium.line_breakpoints(local, length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::AnalyticCosine;

    #[test]
    fn lookups_are_counted_and_the_range_kept() {
        let observed = Observed::new(AnalyticCosine::new(1.0).unwrap());
        let values: Vec<f64> = (0..50).map(|i| observed.sigma_t(DVec3::splat(0.1 * f64::from(i)))).collect();
        assert_eq!(observed.lookups(), 50);
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(0.0, f64::max);
        assert_eq!(observed.range(), (low, high));
        assert!(observed.is_finite());
    }

    #[test]
    fn lanes_that_do_not_look_up_are_not_observed() {
        let (one, lanes) = [(); 2].map(|()| Observed::new(AnalyticCosine::new(1.0).unwrap())).into();
        for k in 0..20 {
            let points = [0.31, -0.17, 0.07].map(|step| std::array::from_fn(|i| step * (16 * k + i) as f64));
            let looks_up: [bool; LANES] = std::array::from_fn(|i| (i + k) % 3 > 0);
            let found = lanes.sigma_t_local_where(&points, &looks_up);
            for i in (0..LANES).filter(|&i| looks_up[i]) {
                let point = DVec3::new(points[0][i], points[1][i], points[2][i]);
                assert_eq!(found[i].to_bits(), one.sigma_t_local(point).to_bits());
            }
            assert_eq!((lanes.lookups(), lanes.range()), (one.lookups(), one.range()));
        }
    }

    #[test]
    fn a_nan_is_remembered() {
        struct Hole;
        impl Medium for Hole {
            fn sigma_t_local(&self, point: DVec3) -> f64 {
                if point.x > 1.0 { f64::NAN } else { 1.0 }
            }
            fn upper_bound(&self) -> Option<f64> {
                None
            }
            fn lower_bound(&self) -> Option<f64> {
                None
            }
        }
        let observed = Observed::new(Hole);
        observed.sigma_t(DVec3::splat(2.0));
        observed.sigma_t(DVec3::ZERO);
        assert!(!observed.is_finite());
        assert_eq!(observed.range(), (1.0, 1.0));
    }
}
