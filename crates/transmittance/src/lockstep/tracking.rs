//! Tracking with the double particle model, in lanes: the twin of `Tracking::estimate`.

use super::Lockstep;
use super::products::Products;
use crate::Tracking;
use fairflight_collision::DoubleParticle;
use fairflight_elementary::lanes::LANES;
use fairflight_media::{Extinction, InvertOpticalThickness, OpticalThickness};
use fairflight_sources::SeededLanes;

impl<F: Extinction, C: OpticalThickness, R: InvertOpticalThickness> Lockstep<F>
    for Tracking<DoubleParticle, C, R>
{
    #[inline(always)]
    fn fill(&self, field: &F, source: &mut SeededLanes, estimates: &mut [&mut [f64]; LANES]) {
        let mut walking = estimates.iter().filter(|estimates| !estimates.is_empty()).count();
        let (mut s, mut next) = ([0.0; LANES], [0; LANES]);
        let mut weights = Products::ONE;
        while walking > 0 {
            let to = self.sampling().invert_lanes(&s, &source.next_exponentials());
            // Where a walk ends, anything may be looked up.
            let mut at = to;
            let mut some_end = false;
            for at in &mut at {
                let ends = *at == f64::INFINITY;
                some_end |= ends;
                *at = if ends { 0.0 } else { *at };
            }
            let sigma_t = field.sigma_t_lanes(&at);
            let (main, sampling) = (self.control().sigma_t_lanes(&at), self.sampling().sigma_t_lanes(&at));
            let mut factors = [1.0; LANES];
            for i in 0..LANES {
                let ratio = (sigma_t[i] - main[i]) / sampling[i];
                factors[i] = if to[i] == f64::INFINITY { 1.0 } else { 1.0 - ratio };
            }
            weights.multiply(&factors);
            s = at;
            if some_end {
                for lane in 0..LANES {
                    if to[lane] == f64::INFINITY && next[lane] < estimates[lane].len() {
                        estimates[lane][next[lane]] = self.behind_control(&weights.take(lane));
                        next[lane] += 1;
                        walking -= usize::from(next[lane] == estimates[lane].len());
                    }
                }
            }
        }
    }
}
