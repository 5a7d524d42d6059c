//! The report on virtual point lights: the figures of engelhardt-2013, measured again.

mod anisotropy;
mod approximations;
mod claims;
mod clamping;
mod costs;
mod reference;
mod scenes;
mod sizes;
mod strategies;

use crate::report::document::{Document, Options};
use crate::report::run::Run;
use crate::{Environment, Failure};
use reference::{ROOM_PATHS, Reference};
use std::time::Instant;

/// What makes the images of the room neither black nor white.
const EXPOSURE: f64 = 0.9;

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(options: &Options, environment: &Environment) -> Result<Document, Failure> {
    let clock = Instant::now();
    let steps = 1
        + sizes::steps()
        + strategies::steps()
        + clamping::steps()
        + approximations::steps()
        + costs::steps()
        + anisotropy::steps();
    let run = Run::new(options, environment, steps);
    let room = Reference::of(&run, &scenes::smoke_room(scenes::side(&run))?, ROOM_PATHS, run.seed(0, 0))?;
    let clamping = clamping::study(&run, &room)?;
    let strategies = strategies::study(&run, &room)?;
    let sizes = sizes::study(&run)?;
    let approximations = approximations::study(&run)?;
    let costs = costs::study(&run)?;
    let anisotropy = anisotropy::study(&run)?;
    run.finish();
    let mut document = Document::new(
        "vpl",
        "Virtual point lights and bias compensation",
        options,
        environment.provenance(options.seed),
    );
    document.summary = claims::summary((&strategies, &sizes), &clamping, &approximations, &costs);
    document.unsound = claims::unsound(&strategies, &clamping, &anisotropy);
    document.claims = vec![
        claims::e1(&clamping),
        claims::e2(&strategies, &sizes),
        claims::e3(&approximations),
        claims::e4(&approximations),
        claims::e5(&costs),
        claims::e6(&anisotropy),
        claims::r4(&strategies, &document.unsound),
    ];
    document.sections = clamping
        .sections
        .into_iter()
        .chain([strategies.section, sizes.section])
        .chain(approximations.sections)
        .chain([costs.section, anisotropy.section])
        .collect();
    document.seconds = clock.elapsed().as_secs_f64();
    Ok(document)
}
