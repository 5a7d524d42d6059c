//! The integral of a profile with a proof, by bisection.

use super::{Enclosed, Stretch};
use crate::Tolerance;
use crate::quadrature::compensated_sum;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// ∫ σ_t over a profile, what is proved of it, and where the profile was cut for that.
///
/// The stretch whose error can be lowered most is cut again and again: at a kink that it suspects, else in the middle. It ends where the
/// bounds add up to the tolerance or to less than the rounding, or where a budget is spent. What then was proved holds for certain; whether it is
/// enough is [`doubt`](Self::doubt)'s to say.
///
/// The formula is taken at its word over the real numbers, its constants being the doubles that it was parsed into. What a look-up in doubles
/// rounds is not part of the error: it is granted where estimates are judged.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// ∫ σ_t \[1\]; NaN where nothing bounds it.
    pub thickness: f64,
    /// A bound of its error, rounding included; infinite where none is proved.
    pub error: f64,
    /// Lower and upper bound of ∫ σ_t \[1\]; infinite where nothing is proved.
    pub bounds: (f64, f64),
    /// Lower and upper bound of σ_t \[1/length\]; infinite where nothing is proved.
    pub range: (f64, f64),
    /// Distances at which the profile was cut \[length\], in increasing order: between two of these σ_t is smooth and resolved, or its
    /// part in the integral is within the error. A cut of no more than some roundings on either side of a kink is given once.
    pub borders: Vec<f64>,
    /// Arithmetic operations that it took.
    pub cost: u64,
    doubt: Option<Doubt>,
}

/// Reason why the thickness of a profile is not certified.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Doubt {
    /// The budget was spent before the bounds met.
    #[error(
        "features of sigma_t may have been missed: the budget of {budget:e} operations was spent with the optical thickness proved between \
         {low} and {high} only"
    )]
    Budget {
        /// Operations that were allowed.
        budget: u64,
        /// Lower bound of ∫ σ_t \[1\].
        low: f64,
        /// Upper bound of ∫ σ_t \[1\].
        high: f64,
    },
    /// No bound of σ_t was found around some point.
    #[error(
        "no bound of sigma_t is proved around s = {at}: what it does there is known from its values at nodes only"
    )]
    Unbounded {
        /// The distance from the start of the profile.
        at: f64,
    },
}

/// Arithmetic operations that a certificate may take: some hundred milliseconds.
pub(super) const BUDGET: u64 = 30_000_000;

/// A relative error of the thickness (absolute below 1) up to which it counts as certified. It enters every verdict as it is.
const ENOUGH: f64 = 1e-6;

/// Stretches below this part of the profile are not cut again: a few spacings of doubles at its end.
const THIN: f64 = 8.0 * f64::EPSILON;

/// Stretches without a bound are not cut below this part of the profile: a pole stays one.
const FINEST_UNBOUNDED: f64 = 1e-12;

/// A stretch in the queue, ordered by what cutting it can gain.
pub(super) struct Open {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) stretch: Stretch,
}

impl Open {
    pub(super) fn new(field: &(impl Enclosed + ?Sized), from: f64, to: f64) -> Self {
        Self { from, to, stretch: field.enclose(from, to) }
    }

    /// Greatest gain of cutting the stretch, its truncation \[1\]: infinite where σ_t may have no value.
    fn gain(&self) -> f64 {
        if self.stretch.may_be_undefined { f64::INFINITY } else { self.stretch.truncation }
    }

    fn is_unbounded(&self) -> bool {
        !self.stretch.truncation.is_finite()
    }

    /// Distances to cut at: on both sides of a kink, so near that the next cuts are within rounding of it, or in the middle.
    fn cuts(&self) -> Vec<f64> {
        /// Share of the width: kinks are found to the square of the error that the stretch allows, thus soon to rounding.
        const BESIDE: f64 = 1e-5;
        let (from, to) = (self.from, self.to);
        let inside = |s: &f64| from < *s && *s < to;
        let middle = from + 0.5 * (to - from);
        if let Some(kink) = self.stretch.kink {
            let beside = (BESIDE * (to - from)).max(2.0 * f64::EPSILON * kink.abs());
            let cuts: Vec<f64> = [kink - beside, kink + beside].into_iter().filter(inside).collect();
            if !cuts.is_empty() {
                return cuts;
            }
        }
        std::iter::once(middle).filter(inside).collect()
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Open {}
impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        self.gain().total_cmp(&other.gain()).then((self.to - self.from).total_cmp(&(other.to - other.from)))
    }
}

