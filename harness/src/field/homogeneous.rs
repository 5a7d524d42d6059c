//! The same extinction in all of the bounds.

use super::known::{Knowledge, KnownField, exact};
use super::{AnyMedium, BoundsRule, MediumKind, MediumLibrary};
use crate::reader::rule::Number;
use crate::{Failure, kind};
use fairflight_media::{Bounds, Homogeneous, Ray};
use std::sync::Arc;

kind! {
    /// The same everywhere.
    HomogeneousSpec = "homogeneous" {
        /// The extinction \[1/length\].
        sigma_t: f64 as Number,
        /// The bounds, with vacuum outside.
        bounds: Bounds as BoundsRule,
    }
}

impl MediumKind for HomogeneousSpec {
    fn build(&self, _library: &MediumLibrary, key: &str) -> Result<(AnyMedium, Bounds), Failure> {
        let medium =
            Homogeneous::new(self.sigma_t).map_err(|error| Failure::refused(format!("{key}: {error}")))?;
        Ok((AnyMedium::Homogeneous(Arc::new(medium)), self.bounds))
    }
}

impl KnownField for Ray<Arc<Homogeneous>> {
    fn knowledge(&self) -> Knowledge {
        exact(self)
    }
}
