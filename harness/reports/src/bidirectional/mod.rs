//! The report on bidirectional path tracing: lafortune-1996 and antwerpen-2011 chapters 3 to 5 in media, measured.

mod claims;
mod equal_time;
mod extensions;
mod point;
mod strategies;

use crate::laws::Laws;
use crate::run::Run;
use crate::scenes::{BULB, DOOR, FIXTURE, MIXED, Scene, VOLUME_CAUSTIC};
use fairflight_document::Document;
use fairflight_harness::Failure;

/// Scenes of which bidirectional path tracing is to show something.
const SCENES: [Scene; 5] = [BULB, VOLUME_CAUSTIC, DOOR, FIXTURE, MIXED];
/// The part of the catalogue whose law is that weights sum to one.
const WEIGHTS: &str = "bidirectional/partition/";

/// Columns and rows of the images.
fn side(run: &Run<'_>) -> u32 {
    run.quick_or(12, 32)
}

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(run: &Run<'_>) -> Result<Document, Failure> {
    let sections = point::STEPS + strategies::STEPS + extensions::steps();
    run.expect(equal_time::STEPS + sections + Laws::steps(WEIGHTS));
    let compared = SCENES.iter().map(|scene| equal_time::study(run, scene)).collect::<Result<Vec<_>, _>>()?;
    let extended = extensions::study(run, &compared)?;
    let point = point::study(run)?;
    let triangle = strategies::study(run)?;
    let laws = Laws::study(run, WEIGHTS);
    let unsound = compared.iter().flat_map(equal_time::unsound).chain(laws.unsound()).collect();
    Ok(Document {
        summary: claims::summary(&compared, &point),
        claims: vec![claims::a1(&laws), extensions::a2(&extended), claims::l1(&compared), claims::r5(&laws)],
        unsound,
        sections: vec![
            equal_time::section(run, &compared),
            extensions::section(&extended),
            point.section,
            strategies::section(&compared, triangle),
            claims::section(&laws),
        ],
        hero: Some("bulb-time".to_owned()),
        ..run.document("Bidirectional path tracing in media")
    })
}