impl Certificate {
    /// The certificate of a profile, to `tolerance` where its budget allows.
    #[must_use]
    pub fn of(field: &(impl Enclosed + ?Sized), tolerance: Tolerance) -> Self {
        Self::within(field, tolerance, BUDGET)
    }

    /// The same with a budget of its own, in arithmetic operations.
    #[must_use]
    pub fn within(field: &(impl Enclosed + ?Sized), tolerance: Tolerance, budget: u64) -> Self {
        let length = field.length();
        let mut done: Vec<Open> = Vec::new();
        let mut open = BinaryHeap::new();
        let mut known = field.known_borders();
        known.retain(|s| *s > 0.0 && *s < length);
        known.push(length);
        known.sort_unstable_by(f64::total_cmp);
        let mut from = 0.0;
        for to in known {
            if to > from {
                open.push(Open::new(field, from, to));
                from = to;
            }
        }
        let mut sums = Sums::of(open.iter());
        while let Some(worst) = open.pop() {
            if sums.are_within(tolerance) {
                // Thousands of sums and differences: once more from the start.
                sums = sums.again(open.iter().chain([&worst]), done.iter());
                if sums.are_within(tolerance) {
                    done.push(worst);
                    break;
                }
            }
            let spent = sums.cost > budget;
            let finest = if worst.is_unbounded() { FINEST_UNBOUNDED * length } else { 0.0 };
            let width = worst.to - worst.from;
            let cuts = worst.cuts();
            if spent || width <= finest.max(THIN * length) || cuts.is_empty() || worst.gain() == 0.0 {
                sums.close(&worst);
                done.push(worst);
                if spent {
                    break;
                }
                continue;
            }
            sums.remove(&worst);
            let mut from = worst.from;
            for to in cuts.into_iter().chain([worst.to]) {
                let piece = Open::new(field, from, to);
                sums.add(&piece);
                open.push(piece);
                from = to;
            }
        }
        done.extend(open);
        done.sort_unstable_by(|a, b| a.from.total_cmp(&b.from));
        let slack = sums.asked(tolerance) / done.len() as f64;
        let (done, cost) = joined(field, done, THIN * length, slack);
        Self::from_stretches(&done, length, sums.cost + cost, budget)
    }

    fn from_stretches(done: &[Open], length: f64, cost: u64, budget: u64) -> Self {
        let bounded = || done.iter().filter(|open| !open.is_unbounded()).map(|open| &open.stretch);
        let sum = compensated_sum(bounded().map(|stretch| stretch.integral));
        let size: f64 = bounded().map(|stretch| stretch.integral.abs()).sum();
        let errors: f64 = bounded().map(|stretch| stretch.truncation + stretch.rounding).sum();
        // A compensated sum is off by a rounding of itself; the errors are at most so many sums off.
        let count = done.len() as f64;
        let error =
            (errors * (1.0 + count * f64::EPSILON) + 4.0 * f64::EPSILON * size) * (1.0 + 4.0 * f64::EPSILON);
        let unbounded = || done.iter().filter(|open| open.is_unbounded());
        let beside = |of: fn(&Stretch) -> f64| -> f64 {
            unbounded().map(|open| of(&open.stretch) * (open.to - open.from)).sum()
        };
        let bounds = (sum - error + beside(|s| s.low), sum + error + beside(|s| s.high));
        let gap = unbounded().next().map(|open| 0.5 * (open.from + open.to));
        let may_be_undefined =
            |open: &&Open| open.stretch.may_be_undefined && open.to - open.from > THIN * length;
        let gap = gap.or_else(|| done.iter().find(may_be_undefined).map(|open| 0.5 * (open.from + open.to)));
        let thickness = if gap.is_none() { sum } else { f64::NAN };
        let doubt = match gap {
            Some(at) => Some(Doubt::Unbounded { at }),
            None if error <= ENOUGH * sum.abs().max(1.0) => None,
            None => Some(Doubt::Budget { budget, low: bounds.0, high: bounds.1 }),
        };
        let range = done.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), open| {
            (low.min(open.stretch.low), high.max(open.stretch.high))
        });
        Self {
            thickness,
            error: if gap.is_none() { error } else { f64::INFINITY },
            bounds: if bounds.0.is_nan() || bounds.1.is_nan() {
                (f64::NEG_INFINITY, f64::INFINITY)
            } else {
                bounds
            },
            range: if done.is_empty() { (0.0, 0.0) } else { range },
            borders: thinned(borders(done, length), doubt.is_some()),
            cost,
            doubt,
        }
    }

    /// Reason why the thickness is not certified; `None` where it is.
    #[must_use]
    pub fn doubt(&self) -> Option<Doubt> {
        self.doubt
    }
}

