//! Tables: all estimators, optima, images, hard cases.

use super::super::findings::Limit;
use super::super::optimum::{CurveOptima, Optimum, Place};
use super::super::result::{EstimatorRow, ImagePanel, ImageStudy, MediumReport, StabilityRow};
use fairflight_document::{Cell, Table, listed, short};

/// A remark on an optimum at the end of its curve.
pub(super) fn where_it_lies(place: Place) -> &'static str {
    match place {
        Place::Inside => "",
        Place::LowerEnd => ", the lower end of its curve",
        Place::UpperEnd => ", the upper end of its curve",
    }
}

/// All estimators, the most efficient per look-up first.
pub(super) fn estimators(medium: &MediumReport) -> Table {
    let mut rows: Vec<&EstimatorRow> = medium.estimators.iter().collect();
    let efficiency = |row: &EstimatorRow| row.log10_efficiency_per_lookup.unwrap_or(f64::INFINITY);
    rows.sort_by(|a, b| efficiency(b).total_cmp(&efficiency(a)));
    let power = |log10: Option<f64>| Cell::maybe(log10.map(|x| 10_f64.powf(x)));
    let mut caption = "Parameters are the usual ones, with the greatest σ_t of the ray, rounded up, as majorant; MSE is that of one estimate; pilots of the hybrids are not charged."
        .to_owned();
    if !medium.refused.is_empty() {
        let refused: Vec<String> = medium.refused.iter().map(|it| it.series.label().to_owned()).collect();
        caption.push_str(&format!(" Not defined on this ray: {}.", listed(&refused)));
    }
    let count = rows.len();
    Table::of(
        [&format!("{}-estimators", medium.id), "All estimators", &caption],
        rows,
        &[
            ("estimator", "", &|row| Cell::text(row.series.label())),
            ("kind", "", &|row| Cell::text(row.kind)),
            ("parameters", "", &|row| Cell::text(&row.parameters)),
            ("MSE/T²", "1", &|row| match (row.is_closed, row.measured.relative_variance_interval) {
                (true, _) => power(row.log10_relative_variance),
                (false, interval) => Cell::measured(row.measured.relative_variance, interval),
            }),
            ("closed form", "", &|row| Cell::Flag(row.is_closed)),
            ("look-ups", "1", &|row| Cell::Number(row.lookups)),
            ("T²/(MSE · look-ups)", "1", &|row| power(row.log10_efficiency_per_lookup)),
            ("CPU time", "ns", &|row| Cell::Number(row.measured.nanoseconds)),
            ("T²/(MSE · s)", "1/s", &|row| power(row.measured.log10_efficiency_per_second)),
            ("agrees", "", &|row| match (row.is_biased, row.measured.sound) {
                (true, _) => Cell::text("biased"),
                (false, Some(sound)) => Cell::Flag(sound),
                (false, None) => Cell::Empty,
            }),
        ],
    )
    .folded(format!("{count} estimators: variance, look-ups, efficiency per look-up and per second"))
}

/// The best σ_samp of each curve.
pub(super) fn optima(medium: &MediumReport) -> Table {
    let sigma = |best: Option<Optimum>| Cell::maybe(best.map(|best| best.sigma_samp));
    let efficiency = |best: Option<Optimum>| Cell::maybe(best.map(|best| 10_f64.powf(best.log10_efficiency)));
    let end = |best: Option<Optimum>| match best.map(|best| best.place) {
        None => Cell::Empty,
        Some(Place::Inside) => Cell::text("inside"),
        Some(Place::LowerEnd) => Cell::text("lower end"),
        Some(Place::UpperEnd) => Cell::text("upper end"),
    };
    let inside = |row: &&CurveOptima| row.per_lookup.is_some_and(|best| best.place == Place::Inside);
    let count = medium.optima.iter().filter(inside).count();
    Table::of(
        [
            &format!("{}-optima", medium.id),
            "Best σ_samp of each curve",
            "Per look-up in closed form, per CPU second among the measured points. An end is that of the estimator's domain or of the sweep.",
        ],
        &medium.optima,
        &[
            ("estimator", "", &|row: &&CurveOptima| Cell::text(row.series.label())),
            ("parameters", "", &|row| Cell::text(&row.parameters)),
            ("σ_samp per look-up", "1/length", &|row| sigma(row.per_lookup)),
            ("position", "", &|row| end(row.per_lookup)),
            ("T²/(MSE · look-ups)", "1", &|row| efficiency(row.per_lookup)),
            ("σ_samp per second", "1/length", &|row| sigma(row.per_second)),
            ("position", "", &|row| end(row.per_second)),
            ("T²/(MSE · s)", "1/s", &|row| efficiency(row.per_second)),
        ],
    )
    .folded(format!("{} curves, {count} of them with their best σ_samp inside", medium.optima.len()))
}

/// Limits of variance times look-ups.
pub(super) fn limits(medium: &MediumReport) -> Table {
    Table::of(
        [
            &format!("{}-limits", medium.id),
            "Limits of the double particle model",
            "Var/T² · look-ups falls to L·∫(σ_t − σ_main)² ds as σ_samp grows.",
        ],
        &medium.findings.limits,
        &[
            ("estimator", "", &|limit: &&Limit| Cell::text(limit.series.label())),
            ("limit of Var/T² · look-ups", "1", &|limit| Cell::Number(limit.product)),
            ("at the majorant, over its limit", "1", &|limit| Cell::Number(limit.at_majorant)),
            ("within a tenth from σ_samp", "1/length", &|limit| Cell::Number(limit.within_a_tenth_from)),
        ],
    )
}

/// The images of all budgets of a medium.
pub(super) fn images(medium: &MediumReport, studies: &[&ImageStudy]) -> Table {
    let all = studies.iter().flat_map(|study| study.panels.iter().map(move |panel| (study.budget, panel)));
    let rows: Vec<(f64, &ImagePanel)> = all.collect();
    let budgets: Vec<String> = studies.iter().map(|study| short(study.budget)).collect();
    let line = format!("{} images at {} look-ups per pixel", rows.len(), listed(&budgets));
    Table::of(
        [
            &format!("{}-images", medium.id),
            "Error of the images",
            "Over the pixels whose rays meet the medium; intervals by the bootstrap.",
        ],
        rows,
        &[
            ("method", "", &|(_, panel)| Cell::text(panel.name)),
            ("parameters", "", &|(_, panel)| Cell::text(&panel.parameters)),
            ("budget", "1", &|(budget, _)| Cell::Number(*budget)),
            ("look-ups per pixel", "1", &|(_, panel)| Cell::Number(panel.lookups_per_pixel)),
            ("RMSE", "1", &|(_, panel)| Cell::measured(panel.rmse, panel.rmse_interval)),
            ("CPU time", "s", &|(_, panel)| Cell::Number(panel.seconds)),
        ],
    )
    .folded(line)
}

/// The hard cases, under one line.
pub(super) fn hard_cases(rows: &[StabilityRow]) -> Table {
    let right = rows.iter().filter(|row| row.passes).count();
    Table::of(
        [
            "hard-cases-rows",
            "Hard cases of transmittance",
            "Exact answers, and ours; where a refusal is due, it is the exact answer.",
        ],
        rows,
        &[
            ("no.", "", &|row: &&StabilityRow| Cell::Count(u64::from(row.number))),
            ("case", "", &|row| Cell::text(&row.case)),
            ("exact", "", &|row| Cell::text(&row.exact)),
            ("ours", "", &|row| Cell::text(&row.ours)),
            ("right", "", &|row| Cell::Flag(row.passes)),
        ],
    )
    .folded(format!("{right} of {} right", rows.len()))
}
