//! Forecast of the variance and the cost of an estimator on a ray, before it is run.

use crate::comparison::TestRay;
use crate::estimator::{
    ControlSpec, DoubleParticleSpec, EstimatorSpec, JitteredRatioSpec, RouletteSpec, SamplingSpec,
    UnbiasedRayMarchingSpec, WoodcockSpec,
};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::{
    Comb, CombShape, Forecast, Pilot, Roulette, UnbiasedRayMarching, predicted_relative_variance, teeth_for,
};

/// Facts about a ray that forecasts are made of.
pub(super) struct Signs {
    /// ∫ σ_t over the ray.
    thickness: f64,
    /// ∫ σ_t², from random points.
    square: f64,
    length: f64,
    majorant: f64,
    pilot: Pilot,
}

/// Points from which the mean square of σ_t is found.
const POINTS: u32 = 256;

impl Signs {
    pub(super) fn of(ray: &TestRay, pilot: Pilot, seed: u64) -> Self {
        let (field, mut source) = (ray.profile.field(), Seeded::new(seed));
        let step = field.length() / f64::from(POINTS);
        let square = (0..POINTS)
            .map(|i| field.sigma_t((f64::from(i) + source.next_uniform()) * step).powi(2) * step)
            .sum();
        Self {
            thickness: ray.truth.optical_thickness,
            square,
            length: ray.profile.length(),
            majorant: ray.majorant,
            pilot,
        }
    }

    /// Var/T² and look-ups of an estimator; `None` where nothing but a trial tells.
    pub(super) fn forecast(&self, spec: &EstimatorSpec) -> Option<Forecast> {
        match spec {
            EstimatorSpec::DoubleParticle(DoubleParticleSpec {
                sigma_samp: SamplingSpec::Constant(sigma_samp),
                control,
            }) => {
                let control = match control {
                    ControlSpec::None(_) => 0.0,
                    ControlSpec::Constant(constant) => constant.sigma_main,
                    _ => return None,
                };
                // szirmay-kalos-2017 eq. 16: ∫ (σ_t − σ_main)²/σ_samp.
                let difference =
                    self.square - 2.0 * control * self.thickness + control * control * self.length;
                let relative_variance = (difference.max(0.0) / sigma_samp).exp_m1();
                Some(Forecast { relative_variance, lookups: sigma_samp * self.length })
            }
            // A coin; the flight ends at its first collision, on an even ray.
            EstimatorSpec::Woodcock(WoodcockSpec { majorant }) => Some(Forecast {
                relative_variance: self.thickness.exp_m1(),
                lookups: majorant * self.length * -(-self.thickness).exp_m1() / self.thickness,
            }),
            EstimatorSpec::UnbiasedRayMarching(spec) => self.marching(spec),
            EstimatorSpec::JitteredRatio(JitteredRatioSpec { majorant: Some(_), epsilon, .. }) => {
                let index = [1.0, 0.5, 0.25, 0.125].iter().position(|known| known == epsilon)?;
                let strata = (self.majorant * self.length / epsilon).ceil().max(1.0);
                let thickness = self.majorant * self.length / strata;
                Some(Forecast {
                    relative_variance: self.pilot.jittered[index],
                    lookups: strata * thickness.exp_m1() / thickness,
                })
            }
            _ => None,
        }
    }

    fn marching(&self, spec: &UnbiasedRayMarchingSpec) -> Option<Forecast> {
        let (rule, segments) = (teeth_for(self.majorant * self.length), spec.segments);
        let (teeth, shape) = (spec.teeth(self.majorant * self.length), spec.shape());
        let k2 = match shape {
            CombShape::Uniform if segments == rule && teeth == 1 => self.pilot.apart[0],
            CombShape::Uniform if segments == 1 && teeth == rule => self.pilot.whole[0],
            CombShape::EndpointMatched if segments == 1 && teeth == rule => self.pilot.matched[0],
            _ => return None,
        };
        let RouletteSpec::Stop(stop) = spec.roulette else { return None };
        let roulette = Roulette::new(stop).ok()?;
        // Beyond, the second-order law of a comb says nothing.
        if k2 / f64::from(segments) > 1.0 {
            return None;
        }
        let estimator =
            UnbiasedRayMarching::new(Comb::new(teeth, shape).ok()?, roulette).in_segments(segments).ok()?;
        Some(Forecast {
            relative_variance: predicted_relative_variance(k2, roulette, segments),
            lookups: estimator.expected_lookups(),
        })
    }
}
