//! A constant extinction in each of n cells.

use crate::{
    Breakpoints, Extinction, FieldError, InvertOpticalThickness, Majorant, Minorant, OpticalThickness,
};

/// σ_t(s) = σ_i for `edges[i] ≤ s < edges[i + 1]`. As a profile, a control, or a sampling extinction.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseConstant {
    edges: Vec<f64>,
    sigma_t: Vec<f64>,
    /// ∫ σ_t from the first edge to edge i.
    depth_at_edge: Vec<f64>,
}

impl PiecewiseConstant {
    /// Cells between `edges` \[length\], of which the first is 0, with one `sigma_t` \[1/length\] each, of any sign.
    ///
    /// # Errors
    /// If the edges are fewer than two, do not start at 0, do not increase, do not fit the number of values, or a number
    /// is not finite.
    pub fn new(edges: Vec<f64>, sigma_t: Vec<f64>) -> Result<Self, FieldError> {
        FieldError::check_nodes("edges", &edges)?;
        FieldError::check_len("sigma_t", edges.len() - 1, sigma_t.len())?;
        FieldError::check_all_finite("sigma_t", &sigma_t)?;
        if edges[0] != 0.0 {
            return Err(FieldError::NotAtStart { what: "edges", found: edges[0] });
        }
        let mut depth_at_edge = vec![0.0];
        let mut depth = 0.0;
        for (cell, sigma) in edges.windows(2).zip(&sigma_t) {
            depth += sigma * (cell[1] - cell[0]);
            depth_at_edge.push(depth);
        }
        Ok(Self { edges, sigma_t, depth_at_edge })
    }

    /// The edges strictly inside the profile.
    pub(crate) fn inner_edges(&self) -> &[f64] {
        &self.edges[1..self.edges.len() - 1]
    }

    /// The cell that holds `s`; a point on an edge belongs to the cell that starts there.
    #[inline]
    fn cell(&self, s: f64) -> usize {
        self.inner_edges().partition_point(|&edge| edge <= s)
    }

    /// The values met on `from ≤ s < to`.
    pub(crate) fn values_between(&self, from: f64, to: f64) -> &[f64] {
        let first = self.cell(from);
        let last = self.inner_edges().partition_point(|&edge| edge < to);
        &self.sigma_t[first..=last.max(first)]
    }

    /// ∫ σ_t from the start of the profile to `s`.
    #[inline]
    fn depth(&self, s: f64) -> f64 {
        let i = self.cell(s);
        self.depth_at_edge[i] + self.sigma_t[i] * (s - self.edges[i])
    }
}

impl Extinction for PiecewiseConstant {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        self.sigma_t[self.cell(s)]
    }
    #[inline]
    fn length(&self) -> f64 {
        self.edges[self.edges.len() - 1]
    }
}

impl Majorant for PiecewiseConstant {
    fn majorant(&self) -> f64 {
        self.sigma_t.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }
}

