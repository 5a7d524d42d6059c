//! Figures as files: SVG and PNG, by the chart level of plotters.

pub(crate) mod axis;
mod chart;
mod clip;
pub(crate) mod data;
pub(crate) mod heat_map;
mod mark;
mod thin;

pub(crate) use thin::thinned;

use crate::palette::{Looks, Rgb};
use crate::{Chart, HeatMap, png};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::sync::Once;

/// A figure in both formats.
pub(crate) struct Drawing {
    pub(crate) svg: String,
    pub(crate) png: Vec<u8>,
}

/// Draws a chart.
pub(crate) fn of_chart(chart: &Chart, looks: &Looks<'_>) -> Result<Drawing, String> {
    drawn(&chart::Drawn::new(chart, looks)).map_err(|error| format!("chart {}: {error}", chart.id))
}

/// Draws a heat map.
pub(crate) fn of_heat_map(map: &HeatMap, looks: &Looks<'_>) -> Result<Drawing, String> {
    drawn(&heat_map::Drawn::new(map, looks)).map_err(|error| format!("heat map {}: {error}", map.id))
}

/// A figure that any backend can draw.
trait Figure {
    /// Width and height in pixels.
    fn size(&self) -> (u32, u32);

    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Outcome<DB>;
}

type Outcome<DB> = Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// Width of every figure in pixels.
const WIDTH: u32 = 1200;
const FONT: &str = "sans-serif";
/// Size of letters in pixels.
const LETTERS: i32 = 22;
/// Height of a line of a legend in pixels.
const LINE: i32 = 32;
const FAINT: RGBColor = RGBColor(0x5B, 0x62, 0x6B);
const GRID: RGBColor = RGBColor(0xE2, 0xE5, 0xE9);

fn colour((r, g, b): Rgb) -> RGBColor {
    RGBColor(r, g, b)
}

fn drawn(figure: &impl Figure) -> Result<Drawing, String> {
    static FONTS: Once = Once::new();
    FONTS.call_once(|| {
        for (style, bytes) in
            [(FontStyle::Normal, dejavu::sans::regular()), (FontStyle::Bold, dejavu::sans::bold())]
        {
            // A font that cannot be read is told where its first letter is drawn.
            let _ = register_font(FONT, style, bytes);
        }
    });
    let (width, height) = figure.size();
    let mut svg = String::new();
    on_white(figure, &SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area())?;
    let mut pixels = vec![0; 3 * (width * height) as usize];
    on_white(figure, &BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area())?;
    Ok(Drawing { svg: joined(&svg), png: png::colour(&pixels, [width as usize, height as usize])? })
}

fn on_white<DB: DrawingBackend>(figure: &impl Figure, area: &DrawingArea<DB, Shift>) -> Result<(), String> {
    let draw = || {
        area.fill(&WHITE)?;
        figure.draw(area)?;
        area.present()
    };
    draw().map_err(|error| error.to_string())
}

/// The same drawing with neighbouring lines, and neighbouring polygons, of one look as one path each: a dash is an element of 100 letters.
fn joined(svg: &str) -> String {
    let mut file = String::with_capacity(svg.len());
    let mut open = "";
    for line in svg.lines() {
        let ends = [("<polyline ", ""), ("<polygon ", "Z")].into_iter().find_map(|(tag, end)| {
            let (look, points) = line.strip_prefix(tag)?.split_once(" points=\"")?;
            Some((look, points.strip_suffix(" \"/>")?, end))
        });
        let (look, drawn) =
            ends.map_or(("", line.to_owned()), |(look, points, end)| (look, format!("M{points}{end}")));
        match (look == open, look.is_empty()) {
            (true, false) => file.push_str(&drawn),
            (_, is_else) => {
                file.push_str(if open.is_empty() { "" } else { "\"/>\n" });
                file.push_str(&if is_else { drawn + "\n" } else { format!("<path {look} d=\"{drawn}") });
            }
        }
        open = look;
    }
    file
}

/// An entry of a legend: its sign, drawn about a point, and its words.
type Entry<'a, DB> = (Box<dyn Fn(&DrawingArea<DB, Shift>, (i32, i32)) -> Outcome<DB> + 'a>, &'a str);

/// Columns of a legend with these words: at most three, fewer where words are long.
fn columns<'a>(words: impl IntoIterator<Item = &'a str>) -> usize {
    /// Width of a sign with its gaps, and of a letter, in pixels.
    const SIGN: usize = 76;
    const LETTER: usize = 10;
    let longest = words.into_iter().map(|words| words.chars().count()).max().unwrap_or(0);
    ((WIDTH as usize - 40) / (SIGN + LETTER * longest)).clamp(1, 3)
}

fn legend_height(words: &[&str]) -> u32 {
    words.len().div_ceil(columns(words.iter().copied())) as u32 * LINE as u32 + 16
}

/// Draws entries in columns, down first.
fn legend<DB: DrawingBackend>(area: &DrawingArea<DB, Shift>, entries: &[Entry<'_, DB>]) -> Outcome<DB> {
    let columns = columns(entries.iter().map(|entry| entry.1));
    let rows = entries.len().div_ceil(columns).max(1);
    for (k, (sign, words)) in entries.iter().enumerate() {
        let (column, row) = ((k / rows) as i32, (k % rows) as i32);
        let (x, y) = (36 + column * (WIDTH as i32 - 40) / columns as i32, LINE / 2 + row * LINE);
        sign(area, (x + 26, y))?;
        words_at(area, words, (x + 64, y), LETTERS)?;
    }
    Ok(())
}

/// Strokes and gaps from one point to another on the same height; one stroke where there is no dash.
fn strokes<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    [from, to]: [i32; 2],
    y: i32,
    dash: Option<(i32, i32)>,
    style: ShapeStyle,
) -> Outcome<DB> {
    let (size, gap) = dash.unwrap_or((to - from, 1));
    let mut x = from;
    // Half a stroke at the end would look like a dot.
    while x + size / 2 < to {
        area.draw(&PathElement::new([(x, y), ((x + size).min(to), y)], style))?;
        x += size + gap;
    }
    Ok(())
}

/// Writes words to the right of a point.
fn words_at<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    words: &str,
    at: (i32, i32),
    size: i32,
) -> Outcome<DB> {
    use plotters::style::text_anchor::{HPos, Pos, VPos};
    let style = (FONT, size).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
    area.draw(&Text::new(words.to_owned(), at, style))
}
