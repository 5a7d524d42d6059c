//! A sampling extinction that is constant in each cell of a grid.

use crate::{NotPositive, SamplingExtinction};
use fairflight_media::{Bounds, Line, Medium};
use glam::DVec3;

/// σ_samp per cell of a box of equal cells; beside the box the value of the nearest cell.
///
/// szirmay-kalos-2017 section 4.1: "the sampling extinction can be a piece-wise constant function". It need be no majorant, so that
/// a few look-ups per cell are enough to choose it ([`Grid::fitted`]); where it is one, it is a majorant grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    min: DVec3,
    per_length: DVec3,
    cells: [usize; 3],
    sigma_samp: Vec<f64>,
    highest: f64,
    lowest: f64,
}

/// Error of a grid that cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// A value that is no sampling extinction.
    #[error(transparent)]
    NotPositive(#[from] NotPositive),
    /// A grid without cells, or with more than memory should be spent on.
    #[error("cells must be 1 to {most} in each direction, found {found}", most = Grid::MOST_CELLS)]
    Cells {
        /// The value given.
        found: usize,
    },
    /// A number of values that is not the number of cells.
    #[error("the grid needs {expected} values, found {found}")]
    Values {
        /// The number of cells.
        expected: usize,
        /// The number of values.
        found: usize,
    },
}

impl Grid {
    /// The most cells in one direction.
    pub const MOST_CELLS: usize = 512;

    /// Cells of the box around `bounds`, x fastest.
    ///
    /// # Errors
    /// If the number of cells or of values does not fit, or a value is not positive.
    pub fn new(bounds: &Bounds, cells: [usize; 3], sigma_samp: Vec<f64>) -> Result<Self, GridError> {
        if let Some(&found) = cells.iter().find(|count| !(1..=Self::MOST_CELLS).contains(*count)) {
            return Err(GridError::Cells { found });
        }
        let expected = cells.iter().product();
        if sigma_samp.len() != expected {
            return Err(GridError::Values { expected, found: sigma_samp.len() });
        }
        for &value in &sigma_samp {
            NotPositive::check("sigma_samp", value)?;
        }
        let (min, max) = corners(bounds);
        let per_length = DVec3::from_array(cells.map(|count| count as f64)) / (max - min);
        // A box without extent in a direction has one layer of cells there.
        let per_length = DVec3::select(per_length.is_finite_mask(), per_length, DVec3::ZERO);
        let highest = sigma_samp.iter().copied().fold(0.0, f64::max);
        let lowest = sigma_samp.iter().copied().fold(f64::INFINITY, f64::min);
        Ok(Self { min, per_length, cells, sigma_samp, highest, lowest })
    }

    /// A grid with, in each cell, `factor` times the greatest of `probes`³ look-ups on a regular lattice that includes the corners, and at
    /// least `least` > 0: a floor that keeps the rate positive where the look-ups found nothing.
    ///
    /// # Errors
    /// As [`new`](Self::new); also where the medium is not finite.
    pub fn fitted<M: Medium>(
        medium: &M,
        bounds: &Bounds,
        cells: [usize; 3],
        (probes, factor, least): (u32, f64, f64),
    ) -> Result<Self, GridError> {
        if let Some(&found) = cells.iter().find(|count| !(1..=Self::MOST_CELLS).contains(*count)) {
            return Err(GridError::Cells { found });
        }
        let (min, max) = corners(bounds);
        let cell = (max - min) / DVec3::from_array(cells.map(|count| count as f64));
        let last = f64::from(probes.max(2) - 1);
        let mut values = Vec::with_capacity(cells.iter().product());
        for z in 0..cells[2] {
            for y in 0..cells[1] {
                for x in 0..cells[0] {
                    let corner = min + cell * DVec3::new(x as f64, y as f64, z as f64);
                    let mut greatest = 0.0_f64;
                    for probe in 0..probes.max(2).pow(3) {
                        let n = probes.max(2);
                        let at = DVec3::new(
                            f64::from(probe % n),
                            f64::from(probe / n % n),
                            f64::from(probe / (n * n)),
                        ) / last;
                        greatest = greatest.max(medium.sigma_t(corner + at * cell).abs());
                    }
                    values.push((factor * greatest).max(least));
                }
            }
        }
        Self::new(bounds, cells, values)
    }
}

