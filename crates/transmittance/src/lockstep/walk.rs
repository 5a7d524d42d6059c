//! Walks from collision to collision, in lanes.

use super::Batches;
use super::products::Products;
use crate::SignedProduct;
use fairflight_elementary::lanes::{LANES, Lanes, Mask, lanes_of, mask, select, some};
use fairflight_media::Extinction;
use fairflight_sources::SeededLanes;

/// An estimator that follows one particle and multiplies its weight at collisions.
pub(super) trait Walk<F: Extinction> {
    /// True if a collision draws a variate.
    const DRAWS: bool;

    /// The distances of the next collisions, behind flights of these optical lengths from `s`; ∞ where the profile ends before.
    fn fly(&self, field: &F, s: &Lanes, depths: &Lanes) -> Lanes;

    /// The factors of the weights at collisions, by a variate each, and the lanes whose walk ends there with the estimate 0.
    fn collide(&self, field: &F, s: &Lanes, sigma_t: &Lanes, variates: &Lanes) -> (Lanes, Mask);

    /// The estimate of a walk that leaves the profile with this weight.
    fn leave(&self, weight: &SignedProduct) -> f64;
}

/// Fills `batches`: where a walk ends the next one of its lane begins, in the same step as the others go on.
#[inline(always)]
pub(super) fn fill<F: Extinction, W: Walk<F>>(
    walk: &W,
    field: &F,
    source: &mut SeededLanes,
    batches: &mut Batches<'_, '_>,
) {
    let (mut s, mut weights) = ([0.0; LANES], Products::ONE);
    // A lane looks up once in each step, but for that in which it leaves: the step in which its walk began tells how often.
    let (mut step, mut began) = (0_u64, [0; LANES]);
    while batches.are_open() {
        let to = walk.fly(field, &s, &source.next_exponentials());
        let mut inside = [0; LANES];
        for i in 0..LANES {
            inside[i] = mask(to[i] < f64::INFINITY);
            // Outside nothing is met; what is looked up there is not used.
            s[i] = select(inside[i], to[i], 0.0);
        }
        let sigma_t = field.sigma_t_lanes(&s);
        let variates = if W::DRAWS { source.next_uniforms_of(&inside) } else { [0.0; LANES] };
        let (mut factors, mut ended) = walk.collide(field, &s, &sigma_t, &variates);
        for i in 0..LANES {
            ended[i] |= !inside[i];
            factors[i] = select(ended[i], 1.0, factors[i]);
            s[i] = select(ended[i], 0.0, s[i]);
        }
        weights.multiply(&factors);
        step += 1;
        if some(&ended) {
            for lane in lanes_of(&ended) {
                let left = inside[lane] == 0;
                let estimate = if left { walk.leave(&weights.get(lane)) } else { 0.0 };
                batches.take(lane, estimate, step - began[lane] - u64::from(left));
                began[lane] = step;
            }
            weights.restart(&ended);
        }
    }
}
