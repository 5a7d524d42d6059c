//! A chart: panels, and a legend below them.

use super::axis::{Stretch, on};
use super::clip::{placed, runs};
use super::mark::mark;
use super::{
    Entry, FAINT, FONT, Figure, GRID, LETTERS, Outcome, WIDTH, colour, legend, legend_height, strokes,
};
use crate::palette::{Dash, Look, Looks, Marker};
use crate::{Arrangement, Axis, Chart, Curve, Panel, Role};
use plotters::coord::ranged1d::{NoDefaultFormatting, ValueFormatter};
use plotters::coord::{Shift, types::RangedCoordf64};
use plotters::prelude::*;

/// Height of the panels of a row, and of each panel of a column, in pixels.
const ROW: u32 = 620;
const COLUMN: u32 = 400;
/// Verticals of one chart differ in their dash, bands in their depth.
const VERTICALS: [(i32, i32); 4] = [(6, 6), (16, 6), (2, 5), (24, 5)];
const DEPTHS: [f64; 3] = [0.14, 0.26, 0.38];
/// Depth of the area about a curve.
const AREA: f64 = 0.25;

/// A chart on its way to a backend.
pub(super) struct Drawn<'a> {
    chart: &'a Chart,
    looks: &'a Looks<'a>,
    stretches: Vec<[Stretch; 2]>,
}

impl<'a> Drawn<'a> {
    pub(super) fn new(chart: &'a Chart, looks: &'a Looks<'a>) -> Self {
        Self { chart, looks, stretches: stretches(chart) }
    }

    /// All curves, each label once.
    fn labels(&self) -> Vec<&'a Curve> {
        let mut labels: Vec<&Curve> = Vec::new();
        for curve in self.chart.curves() {
            if labels.iter().all(|known| (known.role, &known.label) != (curve.role, &curve.label)) {
                labels.push(curve);
            }
        }
        labels
    }

    fn look(&self, curve: &Curve) -> Look {
        self.looks.get(curve.role, &curve.label)
    }

    fn remarks<DB: DrawingBackend + 'a>(&self) -> Vec<Entry<'a, DB>> {
        let marks = || self.chart.curves().flat_map(|curve| &curve.marks);
        let mut entries: Vec<Entry<'a, DB>> = Vec::new();
        let sign = |solid: bool| {
            move |area: &DrawingArea<DB, Shift>, at| area.draw(&mark(Marker::Circle, at, FAINT, solid))
        };
        if marks().any(|mark| mark.interval.is_some()) {
            entries.push((
                Box::new(move |area, (x, y)| {
                    area.draw(&PathElement::new([(x, y - 13), (x, y + 13)], FAINT.stroke_width(2)))?;
                    sign(true)(area, (x, y))
                }),
                "measured, 95 % interval",
            ));
        }
        if marks().any(|mark| !mark.solid) {
            entries.push((Box::new(sign(false)), "measured, not testable"));
        }
        let first = &self.chart.panels[0];
        for (k, vertical) in first.verticals.iter().enumerate() {
            let dash = VERTICALS[k % VERTICALS.len()];
            entries.push((
                Box::new(move |area, (x, y)| {
                    strokes(area, [x - 26, x + 26], y, Some(dash), FAINT.stroke_width(2))
                }),
                &vertical.label,
            ));
        }
        for (k, band) in first.bands.iter().enumerate() {
            let style = FAINT.mix(DEPTHS[k % DEPTHS.len()]).filled();
            entries.push((
                Box::new(move |area, (x, y)| {
                    area.draw(&Rectangle::new([(x - 26, y - 9), (x + 26, y + 9)], style))
                }),
                &band.label,
            ));
        }
        entries
    }

    fn entries<DB: DrawingBackend + 'a>(&self) -> Vec<Entry<'a, DB>> {
        let mut entries: Vec<Entry<'a, DB>> = Vec::new();
        for curve in self.labels() {
            let look = self.look(curve);
            entries.push((
                Box::new(move |area, (x, y)| {
                    if !curve.area.is_empty() {
                        let style = colour(look.colour).mix(AREA).filled();
                        area.draw(&Rectangle::new([(x - 26, y - 9), (x + 26, y + 9)], style))?;
                    }
                    if !curve.line.is_empty() {
                        let style = colour(look.colour).stroke_width(3);
                        strokes(area, [x - 26, x + 26], y, dash(look.dash), style)?;
                    }
                    if curve.marks.is_empty() {
                        return Ok(());
                    }
                    area.draw(&mark(look.marker, (x, y), colour(look.colour), true))
                }),
                &curve.label,
            ));
        }
        entries.extend(self.remarks());
        entries
    }

    fn legend_height(&self) -> u32 {
        let words: Vec<&str> = self.entries::<SVGBackend<'_>>().iter().map(|entry| entry.1).collect();
        legend_height(&words)
    }
}

