//! The part of a ray within the bounds of a medium.

use super::{AnyProfile, MediumLibrary, MediumSpec, ProfileKind, refused};
use crate::reader::rule::{Direction, Maybe, NonNegative, Own, Vector};
use crate::{Failure, kind};
use fairflight_media::Clip;
use glam::DVec3;

kind! {
    /// A ray through a medium.
    RaySpec = "ray" {
        /// The direction, normalised on reading.
        direction: DVec3 as Direction,
        /// The medium.
        medium: MediumSpec as Own,
        /// The point at which s is 0 \[length\].
        origin: DVec3 as Vector,
        /// The greatest distance from the origin; to the far end of the medium's bounds by default.
        length: Option<f64> as Maybe<NonNegative> = None,
    }
}

impl ProfileKind for RaySpec {
    fn build(&self, library: &MediumLibrary) -> Result<AnyProfile, Failure> {
        let (medium, bounds) = self.medium.kind().build(library, "profile.medium")?;
        let clip = bounds.clip(self.origin, self.direction, self.length).map_err(refused)?;
        AnyProfile::ray(&medium, &clip.unwrap_or_else(|| Clip::empty(self.origin, self.direction)))
    }
}
