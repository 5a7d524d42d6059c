//! Jittered ratio tracking.

use super::cells::{cells, range};
use super::erased::{ByCells, ByMajorant};
use super::{CellsSpec, EstimatorKind, Expected, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::Object;
use crate::reader::rule::{Maybe, NonNegative, Own, Positive};
use crate::{Failure, kind};
use fairflight_transmittance::{JitteredRatio, JitteredRatioInCells};

kind! {
    /// Ratio tracking with one candidate per stratum of the majorant's optical thickness; estimates lie in [0, 1].
    JitteredRatioSpec = "jittered_ratio" {
        /// Bounds of σ_t in cells: a number of them, or edges, minorants and majorants.
        cells: Option<CellsSpec> as Maybe<Own> = None,
        /// An upper bound of σ_t \[1/length\].
        majorant: Option<f64> as Maybe<NonNegative> = None,
        /// The optical thickness of a stratum in the majorant.
        epsilon: f64 as Positive,
    }
    check JitteredRatioSpec::check
}

/// The bounds that are claimed.
enum Bounds<'a> {
    Majorant(f64),
    Cells(&'a CellsSpec),
}

impl JitteredRatioSpec {
    /// Below a majorant [1/length].
    #[must_use]
    pub fn below(majorant: f64, epsilon: f64) -> Self {
        Self { cells: None, majorant: Some(majorant), epsilon }
    }

    /// Within bounds in cells.
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
        self.bounds().map(|_| ())
    }

    fn bounds(&self) -> Result<Bounds<'_>, Failure> {
        match (&self.cells, self.majorant) {
            (Some(cells), _) => Ok(Bounds::Cells(cells)),
            (None, Some(majorant)) => Ok(Bounds::Majorant(majorant)),
            (None, None) => Err(Failure::refused(
                "estimator: jittered_ratio needs a majorant; give `majorant`, or `cells`, or use \
                 unbiased_ray_marching, which needs none",
            )),
        }
    }

    fn below_majorant(&self, majorant: f64, key: &str) -> Result<ByMajorant<JitteredRatio>, Failure> {
        let at = |what: &str| format!("{key}.{what}");
        // The claim first, as it stands first.
        let claim = ByMajorant::new((), majorant).map_err(|error| refuse(&at("majorant"), error))?;
        let estimator = JitteredRatio::new(self.epsilon).map_err(|error| refuse(&at("epsilon"), error))?;
        Ok(claim.with(estimator))
    }
}

impl EstimatorKind for JitteredRatioSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let variance = "variance: closed form, integrated over the ray";
        match self.bounds()? {
            Bounds::Majorant(majorant) => {
                let trial = profile.erased_trial(self.below_majorant(majorant, "estimator")?);
                Ok(Prepared::new("jittered_ratio", trial, variance)
                    .claiming(majorant)
                    .within(Some((0.0, 1.0))))
            }
            Bounds::Cells(spec) => {
                let estimator = JitteredRatioInCells::new(self.epsilon)
                    .map_err(|error| refuse("estimator.epsilon", error))?;
                let cells = cells(spec, profile)?;
                let range = range(&cells);
                let trial = profile.erased_trial(ByCells { estimator, cells });
                Ok(Prepared::new("jittered_ratio", trial, variance).within(Some(range)))
            }
        }
    }

    fn for_all_rays(&self, key: &str) -> Result<Shadow, Failure> {
        match self.bounds()? {
            Bounds::Majorant(majorant) => self.below_majorant(majorant, key).map(Shadow::erased),
            Bounds::Cells(_) => Err(refuse("cells", "are given along one ray, but a scene has many")),
        }
    }

    fn of_one_ray(&self) -> Option<(&'static str, String)> {
        self.cells.as_ref().map(|_| ("kind", CELLS_OF_ONE_RAY.to_owned()))
    }

    fn work(&self, ray: RayKnown) -> Work {
        match self.bounds() {
            Ok(Bounds::Cells(cells)) => {
                Work::of("estimator.cells", ray.in_cells(cells, |range| strata(range, self.epsilon)))
            }
            Ok(Bounds::Majorant(majorant)) => {
                Work::of("estimator.majorant", Expected::Exactly(strata(ray.depth(majorant), self.epsilon)))
            }
            Err(_) => Work::of("estimator.majorant", Expected::Exactly(0.0)),
        }
    }
}

/// The reason why a scene refuses cells along a ray.
pub(super) const CELLS_OF_ONE_RAY: &str =
    "cells are given along one ray, but a scene has many: use jittered_ratio with a majorant";

/// Expected look-ups of jittered ratio tracking below a majorant of this optical thickness: (e^h − 1)/h in each
/// stratum of thickness h ≤ ε.
pub(super) fn strata(depth: f64, epsilon: f64) -> f64 {
    let strata = (depth / epsilon).ceil().max(1.0);
    let h = depth / strata;
    if h > 0.0 { strata * h.exp_m1() / h } else { strata }
}
