//! Power series in the optical thickness.

use super::{EstimatorKind, Expected, InScene, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::{Maybe, NonNegative};
use crate::{Failure, kind, words};
use fairflight_media::Extinction;
use fairflight_sources::UniformSource;
use fairflight_transmittance::{PSeries, PSeriesVersion, TransmittanceEstimator};

words! {
    /// The law of the orders of a power series.
    pub(super) PSeriesWord for PSeriesVersion {
        "cmf" => PSeriesVersion::Cmf,
        "cumulative" => PSeriesVersion::Cumulative,
        "ratio" => PSeriesVersion::Ratio,
        "next_flight" => PSeriesVersion::NextFlight,
    }
}

kind! {
    /// Power series in the optical thickness (georgiev-2019).
    PSeriesSpec = "p_series" {
        /// The law of the orders.
        version: PSeriesVersion as PSeriesWord,
        /// The optical thickness about which the series is; that of the field's majorant by default.
        pivot: Option<f64> as Maybe<NonNegative> = None,
    }
}

/// Orders are counted in 32 bits.
const MOST_ORDERS: f64 = 1e9;

/// A pivot, or a rate, up to which orders can be counted.
pub(super) fn countable(order: f64, key: &str) -> Result<f64, Failure> {
    if order.abs() > MOST_ORDERS {
        return Err(refuse(key, format!("must be at most {MOST_ORDERS:e}, found {order}")));
    }
    Ok(order)
}

impl PSeriesSpec {
    fn about(&self, pivot: f64, key: &str) -> Result<PSeries, Failure> {
        let at = format!("{key}.pivot");
        PSeries::new(self.version, countable(pivot, &at)?).map_err(|error| refuse(&at, error))
    }
}

/// The series about the optical thickness of the majorant on each ray.
#[derive(Clone, Copy, Debug)]
struct AboutMajorant {
    version: PSeriesVersion,
    majorant: f64,
}

impl<F: Extinction> TransmittanceEstimator<F> for AboutMajorant {
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        // Nothing is there to be looked up, and a pivot of 0 would admit nothing.
        if field.length() == 0.0 {
            return 1.0;
        }
        PSeries::new(self.version, self.majorant * field.length())
            .expect("a majorant is at least 0, and a ray has a length")
            .estimate(field, source)
    }

    fn admits(&self, _field: &F, _s: f64, sigma_t: f64) -> bool {
        self.version == PSeriesVersion::Cumulative || self.majorant > 0.0 || sigma_t == 0.0
    }
}

impl EstimatorKind for PSeriesSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let variance = match self.version {
            PSeriesVersion::Cumulative => "variance: no closed form, but an upper bound",
            PSeriesVersion::Cmf | PSeriesVersion::Ratio | PSeriesVersion::NextFlight => {
                "variance: closed form, integrated over the ray"
            }
        };
        let pivot = match self.pivot {
            Some(pivot) => pivot,
            None => profile.declared_depth("p_series needs a pivot; give `pivot`")?,
        };
        let trial = profile.erased_trial(self.about(pivot, "estimator")?);
        // Factors of t_c − S σ_t.
        let range = profile.field().knowledge().of_null_collisions(pivot / profile.length());
        Ok(Prepared::new("p_series", trial, variance).within(range))
    }

    fn for_all_rays(&self, scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        if let Some(pivot) = self.pivot {
            return self.about(pivot, key).map(Shadow::erased);
        }
        let majorant = scene.majorant(None, &format!("{key}.pivot"))?;
        // The pivot of no ray is greater.
        self.about(majorant * scene.longest(), key)?;
        Ok(Shadow::erased(AboutMajorant { version: self.version, majorant }))
    }

    fn work(&self, ray: RayKnown) -> Work {
        let pivot = self.pivot.unwrap_or_else(|| ray.declared_depth());
        let estimate = match self.version {
            PSeriesVersion::Ratio | PSeriesVersion::NextFlight => Expected::Exactly(pivot),
            // Up to the 99th percentile of a Poisson law for sure, and a tail about as wide as that law.
            PSeriesVersion::Cmf => Expected::Exactly(pivot + 4.0 * pivot.sqrt() + 2.0),
            // |Y| is at most y := max(t_c, X − t_c): y^k/k! falls below 1 near k = e y.
            PSeriesVersion::Cumulative => {
                Expected::Between(0.0, std::f64::consts::E * pivot.max(ray.declared_depth() - pivot) + 2.0)
            }
        };
        Work::of("estimator.pivot", estimate)
    }
}
