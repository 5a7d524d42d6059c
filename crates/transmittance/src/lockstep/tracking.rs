//! Tracking in lanes, with any model: the twin of `Tracking::estimate`.

use super::walk::{self, Walk};
use super::{Batches, Lockstep};
use crate::{SignedProduct, Tracking, TransmittanceEstimator};
use fairflight_collision::CollisionModel;
use fairflight_elementary::lanes::{LANES, Lanes, Mask, mask};
use fairflight_media::{Extinction, InvertOpticalThickness, OpticalThickness};
use fairflight_sources::SeededLanes;

impl<F: Extinction, M: CollisionModel, C: OpticalThickness, R: InvertOpticalThickness> Walk<F>
    for Tracking<M, C, R>
{
    const DRAWS: bool = M::DRAWS;

    #[inline(always)]
    fn fly(&self, _field: &F, s: &Lanes, depths: &Lanes) -> Lanes {
        self.sampling().invert_lanes(s, depths)
    }

    #[inline(always)]
    fn collide(&self, _field: &F, s: &Lanes, sigma_t: &Lanes, variates: &Lanes) -> (Lanes, Mask) {
        let ratios = self.ratios(s, sigma_t);
        let (mut factors, mut ended) = ([0.0; LANES], [0; LANES]);
        for i in 0..LANES {
            let transmitted = self.model().transmit_by(ratios[i], variates[i]);
            (factors[i], ended[i]) = (transmitted.unwrap_or(0.0), mask(transmitted.is_none()));
        }
        (factors, ended)
    }

    #[inline(always)]
    fn leave(&self, weight: &SignedProduct) -> f64 {
        self.behind_control(weight)
    }
}

impl<F: Extinction, M: CollisionModel, C: OpticalThickness, R: InvertOpticalThickness> Lockstep<F>
    for Tracking<M, C, R>
{
    #[inline(always)]
    fn fill(&self, field: &F, source: &mut SeededLanes, batches: &mut Batches<'_, '_>) {
        walk::fill(self, field, source, batches);
    }

    #[inline(always)]
    fn admits_lanes(&self, field: &F, s: &Lanes, sigma_t: &Lanes) -> bool {
        // A ratio that the model admits is lawful whatever rounding; that is finite, so that σ_samp is not 0.
        let ratios = self.ratios(s, sigma_t);
        let all = ratios.iter().fold(true, |all, &ratio| all & self.model().admits(ratio));
        all || (0..LANES).all(|lane| self.admits(field, s[lane], sigma_t[lane]))
    }
}

impl<M: CollisionModel, C: OpticalThickness, R: InvertOpticalThickness> Tracking<M, C, R> {
    /// r = σ_diff/σ_samp in each lane; not finite where σ_samp is 0.
    #[inline(always)]
    fn ratios(&self, s: &Lanes, sigma_t: &Lanes) -> Lanes {
        let (main, sampling) = (self.control().sigma_t_lanes(s), self.sampling().sigma_t_lanes(s));
        let mut ratios = [0.0; LANES];
        for i in 0..LANES {
            ratios[i] = (sigma_t[i] - main[i]) / sampling[i];
        }
        ratios
    }
}
