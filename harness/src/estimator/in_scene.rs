//! A scene as its estimator of transmittance is prepared for it: a medium, and a few of the rays that will come.

use super::{MOST_POINTS, refuse};
use crate::Failure;
use crate::field::{AnyMedium, AnyProfile, MediumLibrary, MediumSpec};
use fairflight_media::{BoundGrid, Bounds, Clip, EmptySpace};
use std::sync::Arc;

/// The medium of a scene, and some of the scene's own rays.
#[derive(Debug)]
pub struct InScene<'a> {
    /// The medium.
    pub medium: &'a AnyMedium,
    /// The spec that it was built from; none of an empty scene.
    pub spec: Option<&'a MediumSpec>,
    /// The place of the medium.
    pub bounds: &'a Bounds,
    /// Rays of the kind that will be estimated, from a stream of their own.
    pub rays: Vec<Clip>,
    /// Grids of bounds that were built so far.
    pub media: &'a MediumLibrary,
}

/// Look-ups before the first pixel, which none is charged with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Preparation {
    /// Number of the look-ups.
    pub lookups: u64,
    /// Use of the look-ups, in words.
    pub purpose: String,
}

/// Boxes along an edge of a grid at most: they hold 256 MiB.
const MOST: u32 = 256;
/// The same for a formula, whose bounds in a box take some hundred evaluations.
const MOST_OF_A_FORMULA: u32 = 32;

/// The estimators that take a medium of whose bounds in boxes nothing is known.
const INSTEAD: &str = "use jittered_ratio with a majorant, or unbiased_ray_marching with teeth";

impl InScene<'_> {
    /// The majorant that was given, else the one that the medium declares \[1/length\]; `key` is what it stands for.
    ///
    /// # Errors
    /// If there is neither.
    pub(super) fn majorant(&self, given: Option<f64>, key: &str) -> Result<f64, Failure> {
        given.map_or_else(|| self.medium.declared_extinction(key), Ok)
    }

    /// Length that no ray in the bounds exceeds \[length\].
    pub(super) fn longest(&self) -> f64 {
        2.0 * self.bounds.enclosing_ball().1
    }

    /// The rays as profiles, but for those through more voxels than a profile may have.
    pub(super) fn profiles(&self) -> Vec<AnyProfile> {
        self.rays.iter().filter_map(|clip| AnyProfile::ray(self.medium, clip).ok()).collect()
    }

    /// Checks that a few rays of these look-ups are affordable: it guards against a slip of the keyboard, before the budget of the image is known.
    ///
    /// # Errors
    /// If they are.
    pub(super) fn affords(&self, lookups: impl Iterator<Item = f64>, key: &str) -> Result<(), Failure> {
        let (sum, most) = (lookups.sum::<f64>(), MOST_POINTS as f64);
        if sum <= most {
            return Ok(());
        }
        Err(refuse(
            key,
            format!("takes {sum:.1e} look-ups on a few rays before the first pixel, more than {most:.0e}"),
        ))
    }

    /// The bounds of the medium in boxes, so many along the longest edge of its bounds; none where there is no medium.
    ///
    /// # Errors
    /// If the medium does not know its bounds in boxes, or there are too many of them.
    pub(super) fn grid(&self, longest: u32, key: &str) -> Result<Option<Arc<BoundGrid>>, Failure> {
        let Some(spec) = self.spec else { return Ok(None) };
        self.media.bound_grid((spec, longest), || self.build_grid(longest, key)).map(Some)
    }

    fn build_grid(&self, longest: u32, key: &str) -> Result<BoundGrid, Failure> {
        let most = if matches!(self.medium, AnyMedium::Expression(_)) { MOST_OF_A_FORMULA } else { MOST };
        if longest > most {
            return Err(refuse(key, format!("must be at most {most} boxes along an edge, found {longest}")));
        }
        let longest = longest as usize;
        let grid = match self.medium {
            AnyMedium::Empty => BoundGrid::around(&EmptySpace, self.bounds, longest),
            AnyMedium::Homogeneous(medium) => BoundGrid::around(medium, self.bounds, longest),
            AnyMedium::AnalyticCosine(medium) => BoundGrid::around(medium, self.bounds, longest),
            AnyMedium::Expression(medium) => BoundGrid::around(medium, self.bounds, longest),
            AnyMedium::Voxels(medium) => BoundGrid::around(medium, self.bounds, longest),
            AnyMedium::Perlin(_) => {
                return Err(refuse(
                    key,
                    format!("Perlin noise does not know its bounds in boxes; {INSTEAD}"),
                ));
            }
        };
        let grid = grid.map_err(|error| refuse(key, error))?;
        let (minorant, majorant) = grid.hull();
        if !(minorant.is_finite() && majorant.is_finite()) {
            return Err(refuse(
                key,
                format!("no bounds of sigma_t are found in some of the boxes; {INSTEAD}"),
            ));
        }
        Ok(grid)
    }
}
