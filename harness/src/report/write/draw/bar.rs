//! A colour bar: which value has which colour.

use super::super::colour_map::{LEVELS, sequential};
use super::canvas::{Canvas, Drawn, Stroke, Text};
use super::{Axis, INK, Rect, tile};
use plotters::backend::DrawingBackend;

/// How far the title is right of a bar.
const TITLE: f64 = 100.0;
/// Height of the triangles for what lies beyond.
const TIP: f64 = 24.0;

/// An upright bar with its axis on the right.
pub(crate) struct ColourBar<'a> {
    /// The whole place of the colours.
    pub(crate) rect: Rect,
    /// Values, as log10 on a logarithmic axis.
    pub(crate) axis: &'a Axis,
    /// Whether values lie below and above the axis: a triangle shows their colour.
    pub(crate) beyond: [bool; 2],
    /// Values that are marked across it.
    pub(crate) marks: &'a [f64],
}

impl ColourBar<'_> {
    /// Room that the labels and the title need on the right of the rectangle.
    pub(crate) const ROOM: f64 = TITLE + 24.0;

    /// Draws the bar.
    pub(crate) fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn {
        let Rect { left, top, right, bottom } = self.rect;
        let [below, above] = self.beyond.map(|beyond| if beyond { TIP } else { 0.0 });
        let (foot, head) = (bottom - below, top + above);
        let middle = f64::midpoint(left, right);
        let at = |fraction: f64| foot - fraction * (foot - head);
        // From the highest on, each down to the foot: between rectangles that only meet, the ground would shine through.
        for level in (0..LEVELS).rev() {
            let top = at(f64::from(level + 1) / f64::from(LEVELS));
            tile(canvas, Rect { left, top, right, bottom: foot }, sequential(level))?;
        }
        // The outline runs around the tips.
        let mut outline = vec![(left, foot)];
        if below > 0.0 {
            canvas.area(&[(left, foot), (right, foot), (middle, bottom)], sequential(0), 1.0)?;
            outline.push((middle, bottom));
        }
        outline.extend([(right, foot), (right, head)]);
        if above > 0.0 {
            canvas.area(&[(left, head), (right, head), (middle, top)], sequential(LEVELS - 1), 1.0)?;
            outline.push((middle, top));
        }
        outline.extend([(left, head), (left, foot)]);
        for &mark in self.marks.iter().filter(|mark| self.axis.shows(**mark)) {
            let y = at(self.axis.fraction(mark));
            for stroke in Stroke::CASED {
                canvas.line(&[(left, y), (right, y)], stroke)?;
            }
        }
        canvas.line(&outline, Stroke::solid(INK, 1.5))?;
        for tick in self.axis.ticks((((bottom - top) / 58.0) as usize).max(2)) {
            let y = at(self.axis.fraction(tick.at));
            let length = if tick.label.is_empty() { 5.0 } else { 9.0 };
            canvas.line(&[(right, y), (right + length, y)], Stroke::solid(INK, 1.0))?;
            canvas.text(&tick.label, (right + 14.0, y), Text::LABEL)?;
        }
        let look = Text { upright: true, ..Text::TITLE };
        canvas.text(self.axis.title(), (right + TITLE, f64::midpoint(top, bottom)), look)
    }
}
