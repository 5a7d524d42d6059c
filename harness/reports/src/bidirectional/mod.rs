//! The report on bidirectional path tracing: lafortune-1996 and antwerpen-2011 chapters 3 to 5 in media, measured.

mod claims;
mod equal_time;
mod extensions;
mod point;
mod scenes;
mod strategies;

use crate::laws::Laws;
use crate::run::Run;
use fairflight_document::Document;
use fairflight_harness::Failure;
use scenes::SCENES;

/// The part of the catalogue whose law is that weights sum to one.
const WEIGHTS: &str = "bidirectional/partition/";

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(run: &Run<'_>) -> Result<Document, Failure> {
    let scenes = SCENES.len() as u64;
    let sections = point::STEPS + strategies::STEPS + extensions::steps();
    run.expect(scenes * equal_time::STEPS + sections + Laws::steps(WEIGHTS));
    let compared = SCENES.iter().map(|scene| equal_time::study(run, scene)).collect::<Result<Vec<_>, _>>()?;
    let extended = extensions::study(run, &compared)?;
    let point = point::study(run)?;
    let triangle = strategies::study(run)?;
    let laws = Laws::study(run, WEIGHTS);
    let unsound = compared.iter().flat_map(equal_time::Compared::unsound).chain(laws.unsound()).collect();
    let gallery = compared.iter().map(equal_time::Compared::row).collect();
    Ok(Document {
        summary: claims::summary(&compared, &point),
        claims: vec![claims::a1(&laws), extensions::a2(&extended), claims::l1(&compared), claims::r5(&laws)],
        unsound,
        sections: vec![
            equal_time::section(run, &compared, gallery),
            extensions::section(&extended),
            point.section,
            strategies::section(&compared, triangle),
            claims::section(&laws),
        ],
        hero: Some("bulb-time".to_owned()),
        ..run.document("Bidirectional path tracing in media")
    })
}
