//! One extinction per cell.

use super::known::{Knowledge, KnownField, exact};
use super::{AnyProfile, MediumLibrary, ProfileKind, refused};
use crate::reader::rule::Numbers;
use crate::{Failure, kind};
use fairflight_media::PiecewiseConstant;

kind! {
    /// One value per cell.
    PiecewiseConstantSpec = "piecewise_constant" {
        /// Borders of the cells, increasing from 0 \[length\].
        edges: Vec<f64> as Numbers,
        /// The extinction of each cell \[1/length\].
        sigma_t: Vec<f64> as Numbers,
    }
}

impl ProfileKind for PiecewiseConstantSpec {
    fn build(&self, _library: &MediumLibrary) -> Result<AnyProfile, Failure> {
        PiecewiseConstant::new(self.edges.clone(), self.sigma_t.clone())
            .map(AnyProfile::PiecewiseConstant)
            .map_err(refused)
    }
}

impl KnownField for PiecewiseConstant {
    fn knowledge(&self) -> Knowledge {
        exact(self)
    }
}
