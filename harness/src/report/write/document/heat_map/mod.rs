//! A heat map: panels of coloured cells with isolines, a colour bar or a legend, and all its cells as CSV.

mod labels;
mod layout;
mod lines;
mod panels;
mod plane;
mod regions;
mod table;

pub(super) use table::summary;

use super::super::draw::{Axis, Canvas, ColourBar, Draw, Drawing, Drawn, Legend, Panel, Rect, Sign};
use super::super::draw::{Text, both, hatched, tile};
use super::super::figure::{LEGEND_LEFT, LEGEND_WIDTH};
use super::super::{colour_map, png};
use super::chart::on;
use super::styles::Styles;
use crate::report::document::{self, Content, HeatMap, Numbers, Scale};
use layout::Layout;
use lines::Lines;
use panels::{PanelOf, Shown, colours, panels};
use plotters::backend::DrawingBackend;

/// A heat map on its way into files and the page.
pub(super) struct Finished<'a> {
    pub(super) id: &'a str,
    pub(super) map: &'a HeatMap,
    /// What it shows, for those who do not see it.
    pub(super) alternative: String,
    pub(super) csv: String,
    pub(super) drawing: Drawing,
}

/// Draws a heat map and tabulates it.
pub(super) fn finished<'a>(map: &'a HeatMap, styles: &Styles) -> Result<Finished<'a>, String> {
    let figure = Figure { map, styles, panels: panels(map) };
    let drawing = both(&figure).map_err(|error| format!("heat map {}: {error}", map.id))?;
    let alternative = figure.alternative();
    Ok(Finished { id: &map.id, map, alternative, csv: table::csv(map), drawing })
}

/// The names that stand in a cell, each once for each panel that has it.
pub(super) fn names_in(map: &HeatMap) -> Vec<&str> {
    let Content::Names { names, panels, .. } = &map.content else { return Vec::new() };
    let used = |k: &usize| panels.iter().any(|panel| panel.values.contains(&Some(*k)));
    (0..names.len()).filter(used).map(|k| &*names[k]).collect()
}

struct Figure<'a> {
    map: &'a HeatMap,
    styles: &'a Styles,
    panels: Vec<PanelOf<'a>>,
}

impl Figure<'_> {
    fn layout(&self) -> Layout {
        Layout {
            panels: self.panels.len(),
            headed: self.panels.iter().any(|panel| !panel.label.is_empty()),
            bar: matches!(self.map.content, Content::Values { .. }),
            legend: self.legend().height(),
        }
    }

    fn axis(&self, which: usize) -> Axis {
        let axis = [&self.map.x, &self.map.y][which];
        let edges = self.panels.iter().flat_map(|panel| panel.plane.ends(which));
        let [low, high] = match axis.range {
            Some(range) => range.map(|end| on(axis, end)),
            None => {
                edges.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
            }
        };
        match axis.scale {
            Scale::Linear => Axis::exactly(&axis.title, low, high),
            Scale::Logarithmic => Axis::exactly_logarithmic(&axis.title, low, high),
        }
    }

    /// The isolines: their axis and their levels.
    fn levels(&self) -> Option<(&document::Axis, &[f64])> {
        match &self.map.content {
            Content::Values { colours, isolines, .. } => Some((colours, isolines)),
            Content::Names { numbers: Some(Numbers { axis, isolines, .. }), .. } => Some((axis, isolines)),
            Content::Names { numbers: None, .. } => None,
        }
    }

    fn legend(&self) -> Legend {
        let mut entries = Vec::new();
        if let Content::Names { names, numbers, .. } = &self.map.content {
            let shown = names_in(self.map);
            for (k, name) in names.iter().enumerate().filter(|(_, name)| shown.contains(&&***name)) {
                entries.push((Sign::Tile(self.styles.colour(name), k + 1), name.clone()));
            }
            if let Some(numbers) = numbers {
                entries.push((Sign::Cased, numbers.axis.title.clone()));
            }
        }
        if self.panels.iter().any(|panel| panel.cells.contains(&Shown::Missing)) {
            entries.push((Sign::Hatched, "no value".to_owned()));
        }
        Legend::of(entries, LEGEND_WIDTH)
    }

    fn bar(&self, layout: &Layout) -> Option<(Rect, Axis, [bool; 2], Vec<f64>)> {
        let (axis, isolines) = self.levels()?;
        let scale = colours(self.map)?;
        let numbers = || self.panels.iter().flat_map(|panel| &panel.numbers);
        let [low, high] = scale.range();
        let beyond = [numbers().any(|&x| x < low), numbers().any(|&x| x > high)];
        let marks = isolines.iter().map(|&level| on(axis, level)).collect();
        Some((layout.bar()?, scale, beyond, marks))
    }

    fn colour(&self, kind: usize) -> super::super::palette::Rgb {
        match &self.map.content {
            Content::Values { .. } => colour_map::sequential(u16::try_from(kind).unwrap_or(u16::MAX)),
            Content::Names { names, .. } => self.styles.colour(&names[kind]),
        }
    }

    /// Cells of one colour follow each other: they become one path of the SVG.
    fn cells<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, panel: &Panel, it: &PanelOf<'_>) -> Drawn {
        for (shown, rect) in it.plane.runs(panel, &it.cells) {
            match shown {
                Shown::Missing => hatched(canvas, rect)?,
                Shown::Kind(kind) => tile(canvas, rect, self.colour(kind))?,
            }
        }
        Ok(())
    }

    fn alternative(&self) -> String {
        let HeatMap { title, x, y, content, .. } = self.map;
        let what = match content {
            Content::Values { colours, .. } => colours.title.clone(),
            Content::Names { .. } => format!("which of {}", names_in(self.map).join("; ")),
        };
        let labels: Vec<&str> =
            self.panels.iter().map(|panel| panel.label).filter(|it| !it.is_empty()).collect();
        let panels =
            if labels.is_empty() { String::new() } else { format!(" Panels: {}.", labels.join(", ")) };
        format!("{title}. Heat map of {what}, over {} and {}.{panels}", x.title, y.title)
    }
}

impl Draw for Figure<'_> {
    fn size(&self) -> [u32; 2] {
        self.layout().size()
    }

    fn colours(&self) -> usize {
        png::IMAGE
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn {
        let layout = self.layout();
        let [x, y] = [0, 1].map(|which| self.axis(which));
        for (k, it) in self.panels.iter().enumerate() {
            let (rect, labels) = layout.panel(k);
            let panel = Panel { rect, x: x.clone(), y: y.clone() };
            panel.ticks(canvas, labels, layout.ticks())?;
            self.cells(canvas, &panel, it)?;
            let lines = match self.levels() {
                Some((axis, levels)) if !it.numbers.is_empty() => Lines::of(&panel, it, axis, levels),
                _ => Lines::default(),
            };
            let mut taken = Vec::new();
            if let Content::Names { .. } = self.map.content {
                taken = regions::draw(canvas, &panel, it, &lines.points(), |kind| self.colour(kind))?;
            }
            lines.draw(canvas, &panel, taken)?;
            panel.frame(canvas)?;
            panel.heading(canvas, it.label)?;
        }
        let [x_title, y_title] = layout.titles();
        canvas.text(x.title(), x_title, Text::TITLE)?;
        canvas.text(y.title(), y_title, Text { upright: true, ..Text::TITLE })?;
        if let Some((rect, axis, beyond, marks)) = self.bar(&layout) {
            ColourBar { rect, axis: &axis, beyond, marks: &marks }.draw(canvas)?;
        }
        self.legend().draw(canvas, (LEGEND_LEFT, layout.foot()))
    }
}
