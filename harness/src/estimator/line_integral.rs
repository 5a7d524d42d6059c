//! Flights that share one depth.

use super::erased::ByMajorant;
use super::range::below_zero;
use super::ray::RayKind;
use super::{EstimatorKind, Expected, InScene, MOST_POINTS, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::{NonNegative, Whole};
use crate::{Failure, kind};
use fairflight_laws::scores;
use fairflight_transmittance::LineIntegral;

kind! {
    /// The share of escaped flights whose first steps are stratified (raab-2008 algorithm 2).
    LineIntegralSpec = "line_integral" {
        /// An upper bound of σ_t \[1/length\].
        majorant: f64 as NonNegative,
        /// Flights per estimate.
        splits: u32 as Whole<1, MOST_POINTS>,
    }
}

impl LineIntegralSpec {
    fn estimator(&self, key: &str) -> Result<ByMajorant<LineIntegral>, Failure> {
        let at = |what: &str| format!("{key}.{what}");
        let estimator = LineIntegral::new(self.splits).map_err(|error| refuse(&at("splits"), error))?;
        ByMajorant::new(estimator, self.majorant).map_err(|error| refuse(&at("majorant"), error))
    }
}

impl EstimatorKind for LineIntegralSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let trial = profile.trial(self.estimator("estimator")?);
        let depth = self.majorant * profile.length();
        Ok(Prepared::new("line_integral", trial, "variance: quadrature over the shared shift")
            .scoring(move |unit| scores::line_integral(depth, unit))
            .objecting(below_zero)
            .claiming(self.majorant))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        self.estimator(key).map(RayKind::LineIntegral).map(Shadow::of)
    }

    fn work(&self, ray: RayKnown) -> Work {
        // The first step of every flight ends on the ray, unless nothing is there to collide with.
        let (splits, flight) = (f64::from(self.splits), ray.depth(self.majorant));
        let least = if flight > 0.0 { splits } else { 0.0 };
        Work::of("estimator.splits", Expected::Between(least, splits * flight.max(1.0)))
    }
}
