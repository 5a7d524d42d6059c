//! Figures over σ_samp: variance, look-ups, efficiency per look-up and per second.

use super::super::findings::Agreement;
use super::super::optimum::Optimum;
use super::super::result::{MediumReport, Series, SweepCurve, SweepMeasurement, SweepPoint};
use super::decades;
use fairflight_document::{Axis, Chart, Curve, Mark, Panel, Vertical, short, short_of_log10};

const SIGMA_SAMP: &str = "σ_samp [1/length]";
/// Decades of variance beyond which no curve is followed.
const LIMITS: [f64; 2] = [-6.0, 12.0];
/// Decades of efficiency that are shown.
const DEPTH: f64 = 7.0;

/// The variance at all albedos but the middle one.
pub(super) fn variance_at_other_albedos(medium: &MediumReport) -> impl Iterator<Item = Chart> + '_ {
    let middle = middle_albedo(medium);
    let others = albedos(medium).into_iter().filter(move |albedo| *albedo != middle);
    others.map(|albedo| variance(medium, albedo))
}

/// The efficiency per look-up.
pub(super) fn efficiency_per_lookup(medium: &MediumReport) -> Chart {
    efficiency(medium, Cost::Lookups)
}

/// The efficiency per CPU second.
pub(super) fn efficiency_per_second(medium: &MediumReport) -> Chart {
    efficiency(medium, Cost::Seconds)
}

/// The albedos for which there are curves of their own, increasing; a single none where no curve depends on it.
fn albedos(medium: &MediumReport) -> Vec<Option<f64>> {
    let mut known: Vec<f64> = medium.sweeps.iter().filter_map(|curve| curve.albedo).collect();
    known.sort_by(f64::total_cmp);
    known.dedup();
    if known.is_empty() { vec![None] } else { known.into_iter().map(Some).collect() }
}

/// The albedo of the figures that show one only.
pub(super) fn middle_albedo(medium: &MediumReport) -> Option<f64> {
    let albedos = albedos(medium);
    albedos[albedos.len() / 2]
}

/// The id of the figure of the variance at an albedo.
pub(super) fn variance_id(medium: &MediumReport, albedo: Option<f64>) -> String {
    let albedo = albedo.map_or_else(String::new, |albedo| format!("-albedo-{albedo}"));
    format!("{}-variance{albedo}", medium.id)
}

/// The curves at an albedo: its own, and those that do not depend on it.
fn curves(medium: &MediumReport, albedo: Option<f64>) -> impl Iterator<Item = &SweepCurve> {
    medium.sweeps.iter().filter(move |curve| curve.albedo.is_none() || curve.albedo == albedo)
}

fn at(albedo: Option<f64>) -> String {
    albedo.map_or_else(String::new, |albedo| format!(" at albedo {albedo}"))
}

fn chart(medium: &MediumReport, [id, title]: [&str; 2], y: Axis, curves: Vec<Curve>) -> Chart {
    let greatest = Vertical { x: medium.ray.maximum, label: "greatest σ_t on the ray".to_owned() };
    let panel = Panel::new("", Axis::logarithmic(SIGMA_SAMP), y);
    Chart::of(id, title, vec![Panel { curves, verticals: vec![greatest], ..panel }])
}

/// A curve whose line has gaps where the estimator is not defined.
fn curve(
    curve: &SweepCurve,
    log10: impl Fn(&SweepPoint) -> Option<f64>,
    mark: impl Fn(&SweepPoint) -> Option<Mark>,
) -> Curve {
    let place = |point: &SweepPoint| log10(point).filter(|x| x.is_finite()).map(|x| 10_f64.powf(x));
    Curve::method(curve.series.label())
        .with_gaps(curve.points.iter().map(|point| (point.sigma_samp, place(point))))
        .with_marks(curve.points.iter().filter_map(mark))
}

fn cost(measured: &SweepMeasurement) -> String {
    let SweepMeasurement { samples, lookups, nanoseconds, .. } = measured;
    format!("{samples} estimates of {} look-ups and {} ns each", short(*lookups), short(*nanoseconds))
}

/// The variance at an albedo.
pub(super) fn variance(medium: &MediumReport, albedo: Option<f64>) -> Chart {
    let mark = |point: &SweepPoint| {
        let measured = point.measured.as_ref()?;
        let (x, y) = (point.sigma_samp, measured.relative_variance);
        let mark = if measured.testable {
            Mark::measured(x, y, measured.relative_variance_interval)
        } else {
            Mark::at(x, y).hollow()
        };
        Some(mark.noted(cost(measured)))
    };
    let all = || curves(medium, albedo);
    let values = all().flat_map(|curve| &curve.points).flat_map(|point| {
        let measured = point.measured.as_ref().map(|measured| measured.relative_variance.log10());
        [point.log10_relative_variance, measured]
    });
    let [low, high] = decades(values.flatten(), LIMITS);
    let drawn = all().map(|it| curve(it, |point| point.log10_relative_variance, mark)).collect();
    let title = format!("Variance against σ_samp{}", at(albedo));
    let y = Axis::logarithmic("Var/T² [1]").within(low, high);
    let unbiased = || all().filter(|curve| !curve.series.is_baseline());
    let agreement =
        Agreement::of(unbiased().flat_map(|curve| &curve.points).filter_map(|point| point.measured.as_ref()));
    let caption = format!(
        "{}Of {} measured points of unbiased estimators {} agree with their closed forms, {} do not, and {} cannot tell.",
        span(unbiased(), medium.ray.maximum),
        agreement.measured,
        agreement.agree,
        agreement.disagree,
        agreement.measured - agreement.agree - agreement.disagree
    );
    chart(medium, [&variance_id(medium, albedo), &title], y, drawn).with_caption(caption)
}

