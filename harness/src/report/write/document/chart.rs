//! A chart: one panel, a legend below it, and all its points as CSV.

use super::super::draw::{Axis, Canvas, Draw, Drawing, Drawn, FAINT, Fill, INK, Labels, Legend, Panel};
use super::super::draw::{Sign, Stroke, both};
use super::super::figure::{FOOT, LEGEND_LEFT, LEGEND_WIDTH, frame};
use super::super::palette::Marker;
use super::super::table::{Cell, Table};
use super::styles::Styles;
use crate::report::document::{self, Chart, Curve, Mark, Role, Scale};
use plotters::backend::DrawingBackend;

pub(super) const TOP: f64 = 24.0;
const HEIGHT: f64 = 760.0;
/// A logarithmic axis goes no further below its greatest value: the rest of the curves would be flat.
pub(super) const DECADES: f64 = 12.0;
/// Verticals of one chart differ in their dash.
const VERTICALS: [&[f64]; 4] = [&[6.0, 6.0], &[16.0, 6.0], &[2.0, 5.0], &[16.0, 5.0, 3.0, 5.0]];
/// Bands of one chart differ in their depth.
const OPACITIES: [f64; 3] = [0.14, 0.26, 0.38];

/// A chart on its way into files and the page.
pub(super) struct Finished<'a> {
    pub(super) id: &'a str,
    pub(super) chart: &'a Chart,
    pub(super) csv: String,
    pub(super) drawing: Drawing,
}

/// Draws a chart and tabulates it.
pub(super) fn finished<'a>(chart: &'a Chart, styles: &Styles) -> Result<Finished<'a>, String> {
    let drawing = both(&Figure { chart, styles }).map_err(|error| format!("chart {}: {error}", chart.id))?;
    Ok(Finished { id: &chart.id, chart, csv: csv(chart), drawing })
}

struct Figure<'a> {
    chart: &'a Chart,
    styles: &'a Styles,
}

/// A value in the units of a drawn axis: its log10 on a logarithmic one, where a negative value has no place.
pub(super) fn on(axis: &document::Axis, value: f64) -> f64 {
    match axis.scale {
        Scale::Linear => value,
        // Minus infinity for zero: below every range.
        Scale::Logarithmic if value >= 0.0 => value.log10(),
        Scale::Logarithmic => f64::NAN,
    }
}

/// The same for the end of an interval: one that reaches below zero reaches to zero.
fn end(axis: &document::Axis, value: f64) -> f64 {
    if axis.scale == Scale::Logarithmic { on(axis, value.max(0.0)) } else { value }
}

impl Figure<'_> {
    fn marks(&self) -> impl Iterator<Item = &Mark> {
        self.chart.curves.iter().flat_map(|curve| &curve.marks)
    }

    /// All drawn ordinates, without their intervals.
    fn ordinates(&self) -> impl Iterator<Item = f64> {
        let lines = self.chart.curves.iter().flat_map(|curve| &curve.line).filter_map(|point| point.y);
        lines.chain(self.marks().map(|mark| mark.y)).map(|y| on(&self.chart.y, y))
    }

    fn x(&self) -> Axis {
        let axis = &self.chart.x;
        if let Some(range) = axis.range {
            return exactly(axis, range);
        }
        let lines = self.chart.curves.iter().flat_map(|curve| &curve.line).map(|point| point.x);
        let marked = self.chart.verticals.iter().map(|vertical| vertical.x);
        let bands = self.chart.bands.iter().flat_map(|band| [band.from, band.to]);
        let all = lines.chain(self.marks().map(|mark| mark.x)).chain(marked).chain(bands);
        let all = all.map(|x| on(axis, x));
        match axis.scale {
            Scale::Linear => Axis::linear(&axis.title, all),
            Scale::Logarithmic => Axis::logarithmic(&axis.title, all),
        }
    }

    fn y(&self) -> Axis {
        let axis = &self.chart.y;
        if let Some(range) = axis.range {
            return exactly(axis, range);
        }
        let intervals = || self.marks().filter_map(|mark| mark.interval);
        match axis.scale {
            Scale::Linear => Axis::linear(&axis.title, self.ordinates().chain(intervals().flatten())),
            Scale::Logarithmic => {
                // A lower end near zero would squeeze all else: bars are cut at the axis.
                let upper = intervals().map(|[_, high]| end(axis, high));
                let values: Vec<f64> = self.ordinates().chain(upper).filter(|y| y.is_finite()).collect();
                let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil();
                let limits =
                    if top.is_finite() { [top - DECADES, top.max(top - DECADES + 1.0)] } else { [-1.0, 1.0] };
                Axis::decades(&axis.title, values, limits)
            }
        }
    }

    fn legend(&self) -> Legend {
        let mut entries: Vec<(Sign, String)> = Vec::new();
        for curve in &self.chart.curves {
            if entries.iter().all(|entry| entry.1 != curve.label) {
                entries.push((self.sign(curve), curve.label.clone()));
            }
        }
        let lines = self.chart.curves.iter().any(|curve| !curve.line.is_empty());
        if self.marks().any(|mark| mark.interval.is_some()) {
            entries.push((Sign::Interval, "measured, 95 % interval".to_owned()));
        } else if lines && self.marks().next().is_some() {
            entries.push((Sign::Mark(Marker::Circle, FAINT, Fill::Solid), "measured".to_owned()));
        }
        if self.marks().any(|mark| !mark.solid) {
            let sign = Sign::Mark(Marker::Circle, FAINT, Fill::Hollow);
            entries.push((sign, "measured, not testable".to_owned()));
        }
        let y = self.y();
        if self.ordinates().any(|value| !value.is_nan() && !y.shows(value)) {
            let sign = Sign::Mark(Marker::TriangleUp, FAINT, Fill::Solid);
            entries.push((sign, "leaves the figure".to_owned()));
        }
        for (k, vertical) in self.chart.verticals.iter().enumerate() {
            entries.push((Sign::Line(vertical_stroke(k)), vertical.label.clone()));
        }
        for (k, band) in self.chart.bands.iter().enumerate() {
            entries.push((Sign::Area(FAINT, OPACITIES[k % OPACITIES.len()]), band.label.clone()));
        }
        Legend::of(entries, LEGEND_WIDTH)
    }

    /// A line, a mark or both, as the curves of this name have them.
    fn sign(&self, curve: &Curve) -> Sign {
        let same = || self.chart.curves.iter().filter(|other| other.label == curve.label);
        let style = self.styles.style(curve);
        match (same().any(|curve| !curve.line.is_empty()), same().any(|curve| !curve.marks.is_empty())) {
            (true, false) => Sign::Line(self.stroke(curve)),
            (false, true) => Sign::Mark(style.marker, style.colour, Fill::Solid),
            _ => Sign::Curve(style),
        }
    }

    fn stroke(&self, curve: &Curve) -> Stroke {
        let style = self.styles.style(curve);
        let width = if curve.role == Role::Reference { 4.0 } else { 2.5 };
        Stroke { colour: style.colour, width, dash: style.dash }
    }
}

