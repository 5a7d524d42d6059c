//! Values or names over a plane, several panels side by side.

use super::Axis;
use super::number;
use serde::{Serialize, Serializer};

/// A drawing whose cells are coloured: the same plane for several cases, one panel each, in rows of three.
#[derive(Clone, Debug, Serialize)]
pub struct HeatMap {
    /// Name of its files without ending.
    pub id: String,
    /// One line.
    pub title: String,
    /// Finding of the figure, with its numbers. The colour bar or the legend says what the colours are.
    pub caption: String,
    /// The horizontal axis of all panels. Without a range it reaches from the first centre to the last, and shows half of their cells.
    pub x: Axis,
    /// The vertical axis of all panels, likewise.
    pub y: Axis,
    /// Contents of the cells.
    pub content: Content,
}

impl HeatMap {
    /// A heat map without a caption.
    #[must_use]
    pub fn new(id: &str, title: &str, x: Axis, y: Axis, content: Content) -> Self {
        Self { id: id.to_owned(), title: title.to_owned(), caption: String::new(), x, y, content }
    }
}

/// Contents of the cells.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Content {
    /// A number per cell: its colour, on one scale for all panels.
    Values {
        /// Law by which numbers become colours; values beyond its range have the end colours. Without a range it shows all finite values,
        /// on a logarithmic scale within twelve decades of the greatest.
        colours: Axis,
        /// Values at which lines are drawn in the page.
        isolines: Vec<f64>,
        /// The panels; a cell without a value is grey.
        #[serde(serialize_with = "panels_of_numbers")]
        panels: Vec<Grid<Option<f64>>>,
    },
    /// One of a list of names per cell, such as that of the best method.
    Names {
        /// All names. One that has a curve in a chart of the document has its colour here too; those of no cell are not in the legend.
        names: Vec<String>,
        /// Place of the name in the list; a cell without a name is grey.
        panels: Vec<Grid<Option<usize>>>,
        /// A number per cell beside the name, such as the gain of the best.
        numbers: Option<Numbers>,
    },
}

/// Label, columns and rows of a panel.
pub(crate) type Frame<'a> = (&'a str, &'a [f64], &'a [f64]);

impl Content {
    /// Labels and centres of all panels.
    pub(crate) fn frames(&self) -> Vec<Frame<'_>> {
        fn frame<T>(panel: &Grid<T>) -> Frame<'_> {
            (&panel.label, &panel.x, &panel.y)
        }
        match self {
            Self::Values { panels, .. } => panels.iter().map(frame).collect(),
            Self::Names { panels, .. } => panels.iter().map(frame).collect(),
        }
    }
}

/// The plane for one case: centres of its cells and their values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Grid<T> {
    /// The case.
    pub label: String,
    /// Centres of the columns, increasing, in units of the x axis. A cell reaches half way to its neighbours, as lengths on the axis go,
    /// and as far outwards as inwards at the ends.
    pub x: Vec<f64>,
    /// Centres of the rows, increasing, in units of the y axis.
    pub y: Vec<f64>,
    /// Row by row, from the least y; in a row from the least x.
    pub values: Vec<T>,
}

impl<T> Grid<T> {
    /// The values of a function of x and y.
    pub fn of(label: &str, x: Vec<f64>, y: Vec<f64>, mut value: impl FnMut(f64, f64) -> T) -> Self {
        let values = y.iter().flat_map(|&y| x.iter().map(move |&x| (x, y)));
        let values = values.map(|(x, y)| value(x, y)).collect();
        Self { label: label.to_owned(), x, y, values }
    }

    /// Centre and value of every cell, in the order of the values.
    pub fn cells(&self) -> impl Iterator<Item = (f64, f64, &T)> {
        let centres = self.y.iter().flat_map(|&y| self.x.iter().map(move |&x| (x, y)));
        centres.zip(&self.values).map(|((x, y), value)| (x, y, value))
    }
}

/// A number per cell of a map of names.
#[derive(Clone, Debug, Serialize)]
pub struct Numbers {
    /// Quantity and scale.
    pub axis: Axis,
    /// Values at which lines are drawn in the page.
    pub isolines: Vec<f64>,
    /// For each panel of the map as many numbers as it has cells, in their order.
    #[serde(serialize_with = "lists_of_numbers")]
    pub panels: Vec<Vec<Option<f64>>>,
}

/// See [`number`].
#[derive(Serialize)]
struct Written(#[serde(serialize_with = "number")] Option<f64>);

fn written(values: &[Option<f64>]) -> Vec<Written> {
    values.iter().copied().map(Written).collect()
}

fn panels_of_numbers<S: Serializer>(panels: &[Grid<Option<f64>>], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(panels.iter().map(|panel| Grid {
        label: panel.label.clone(),
        x: panel.x.clone(),
        y: panel.y.clone(),
        values: written(&panel.values),
    }))
}

fn lists_of_numbers<S: Serializer>(lists: &[Vec<Option<f64>>], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(lists.iter().map(|list| written(list)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_rows_from_the_least_y() {
        let panel = Grid::of("", vec![1.0, 2.0, 3.0], vec![10.0, 20.0], |x, y| x + y);
        assert_eq!(panel.values, [11.0, 12.0, 13.0, 21.0, 22.0, 23.0]);
        assert!(panel.cells().all(|(x, y, value)| *value == x + y));
    }

    #[test]
    fn what_is_missing_and_what_is_infinite_are_different_in_json() {
        let values = |_: f64, y: f64| if y > 1.0 { Some(f64::INFINITY) } else { None };
        let content = Content::Values {
            colours: Axis::linear("1"),
            isolines: vec![1.0],
            panels: vec![Grid::of("a", vec![1.0], vec![1.0, 2.0], values)],
        };
        let json = serde_json::to_value(&content).unwrap();
        assert_eq!(json["kind"], "values");
        assert_eq!(json["panels"][0]["values"], serde_json::json!([null, "infinity"]));
    }
}
