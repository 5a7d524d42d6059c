//! Explorer points borrowed from the pixels before: szirmay-kalos-2017 section 4, "data can even be borrowed from nearby
//! rays", projected by putting the distance of the borrowed ray into the equation of the current one.

use std::collections::VecDeque;

/// The look-ups of the last few rays of a row.
///
/// They are independent of the interaction points of the current ray, so that a control built from them biases nothing.
#[derive(Clone, Debug, Default)]
pub(super) struct Borrowed {
    rays: VecDeque<Vec<(f64, f64)>>,
}

/// Rays that are remembered: with ten look-ups each, about as many points as the paper's fig. 5 shows.
pub(super) const RAYS: usize = 3;
/// Cells of the control: the points within one are averaged.
pub(super) const CELLS: usize = 16;

impl Borrowed {
    /// Nodes and values of a piecewise linear control over a profile that begins at this distance from the camera: one node in the middle of each cell that holds
    /// borrowed points, constant beyond the first and the last; zero where nothing was borrowed.
    pub(super) fn control(&self, entry: f64, length: f64) -> (Vec<f64>, Vec<f64>) {
        let mut cells = [(0.0, 0u32); CELLS];
        for (distance, sigma_t) in self.rays.iter().flatten() {
            let s = distance - entry;
            if (0.0..length).contains(&s) {
                let cell = &mut cells[((s / length * CELLS as f64) as usize).min(CELLS - 1)];
                *cell = (cell.0 + sigma_t, cell.1 + 1);
            }
        }
        let filled = cells.iter().enumerate().filter(|(_, (_, count))| *count > 0);
        let nodes: Vec<(f64, f64)> = filled
            .map(|(i, (sum, count))| (length * (i as f64 + 0.5) / CELLS as f64, sum / f64::from(*count)))
            .collect();
        let first = nodes.first().map_or(0.0, |node| node.1);
        let last = nodes.last().map_or(0.0, |node| node.1);
        let positions = [0.0].into_iter().chain(nodes.iter().map(|node| node.0)).chain([length]).collect();
        let values = [first].into_iter().chain(nodes.iter().map(|node| node.1)).chain([last]).collect();
        (positions, values)
    }

    /// Remembers the look-ups of a ray.
    pub(super) fn give(&mut self, entry: f64, points: &[(f64, f64)]) {
        if self.rays.len() == RAYS {
            self.rays.pop_front();
        }
        self.rays.push_back(points.iter().map(|(s, sigma_t)| (entry + s, *sigma_t)).collect());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_averaged_per_cell_and_shifted_by_the_entry() {
        let mut borrowed = Borrowed::default();
        assert_eq!(borrowed.control(5.0, 16.0), (vec![0.0, 16.0], vec![0.0, 0.0]));
        borrowed.give(6.0, &[(0.2, 1.0), (0.6, 3.0), (9.1, 7.0)]);
        let (positions, values) = borrowed.control(5.0, 16.0);
        assert_eq!(positions, [0.0, 1.5, 10.5, 16.0]);
        assert_eq!(values, [2.0, 2.0, 7.0, 7.0]);
        for _ in 0..RAYS {
            borrowed.give(5.0, &[]);
        }
        assert_eq!(borrowed.control(5.0, 16.0).0.len(), 2);
    }
}
