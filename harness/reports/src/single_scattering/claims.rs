//! S9 of the ledger, and the findings of the report.

use super::POINT;
use super::equal_cost::{Budget, Study};
use crate::measured::Measured;
use crate::speed_against_error::Speed;
use fairflight_document::{Claim, ClaimVerdict, measured};

/// Beginning of the names of the methods that S9 says win: they differ in the number of samples per ray.
const MIS: &str = "source and scattering";

/// S9: where the point light dominates, MIS of source- and scattering-driven sampling has the least error.
///
/// Criterion: under the strong point light one of them has the least error of all unbiased methods at both budgets, or none is separable
/// from it by the 95 % intervals.
pub(super) fn s9(studies: &[Study]) -> Claim {
    let point = studies.iter().find(|study| study.lighting.id == POINT.id);
    let budgets: &[Budget] = point.map_or(&[], |study| &study.budgets);
    let wins = |budget: &&Budget| {
        budget.entries.iter().filter(|entry| entry.name.starts_with(MIS)).any(|mis| {
            budget.entries.iter().all(|entry| entry.is_baseline || !entry.rmse.is_below(&mis.rmse))
        })
    };
    let won = budgets.iter().filter(wins).count();
    let words = |budget: &Budget| {
        let ranked: Vec<String> = budget
            .ranking()
            .iter()
            .take(5)
            .map(|entry| format!("{} {}", entry.name, entry.rmse.words(4)))
            .collect();
        format!("{} look-ups: {}", budget.lookups, ranked.join(", "))
    };
    let verdict = match won {
        0 => ClaimVerdict::DoesNotHold,
        n if n == budgets.len() => ClaimVerdict::Holds,
        _ => ClaimVerdict::HoldsUnder,
    };
    Claim::new(
        ("S9", "szirmay-kalos-2017 fig. 12"),
        "At about 300 and 50 look-ups per pixel, MIS of source-driven and scattering-driven sampling wins where the point light dominates",
        budgets.iter().map(words).collect::<Vec<_>>().join("; "),
        (
            verdict,
            "RMSE of the unbiased methods, least first. What wins depends on what a look-up costs beside a camera ray: attenuation-driven \
             sampling reuses those of the walk.",
        ),
    )
}

/// The findings, in words.
pub(super) fn summary(studies: &[Study], speed: &Speed) -> Vec<String> {
    let mut summary = Vec::new();
    for study in studies {
        for budget in &study.budgets {
            let best = budget.ranking()[0];
            summary.push(format!(
                "{} look-ups per pixel under {}: least error {} with {}.",
                budget.lookups,
                study.lighting.words,
                best.name,
                best.rmse.words(4)
            ));
        }
    }
    let fastest = speed.fastest();
    let Measured { value, interval } = fastest.per_second;
    summary.push(format!("Fastest: {}, 1/(MSE · CPU s) = {}.", fastest.name, measured(value, interval)));
    summary
}
