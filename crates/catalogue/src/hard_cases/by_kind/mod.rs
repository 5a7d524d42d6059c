//! The table of hard cases: every kind of estimator, free-flight sampler and integrator in every row, or the reason why not.
//!
//! A row that has a case of its own for a kind is met by that. All others are made here, from what each kind says of itself.

mod ends;
mod flights;
mod integrators;
mod profile;
mod rows;
mod spared;
mod spectral;

use super::{HardCase, Outcome};
use ends::{End, at_the_ends};
use fairflight_laws::{CheckResult, Run};
use fairflight_sources::derive_seed;
use rows::{Row, Setting};
use std::collections::BTreeSet;

pub(crate) use profile::Profile;
pub use spared::{ROWS, SAMPLERS, spared};

/// The result of one subject on one profile.
pub(crate) struct Found {
    /// The judgement of the law.
    pub(crate) result: CheckResult,
    /// The refusal, if it is one.
    pub(crate) refused: Option<String>,
}

/// An estimator or a sampler of free flights, as the rows need it.
pub(crate) struct Subject {
    /// Kind of the estimator or sampler.
    pub(crate) kind: &'static str,
    /// Name among those of the same kind.
    name: &'static str,
    /// True if it admits σ_t above the majorant that a profile claims.
    above: bool,
    /// True if it admits σ_t below 0.
    below: bool,
    /// Selects the profiles that it is tried on: some have laws or look-ups too dear to evaluate.
    is_tried: fn(&Profile) -> bool,
    /// Judges a run by the law on a profile.
    examine: fn(&Profile, Run) -> Found,
    /// Finds the refusals among its look-ups.
    watch: fn(&Profile) -> Found,
    /// Draws once; true if the result is finite and lawful.
    draw: fn(&Profile, &mut End) -> bool,
}

impl Subject {
    /// A subject that is tried on all profiles.
    pub(crate) fn new(
        (kind, name): (&'static str, &'static str),
        (above, below): (bool, bool),
        examine: fn(&Profile, Run) -> Found,
        watch: fn(&Profile) -> Found,
        draw: fn(&Profile, &mut End) -> bool,
    ) -> Self {
        Self { kind, name, above, below, is_tried: |_| true, examine, watch, draw }
    }

    /// The same, of this kind.
    pub(crate) fn of_kind(self, kind: &'static str) -> Self {
        Self { kind, ..self }
    }

    /// The same, tried on these profiles only.
    pub(crate) fn tried_where(self, is_tried: fn(&Profile) -> bool) -> Self {
        Self { is_tried, ..self }
    }

    /// True if the only right answer is a refusal.
    fn refuses(&self, setting: &Setting) -> bool {
        match setting {
            Setting::Lawful => false,
            Setting::Above => !self.above,
            Setting::Below => !self.below,
            Setting::Broken => true,
        }
    }
}

/// N, seed and level of a run that is to be refused, and judged by nothing.
pub(crate) const WATCHED: Run = Run { samples: 2_000, seed: 15, alpha: 1e-6 };

/// Look-ups on one profile: an answer is to be right, not precise.
const BUDGET: f64 = 4e5;

/// Number of samples that the budget allows, where one costs so many look-ups; 2 at least, `samples` at most.
pub(crate) fn affordable(samples: u64, cost: f64) -> u64 {
    samples.min((BUDGET / cost.max(1.0)) as u64).max(2)
}

/// Estimators and samplers of every kind.
fn subjects() -> Vec<Subject> {
    let mut all = crate::estimators::subjects();
    all.extend(flights::subjects());
    all.extend(spectral::subjects());
    all
}

