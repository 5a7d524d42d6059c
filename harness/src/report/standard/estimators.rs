//! The table of all estimators: variance, look-ups and efficiency of each with usual parameters.

use super::effort::{COUNTED, samples_to_test};
use super::lines::Line;
use super::result::EstimatorRow;
use super::sweep::{known_variance, log10_relative_mse, measured, samples_needed};
use super::{Effort, Run, Subject};
use crate::Failure;
use crate::parallel::try_in_parallel;
use crate::plan::Plan;

/// A row for each line.
pub(super) fn rows(run: &Run<'_>, subject: &Subject, lines: &[Line]) -> Result<Vec<EstimatorRow>, Failure> {
    try_in_parallel(lines.len(), &|i| {
        let row = row(run, subject, &lines[i]);
        run.advance();
        row
    })
}

fn row(run: &Run<'_>, subject: &Subject, line: &Line) -> Result<EstimatorRow, Failure> {
    let seconds = Effort::of(run.options.quick).point_seconds;
    let theory = &line.law.theory;
    let nanoseconds = line.lookups * subject.lookup_nanoseconds;
    let samples = samples_to_test(seconds, 2.0 * seconds, nanoseconds, samples_needed(theory));
    let seed = run.seed(format_args!("table/{}/{}", subject.id, line.series.label()));
    let mut plan = Plan::on(subject.profile.clone(), line.spec.clone(), samples, seed)?;
    plan.counted = COUNTED;
    let is_biased = line.spec.is_biased_baseline();
    let measured = measured(&plan, subject, is_biased, &line.law)?;
    let is_closed = known_variance(theory).is_some();
    let log10_mse = if is_closed { log10_relative_mse(theory) } else { measured.relative_variance.log10() };
    let lookups = if theory.lookups.is_finite() {
        theory.lookups + plan.estimator.preparation_lookups as f64
    } else {
        measured.lookups
    };
    Ok(EstimatorRow {
        series: line.series,
        kind: line.kind,
        parameters: line.parameters.clone(),
        is_biased,
        is_oracle: line.is_oracle,
        log10_relative_variance: Some(log10_mse),
        is_closed,
        lookups,
        log10_efficiency_per_lookup: Some(-log10_mse - lookups.log10()).filter(|x| x.is_finite()),
        measured,
    })
}
