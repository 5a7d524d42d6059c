//! A1, L1 and R5 of the ledger, and the findings of the report.

use super::point::Point;
use crate::compared::Compared;
use crate::laws::Laws;
use crate::measured::Measured;
use fairflight_document::{Cell, Claim, ClaimVerdict, Section, Table};

/// The law of weights, scene by scene.
pub(super) fn section(laws: &Laws) -> Section {
    let text = "Of each path that any strategy finds, by all three heuristics: the weight that was used, the one by the recursion over the \
         whole path, and the one by the densities of all strategies, each a product over the path. Deviations are relative to a weight. \
         Scenes without the extinction or without absorption are surrogates of densities, which look wrong and are lawful.";
    let table = Table::of(
        ["weights-table", "Weights of strategies", ""],
        &laws.0,
        &[
            ("scene", "", &|(id, _)| Cell::text(id.as_str())),
            ("verdict", "", &|(_, result)| Cell::text(Laws::verdict(result))),
            ("greatest deviation", "", &|(_, result)| Cell::text(result.reason.as_str())),
        ],
    );
    Section::new("weights", "A1, R5: the weights of every path sum to one").with(text.to_owned()).with(table)
}

fn all_hold(laws: &Laws) -> (String, ClaimVerdict) {
    let held = laws.0.iter().filter(|(_, result)| result.holds == Some(true)).count();
    (format!("{held} of {} laws hold", laws.0.len()), ClaimVerdict::of(held == laws.0.len()))
}

/// A1: recursive weights are those by all densities.
///
/// Criterion: the law holds in each scene.
pub(super) fn a1(laws: &Laws) -> Claim {
    let (measured, verdict) = all_hold(laws);
    Claim::new(
        ("A1", "antwerpen-2011 5.3"),
        "Recursive weights equal those that are computed directly, for balance, power and maximum heuristic",
        measured,
        (
            verdict,
            "With the edge that 5.3 defines and not the one before, which algorithms 2 and 3 print, and with the distance densities of the \
             medium; the wrong twins of the catalogue show that each is needed.",
        ),
    )
}

/// R5: deterministic quadrature of τ keeps weights summing to one.
///
/// Criterion: the law holds in each scene, those with a midpoint rule and without τ among them.
pub(super) fn r5(laws: &Laws) -> Claim {
    let (measured, verdict) = all_hold(laws);
    Claim::new(
        ("R5", "raab-2008 4.3"),
        "Weights by a deterministic quadrature of τ sum to one",
        measured,
        (
            verdict,
            "In closed form, by four nodes, and with τ neglected. A transmittance that is drawn for each weight leaves sums that are off by a \
             tenth on average: wrong twin bdpt_random_tau.",
        ),
    )
}

/// L1: bidirectional path tracing beats path tracing where a medium is lit indirectly.
///
/// Criterion: its gain lies above 1 in every scene with indirect light, by 95 % intervals.
pub(super) fn l1(compared: &[Compared]) -> Claim {
    let indirect: Vec<Option<bool>> = compared
        .iter()
        .filter(|scene| scene.scene.is_indirect)
        .map(|scene| gain(scene).exceeds(1.0))
        .collect();
    let verdict = if indirect.contains(&Some(false)) {
        ClaimVerdict::HoldsUnder
    } else if indirect.contains(&None) {
        ClaimVerdict::NotTestable
    } else {
        ClaimVerdict::Holds
    };
    Claim::new(
        ("L1", "lafortune-1996"),
        "Bidirectional path tracing beats path tracing in a medium that is lit indirectly",
        gains(compared),
        (verdict, "1/(MSE · CPU s) over that of path tracing. Where light is direct it loses, and has to."),
    )
}

fn gains(compared: &[Compared]) -> String {
    let words = |scene: &Compared| format!("{} {}", scene.scene.id, gain(scene).words(2));
    compared.iter().map(words).collect::<Vec<_>>().join(", ")
}

/// The efficiency, 1/(MSE · CPU seconds), over that of path tracing.
fn gain(scene: &Compared) -> Measured {
    scene.gain(1, 0)
}

/// The findings, in words.
pub(super) fn summary(compared: &[Compared], point: &Point) -> Vec<String> {
    let prices = compared.iter().map(|scene| scene.entries[1].seconds / scene.entries[0].seconds);
    let [low, high] =
        prices.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], price| [low.min(price), high.max(price)]);
    let [paths, both] = point.growth();
    vec![
        format!("Gain over path tracing at equal time: {}.", gains(compared)),
        format!("A bidirectional sample takes the CPU time of {low:.1} to {high:.1} paths."),
        format!(
            "A point light in haze: at ten times the samples the variance of path tracing is {} times as great, of bidirectional path \
             tracing {} times.",
            paths.words(2),
            both.words(2)
        ),
    ]
}
