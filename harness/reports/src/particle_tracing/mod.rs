//! The report on particle tracing: szirmay-kalos-2017 section 4.1 with its fig. 6 and 7, measured again.

mod claims;
mod equal_cost;
mod growth;
mod scenes;
mod speed;
mod versions;

use crate::run::Run;
use fairflight_document::Document;
use fairflight_harness::Failure;

/// Independent images per measurement.
const REPLICAS: u32 = 4;

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(run: &Run<'_>) -> Result<Document, Failure> {
    run.expect(versions::steps() * 2 + equal_cost::steps() + speed::steps() + growth::steps());
    let even = versions::study(run, &versions::EVEN)?;
    let sun = versions::study(run, &versions::SUN)?;
    let noise = equal_cost::study(run)?;
    let speed = speed::study(run)?;
    let growth = growth::study(run)?;
    Ok(Document {
        claims: vec![claims::s5(&even, &sun), claims::s6(&noise)],
        summary: claims::summary(&even, &sun, &noise, &speed),
        unsound: growth.unsound,
        sections: vec![even.section, sun.section, noise.section, speed.section, growth.section],
        hero: Some("even-merit".to_owned()),
        ..run.document("Particle tracing with any sampling extinction")
    })
}
