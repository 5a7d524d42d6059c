//! Estimators made of combs in lanes: the twins of those in `combs`. A step is a whole comb in each lane, at the same tooth in all.

use super::{Batches, Lockstep};
use crate::combs::{difference, of_draws};
use crate::{Comb, CombShape, Jackknife, Prepared, SignedProduct, Telescoping, UnbiasedRayMarching};
use fairflight_elementary::lanes::{LANES, Lanes};
use fairflight_elementary::{cos, exp};
use fairflight_media::Extinction;
use fairflight_sources::{SeededLanes, UniformSource};
use smallvec::{SmallVec, smallvec};

/// An estimator that draws combs one after the other.
trait OfCombs {
    /// Knowledge of an estimate between two combs.
    type State;

    /// The comb, on each of the segments.
    fn comb(&self) -> Comb;

    /// The number of segments.
    fn segments(&self) -> u32 {
        1
    }

    /// Begins an estimate.
    fn begin(&self, source: &mut impl UniformSource) -> Self::State;

    /// The segment of the next comb, from 0 on.
    fn segment(&self, _state: &Self::State) -> usize {
        0
    }

    /// The variate of the next comb.
    fn shift(&self, _state: &Self::State, source: &mut impl UniformSource) -> f64 {
        source.next_uniform()
    }

    /// Takes the thickness of that comb; the estimate, where it is the last.
    fn receive(&self, state: &mut Self::State, x: f64, source: &mut impl UniformSource) -> Option<f64>;
}

#[inline(always)]
fn fill<F: Extinction, E: OfCombs>(
    estimator: &E,
    field: &F,
    source: &mut SeededLanes,
    batches: &mut Batches<'_, '_>,
) {
    let (comb, segments) = (estimator.comb(), estimator.segments());
    // What depends on no variate is the same for all estimates. Each counts it, as if it were alone.
    let shared = comb.shared_lookups(segments) as u64;
    let mut prepared: SmallVec<[Prepared; 8]> = smallvec![comb.prepare(field, 0.0, end(field, 1, segments))];
    for segment in 2..=segments {
        let before = prepared[segment as usize - 2];
        prepared.push(comb.prepare_next(field, &before, end(field, segment, segments)));
    }
    let mut states: [E::State; LANES] = std::array::from_fn(|lane| estimator.begin(&mut source.lane(lane)));
    let mut intervals = Intervals::of(&prepared[0]);
    let mut lookups = [shared; LANES];
    while batches.are_open() {
        let mut shifts = [0.0; LANES];
        for lane in (0..LANES).filter(|&lane| batches.is_open(lane)) {
            shifts[lane] = estimator.shift(&states[lane], &mut source.lane(lane));
            if segments > 1 {
                intervals.set(lane, &prepared[estimator.segment(&states[lane])]);
            }
        }
        let thicknesses = intervals.thicknesses(comb, field, &shifts);
        for lane in 0..LANES {
            if !batches.is_open(lane) {
                continue;
            }
            let mut stream = source.lane(lane);
            lookups[lane] += u64::from(comb.teeth());
            if let Some(estimate) = estimator.receive(&mut states[lane], thicknesses[lane], &mut stream) {
                batches.take(lane, estimate, lookups[lane]);
                lookups[lane] = shared;
                states[lane] = estimator.begin(&mut stream);
            }
        }
    }
}

/// The end of a segment, from 1 on.
fn end<F: Extinction>(field: &F, segment: u32, segments: u32) -> f64 {
    UnbiasedRayMarching::end_of(field.length(), segment, segments)
}

/// A [`Prepared`] interval in each lane.
struct Intervals {
    from: Lanes,
    to: Lanes,
    step: Lanes,
    corrections: [Lanes; 3],
}

impl Intervals {
    fn of(prepared: &Prepared) -> Self {
        let mut intervals =
            Self { from: [0.0; LANES], to: [0.0; LANES], step: [0.0; LANES], corrections: [[0.0; LANES]; 3] };
        (0..LANES).for_each(|lane| intervals.set(lane, prepared));
        intervals
    }

    fn set(&mut self, lane: usize, prepared: &Prepared) {
        (self.from[lane], self.to[lane], self.step[lane]) = (prepared.from, prepared.to, prepared.step);
        for (lanes, correction) in self.corrections.iter_mut().zip(prepared.corrections) {
            lanes[lane] = correction;
        }
    }

    /// [`Comb::thickness`] in each lane.
    #[inline(always)]
    fn thicknesses<F: Extinction>(&self, comb: Comb, field: &F, shifts: &Lanes) -> Lanes {
        let Self { from, to, step, corrections } = self;
        let (mut sum, mut s) = ([0.0; LANES], [0.0; LANES]);
        if comb.shape() == CombShape::Periodised {
            let scale = 1.0 / f64::from(comb.teeth());
            for tooth in 0..comb.teeth() {
                let mut t = [0.0; LANES];
                for i in 0..LANES {
                    t[i] = (f64::from(tooth) + shifts[i]) * scale;
                    s[i] = (from[i] + t[i] * t[i] * (3.0 - 2.0 * t[i]) * (to[i] - from[i])).min(to[i]);
                }
                let sigma_t = field.sigma_t_lanes(&s);
                for i in 0..LANES {
                    sum[i] += t[i] * (1.0 - t[i]) * sigma_t[i];
                }
            }
            return std::array::from_fn(|i| 6.0 * step[i] * sum[i]);
        }
        for tooth in 0..comb.teeth() {
            for i in 0..LANES {
                s[i] = ((from[i] + shifts[i] * step[i]) + f64::from(tooth) * step[i]).min(to[i]);
            }
            let sigma_t = field.sigma_t_lanes(&s);
            for i in 0..LANES {
                sum[i] += sigma_t[i];
            }
        }
        std::array::from_fn(|i| {
            let [b1, b2, b3] = Comb::bernoulli(shifts[i]);
            let correction = corrections[0][i] * b1 + corrections[1][i] * b2 + corrections[2][i] * b3;
            step[i] * sum[i] - correction
        })
    }
}