fn exactly(axis: &document::Axis, range: [f64; 2]) -> Axis {
    match axis.scale {
        Scale::Linear => Axis::exactly(&axis.title, range[0], range[1]),
        Scale::Logarithmic => Axis::logarithmic(&axis.title, range.map(f64::log10)),
    }
}

fn vertical_stroke(k: usize) -> Stroke {
    let colour = if k == 0 { FAINT } else { INK };
    Stroke { colour, width: 2.0, dash: VERTICALS[k % VERTICALS.len()] }
}

impl Draw for Figure<'_> {
    fn size(&self) -> [u32; 2] {
        frame(TOP, HEIGHT, &self.legend()).1
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn {
        let (chart, legend) = (self.chart, self.legend());
        let (rect, _) = frame(TOP, HEIGHT, &legend);
        let panel = Panel { rect, x: self.x(), y: self.y() };
        for (k, band) in chart.bands.iter().enumerate() {
            let [low, high] = panel.x.range();
            let (from, to) = (end(&chart.x, band.from), end(&chart.x, band.to));
            if from <= high && to >= low {
                let (left, right) = (panel.place(from, 0.0).0, panel.place(to, 0.0).0);
                let corners =
                    [(left, rect.top), (right, rect.top), (right, rect.bottom), (left, rect.bottom)];
                canvas.area(&corners, FAINT, OPACITIES[k % OPACITIES.len()])?;
            }
        }
        panel.axes(canvas, Labels::Both)?;
        for (k, vertical) in chart.verticals.iter().enumerate() {
            panel.vertical_of(canvas, on(&chart.x, vertical.x), vertical_stroke(k))?;
        }
        // The first of the legend are drawn last, on top; marks lie above all lines.
        for curve in chart.curves.iter().rev() {
            let place = |point: &document::Point| {
                let (x, y) = (on(&chart.x, point.x), on(&chart.y, point.y?));
                (!x.is_nan() && !y.is_nan()).then_some((x, y))
            };
            let line: Vec<_> = curve.line.iter().map(place).collect();
            panel.curve(canvas, &line, self.stroke(curve))?;
        }
        for curve in chart.curves.iter().rev() {
            let style = self.styles.style(curve);
            for mark in &curve.marks {
                let at = (on(&chart.x, mark.x), on(&chart.y, mark.y));
                let interval = mark.interval.map(|ends| ends.map(|y| end(&chart.y, y)));
                let fill = if mark.solid { Fill::Solid } else { Fill::Hollow };
                panel.mark(canvas, at, interval, (style.marker, style.colour, fill))?;
            }
        }
        legend.draw(canvas, (LEGEND_LEFT, rect.bottom + FOOT))
    }
}

/// One row per point of a line and per mark.
fn csv(chart: &Chart) -> String {
    let mut table = Table::new(&[
        "curve",
        "kind",
        &chart.x.title,
        &chart.y.title,
        "lower end of 95 % interval",
        "upper end of 95 % interval",
        "testable",
    ]);
    for curve in &chart.curves {
        for point in &curve.line {
            table.row(&[
                Cell::Text(&curve.label),
                Cell::Text("line"),
                Cell::Number(point.x),
                Cell::Maybe(point.y),
                Cell::Maybe(None),
                Cell::Maybe(None),
                Cell::MaybeFlag(None),
            ]);
        }
        for mark in &curve.marks {
            table.row(&[
                Cell::Text(&curve.label),
                Cell::Text("mark"),
                Cell::Number(mark.x),
                Cell::Number(mark.y),
                Cell::Maybe(mark.interval.map(|ends| ends[0])),
                Cell::Maybe(mark.interval.map(|ends| ends[1])),
                Cell::Flag(mark.solid),
            ]);
        }
    }
    table.into_csv()
}
