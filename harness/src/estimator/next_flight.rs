//! Next-flight estimators, and their combination with ratio tracking.

use super::erased::ByMajorant;
use super::{EstimatorKind, Expected, Prepared, RayKnown, Shadow, Work, refuse};
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
    /// With ratio tracking, by the balance heuristic.
    Unidirectional,
    /// With ratio tracking, from both ends.
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

const QUADRATURE: &str = "variance: closed form, integrated over the ray";

impl EstimatorKind for NextFlightSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let error = |error| refuse("estimator.majorant", error);
        macro_rules! behind_a_pointer {
            ($estimator:expr) => {
                profile.erased_trial(ByMajorant::new($estimator, self.majorant).map_err(error)?)
            };
        }
        let (trial, variance) = match self.version {
            NextFlightKind::Delta => {
                (behind_a_pointer!(NextFlight::new(NextFlightVersion::Delta)), QUADRATURE)
            }
            NextFlightKind::Ratio => {
                (behind_a_pointer!(NextFlight::new(NextFlightVersion::Ratio)), QUADRATURE)
            }
            NextFlightKind::Unidirectional => (behind_a_pointer!(Unidirectional), QUADRATURE),
            NextFlightKind::Bidirectional => (behind_a_pointer!(Bidirectional), "variance: no closed form"),
        };
        let range = profile.field().knowledge().of_null_collisions(self.majorant);
        Ok(Prepared::new("next_flight", trial, variance).claiming(self.majorant).within(range))
    }

    fn for_all_rays(&self, key: &str) -> Result<Shadow, Failure> {
        let error = |error| refuse(&format!("{key}.majorant"), error);
        Ok(match self.version {
            NextFlightKind::Delta => Shadow::erased(
                ByMajorant::new(NextFlight::new(NextFlightVersion::Delta), self.majorant).map_err(error)?,
            ),
            NextFlightKind::Ratio => Shadow::erased(
                ByMajorant::new(NextFlight::new(NextFlightVersion::Ratio), self.majorant).map_err(error)?,
            ),
            NextFlightKind::Unidirectional => {
                Shadow::erased(ByMajorant::new(Unidirectional, self.majorant).map_err(error)?)
            }
            NextFlightKind::Bidirectional => {
                Shadow::erased(ByMajorant::new(Bidirectional, self.majorant).map_err(error)?)
            }
        })
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
