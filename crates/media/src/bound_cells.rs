//! Fields with an upper and a lower bound in each of many cells: what tracking with local bounds walks on.

use crate::of_field::of_field;
use crate::{
    Breakpoints, Counted, Domain, Extinction, FieldError, Majorant, Minorant, OpticalThickness, Watched,
};

/// The end of a cell, and what σ_t keeps to inside it. The cell begins where the one before it ends, the first at 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundCell {
    /// End of the cell \[length\].
    pub to: f64,
    /// Lower bound of σ_t in the cell \[1/length\].
    pub minorant: f64,
    /// Upper bound of σ_t in the cell \[1/length\].
    pub majorant: f64,
}

impl BoundCell {
    /// Width of the range of σ_t inside the cell, majorant − minorant \[1/length\].
    #[inline]
    #[must_use]
    pub fn range(&self) -> f64 {
        self.majorant - self.minorant
    }

    /// True if σ_t may have this value inside the cell.
    #[inline]
    #[must_use]
    pub fn admits(&self, sigma_t: f64) -> bool {
        (self.minorant..=self.majorant).contains(&sigma_t)
    }
}

/// A field that is bounded in cells.
///
/// **Law.** The cells cover the profile in order: each `to` exceeds the one before it, the last one is the length. σ_t stays
/// between the bounds of its cell; at a border between two cells it may keep to those of either. A profile of length 0 may
/// have no cells.
pub trait BoundedInCells: Extinction {
    /// The cells, in order.
    fn bound_cells(&self) -> &[BoundCell];

    /// True if σ_t may have this value at `s`: the domain of an estimator that relies on the cells.
    fn cells_admit(&self, s: f64, sigma_t: f64) -> bool {
        let cells = self.bound_cells();
        let first = cells.partition_point(|cell| cell.to < s).min(cells.len().saturating_sub(1));
        let mut at = cells[first..].iter().take(2);
        let Some(cell) = at.next() else { return sigma_t.is_finite() };
        cell.admits(sigma_t) || (cell.to == s && at.next().is_some_and(|after| after.admits(sigma_t)))
    }
}

/// A field with cells that somebody claims for it: from a grid that the ray was traced through, or found beforehand.
///
/// The claim is a parameter, not knowledge: watch it at every look-up with [`crate::Watched`]. `C` may borrow, so that a
/// buffer of cells serves one ray after another.
#[derive(Clone, Copy, Debug)]
pub struct InCells<F, C> {
    field: F,
    cells: C,
    minorant: f64,
    majorant: f64,
}

impl<F: Extinction, C: AsRef<[BoundCell]>> InCells<F, C> {
    /// `field` with the claimed `cells`.
    ///
    /// # Errors
    /// If a bound is not finite, a majorant is below its minorant, the ends of the cells do not increase, or they do not
    /// cover the profile.
    pub fn new(field: F, cells: C) -> Result<Self, FieldError> {
        let (mut from, mut minorant, mut majorant) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
        for (index, cell) in cells.as_ref().iter().enumerate() {
            // Rays are many: the names are made only to refuse one.
            FieldError::check_at_least("majorant", cell.minorant, cell.majorant)?;
            FieldError::check_finite("minorant", cell.minorant)?;
            FieldError::check_finite("to", cell.to)?;
            if cell.to <= from {
                let (previous, found) = (from, cell.to);
                return Err(FieldError::NotIncreasing { what: "to", index, previous, found });
            }
            (from, minorant, majorant) = (cell.to, minorant.min(cell.minorant), majorant.max(cell.majorant));
        }
        if from != field.length() {
            return Err(FieldError::NotAtEnd { what: "cells", length: field.length(), found: from });
        }
        if from == 0.0 {
            (minorant, majorant) = (0.0, 0.0);
        }
        Ok(Self { field, cells, minorant, majorant })
    }

    /// The field without the claim.
    pub fn field(&self) -> &F {
        &self.field
    }

    /// Another field with the same claim, which is not checked again: one of the same length.
    pub fn with_field<G: Extinction>(&self, field: G) -> InCells<G, &[BoundCell]> {
        debug_assert_eq!(field.length(), self.field.length(), "cells of another profile");
        InCells { field, cells: self.cells.as_ref(), minorant: self.minorant, majorant: self.majorant }
    }
}

of_field!(Extinction, [F: Extinction, C] InCells<F, C>);

