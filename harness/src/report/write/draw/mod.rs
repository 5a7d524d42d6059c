//! What all figures share: a canvas, axes, curves, isolines, marks, legends and colour bars.

mod axis;
mod bar;
mod canvas;
mod isolines;
mod legend;
mod marks;
mod panel;
mod svg;
mod tile;

pub(crate) use axis::{Axis, nice_ceil};
pub(crate) use bar::ColourBar;
pub(crate) use canvas::{Canvas, Drawn, Horizontal, Point, Stroke, Text};
pub(crate) use isolines::isolines;
pub(crate) use legend::{Legend, Sign};
pub(crate) use marks::Fill;
pub(crate) use panel::{Labels, Panel, Rect, X_TITLE, Y_TITLE, side_by_side};
pub(crate) use tile::{hatched, numbered, tile};

use super::png;
use plotters::backend::{BitMapBackend, DrawingBackend, SVGBackend};

/// Ink of axes and text.
pub(crate) const INK: super::palette::Rgb = (0x22, 0x26, 0x2B);
/// Secondary ink: remarks, the maximum on the ray.
pub(crate) const FAINT: super::palette::Rgb = (0x6B, 0x70, 0x78);
/// Grid lines.
pub(crate) const GRID: super::palette::Rgb = (0xE2, 0xE5, 0xE9);

/// Something that can be drawn on any backend.
pub(crate) trait Draw: Sync {
    /// Width and height in pixels.
    fn size(&self) -> [u32; 2];
    /// Draws everything but the background.
    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn;
    /// How many colours its bitmap may have.
    fn colours(&self) -> usize {
        png::DRAWING
    }
}

/// Both forms of a drawing.
pub(crate) struct Drawing {
    /// A file of its own.
    pub(crate) svg: String,
    /// The same at a fixed resolution.
    pub(crate) png: Vec<u8>,
}

/// Draws once per backend, in parallel. Both get the same coordinates, twice as fine as the pixels of the PNG: the bitmap is then
/// averaged over 2 × 2, which smooths what the backend leaves jagged, and the SVG's whole numbers are half pixels.
pub(crate) fn both(drawing: &impl Draw) -> Result<Drawing, String> {
    canvas::register_fonts()?;
    let (svg, png) = rayon::join(|| vector(drawing), || bitmap(drawing));
    Ok(Drawing { svg: svg?, png: png? })
}

fn vector(drawing: &impl Draw) -> Result<String, String> {
    let [width, height] = drawing.size();
    let mut text = String::new();
    let fine = (width * canvas::FINENESS, height * canvas::FINENESS);
    {
        let canvas = Canvas::on(SVGBackend::with_string(&mut text, fine), 0.0)?;
        drawing.draw(&canvas)?;
        canvas.finish()?;
    }
    Ok(svg::compact(&text, [width, height]))
}

/// The SVG backend centres a text on its x-height; the bitmap backend puts the baseline 0.10 of the size below the centre, where
/// that would be 0.22.
const BITMAP_SINK: f64 = 0.12;

fn bitmap(drawing: &impl Draw) -> Result<Vec<u8>, String> {
    let [width, height] = drawing.size();
    let fine = (width * canvas::FINENESS, height * canvas::FINENESS);
    let mut pixels = vec![0; 3 * fine.0 as usize * fine.1 as usize];
    {
        let canvas = Canvas::on(BitMapBackend::with_buffer(&mut pixels, fine), BITMAP_SINK)?;
        drawing.draw(&canvas)?;
        canvas.finish()?;
    }
    let size = [width as usize, height as usize];
    png::indexed(&averaged(&pixels, size), size, drawing.colours())
}

/// The mean of each block of fine pixels.
fn averaged(fine: &[u8], [width, height]: [usize; 2]) -> Vec<u8> {
    let n = canvas::FINENESS as usize;
    let mut coarse = Vec::with_capacity(3 * width * height);
    for y in 0..height {
        for x in 0..width {
            for channel in 0..3 {
                let at = |k: usize| 3 * ((n * y + k / n) * n * width + n * x + k % n) + channel;
                let sum: usize = (0..n * n).map(|k| usize::from(fine[at(k)])).sum();
                coarse.push(u8::try_from((sum + n * n / 2) / (n * n)).unwrap_or(u8::MAX));
            }
        }
    }
    coarse
}
