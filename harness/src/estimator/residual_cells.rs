//! Residual ratio tracking between a minorant and a majorant in cells.

use super::cells::{cells, range};
use super::erased::ByCells;
use super::in_grid::{self, CellEstimator};
use super::{CellsSpec, EstimatorKind, InScene, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::{Own, Positive};
use crate::{Failure, kind};
use fairflight_transmittance::ResidualCells;

kind! {
    /// Residual ratio tracking between bounds in cells.
    ResidualCellsSpec = "residual_cells" {
        /// Bounds of σ_t in cells: a number of them, in a scene of boxes along the longest edge of the medium; or edges, minorants and majorants.
        cells: CellsSpec as Own,
        /// The sampling extinction over the difference of the bounds.
        rate: f64 as Positive = 1.0,
    }
}

impl ResidualCellsSpec {
    fn estimator(&self, key: &str) -> Result<ResidualCells, Failure> {
        ResidualCells::new(self.rate).map_err(|error| refuse(&format!("{key}.rate"), error))
    }
}

impl EstimatorKind for ResidualCellsSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let estimator = self.estimator("estimator")?;
        let cells = cells(&self.cells, profile)?;
        let range = (self.rate >= 1.0).then(|| range(&cells));
        let trial = profile.erased_trial(ByCells { estimator, cells });
        Ok(Prepared::new("residual_cells", trial, "variance: closed form, integrated over the ray")
            .within(range))
    }

    fn for_all_rays(&self, scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        let estimator = CellEstimator::Residual(self.estimator(key)?);
        in_grid::for_all_rays(estimator, &self.cells, scene, key)
    }

    fn of_one_ray(&self) -> Option<(&'static str, String)> {
        in_grid::of_one_ray(&self.cells)
    }

    fn work(&self, ray: RayKnown) -> Work {
        Work::of("estimator.cells", ray.in_cells(&self.cells, |range| (self.rate * range).max(1.0)))
    }
}
