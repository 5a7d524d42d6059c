//! The report on speed: look-ups, walks, connections and images per second, beside the parts that they cannot do without.

mod connections;
mod estimators;
mod haze;
mod images;
mod in_turn;
mod media;
mod surfaces;
mod walks;

use crate::run::Run;
use fairflight_document::{Document, Section};
use fairflight_elementary::InstructionSet;
use fairflight_harness::Failure;
use in_turn::Row;

/// Measures the report, one loop at a time.
pub(crate) fn document(run: &Run<'_>) -> Result<Document, Failure> {
    let walked = walks::STEPS + connections::STEPS + surfaces::STEPS;
    run.expect(media::STEPS + estimators::STEPS + walked + images::STEPS);
    let media = media::study(run)?;
    let length = media::lengths(run)?;
    let estimators = estimators::study(run)?;
    let walks = walks::study(run)?;
    let connections = connections::study(run)?;
    let surfaces = surfaces::study(run)?;
    let images = images::study(run)?;
    let summary = vec![
        Row::finding("A look-up of ratio tracking", &media),
        Row::finding("A collision of the particle tracer", &walks),
        Row::finding("A connection with a virtual point light", &connections),
        format!(
            "The widest instruction set of this machine is {}; all sets give the same bits.",
            InstructionSet::widest().name()
        ),
    ];
    let text = "Each row is one run of loops in turn, by the CPU clock of one thread, so that ratios can be compared where a machine's speed drifts. The bare parts are what the work \
                cannot do without, in a loop of their own. Times are of one look-up, collision or connection. Lanes are sixteen streams side by side, with the bits of one after the other: a column for each \
                instruction set that this machine has tells how many times as fast they are.";
    Ok(Document {
        summary,
        sections: vec![
            Section::new("media", "Look-ups, by medium").with(text).with(media::table(&media)).with(length),
            Section::new("estimators", "Look-ups, by estimator").with(estimators::table(&estimators)),
            Section::new("walks", "Walks").with(walks::table(&walks)),
            Section::new("connections", "Connections").with(connections::table(&connections)).with(surfaces),
            Section::new("images", "Images").with(images),
        ],
        hero: Some("length".to_owned()),
        ..run.document("Speed of look-ups, walks, connections and images")
    })
}
