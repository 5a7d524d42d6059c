//! Mistakes with quasi-random points.

use super::{Evident, Rejection, Twin};
use crate::profiles::constant;
use fairflight_freeflight::{Flight, FreeFlight, Inversion};
use fairflight_laws::{Run, measure};
use fairflight_sources::UniformSource;
use fairflight_stats::{Reference, Scores, judge};

/// Points of the one set that all estimates are drawn from.
const POINTS: u32 = 8;

/// A point of Halton's sequence as it stands: neither scrambled nor rotated, the same for every seed.
struct Unscrambled {
    index: u32,
}

impl UniformSource for Unscrambled {
    fn next_uniform(&mut self) -> f64 {
        // right: a random number, equal for all points of a replica, is combined with this
        f64::from(self.index.reverse_bits()) / (f64::from(u32::MAX) + 1.0)
    }
}

fn judged(run: Run) -> Rejection {
    let field = constant(1.0, 1.0);
    let exact = Reference { scores: Scores::TwoValued { high: 1.0 }, ..Reference::exact((-1.0_f64).exp()) };
    let mut index = 0;
    let moments = measure(run.seed, run.samples, |_| {
        let flight = Inversion.sample(&field, &mut Unscrambled { index });
        index = (index + 1) % POINTS;
        f64::from(u8::from(matches!(flight, Flight::Escaped { .. })))
    });
    match moments {
        Ok(moments) => Rejection::of_mean(judge(&moments, &exact, run.alpha)),
        Err(error) => Rejection::exact(false, error.to_string()),
    }
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    // A flight escapes for u ≥ 1 − e^−1 = 0.632: 6/8 and 7/8 of the eight points, 1/4 for e^−1 = 0.3679. As independent
    // estimates they would have the variance e^−1 (1 − e^−1).
    vec![Twin::new(
        "free flight by inversion, halton points",
        "unscrambled_points_taken_for_independent",
        "the same eight points for every replica, without scrambling or rotation, judged as independent estimates",
        "sigma_t 1, length 1; eight points of base 2",
        (16_384, Evident::Mean { z: 31.3 }),
        judged,
    )]
}
