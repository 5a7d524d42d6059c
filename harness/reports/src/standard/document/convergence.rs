//! Figures of the error against cost: unbiased estimators fall forever, biased baselines end on their floor.

use super::super::result::{ConvergenceCurve, ConvergencePoint, MediumReport, Series};
use super::decades;
use fairflight_document::{Axis, Chart, Curve, Mark, listed, short};

type Cost = fn(&ConvergencePoint) -> f64;

/// The error against look-ups and against seconds.
pub(super) fn charts(medium: &MediumReport) -> [Chart; 2] {
    let lookups: Cost = |point| point.lookups;
    let seconds: Cost = |point| point.seconds;
    [
        chart(medium, ["lookups", "look-ups"], "look-ups [1]", lookups),
        chart(medium, ["seconds", "CPU time"], "CPU time [s]", seconds),
    ]
}

fn chart(medium: &MediumReport, [id, name]: [&str; 2], title: &str, cost: Cost) -> Chart {
    let points = || medium.convergence.iter().flat_map(|curve| &curve.points);
    let errors = points().flat_map(|point| [Some(point.relative_rmse), point.predicted]);
    let [low, high] = decades(errors.flatten().map(f64::log10), [-8.0, 3.0]);
    let curves = medium.convergence.iter().map(|it| curve(it, cost));
    let y = Axis::logarithmic("RMSE/T [1]").within(low, high);
    Chart::new(
        &format!("{}-error-against-{id}", medium.id),
        &format!("Error against {name}"),
        Axis::logarithmic(title),
        y,
    )
    .with_curves(curves.collect())
    .with_caption(caption(medium, name, cost))
}

fn curve(curve: &ConvergenceCurve, cost: Cost) -> Curve {
    let line = curve.points.iter().map(|point| (cost(point), point.predicted.filter(|y| y.is_finite())));
    let marks = curve.points.iter().map(|point| {
        let ConvergencePoint { estimates, replicas, lookups, seconds, .. } = *point;
        let unit = if curve.series.is_baseline() { "steps" } else { "estimates" };
        Mark::measured(cost(point), point.relative_rmse, point.interval).noted(format!(
            "{estimates} {unit} in each of {replicas} replicas; {} look-ups and {} s each",
            short(lookups),
            short(seconds)
        ))
    });
    Curve::method(curve.series.label()).with_gaps(line).with_marks(marks)
}

/// The best of the unbiased by error times the root of the cost, which does not depend on the cost; the floors of the others.
fn caption(medium: &MediumReport, name: &str, cost: Cost) -> String {
    let competes = |series: Series| {
        medium.estimators.iter().any(|row| row.series == series && !row.is_biased && !row.is_oracle)
    };
    let last = |curve: &ConvergenceCurve| {
        let point = curve.points.last()?;
        Some((curve.series, cost(point), point.relative_rmse))
    };
    let best = medium
        .convergence
        .iter()
        .filter(|curve| competes(curve.series))
        .filter_map(last)
        .min_by(|a, b| (a.2 * a.1.sqrt()).total_cmp(&(b.2 * b.1.sqrt())));
    let mut caption = best.map_or_else(String::new, |(series, cost, error)| {
        let unit = if name == "CPU time" { "s" } else { "look-ups" };
        format!(
            "Least error at the same {name}, of the unbiased estimators without an oracle: {}, RMSE/T = {} for {} {unit}.",
            series.label(),
            short(error),
            short(cost)
        )
    });
    let floors: Vec<String> = medium
        .convergence
        .iter()
        .filter_map(|curve| Some((curve.series, curve.points.last()?.relative_bias)))
        .filter(|(_, bias)| *bias > 0.0)
        .map(|(series, bias)| format!("{} at {}", series.label(), short(bias)))
        .collect();
    if !floors.is_empty() {
        caption.push_str(&format!(" Biases end the fall of {}.", listed(&floors)));
    }
    caption
}
