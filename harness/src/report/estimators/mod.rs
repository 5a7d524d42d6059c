//! The report on all estimators of transmittance: which is the best where, and what each costs.

mod cells;
mod convergence;
mod findings;
mod flights;
mod plane;
mod rays;
mod seed_ray;
mod sets;
mod spectral;
mod variates;

use crate::report::document::{Document, Options};
use crate::report::run::Run;
use crate::{Environment, Failure};
use std::time::Instant;

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(options: &Options, environment: &Environment) -> Result<Document, Failure> {
    let clock = Instant::now();
    let run = Run::new(options, environment, 1);
    let arenas = sets::arenas(&run)?;
    let parts = [
        seed_ray::steps(),
        plane::steps(&run),
        cells::steps(),
        convergence::steps(),
        flights::steps(),
        spectral::steps(),
        variates::steps(),
    ];
    run.expect(parts.iter().sum::<u64>() + arenas.iter().map(rays::steps).sum::<u64>());
    let seed = seed_ray::study(&run)?;
    let plane = plane::study(&run)?;
    let mut standings = Vec::new();
    for (k, arena) in (0..).zip(&arenas) {
        standings.push(rays::study(&run, arena, k)?);
    }
    let convergence = convergence::study(&run)?;
    let flights = flights::study(&run, &seed_ray::ray(&run)?.profile)?;
    let cells = cells::study(&run)?;
    let spectral = spectral::study(&run)?;
    let variates = variates::study(&run)?;
    run.finish();
    let mut document = Document::new(
        "estimators",
        "Estimators of transmittance: the whole family, and which to use",
        options,
        environment.provenance(options.seed),
    );
    document.summary = findings::summary(&seed, &plane, &standings);
    document.claims = findings::goals(&standings);
    document.unsound = seed
        .unsound
        .into_iter()
        .chain(plane.unsound)
        .chain(flights.unsound)
        .chain(spectral.unsound)
        .chain(variates.unsound)
        .collect();
    document
        .unsound
        .extend(standings.iter().flat_map(|standings| &standings.rows).filter_map(|row| row.unsound.clone()));
    document.sections = plane.sections;
    document.sections.insert(1, seed.section);
    document.sections.extend(standings.into_iter().map(|standings| standings.section));
    document.sections.extend([convergence, cells, flights.section, variates.section, spectral.section]);
    document.seconds = clock.elapsed().as_secs_f64();
    Ok(document)
}
