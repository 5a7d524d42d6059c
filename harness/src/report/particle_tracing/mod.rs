//! The report on particle tracing: szirmay-kalos-2017 section 4.1 with its fig. 6 and 7, measured again.

mod claims;
mod equal_cost;
mod growth;
mod scenes;
mod speed;
mod versions;

use crate::report::document::{Document, Options};
use crate::report::run::Run;
use crate::{Environment, Failure};
use std::time::Instant;

/// Independent images per measurement.
const REPLICAS: u32 = 4;

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(options: &Options, environment: &Environment) -> Result<Document, Failure> {
    let clock = Instant::now();
    let steps = versions::steps() * 2 + equal_cost::steps() + speed::steps() + growth::steps();
    let run = Run::new(options, environment, steps);
    let even = versions::study(&run, versions::Lighting::Even)?;
    let sun = versions::study(&run, versions::Lighting::Sun)?;
    let noise = equal_cost::study(&run)?;
    let speed = speed::study(&run)?;
    let growth = growth::study(&run)?;
    run.finish();
    let mut document = Document::new(
        "particle-tracing",
        "Particle tracing with any sampling extinction",
        options,
        environment.provenance(options.seed),
    );
    document.claims = vec![claims::s5(&even, &sun), claims::s6(&noise)];
    document.summary = claims::summary(&even, &sun, &noise, &speed);
    document.unsound = growth.unsound;
    document.sections = vec![even.section, sun.section, noise.section, speed.section, growth.section];
    document.seconds = clock.elapsed().as_secs_f64();
    Ok(document)
}
