//! The legend below the panels: it covers no data.

use super::super::palette::{Rgb, Style, look, rank};
use super::canvas::{Canvas, Drawn, Stroke, Text};
use super::marks::Fill;
use super::{FAINT, INK, Rect, hatched, numbered, tile};
use crate::report::result::Series;
use crate::report::write::palette::Marker;
use plotters::backend::DrawingBackend;

const ROW: f64 = 36.0;
const KEY: f64 = 88.0;
const GAP: f64 = 30.0;

/// What stands in front of an entry.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sign {
    /// Line and mark of a curve.
    Curve(Style),
    /// A line alone.
    Line(Stroke),
    /// A shaded area.
    Area(Rgb, f64),
    /// A mark alone.
    Mark(Marker, Rgb, Fill),
    /// A mark with an interval.
    Interval,
    /// A line in a casing.
    Cased,
    /// A filled cell with the number of its name.
    Tile(Rgb, usize),
    /// A cell without a value.
    Hatched,
}

/// Entries of a legend, laid out in columns.
pub(crate) struct Legend {
    entries: Vec<(Sign, String)>,
    columns: usize,
    width: f64,
}

impl Legend {
    /// The series that appear, in the order of the palette, then the remarks. Parameters are said in the page and in the tables.
    pub(crate) fn new(
        series: impl IntoIterator<Item = Series>,
        remarks: &[(Sign, &str)],
        width: f64,
    ) -> Self {
        let mut known: Vec<Series> = series.into_iter().collect();
        known.sort_by_key(|&series| rank(series));
        known.dedup();
        let series =
            known.into_iter().map(look).map(|look| (Sign::Curve(look.style()), look.name.to_owned()));
        let remarks = remarks.iter().map(|&(sign, text)| (sign, text.to_owned()));
        Self::of(series.chain(remarks).collect(), width)
    }

    /// These entries, in their order.
    pub(crate) fn of(entries: Vec<(Sign, String)>, width: f64) -> Self {
        let longest = entries.iter().map(|(_, text)| Text::LABEL.width_of(text)).fold(0.0, f64::max);
        let columns = ((width + GAP) / (KEY + longest + GAP)).floor().clamp(1.0, 4.0) as usize;
        Self { entries, columns, width }
    }

    /// The remarks of a sweep: intervals, hollow marks, the maximum, curves that leave.
    pub(crate) fn sweep_remarks() -> [(Sign, &'static str); 4] {
        [
            (Sign::Interval, "measured, 95 % interval"),
            (Sign::Mark(Marker::Circle, FAINT, Fill::Hollow), "measured, not testable"),
            (Sign::Mark(Marker::TriangleUp, FAINT, Fill::Solid), "leaves the figure"),
            Self::maximum(),
        ]
    }

    /// The line at the maximum on the ray.
    pub(crate) fn maximum() -> (Sign, &'static str) {
        (Sign::Line(Stroke { colour: FAINT, width: 2.0, dash: &[6.0, 6.0] }), "greatest σ_t on the ray")
    }

    /// Height in pixels.
    pub(crate) fn height(&self) -> f64 {
        ROW * self.entries.len().div_ceil(self.columns) as f64
    }

    /// Draws the legend with its upper left corner here. Entries run down the columns.
    pub(crate) fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, (left, top): (f64, f64)) -> Drawn {
        let rows = self.entries.len().div_ceil(self.columns);
        for (k, (sign, text)) in self.entries.iter().enumerate() {
            let x = left + (k / rows) as f64 * (self.width + GAP) / self.columns as f64;
            let y = top + ((k % rows) as f64 + 0.5) * ROW;
            draw_sign(canvas, *sign, (x, y))?;
            canvas.text(text, (x + KEY, y), Text::LABEL)?;
        }
        Ok(())
    }
}

fn draw_sign<DB: DrawingBackend>(canvas: &Canvas<DB>, sign: Sign, (x, y): (f64, f64)) -> Drawn {
    let line = [(x, y), (x + KEY - 16.0, y)];
    let middle = (x + (KEY - 16.0) / 2.0, y);
    let area = Rect { left: line[0].0, top: y - 10.0, right: line[1].0, bottom: y + 10.0 };
    // High enough for a number.
    let cell = Rect { top: y - 14.0, bottom: y + 14.0, ..area };
    match sign {
        Sign::Curve(style) => {
            canvas.line(&line, Stroke { colour: style.colour, width: 3.0, dash: style.dash })?;
            canvas.mark(style.marker, middle, 8.0, style.colour, Fill::Solid)
        }
        Sign::Line(stroke) => canvas.line(&line, stroke),
        Sign::Area(colour, opacity) => canvas.area(&area.corners(), colour, opacity),
        Sign::Cased => Stroke::CASED.into_iter().try_for_each(|stroke| canvas.line(&line, stroke)),
        Sign::Tile(colour, number) => {
            tile(canvas, cell, colour)?;
            numbered(canvas, middle, number, colour)
        }
        Sign::Hatched => hatched(canvas, cell),
        Sign::Mark(marker, colour, fill) => canvas.mark(marker, middle, 8.0, colour, fill),
        Sign::Interval => {
            canvas.line(&[(middle.0, y - 14.0), (middle.0, y + 14.0)], Stroke::solid(INK, 2.0))?;
            for end in [y - 14.0, y + 14.0] {
                canvas.line(&[(middle.0 - 5.0, end), (middle.0 + 5.0, end)], Stroke::solid(INK, 2.0))?;
            }
            canvas.mark(Marker::Circle, middle, 7.5, INK, Fill::Solid)
        }
    }
}
