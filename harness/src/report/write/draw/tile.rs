//! Cells of heat maps.

use super::canvas::{Canvas, Drawn, Horizontal, Point, Stroke, Text};
use super::{INK, Rect};
use crate::report::write::palette::Rgb;
use plotters::backend::DrawingBackend;

/// Behind a hatch, and the hatch.
const PALE: Rgb = (0xF3, 0xF4, 0xF6);
const HATCH: Rgb = (0xB4, 0xB9, 0xC0);
/// Between two lines of a hatch.
const PITCH: f64 = 10.0;

/// A filled cell.
pub(crate) fn tile<DB: DrawingBackend>(canvas: &Canvas<DB>, rect: Rect, colour: Rgb) -> Drawn {
    canvas.area(&rect.corners(), colour, 1.0)
}

/// A cell without a value. The lines go on in its neighbours.
pub(crate) fn hatched<DB: DrawingBackend>(canvas: &Canvas<DB>, rect: Rect) -> Drawn {
    tile(canvas, rect, PALE)?;
    // Lines of constant x + y.
    let first = ((rect.left + rect.top) / PITCH).ceil() as i64;
    let last = ((rect.right + rect.bottom) / PITCH).floor() as i64;
    for sum in (first..=last).map(|k| k as f64 * PITCH) {
        let from = (sum - rect.bottom).max(rect.left);
        let to = (sum - rect.top).min(rect.right);
        canvas.line(&[(from, sum - from), (to, sum - to)], Stroke::solid(HATCH, 1.0))?;
    }
    Ok(())
}

/// A number on a coloured ground.
pub(crate) fn numbered<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    at: Point,
    number: usize,
    ground: Rgb,
) -> Drawn {
    let colour = if is_dark(ground) { (255, 255, 255) } else { INK };
    let look = Text { colour, bold: true, anchor: Horizontal::Centre, ..Text::LABEL };
    canvas.text(&number.to_string(), at, look)
}

/// Whether white stands out more than ink, by Rec. 601 luma.
fn is_dark((r, g, b): Rgb) -> bool {
    0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b) < 140.0
}
