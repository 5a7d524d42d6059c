//! The report on free flight: raab-2008 section 3 with its fig. 1 and 2, and the formula of 3.2, measured again.

mod claims;
mod distances;
mod laws;
mod splitting;
mod starts;
mod wavelengths;

use crate::report::document::{Document, Options};
use crate::report::run::Run;
use crate::{Environment, Failure};
use std::time::Instant;

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(options: &Options, environment: &Environment) -> Result<Document, Failure> {
    let clock = Instant::now();
    let steps = laws::steps() + distances::steps() + wavelengths::steps() + splitting::steps();
    let run = Run::new(options, environment, steps);
    let laws = laws::study(&run);
    let distances = distances::study(&run)?;
    let starts = starts::section(&run);
    let splitting = splitting::study(&run)?;
    let wavelengths = wavelengths::study(&run)?;
    run.finish();
    let mut document = Document::new(
        "free-flight",
        "Free flight, line integrals, wavelengths",
        options,
        environment.provenance(options.seed),
    );
    document.claims = vec![claims::r1(&laws), claims::r2(&splitting), claims::r3(&wavelengths)];
    document.summary = claims::summary(&laws, &splitting, &wavelengths);
    document.unsound = laws.unsound.iter().chain(&wavelengths.unsound).cloned().collect();
    document.sections = vec![laws.section, distances, starts, splitting.section, wavelengths.section];
    document.seconds = clock.elapsed().as_secs_f64();
    Ok(document)
}
