//! An extinction linear between nodes.

use super::known::{Knowledge, KnownField, exact};
use super::{AnyProfile, MediumLibrary, ProfileKind, refused};
use crate::reader::rule::Numbers;
use crate::{Failure, kind};
use fairflight_media::PiecewiseLinear;

kind! {
    /// Linear between nodes.
    PiecewiseLinearSpec = "piecewise_linear" {
        /// Distances of the nodes, increasing from 0 \[length\].
        positions: Vec<f64> as Numbers,
        /// The extinction at each node \[1/length\].
        sigma_t: Vec<f64> as Numbers,
    }
}

impl ProfileKind for PiecewiseLinearSpec {
    fn build(&self, _library: &MediumLibrary) -> Result<AnyProfile, Failure> {
        PiecewiseLinear::new(self.positions.clone(), self.sigma_t.clone())
            .map(AnyProfile::PiecewiseLinear)
            .map_err(refused)
    }
}

impl KnownField for PiecewiseLinear {
    fn knowledge(&self) -> Knowledge {
        exact(self)
    }
}
