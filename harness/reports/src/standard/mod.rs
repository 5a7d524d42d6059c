//! The standard report: szirmay-kalos-2017's curves, figures and claims, measured again, and all estimators beside them.
//!
//! One file per study. A study takes a `Subject` (a medium and a ray) and fills its part of the [`Report`], which is all of
//! `results.json`; [`document`] words it. Points run in parallel, each from a seed of its own name: every number but the times is the same on
//! any number of threads.

mod anatomy;
mod claims;
mod convergence;
mod document;
mod effort;
mod estimators;
mod findings;
mod functions;
mod images;
mod interval;
mod laws;
mod lines;
mod marching;
mod maximum;
mod optimum;
mod preparation;
mod result;
mod series;
mod subject;
mod sweep;
mod walk;

#[cfg(test)]
mod fixture;

pub(super) use result::{Series, StabilityRow};

use super::run::{Finished, Run};
use super::stability::stability;
use effort::Effort;
use fairflight_harness::Failure;
use laws::SharedLaws;
use optimum::CurveOptima;
use result::{MediumReport, Report};
use series::Entry;
use subject::Subject;

const TITLE: &str = "Transmittance estimators, measured against their closed forms";

/// Measures the report, on the threads of the current pool.
///
/// # Errors
/// If the volume cannot be read or studied, or an estimator met a look-up that it does not admit.
pub(crate) fn study(run: &Run<'_>) -> Result<Finished, Failure> {
    let mut subjects = vec![subject::analytic(&run.media)?, subject::perlin(&run.media)?];
    if let Some(volume) = &run.options.vdb {
        subjects.push(subject::volume(volume, &run.media)?);
    }
    let effort = Effort::of(run.options.quick);
    let laws: Vec<SharedLaws> = subjects.iter().map(SharedLaws::of).collect();
    let mut swept = Vec::new();
    for (subject, laws) in subjects.iter().zip(&laws) {
        swept.push(series::all(subject, laws)?);
    }
    let points: usize = swept.iter().map(|entries| entries.len() * effort.sweep_points).sum();
    let rows = (fairflight_harness::comparison::entrants().len()
        + fairflight_harness::comparison::others().len())
        * subjects.len();
    run.expect((points + rows) as u64 + images::steps() * subjects.len() as u64 + claims::steps());

    let mut media = Vec::with_capacity(subjects.len());
    let mut pictures = Vec::new();
    for ((subject, laws), entries) in subjects.iter().zip(&laws).zip(&swept) {
        media.push(medium(run, subject, laws, entries)?);
        pictures.extend(images::studies(run, subject, effort.resolution)?);
    }
    let claims = claims::ledger(run, &subjects, &media, &pictures)?;
    let stability = stability(run.options.seed);
    let unsound = findings::unsound(&media, &stability);
    let document = run.document(TITLE);
    let report = Report {
        provenance: document.provenance.clone(),
        quick: document.quick,
        seconds: document.seconds,
        threads: document.threads,
        media,
        images: pictures,
        claims,
        stability,
        unsound,
    };
    let results = fairflight_document::json(&report)
        .map_err(|error| Failure::refused(format!("report standard: {error}")))?;
    Ok(Finished { document: document::of(&report, document), results })
}

fn medium(
    run: &Run<'_>,
    subject: &Subject,
    laws: &SharedLaws,
    entries: &[Entry],
) -> Result<MediumReport, Failure> {
    let sweeps = sweep::curves(run, subject, laws, entries)?;
    let (lines, refused) = lines::all(run, subject, laws, &sweeps)?;
    let estimators = estimators::rows(run, subject, &lines)?;
    Ok(MediumReport {
        id: subject.id.to_owned(),
        title: subject.title.clone(),
        description: subject.description.clone(),
        ray: subject.facts.clone(),
        convergence: convergence::curves(run, subject, &lines)?,
        anatomy: anatomy::of(run, subject, laws)?,
        functions: functions::of(run, subject, laws)?,
        optima: sweeps.iter().map(CurveOptima::of).collect(),
        findings: findings::of(subject, &sweeps, &estimators),
        sweeps,
        estimators,
        refused,
    })
}

/// A quick run without a bar.
#[cfg(test)]
fn run_for_tests() -> Run<'static> {
    use super::options::Options;
    use crate::command::ReportArguments;
    use fairflight_harness::{Environment, Host};
    let options = Options::of(&ReportArguments { quick: true, seed: 1, ..ReportArguments::default() });
    let environment = Environment::new(&[], Host::default());
    Run::new("standard", Box::leak(Box::new(options)), Box::leak(Box::new(environment)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_harness::field::MediumLibrary;

    /// All that is drawn for the analytic medium, without its times.
    fn drawn(threads: usize) -> String {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let run = run_for_tests();
            let subject = subject::analytic(&MediumLibrary::default()).unwrap();
            let laws = SharedLaws::of(&subject);
            let entries = series::all(&subject, &laws).unwrap();
            let mut medium = medium(&run, &subject, &laws, &entries).unwrap();
            let mut images = images::studies(&run, &subject, Effort::of(true).resolution).unwrap();
            let points = medium.sweeps.iter_mut().flat_map(|curve| &mut curve.points);
            let rows = medium.estimators.iter_mut().map(|row| &mut row.measured);
            for measured in points.filter_map(|point| point.measured.as_mut()).chain(rows) {
                (measured.nanoseconds, measured.log10_efficiency_per_second) = (0.0, None);
            }
            for point in medium.convergence.iter_mut().flat_map(|curve| &mut curve.points) {
                point.seconds = 0.0;
            }
            for panel in images.iter_mut().flat_map(|image| &mut image.panels) {
                panel.seconds = 0.0;
            }
            medium.optima.iter_mut().for_each(|optima| optima.per_second = None);
            medium.findings.per_second.clear();
            format!("{medium:?} {images:?}")
        })
    }

    #[test]
    fn all_numbers_but_times_are_the_same_on_any_number_of_threads() {
        assert_eq!(drawn(1), drawn(3));
    }
}
