//! Lines, areas and text in pixels, on any backend of plotters.

use super::super::palette::{Dash, Rgb};
use super::marks::{Fill, outline};
use crate::report::write::palette::Marker;
use plotters::backend::DrawingBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{PathElement, Polygon, Text as TextElement};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color, FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, ShapeStyle, TextStyle, WHITE,
    register_font,
};

/// Coordinates of the backend per pixel.
pub(super) const FINENESS: u32 = 2;
const FAMILY: FontFamily<'static> = FontFamily::SansSerif;
/// plotters sizes a font by its line height, this much above the em.
const LINE_HEIGHT: f64 = 1.24;

/// A library's errors differ by backend; a message is all that is ever done with them.
pub(crate) type Drawn = Result<(), String>;

/// A point in pixels, y downwards.
pub(crate) type Point = (f64, f64);

/// The shipped fonts replace those of the system, which may have none. Registering again does no harm.
pub(super) fn register_fonts() -> Drawn {
    let fonts = [(FontStyle::Normal, dejavu::sans::regular()), (FontStyle::Bold, dejavu::sans::bold())];
    for (style, bytes) in fonts {
        register_font(FAMILY.as_str(), style, bytes)
            .map_err(|_| "the shipped font cannot be read".to_owned())?;
    }
    Ok(())
}

/// How a line looks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    pub(crate) colour: Rgb,
    pub(crate) width: f64,
    pub(crate) dash: Dash,
}

impl Stroke {
    /// A solid line.
    pub(crate) const fn solid(colour: Rgb, width: f64) -> Self {
        Self { colour, width, dash: &[] }
    }

    /// A dark line in a light casing, which stands out from any colour: both, the casing first.
    pub(crate) const CASED: [Self; 2] = [Self::solid((255, 255, 255), 4.5), Self::solid(super::INK, 2.0)];
}

/// Which part of the text is at its point.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Horizontal {
    Left,
    Centre,
    Right,
}

/// How a text looks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Text {
    pub(crate) size: f64,
    pub(crate) colour: Rgb,
    pub(crate) bold: bool,
    pub(crate) anchor: Horizontal,
    /// Reads upwards.
    pub(crate) upright: bool,
}

impl Text {
    /// Text of the size of tick labels and legends.
    pub(crate) const LABEL: Self =
        Self { size: 23.0, colour: super::INK, bold: false, anchor: Horizontal::Left, upright: false };
    /// Titles of axes.
    pub(crate) const TITLE: Self = Self { size: 25.0, anchor: Horizontal::Centre, ..Self::LABEL };

    fn font(&self) -> FontDesc<'static> {
        let style = if self.bold { FontStyle::Bold } else { FontStyle::Normal };
        FontDesc::new(FAMILY, self.size * LINE_HEIGHT * f64::from(FINENESS), style)
    }

    /// Width in pixels in the shipped font, which is a wide one: others fit where it does.
    pub(crate) fn width_of(&self, text: &str) -> f64 {
        let fine = self.font().box_size(text).map_or(0, |(width, _)| width);
        f64::from(fine) / f64::from(FINENESS)
    }
}

/// A backend with a white background.
pub(crate) struct Canvas<DB: DrawingBackend> {
    area: DrawingArea<DB, Shift>,
    /// How far this backend must lower a text to centre it, in units of the font size.
    sink: f64,
}

impl<DB: DrawingBackend> Canvas<DB> {
    pub(super) fn on(backend: DB, sink: f64) -> Result<Self, String> {
        let area = backend.into_drawing_area();
        area.fill(&WHITE).map_err(|error| error.to_string())?;
        Ok(Self { area, sink })
    }

    pub(super) fn finish(&self) -> Drawn {
        self.area.present().map_err(|error| error.to_string())
    }

