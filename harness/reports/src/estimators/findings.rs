//! What the report came to, in words made of its numbers.

use super::plane::Plane;
use super::rays::{Standing, Standings};
use super::seed_ray::SeedRay;
use fairflight_document::{Claim, ClaimVerdict, short};
use fairflight_harness::comparison::Gain;

/// The goal for the worst ray of every set, and for the geometric mean on smooth ones.
const WORST: f64 = 2.4;
const SMOOTH: f64 = 1e4;
/// What the hybrid may lose against the best published estimator.
const SHARE: f64 = 0.9;

pub(super) fn summary(seed: &SeedRay, plane: &Plane, standings: &[Standings]) -> Vec<String> {
    let winners: Vec<String> = plane
        .wins
        .iter()
        .filter(|(_, points)| *points > 0)
        .take(4)
        .map(|(name, points)| format!("{name} ({points})"))
        .collect();
    let mut summary = Vec::new();
    for standings in standings {
        let best_of =
            |of: &dyn Fn(&Standing) -> f64| standings.rows.iter().max_by(|a, b| of(a).total_cmp(&of(b)));
        if let (Some(hybrid), Some(published), Some(fastest)) =
            (standings.of("hybrid"), standings.best_published(), best_of(&|row| row.per_second.mean))
        {
            summary.push(format!(
                "{} rays: the hybrid gains {} over ratio tracking per look-up (worst ray {}), at {} look-ups; the best published estimator, {}, {} \
                 (worst {}), at {}. Per second the best is {}, {}.",
                capital(&standings.set),
                short(hybrid.per_lookup.mean),
                short(hybrid.per_lookup.worst),
                short(hybrid.lookups),
                published.name,
                short(published.per_lookup.mean),
                short(published.per_lookup.worst),
                short(published.lookups),
                fastest.name,
                short(fastest.per_second.mean),
            ));
        }
    }
    summary.push(format!(
        "On the canonical plane of {} points the winners per look-up are {}.",
        plane.cells,
        winners.join(", ")
    ));
    summary.push(format!(
        "{} of {} variances of an earlier numerical study on the seed ray are reproduced within their error.",
        seed.reproduced, seed.compared
    ));
    summary
}

/// The goals of the hybrid as lines of the ledger.
pub(super) fn goals(standings: &[Standings]) -> Vec<Claim> {
    let hybrids = || standings.iter().filter_map(|standings| Some((standings, standings.of("hybrid")?)));
    let claim = |id: &str, claim: String, measured: Vec<String>, holds: bool, comment: &str| {
        let verdict = (ClaimVerdict::of(holds), comment);
        Claim::new((id, "goal of this project"), claim, measured.join("; "), verdict)
    };
    let smooth = || hybrids().filter(|(set, _)| set.id == "smooth").map(|(_, row)| &row.per_lookup);
    let gain = |gain: &Gain| {
        format!("{} [{}, {}]", short(gain.mean), short(gain.interval[0]), short(gain.interval[1]))
    };
    let against: Vec<(String, f64)> = standings
        .iter()
        .filter_map(|set| {
            let (hybrid, best) = (set.of("hybrid")?, set.best_published()?);
            let ratio = hybrid.per_lookup.mean / best.per_lookup.mean;
            Some((format!("{} {} ({})", set.set, short(ratio), best.name), ratio))
        })
        .collect();
    vec![
        claim(
            "H1",
            format!("the hybrid has at least {WORST} times the efficiency of ratio tracking per look-up on the worst ray of every set"),
            hybrids().map(|(set, row)| format!("{} {}", set.set, short(row.per_lookup.worst))).collect(),
            hybrids().all(|(_, row)| row.per_lookup.worst >= WORST),
            "on the rays of this report",
        ),
        claim(
            "H2",
            "the hybrid gains at least 1e4 in the geometric mean on smooth rays".to_owned(),
            smooth().map(gain).collect(),
            smooth().all(|gain| gain.mean >= SMOOTH),
            "finer combs gain without end on smooth rays: the number depends on how many look-ups an estimate may cost",
        ),
        claim(
            "H3",
            "the hybrid is not below the geometric mean of any published estimator by more than 10 % on any set"
                .to_owned(),
            against.iter().map(|(words, _)| words.clone()).collect(),
            against.iter().all(|(_, ratio)| *ratio >= SHARE),
            "ratio to the best published one, which is named",
        ),
    ]
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
