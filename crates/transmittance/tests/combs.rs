//! Estimates made of combs allocate nothing.

use fairflight_media::PiecewiseLinear;
use fairflight_sources::Seeded;
use fairflight_transmittance::{
    Comb, CombShape, Jackknife, Roulette, RunningCumulant, Telescoping, TransmittanceEstimator,
    UnbiasedRayMarching,
};

#[test]
fn an_estimate_allocates_nothing() {
    let field = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).unwrap();
    let comb = Comb::new(2, CombShape::Bernoulli3).unwrap();
    // Orders that need more room than there is in place come once in 10^9 estimates.
    let marching = UnbiasedRayMarching::new(comb, Roulette::new(0.5).unwrap()).in_segments(2).unwrap();
    let telescoping = Telescoping::new(2, 0.8, CombShape::EndpointMatched).unwrap();
    let (mut source, mut earlier, mut sum) = (Seeded::new(1), RunningCumulant::new(), 0.0);
    let allocated = allocation_counter::measure(|| {
        for _ in 0..10_000 {
            sum += marching.estimate(&field, &mut source);
            sum += marching.estimate_and_observe(&field, &mut source, &mut earlier);
            sum += telescoping.estimate(&field, &mut source);
            sum += Jackknife::new(comb).estimate(&field, &mut source);
        }
    });
    assert_eq!(allocated.count_total, 0);
    assert!(sum > 0.0 && earlier.count() > 0);
}