/// Strokes and gaps in pixels; none for a solid line.
fn dash(dash: Dash) -> Option<(i32, i32)> {
    match dash {
        Dash::Solid => None,
        Dash::Long => Some((18, 7)),
        Dash::Short => Some((9, 6)),
        Dash::Dotted => Some((3, 5)),
    }
}

/// The stretches of the axes of each panel. Panels of a row share the vertical axis, panels of a column the horizontal one.
fn stretches(chart: &Chart) -> Vec<[Stretch; 2]> {
    let x = |panel: &Panel| panel.curves.iter().flat_map(places).collect::<Vec<f64>>();
    let y = |panel: &Panel| panel.curves.iter().flat_map(heights).collect::<Vec<f64>>();
    let all = |of: &dyn Fn(&Panel) -> Vec<f64>| chart.panels.iter().flat_map(of).collect::<Vec<f64>>();
    chart
        .panels
        .iter()
        .map(|panel| match chart.arrangement {
            Arrangement::Row => [Stretch::of(&panel.x, x(panel)), vertical(&panel.y, all(&y))],
            Arrangement::Column => [Stretch::of(&panel.x, all(&x)), vertical(&panel.y, y(panel))],
        })
        .collect()
}

/// The stretch of a vertical axis: with round ends, if it has none of its own.
fn vertical(axis: &Axis, values: Vec<f64>) -> Stretch {
    let stretch = Stretch::of(axis, values);
    if axis.range.is_none() { stretch.rounded() } else { stretch }
}

/// All places of a curve on the horizontal axis.
fn places(curve: &Curve) -> Vec<f64> {
    let lines = curve.line.iter().map(|point| point.x);
    let marks = curve.marks.iter().map(|mark| mark.x);
    lines.chain(marks).chain(curve.area.iter().map(|area| area.x)).collect()
}

/// All values of a curve on the vertical axis.
fn heights(curve: &Curve) -> Vec<f64> {
    let lines = curve.line.iter().filter_map(|point| point.y);
    let marks = curve.marks.iter().map(|mark| mark.y);
    lines.chain(marks).chain(curve.area.iter().flat_map(|area| area.y)).collect()
}

impl Figure for Drawn<'_> {
    fn size(&self) -> (u32, u32) {
        let panels = match self.chart.arrangement {
            Arrangement::Row => ROW,
            Arrangement::Column => COLUMN * self.chart.panels.len() as u32,
        };
        (WIDTH, panels + self.legend_height())
    }

    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Outcome<DB> {
        let height = self.size().1 - self.legend_height();
        let (panels, below) = area.split_vertically(height);
        let count = self.chart.panels.len();
        let places = match self.chart.arrangement {
            Arrangement::Row => panels.split_evenly((1, count)),
            Arrangement::Column => panels.split_evenly((count, 1)),
        };
        for (k, place) in places.iter().enumerate() {
            self.panel(k, place)?;
        }
        legend(&below, &self.entries())
    }
}

