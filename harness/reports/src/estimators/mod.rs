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

use crate::run::Run;
use fairflight_document::Document;
use fairflight_harness::Failure;

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(run: &Run<'_>) -> Result<Document, Failure> {
    let arenas = sets::arenas(run)?;
    let parts = [
        seed_ray::steps(),
        plane::steps(run),
        cells::steps(),
        convergence::steps(),
        flights::steps(),
        spectral::steps(),
        variates::steps(),
    ];
    run.expect(parts.iter().sum::<u64>() + arenas.iter().map(rays::steps).sum::<u64>());
    let seed = seed_ray::study(run)?;
    let plane = plane::study(run)?;
    let standings = arenas.iter().map(|arena| rays::study(run, arena)).collect::<Result<Vec<_>, _>>()?;
    let convergence = convergence::study(run)?;
    let flights = flights::study(run, &seed_ray::ray(run)?.profile)?;
    let cells = cells::study(run)?;
    let spectral = spectral::study(run)?;
    let variates = variates::study(run)?;
    let summary = findings::summary(&seed, &plane, &standings);
    let claims = findings::goals(&standings);
    let mut unsound: Vec<String> = [seed.part.unsound, plane.unsound].concat();
    unsound.extend([flights.unsound, spectral.unsound, variates.unsound].concat());
    unsound
        .extend(standings.iter().flat_map(|standings| &standings.rows).filter_map(|row| row.unsound.clone()));
    let mut sections = plane.sections;
    sections.insert(1, seed.part.section);
    sections.extend(standings.into_iter().map(|standings| standings.section));
    sections.extend([convergence, cells, flights.section, variates.section, spectral.section]);
    let title = "Estimators of transmittance: the whole family, and which to use";
    Ok(Document {
        summary,
        claims,
        unsound,
        sections,
        hero: Some("plane-winners".to_owned()),
        ..run.document(title)
    })
}
