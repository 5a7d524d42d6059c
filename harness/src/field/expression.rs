//! Formulas of the extinction: along a ray in s, in space in x, y and z.

use super::known::{Knowledge, KnownField, bounds_of};
use super::{AnyMedium, AnyProfile, BoundsRule, MediumKind, MediumLibrary, ProfileKind};
use crate::reader::rule::{Maybe, NonNegative, Text};
use crate::{Failure, kind};
use fairflight_media::{Bounds, Certificate, Certified, ExpressionMedium, ExpressionProfile, Ray};
use std::sync::Arc;

kind! {
    /// A formula in s.
    ExpressionSpec = "expression" {
        /// The extinction \[1/length\], in the distance s.
        sigma_t: String as Text,
        /// The length of the ray.
        length: f64 as NonNegative,
        /// An upper bound of the extinction \[1/length\], a fact that every look-up checks.
        majorant: Option<f64> as Maybe<NonNegative> = None,
    }
}

kind! {
    /// A formula in x, y and z.
    ExpressionMediumSpec = "expression" {
        /// The extinction \[1/length\], in x, y and z.
        sigma_t: String as Text,
        /// An upper bound of the extinction \[1/length\], a fact that every look-up checks.
        majorant: Option<f64> as Maybe<NonNegative> = None,
        /// The bounds, with vacuum outside.
        bounds: Bounds as BoundsRule,
    }
}

impl ProfileKind for ExpressionSpec {
    fn build(&self, _library: &MediumLibrary) -> Result<AnyProfile, Failure> {
        ExpressionProfile::new(&self.sigma_t, self.length, self.majorant)
            .map(|field| AnyProfile::Expression(Certified::new(field)))
            .map_err(|error| Failure::refused(format!("profile.sigma_t: {error}")))
    }
}

impl MediumKind for ExpressionMediumSpec {
    fn build(&self, _library: &MediumLibrary, key: &str) -> Result<(AnyMedium, Bounds), Failure> {
        let medium = ExpressionMedium::new(&self.sigma_t, self.majorant)
            .map_err(|error| Failure::refused(format!("{key}.sigma_t: {error}")))?;
        Ok((AnyMedium::Expression(Arc::new(medium)), self.bounds))
    }
}

impl KnownField for Certified<ExpressionProfile> {
    fn knowledge(&self) -> Knowledge {
        bounds_of(self)
    }
    fn certificate(&self) -> Option<&Certificate> {
        Some(Certified::certificate(self))
    }
}

impl KnownField for Certified<Ray<Arc<ExpressionMedium>>> {
    fn knowledge(&self) -> Knowledge {
        bounds_of(self)
    }
    fn certificate(&self) -> Option<&Certificate> {
        Some(Certified::certificate(self))
    }
}
