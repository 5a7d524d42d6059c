//! A heat map: panels of coloured cells in rows of three, and a legend of names or a bar of colours.

use super::axis::{Stretch, on};
use super::chart::framed;
use super::{Entry, FONT, Figure, LETTERS, Outcome, WIDTH, colour, legend, legend_height};
use crate::palette::{Looks, Rgb};
use crate::{Axis, Content, Grid, HeatMap, Role, colour_map, number};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Panels in a row, and their height in pixels.
const ACROSS: usize = 3;
const HEIGHT: u32 = 380;
/// Height of the bar of colours in pixels.
const BAR: u32 = 110;
/// A run of cells has a number if it is wider than this share of the panel.
const NARROW: f64 = 0.08;
/// Cells without a value.
const MISSING: RGBColor = RGBColor(0xC9, 0xCD, 0xD3);

/// A heat map on its way to a backend.
pub(super) struct Drawn<'a> {
    map: &'a HeatMap,
    looks: &'a Looks<'a>,
}

/// Colours of the cells of a panel, and the number of the name in each.
struct Cells {
    colours: Vec<Option<Rgb>>,
    names: Vec<Option<usize>>,
}

impl<'a> Drawn<'a> {
    pub(super) fn new(map: &'a HeatMap, looks: &'a Looks<'a>) -> Self {
        Self { map, looks }
    }

    fn name_colour(&self, name: &str) -> Rgb {
        self.looks.get(Role::Method, name).colour
    }

    /// The stretch of the colours of a map of values.
    fn scale(&self) -> Option<(&'a Axis, Stretch)> {
        let Content::Values { colours, panels, .. } = &self.map.content else { return None };
        let values = panels.iter().flat_map(|panel| panel.values.iter().copied().flatten());
        Some((colours, Stretch::of(colours, values)))
    }

    fn cells(&self, k: usize) -> Cells {
        match &self.map.content {
            Content::Values { colours, panels, .. } => {
                let values = &panels[k].values;
                let scale = self.scale().map(|(_, stretch)| stretch);
                let shade = |value: &Option<f64>| {
                    let (value, scale) = ((*value)?, scale?);
                    let place = (on(colours, value) - scale.low) / (scale.high - scale.low);
                    (!place.is_nan()).then(|| colour_map::sequential(colour_map::level(place)))
                };
                Cells { colours: values.iter().map(shade).collect(), names: vec![None; values.len()] }
            }
            Content::Names { names, panels, .. } => {
                let values = &panels[k].values;
                let colours = values.iter().map(|name| name.map(|k| self.name_colour(&names[k]))).collect();
                Cells { colours, names: values.clone() }
            }
        }
    }

    fn count(&self) -> usize {
        self.map.content.frames().len()
    }

    fn entries<DB: DrawingBackend + 'a>(&self) -> Vec<Entry<'a, DB>> {
        let Content::Names { names, panels, .. } = &self.map.content else { return Vec::new() };
        let used = |k: usize| panels.iter().any(|panel| panel.values.contains(&Some(k)));
        let mut entries: Vec<Entry<'a, DB>> = Vec::new();
        for (k, name) in names.iter().enumerate().filter(|(k, _)| used(*k)) {
            let fill = self.name_colour(name);
            entries.push((
                Box::new(move |area, (x, y)| {
                    let tile = [(x - 26, y - 12), (x + 26, y + 12)];
                    area.draw(&Rectangle::new(tile, colour(fill).filled()))?;
                    area.draw(&number_at(k + 1, (x, y), fill))
                }),
                name,
            ));
        }
        entries
    }

    fn foot(&self) -> u32 {
        match &self.map.content {
            Content::Values { .. } => BAR,
            Content::Names { .. } => {
                let words: Vec<&str> = self.entries::<SVGBackend<'_>>().iter().map(|entry| entry.1).collect();
                legend_height(&words)
            }
        }
    }

    /// The stretch of an axis over the cells of all panels.
    fn stretch(&self, which: usize) -> Stretch {
        Stretch::of(&tight([&self.map.x, &self.map.y][which], self.map), [])
    }
}

/// An axis of a map; it reaches from the first centre to the last where it has no range.
pub(crate) fn tight(axis: &Axis, map: &HeatMap) -> Axis {
    let frames = map.content.frames();
    let centres = frames.iter().flat_map(|(_, x, y)| if *axis == map.x { *x } else { *y });
    let ends = |[low, high]: [f64; 2], &place: &f64| [low.min(place), high.max(place)];
    let [low, high] = centres.fold([f64::INFINITY, f64::NEG_INFINITY], ends);
    match axis.range {
        None if low < high => axis.clone().within(low, high),
        _ => axis.clone(),
    }
}

