//! Fig. 1: first collisions from independent and from equidistant variates.

use crate::run::Run;
use fairflight_document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use fairflight_sources::{Seeded, UniformSource};

/// First collisions that are shown.
const POINTS: u32 = 16;
/// Majorant optical thickness of the ray.
const THICKNESS: f64 = 3.0;
/// Sets from which spacings are measured.
const SETS: u32 = 20_000;

/// The distances of one set, over the length of the ray: −ln(1 − u p_V)/thickness.
fn set(equidistant: bool, source: &mut Seeded) -> Vec<f64> {
    let collides = -(-THICKNESS).exp_m1();
    let shift = source.next_uniform();
    (0..POINTS)
        .map(|k| {
            let u =
                if equidistant { (f64::from(k) + shift) / f64::from(POINTS) } else { source.next_uniform() };
            -(-u * collides).ln_1p() / THICKNESS
        })
        .collect()
}

/// The mean over sets of the greatest gap between neighbouring variates, in units of the mean gap.
fn greatest_gap(equidistant: bool, source: &mut Seeded) -> f64 {
    let collides = -(-THICKNESS).exp_m1();
    let sum: f64 = (0..SETS)
        .map(|_| {
            let mut variates: Vec<f64> =
                set(equidistant, source).into_iter().map(|t| -(-THICKNESS * t).exp_m1() / collides).collect();
            variates.sort_unstable_by(f64::total_cmp);
            let inner = variates.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
            f64::from(POINTS) * inner.max(variates[0]).max(1.0 - variates[variates.len() - 1])
        })
        .sum();
    sum / f64::from(SETS)
}

pub(super) fn section(run: &Run<'_>) -> Section {
    let source = |what: &str, label: &str| Seeded::new(run.seed(format_args!("starts/{label}/{what}")));
    let curve = |label: &str, equidistant: bool, rows: std::ops::Range<u32>| {
        let mut source = source("points", label);
        let points = rows.flat_map(|row| set(equidistant, &mut source).into_iter().map(move |t| (t, row)));
        Curve::method(label).with_marks(points.map(|(t, row)| Mark::at(t, f64::from(row))))
    };
    let chart = Chart::new(
            "starts-points",
            "First collisions along a ray",
            Axis::linear("distance / length of the ray [1]"),
            Axis::linear("independent 1 to 4, equidistant 5 to 8").within(0.0, 9.0),
        ).with_caption(format!(
            "Four sets of {POINTS} first collisions of each kind, majorant optical thickness {THICKNESS}: the points from which the flights of \
             algorithm 2 start."
        )).with_curves(vec![curve("independent", false, 1..5), curve("equidistant", true, 5..9)]);
    let table = Table::of(
        [
            "starts-gaps",
            "How even the starts are",
            "In variates, where both kinds are uniform: the greatest gap of a set over the mean gap, averaged over 20 000 sets.",
        ],
        [("independent", false), ("equidistant", true)],
        &[
            ("starts", "", &|(label, _)| Cell::text(*label)),
            ("greatest gap / mean gap", "1", &|(label, equidistant)| {
                Cell::Number(greatest_gap(*equidistant, &mut source("gaps", label)))
            }),
        ],
    );
    Section::new("starts", "raab-2008 fig. 1: where flights start").with(chart).with(table)
}
