//! Curves over a common axis: lines for what is known, marks for what was measured.

use super::{always, ends, number};
use serde::Serialize;

/// A drawing of one panel or several.
#[derive(Clone, Debug, Serialize)]
pub struct Chart {
    /// Name of its files without ending.
    pub id: String,
    /// One line.
    pub title: String,
    /// Finding of the figure, with its numbers. The legend already says what lines, marks, bars and bands are.
    pub caption: String,
    /// The panels; at least one.
    pub panels: Vec<Panel>,
    /// Order of the panels in the plane.
    pub arrangement: Arrangement,
}

impl Chart {
    /// A chart of one panel without curves.
    #[must_use]
    pub fn new(id: &str, title: &str, x: Axis, y: Axis) -> Self {
        Self::of(id, title, vec![Panel::new("", x, y)])
    }

    /// A chart of panels side by side.
    #[must_use]
    pub fn of(id: &str, title: &str, panels: Vec<Panel>) -> Self {
        let [id, title] = [id, title].map(str::to_owned);
        Self { id, title, caption: String::new(), panels, arrangement: Arrangement::Row }
    }

    /// The same chart with these curves in its first panel.
    #[must_use]
    pub fn with_curves(mut self, curves: Vec<Curve>) -> Self {
        self.panels[0].curves = curves;
        self
    }

    /// The same chart with these places marked on the x axis of its first panel.
    #[must_use]
    pub fn with_verticals(mut self, verticals: Vec<Vertical>) -> Self {
        self.panels[0].verticals = verticals;
        self
    }

    /// The same chart with these intervals marked on the x axis of its first panel.
    #[must_use]
    pub fn with_bands(mut self, bands: Vec<Band>) -> Self {
        self.panels[0].bands = bands;
        self
    }

    /// The same chart with this caption.
    #[must_use]
    pub fn with_caption(self, caption: impl Into<String>) -> Self {
        Self { caption: caption.into(), ..self }
    }

    /// Iterates over the curves of every panel.
    pub fn curves(&self) -> impl Iterator<Item = &Curve> {
        self.panels.iter().flat_map(|panel| &panel.curves)
    }
}

/// Order of panels in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Arrangement {
    /// Side by side; the vertical axis is that of the first.
    Row,
    /// One above the other; the horizontal axis is that of the last.
    Column,
}

/// Curves over a common axis.
#[derive(Clone, Debug, Serialize)]
pub struct Panel {
    /// Its case; empty where there is only one.
    pub heading: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The curves, in the order of the legend; the first is drawn last, on top.
    pub curves: Vec<Curve>,
    /// Places that are marked on the x axis.
    pub verticals: Vec<Vertical>,
    /// Intervals that are marked on the x axis.
    pub bands: Vec<Band>,
}

impl Panel {
    /// A panel without curves.
    #[must_use]
    pub fn new(heading: &str, x: Axis, y: Axis) -> Self {
        let heading = heading.to_owned();
        Self { heading, x, y, curves: Vec::new(), verticals: Vec::new(), bands: Vec::new() }
    }
}

/// An axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// Quantity, with its unit in brackets: "σ_samp \[1/length\]".
    pub title: String,
    /// Law of places.
    pub scale: Scale,
    /// The values at its ends; without, all that is drawn is shown. What lies beyond becomes a triangle on the edge.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis that shows all.
    #[must_use]
    pub fn linear(title: &str) -> Self {
        Self { title: title.to_owned(), scale: Scale::Linear, range: None }
    }

    /// A logarithmic axis that shows all, within twelve decades of the greatest value.
    #[must_use]
    pub fn logarithmic(title: &str) -> Self {
        Self { title: title.to_owned(), scale: Scale::Logarithmic, range: None }
    }

    /// The same axis, which shows exactly these values.
    #[must_use]
    pub fn within(self, low: f64, high: f64) -> Self {
        Self { range: Some([low, high]), ..self }
    }
}

/// Law by which values are placed on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Equal differences, equal lengths.
    Linear,
    /// Equal ratios, equal lengths. Zero lies below every range; negative values are not drawn.
    Logarithmic,
}