impl Drawn<'_> {
    fn panel<DB: DrawingBackend>(&self, k: usize, area: &DrawingArea<DB, Shift>) -> Outcome<DB> {
        let panel = &self.chart.panels[k];
        let [x, y] = self.stretches[k];
        let (first, last) = (k == 0, k + 1 == self.chart.panels.len());
        let row = self.chart.arrangement == Arrangement::Row;
        let titles = [
            if row || last { &*panel.x.title } else { "" },
            if !row || first { &*panel.y.title } else { "" },
        ];
        let mut builder = ChartBuilder::on(area);
        // The label of a tick at the upper end is half above it.
        builder.margin(10).margin_top(18).margin_right(20);
        if !panel.heading.is_empty() {
            builder.caption(&panel.heading, (FONT, LETTERS + 2, FontStyle::Bold));
        }
        let mut context = framed(builder, [x, y], titles, [6, if row { 7 } else { 5 }])?;
        for (k, band) in panel.bands.iter().enumerate() {
            let ends = [band.from, band.to].map(|end| on(&panel.x, end).clamp(x.low, x.high));
            let style = FAINT.mix(DEPTHS[k % DEPTHS.len()]).filled();
            context.draw_series([Rectangle::new([(ends[0], y.low), (ends[1], y.high)], style)])?;
        }
        for (k, vertical) in panel.verticals.iter().enumerate() {
            let place = on(&panel.x, vertical.x);
            let (size, spacing) = VERTICALS[k % VERTICALS.len()];
            if x.contains(place) {
                let ends = [(place, y.low), (place, y.high)];
                context.draw_series(DashedLineSeries::new(ends, size, spacing, FAINT.stroke_width(2)))?;
            }
        }
        // The first of the legend are drawn last, on top.
        for curve in panel.curves.iter().rev() {
            let look = self.look(curve);
            let ink = colour(look.colour);
            if !curve.area.is_empty() {
                let end = |which: usize| {
                    curve.area.iter().map(move |at| (on(&panel.x, at.x), on(&panel.y, at.y[which])))
                };
                let outline = end(0).chain(end(1).collect::<Vec<_>>().into_iter().rev());
                let inside = outline.map(|(a, b)| (a.clamp(x.low, x.high), b.clamp(y.low, y.high)));
                context.draw_series([Polygon::new(inside.collect::<Vec<_>>(), ink.mix(AREA).filled())])?;
            }
            let width = if curve.role == Role::Reference { 4 } else { 3 };
            for run in runs(curve, panel, [x, y]) {
                let style = ink.stroke_width(width);
                match dash(look.dash) {
                    None => context.draw_series(LineSeries::new(run, style))?,
                    Some((size, gap)) => context.draw_series(DashedLineSeries::new(run, size, gap, style))?,
                };
            }
        }
        for curve in panel.curves.iter().rev() {
            let look = self.look(curve);
            let ink = colour(look.colour);
            let marks = || curve.marks.iter().map(|it| (it, placed(it, panel, [x, y], look.marker)));
            for (it, (at, _)) in marks().filter(|(it, (at, _))| at.1 == on(&panel.y, it.y)) {
                let Some(interval) = it.interval else { continue };
                let ends = interval.map(|end| (at.0, on(&panel.y, end).max(y.low).min(y.high)));
                context.draw_series([PathElement::new(ends, ink.stroke_width(2))])?;
            }
            for (it, (at, marker)) in marks() {
                context.plotting_area().draw(&mark(marker, at, ink, it.solid))?;
            }
        }
        Ok(())
    }
}

/// A chart of plotters with its axes drawn: linear in units of length, with ticks of ours.
pub(super) type Context<'a, DB> = ChartContext<'a, DB, Cartesian2d<Ticked, Ticked>>;

/// An axis with ticks.
pub(super) struct Ticked {
    inner: RangedCoordf64,
    ticks: Vec<(f64, String)>,
    ends: [f64; 2],
}

impl Ticked {
    fn new(stretch: Stretch, count: usize) -> Self {
        let Stretch { low, high, .. } = stretch;
        Self { inner: (low..high).into(), ticks: stretch.ticks(count), ends: [low, high] }
    }
}

impl Ranged for Ticked {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.inner.map(value, limit)
    }

    fn key_points<Hint: plotters::coord::ranged1d::KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.iter().map(|(place, _)| *place).collect()
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.ends[0]..self.ends[1]
    }
}

impl ValueFormatter<f64> for Ticked {
    fn format(_: &f64) -> String {
        String::new()
    }

    fn format_ext(&self, value: &f64) -> String {
        self.ticks
            .iter()
            .find(|(place, _)| place == value)
            .map_or_else(String::new, |(_, label)| label.clone())
    }
}

/// Draws axes with titles and about so many ticks each.
pub(super) fn framed<'a, DB: DrawingBackend>(
    mut builder: ChartBuilder<'a, '_, DB>,
    [x, y]: [Stretch; 2],
    [x_title, y_title]: [&str; 2],
    [across, up]: [usize; 2],
) -> Result<Context<'a, DB>, DrawingAreaErrorKind<DB::ErrorType>> {
    builder.x_label_area_size(if x_title.is_empty() { 34 } else { 66 });
    builder.y_label_area_size(if y_title.is_empty() { 70 } else { 108 });
    let mut context = builder.build_cartesian_2d(Ticked::new(x, across), Ticked::new(y, up))?;
    context
        .configure_mesh()
        .x_desc(x_title)
        .y_desc(y_title)
        .axis_desc_style((FONT, LETTERS))
        .label_style((FONT, LETTERS - 2))
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .draw()?;
    Ok(context)
}
