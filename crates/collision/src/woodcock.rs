//! Woodcock's model: virtual particles raise the extinction to a majorant (szirmay-kalos-2017 3.1, eq. 7).

use crate::{Albedo, Branch, CollisionModel, Outcome, SingleOutcome};
use fairflight_sources::UniformSource;

/// A collision is with matter with probability r, else with a virtual particle that changes nothing.
///
/// Woodcock, Murphy, Hemmings & Longworth 1965; raab-2008 algorithm 1. Admits 0 ≤ r ≤ 1: σ_samp is a majorant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Woodcock {
    /// σ_s / σ_t of matter.
    pub albedo: Albedo,
}

impl CollisionModel for Woodcock {
    #[inline]
    fn admits(&self, r: f64) -> bool {
        (0.0..=1.0).contains(&r)
    }

    fn scattered(&self, r: f64) -> Branch {
        let probability = self.albedo.get() * r;
        Branch { probability, energy: 1.0, absence: 1.0 - probability, excess: 0.0 }
    }

    fn transmitted(&self, r: f64) -> Branch {
        Branch { probability: 1.0 - r, energy: 1.0, absence: r, excess: 0.0 }
    }

    /// Strictly `u < r`: where r = 0 no variate collides, where r = 1 every one does. (raab-2008 algorithm 1 as printed
    /// can collide where there is no matter.)
    #[inline]
    fn transmit_by(&self, r: f64, u: f64) -> Option<f64> {
        if u < r { None } else { Some(1.0) }
    }
}

impl SingleOutcome for Woodcock {
    #[inline]
    fn collide(&self, r: f64, source: &mut impl UniformSource) -> Outcome {
        let u = source.next_uniform();
        if u < self.albedo.get() * r {
            Outcome::Scattered(1.0)
        } else if u < r {
            Outcome::Absorbed
        } else {
            Outcome::Transmitted(1.0)
        }
    }
}