/// The least and the greatest variance just above the greatest extinction.
fn span<'a>(curves: impl Iterator<Item = &'a SweepCurve>, maximum: f64) -> String {
    let mut there: Vec<(Series, f64, f64)> = curves
        .filter_map(|curve| {
            let point = curve.points.iter().find(|point| point.sigma_samp >= maximum)?;
            Some((curve.series, point.sigma_samp, point.log10_relative_variance.filter(|x| x.is_finite())?))
        })
        .collect();
    there.sort_by(|a, b| a.2.total_cmp(&b.2));
    match (there.first(), there.last()) {
        (Some(least), Some(greatest)) if there.len() > 1 => format!(
            "At σ_samp = {} Var/T² is between {} ({}) and {} ({}). ",
            short(least.1),
            short_of_log10(least.2),
            least.0.label(),
            short_of_log10(greatest.2),
            greatest.0.label()
        ),
        _ => String::new(),
    }
}

/// The look-ups of an estimate.
pub(super) fn lookups(medium: &MediumReport) -> Chart {
    let albedo = middle_albedo(medium);
    let mark = |point: &SweepPoint| {
        let measured = point.measured.as_ref()?;
        Some(Mark::at(point.sigma_samp, measured.lookups).noted(cost(measured)))
    };
    let all = || curves(medium, albedo);
    let log10 = |point: &SweepPoint| point.lookups.map(f64::log10);
    let [low, high] = decades(all().flat_map(|curve| &curve.points).filter_map(log10), [-4.0, 8.0]);
    let drawn = all().map(|it| curve(it, log10, mark)).collect();
    let differences = all().flat_map(|curve| &curve.points).filter_map(|point| {
        let expected = point.lookups.filter(|expected| *expected > 0.0)?;
        Some((point.measured.as_ref()?.lookups / expected - 1.0).abs())
    });
    let caption = differences.max_by(f64::total_cmp).map_or_else(String::new, |greatest| {
        format!("Measured look-ups differ from expected ones by at most {} %.", short(100.0 * greatest))
    });
    let title = format!("Look-ups against σ_samp{}", at(albedo));
    let y = Axis::logarithmic("look-ups per estimate [1]").within(low, high);
    chart(medium, [&format!("{}-lookups", medium.id), &title], y, drawn).with_caption(caption)
}

/// The cost by which variance is multiplied.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Cost {
    Lookups,
    Seconds,
}

impl Cost {
    fn of(self, point: &SweepPoint) -> Option<f64> {
        match self {
            Self::Lookups => point.log10_efficiency_per_lookup,
            Self::Seconds => point.measured.as_ref()?.log10_efficiency_per_second,
        }
    }

    fn optimum(self, medium: &MediumReport, curve: &SweepCurve) -> Option<Optimum> {
        let optima = &medium.optima;
        let best = optima.iter().find(|it| it.series == curve.series && it.albedo == curve.albedo)?;
        if self == Self::Lookups { best.per_lookup } else { best.per_second }
    }
}

fn efficiency(medium: &MediumReport, cost: Cost) -> Chart {
    let albedo = middle_albedo(medium);
    let all = || curves(medium, albedo);
    let drawn = all().map(|it| {
        let best = cost.optimum(medium, it);
        let mark = |point: &SweepPoint| {
            let y = cost.of(point).filter(|y| y.is_finite())?;
            let is_best = best.is_some_and(|best| best.sigma_samp == point.sigma_samp);
            let mark = Mark::at(point.sigma_samp, 10_f64.powf(y));
            if is_best {
                Some(mark.noted("best of its curve"))
            } else {
                (cost == Cost::Seconds).then_some(mark)
            }
        };
        let mut drawn = curve(it, |point| cost.of(point), mark);
        if cost == Cost::Seconds {
            // Few points are measured: those between them are no gaps.
            drawn.line.retain(|point| point.y.is_some());
        }
        drawn
    });
    // The axis follows the unbiased estimators: a baseline that happens to hit the truth is arbitrarily efficient.
    let unbiased = all().filter(|curve| !curve.series.is_baseline());
    let values: Vec<f64> = unbiased.flat_map(|it| &it.points).filter_map(|point| cost.of(point)).collect();
    let top = values.iter().copied().filter(|x| x.is_finite()).fold(f64::NEG_INFINITY, f64::max).ceil() + 1.0;
    let [low, high] = decades(values.into_iter().chain([top]), [top - DEPTH, top]);
    let (title, unit, id) = match cost {
        Cost::Lookups => ("look-up", "T²/(MSE · look-ups) [1]", "lookup"),
        Cost::Seconds => ("CPU second", "T²/(MSE · CPU seconds) [1/s]", "second"),
    };
    let competing = all().filter(|curve| !curve.series.is_baseline() && !curve.series.is_oracle());
    let best = competing
        .filter_map(|curve| Some((curve.series, cost.optimum(medium, curve)?)))
        .max_by(|a, b| a.1.log10_efficiency.total_cmp(&b.1.log10_efficiency));
    let marks = match cost {
        Cost::Lookups => "A mark is the best of its curve.",
        Cost::Seconds => "Marks are measured points.",
    };
    let caption = best.map_or_else(String::new, |(series, best)| {
        format!(
            "{marks} Highest of the unbiased estimators without an oracle: {}, {} at σ_samp = {}{}.",
            series.label(),
            short_of_log10(best.log10_efficiency),
            short(best.sigma_samp),
            super::tables::where_it_lies(best.place)
        )
    });
    let title = format!("Efficiency per {title}{}", at(albedo));
    let y = Axis::logarithmic(unit).within(low, high);
    let id = format!("{}-efficiency-per-{id}", medium.id);
    chart(medium, [&id, &title], y, drawn.collect()).with_caption(caption)
}