/// Edges of cells: half way between centres, in units of length, cut at the frame.
fn edges(axis: &Axis, centres: &[f64], stretch: Stretch) -> Vec<f64> {
    let places: Vec<f64> = centres.iter().map(|&centre| on(axis, centre)).collect();
    let last = places.len() - 1;
    let half = |k: usize| 0.5 * (places[k + 1] - places[k]);
    let outer = if last == 0 { 0.5 * (stretch.high - stretch.low) } else { half(0) };
    let mut edges = vec![places[0] - outer];
    edges.extend((0..last).map(|k| places[k] + half(k)));
    edges.push(places[last] + if last == 0 { outer } else { half(last - 1) });
    edges.into_iter().map(|edge| edge.clamp(stretch.low, stretch.high)).collect()
}

/// Runs of equal cells of a row: first column, number of columns, cell.
fn runs<T: PartialEq + Copy>(row: &[T]) -> Vec<(usize, usize, T)> {
    let mut runs: Vec<(usize, usize, T)> = Vec::new();
    for (k, &cell) in row.iter().enumerate() {
        match runs.last_mut() {
            Some((_, length, known)) if *known == cell => *length += 1,
            _ => runs.push((k, 1, cell)),
        }
    }
    runs
}

/// Edges between cells below a level and cells that are not, by the numbers of their columns and rows of edges.
fn borders(panel: &Grid<Option<f64>>, level: f64) -> Vec<[[usize; 2]; 2]> {
    let [columns, rows] = [panel.x.len(), panel.y.len()];
    let is_below =
        |column: usize, row: usize| panel.values[row * columns + column].map(|value| value < level);
    let differ = |a: Option<bool>, b: Option<bool>| a.is_some() && b.is_some() && a != b;
    let mut borders = Vec::new();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let here = is_below(column, row);
        if column + 1 < columns && differ(here, is_below(column + 1, row)) {
            borders.push([[column + 1, row], [column + 1, row + 1]]);
        }
        if row + 1 < rows && differ(here, is_below(column, row + 1)) {
            borders.push([[column, row + 1], [column + 1, row + 1]]);
        }
    }
    borders
}

/// A number at a point, white on dark colours and black on light ones.
fn number_at<Coord: Clone + 'static>(number: usize, at: Coord, ground: Rgb) -> Text<'static, Coord, String> {
    let light = u32::from(ground.0) * 3 + u32::from(ground.1) * 6 + u32::from(ground.2) > 1350;
    let ink = if light { BLACK } else { WHITE };
    let style = FontDesc::new(FontFamily::SansSerif, 17.0, FontStyle::Bold).color(&ink);
    Text::new(number.to_string(), at, style.pos(Pos::new(HPos::Center, VPos::Center)))
}

impl Figure for Drawn<'_> {
    fn size(&self) -> (u32, u32) {
        let rows = self.count().div_ceil(ACROSS) as u32;
        (WIDTH, rows * HEIGHT + self.foot())
    }

    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Outcome<DB> {
        let rows = self.count().div_ceil(ACROSS);
        let (panels, below) = area.split_vertically(rows as u32 * HEIGHT);
        let places = panels.split_evenly((rows, ACROSS.min(self.count())));
        for (k, place) in places.iter().take(self.count()).enumerate() {
            self.panel(k, place)?;
        }
        match self.scale() {
            Some((axis, stretch)) => self.bar(&below, axis, stretch),
            None => legend(&below, &self.entries()),
        }
    }
}

