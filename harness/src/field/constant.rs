//! The same extinction along the whole ray.

use super::known::{Knowledge, KnownField, exact};
use super::{AnyProfile, MediumLibrary, ProfileKind, refused};
use crate::reader::rule::{NonNegative, Number};
use crate::{Failure, kind};
use fairflight_media::Constant;

kind! {
    /// The same everywhere.
    ConstantSpec = "constant" {
        /// The extinction \[1/length\].
        sigma_t: f64 as Number,
        /// The length of the ray.
        length: f64 as NonNegative,
    }
}

impl ProfileKind for ConstantSpec {
    fn build(&self, _library: &MediumLibrary) -> Result<AnyProfile, Failure> {
        Constant::new(self.sigma_t, self.length).map(AnyProfile::Constant).map_err(refused)
    }
}

impl KnownField for Constant {
    fn knowledge(&self) -> Knowledge {
        exact(self)
    }
}