/// The stretches without the slivers that cuts beside a kink leave in what is smooth, and what that took: each is joined to the one before or
/// after it if the errors of both do not grow by more than `slack`.
fn joined(field: &(impl Enclosed + ?Sized), stretches: Vec<Open>, thin: f64, slack: f64) -> (Vec<Open>, u64) {
    /// Halvings leave neighbours of similar width.
    const SLIVER: f64 = 1.0 / 64.0;
    let (mut joined, mut cost): (Vec<Open>, u64) = (Vec::with_capacity(stretches.len()), 0);
    for mut next in stretches {
        while let Some(last) = joined.last() {
            let widths = (last.to - last.from, next.to - next.from);
            let sliver =
                widths.0.min(widths.1) < SLIVER * widths.0.max(widths.1) && widths.0.min(widths.1) > thin;
            if !(sliver && last.gain() + next.gain() < f64::INFINITY) {
                break;
            }
            let whole = Open::new(field, last.from, next.to);
            cost += whole.stretch.cost;
            if whole.gain() > last.gain() + next.gain() + slack {
                break;
            }
            joined.pop();
            next = whole;
        }
        joined.push(next);
    }
    (joined, cost)
}

/// The borders of stretches; of those that are thin the middle.
fn borders(done: &[Open], length: f64) -> Vec<f64> {
    let is_thin = |open: &Open| open.to - open.from <= 4.0 * THIN * length;
    let mut borders: Vec<f64> = Vec::new();
    let mut thin: Option<(f64, f64)> = None;
    for open in done {
        if is_thin(open) {
            thin = Some((thin.map_or(open.from, |(from, _)| from), open.to));
            continue;
        }
        borders.push(match thin.take() {
            Some((from, to)) => 0.5 * (from + to),
            None => open.from,
        });
    }
    borders.retain(|border| *border > 0.0);
    borders.dedup();
    borders
}

/// Returns the borders; of a certificate that proves too little only some of them, evenly: quadrature goes on by itself, and its budget is
/// not the certificate's.
fn thinned(borders: Vec<f64>, is_doubtful: bool) -> Vec<f64> {
    const MOST: usize = 1 << 13;
    let step = if is_doubtful { borders.len().div_ceil(MOST).max(1) } else { 1 };
    borders.into_iter().step_by(step).collect()
}

/// Operations that a stretch costs at least: it is cut, sorted and kept, even where its bounds are a constant.
const LEAST_COST: u64 = 16;

/// Errors and costs so far.
struct Sums {
    integral: f64,
    gain: f64,
    rounding: f64,
    /// Stretches that are not bounded, or may have no value, and can still be cut.
    unknown: usize,
    cost: u64,
}

impl Sums {
    fn of<'a>(all: impl Iterator<Item = &'a Open>) -> Self {
        let mut sums = Self { integral: 0.0, gain: 0.0, rounding: 0.0, unknown: 0, cost: 0 };
        all.for_each(|open| sums.add(open));
        sums
    }

    /// The same of stretches that are open and done, without what the differences have rounded.
    fn again<'a>(self, open: impl Iterator<Item = &'a Open>, done: impl Iterator<Item = &'a Open>) -> Self {
        let mut sums = Self::of(open);
        for closed in done {
            sums.add(closed);
            sums.close(closed);
        }
        Self { cost: self.cost, ..sums }
    }

    fn add(&mut self, open: &Open) {
        self.cost += open.stretch.cost.max(LEAST_COST);
        if open.gain().is_finite() {
            self.gain += open.gain();
            self.integral += open.stretch.integral;
            self.rounding += open.stretch.rounding;
        } else {
            self.unknown += 1;
        }
    }

    fn remove(&mut self, open: &Open) {
        if open.gain().is_finite() {
            self.gain -= open.gain();
            self.integral -= open.stretch.integral;
            self.rounding -= open.stretch.rounding;
        } else {
            self.unknown -= 1;
        }
    }

    /// A stretch that is not cut again: what it does not know will stay so.
    fn close(&mut self, open: &Open) {
        if open.gain().is_finite() {
            self.gain -= open.gain();
            self.rounding += open.gain();
        } else {
            self.unknown -= 1;
        }
    }

    /// True if the bounds are good enough, or no better than rounding.
    fn are_within(&self, tolerance: Tolerance) -> bool {
        self.unknown == 0 && self.gain <= self.asked(tolerance).max(self.rounding)
    }

    /// Limit of the sum of errors \[1\]: half the tolerance, the other half being left to rounding.
    fn asked(&self, tolerance: Tolerance) -> f64 {
        0.5 * tolerance.absolute.max(tolerance.relative * self.integral.abs())
    }
}