/// A line, marks, or both, under one name.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Curve {
    /// The name in the legend. The same name has the same look in all figures of a document.
    pub label: String,
    /// Part of the curve in the comparison.
    pub role: Role,
    /// Known values, in closed form or by quadrature, in increasing x.
    pub line: Vec<Point>,
    /// Measured values.
    pub marks: Vec<Mark>,
    /// A shaded area, such as one standard deviation about the line.
    pub area: Vec<Area>,
}

impl Curve {
    /// An empty curve of a method.
    #[must_use]
    pub fn method(label: &str) -> Self {
        Self { label: label.to_owned(), ..Self::default() }
    }

    /// Marks of a method, joined by a line.
    #[must_use]
    pub fn joined(label: &str, marks: impl IntoIterator<Item = Mark>) -> Self {
        let marks: Vec<Mark> = marks.into_iter().collect();
        let line: Vec<(f64, f64)> = marks.iter().map(|mark| (mark.x, mark.y)).collect();
        Self::method(label).with_line(line).with_marks(marks)
    }

    /// A line that the methods are compared with, such as the exact answer.
    #[must_use]
    pub fn reference(label: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self { role: Role::Reference, ..Self::method(label).with_line(points) }
    }

    /// The same curve with this line.
    #[must_use]
    pub fn with_line(self, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self { line: points.into_iter().map(|(x, y)| Point { x, y: Some(y) }).collect(), ..self }
    }

    /// The same curve with these marks.
    #[must_use]
    pub fn with_marks(self, marks: impl IntoIterator<Item = Mark>) -> Self {
        Self { marks: marks.into_iter().collect(), ..self }
    }

    /// The same curve with an area between two values at each x.
    #[must_use]
    pub fn with_area(self, area: impl IntoIterator<Item = (f64, [f64; 2])>) -> Self {
        Self { area: area.into_iter().map(|(x, y)| Area { x, y }).collect(), ..self }
    }

    /// The same curve with a line that may have gaps.
    #[must_use]
    pub fn with_gaps(self, points: impl IntoIterator<Item = (f64, Option<f64>)>) -> Self {
        Self { line: points.into_iter().map(|(x, y)| Point { x, y }).collect(), ..self }
    }
}

/// Part of a curve in the comparison; it decides its look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// One of several that are compared.
    #[default]
    Method,
    /// The yardstick of the others: a dark line.
    Reference,
}

/// A point of a line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Point {
    /// In units of the x axis.
    pub x: f64,
    /// In units of the y axis; none is a gap.
    #[serde(serialize_with = "number")]
    pub y: Option<f64>,
}

/// The extent of an area at one x.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Area {
    /// In units of the x axis.
    pub x: f64,
    /// Lower and upper end in units of the y axis.
    pub y: [f64; 2],
}

/// A measured value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mark {
    /// In units of the x axis.
    pub x: f64,
    /// In units of the y axis.
    #[serde(serialize_with = "always")]
    pub y: f64,
    /// Its 95 % interval.
    #[serde(serialize_with = "ends")]
    pub interval: Option<[f64; 2]>,
    /// Whether this number of samples can test the value; hollow where not.
    pub solid: bool,
    /// Its cost and the like, for those who point at it; may be empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub note: String,
}

impl Mark {
    /// A value with its 95 % interval.
    #[must_use]
    pub fn measured(x: f64, y: f64, interval: [f64; 2]) -> Self {
        Self { x, y, interval: Some(interval), solid: true, note: String::new() }
    }

    /// A value without an interval, such as a count.
    #[must_use]
    pub fn at(x: f64, y: f64) -> Self {
        Self { x, y, interval: None, solid: true, note: String::new() }
    }

    /// The same value with a note.
    #[must_use]
    pub fn noted(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }

    /// The same value, not testable.
    #[must_use]
    pub fn hollow(self) -> Self {
        Self { solid: false, ..self }
    }
}

/// A place on the x axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vertical {
    /// In units of the x axis.
    pub x: f64,
    /// Its name.
    pub label: String,
}

/// An interval on the x axis, such as that in which an optimum lies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Band {
    /// Its lower end in units of the x axis.
    pub from: f64,
    /// Its upper end.
    pub to: f64,
    /// Its name.
    pub label: String,
}

impl Band {
    /// The band of a range, if it has a width.
    #[must_use]
    pub fn between([from, to]: [f64; 2], label: &str) -> Option<Self> {
        (from < to).then(|| Self { from, to, label: label.to_owned() })
    }
}
