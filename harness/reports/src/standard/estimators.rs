//! The table of all estimators: variance, look-ups and efficiency of each with usual parameters.

use super::effort::{COUNTED, samples_to_test};
use super::lines::Line;
use super::result::EstimatorRow;
use super::sweep::{known_variance, log10_relative_mse, measured, samples_needed};
use super::{Effort, Run, Subject};
use fairflight_harness::Failure;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::plan::Plan;

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

#[cfg(test)]
mod tests {
    use super::super::laws::SharedLaws;
    use super::super::result::Series;
    use super::super::{findings, lines, run_for_tests, subject};
    use super::*;
    use fairflight_harness::comparison::{Bout, TestRay, entrants, facts_of, fight};
    use fairflight_harness::field::MediumLibrary;
    use fairflight_harness::volume::Volume;
    use fairflight_media::Medium;

    /// Variance times look-ups of ratio tracking over those of an entrant, as advice finds it, and its relative standard error; `pilots` is the
    /// seed of the pilots that a choice is made from.
    fn gain(ray: &TestRay, name: &str, pilots: u64) -> (f64, f64) {
        let facts = facts_of(ray, pilots);
        let bout = |name: &str| -> Bout {
            let entrant = entrants().into_iter().find(|entrant| entrant.name == name).unwrap();
            let effort =
                fairflight_harness::comparison::Effort { samples: 8192, counted: 1024, closed: false };
            fight(ray, &entrant.on(ray, &facts).unwrap(), effort, 6).unwrap()
        };
        let (ours, theirs) = (bout(name), bout("ratio tracking"));
        let price = |bout: &Bout| bout.relative_variance * bout.lookups;
        let error = |bout: &Bout| bout.variance_error / bout.measured_variance;
        (price(&theirs) / price(&ours), error(&ours).hypot(error(&theirs)))
    }

    #[test]
    fn advice_agrees_on_the_same_ray_and_differs_by_the_majorant() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/fixtures/cloud.vdb").into();
        let volume = Volume { file, grid: None, scale: 1.0 };
        let subject = subject::volume(&volume, &MediumLibrary::default()).unwrap();
        let (run, laws) = (run_for_tests(), SharedLaws::of(&subject));
        let (lines, _) = lines::all(&run, &subject, &laws, &[]).unwrap();
        let found = findings::of(&subject, &[], &rows(&run, &subject, &lines).unwrap());
        let best = &found.per_lookup[0];
        assert!(matches!(best.series, Series::Entrant(_)));
        let off = |ray: &TestRay| {
            let (gain, error) = gain(ray, best.series.label(), run.seed("lines/vdb/facts"));
            (gain.ln() - best.gain.unwrap().ln()).abs() / error
        };
        let same = off(&subject.ray(subject.majorant));
        assert!(same < 4.0, "{same} standard errors apart on the same ray");
        let whole = subject.medium.upper_bound().unwrap();
        assert!(whole > 2.0 * subject.majorant);
        let other = off(&subject.ray(whole));
        assert!(other > 6.0, "only {other} standard errors apart below the majorant of the whole volume");
    }
}
