//! The cells of a panel in units of the drawn axes.

use super::super::super::draw::{Panel, Rect, isolines};
use super::super::chart::on;
use super::panels::Shown;
use crate::report::document::Axis;

/// Overlap of neighbours in pixels: a renderer that smooths edges would let the ground shine through between them.
const OVERLAP: f64 = 0.5;

/// Centres and edges of columns and rows.
pub(super) struct Plane {
    centres: [Vec<f64>; 2],
    edges: [Vec<f64>; 2],
}

impl Plane {
    /// Cells with these centres.
    pub(super) fn new((x, columns): (&Axis, &[f64]), (y, rows): (&Axis, &[f64])) -> Self {
        let drawn = |axis: &Axis, values: &[f64]| values.iter().map(|&value| on(axis, value)).collect();
        let centres: [Vec<f64>; 2] = [drawn(x, columns), drawn(y, rows)];
        let edges = [edges(&centres[0]), edges(&centres[1])];
        Self { centres, edges }
    }

    /// The outermost centres of the columns (0) or the rows (1); the edges of a single one.
    pub(super) fn ends(&self, which: usize) -> impl Iterator<Item = f64> {
        let centres = &self.centres[which];
        let ends = if centres.len() > 1 { centres } else { &self.edges[which] };
        [ends.first(), ends.last()].into_iter().flatten().copied()
    }

    /// How many columns there are.
    pub(super) fn columns(&self) -> usize {
        self.centres[0].len()
    }

    /// The cells of a row between two columns; nothing of what is outside the panel.
    pub(super) fn rect(&self, panel: &Panel, columns: [usize; 2], row: usize) -> Option<Rect> {
        let [x, y] = &self.edges;
        let (left, bottom) = panel.place(x[columns[0]], y[row]);
        let (right, top) = panel.place(x[columns[1]], y[row + 1]);
        (left < right && top < bottom).then_some(Rect { left, top, right, bottom })
    }

    /// Equal neighbours in a row as one, all of a kind in succession.
    pub(super) fn runs(&self, panel: &Panel, cells: &[Shown]) -> Vec<(Shown, Rect)> {
        let mut runs = Vec::new();
        for (row, cells) in cells.chunks(self.columns().max(1)).enumerate() {
            let mut from = 0;
            for run in cells.chunk_by(|a, b| a == b) {
                let to = from + run.len();
                if let Some(rect) = self.rect(panel, [from, to], row) {
                    let (right, bottom) = (rect.right + OVERLAP, rect.bottom + OVERLAP);
                    let right = right.min(panel.rect.right);
                    runs.push((run[0], Rect { right, bottom: bottom.min(panel.rect.bottom), ..rect }));
                }
                from = to;
            }
        }
        runs.sort_by_key(|run| run.0);
        runs
    }

    /// The lines of a level between the centres of cells, in units of the drawn axes.
    pub(super) fn isolines(&self, numbers: &[f64], level: f64) -> Vec<Vec<(f64, f64)>> {
        let [x, y] = &self.centres;
        let lines = isolines(x.len(), numbers, level).into_iter();
        lines.map(|line| line.into_iter().map(|(u, v)| (between(x, u), between(y, v))).collect()).collect()
    }
}

/// Half way between neighbours, and as far outwards as inwards at the ends.
fn edges(centres: &[f64]) -> Vec<f64> {
    match centres {
        [] => Vec::new(),
        [only] => vec![only - 0.5, only + 0.5],
        [first, second, ..] => {
            let inner = centres.windows(2).map(|pair| f64::midpoint(pair[0], pair[1]));
            let last = 1.5 * centres[centres.len() - 1] - 0.5 * centres[centres.len() - 2];
            std::iter::once(1.5 * first - 0.5 * second).chain(inner).chain([last]).collect()
        }
    }
}

/// The value at a place between two entries, of which there are at least two.
fn between(values: &[f64], place: f64) -> f64 {
    let k = (place as usize).min(values.len() - 2);
    let t = place - k as f64;
    values[k] + t * (values[k + 1] - values[k])
}

#[cfg(test)]
mod tests {
    use super::super::super::super::draw;
    use super::*;

    fn plane(x: &[f64], y: &[f64]) -> Plane {
        Plane::new((&Axis::linear(""), x), (&Axis::linear(""), y))
    }

    fn panel() -> Panel {
        let rect = Rect { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };
        Panel { rect, x: draw::Axis::exactly("", 0.0, 1.0), y: draw::Axis::exactly("", 0.0, 1.0) }
    }

    #[test]
    fn cells_meet_half_way_and_on_a_logarithmic_axis_at_the_geometric_mean() {
        assert_eq!(edges(&[1.0, 3.0, 4.0]), [0.0, 2.0, 3.5, 4.5]);
        let plane = Plane::new((&Axis::logarithmic(""), &[1.0, 100.0]), (&Axis::linear(""), &[7.0]));
        assert_eq!(plane.edges, [vec![-1.0, 1.0, 3.0], vec![6.5, 7.5]]);
    }

    #[test]
    fn isolines_are_where_the_function_has_the_level_and_end_at_centres() {
        // Not evenly spaced: the lines are still straight.
        let plane = plane(&[0.1, 0.2, 0.5, 0.9], &[0.25, 0.75]);
        let numbers: Vec<f64> =
            [0.25, 0.75].iter().flat_map(|y| [0.1, 0.2, 0.5, 0.9].map(|x| x + 0.2 * y)).collect();
        let lines = plane.isolines(&numbers, 0.4);
        assert_eq!(lines.len(), 1);
        for (x, y) in &lines[0] {
            assert!((x + 0.2 * y - 0.4).abs() < 1e-12, "{x}, {y}");
        }
        let mut rows: Vec<f64> = lines[0].iter().map(|point| point.1).collect();
        rows.sort_by(f64::total_cmp);
        assert_eq!((rows[0], rows[rows.len() - 1]), (0.25, 0.75));
        assert_eq!(plane.ends(0).collect::<Vec<_>>(), [0.1, 0.9]);
    }

    #[test]
    fn equal_neighbours_are_one_and_kinds_follow_each_other() {
        use Shown::{Kind, Missing};
        let plane = plane(&[0.25, 0.75, 1.25], &[0.25, 0.75]);
        let runs = plane.runs(&panel(), &[Kind(1), Kind(1), Kind(1), Kind(0), Missing, Kind(1)]);
        let kinds: Vec<Shown> = runs.iter().map(|run| run.0).collect();
        // The last column is outside.
        assert_eq!(kinds, [Missing, Kind(0), Kind(1)]);
        assert_eq!(
            [runs[2].1.left, runs[2].1.top, runs[2].1.right, runs[2].1.bottom],
            [0.0, 50.0, 100.0, 100.0]
        );
    }
}
