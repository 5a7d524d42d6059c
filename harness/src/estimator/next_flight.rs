//! Next-flight estimators, and their combination with ratio tracking.

use super::erased::ByMajorant;
use super::{EstimatorKind, Expected, InScene, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::NonNegative;
use crate::{Failure, kind, words};
use fairflight_transmittance::{Bidirectional, NextFlight, NextFlightVersion, Unidirectional};

/// One of the next-flight estimators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NextFlightKind {
    /// Flights end at collisions with matter.
    Delta,
    /// Flights are weighted.
    Ratio,
    /// Combination with ratio tracking, by the balance heuristic.
    Unidirectional,
    /// Combination with ratio tracking, from both ends.
    Bidirectional,
}

words! {
    /// The names of the next-flight estimators.
    pub(super) NextFlightWord for NextFlightKind {
        "delta" => NextFlightKind::Delta,
        "ratio" => NextFlightKind::Ratio,
        "unidirectional" => NextFlightKind::Unidirectional,
        "bidirectional" => NextFlightKind::Bidirectional,
    }
}

kind! {
    /// Sums of free flights to the far end (georgiev-2019).
    NextFlightSpec = "next_flight" {
        /// An upper bound of σ_t \[1/length\].
        majorant: f64 as NonNegative,
        /// The estimator.
        version: NextFlightKind as NextFlightWord,
    }
}

/// `$body` with `$estimator` for the estimator of a version: each is a type of its own.
macro_rules! of_version {
    ($version:expr, $estimator:ident => $body:expr) => {
        match $version {
            NextFlightKind::Delta => {
                let $estimator = NextFlight::new(NextFlightVersion::Delta);
                $body
            }
            NextFlightKind::Ratio => {
                let $estimator = NextFlight::new(NextFlightVersion::Ratio);
                $body
            }
            NextFlightKind::Unidirectional => {
                let $estimator = Unidirectional;
                $body
            }
            NextFlightKind::Bidirectional => {
                let $estimator = Bidirectional;
                $body
            }
        }
    };
}

impl NextFlightSpec {
    fn claim(&self, key: &str) -> Result<ByMajorant<()>, Failure> {
        ByMajorant::new((), self.majorant).map_err(|error| refuse(&format!("{key}.majorant"), error))
    }
}

impl EstimatorKind for NextFlightSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let claim = self.claim("estimator")?;
        let trial = of_version!(self.version, estimator => profile.erased_trial(claim.with(estimator)));
        let variance = match self.version {
            NextFlightKind::Bidirectional => "variance: no closed form",
            _ => "variance: closed form, integrated over the ray",
        };
        let range = profile.field().knowledge().of_null_collisions(self.majorant);
        Ok(Prepared::new("next_flight", trial, variance).claiming(self.majorant).within(range))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        let claim = self.claim(key)?;
        Ok(of_version!(self.version, estimator => Shadow::erased(claim.with(estimator))))
    }

    fn work(&self, ray: RayKnown) -> Work {
        let depth = ray.depth(self.majorant);
        Work::of(
            "estimator.majorant",
            match self.version {
                NextFlightKind::Delta => Expected::Between(0.0, depth),
                NextFlightKind::Ratio | NextFlightKind::Unidirectional => Expected::Exactly(depth),
                // Two walks, and about depth²/2 pairs of their points that are connected.
                NextFlightKind::Bidirectional => Expected::Exactly(2.0 * depth + 0.5 * depth * depth),
            },
        )
    }
}