/// An estimate of unbiased ray marching between two combs.
struct Marched {
    segment: usize,
    order: u32,
    /// X_0 of the segment.
    first: f64,
    /// X_0 − X_i so far.
    deviations: SmallVec<[f64; 16]>,
    product: SignedProduct,
    thickness: f64,
}

impl OfCombs for UnbiasedRayMarching {
    type State = Marched;

    fn comb(&self) -> Comb {
        self.comb()
    }

    fn segments(&self) -> u32 {
        self.segments()
    }

    #[inline]
    fn begin(&self, source: &mut impl UniformSource) -> Marched {
        let order = self.roulette().sample_order(source);
        let (product, deviations) = (SignedProduct::ONE, SmallVec::new());
        Marched { segment: 0, order, first: 0.0, deviations, product, thickness: 0.0 }
    }

    fn segment(&self, state: &Marched) -> usize {
        state.segment
    }

    #[inline]
    fn receive(&self, state: &mut Marched, x: f64, source: &mut impl UniformSource) -> Option<f64> {
        if state.deviations.is_empty() {
            state.first = x;
            state.thickness += x;
        }
        if state.order > 0 {
            state.deviations.push(state.first - x);
            if state.deviations.len() <= state.order as usize {
                return None;
            }
            // The first is 0, also where X is not finite.
            state.deviations[0] = 0.0;
            let (sum, exponent) = of_draws(self.roulette(), &state.deviations);
            state.product.multiply(sum);
            state.thickness -= exponent;
            state.deviations.clear();
        }
        state.segment += 1;
        if state.segment == self.segments() as usize {
            return Some(state.product.times_exp(-state.thickness));
        }
        state.order = self.roulette().sample_order(source);
        None
    }
}

/// An estimate by telescoping between two combs.
#[derive(Default)]
struct Telescoped {
    level: u32,
    /// The variate of the finest comb.
    u: f64,
    /// Combs so far, and the sums over them.
    combs: u64,
    base: f64,
    even: f64,
    odd: f64,
    /// exp(−X) of an even comb that waits for its neighbour.
    waiting: f64,
}

impl OfCombs for Telescoping {
    type State = Telescoped;

    fn comb(&self) -> Comb {
        self.comb()
    }

    #[inline]
    fn begin(&self, source: &mut impl UniformSource) -> Telescoped {
        let level = self.sample_level(source);
        Telescoped { level, u: source.next_uniform(), ..Telescoped::default() }
    }

    #[inline]
    fn shift(&self, state: &Telescoped, _source: &mut impl UniformSource) -> f64 {
        let (combs, scale) = (state.combs, 1.0 / (1_u64 << state.level) as f64);
        let first = (combs & !1) as f64 + state.u;
        if combs % 2 == 0 { first * scale } else { (first + 1.0) * scale }
    }

    #[inline]
    fn receive(&self, state: &mut Telescoped, x: f64, _source: &mut impl UniformSource) -> Option<f64> {
        let estimate = exp(-x);
        if state.level == 0 {
            return Some(estimate + 0.0 / self.probability(0));
        }
        state.combs += 1;
        if state.combs % 2 == 1 {
            (state.waiting, state.even) = (estimate, state.even + x);
            return None;
        }
        state.base += state.waiting + estimate;
        state.odd += x;
        let combs = 1_u64 << state.level;
        (state.combs == combs).then(|| {
            let (scale, &mut Telescoped { base, even, odd, .. }) = (1.0 / combs as f64, &mut *state);
            let difference = difference(0.0 - scale * (even + odd), 0.5 * scale * (odd - even));
            scale * base + difference / self.probability(state.level)
        })
    }
}

impl OfCombs for Jackknife {
    /// The first of the two thicknesses.
    type State = Option<f64>;

    fn comb(&self) -> Comb {
        self.comb()
    }

    fn begin(&self, _source: &mut impl UniformSource) -> Option<f64> {
        None
    }

    #[inline]
    fn receive(&self, state: &mut Option<f64>, x: f64, _source: &mut impl UniformSource) -> Option<f64> {
        let first = state.replace(x)?;
        Some(cos(0.5 * (first - x)) * exp(-0.5 * (first + x)))
    }
}

macro_rules! in_lanes {
    ($($estimator:ty),*) => {$(
        impl<F: Extinction> Lockstep<F> for $estimator {
            #[inline(always)]
            fn fill(&self, field: &F, source: &mut SeededLanes, batches: &mut Batches<'_, '_>) {
                fill(self, field, source, batches);
            }
        }
    )*};
}

in_lanes!(UnbiasedRayMarching, Telescoping, Jackknife);
