//! Mistakes of estimators that walk from stratum to stratum.

use super::trial::{LAWFUL, judged, theory_on};
use super::{Evident, Twin, freeflight};
use fairflight_freeflight::{Flight, FreeFlight, JitteredFlight};
use fairflight_laws::freeflight::Weights;
use fairflight_media::{Bounded, Constant, Majorant};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{JitteredRatio, TransmittanceEstimator};

/// Jittered ratio tracking with ε = 1 that continues to the k-th point with the probability ε/(k + 1).
struct ContinuesTooRarely;

impl<F: Majorant> TransmittanceEstimator<F> for ContinuesTooRarely {
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let strata = (field.majorant() * field.length()).ceil();
        let width = field.length() / strata;
        let mut estimate = 1.0;
        for i in 0..strata as u32 {
            let (mut factor, mut term, mut order) = (1.0, -1.0, 1.0);
            loop {
                term *= width * field.sigma_t((f64::from(i) + source.next_uniform()) * width);
                factor += term;
                term = -term;
                order += 1.0;
                // right: 1/order, the order of the point to come
                if source.next_uniform() >= 1.0 / (order + 1.0) {
                    break;
                }
            }
            estimate *= factor;
        }
        estimate
    }
    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

/// The companion free flight with ε = 1 that takes an accepted candidate for a collision.
struct WithoutSurvivalTest;

impl<F: Majorant> FreeFlight<F> for WithoutSurvivalTest {
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        let strata = (field.majorant() * field.length()).ceil();
        let width = field.length() / strata;
        for i in 0..strata as u32 {
            let distance = (f64::from(i) + source.next_uniform()) * width;
            // right: and a Woodcock flight from the start of the stratum reaches it
            if source.next_uniform() < width * field.sigma_t(distance) {
                return Flight::Collided { distance, weight: 1.0 };
            }
        }
        Flight::Escaped { weight: 1.0 }
    }
    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

/// Four strata of the optical thickness 1 in the majorant and 1/2 in the field.
fn half() -> Bounded<Constant> {
    Bounded::new(Constant::new(0.5, 4.0).expect(LAWFUL), 1.0).expect(LAWFUL)
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    vec![
        // P(N ≥ k) = 2/(k + 1)! for 1/k!: a stratum has the expectation 1 − R + Σ_{k≥2} 2 (−R)^k/(k + 1)! = 2 (1 − e^−R)/R − 1 = 0.5739 for
        // 0.6065, four of them 0.1085 for 0.1353: a bias of −20 %, with Var/T² = 0.1468.
        Twin::new(
            "jittered ratio tracking",
            "jittered_ratio_continues_too_rarely",
            "the k-th point is drawn with the probability epsilon/(k + 1) for epsilon/k: the order counted from 0",
            "sigma_t 0.5, majorant 1, length 4, epsilon 1",
            (20_000, Evident::Mean { z: 73.3 }),
            |run| {
                let field = half();
                let right = theory_on(field, &JitteredRatio::new(1.0).expect(LAWFUL), &[]);
                judged(&field, &ContinuesTooRarely, right, run)
            },
        ).about(["jittered_ratio"]),
        // A stratum is passed with 1 − R for e^−R: escape has the probability 1/16 for e^−2 = 0.1353.
        Twin::new(
            "jittered free flight",
            "jittered_flight_without_survival_test",
            "a candidate accepted with h sigma_t is a collision, whatever lies before it in its stratum",
            "sigma_t 0.5, majorant 1, length 4, epsilon 1",
            (20_000, Evident::Mean { z: 30.1 }),
            |run| {
                let right = JitteredFlight::new(1.0).expect(LAWFUL);
                freeflight::judged(&half(), (&right, &[]), Weights::One, &WithoutSurvivalTest, "escaped", run)
            },
        ),
    ]
}