impl Minorant for PiecewiseConstant {
    fn minorant(&self) -> f64 {
        self.sigma_t.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

impl OpticalThickness for PiecewiseConstant {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        let (first, last) = (self.cell(from), self.cell(to));
        if first == last {
            // Not a difference of two depths: a short stretch far along a thick profile keeps its digits.
            return self.sigma_t[first] * (to - from);
        }
        let head = self.sigma_t[first] * (self.edges[first + 1] - from);
        let body = self.depth_at_edge[last] - self.depth_at_edge[first + 1];
        let tail = self.sigma_t[last] * (to - self.edges[last]);
        head + body + tail
    }
}

impl InvertOpticalThickness for PiecewiseConstant {
    #[inline]
    fn invert(&self, from: f64, depth: f64) -> Option<f64> {
        debug_assert!(self.minorant() >= 0.0, "a sampling extinction is not negative");
        let target = self.depth(from) + depth;
        // The cell in which the depth passes the target. An empty cell never holds a target strictly inside it.
        let after = &self.depth_at_edge[1..];
        let cell = after.partition_point(|&at_edge| at_edge <= target);
        let sigma_t = *self.sigma_t.get(cell)?;
        let s = self.edges[cell] + (target - self.depth_at_edge[cell]) / sigma_t;
        // Rounding may carry s to the cell's far edge, behind which there may be no extinction, or back before the start.
        let s = s.min(self.edges[cell + 1].next_down()).max(from);
        (s < self.length()).then_some(s)
    }
}

impl Breakpoints for PiecewiseConstant {
    fn breakpoints(&self) -> Vec<f64> {
        self.inner_edges().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field() -> PiecewiseConstant {
        PiecewiseConstant::new(vec![0.0, 1.0, 3.0, 4.0], vec![2.0, 0.0, 0.5]).unwrap()
    }

    #[test]
    fn a_point_on_an_edge_belongs_to_the_cell_that_starts_there() {
        let field = field();
        assert_eq!([0.0, 1.0, 3.0, 4.0].map(|s| field.sigma_t(s)), [2.0, 0.0, 0.5, 0.5]);
    }

    #[test]
    fn the_optical_thickness_is_the_sum_over_cells() {
        let field = field();
        assert_eq!(field.optical_thickness(0.0, 4.0), 2.5);
        assert_eq!(field.optical_thickness(0.5, 3.5), 1.25);
        assert_eq!(field.optical_thickness(1.5, 2.0), 0.0);
    }

    #[test]
    fn inversion_skips_the_empty_cell() {
        let field = field();
        assert_eq!(field.invert(0.0, 1.0), Some(0.5));
        assert_eq!(field.invert(0.5, 1.25), Some(3.5));
        assert_eq!(field.invert(2.0, 0.25), Some(3.5));
        assert_eq!(field.invert(0.0, 2.5), None);
    }

    #[test]
    fn no_flight_ends_where_there_is_nothing() {
        // Depths a few roundings short of the end of a cell, behind which σ_t is 0: the flight must end before it.
        let field = PiecewiseConstant::new(vec![0.0, 0.8, 2.3, 2.9], vec![0.0, 1.4, 0.0]).unwrap();
        let (mut depth, mut landed) = (field.optical_thickness(0.0, 2.3), 0);
        for _ in 0..8 {
            depth = depth.next_down();
            if let Some(s) = field.invert(0.0, depth) {
                assert!(field.sigma_t(s) > 0.0, "{s}");
                landed += 1;
            }
        }
        assert!(landed > 4);
    }

    #[test]
    fn a_narrow_spike_is_exact() {
        // Hard case 9: sigma_t = 1e6 on 1e-6 of the ray.
        let spike = PiecewiseConstant::new(vec![0.0, 0.5, 0.500_001, 1.0], vec![0.0, 1e6, 0.0]).unwrap();
        assert!((spike.optical_thickness(0.0, 1.0) - 1.0).abs() < 1e-9);
        let s = spike.invert(0.0, 0.5).unwrap();
        assert!((s - 0.500_000_5).abs() < 1e-12);
    }

    #[test]
    fn bad_lists_are_refused() {
        let new = |edges: &[f64], sigma_t: &[f64]| PiecewiseConstant::new(edges.to_vec(), sigma_t.to_vec());
        assert!(matches!(new(&[], &[]), Err(FieldError::TooFew { .. })));
        assert!(matches!(new(&[0.0, 1.0], &[]), Err(FieldError::LengthMismatch { .. })));
        assert!(matches!(
            new(&[0.0, 1.0, 1.0], &[1.0, 1.0]),
            Err(FieldError::NotIncreasing { index: 2, .. })
        ));
        assert!(matches!(new(&[0.5, 1.0], &[1.0]), Err(FieldError::NotAtStart { .. })));
        assert!(matches!(new(&[0.0, 1.0], &[f64::NAN]), Err(FieldError::NotFinite { .. })));
    }
}
