//! Estimators between bounds in cells, in a scene: the cells of each ray are those of a grid that it passes.

use super::cells::CellsSpec;
use super::erased::ByCells;
use super::ray::{RayKind, Unlawful, watched};
use super::{InScene, Preparation, Shadow, refuse};
use crate::Failure;
use fairflight_media::{BoundCell, BoundGrid, Extinction, InCells, Medium, Ray, Vacuum};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{JitteredRatioInCells, ResidualCells};
use std::cell::Cell;
use std::sync::Arc;

/// An estimator between bounds in cells.
#[derive(Clone, Copy, Debug)]
pub(super) enum CellEstimator {
    Residual(ResidualCells),
    Jittered(JitteredRatioInCells),
}

/// An estimator with the grid that its cells come from.
#[derive(Clone, Debug)]
pub(super) struct InGrid {
    estimator: CellEstimator,
    grid: Arc<BoundGrid>,
}

/// The reason why a scene refuses cells along a ray.
const OF_ONE_RAY: &str = "are given along one ray, but a scene has many: a number of boxes is allowed";

/// The key that leads to cells along one ray.
pub(super) fn of_one_ray(cells: &CellsSpec) -> Option<(&'static str, String)> {
    matches!(cells, CellsSpec::Given { .. }).then(|| ("cells", OF_ONE_RAY.to_owned()))
}

/// The estimator of all rays of a scene.
pub(super) fn for_all_rays(
    estimator: CellEstimator,
    cells: &CellsSpec,
    scene: &InScene<'_>,
    key: &str,
) -> Result<Shadow, Failure> {
    let key = format!("{key}.cells");
    let CellsSpec::Count(longest) = *cells else { return Err(refuse(&key, OF_ONE_RAY)) };
    // Without a medium there is nothing to be bounded, and no ray to be estimated.
    let Some(grid) = scene.grid(longest, &key)? else { return Ok(Shadow::Regular) };
    let [x, y, z] = grid.resolution();
    let purpose = format!("bounds of the medium in {x} x {y} x {z} boxes");
    let preparation = Preparation { lookups: grid.lookups(), purpose };
    Ok(Shadow::of(RayKind::InGrid(InGrid { estimator, grid })).after(preparation))
}

impl InGrid {
    /// One estimate; `cells` is a buffer that one ray after another uses.
    #[inline]
    pub(super) fn estimate<M: Medium>(
        &self,
        ray: &Ray<&M>,
        cells: &mut Vec<BoundCell>,
        unlawful: &Cell<Option<Unlawful>>,
        source: &mut impl UniformSource,
    ) -> f64 {
        self.grid.cells_along(ray.local_line(), ray.length(), cells);
        let cells = InCells::new(Vacuum::new(ray.length()), cells.as_slice())
            .expect("a grid whose bounds are finite covers every ray");
        match self.estimator {
            CellEstimator::Residual(estimator) => {
                watched(ray, &ByCells { estimator, cells }, unlawful, source)
            }
            CellEstimator::Jittered(estimator) => {
                watched(ray, &ByCells { estimator, cells }, unlawful, source)
            }
        }
    }
}
