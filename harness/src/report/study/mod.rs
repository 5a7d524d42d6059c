//! The measuring half of the standard report: szirmay-kalos-2017's curves, figures and claims, measured again.
//!
//! One file per study. A study takes a `Subject` (a medium and a ray) and fills its part of the
//! [`Report`]. Points run in parallel, each from a seed of its own: every number but the
//! times is the same on any number of threads.

mod anatomy;
mod claims;
mod convergence;
mod effort;
mod functions;
mod images;
mod interval;
mod laws;
mod marching;
mod maximum;
mod options;
mod preparation;
mod series;
mod subject;
mod sweep;
mod walk;

pub use options::Options;

use crate::field::MediumLibrary;
use crate::progress::Progress;
use crate::report::result::{MediumReport, Report};
use crate::{Environment, Failure};
use effort::Effort;
use fairflight_sources::named_seed;
use laws::SharedLaws;
use std::fmt::Display;
use std::time::Instant;
use subject::Subject;

/// Measures the standard report, on the threads of the current pool.
///
/// # Errors
/// If the volume cannot be read or studied, or an estimator met a look-up that it does not admit.
pub fn standard(options: &Options, environment: &Environment) -> Result<Report, Failure> {
    let clock = Instant::now();
    let library = MediumLibrary::default();
    let mut subjects = vec![subject::analytic(&library)?, subject::perlin(&library)?];
    if let Some(volume) = &options.vdb {
        subjects.push(subject::volume(volume, &library)?);
    }
    let effort = Effort::of(options.quick);
    let each = sweep::steps(&effort) + convergence::steps(&effort) + images::steps();
    let bar = environment.progress(each * subjects.len() as u64 + claims::steps(), "measuring");
    let run = Run { seed: options.seed, effort, bar: &bar };

    let mut media = Vec::with_capacity(subjects.len());
    let mut pictures = Vec::new();
    for subject in &subjects {
        media.push(medium(&run, subject)?);
        pictures.extend(images::studies(&run, subject)?);
    }
    let claims = claims::ledger(&run, &subjects, &media, &pictures)?;
    bar.finish();
    Ok(Report {
        provenance: environment.provenance(options.seed),
        quick: options.quick,
        seconds: clock.elapsed().as_secs_f64(),
        threads: options.threads,
        media,
        images: pictures,
        claims,
        stability: Vec::new(),
    })
}

fn medium(run: &Run<'_>, subject: &Subject) -> Result<MediumReport, Failure> {
    let laws = SharedLaws::of(subject);
    let sweeps = sweep::curves(run, subject, &laws)?;
    let convergence = convergence::curves(run, subject, &laws, &sweeps)?;
    Ok(MediumReport {
        id: subject.id.to_owned(),
        title: subject.title.clone(),
        description: subject.description.clone(),
        ray: subject.facts.clone(),
        sweeps,
        convergence,
        anatomy: anatomy::of(run, subject, &laws)?,
        functions: functions::of(run, subject, &laws)?,
    })
}

/// What all studies share.
#[derive(Clone, Copy, Debug)]
struct Run<'a> {
    seed: u64,
    effort: Effort,
    bar: &'a Progress,
}

impl Run<'_> {
    /// The seed of the stream of this name, "study/subject/estimator/point".
    fn seed(&self, name: impl Display) -> u64 {
        named_seed(self.seed, &format!("report/standard/{name}"))
    }

    fn advance(&self) {
        self.bar.inc(1);
    }

    /// A quick run without a bar.
    #[cfg(test)]
    fn for_tests() -> Run<'static> {
        static HIDDEN: std::sync::LazyLock<Progress> = std::sync::LazyLock::new(Progress::hidden);
        Run { seed: 1, effort: Effort::of(true), bar: &HIDDEN }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everything that is drawn for the analytic medium, without its times.
    fn drawn(threads: usize) -> String {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let run = Run::for_tests();
            let subject = subject::analytic(&MediumLibrary::default()).unwrap();
            let mut medium = medium(&run, &subject).unwrap();
            let mut images = images::studies(&run, &subject).unwrap();
            for point in medium.sweeps.iter_mut().flat_map(|curve| &mut curve.points) {
                if let Some(measured) = &mut point.measured {
                    (measured.nanoseconds, measured.log10_efficiency_per_second) = (0.0, None);
                }
            }
            for point in medium.convergence.iter_mut().flat_map(|curve| &mut curve.points) {
                point.seconds = 0.0;
            }
            for panel in images.iter_mut().flat_map(|image| &mut image.panels) {
                panel.seconds = 0.0;
            }
            format!("{medium:?} {images:?}")
        })
    }

    #[test]
    fn all_numbers_but_times_are_the_same_on_any_number_of_threads() {
        assert_eq!(drawn(1), drawn(3));
    }
}
