//! Numerically hard inputs with their exact answers: right, or refused with a clear error.
//!
//! The numbers are those of the project's list of hard cases; several entries of one number are its several values. A case
//! is evaluated deterministically wherever a set-up without variance exists, else by a short seeded run that the law
//! judges.

mod anisotropy;
mod by_kind;
mod collisions;
mod connections;
mod densities;
mod far;
mod heavy_tails;
mod judging;
mod refusals;
mod signed;
mod spectral;
mod thickness;
mod vacuum;
mod voxel_faces;

pub(crate) use by_kind::{Found, Profile, Subject, WATCHED, affordable};
pub use by_kind::{ROWS, SAMPLERS, spared};

use crate::function::{Function, joined};
use fairflight_laws::{CheckResult, Run};

/// Outcome of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Our answer, or the text of the refusal.
    pub ours: String,
    /// True if the answer is as it should be.
    pub passes: bool,
    /// True if the answer is a refusal.
    pub refused: bool,
    /// Result of a judged run: samples, scores, p-values and power. None for a case that is evaluated exactly.
    pub evidence: CheckResult,
}

impl Outcome {
    /// A value against the exact one, to a relative tolerance (absolute for an exact 0).
    fn value(ours: f64, exact: f64, tolerance: f64) -> Self {
        let granted = tolerance * if exact == 0.0 { 1.0 } else { exact.abs() };
        // Equality first: it also covers a tolerance that underflows.
        let passes = ours == exact || (ours - exact).abs() <= granted;
        Self::said(passes, number(ours))
    }

    /// Something else than one value.
    fn said(passes: bool, ours: impl Into<String>) -> Self {
        Self { ours: ours.into(), passes, refused: false, evidence: CheckResult::default() }
    }

    /// A refusal, which is what was wanted.
    fn refusal(text: impl std::fmt::Display) -> Self {
        Self { refused: true, ..Self::said(true, format!("refused: {text}")) }
    }

    /// A run judged by its law.
    fn judged(result: CheckResult, mean: f64) -> Self {
        let z = result.mean_z.map_or(String::new(), |z| format!(", z = {z:.2}"));
        let passes = result.holds == Some(true);
        let ours = if passes { format!("{mean:.6}{z}") } else { format!("{mean:.6}{z}: {}", result.reason) };
        Self { evidence: result, ..Self::said(passes, ours) }
    }
}

/// A number with as many digits as tell it apart.
fn number(value: f64) -> String {
    if value != 0.0 && !(1e-4..1e6).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// A hard case: one row of the stability table.
#[derive(Debug)]
pub struct HardCase {
    /// The number of its row in the list.
    pub number: u32,
    /// Difficulty of the case, with the value; unique together with the number.
    pub title: String,
    /// Estimator of ours that is tried.
    pub estimator: &'static str,
    /// The kinds of estimator, free-flight sampler and integrator that it draws from, by their names.
    pub kinds: Vec<&'static str>,
    /// The exact answer and how it is known.
    pub exact: String,
    /// Deviation from the exact answer that is granted.
    pub tolerance: &'static str,
    /// True if it is made from the table of kinds, and has no set-up of its own.
    pub of_table: bool,
    /// True if a refusal is the right answer, in part at least.
    pub refusal: bool,
    /// N of a judged run; 0 for a deterministic evaluation.
    pub samples: u64,
    function: Function<Outcome>,
}

impl HardCase {
    /// A case without samples, to the tolerance of values that `function` compares.
    fn new(
        number: u32,
        title: impl Into<String>,
        estimator: &'static str,
        (exact, tolerance): (impl Into<String>, &'static str),
        function: impl Fn(Run) -> Outcome + Send + Sync + 'static,
    ) -> Self {
        Self {
            number,
            title: title.into(),
            estimator,
            kinds: Vec::new(),
            exact: exact.into(),
            tolerance,
            of_table: false,
            refusal: false,
            samples: 0,
            function: Function::new(function),
        }
    }

    /// A deterministic case.
    fn deterministic(
        number: u32,
        title: impl Into<String>,
        estimator: &'static str,
        exact: impl Into<String>,
        tolerance: &'static str,
        function: impl Fn() -> Outcome + Send + Sync + 'static,
    ) -> Self {
        Self::new(number, title, estimator, (exact, tolerance), move |_| function())
    }

    /// A case judged over `samples` estimates.
    fn statistical(
        number: u32,
        title: impl Into<String>,
        estimator: &'static str,
        exact: impl Into<String>,
        samples: u64,
        function: impl Fn(Run) -> Outcome + Send + Sync + 'static,
    ) -> Self {
        let tolerance = "the law, at its share of the false alarm";
        Self { samples, ..Self::new(number, title, estimator, (exact, tolerance), function) }
    }

    /// The same, which draws from these kinds.
    fn about(mut self, kinds: impl IntoIterator<Item = &'static str>) -> Self {
        self.kinds.extend(kinds);
        self
    }

    /// Evaluates the case.
    #[must_use]
    pub fn run(&self, run: Run) -> Outcome {
        self.function.run(run)
    }
}

/// The hard cases, by number.
#[must_use]
pub fn hard_cases() -> Vec<HardCase> {
    let mut cases = joined!(
        cases of vacuum, signed, collisions, thickness, voxel_faces, far, refusals,
        heavy_tails, spectral, anisotropy, connections, densities
    );
    let table = by_kind::cases(&cases).into_iter().map(|case| HardCase { of_table: true, ..case });
    cases.extend(table);
    cases.sort_by_key(|case| case.number);
    cases
}

/// A case that builds something unlawful would be a bug of its own.
const LAWFUL: &str = "the hard cases are lawful";
