//! The tolerance of a case, by perturbed runs.

use crate::kinds::Model;
use crate::number::Number;
use crate::run::{Event, Outcome, Run, Use};
use crate::{Arithmetic, Noise, Precision, Profile, Script};

/// Perturbed runs of a case.
const RUNS: u64 = 64;
/// The largest deviation of those, times this.
const MARGIN: f64 = 2.0;
/// Units of the last place that any port is granted.
const LEAST_UNITS: f64 = 4.0;

/// A finished run in doubles.
#[derive(Clone, Debug)]
pub(crate) struct Finished {
    pub(crate) event: Option<Event>,
    pub(crate) values: Vec<f64>,
    pub(crate) uses: Vec<Use>,
    pub(crate) decisions: Vec<bool>,
    /// s, σ_t and the weight behind each look-up.
    pub(crate) trace: Vec<(f64, f64, Option<f64>)>,
}

impl Finished {
    /// Runs a model to its end.
    pub(crate) fn of<A: Arithmetic>(
        model: &impl Model,
        arithmetic: A,
        script: &Script,
        profile: Profile,
    ) -> Self {
        let mut run = Run::new(arithmetic, script, profile);
        let Outcome { event, values } = model.run(&mut run);
        let double = |x: &A::Number| x.to_f64();
        Self {
            event,
            values: values.iter().map(double).collect(),
            trace: run
                .lookups
                .iter()
                .map(|seen| (double(&seen.s), double(&seen.sigma_t), seen.weight.as_ref().map(double)))
                .collect(),
            uses: run.uses,
            decisions: run.decisions,
        }
    }

    /// True where both decided alike.
    pub(crate) fn decides_as(&self, other: &Self) -> bool {
        self.event == other.event
            && self.uses == other.uses
            && self.decisions == other.decisions
            && self.trace.len() == other.trace.len()
    }
}

/// The largest deviation of a right port from the exact run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tolerance {
    /// Of each value.
    pub(crate) values: Vec<f64>,
    /// Of the distance of each look-up \[length\]; `None` of kinds without look-ups.
    pub(crate) s: Option<f64>,
}

impl Tolerance {
    /// The tolerance of cases by hand, which perturbed runs may decide otherwise: twice as many units as any port is granted.
    pub(crate) fn of_a_border(precision: Precision, exact: &Finished) -> Self {
        let units = 2.0 * LEAST_UNITS * precision.unit();
        Self { values: exact.values.iter().map(|value| rounded_up(units * value.abs())).collect(), s: None }
    }

    /// The tolerance at a precision, or `None` where some perturbed run decides otherwise than the exact one.
    pub(crate) fn at(
        precision: Precision,
        model: &impl Model,
        script: &Script,
        profile: Profile,
        exact: &Finished,
    ) -> Option<Self> {
        let mut values = vec![0.0; exact.values.len()];
        let mut s = 0.0_f64;
        for number in 0..RUNS {
            let noise = Noise::new(precision, number);
            let run = Finished::of(model, &noise, script, profile);
            if !run.decides_as(exact) {
                return None;
            }
            for (most, (found, exact)) in values.iter_mut().zip(run.values.iter().zip(&exact.values)) {
                *most = f64::max(*most, (found - exact).abs());
            }
            for (found, exact) in run.trace.iter().zip(&exact.trace) {
                s = s.max((found.0 - exact.0).abs());
            }
        }
        let granted = |deviation: f64, size: f64| {
            rounded_up(f64::max(MARGIN * deviation, LEAST_UNITS * precision.unit() * size.abs()))
        };
        Some(Self {
            values: values.iter().zip(&exact.values).map(|(&off, &exact)| granted(off, exact)).collect(),
            s: (!exact.trace.is_empty()).then(|| granted(s, profile.length())),
        })
    }
}

/// The next number of two decimal digits that is not below, x ≥ 0.
pub(crate) fn rounded_up(x: f64) -> f64 {
    let nearest = format!("{x:.1e}");
    let rounded: f64 = nearest.parse().expect("a number that was just written");
    if rounded >= x {
        return rounded;
    }
    // D.De±N: one more in the last place.
    let (digits, exponent) = nearest.split_once('e').expect("an exponent was asked for");
    let tenths: u32 = digits.replace('.', "").parse().expect("two digits");
    let exponent: i32 = exponent.parse().expect("an exponent");
    format!("{}e{}", tenths + 1, exponent - 1).parse().expect("a number of three digits at most")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_up_to_two_digits() {
        assert_eq!([0.0, 1.0, 0.0123, 9.91e-9, 99.5].map(rounded_up), [0.0, 1.0, 0.013, 1e-8, 100.0]);
    }
}
