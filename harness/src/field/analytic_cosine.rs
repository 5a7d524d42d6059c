//! The analytic medium of szirmay-kalos-2017.

use super::known::{Knowledge, KnownField, ThicknessMethod, closed_form_of};
use super::{AnyMedium, BoundsRule, MediumKind, MediumLibrary};
use crate::reader::rule::{Maybe, Number};
use crate::{Failure, kind};
use fairflight_media::{AnalyticCosine, Bounds, Ray};
use std::sync::Arc;

kind! {
    /// The analytic medium of szirmay-kalos-2017 eq. 21.
    AnalyticCosineSpec = "analytic_cosine" {
        /// A factor of the extinction.
        scale: f64 as Number = 1.0,
        /// The bounds, with vacuum outside; the sphere of radius 10 around (0, 0, 10) by default.
        bounds: Option<Bounds> as Maybe<BoundsRule> = None,
    }
}

impl MediumKind for AnalyticCosineSpec {
    fn build(&self, _library: &MediumLibrary, key: &str) -> Result<(AnyMedium, Bounds), Failure> {
        let medium =
            AnalyticCosine::new(self.scale).map_err(|error| Failure::refused(format!("{key}: {error}")))?;
        let bounds = self.bounds.unwrap_or_else(AnalyticCosine::default_bounds);
        Ok((AnyMedium::AnalyticCosine(Arc::new(medium)), bounds))
    }
}

impl KnownField for Ray<Arc<AnalyticCosine>> {
    fn knowledge(&self) -> Knowledge {
        closed_form_of(self, ThicknessMethod::ClosedForm)
    }
}
