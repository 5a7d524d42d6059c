//! The isolines of a panel and their labels.

use super::super::super::draw::{Canvas, Drawn, Horizontal, Panel, Point, Rect, Stroke, Text};
use super::super::super::number::terse;
use super::super::chart::on;
use super::labels::{Labelled, place};
use super::panels::PanelOf;
use crate::report::document::Axis;
use plotters::backend::DrawingBackend;

const LABEL: Text = Text { size: 19.0, anchor: Horizontal::Centre, ..Text::LABEL };
/// Size of the plate of a label beyond its text, and its height.
const MARGIN: f64 = 4.0;
const PLATE: f64 = 24.0;

/// All lines of a panel, in pixels.
#[derive(Default)]
pub(super) struct Lines {
    lines: Vec<Labelled>,
}

impl Lines {
    /// The lines of these levels.
    pub(super) fn of(panel: &Panel, it: &PanelOf<'_>, axis: &Axis, levels: &[f64]) -> Self {
        let mut lines = Vec::new();
        for &level in levels {
            let text = terse(level);
            let size = [LABEL.width_of(&text) + 2.0 * MARGIN, PLATE];
            for line in it.plane.isolines(&it.numbers, on(axis, level)) {
                let pieces = panel.visible(&line).into_iter();
                lines.extend(pieces.map(|points| Labelled { points, text: text.clone(), size }));
            }
        }
        Self { lines }
    }

    /// Points along all lines.
    pub(super) fn points(&self) -> Vec<Point> {
        self.lines.iter().flat_map(Labelled::steps).collect()
    }

    /// Draws the lines, then the labels where they cover no other line, nor what is taken.
    pub(super) fn draw<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        panel: &Panel,
        taken: Vec<Rect>,
    ) -> Drawn {
        for stroke in Stroke::CASED {
            for line in &self.lines {
                canvas.line(&line.points, stroke)?;
            }
        }
        let plates: Vec<(&Labelled, Point)> = place(&self.lines, panel.rect, taken);
        for (line, at) in &plates {
            canvas.area(&line.plate(*at).corners(), (255, 255, 255), 1.0)?;
        }
        for (line, at) in &plates {
            canvas.text(&line.text, *at, LABEL)?;
        }
        Ok(())
    }
}