impl Grid {
    /// True if there is another cell in this direction. Beside the box the last cell goes on.
    #[inline]
    fn has_next(&self, cell: usize, axis: usize, slope: f64) -> bool {
        (slope > 0.0 && cell + 1 < self.cells[axis]) || (slope < 0.0 && cell > 0)
    }
}

fn corners(bounds: &Bounds) -> (DVec3, DVec3) {
    match *bounds {
        Bounds::Sphere { center, radius } => (center - radius, center + radius),
        Bounds::Box { min, max } => (min, max),
    }
}

impl SamplingExtinction for Grid {
    /// Flies from cell to cell (amanatides-1987); the depth that is left when a cell's share is passed goes on into the next.
    // Never inlined: where a grid is one of several sampling extinctions, its loop would take the registers of the others.
    #[inline(never)]
    fn fly(&self, line: &Line, from: f64, length: f64, depth: f64) -> Option<(f64, f64)> {
        let start = (line.at(from) - self.min) * self.per_length;
        let slope = line.direction * self.per_length;
        let mut cell = [0_usize; 3];
        // Distances at which the line leaves its cell along each axis, and from there to the next cell.
        let mut leaves = [f64::INFINITY; 3];
        let mut stride = [f64::INFINITY; 3];
        for axis in 0..3 {
            let last = self.cells[axis] - 1;
            // The cast saturates below at 0.
            cell[axis] = (start[axis] as usize).min(last);
            stride[axis] = slope[axis].abs().recip();
            if self.has_next(cell[axis], axis, slope[axis]) {
                let face = cell[axis] as f64 + f64::from(u8::from(slope[axis] > 0.0));
                leaves[axis] = from + ((face - start[axis]) / slope[axis]).max(0.0);
            }
        }
        let (mut s, mut depth) = (from, depth);
        loop {
            let index = cell[0] + self.cells[0] * (cell[1] + self.cells[1] * cell[2]);
            let sigma_samp = self.sigma_samp[index];
            let axis = if leaves[0] <= leaves[1] && leaves[0] <= leaves[2] {
                0
            } else if leaves[1] <= leaves[2] {
                1
            } else {
                2
            };
            let exit = leaves[axis];
            let share = sigma_samp * (exit - s);
            if depth < share {
                s += depth / sigma_samp;
                return (s < length).then_some((s, sigma_samp));
            }
            if exit >= length {
                return None;
            }
            depth -= share;
            s = exit;
            cell[axis] = if slope[axis] > 0.0 { cell[axis] + 1 } else { cell[axis] - 1 };
            if self.has_next(cell[axis], axis, slope[axis]) {
                leaves[axis] += stride[axis];
            } else {
                leaves[axis] = f64::INFINITY;
            }
        }
    }
    fn highest(&self) -> f64 {
        self.highest
    }
    fn lowest(&self) -> f64 {
        self.lowest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::AnalyticCosine;
    use glam::dvec3;

    fn grid() -> Grid {
        let bounds = Bounds::aligned_box(dvec3(-1.0, 0.0, 2.0), dvec3(3.0, 3.0, 4.0)).unwrap();
        let values = (0..24).map(|i| 0.25 + f64::from(i * 7 % 11)).collect();
        Grid::new(&bounds, [4, 3, 2], values).unwrap()
    }

    /// The value at a point, by rounding down.
    fn value(grid: &Grid, point: DVec3) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let cell = ((point - grid.min) * grid.per_length)[axis].floor().max(0.0) as usize;
            cell.min(grid.cells[axis] - 1)
        });
        grid.sigma_samp[x + 4 * (y + 3 * z)]
    }

    #[test]
    fn a_flight_ends_where_the_depth_is_reached() {
        let grid = grid();
        for i in 0..200 {
            let t = f64::from(i);
            let direction = dvec3(t.sin(), (1.3 * t).cos(), (0.7 * t).sin()).normalize();
            let origin =
                dvec3(1.0 + (0.9 * t).sin(), 1.5 + 1.4 * (0.4 * t).cos(), 3.0 + 0.9 * (2.2 * t).sin());
            let line = Line { origin, direction };
            let depth = 4.0 * (0.618 * t).fract();
            let Some((s, sigma_samp)) = grid.fly(&line, 0.3, 2.5, depth) else { continue };
            assert_eq!(sigma_samp, value(&grid, line.at(s)), "{line:?} {s}");
            let steps = 40_000;
            let h = (s - 0.3) / f64::from(steps);
            let sum: f64 =
                (0..steps).map(|k| h * value(&grid, line.at(0.3 + h * (f64::from(k) + 0.5)))).sum();
            assert!((sum - depth).abs() < 2e-3, "{line:?} {s}: {sum} for {depth}");
        }
    }

    #[test]
    fn axis_parallel_lines_in_faces_and_edges_end() {
        let grid = grid();
        for direction in [DVec3::X, -DVec3::X, dvec3(-0.0, 1.0, 0.0), -DVec3::Z] {
            for origin in [dvec3(0.0, 1.0, 3.0), dvec3(-1.0, 0.0, 2.0), dvec3(3.0, 3.0, 4.0)] {
                let line = Line { origin, direction };
                assert!(grid.fly(&line, 0.0, 1e9, 1e6).is_some());
                assert!(grid.fly(&line, 0.0, 1.0, 1e6).is_none());
                let (s, _) = grid.fly(&line, 0.0, 1.0, 0.0).unwrap();
                assert_eq!(s, 0.0);
            }
        }
    }

    /// σ_t = x + 10 y + 100 z.
    struct Slope;

    impl Medium for Slope {
        fn sigma_t_local(&self, point: DVec3) -> f64 {
            point.dot(dvec3(1.0, 10.0, 100.0))
        }
        fn upper_bound(&self) -> Option<f64> {
            None
        }
        fn lower_bound(&self) -> Option<f64> {
            None
        }
    }

    #[test]
    fn a_fitted_cell_has_the_greatest_value_of_its_corners() {
        let bounds = Bounds::aligned_box(dvec3(1.0, 2.0, 3.0), dvec3(3.0, 5.0, 7.0)).unwrap();
        let grid = Grid::fitted(&Slope, &bounds, [2, 3, 4], (2, 2.0, 1.0)).unwrap();
        // Cells of the size 1: twice the value at the far corner.
        let far = |i: usize| dvec3((2 + i % 2) as f64, (3 + i / 2 % 3) as f64, (4 + i / 6) as f64);
        let exact: Vec<f64> = (0..24).map(|i| 2.0 * Slope.sigma_t(far(i))).collect();
        assert_eq!(grid.sigma_samp, exact);
        assert_eq!((grid.lowest(), grid.highest()), (2.0 * 432.0, 2.0 * 753.0));
    }

    #[test]
    fn a_fitted_grid_follows_the_medium() {
        let medium = AnalyticCosine::new(1.0).unwrap();
        let bounds = AnalyticCosine::default_bounds();
        let grid = Grid::fitted(&medium, &bounds, [40; 3], (3, 1.0, 0.05)).unwrap();
        assert!(grid.highest() <= 1.0 && grid.lowest() == 0.05 && grid.highest() > 0.9);
        assert!(matches!(Grid::new(&bounds, [0, 1, 1], vec![]), Err(GridError::Cells { found: 0 })));
        assert!(matches!(Grid::new(&bounds, [2, 1, 1], vec![1.0]), Err(GridError::Values { .. })));
        assert!(matches!(Grid::new(&bounds, [1; 3], vec![0.0]), Err(GridError::NotPositive(_))));
    }
}
