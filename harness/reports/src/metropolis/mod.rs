//! The report on chains of paths: antwerpen-2011 chapter 6 and raab-2008 4.4, measured.

mod claims;
mod equal_time;
mod learning;
mod mutations;
mod resolution;
mod rows;
mod start;
mod toy;

use crate::run::Run;
use fairflight_document::Document;
use fairflight_harness::Failure;

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(run: &Run<'_>) -> Result<Document, Failure> {
    run.expect(start::STEPS + rows::STEPS + equal_time::STEPS + resolution::STEPS + learning::STEPS);
    let start = start::study(run);
    let rows = rows::study(run)?;
    let compared = equal_time::study(run)?;
    let resolution = resolution::study(run, &compared)?;
    let learning = learning::study(run, &compared)?;
    let [maps, sizes] = learning.sections(run);
    let unsound = compared
        .iter()
        .flat_map(|scene| scene.entries.iter().filter_map(|entry| entry.too_bright(scene.scene.id)));
    Ok(Document {
        summary: claims::summary(&compared, &rows, &start).into_iter().chain(learning.summary()).collect(),
        claims: vec![start.a3(), rows::r6(&rows)],
        unsound: start
            .unsound()
            .into_iter()
            .chain(rows::unsound(&rows))
            .chain(unsound)
            .chain(learning.unsound())
            .collect(),
        sections: vec![
            equal_time::section(run, &compared),
            resolution::section(&resolution),
            mutations::section(&compared),
            maps,
            sizes,
            rows::section(run, &rows),
            start.section(run),
        ],
        hero: Some("mirror-room-time".to_owned()),
        ..run.document("Chains of paths in media")
    })
}
