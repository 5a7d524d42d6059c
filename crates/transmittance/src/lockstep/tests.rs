//! Equality with the scalar estimators, on every instruction set that the machine has.

use super::*;
use crate::{
    Comb, CombShape, Jackknife, JitteredRatio, JitteredRatioInCells, Offset, RayMarching, Roulette,
    Telescoping, Tracking, UnbiasedRayMarching, Woodcock,
};
use fairflight_collision::{Albedo, CollisionModel, DoubleParticle, SingleParticle, Version};
use fairflight_media::{
    AnalyticCosine, BoundCell, Bounded, Clip, Constant, Counted, Extinction, InCells, InvertOpticalThickness,
    Line, OpticalThickness, Perlin, PerlinParameters, PiecewiseLinear, Ray, Vacuum,
};
use fairflight_sources::Seeded;
use glam::{DVec3, dvec3};

const SEEDS: [u64; LANES] = [3, 1, 4, 15, 9, 2, 6, 5, 35, 8, 97, 93, 23, 84, 62, 64];

/// Lengths of the slices of all lanes, one of them empty.
fn lengths() -> [usize; LANES] {
    std::array::from_fn(|lane| lane * 37 % 200)
}

/// Bits of the estimates of each lane, and the look-ups of each estimate.
type Found = Vec<(Vec<u64>, Vec<f64>)>;

fn one_after_the_other<F: Extinction, E: for<'a> TransmittanceEstimator<Counted<&'a F>>>(
    estimator: &E,
    field: &F,
) -> Found {
    let of_lane = |(&seed, length)| {
        let mut source = Seeded::new(seed);
        let of_one = |_| {
            let counted = Counted::new(field);
            (estimator.estimate(&counted, &mut source).to_bits(), counted.lookups() as f64)
        };
        (0..length).map(of_one).unzip()
    };
    SEEDS.iter().zip(lengths()).map(of_lane).collect()
}

/// Estimates and look-ups that `fill` makes.
fn found(fill: impl FnOnce(&mut Batches<'_, '_>)) -> Found {
    let [mut estimates, mut counts] = [(); 2].map(|()| lengths().map(|length| vec![f64::NAN; length]));
    let mut slices = estimates.each_mut().map(Vec::as_mut_slice);
    let mut count_slices = counts.each_mut().map(Vec::as_mut_slice);
    let mut batches = Batches::new(&mut slices, Some(&mut count_slices));
    fill(&mut batches);
    let lookups = batches.lookups();
    let bits = |lane: &Vec<f64>| lane.iter().map(|estimate| estimate.to_bits()).collect::<Vec<u64>>();
    assert_eq!(counts.each_ref().map(|lane| lane.iter().sum::<f64>() as u64), lookups);
    estimates.iter().map(bits).zip(counts).collect()
}

/// Holds `estimator` in lanes to be what it is one walk after the other, on every instruction set that the machine has.
fn is_the_same<F: Extinction, E: Lockstep<F> + for<'a> TransmittanceEstimator<Counted<&'a F>>>(
    name: &str,
    estimator: &E,
    field: &F,
) {
    let expected = one_after_the_other(estimator, field);
    for set in InstructionSet::of_this_machine() {
        let found = found(|batches| _ = fill_by(set, (estimator, field), SEEDS, batches));
        assert!(found == expected, "{name}: {}", set.name());
    }
}

fn tracking<C: OpticalThickness, R: InvertOpticalThickness>(
    control: C,
    sampling: R,
) -> Tracking<DoubleParticle, C, R> {
    Tracking::new(DoubleParticle { albedo: Albedo::new(0.0).unwrap() }, control, sampling)
}

fn nodes() -> PiecewiseLinear {
    PiecewiseLinear::new(vec![0.0, 1.0, 2.5, 4.0, 8.0], vec![0.25, 1.0, 0.0, 0.75, 0.5]).unwrap()
}

/// A ray of length 8 through eq. 21.
fn ray() -> Ray<AnalyticCosine> {
    let line = Line { origin: dvec3(1.0, 2.0, 3.0), direction: dvec3(0.2, -0.5, 0.9).normalize() };
    Ray::new(AnalyticCosine::new(1.0).unwrap(), &Clip { line, length: 8.0, entry_distance: 0.0 })
}

