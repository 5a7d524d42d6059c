//! Estimators of transmittance in the catalogue, a file and a line each: the laws that one keeps, realistic mistakes that the same laws
//! reject, and how hard cases make one.

mod in_cells;
mod on_profile;
mod on_specimen;
mod profiles;

use crate::checks::Check;
use crate::hard_cases::Subject;
use crate::twins::Twin;
pub(crate) use on_specimen::add;

/// Checks that a function gives for each of these specimens. A macro, because an argument is no generic function.
macro_rules! on_each {
    ($on:ident of $module:ident: $($specimen:ident),+) => {{
        use $crate::estimators::$module::{$($specimen),+};
        let mut checks = Vec::new();
        $(checks.extend($on(&$specimen()));)+
        checks
    }};
}
pub(crate) use on_each;

/// A kind of estimators.
pub(crate) struct Kind {
    /// Its name in specs.
    pub(crate) name: &'static str,
    /// Laws on profiles of its own. Some kinds are tried on every medium instead, by [`crate::checks`].
    checks: fn() -> Vec<Check>,
    /// Realistic mistakes.
    twins: fn() -> Vec<Twin>,
    /// One of each version, for a profile of a hard case.
    subjects: fn() -> Vec<Subject>,
    /// Rows of hard cases that do not concern it, with the reason.
    spared: &'static [(u32, &'static str)],
}

/// Declares the modules of all kinds and lists their entries.
macro_rules! kinds {
    ($($kind:ident),+ $(,)?) => {
        $(pub(crate) mod $kind;)+
        /// All kinds, in the order of a report.
        const KINDS: &[&Kind] = &[$(&$kind::KIND),+];
    };
}

kinds! {
    woodcock,
    double_particle,
    single_particle,
    line_integral,
    ray_marching,
    naive,
    next_flight,
    p_series,
    generalised_poisson,
    adaptive_ratio,
    unbiased_ray_marching,
    telescoping,
    jackknife,
    jittered_ratio,
    residual_cells,
    hybrid,
    regular,
    progressive_majorant,
}

/// Lists the laws of all kinds on profiles of their own.
pub(crate) fn checks() -> Vec<Check> {
    KINDS.iter().flat_map(|kind| (kind.checks)()).collect()
}

/// Lists the wrong twins of all kinds.
pub(crate) fn twins() -> Vec<Twin> {
    KINDS.iter().flat_map(|kind| (kind.twins)().into_iter().map(|twin| twin.about([kind.name]))).collect()
}

/// Estimators of every kind, as the rows of hard cases need them.
pub(crate) fn subjects() -> Vec<Subject> {
    KINDS
        .iter()
        .flat_map(|kind| (kind.subjects)().into_iter().map(|subject| subject.of_kind(kind.name)))
        .collect()
}

/// The reason why `row` does not concern `kind` of estimator; `None` where it does.
pub(crate) fn spared(kind: &str, row: u32) -> Option<&'static str> {
    let found = KINDS.iter().find(|entry| entry.name == kind)?;
    found.spared.iter().find(|(number, _)| *number == row).map(|(_, reason)| *reason)
}

/// True if this is the name of a kind.
pub(crate) fn is_estimator(kind: &str) -> bool {
    KINDS.iter().any(|entry| entry.name == kind)
}
