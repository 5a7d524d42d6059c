//! Extinction interpolated linearly between n nodes.

use crate::{Breakpoints, Extinction, FieldError, Majorant, Minorant, OpticalThickness};

/// σ_t(s) linear between `(positions[i], sigma_t[i])` and the next node. As a profile or a control.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear {
    positions: Vec<f64>,
    sigma_t: Vec<f64>,
    /// ∫ σ_t from the first position to position i.
    depth_at_node: Vec<f64>,
}

impl PiecewiseLinear {
    /// Nodes at `positions` \[length\], of which the first is 0, with values `sigma_t` \[1/length\] of any sign.
    ///
    /// # Errors
    /// If the positions are fewer than two, do not start at 0, do not increase, do not fit the number of values, or a
    /// number is not finite.
    pub fn new(positions: Vec<f64>, sigma_t: Vec<f64>) -> Result<Self, FieldError> {
        FieldError::check_nodes("positions", &positions)?;
        FieldError::check_len("sigma_t", positions.len(), sigma_t.len())?;
        FieldError::check_all_finite("sigma_t", &sigma_t)?;
        if positions[0] != 0.0 {
            return Err(FieldError::NotAtStart { what: "positions", found: positions[0] });
        }
        let mut field = Self { depth_at_node: vec![0.0; positions.len()], positions, sigma_t };
        for i in 1..field.positions.len() {
            let width = field.positions[i] - field.positions[i - 1];
            let trapezoid = 0.5 * width * (field.sigma_t[i - 1] + field.sigma_t[i]);
            field.depth_at_node[i] = field.depth_at_node[i - 1] + trapezoid;
        }
        Ok(field)
    }

    #[inline]
    fn piece(&self, s: f64) -> usize {
        let inner = &self.positions[1..self.positions.len() - 1];
        inner.partition_point(|&node| node <= s)
    }

    /// σ_t at `s` in piece `i`, clamped to the piece so that rounding never extrapolates.
    #[inline]
    fn value_in(&self, i: usize, s: f64) -> f64 {
        let t = (s - self.positions[i]) / (self.positions[i + 1] - self.positions[i]);
        let t = t.clamp(0.0, 1.0);
        (1.0 - t) * self.sigma_t[i] + t * self.sigma_t[i + 1]
    }

    /// The trapezoid between two points of piece `i`.
    fn thickness_in(&self, i: usize, from: f64, to: f64) -> f64 {
        0.5 * (to - from) * (self.value_in(i, from) + self.value_in(i, to))
    }
}

impl Extinction for PiecewiseLinear {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        self.value_in(self.piece(s), s)
    }
    #[inline]
    fn length(&self) -> f64 {
        self.positions[self.positions.len() - 1]
    }
}

impl Majorant for PiecewiseLinear {
    fn majorant(&self) -> f64 {
        self.sigma_t.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }
}

impl Minorant for PiecewiseLinear {
    fn minorant(&self) -> f64 {
        self.sigma_t.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

impl OpticalThickness for PiecewiseLinear {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        let (first, last) = (self.piece(from), self.piece(to));
        if first == last {
            return self.thickness_in(first, from, to);
        }
        self.thickness_in(first, from, self.positions[first + 1])
            + (self.depth_at_node[last] - self.depth_at_node[first + 1])
            + self.thickness_in(last, self.positions[last], to)
    }
}

impl Breakpoints for PiecewiseLinear {
    fn breakpoints(&self) -> Vec<f64> {
        self.positions[1..self.positions.len() - 1].to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_integral_of_a_tent() {
        let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.0]).unwrap();
        assert_eq!([0.0, 0.5, 1.0, 2.0, 3.0].map(|s| tent.sigma_t(s)), [0.0, 1.0, 2.0, 1.0, 0.0]);
        assert_eq!(tent.optical_thickness(0.0, 3.0), 3.0);
        assert_eq!(tent.optical_thickness(0.5, 2.0), 0.75 + 1.5);
        assert_eq!(tent.majorant(), 2.0);
        assert_eq!(tent.minorant(), 0.0);
    }

    #[test]
    fn bad_lists_are_refused() {
        let new = |p: &[f64], v: &[f64]| PiecewiseLinear::new(p.to_vec(), v.to_vec());
        assert!(matches!(new(&[0.0], &[1.0]), Err(FieldError::TooFew { .. })));
        assert!(matches!(new(&[0.0, 1.0], &[1.0]), Err(FieldError::LengthMismatch { .. })));
        assert!(matches!(new(&[0.0, -1.0], &[1.0, 1.0]), Err(FieldError::NotIncreasing { .. })));
        assert!(matches!(new(&[1.0, 2.0], &[1.0, 1.0]), Err(FieldError::NotAtStart { .. })));
    }
}
