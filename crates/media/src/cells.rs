//! Fields that are polynomials from one border to the next, and where those borders are: what regular tracking walks on.

use crate::{
    Constant, Counted, Domain, Extinction, Homogeneous, Line, Medium, PiecewiseConstant, PiecewiseLinear,
    Ray, Watched,
};
use std::sync::Arc;

/// A field in cells.
///
/// **Law.** Between two neighbouring borders (the ends of the profile among them) σ_t is a polynomial in s of degree at most
/// three. Values at a border itself may belong to either side.
///
/// More than [`crate::Breakpoints`], which says where a field is not smooth but nothing of it in between; and an iterator, so
/// that a flight that ends in the first cell pays for one.
pub trait Cells: Extinction {
    /// The borders strictly inside the profile, in increasing order \[length\]; duplicates allowed.
    fn borders(&self) -> impl Iterator<Item = f64>;
}

/// A medium that is in [`Cells`] along every straight line.
pub trait LineCells: Medium {
    /// The borders in `(0, length)` on a line in the medium's own coordinates, in increasing order; duplicates allowed.
    fn line_borders(&self, local: &Line, length: f64) -> impl Iterator<Item = f64>;
}

impl<M: LineCells> Cells for Ray<M> {
    fn borders(&self) -> impl Iterator<Item = f64> {
        self.medium().line_borders(self.local_line(), self.length())
    }
}

impl LineCells for Homogeneous {
    fn line_borders(&self, _local: &Line, _length: f64) -> impl Iterator<Item = f64> {
        std::iter::empty()
    }
}

impl Cells for Constant {
    fn borders(&self) -> impl Iterator<Item = f64> {
        std::iter::empty()
    }
}

impl Cells for PiecewiseConstant {
    fn borders(&self) -> impl Iterator<Item = f64> {
        self.inner_edges().iter().copied()
    }
}

impl Cells for PiecewiseLinear {
    fn borders(&self) -> impl Iterator<Item = f64> {
        self.inner_nodes().iter().copied()
    }
}

impl<F: Cells + ?Sized> Cells for &F {
    fn borders(&self) -> impl Iterator<Item = f64> {
        (**self).borders()
    }
}

impl<F: Cells> Cells for Counted<F> {
    fn borders(&self) -> impl Iterator<Item = f64> {
        self.field().borders()
    }
}

impl<F: Cells, D: Domain> Cells for Watched<F, D> {
    fn borders(&self) -> impl Iterator<Item = f64> {
        self.field().borders()
    }
}

impl<M: LineCells + ?Sized> LineCells for &M {
    fn line_borders(&self, local: &Line, length: f64) -> impl Iterator<Item = f64> {
        (**self).line_borders(local, length)
    }
}

impl<M: LineCells + ?Sized> LineCells for Arc<M> {
    fn line_borders(&self, local: &Line, length: f64) -> impl Iterator<Item = f64> {
        (**self).line_borders(local, length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Breakpoints;

    #[test]
    fn the_borders_are_the_breakpoints_in_order() {
        let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.5, 4.0], vec![1.0, 0.0, 3.0]).unwrap();
        assert_eq!(Cells::borders(&&steps).collect::<Vec<_>>(), [1.0, 2.5]);
        let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.0]).unwrap();
        assert_eq!(Counted::new(&tent).borders().collect::<Vec<_>>(), tent.breakpoints());
        assert_eq!(Constant::new(1.0, 2.0).unwrap().borders().count(), 0);
    }
}
