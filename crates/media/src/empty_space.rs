//! No medium at all.

use crate::{Line, LineThickness, Medium, MediumBreakpoints};
use glam::DVec3;

/// σ_t(p) = 0, known at compile time: what a scene without a medium has. Code for a medium is left out where it stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EmptySpace;

impl Medium for EmptySpace {
    const IS_EMPTY: bool = true;

    #[inline]
    fn sigma_t_local(&self, _point: DVec3) -> f64 {
        0.0
    }
    fn upper_bound(&self) -> Option<f64> {
        Some(0.0)
    }
    fn lower_bound(&self) -> Option<f64> {
        Some(0.0)
    }
}

impl LineThickness for EmptySpace {
    #[inline]
    fn line_thickness(&self, _local: &Line, _from: f64, _to: f64) -> f64 {
        0.0
    }
    #[inline(always)]
    fn everywhere(&self) -> Option<f64> {
        Some(0.0)
    }
}

impl MediumBreakpoints for EmptySpace {
    fn line_breakpoints(&self, _local: &Line, _length: f64) -> Vec<f64> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Homogeneous, Observed};
    use std::sync::Arc;

    #[test]
    fn emptiness_is_known_behind_wrappers() {
        const {
            assert!(EmptySpace::IS_EMPTY && <&EmptySpace>::IS_EMPTY && Arc::<EmptySpace>::IS_EMPTY);
            assert!(Observed::<&EmptySpace>::IS_EMPTY);
            // A value that happens to be 0 is not known to the compiler.
            assert!(!Homogeneous::IS_EMPTY && !Observed::<&Homogeneous>::IS_EMPTY);
        }
    }

    #[test]
    fn nothing_is_nowhere() {
        let line = Line { origin: DVec3::ONE, direction: DVec3::X };
        assert_eq!(EmptySpace.sigma_t(DVec3::splat(3.0)), 0.0);
        assert_eq!(EmptySpace.line_thickness(&line, 1.0, f64::INFINITY), 0.0);
        assert_eq!((EmptySpace.upper_bound(), EmptySpace.lower_bound()), (Some(0.0), Some(0.0)));
        assert!(EmptySpace.line_breakpoints(&line, 2.0).is_empty());
    }
}