impl<F: Extinction, C: AsRef<[BoundCell]>> BoundedInCells for InCells<F, C> {
    #[inline]
    fn bound_cells(&self) -> &[BoundCell] {
        self.cells.as_ref()
    }
}

/// The greatest majorant of a cell.
impl<F: Extinction, C> Majorant for InCells<F, C> {
    #[inline]
    fn majorant(&self) -> f64 {
        self.majorant
    }
}

/// The least minorant of a cell.
impl<F: Extinction, C> Minorant for InCells<F, C> {
    #[inline]
    fn minorant(&self) -> f64 {
        self.minorant
    }
}

of_field!(OpticalThickness, [F: OpticalThickness, C] InCells<F, C>);
of_field!(Breakpoints, [F: Breakpoints, C] InCells<F, C>);

impl<F: BoundedInCells + ?Sized> BoundedInCells for &F {
    #[inline]
    fn bound_cells(&self) -> &[BoundCell] {
        (**self).bound_cells()
    }
}

impl<F: BoundedInCells> BoundedInCells for Counted<F> {
    #[inline]
    fn bound_cells(&self) -> &[BoundCell] {
        self.field().bound_cells()
    }
}

impl<F: BoundedInCells, D: Domain> BoundedInCells for Watched<F, D> {
    #[inline]
    fn bound_cells(&self) -> &[BoundCell] {
        self.field().bound_cells()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Constant, PiecewiseConstant};

    fn cell(to: f64, minorant: f64, majorant: f64) -> BoundCell {
        BoundCell { to, minorant, majorant }
    }

    fn steps() -> PiecewiseConstant {
        PiecewiseConstant::new(vec![0.0, 1.0, 3.0], vec![2.0, 0.5]).unwrap()
    }

    #[test]
    fn the_bounds_of_the_whole_are_those_of_the_cells() {
        let field = InCells::new(steps(), [cell(1.0, 1.5, 2.0), cell(3.0, 0.5, 0.75)]).unwrap();
        assert_eq!((field.minorant(), field.majorant(), field.length()), (0.5, 2.0, 3.0));
        assert_eq!((field.sigma_t(0.5), field.optical_thickness(0.0, 3.0)), (2.0, 3.0));
        assert_eq!(field.breakpoints(), [1.0]);
        assert_eq!(Counted::new(&field).bound_cells().len(), 2);
    }

    #[test]
    fn a_border_belongs_to_either_side() {
        let field = InCells::new(steps(), [cell(1.0, 1.5, 2.0), cell(3.0, 0.5, 0.75)]).unwrap();
        let admitted = |s, values: [f64; 3]| values.map(|sigma_t| field.cells_admit(s, sigma_t));
        assert_eq!(admitted(0.0, [2.0, 0.5, 1.0]), [true, false, false]);
        assert_eq!(admitted(1.0, [2.0, 0.5, 1.0]), [true, true, false]);
        assert_eq!(admitted(1.1, [2.0, 0.5, 1.0]), [false, true, false]);
        assert_eq!(admitted(3.0, [2.0, 0.5, f64::NAN]), [false, true, false]);
    }

    #[test]
    fn what_is_refused() {
        let new = |cells: &[BoundCell]| InCells::new(steps(), cells.to_vec()).map(|_| ());
        assert!(matches!(
            new(&[cell(1.0, 0.0, 2.0)]),
            Err(FieldError::NotAtEnd { length: 3.0, found: 1.0, .. })
        ));
        assert!(matches!(new(&[]), Err(FieldError::NotAtEnd { .. })));
        assert!(matches!(new(&[cell(3.0, 2.0, 1.0)]), Err(FieldError::TooSmall { what: "majorant", .. })));
        assert!(matches!(new(&[cell(3.0, f64::NEG_INFINITY, 1.0)]), Err(FieldError::NotFinite { .. })));
        assert!(matches!(new(&[cell(3.0, 0.0, f64::NAN)]), Err(FieldError::NotFinite { .. })));
        let twice = [cell(1.0, 0.0, 2.0), cell(1.0, 0.0, 2.0), cell(3.0, 0.0, 2.0)];
        assert!(matches!(new(&twice), Err(FieldError::NotIncreasing { index: 1, .. })));
    }

    #[test]
    fn a_ray_that_misses_has_no_cells() {
        let nothing = InCells::new(Constant::new(1.0, 0.0).unwrap(), []).unwrap();
        assert_eq!((nothing.minorant(), nothing.majorant()), (0.0, 0.0));
        assert!(nothing.cells_admit(0.0, 1.0));
    }
}
