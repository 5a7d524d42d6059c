//! A mistake of the free flight that walks from stratum to stratum.

use super::trial::{LAWFUL, Wrong};
use super::{Evident, Twin, freeflight};
use crate::profiles::constant;
use fairflight_freeflight::{Flight, JitteredFlight};
use fairflight_laws::freeflight::Weights;
use fairflight_media::{Bounded, Constant, Majorant};
use fairflight_sources::UniformSource;

/// The companion free flight with ε = 1 that takes an accepted candidate for a collision.
struct WithoutSurvivalTest;

impl<F: Majorant> Wrong<F, Flight> for WithoutSurvivalTest {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> Flight {
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
}

/// Four strata of the optical thickness 1 in the majorant and 1/2 in the field.
fn half() -> Bounded<Constant> {
    Bounded::new(constant(0.5, 4.0), 1.0).expect(LAWFUL)
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    vec![
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
        )
        .answers(|vector, source| {
            let field = vector.of("jittered_flight").filter(|_| vector.sampler("epsilon") == Some(1.0))?;
            vector.flown(WithoutSurvivalTest.draw(field, source))
        }),
    ]
}
