//! Equality with the scalar estimators, on every instruction set that the machine has.

use super::*;
use crate::Tracking;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::{
    AnalyticCosine, Clip, Constant, Counted, Extinction, InvertOpticalThickness, Line, OpticalThickness,
    PiecewiseLinear, Ray, Vacuum,
};
use fairflight_sources::Seeded;
use glam::{DVec3, dvec3};

const SEEDS: [u64; LANES] = [3, 1, 4, 15, 9, 2, 6, 5, 35, 8, 97, 93, 23, 84, 62, 64];

type Slices<'a> = [&'a mut [f64]; LANES];

/// Lengths of the slices of all lanes, one of them empty.
fn lengths() -> [usize; LANES] {
    std::array::from_fn(|lane| lane * 37 % 200)
}

fn one_after_the_other<F: Extinction, E: for<'a> TransmittanceEstimator<Counted<&'a F>>>(
    estimator: &E,
    field: &F,
) -> Vec<(Vec<u64>, u64)> {
    let of_lane = |(&seed, length)| {
        let (mut source, counted) = (Seeded::new(seed), Counted::new(field));
        let estimates = (0..length).map(|_| estimator.estimate(&counted, &mut source).to_bits()).collect();
        (estimates, counted.lookups())
    };
    SEEDS.iter().zip(lengths()).map(of_lane).collect()
}

/// Bits of the estimates that `fill` makes, and the look-ups that it tells.
fn bits(fill: impl FnOnce(&mut Slices<'_>) -> [u64; LANES]) -> Vec<(Vec<u64>, u64)> {
    let mut estimates = lengths().map(|length| vec![f64::NAN; length]);
    let lookups = fill(&mut estimates.each_mut().map(Vec::as_mut_slice));
    let bits = estimates.iter().map(|lane| lane.iter().map(|estimate| estimate.to_bits()).collect());
    bits.zip(lookups).collect()
}

/// Holds `estimator` in lanes to be what it is one walk after the other.
fn is_the_same<F: Extinction, E: Lockstep<F> + for<'a> TransmittanceEstimator<Counted<&'a F>>>(
    name: &str,
    estimator: &E,
    field: &F,
) {
    let expected = one_after_the_other(estimator, field);
    let plain = bits(|estimates| estimator.fill(field, &mut SeededLanes::new(SEEDS), estimates));
    assert_eq!(plain, expected, "{name}: the common instruction set");
    let best = bits(|estimates| fill(estimator, field, SEEDS, estimates));
    assert_eq!(best, expected, "{name}: the best instruction set");
    #[cfg(target_arch = "x86_64")]
    {
        use pulp::Simd;
        use pulp::x86::V3;
        if let Some(v3) = V3::try_new() {
            let found =
                bits(|estimates| Simd::vectorize(v3, Fill { estimator, field, seeds: SEEDS, estimates }));
            assert_eq!(found, expected, "{name}: AVX2");
        }
    }
}

fn tracking<C: OpticalThickness, R: InvertOpticalThickness>(
    control: C,
    sampling: R,
) -> Tracking<DoubleParticle, C, R> {
    Tracking::new(DoubleParticle { albedo: Albedo::new(0.0).unwrap() }, control, sampling)
}

#[test]
fn tracking_is_that_of_one_walk() {
    let length = 8.0;
    let constant = |sigma_t| Constant::new(sigma_t, length).unwrap();
    let field = PiecewiseLinear::new(vec![0.0, 1.0, 2.5, 4.0, 8.0], vec![0.25, 1.0, 0.0, 0.75, 0.5]).unwrap();
    for sigma_samp in [0.4, 1.0, 3.0] {
        is_the_same("ratio tracking", &tracking(Vacuum::new(length), constant(sigma_samp)), &field);
        is_the_same("residual ratio tracking", &tracking(constant(0.5), constant(sigma_samp)), &field);
        // A weight of 0 at the majorant.
        is_the_same(
            "ratio tracking, constant",
            &tracking(Vacuum::new(length), constant(sigma_samp)),
            &constant(1.0),
        );
    }
    let ray = |origin: DVec3, direction: DVec3| {
        let line = Line { origin, direction: direction.normalize() };
        Ray::new(AnalyticCosine::new(1.0).unwrap(), &Clip { line, length, entry_distance: 0.0 })
    };
    is_the_same(
        "eq. 21",
        &tracking(Vacuum::new(length), constant(0.7)),
        &ray(dvec3(1.0, 2.0, 3.0), dvec3(0.2, -0.5, 0.9)),
    );
    // Beyond the common range of sine and cosine.
    is_the_same(
        "far away",
        &tracking(Vacuum::new(length), constant(0.7)),
        &ray(1e6 * DVec3::ONE, dvec3(1.0, 1.0, 0.3)),
    );
    // Products beyond the range of double precision, and a dense medium.
    is_the_same("negative extinction", &tracking(constant(500.0), constant(20.0)), &constant(-90.0));
    is_the_same("seldom", &tracking(Vacuum::new(length), constant(0.0)), &constant(0.0));
}

/// A twin that hands variates from lane to lane is not the scalar walk.
#[test]
fn lanes_that_are_mixed_are_told() {
    let [field, sampling] = [0.9, 0.5].map(|sigma_t| Constant::new(sigma_t, 8.0).unwrap());
    let estimator = tracking(Vacuum::new(8.0), sampling);
    let expected = one_after_the_other(&estimator, &field);
    let mut mixed = SEEDS;
    mixed.swap(4, 5);
    assert!(bits(|estimates| fill(&estimator, &field, mixed, estimates)) != expected);
}
