//! Ray marching in lanes: the twin of `RayMarching::estimate`.

use super::{Batches, Lockstep};
use crate::{Offset, RayMarching};
use fairflight_elementary::lanes::{LANES, exp};
use fairflight_media::Extinction;
use fairflight_sources::SeededLanes;

impl<F: Extinction> Lockstep<F> for RayMarching {
    #[inline(always)]
    fn fill(&self, field: &F, source: &mut SeededLanes, batches: &mut Batches<'_, '_>) {
        let step = field.length() / f64::from(self.steps);
        while batches.are_open() {
            let offsets = match self.offset {
                Offset::Fixed => [0.5; LANES],
                Offset::Jittered => source.next_uniforms(),
            };
            let (mut sum, mut s) = ([0.0; LANES], [0.0; LANES]);
            for k in 0..self.steps {
                for i in 0..LANES {
                    s[i] = (f64::from(k) + offsets[i]) * step;
                }
                let sigma_t = field.sigma_t_lanes(&s);
                for i in 0..LANES {
                    sum[i] += sigma_t[i];
                }
            }
            for sum in &mut sum {
                *sum = -(*sum * step);
            }
            for (lane, estimate) in exp(&sum).into_iter().enumerate() {
                batches.take(lane, estimate, u64::from(self.steps));
            }
        }
    }
}
