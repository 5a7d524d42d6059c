//! Panels with cached values at their nodes, and adaptive integration over them.
//!
//! Fields and integrands are asked through pointers: quadrature is cold, and there are hundreds of integrands.

use super::rule::{NODES, PanelIntegral, RULE};

/// Accuracy that an integral must have, and the cost that it may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Allowed absolute error.
    pub absolute: f64,
    /// Allowed error relative to the integral.
    pub relative: f64,
    /// Panels beyond which refinement gives up and reports the error that is left; 21 evaluations each. Going over all of them once per
    /// round, it also gives up when it has gone over four times as many: a second or less, whatever is asked.
    pub most_panels: usize,
}

impl Tolerance {
    /// 10^-12 relative or absolute, whichever is larger, within 2^18 panels.
    pub const TIGHT: Self = Self { absolute: 1e-12, relative: 1e-12, most_panels: 1 << 18 };

    /// The same bound on the cost with another exactness.
    #[must_use]
    pub const fn to(error: f64) -> Self {
        Self { absolute: error, relative: error, most_panels: 1 << 18 }
    }
}

/// The integrals of K functions, with their errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral<const K: usize> {
    /// The integrals.
    pub value: [f64; K],
    /// Estimates of their absolute errors, infinite where an integrand was not finite.
    pub error: [f64; K],
    /// True if all errors are within the tolerance.
    pub converged: bool,
}

/// One panel and what was sampled at its nodes.
#[derive(Clone, Debug)]
pub(super) struct Panel<T> {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) values: [T; NODES],
}

impl<T> Panel<T> {
    fn sampled(from: f64, to: f64, sample: &dyn Fn(f64) -> T) -> Self {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        Self { from, to, values: std::array::from_fn(|i| sample(middle + half * RULE.nodes[i])) }
    }

    pub(super) fn half(&self) -> f64 {
        0.5 * (self.to - self.from)
    }

    pub(super) fn node(&self, i: usize) -> f64 {
        0.5 * (self.from + self.to) + self.half() * RULE.nodes[i]
    }

    /// The function values of `integrand` at the nodes, one row per component.
    pub(super) fn rows<const K: usize>(
        &self,
        integrand: &dyn Fn(usize, f64, &T) -> [f64; K],
    ) -> [[f64; NODES]; K] {
        let mut rows = [[0.0; NODES]; K];
        for i in 0..NODES {
            let values = integrand(i, self.node(i), &self.values[i]);
            for (row, value) in rows.iter_mut().zip(values) {
                row[i] = value;
            }
        }
        rows
    }

    pub(super) fn integrals<const K: usize>(
        &self,
        integrand: &dyn Fn(usize, f64, &T) -> [f64; K],
    ) -> [PanelIntegral; K] {
        self.rows(integrand).map(|row| RULE.integrate(&row, self.half()))
    }
}

/// The integrals of K functions over each panel.
type Integrals<const K: usize> = Vec<[PanelIntegral; K]>;

/// A partition of `[0, length]` that only ever becomes finer.
#[derive(Clone, Debug)]
pub(super) struct Panels<T> {
    pub(super) panels: Vec<Panel<T>>,
}

/// Halvings after which a panel is no longer split: its width is below the rounding of the nodes.
const MOST_ROUNDS: usize = 60;

impl<T> Panels<T> {
    pub(super) fn new(length: f64, breakpoints: &[f64], sample: &dyn Fn(f64) -> T) -> Self {
        let mut panels = Self { panels: Vec::new() };
        if length > 0.0 {
            panels.panels.push(Panel::sampled(0.0, length, sample));
            panels.split_at(breakpoints, sample);
        }
        panels
    }

    /// Makes each of `points` a border between panels; points outside the partition are ignored.
    pub(super) fn split_at(&mut self, points: &[f64], sample: &dyn Fn(f64) -> T) {
        let mut points = points.to_vec();
        points.sort_unstable_by(f64::total_cmp);
        points.dedup();
        let mut points = points.into_iter().peekable();
        let mut split = Vec::with_capacity(self.panels.len() + points.len());
        for panel in self.panels.drain(..) {
            while points.next_if(|&point| point <= panel.from).is_some() {}
            let mut from = panel.from;
            while let Some(point) = points.next_if(|&point| point < panel.to) {
                split.push(Panel::sampled(from, point, sample));
                from = point;
            }
            split.push(if from == panel.from { panel } else { Panel::sampled(from, panel.to, sample) });
        }
        self.panels = split;
    }

    /// Integrates each component of `integrand`, refining the partition until all errors are within `tolerance`.
    pub(super) fn integrate<const K: usize>(
        &mut self,
        sample: &dyn Fn(f64) -> T,
        tolerance: Tolerance,
        integrand: &dyn Fn(f64, &T) -> [f64; K],
    ) -> Integral<K> {
        self.refine(sample, tolerance, &|panels| {
            panels.iter().map(|panel| panel.integrals(&|_, s, value| integrand(s, value))).collect()
        })
    }

