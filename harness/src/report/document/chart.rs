//! Curves over a common axis: lines for what is known, marks for what was measured.

use crate::result::number;
use serde::{Serialize, Serializer};

/// A drawing with two axes.
#[derive(Clone, Debug, Serialize)]
pub struct Chart {
    /// Name of its files without ending.
    pub id: String,
    /// One line.
    pub title: String,
    /// What is seen, with its numbers. The legend already says what lines, marks, bars and bands are.
    pub caption: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, in the order of the legend; the first is drawn last, on top.
    pub curves: Vec<Curve>,
    /// Places that are marked on the x axis.
    pub verticals: Vec<Vertical>,
    /// Intervals that are marked on the x axis.
    pub bands: Vec<Band>,
}

impl Chart {
    /// A chart without curves.
    #[must_use]
    pub fn new(id: &str, title: &str, x: Axis, y: Axis) -> Self {
        Self {
            id: id.to_owned(),
            title: title.to_owned(),
            caption: String::new(),
            x,
            y,
            curves: Vec::new(),
            verticals: Vec::new(),
            bands: Vec::new(),
        }
    }
}

/// An axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// What is on it, with its unit in brackets: "σ_samp \[1/length\]".
    pub title: String,
    /// How values are placed.
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

/// How values are placed on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Equal differences, equal lengths.
    Linear,
    /// Equal ratios, equal lengths. Zero lies below every range; negative values are not drawn.
    Logarithmic,
}

/// A line, marks, or both, under one name.
#[derive(Clone, Debug, Serialize)]
pub struct Curve {
    /// The name in the legend. The same name has the same look in all charts of a document, and the look of the standard report
    /// where that has a series of this name.
    pub label: String,
    /// What the curve is.
    pub role: Role,
    /// What is known, in closed form or by quadrature, in increasing x.
    pub line: Vec<Point>,
    /// What was measured.
    pub marks: Vec<Mark>,
}

impl Curve {
    /// An empty curve of a method.
    #[must_use]
    pub fn method(label: &str) -> Self {
        Self { label: label.to_owned(), role: Role::Method, line: Vec::new(), marks: Vec::new() }
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
}

/// What a curve is: it decides how it looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// One of several that are compared.
    Method,
    /// What they are compared with: a thick dark line.
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

/// A measured value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
}

impl Mark {
    /// A value with its 95 % interval.
    #[must_use]
    pub fn measured(x: f64, y: f64, interval: [f64; 2]) -> Self {
        Self { x, y, interval: Some(interval), solid: true }
    }

    /// A value without an interval, such as a count.
    #[must_use]
    pub fn at(x: f64, y: f64) -> Self {
        Self { x, y, interval: None, solid: true }
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
    /// What is there.
    pub label: String,
}

/// An interval on the x axis, such as that in which an optimum lies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Band {
    /// Its lower end in units of the x axis.
    pub from: f64,
    /// Its upper end.
    pub to: f64,
    /// What it is.
    pub label: String,
}

impl Band {
    /// The band of a range, if it has a width.
    #[must_use]
    pub fn between([from, to]: [f64; 2], label: &str) -> Option<Self> {
        (from < to).then(|| Self { from, to, label: label.to_owned() })
    }
}

/// See [`number`].
pub(super) fn always<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    number(&Some(*value), serializer)
}

/// An end may be infinite.
pub(super) fn ends<S: Serializer>(interval: &Option<[f64; 2]>, serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct End(#[serde(serialize_with = "always")] f64);
    interval.map(|ends| ends.map(End)).serialize(serializer)
}
