//! The report on free flight: raab-2008 section 3 with its fig. 1 and 2, and the formula of 3.2, measured again.

mod claims;
mod distances;
mod laws;
mod splitting;
mod starts;
mod wavelengths;

use crate::laws::Laws;
use crate::run::Run;
use fairflight_document::Document;
use fairflight_harness::Failure;

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(run: &Run<'_>) -> Result<Document, Failure> {
    run.expect(Laws::steps(laws::CHECKS) + distances::steps() + wavelengths::steps() + splitting::steps());
    let laws = Laws::study(run, laws::CHECKS);
    let distances = distances::study(run)?;
    let starts = starts::section(run);
    let splitting = splitting::study(run)?;
    let wavelengths = wavelengths::study(run)?;
    Ok(Document {
        claims: vec![claims::r1(&laws), claims::r2(&splitting), claims::r3(&wavelengths)],
        summary: claims::summary(&laws, &splitting, &wavelengths),
        unsound: laws.unsound().chain(wavelengths.part.unsound).collect(),
        sections: vec![laws::section(&laws), distances, starts, splitting.section, wavelengths.part.section],
        hero: Some("splitting-error".to_owned()),
        ..run.document("Free flight, line integrals, wavelengths")
    })
}