impl Drawn<'_> {
    fn panel<DB: DrawingBackend>(&self, k: usize, area: &DrawingArea<DB, Shift>) -> Outcome<DB> {
        let ((label, columns, rows), cells) = (self.map.content.frames()[k], self.cells(k));
        let stretches = [self.stretch(0), self.stretch(1)];
        let mut builder = ChartBuilder::on(area);
        builder.margin(8).margin_right(14);
        if !label.is_empty() {
            builder.caption(label, (FONT, LETTERS, FontStyle::Bold));
        }
        let titles = [&*self.map.x.title, if k.is_multiple_of(ACROSS) { &*self.map.y.title } else { "" }];
        let mut context = framed(builder, stretches, titles, [4, 5])?;
        let [x, y] = [edges(&self.map.x, columns, stretches[0]), edges(&self.map.y, rows, stretches[1])];
        let width = columns.len();
        let mut longest: Vec<(usize, usize, f64, f64, usize)> = Vec::new();
        let central = |row: usize| row.abs_diff(rows.len() / 2);
        for row in 0..rows.len() {
            let here = row * width..(row + 1) * width;
            for (first, length, shade) in runs(&cells.colours[here.clone()]) {
                let corners = [(x[first], y[row]), (x[first + length], y[row + 1])];
                let style = shade.map_or(MISSING, colour).filled();
                context.draw_series([Rectangle::new(corners, style)])?;
            }
            for (first, length, name) in runs(&cells.names[here]) {
                let Some(name) = name else { continue };
                if x[first + length] - x[first] < NARROW * (stretches[0].high - stretches[0].low) {
                    continue;
                }
                let middle = (0.5 * (x[first] + x[first + length]), 0.5 * (y[row] + y[row + 1]));
                match longest.iter_mut().find(|known| known.0 == name) {
                    Some(known)
                        if known.1 < length || (known.1 == length && central(row) < central(known.4)) =>
                    {
                        *known = (name, length, middle.0, middle.1, row);
                    }
                    Some(_) => {}
                    None => longest.push((name, length, middle.0, middle.1, row)),
                }
            }
        }
        let names = match &self.map.content {
            Content::Values { isolines, panels, .. } => {
                for ends in isolines.iter().flat_map(|level| borders(&panels[k], *level)) {
                    let ends = ends.map(|[column, row]| (x[column], y[row]));
                    context.draw_series([PathElement::new(ends, WHITE.stroke_width(2))])?;
                }
                return Ok(());
            }
            Content::Names { names, .. } => names,
        };
        for (name, _, across, up, _) in longest {
            context.draw_series([number_at(name + 1, (across, up), self.name_colour(&names[name]))])?;
        }
        Ok(())
    }

    /// The bar of colours with its axis, and the levels at which the panels have lines.
    fn bar<DB: DrawingBackend>(
        &self,
        area: &DrawingArea<DB, Shift>,
        axis: &Axis,
        stretch: Stretch,
    ) -> Outcome<DB> {
        let mut builder = ChartBuilder::on(area);
        builder.margin_left(60).margin_right(60).margin_top(10);
        let flat = Stretch::of(&Axis::linear("").within(0.0, 1.0), []);
        let mut context = framed(builder, [stretch, flat], [&axis.title, ""], [8, 0])?;
        let step = (stretch.high - stretch.low) / f64::from(colour_map::LEVELS);
        context.draw_series((0..colour_map::LEVELS).map(|level| {
            let from = stretch.low + f64::from(level) * step;
            let shade = colour(colour_map::sequential(level));
            Rectangle::new([(from, 0.0), (from + step, 1.0)], shade.filled())
        }))?;
        let Content::Values { isolines, .. } = &self.map.content else { return Ok(()) };
        let places = isolines.iter().map(|level| on(axis, *level)).filter(|place| stretch.contains(*place));
        context
            .draw_series(places.map(|at| PathElement::new([(at, 0.0), (at, 1.0)], WHITE.stroke_width(2))))?;
        Ok(())
    }
}

/// Content of a heat map, for those who do not see it.
pub(crate) fn alternative(map: &HeatMap) -> String {
    let what = match &map.content {
        Content::Values { colours, .. } => colours.title.clone(),
        Content::Names { names, .. } => format!("the best of {}", number::listed(names)),
    };
    let frames = map.content.frames();
    let labels: Vec<&str> = frames.iter().map(|frame| frame.0).filter(|label| !label.is_empty()).collect();
    let panels = if labels.is_empty() { String::new() } else { format!(" Panels: {}.", labels.join(", ")) };
    format!("{}. Heat map of {what}, over {} and {}.{panels}", map.title, map.x.title, map.y.title)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_reach_half_way_to_their_neighbours() {
        let axis = Axis::linear("").within(0.0, 10.0);
        let stretch = Stretch::of(&axis, []);
        assert_eq!(edges(&axis, &[0.0, 2.0, 6.0, 10.0], stretch), [0.0, 1.0, 4.0, 8.0, 10.0]);
        assert_eq!(edges(&axis, &[5.0], stretch), [0.0, 10.0]);
    }

    #[test]
    fn a_level_is_crossed_between_cells_that_have_values() {
        let values = |x: f64, y: f64| (x + y > 0.0).then_some(x * y);
        let panel = Grid::of("", vec![0.0, 1.0, 2.0], vec![0.0, 1.0], values);
        // 1 and 2 at the right end of the upper row; no value at the lower left.
        assert_eq!(borders(&panel, 0.5), [[[1, 1], [2, 1]], [[2, 1], [3, 1]], [[1, 1], [1, 2]]]);
        assert_eq!(borders(&panel, 9.0).len(), 0);
    }

    #[test]
    fn equal_neighbours_are_one_run() {
        assert_eq!(runs(&[1, 1, 2, 1]), [(0, 2, 1), (2, 1, 2), (3, 1, 1)]);
    }
}