    /// Integrates as [`integrate`](Self::integrate), by parts: those between 0, the `ends` in increasing order and infinity. The integrand
    /// is told the index of its part. The value of each part, and the total.
    pub(super) fn integrate_parts<const K: usize>(
        &mut self,
        sample: &dyn Fn(f64) -> T,
        tolerance: Tolerance,
        ends: &[f64],
        integrand: &dyn Fn(usize, f64, &T) -> [f64; K],
    ) -> (Vec<[f64; K]>, Integral<K>) {
        self.split_at(ends, sample);
        let parts = |panels: &[Panel<T>]| {
            let mut part = 0;
            let mut part_of = |panel: &Panel<T>| {
                while ends.get(part).is_some_and(|&end| end <= panel.from) {
                    part += 1;
                }
                part
            };
            panels.iter().map(&mut part_of).collect::<Vec<_>>()
        };
        let integrals = |panels: &[Panel<T>]| -> Vec<_> {
            let of_part =
                |(panel, part): (&Panel<T>, usize)| panel.integrals(&|_, s, value| integrand(part, s, value));
            panels.iter().zip(parts(panels)).map(of_part).collect()
        };
        let total = self.refine(sample, tolerance, &integrals);
        let mut values = vec![[0.0; K]; ends.len()];
        for (part, integral) in parts(&self.panels).into_iter().zip(integrals(&self.panels)) {
            // Rounding may leave a last end short of the length; what is beyond belongs to the last part.
            if let Some(value) = values.get_mut(part.min(ends.len().saturating_sub(1))) {
                for (value, of_panel) in value.iter_mut().zip(integral) {
                    *value += of_panel.value;
                }
            }
        }
        (values, total)
    }

    /// Refines until also the running integral inside every panel is within `tolerance`.
    pub(super) fn settle<const K: usize>(
        &mut self,
        sample: &dyn Fn(f64) -> T,
        tolerance: Tolerance,
        integrand: &dyn Fn(f64, &T) -> [f64; K],
    ) {
        self.refine(sample, tolerance, &|panels| {
            let running = |panel: &Panel<T>| {
                panel
                    .rows(&|_, s, value| integrand(s, value))
                    .map(|row| RULE.integrate_running(&row, panel.half()))
            };
            panels.iter().map(running).collect()
        });
    }

    /// Rounds of: integrate every panel, add up, halve the panels whose error is too large a share of the whole.
    ///
    /// A panel is split when its error exceeds `tolerance / (2 · number of panels)`; those left unsplit then add up to
    /// at most half of the tolerance.
    pub(super) fn refine<const K: usize>(
        &mut self,
        sample: &dyn Fn(f64) -> T,
        tolerance: Tolerance,
        integrate: &dyn Fn(&[Panel<T>]) -> Integrals<K>,
    ) -> Integral<K> {
        let most_work = self.panels.len().max(tolerance.most_panels).saturating_mul(4);
        let mut work = 0;
        for round in 0.. {
            let integrals = integrate(&self.panels);
            work += self.panels.len();
            let (total, allowed) = add_up(&integrals, tolerance);
            if total.converged
                || round == MOST_ROUNDS
                || self.panels.len() >= tolerance.most_panels
                || work >= most_work
                || total.error.iter().any(|error| !error.is_finite())
            {
                return total;
            }
            let share = 0.5 / self.panels.len() as f64;
            let mut refined = Vec::with_capacity(self.panels.len() * 5 / 4);
            for (panel, integral) in self.panels.drain(..).zip(&integrals) {
                let middle = 0.5 * (panel.from + panel.to);
                let too_coarse = integral.iter().zip(&allowed).any(|(i, allowed)| i.error > share * allowed);
                if too_coarse && panel.from < middle && middle < panel.to {
                    refined.push(Panel::sampled(panel.from, middle, sample));
                    refined.push(Panel::sampled(middle, panel.to, sample));
                } else {
                    refined.push(panel);
                }
            }
            self.panels = refined;
        }
        unreachable!("the rounds are bounded")
    }
}

/// The totals, and the error that each component may have.
fn add_up<const K: usize>(integrals: &[[PanelIntegral; K]], tolerance: Tolerance) -> (Integral<K>, [f64; K]) {
    let mut total = Integral { value: [0.0; K], error: [0.0; K], converged: true };
    let mut allowed = [0.0; K];
    for k in 0..K {
        let value = compensated_sum(integrals.iter().map(|panel| panel[k].value));
        let error: f64 = integrals.iter().map(|panel| panel[k].error).sum();
        let magnitude: f64 = integrals.iter().map(|panel| panel[k].magnitude).sum();
        // No request is finer than what rounding leaves of an integrand of this magnitude.
        let rounding = 20.0 * f64::EPSILON * magnitude;
        allowed[k] = tolerance.absolute.max(tolerance.relative * value.abs()).max(rounding);
        total.value[k] = value;
        total.error[k] = if error.is_finite() && value.is_finite() { error } else { f64::INFINITY };
        total.converged &= total.error[k] <= allowed[k];
    }
    (total, allowed)
}

/// Neumaier's sum: tens of thousands of panels lose no digits.
pub(crate) fn compensated_sum(terms: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut carry) = (0.0_f64, 0.0);
    for term in terms {
        let next = sum + term;
        carry += if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
        sum = next;
    }
    if carry.is_finite() { sum + carry } else { sum }
}