    /// An open line through the points.
    pub(crate) fn line(&self, points: &[Point], stroke: Stroke) -> Drawn {
        for piece in dashed(points, stroke.dash) {
            let mut fine: Vec<(i32, i32)> = piece.into_iter().map(fine).collect();
            fine.dedup();
            let width = (stroke.width * f64::from(FINENESS)).round().max(1.0) as u32;
            let style =
                ShapeStyle { color: ink(stroke.colour).to_rgba(), filled: false, stroke_width: width };
            self.area.draw(&PathElement::new(fine, style)).map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// A filled area of this opacity.
    pub(crate) fn area(&self, outline: &[Point], colour: Rgb, opacity: f64) -> Drawn {
        let fine: Vec<(i32, i32)> = outline.iter().copied().map(fine).collect();
        self.area
            .draw(&Polygon::new(fine, ink(colour).mix(opacity).filled()))
            .map_err(|error| error.to_string())
    }

    /// A mark; a hollow one hides what is behind it.
    pub(crate) fn mark(&self, marker: Marker, at: Point, radius: f64, colour: Rgb, fill: Fill) -> Drawn {
        self.area(&outline(marker, at, radius), colour, 1.0)?;
        match fill {
            Fill::Solid => Ok(()),
            Fill::Hollow => self.area(&outline(marker, at, 0.66 * radius), (255, 255, 255), 1.0),
        }
    }

    /// A text, vertically centred on its point.
    pub(crate) fn text(&self, text: &str, at: Point, look: Text) -> Drawn {
        let horizontal = match look.anchor {
            Horizontal::Left => HPos::Left,
            Horizontal::Centre => HPos::Center,
            Horizontal::Right => HPos::Right,
        };
        let sink = self.sink * look.size * LINE_HEIGHT;
        let at = if look.upright { (at.0 + sink, at.1) } else { (at.0, at.1 + sink) };
        let transform = if look.upright { FontTransform::Rotate270 } else { FontTransform::None };
        let colour = ink(look.colour);
        let style = TextStyle::from(look.font())
            .color(&colour)
            .transform(transform)
            .pos(Pos::new(horizontal, VPos::Center));
        self.area.draw(&TextElement::new(text.to_owned(), fine(at), style)).map_err(|error| error.to_string())
    }
}

fn ink((r, g, b): Rgb) -> RGBColor {
    RGBColor(r, g, b)
}

fn fine((x, y): Point) -> (i32, i32) {
    // A cast saturates; the callers clip long before.
    let scale = f64::from(FINENESS);
    ((x * scale).round() as i32, (y * scale).round() as i32)
}

/// Cuts a line into the strokes of its dash: the SVG backend of plotters has no dash of its own, and both backends shall agree.
fn dashed(points: &[Point], dash: Dash) -> Vec<Vec<Point>> {
    if dash.is_empty() {
        return vec![points.to_vec()];
    }
    let mut pieces = Vec::new();
    let mut piece: Vec<Point> = points.first().copied().into_iter().collect();
    let (mut phase, mut left) = (0, dash[0]);
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            if length <= left {
                left -= length;
                piece.push(to);
                break;
            }
            let t = left / length;
            from = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
            piece.push(from);
            if phase % 2 == 0 {
                pieces.push(std::mem::take(&mut piece));
            }
            phase = (phase + 1) % dash.len();
            left = dash[phase];
            piece.clear();
            piece.push(from);
        }
    }
    if phase % 2 == 0 && piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dash_goes_on_around_corners() {
        let corner = [(0.0, 0.0), (3.0, 0.0), (3.0, 10.0)];
        let pieces = dashed(&corner, &[4.0, 2.0]);
        assert_eq!(pieces[0], [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0)]);
        assert_eq!(pieces[1], [(3.0, 3.0), (3.0, 7.0)]);
        assert_eq!(pieces[2], [(3.0, 9.0), (3.0, 10.0)]);
        assert_eq!(pieces.len(), 3);
    }

    #[test]
    fn a_solid_line_is_one_piece() {
        assert_eq!(dashed(&[(0.0, 0.0), (1.0, 1.0)], &[]).len(), 1);
    }
}
