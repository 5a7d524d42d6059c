//! Tracking with the double particle model, in lanes: the twin of `Tracking::estimate`.

use super::Lockstep;
use super::products::Products;
use crate::{Tracking, TransmittanceEstimator};
use fairflight_collision::DoubleParticle;
use fairflight_elementary::lanes::{LANES, Lanes};
use fairflight_media::{Extinction, InvertOpticalThickness, OpticalThickness};
use fairflight_sources::SeededLanes;

impl<F: Extinction, C: OpticalThickness, R: InvertOpticalThickness> Lockstep<F>
    for Tracking<DoubleParticle, C, R>
{
    #[inline(always)]
    fn fill(&self, field: &F, source: &mut SeededLanes, estimates: &mut [&mut [f64]; LANES]) -> [u64; LANES] {
        let mut walking = estimates.iter().filter(|estimates| !estimates.is_empty()).count();
        let (mut s, mut next) = ([0.0; LANES], [0; LANES]);
        let (mut looked_up, mut lookups) = ([0; LANES], [0; LANES]);
        let mut weights = Products::ONE;
        while walking > 0 {
            let to = self.sampling().invert_lanes(&s, &source.next_exponentials());
            let mut some_end = false;
            for i in 0..LANES {
                let ends = to[i] == f64::INFINITY;
                some_end |= ends;
                looked_up[i] += u64::from(!ends);
                // Where a walk ends, the next one of its lane begins; what is looked up there is not used.
                s[i] = if ends { 0.0 } else { to[i] };
            }
            let sigma_t = field.sigma_t_lanes(&s);
            let ratios = self.ratios(&s, &sigma_t);
            let mut factors = [1.0; LANES];
            for i in 0..LANES {
                factors[i] = if to[i] == f64::INFINITY { 1.0 } else { 1.0 - ratios[i] };
            }
            weights.multiply(&factors);
            if some_end {
                for lane in 0..LANES {
                    if to[lane] == f64::INFINITY && next[lane] < estimates[lane].len() {
                        estimates[lane][next[lane]] = self.behind_control(&weights.take(lane));
                        next[lane] += 1;
                        if next[lane] == estimates[lane].len() {
                            lookups[lane] = looked_up[lane];
                            walking -= 1;
                        }
                    }
                }
            }
        }
        lookups
    }

    #[inline(always)]
    fn admits_lanes(&self, field: &F, s: &Lanes, sigma_t: &Lanes) -> bool {
        // A finite ratio is lawful for this model, whatever rounding.
        let all_finite = self.ratios(s, sigma_t).iter().fold(true, |all, ratio| all & ratio.is_finite());
        all_finite || (0..LANES).all(|lane| self.admits(field, s[lane], sigma_t[lane]))
    }
}

impl<C: OpticalThickness, R: InvertOpticalThickness> Tracking<DoubleParticle, C, R> {
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
