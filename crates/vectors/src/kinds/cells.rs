//! Rates and bounds in cells.

use crate::Number;
use serde_json::{Value, json};

/// Values that are constant in cells: a sampling extinction, a majorant.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Rates {
    /// Borders \[length\]; the first is 0.
    pub(super) edges: &'static [f64],
    /// A value for each cell \[1/length\].
    pub(super) values: &'static [f64],
}

impl Rates {
    /// Two cells on a length of 8, with a border between nodes of the profile.
    pub(super) const TWO: Self = Self { edges: &[0.0, 2.5, 8.0], values: &[1.0, 0.75] };

    /// The cell that holds a distance; at a border the one behind it.
    fn cell<N: Number>(&self, s: &N) -> usize {
        let last = self.values.len() - 1;
        (0..last).find(|&i| *s < N::of(self.edges[i + 1])).unwrap_or(last)
    }

    /// The value at a distance.
    pub(super) fn at<N: Number>(&self, s: &N) -> N {
        N::of(self.values[self.cell(s)])
    }

    /// Depth of the start of a cell \[1\], a dyadic number.
    fn depth_at_edge(&self, cell: usize) -> f64 {
        (0..cell).map(|i| self.values[i] * (self.edges[i + 1] - self.edges[i])).sum()
    }

    /// The distance behind `from` at which so much depth more is passed; `None` beyond the end.
    pub(super) fn invert<N: Number>(&self, from: &N, depth: N) -> Option<N> {
        let cell = self.cell(from);
        let within = N::of(self.values[cell]) * (from.clone() - N::of(self.edges[cell]));
        let target = N::of(self.depth_at_edge(cell)) + within + depth;
        let cell = (0..self.values.len()).find(|&i| target < N::of(self.depth_at_edge(i + 1)))?;
        let rest = target - N::of(self.depth_at_edge(cell));
        Some(N::of(self.edges[cell]) + rest / N::of(self.values[cell]))
    }

    /// As specs have it.
    pub(super) fn json(&self) -> Value {
        json!({ "edges": self.edges, "values": self.values })
    }
}

/// A lower and an upper bound of σ_t in each of some cells.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    /// Borders \[length\]; the first is 0.
    pub(super) edges: &'static [f64],
    /// Lower bounds \[1/length\].
    pub(super) minorants: &'static [f64],
    /// Upper bounds \[1/length\].
    pub(super) majorants: &'static [f64],
}

impl Bounds {
    /// Four cells of [`Profile::SMOKE`](crate::Profile::SMOKE), the bounds of the last two loose.
    pub(super) const SMOKE: Self = Self {
        edges: &[0.0, 1.0, 2.0, 4.0, 8.0],
        minorants: &[0.25, 0.0, 0.0, 0.375],
        majorants: &[1.0, 1.0, 0.875, 0.75],
    };

    /// Two cells of [`Profile::EVEN`](crate::Profile::EVEN), of which the second is known.
    pub(super) const EVEN: Self =
        Self { edges: &[0.0, 1.0, 4.0], minorants: &[0.25, 0.5], majorants: &[1.0, 0.5] };

    /// Start, end, lower and upper bound of each cell.
    pub(super) fn cells(&self) -> impl Iterator<Item = [f64; 4]> + '_ {
        (0..self.minorants.len())
            .map(|i| [self.edges[i], self.edges[i + 1], self.minorants[i], self.majorants[i]])
    }

    /// The cell that holds a distance.
    pub(super) fn at(&self, s: f64) -> [f64; 4] {
        let last = self.minorants.len() - 1;
        self.cells().find(|[_, to, ..]| s < *to).unwrap_or([
            0.0,
            0.0,
            self.minorants[last],
            self.majorants[last],
        ])
    }

    /// As specs have it.
    pub(super) fn json(&self) -> Value {
        json!({ "edges": self.edges, "minorants": self.minorants, "majorants": self.majorants })
    }
}
