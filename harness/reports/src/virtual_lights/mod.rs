//! The report on virtual point lights: the figures of engelhardt-2013, measured again.

mod anisotropy;
mod approximations;
mod beams;
mod claims;
mod clamping;
mod costs;
mod reference;
mod scenes;
mod sizes;
mod strategies;

use crate::run::Run;
use fairflight_document::Document;
use fairflight_harness::Failure;
use reference::{ROOM_PATHS, Reference};

/// What makes the images of the room neither black nor white.
const EXPOSURE: f64 = 0.9;

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(run: &Run<'_>) -> Result<Document, Failure> {
    let parts = [
        sizes::steps(),
        strategies::steps(),
        beams::steps(),
        clamping::steps(),
        approximations::steps(),
        costs::steps(),
        anisotropy::steps(),
    ];
    run.expect(1 + parts.iter().sum::<u64>());
    let room = Reference::of(run, &scenes::smoke_room(scenes::side(run))?, ROOM_PATHS, run.seed("room"))?;
    let clamping = clamping::study(run, &room)?;
    let strategies = strategies::study(run, &room)?;
    let beams = beams::study(run, &room, &strategies)?;
    let sizes = sizes::study(run)?;
    let approximations = approximations::study(run)?;
    let costs = costs::study(run)?;
    let anisotropy = anisotropy::study(run)?;
    let unsound = claims::unsound(&strategies, &clamping, &anisotropy);
    Ok(Document {
        summary: claims::summary((&strategies, &sizes), &clamping, &approximations, &costs)
            .into_iter()
            .chain(beams::summary(&beams))
            .collect(),
        claims: vec![
            claims::e1(&clamping),
            claims::e2(&strategies, &sizes),
            claims::e3(&approximations),
            claims::e4(&approximations),
            claims::e5(&costs),
            claims::e6(&anisotropy),
            beams::e7(&beams),
            claims::r4(&strategies, &unsound),
        ],
        unsound,
        sections: clamping
            .sections
            .into_iter()
            .chain([strategies.section, sizes.section, beams::section(run, &room, &beams)])
            .chain(approximations.sections)
            .chain([costs.section, anisotropy.section])
            .collect(),
        hero: Some("strategies-time".to_owned()),
        ..run.document("Virtual point lights and bias compensation")
    })
}
