//! Variance against σ_samp: closed forms as lines, measurements as marks.

use super::sweep::{SIGMA_SAMP, curves, positions, stroke};
use super::{FOOT, Figure, LEGEND_LEFT, LEGEND_WIDTH, frame};
use crate::report::result::{MediumReport, SweepCurve, SweepPoint};
use crate::report::write::draw::{Axis, Canvas, Draw, Drawn, Fill, Labels, Legend, Panel};
use crate::report::write::number::{listed, power_of_ten, short};
use crate::report::write::palette::look;
use crate::report::write::table::{Cell, Table};
use plotters::backend::DrawingBackend;

/// One albedo.
pub(super) struct Variance<'a> {
    pub(super) medium: &'a MediumReport,
    pub(super) albedo: Option<f64>,
}

const TOP: f64 = 24.0;
const HEIGHT: f64 = 760.0;
/// Decades beyond which no curve is followed.
const LIMITS: [f64; 2] = [-6.0, 12.0];

impl Variance<'_> {
    fn curves(&self) -> Vec<&SweepCurve> {
        curves(self.medium, self.albedo)
    }

    fn y(&self) -> Axis {
        let values = self.curves().into_iter().flat_map(|curve| &curve.points).flat_map(|point| {
            let measured = point.measured.as_ref().map(|measured| measured.relative_variance.log10());
            [point.log10_relative_variance, measured]
        });
        Axis::decades("Var/T² [1]", values.flatten(), LIMITS)
    }

    fn legend(&self) -> Legend {
        let series = self.curves().into_iter().map(|curve| curve.series);
        Legend::new(series, &Legend::sweep_remarks(), LEGEND_WIDTH)
    }

    fn at_albedo(&self) -> String {
        self.albedo.map_or_else(String::new, |albedo| format!(" at albedo {albedo}"))
    }
}

impl Draw for Variance<'_> {
    fn size(&self) -> [u32; 2] {
        frame(TOP, HEIGHT, &self.legend()).1
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn {
        let legend = self.legend();
        let (rect, _) = frame(TOP, HEIGHT, &legend);
        let panel = Panel { rect, x: Axis::logarithmic(SIGMA_SAMP, positions(self.medium)), y: self.y() };
        panel.axes(canvas, Labels::Both)?;
        panel.vertical(canvas, self.medium.ray.maximum.log10())?;
        let curves = self.curves();
        for curve in curves.iter().rev() {
            panel.curve(canvas, &line(curve), stroke(curve, 3.0))?;
        }
        for curve in curves.iter().rev() {
            let look = look(curve.series);
            for point in &curve.points {
                let Some(measured) = &point.measured else { continue };
                let interval = measured.relative_variance_interval.map(|x| x.max(0.0).log10());
                let fill = if measured.testable { Fill::Solid } else { Fill::Hollow };
                let at = (point.sigma_samp.log10(), measured.relative_variance.log10());
                let interval = measured.testable.then_some(interval);
                panel.mark(canvas, at, interval, (look.marker, look.colour, fill))?;
            }
        }
        legend.draw(canvas, (LEGEND_LEFT, rect.bottom + FOOT))
    }
}

/// The closed form; gaps where the estimator is not defined.
fn line(curve: &SweepCurve) -> Vec<Option<(f64, f64)>> {
    let place = |point: &SweepPoint| {
        let y = point.log10_relative_variance.filter(|y| point.in_domain && !y.is_nan())?;
        Some((point.sigma_samp.log10(), y))
    };
    curve.points.iter().map(place).collect()
}

impl Figure for Variance<'_> {
    fn id(&self) -> String {
        let albedo = self.albedo.map_or_else(String::new, |albedo| format!("-albedo-{albedo}"));
        format!("{}-variance{albedo}", self.medium.id)
    }

    fn title(&self) -> String {
        format!("Variance against σ_samp{}", self.at_albedo())
    }

    fn caption(&self) -> String {
        let curves = self.curves();
        // A baseline is known to be biased: that its test fails is no news.
        let unbiased = || curves.iter().filter(|curve| !curve.series.is_baseline());
        let measured =
            || unbiased().flat_map(|curve| &curve.points).filter_map(|point| point.measured.as_ref());
        let (total, testable) = (measured().count(), measured().filter(|m| m.testable).count());
        let verdict = |sound| measured().filter(|m| m.sound == sound).count();
        let [low, high] = self.y().range();
        let mut caption = format!(
            "Variance of one estimate in units of T² (of the biased baselines: mean squared error). Lines are closed forms, marks are \
             measured. Of {total} measured points of unbiased estimators {testable} can test the variance (filled marks). By all that can \
             be tested, mean or variance, {} agree with the closed forms, {} do not, and {} cannot tell. The vertical line is the \
             greatest σ_t on the ray, {}. The axis shows {} to {}; a triangle is where a curve leaves it.",
            verdict(Some(true)),
            verdict(Some(false)),
            verdict(None),
            short(self.medium.ray.maximum),
            power_of_ten(low as i32),
            power_of_ten(high as i32),
        );
        let bounded: Vec<String> = curves.iter().filter_map(|curve| domain(curve)).collect();
        if !bounded.is_empty() {
            caption.push_str(&format!(" Not defined on the whole axis: {}.", listed(&bounded)));
        }
        caption
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&[
            "series",
            "parameters",
            "albedo [1]",
            "sigma_samp [1/length]",
            "in_domain",
            "closed form log10(Var/T^2) [1]",
            "samples",
            "measured Var/T^2 [1]",
            "lower end of 95 % interval [1]",
            "upper end of 95 % interval [1]",
            "testable",
            "mean z [1]",
            "variance z [1]",
            "sound",
        ]);
        for curve in self.curves() {
            for point in &curve.points {
                let measured = point.measured.as_ref();
                table.row(&[
                    Cell::Text(look(curve.series).name),
                    Cell::Text(&curve.parameters),
                    Cell::Maybe(curve.albedo),
                    Cell::Number(point.sigma_samp),
                    Cell::Flag(point.in_domain),
                    Cell::Maybe(point.log10_relative_variance),
                    measured.map_or(Cell::Maybe(None), |m| Cell::Count(m.samples)),
                    Cell::Maybe(measured.map(|m| m.relative_variance)),
                    Cell::Maybe(measured.map(|m| m.relative_variance_interval[0])),
                    Cell::Maybe(measured.map(|m| m.relative_variance_interval[1])),
                    Cell::MaybeFlag(measured.map(|m| m.testable)),
                    Cell::Maybe(measured.and_then(|m| m.mean_z)),
                    Cell::Maybe(measured.and_then(|m| m.variance_z)),
                    Cell::MaybeFlag(measured.and_then(|m| m.sound)),
                ]);
            }
        }
        table
    }
}

/// Where a curve is defined, in words; none if everywhere or nowhere.
fn domain(curve: &SweepCurve) -> Option<String> {
    let inside = |point: &&SweepPoint| point.in_domain;
    let first = curve.points.iter().position(|point| point.in_domain)?;
    let last = curve.points.iter().rposition(|point| point.in_domain)?;
    let count = curve.points.iter().filter(inside).count();
    if count == curve.points.len() {
        return None;
    }
    let name = look(curve.series).name;
    let (low, high) = (short(curve.points[first].sigma_samp), short(curve.points[last].sigma_samp));
    Some(if last + 1 == curve.points.len() {
        format!("{name} (from {low})")
    } else if first == 0 {
        format!("{name} (up to {high})")
    } else {
        format!("{name} ({low} to {high})")
    })
}
