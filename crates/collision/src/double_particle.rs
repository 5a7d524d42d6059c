//! The double particle model: both particles leave every collision (szirmay-kalos-2017 eq. 8, 10 and 11).

use crate::{Albedo, Branch, CollisionModel};

/// Scattered energy a·r, transmitted energy 1 − r, both always: the Rao–Blackwellised Woodcock model.
///
/// Holds for any r. Above 1 the sampling extinction lies below the extinction and the transmitted energy is negative
/// (section 3.2); below 0 the difference extinction is negative and the energy grows (section 3.3). Without control and
/// with a majorant this is ratio tracking, with a control residual ratio tracking (novak-2014).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleParticle {
    /// σ_s / σ_t of matter. Transmittance does not depend on it.
    pub albedo: Albedo,
}

impl CollisionModel for DoubleParticle {
    const DRAWS: bool = false;

    #[inline]
    fn admits(&self, r: f64) -> bool {
        r.is_finite()
    }

    fn scattered(&self, r: f64) -> Branch {
        let energy = self.albedo.get() * r;
        Branch { probability: 1.0, energy, absence: 0.0, excess: energy - 1.0 }
    }

    #[inline]
    fn transmitted(&self, r: f64) -> Branch {
        Branch { probability: 1.0, energy: 1.0 - r, absence: 0.0, excess: -r }
    }

    #[inline]
    fn transmit_by(&self, r: f64, _u: f64) -> Option<f64> {
        Some(1.0 - r)
    }
}
