//! Woodcock tracking in lanes: the twin of `Woodcock::estimate`.

use super::walk::{self, Walk};
use super::{Batches, Lockstep};
use crate::{SignedProduct, Woodcock};
use fairflight_elementary::lanes::{LANES, Lanes, Mask, mask};
use fairflight_media::Majorant;
use fairflight_sources::SeededLanes;

impl<F: Majorant> Walk<F> for Woodcock {
    const DRAWS: bool = true;

    #[inline(always)]
    fn fly(&self, field: &F, s: &Lanes, depths: &Lanes) -> Lanes {
        let (mean_free_path, length) = (1.0 / field.majorant(), field.length());
        let mut to = [0.0; LANES];
        for i in 0..LANES {
            let distance = s[i] + depths[i] * mean_free_path;
            to[i] = if distance < length { distance } else { f64::INFINITY };
        }
        to
    }

    #[inline(always)]
    fn collide(&self, field: &F, _s: &Lanes, sigma_t: &Lanes, variates: &Lanes) -> (Lanes, Mask) {
        let majorant = field.majorant();
        let mut ended = [0; LANES];
        for i in 0..LANES {
            ended[i] = mask(variates[i] * majorant < sigma_t[i]);
        }
        ([1.0; LANES], ended)
    }

    #[inline(always)]
    fn leave(&self, _weight: &SignedProduct) -> f64 {
        1.0
    }
}

impl<F: Majorant> Lockstep<F> for Woodcock {
    #[inline(always)]
    fn fill(&self, field: &F, source: &mut SeededLanes, batches: &mut Batches<'_, '_>) {
        walk::fill(self, field, source, batches);
    }
}
