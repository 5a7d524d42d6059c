//! Jittered ratio tracking.

use super::cells::{cells, range};
use super::erased::{ByCells, ByMajorant};
use super::in_grid::{self, CellEstimator};
use super::{CellsSpec, EstimatorKind, Expected, InScene, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::Object;
use crate::reader::rule::{Maybe, NonNegative, Own, Positive};
use crate::{Failure, kind};
use fairflight_transmittance::{JitteredRatio, JitteredRatioInCells};

kind! {
    /// Ratio tracking with one candidate per stratum of the majorant's optical thickness; estimates lie in [0, 1].
    JitteredRatioSpec = "jittered_ratio" {
        /// Bounds of σ_t in cells: a number of them, in a scene of boxes along the longest edge of the medium; or edges, minorants and majorants.
        cells: Option<CellsSpec> as Maybe<Own> = None,
        /// An upper bound of σ_t \[1/length\]; what the field declares by default.
        majorant: Option<f64> as Maybe<NonNegative> = None,
        /// The optical thickness of a stratum in the majorant.
        epsilon: f64 as Positive,
    }
    check JitteredRatioSpec::check
}

impl JitteredRatioSpec {
    /// The spec below a majorant [1/length].
    #[must_use]
    pub fn below(majorant: f64, epsilon: f64) -> Self {
        Self { cells: None, majorant: Some(majorant), epsilon }
    }

    /// The spec within bounds in cells.
    #[must_use]
    pub fn in_cells(cells: CellsSpec, epsilon: f64) -> Self {
        Self { cells: Some(cells), majorant: None, epsilon }
    }

    fn check(&self, object: &Object<'_>) -> Result<(), Failure> {
        // A single bound beside the cells would be a claim that nobody uses.
        if self.cells.is_some() && self.majorant.is_some() {
            let majorant = object.required("majorant")?;
            return Err(majorant.reject("cells have majorants of their own: give one of the two"));
        }
        Ok(())
    }

    fn below_majorant(&self, majorant: f64, key: &str) -> Result<ByMajorant<JitteredRatio>, Failure> {
        let at = |what: &str| format!("{key}.{what}");
        // The claim first, as it stands first.
        let claim = ByMajorant::new((), majorant).map_err(|error| refuse(&at("majorant"), error))?;
        let estimator = JitteredRatio::new(self.epsilon).map_err(|error| refuse(&at("epsilon"), error))?;
        Ok(claim.with(estimator))
    }

    fn between_cells(&self, key: &str) -> Result<JitteredRatioInCells, Failure> {
        JitteredRatioInCells::new(self.epsilon).map_err(|error| refuse(&format!("{key}.epsilon"), error))
    }
}

impl EstimatorKind for JitteredRatioSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let variance = "variance: closed form, integrated over the ray";
        if let Some(spec) = &self.cells {
            let estimator = self.between_cells("estimator")?;
            let cells = cells(spec, profile)?;
            let range = range(&cells);
            let trial = profile.erased_trial_in_lanes(ByCells { estimator, cells });
            return Ok(Prepared::new("jittered_ratio", trial, variance).within(Some(range)));
        }
        let majorant = self.majorant.or_else(|| profile.declared()).ok_or_else(|| {
            Failure::refused(
                "estimator: jittered_ratio needs a majorant; give `majorant`, or `cells`, or use \
                 unbiased_ray_marching, which needs none",
            )
        })?;
        let trial = profile.erased_trial_in_lanes(self.below_majorant(majorant, "estimator")?);
        Ok(Prepared::new("jittered_ratio", trial, variance).claiming(majorant).within(Some((0.0, 1.0))))
    }

    fn for_all_rays(&self, scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        if let Some(cells) = &self.cells {
            let estimator = CellEstimator::Jittered(self.between_cells(key)?);
            return in_grid::for_all_rays(estimator, cells, scene, key);
        }
        let majorant = scene.majorant(self.majorant, &format!("{key}.majorant"))?;
        self.below_majorant(majorant, key).map(Shadow::erased)
    }

    fn of_one_ray(&self) -> Option<(&'static str, String)> {
        self.cells.as_ref().and_then(in_grid::of_one_ray)
    }

    fn work(&self, ray: RayKnown) -> Work {
        if let Some(cells) = &self.cells {
            return Work::of("estimator.cells", ray.in_cells(cells, |range| strata(range, self.epsilon)));
        }
        let depth = self.majorant.map_or_else(|| ray.declared_depth(), |majorant| ray.depth(majorant));
        Work::of("estimator.majorant", Expected::Exactly(strata(depth, self.epsilon)))
    }
}

/// Expected look-ups of jittered ratio tracking below a majorant of this optical thickness: (e^h − 1)/h in each
/// stratum of thickness h ≤ ε.
pub(super) fn strata(depth: f64, epsilon: f64) -> f64 {
    let strata = (depth / epsilon).ceil().max(1.0);
    let h = depth / strata;
    if h > 0.0 { strata * h.exp_m1() / h } else { strata }
}
