//! The answer: a recommendation with its reasons, as JSON and as a table.

use crate::comparison::{Bout, Entrant, Facts, Gain, RaySet};
use crate::result::Provenance;
use crate::table::digits;
use serde::Serialize;
use serde_json::Value;

/// The answer.
#[derive(Debug, Serialize)]
pub(super) struct Answer {
    /// The medium that was asked about.
    medium: String,
    /// Rays that meet something.
    rays: usize,
    /// The majorant that estimators were given \[1/length\].
    majorant: f64,
    /// The mean of σ_t over the rays \[1/length\].
    mean_extinction: f64,
    /// The estimator with the least variance times look-ups.
    recommended: String,
    /// The one with the least variance times seconds, on this machine.
    fastest: String,
    /// The best few, measured, most efficient per look-up first; ratio tracking among them.
    measured: Vec<Advice>,
    /// Every estimator by what was expected of it, cheapest first.
    expected: Vec<Contestant>,
    /// Seed, revision and command that the numbers come from.
    provenance: Provenance,
    /// Rays whose reference is not certified: told to a person.
    #[serde(skip)]
    uncertified: usize,
}

/// A measured estimator.
#[derive(Debug, Serialize)]
pub(super) struct Advice {
    estimator: &'static str,
    /// The estimator as an experiment takes it, for the ray in the middle by optical thickness.
    spec: Option<Value>,
    /// Look-ups of one estimate.
    lookups: Spread,
    /// Standard error of one estimate over the transmittance.
    relative_standard_error: Spread,
    pub(super) gain_per_lookup: Advantage,
    gain_per_second: Advantage,
}

/// Spread of a quantity over the rays.
#[derive(Clone, Copy, Debug, Serialize)]
struct Spread {
    median: f64,
    least: f64,
    greatest: f64,
}

/// Efficiency over that of ratio tracking: the geometric mean over rays, its 95 % interval over the choice of rays, the worst ray.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Advantage {
    pub(super) value: f64,
    interval: [f64; 2],
    worst: f64,
}

/// An estimator that was considered.
#[derive(Debug, Serialize)]
pub(super) struct Contestant {
    pub(super) estimator: &'static str,
    /// Variance times look-ups over T², geometric mean over rays.
    pub(super) price: f64,
    pub(super) how: How,
}

/// Source of a price.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum How {
    /// The price by closed forms and a pilot of each ray.
    Forecast,
    /// The price by a few estimates on a few rays.
    Trial,
}

impl From<Gain> for Advantage {
    fn from(Gain { mean, interval, worst, .. }: Gain) -> Self {
        Self { value: mean, interval, worst }
    }
}

impl Spread {
    fn of(mut values: Vec<f64>) -> Self {
        values.sort_unstable_by(f64::total_cmp);
        Self { median: values[values.len() / 2], least: values[0], greatest: values[values.len() - 1] }
    }
}

impl Advice {
    pub(super) fn of(
        entrant: &Entrant,
        bouts: &[Bout],
        (per_lookup, per_second): (Gain, Gain),
        set: &RaySet,
        facts: &[Facts],
    ) -> Self {
        let mut by_thickness: Vec<usize> = (0..set.rays.len()).collect();
        let thickness = |i: usize| set.rays[i].truth.optical_thickness;
        by_thickness.sort_unstable_by(|&a, &b| thickness(a).total_cmp(&thickness(b)));
        let middle = by_thickness[by_thickness.len() / 2];
        Self {
            estimator: entrant.name,
            spec: entrant.spec(&set.rays[middle], &facts[middle]).map(|spec| spec.written()),
            lookups: Spread::of(bouts.iter().map(|bout| bout.lookups).collect()),
            relative_standard_error: Spread::of(
                bouts.iter().map(|bout| bout.relative_variance.sqrt()).collect(),
            ),
            gain_per_lookup: per_lookup.into(),
            gain_per_second: per_second.into(),
        }
    }
}

impl Answer {
    pub(super) fn new(
        medium: &str,
        set: &RaySet,
        measured: Vec<Advice>,
        expected: Vec<Contestant>,
        provenance: Provenance,
    ) -> Self {
        let best = |of: &dyn Fn(&Advice) -> f64| {
            let best = measured.iter().max_by(|a, b| of(a).total_cmp(&of(b)));
            best.map_or(String::new(), |advice| advice.estimator.to_owned())
        };
        Self {
            medium: medium.to_owned(),
            rays: set.rays.len(),
            majorant: set.rays.first().map_or(0.0, |ray| ray.majorant),
            mean_extinction: set.mean,
            recommended: best(&|advice| advice.gain_per_lookup.value),
            fastest: best(&|advice| advice.gain_per_second.value),
            measured,
            expected,
            provenance,
            uncertified: set.rays.iter().filter(|ray| ray.truth.doubt.is_some()).count(),
        }
    }

    /// The answer for a person.
    pub(super) fn table(&self) -> String {
        let mut table = format!(
            "advice for transmittance along rays, not for pictures\n{}: {} rays, majorant {:.4}, mean extinction {:.4}\nuse {} (per look-up), {} (per second on this machine)\n\n{:<34}{:>9}{:>12}{:>30}{:>12}{:>30}\n",
            self.medium,
            self.rays,
            self.majorant,
            self.mean_extinction,
            self.recommended,
            self.fastest,
            "estimator",
            "look-ups",
            "std.err./T",
            "gain per look-up",
            "worst ray",
            "gain per second",
        );
        let advantage = |gain: &Advantage| {
            format!("{} [{}, {}]", short(gain.value), short(gain.interval[0]), short(gain.interval[1]))
        };
        for advice in &self.measured {
            table.push_str(&format!(
                "{:<34}{:>9}{:>12}{:>30}{:>12}{:>30}\n",
                advice.estimator,
                short(advice.lookups.median),
                short(advice.relative_standard_error.median),
                advantage(&advice.gain_per_lookup),
                short(advice.gain_per_lookup.worst),
                advantage(&advice.gain_per_second),
            ));
        }
        table
    }

    /// The meaning of the columns, and what is not certain.
    pub(super) fn notes(&self) -> String {
        let mut notes = format!(
            "\nmedians over the rays; gain: efficiency over that of ratio tracking, geometric mean with its 95 % interval\n\
             all rays are random and below the majorant of the whole medium, {:.4}; harness report --vdb takes one ray through the middle of a \
             volume, below a majorant of its own, where another estimator may lead\n",
            self.majorant
        );
        if self.uncertified > 0 {
            let (count, rays) = (self.uncertified, self.rays);
            notes.push_str(&format!(
                "the transmittance of {count} of {rays} rays is not certified: features of sigma_t may have been missed there\n"
            ));
        }
        notes
    }
}

/// Three digits.
fn short(value: f64) -> String {
    digits(value, 3)
}
