//! Forecasts of all, trials of those that have none, measurements of the best few.

use super::answer::{Advice, Answer, Contestant, How};
use super::forecast::Signs;
use super::question::Question;
use crate::budget::{Budget, patience, seconds_per_lookup};
use crate::comparison::{
    Bout, Effort, Entrant, Facts, RaySet, TestRay, Unit, bouts_of, entrants, facts, gain,
};
use crate::estimator::pilot;
use crate::parallel::in_parallel;
use crate::{Environment, Failure};
use fairflight_sources::named_seed;
use fairflight_transmittance::Pilot;

/// Estimates per ray of a trial, and of a measurement.
const TRIAL: Effort = Effort { samples: 64, counted: 64, closed: false };
const MEASUREMENT: Effort = Effort { samples: 1024, counted: 256, closed: false };
/// Rays of a trial.
const TRIAL_RAYS: usize = 16;
/// Number of estimators that are measured beside ratio tracking.
const BEST: usize = 5;

/// Expected price of an entrant: mean ln(variance · look-ups) over the rays.
struct Expected {
    entrant: Entrant,
    log_price: f64,
    how: How,
}

/// Rays of a question that may be answered within a budget, and a warning where that takes long.
///
/// # Errors
/// If they cannot be integrated, or would take too many look-ups.
pub(super) fn rays(question: &Question, budget: Budget) -> Result<(RaySet, Option<String>), Failure> {
    let set = question.rays()?;
    let (rays, depth) = (set.rays.len() as f64, set.depth());
    // A trial of each and a measurement of the best, drawn and counted; pilots make a few dozen look-ups per
    // unit of depth.
    let estimates = |effort: Effort| (effort.samples + effort.counted) as f64;
    let trial = estimates(TRIAL) * (TRIAL_RAYS as f64 / rays).min(1.0);
    let measured = (BEST + 1) as f64 * estimates(MEASUREMENT);
    let pilot = |ray: &TestRay| Pilot::lookups(ray.majorant * ray.profile.length()) as f64;
    let lookups = depth * (entrants().len() as f64 * trial + measured)
        + set.pairs() * trial
        + 2.0 * set.rays.iter().map(pilot).sum::<f64>();
    let because = format!(
        "{rays} rays, in the majorant {:e} of an optical thickness of {depth:.3e} together",
        set.rays[0].majorant
    );
    budget.check(&format!("{}: medium", question.name), lookups, &because)?;
    let warning = patience(lookups, seconds_per_lookup(&set.rays[0].profile));
    Ok((set, warning))
}

pub(super) fn answer(
    question: &Question,
    set: &RaySet,
    seed: u64,
    environment: &Environment,
) -> Result<Answer, Failure> {
    let facts = facts(set, named_seed(seed, "advise/facts"));
    let signs: Vec<Signs> = in_parallel(set.rays.len(), &|i| {
        let ray = &set.rays[i];
        let of = |what: &str| named_seed(seed, &format!("advise/{what}/ray {i}"));
        Signs::of(ray, pilot(&ray.profile, ray.majorant, of("pilot")), of("mean square"))
    });
    let progress = environment.progress(entrants().len() as u64 + (BEST as u64 + 1), "advising");
    let mut expected: Vec<Expected> = Vec::new();
    for entrant in entrants() {
        // Not every medium knows its bounds in cells.
        if entrant.needs_cells && entrant.on(&set.rays[0], &facts[0]).is_err() {
            continue;
        }
        let seed = named_seed(seed, &format!("advise/trial/{}", entrant.name));
        expected.push(expect(entrant, set, &facts, &signs, seed)?);
        progress.inc(1);
    }
    expected.sort_by(|a, b| a.log_price.total_cmp(&b.log_price));
    // Ratio tracking is what all are compared with.
    let chosen: Vec<&Expected> = expected
        .iter()
        .filter(|expected| expected.entrant.name == "ratio tracking")
        .chain(expected.iter().filter(|expected| expected.entrant.name != "ratio tracking").take(BEST))
        .collect();
    let mut measured: Vec<(Entrant, Vec<Bout>)> = Vec::new();
    for expected in chosen {
        let seed = named_seed(seed, &format!("advise/measurement/{}", expected.entrant.name));
        measured
            .push((expected.entrant, bouts_of(&expected.entrant, set, &facts, MEASUREMENT, seed, &|| ())?));
        progress.inc(1);
    }
    progress.finish();
    let baseline = measured[0].1.clone();
    let mut advice: Vec<Advice> = measured
        .iter()
        .filter_map(|(entrant, bouts)| {
            let of = |unit| gain(bouts, &baseline, unit, named_seed(seed, "advise/bootstrap"));
            Some(Advice::of(entrant, bouts, (of(Unit::Lookups)?, of(Unit::Seconds)?), set, &facts))
        })
        .collect();
    advice.sort_by(|a, b| b.gain_per_lookup.value.total_cmp(&a.gain_per_lookup.value));
    let contestant = |Expected { entrant, log_price, how }: &Expected| Contestant {
        estimator: entrant.name,
        price: log_price.exp(),
        how: *how,
    };
    let contestants = expected.iter().map(contestant).collect();
    let provenance = question.provenance(environment, seed)?;
    Ok(Answer::new(&question.name, set, advice, contestants, provenance))
}

/// A forecast on every ray, or a trial on some.
fn expect(
    entrant: Entrant,
    set: &RaySet,
    facts: &[Facts],
    signs: &[Signs],
    seed: u64,
) -> Result<Expected, Failure> {
    let forecasts: Option<Vec<f64>> = set
        .rays
        .iter()
        .zip(facts)
        .zip(signs)
        .map(|((ray, facts), signs)| {
            let forecast = match entrant.hybrid(ray, facts) {
                Some(hybrid) => hybrid.forecast(),
                None => signs.forecast(&entrant.spec(ray, facts)?)?,
            };
            Some(log_price(forecast.relative_variance, forecast.lookups))
        })
        .collect();
    let (logs, how) = match forecasts {
        Some(logs) => (logs, How::Forecast),
        None => {
            let few = RaySet { rays: set.rays.iter().take(TRIAL_RAYS).cloned().collect(), ..set.clone() };
            let bouts = bouts_of(&entrant, &few, facts, TRIAL, seed, &|| ())?;
            (bouts.iter().map(|bout| log_price(bout.relative_variance, bout.lookups)).collect(), How::Trial)
        }
    };
    Ok(Expected { entrant, log_price: logs.iter().sum::<f64>() / logs.len() as f64, how })
}

fn log_price(relative_variance: f64, lookups: f64) -> f64 {
    relative_variance.max(1e-26).ln() + lookups.max(1.0).ln()
}
