//! A control through explorer points: szirmay-kalos-2017 section 4 and fig. 5.

use fairflight_media::{Breakpoints, Extinction, OpticalThickness, lerp};

/// The extinction interpolated linearly through `count` equidistant look-ups of the profile, both ends included.
///
/// The look-ups are made once per profile; who compares costs charges them to every estimate. They are independent of the
/// interaction points: fitting a control to a walk's own interaction points is a bias.
#[derive(Clone, Debug, PartialEq)]
pub struct Explorers {
    values: Vec<f64>,
    /// ∫ from the start to each explorer.
    depth: Vec<f64>,
    length: f64,
}

/// A line needs two points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("explorers need a count of at least 2, found {found}")]
pub struct TooFewExplorers {
    /// The value given.
    pub found: usize,
}

impl Explorers {
    /// Looks `field` up at `count` points.
    ///
    /// # Errors
    /// If `count < 2`.
    pub fn through<F: Extinction + ?Sized>(field: &F, count: usize) -> Result<Self, TooFewExplorers> {
        if count < 2 {
            return Err(TooFewExplorers { found: count });
        }
        let mut explorers = Self { values: vec![0.0; count], depth: vec![0.0; count], length: 0.0 };
        explorers.refit(field);
        Ok(explorers)
    }

    /// Looks another profile up at as many points, without allocating: the next pixel's ray.
    pub fn refit<F: Extinction + ?Sized>(&mut self, field: &F) {
        self.length = field.length();
        for i in 0..self.values.len() {
            self.values[i] = field.sigma_t(self.position(i));
        }
        self.integrate();
    }

    /// The same values at the same fractions of another length, without a look-up: a control for a neighbouring ray
    /// (szirmay-kalos-2017 section 4, "data can even be borrowed from nearby rays").
    pub fn lend(&mut self, length: f64) {
        self.length = length;
        self.integrate();
    }

    fn integrate(&mut self) {
        let spacing = self.spacing();
        for i in 1..self.values.len() {
            self.depth[i] = self.depth[i - 1] + 0.5 * spacing * (self.values[i - 1] + self.values[i]);
        }
    }

    /// The explorer points, each with the extinction found there.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.values.iter().enumerate().map(|(i, &value)| (self.position(i), value))
    }

    /// The number of look-ups that fitting costs.
    #[must_use]
    pub fn count(&self) -> usize {
        self.values.len()
    }

    fn pieces(&self) -> usize {
        self.values.len() - 1
    }

    fn spacing(&self) -> f64 {
        self.length / self.pieces() as f64
    }

    /// The i-th point; the last is the end of the profile exactly.
    fn position(&self, i: usize) -> f64 {
        if i == self.pieces() { self.length } else { i as f64 * self.spacing() }
    }

    /// The piece that holds `s`, and the position in it in \[0, 1\].
    #[inline]
    fn locate(&self, s: f64) -> (usize, f64) {
        if self.length == 0.0 {
            return (0, 0.0);
        }
        let t = s / self.length * self.pieces() as f64;
        let piece = (t as usize).min(self.pieces() - 1);
        (piece, (t - piece as f64).clamp(0.0, 1.0))
    }

    fn depth_at(&self, s: f64) -> f64 {
        let (piece, t) = self.locate(s);
        let (left, right) = (self.values[piece], self.values[piece + 1]);
        self.depth[piece] + self.spacing() * t * (left + 0.5 * t * (right - left))
    }
}

impl Extinction for Explorers {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        let (piece, t) = self.locate(s);
        lerp(t, self.values[piece], self.values[piece + 1])
    }
    #[inline]
    fn length(&self) -> f64 {
        self.length
    }
}

impl OpticalThickness for Explorers {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        self.depth_at(to) - self.depth_at(from)
    }
}

impl Breakpoints for Explorers {
    fn breakpoints(&self) -> Vec<f64> {
        (1..self.pieces()).map(|i| self.position(i)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Counted, PiecewiseLinear};

    #[test]
    fn explorers_reproduce_a_field_that_is_linear_between_them() {
        let field = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.5]).unwrap();
        let counted = Counted::new(&field);
        let explorers = Explorers::through(&counted, 4).unwrap();
        assert_eq!(counted.lookups(), 4);
        for i in 0..=30 {
            let s = 0.1 * f64::from(i);
            assert!((explorers.sigma_t(s) - field.sigma_t(s)).abs() < 1e-14, "s = {s}");
            let (fitted, exact) = (explorers.optical_thickness(0.0, s), field.optical_thickness(0.0, s));
            assert!((fitted - exact).abs() < 1e-14);
        }
    }

    #[test]
    fn a_lent_control_keeps_its_values_at_the_same_fractions() {
        let field = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.5]).unwrap();
        let mut explorers = Explorers::through(&field, 4).unwrap();
        let (value, depth) = (explorers.sigma_t(1.5), explorers.optical_thickness(0.0, 1.5));
        explorers.lend(6.0);
        assert_eq!(explorers.length(), 6.0);
        assert_eq!((explorers.sigma_t(3.0), explorers.optical_thickness(0.0, 3.0)), (value, 2.0 * depth));
    }

    #[test]
    fn one_explorer_is_refused() {
        let field = PiecewiseLinear::new(vec![0.0, 1.0], vec![1.0, 1.0]).unwrap();
        assert_eq!(Explorers::through(&field, 1), Err(TooFewExplorers { found: 1 }));
    }
}