#[test]
fn tracking_is_that_of_one_walk() {
    let length = 8.0;
    let constant = |sigma_t| Constant::new(sigma_t, length).unwrap();
    let field = nodes();
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

#[test]
fn walks_that_end_are_those_of_one_walk() {
    let albedo = Albedo::new(0.4).unwrap();
    fn at_rates<M: CollisionModel + Copy>(name: &str, model: M, rates: &[f64]) {
        for &rate in rates {
            let sampling = Constant::new(rate, 8.0).unwrap();
            is_the_same(name, &Tracking::new(model, Vacuum::new(8.0), sampling), &nodes());
            is_the_same(name, &Tracking::new(model, Constant::new(0.25, 8.0).unwrap(), sampling), &ray());
        }
    }
    at_rates("Woodcock's model", fairflight_collision::Woodcock { albedo }, &[1.0, 2.0]);
    at_rates("terminating", SingleParticle { version: Version::Terminating, albedo }, &[0.8, 1.0, 2.0]);
    at_rates("not terminating", SingleParticle { version: Version::NonTerminating, albedo }, &[0.4, 2.0]);
    at_rates("adaptive", SingleParticle { version: Version::Adaptive, albedo }, &[0.7, 2.0]);
    for majorant in [1.0, 3.0] {
        is_the_same("Woodcock", &Woodcock, &Bounded::new(nodes(), majorant).unwrap());
        is_the_same("Woodcock, eq. 21", &Woodcock, &Bounded::new(ray(), majorant).unwrap());
    }
    is_the_same("Woodcock, nothing", &Woodcock, &Constant::new(0.0, 8.0).unwrap());
    is_the_same("Woodcock, full", &Woodcock, &Constant::new(1.0, 8.0).unwrap());
}

#[test]
fn strata_are_those_of_one_walk() {
    let cells = [(2.0, 0.0, 1.0), (3.0, 0.5, 0.5), (5.0, 0.0, 0.9), (8.0, 0.5, 0.75)];
    let cells = cells.map(|(to, minorant, majorant)| BoundCell { to, minorant, majorant });
    let known = [BoundCell { to: 8.0, minorant: 0.25, majorant: 0.25 }];
    for epsilon in [1.0, 0.3, 1e-2] {
        let (whole, in_cells) =
            (JitteredRatio::new(epsilon).unwrap(), JitteredRatioInCells::new(epsilon).unwrap());
        is_the_same("jittered ratio", &whole, &Bounded::new(nodes(), 1.0).unwrap());
        is_the_same("jittered ratio, eq. 21", &whole, &Bounded::new(ray(), 1.25).unwrap());
        is_the_same("jittered ratio, nothing", &whole, &Constant::new(0.0, 8.0).unwrap());
        is_the_same("jittered ratio, full", &whole, &Constant::new(2.0, 8.0).unwrap());
        is_the_same("jittered ratio in cells", &in_cells, &InCells::new(nodes(), cells).unwrap());
        let constant = Constant::new(0.25, 8.0).unwrap();
        is_the_same("jittered ratio in known cells", &in_cells, &InCells::new(constant, known).unwrap());
    }
}

#[test]
fn combs_are_those_of_one_walk() {
    let noise = Perlin::new(PerlinParameters { octaves: 3, offset: 0.3, ..PerlinParameters::default() });
    let noise =
        Ray::new(noise.unwrap(), &Clip { line: *ray().world_line(), length: 8.0, entry_distance: 0.0 });
    for shape in CombShape::ALL {
        for teeth in [1, 7] {
            let comb = Comb::new(teeth, shape).unwrap();
            let name = format!("{shape:?}, {teeth} teeth");
            for (stop, segments) in [(0.9, 1), (0.2, 3)] {
                let marching = UnbiasedRayMarching::new(comb, Roulette::new(stop).unwrap());
                let marching = marching.in_segments(segments).unwrap();
                is_the_same(&format!("unbiased ray marching, {name}"), &marching, &nodes());
                is_the_same(&format!("unbiased ray marching, noise, {name}"), &marching, &noise);
            }
            let telescoping = Telescoping::new(teeth, 0.6, shape).unwrap();
            is_the_same(&format!("telescoping, {name}"), &telescoping, &ray());
            is_the_same(&format!("jackknife, {name}"), &Jackknife::new(comb), &ray());
        }
    }
    // Deviations beyond the range of numbers.
    let dense = PiecewiseLinear::new(vec![0.0, 1.9, 2.0], vec![0.1, 0.1, 4e4]).unwrap();
    let comb = Comb::new(2, CombShape::Uniform).unwrap();
    is_the_same("unbiased ray marching, dense", &UnbiasedRayMarching::new(comb, Roulette::KETTUNEN), &dense);
    for offset in [Offset::Fixed, Offset::Jittered] {
        is_the_same("ray marching", &RayMarching::new(9, offset).unwrap(), &ray());
    }
}

#[test]
fn what_is_not_lawful_is_seen() {
    let field = Bounded::new(nodes(), 0.9).unwrap();
    let lawful = |field: &Bounded<PiecewiseLinear>, upper_bound| {
        let watched = Watched::new(field, &Woodcock, upper_bound);
        found(|batches| {
            fill_by(InstructionSet::widest(), (&Woodcock, &watched), SEEDS, batches);
        });
        watched.all_lawful()
    };
    assert!(!lawful(&field, f64::INFINITY));
    let field = Bounded::new(nodes(), 1.0).unwrap();
    assert_eq!([1.0, 0.9].map(|upper_bound| lawful(&field, upper_bound)), [true, false]);
}

/// A twin that hands variates from lane to lane is not the scalar walk.
#[test]
fn lanes_that_are_mixed_are_told() {
    fn is_told<F: Extinction, E: Lockstep<F> + for<'a> TransmittanceEstimator<Counted<&'a F>>>(
        estimator: &E,
        field: &F,
    ) {
        let expected = one_after_the_other(estimator, field);
        let mut seeds = SEEDS;
        seeds.swap(4, 5);
        let set = InstructionSet::widest();
        let mixed = found(|batches| _ = fill_by(set, (estimator, field), seeds, batches));
        assert!(mixed != expected);
    }
    let [field, sampling] = [0.9, 0.5].map(|sigma_t| Constant::new(sigma_t, 8.0).unwrap());
    is_told(&tracking(Vacuum::new(8.0), sampling), &field);
    let field = Bounded::new(nodes(), 1.0).unwrap();
    is_told(&Woodcock, &field);
    is_told(&JitteredRatio::new(0.5).unwrap(), &field);
    let comb = Comb::new(3, CombShape::Uniform).unwrap();
    is_told(&UnbiasedRayMarching::new(comb, Roulette::KETTUNEN), &field);
    is_told(&Telescoping::new(3, 0.8, CombShape::Uniform).unwrap(), &field);
    is_told(&Jackknife::new(comb), &field);
    is_told(&RayMarching::new(3, Offset::Jittered).unwrap(), &field);
}