/// Cases of all kinds and rows that none of `own` is about.
pub(super) fn cases(own: &[HardCase]) -> Vec<HardCase> {
    let kinds: BTreeSet<&'static str> = subjects().iter().map(|subject| subject.kind).collect();
    let mut cases = Vec::new();
    for row in rows::rows() {
        for &kind in &kinds {
            let is_met = own.iter().any(|case| case.number == row.number && case.kinds.contains(&kind));
            if !is_met && spared(kind, row.number).is_none() {
                cases.push(case(row.clone(), kind));
            }
        }
    }
    cases.extend(kinds.into_iter().map(at_the_ends));
    cases.extend(integrators::cases(own));
    cases
}

/// The case of one kind in one row.
fn case(row: Row, kind: &'static str) -> HardCase {
    let subjects: Vec<Subject> = subjects().into_iter().filter(|subject| subject.kind == kind).collect();
    let refuses = |setting| subjects.iter().any(|subject| subject.refuses(setting));
    let refusal = row.settings.iter().any(|(.., setting)| refuses(setting));
    // What is refused whatever the seed draws nothing of its own.
    let is_judged =
        subjects.iter().any(|subject| row.settings.iter().any(|(.., setting)| !subject.refuses(setting)));
    let (number, samples, exact) = (row.number, if is_judged { row.samples } else { 0 }, row.exact);
    let title = format!("{}: {kind}", row.what);
    let case = HardCase::statistical(number, title, kind, exact, samples, move |run| {
        put_through(&row, &subjects, run)
    });
    HardCase { refusal, ..case }.about([kind])
}

/// Evaluates a row, every subject on every profile: each right, or refused where it must be.
fn put_through(row: &Row, subjects: &[Subject], run: Run) -> Outcome {
    let parts: Vec<(&Subject, &str, &Profile, &Setting)> = subjects
        .iter()
        .flat_map(|subject| {
            let tried = row.settings.iter().filter(|(_, profile, _)| (subject.is_tried)(profile));
            tried.map(move |(name, profile, setting)| (subject, name.as_str(), profile, setting))
        })
        .collect();
    if parts.is_empty() {
        return Outcome::said(
            false,
            "tried on no profile of this row: admit one in `tried_where`, or name the row in `spared` with the reason",
        );
    }
    let share = run.alpha / parts.len() as f64;
    let (mut judged, mut refusals, mut wrong, mut untestable) = (Vec::new(), Vec::new(), Vec::new(), 0);
    for (index, (subject, name, profile, setting)) in parts.into_iter().enumerate() {
        let label = format!("{}, {name}", subject.name);
        if subject.refuses(setting) {
            match (subject.watch)(profile).refused {
                Some(text) if text.contains(" at s = ") => refusals.push(text),
                other => wrong.push(format!("{label}: {}", other.as_deref().unwrap_or("not noticed"))),
            }
            continue;
        }
        let seed = derive_seed(run.seed, index as u64);
        let Found { result, .. } = (subject.examine)(profile, Run { seed, alpha: share, ..run });
        match result.holds {
            Some(true) => judged.push((label, result)),
            Some(false) => wrong.push(format!("{label}: {}", result.reason)),
            None => untestable += 1,
        }
    }
    let told = [
        (!judged.is_empty()).then(|| format!("{} right", judged.len())),
        (untestable > 0).then(|| format!("{untestable} not testable at this N")),
        refusals.first().map(|first| format!("{} refused: {first}", refusals.len())),
    ];
    let passes = wrong.is_empty() && told.iter().any(Option::is_some);
    let text =
        if passes { told.into_iter().flatten().collect::<Vec<_>>().join(", ") } else { wrong.join("; ") };
    let refused = passes && !refusals.is_empty();
    Outcome { refused, evidence: CheckResult::of_all(judged), ..Outcome::said(passes, text) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_that_tries_nothing_says_what_to_do() {
        let row = rows::rows().remove(0);
        let shy = |subject: Subject| subject.tried_where(|_| false);
        let subjects: Vec<Subject> = subjects().into_iter().take(2).map(shy).collect();
        let outcome = put_through(&row, &subjects, WATCHED);
        assert!(!outcome.passes && outcome.ours.contains("`spared`"), "{}", outcome.ours);
    }
}
