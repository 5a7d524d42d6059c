//! Bounds and values that are derived in different ways, and may disagree by a rounding: every estimator that claims the bounds of a
//! profile admits every value of it.

use fairflight_collision::{Albedo, SingleParticle, Version};
use fairflight_media::{
    Bounded, BoundedInCells, Constant, Extinction, InCells, IntervalBounds, Majorant, PiecewiseLinear, Vacuum,
};
use fairflight_sources::Seeded;
use fairflight_transmittance::{
    Explorers, JitteredRatio, JitteredRatioInCells, LineIntegral, NextFlight, NextFlightVersion,
    ResidualCells, Tracking, TransmittanceEstimator, Woodcock,
};
use proptest::prelude::*;

/// Extinctions of all sizes, often equal to their neighbours.
fn extinction() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => (0..900_u32).prop_map(|i| f64::from(i) / 100.0),
        1 => prop::sample::select(vec![0.0, 0.7, 5e-324, 1e-300, 1e5]),
        1 => 0.0..10.0_f64,
    ]
}

fn profile() -> impl Strategy<Value = PiecewiseLinear> {
    let node = (1..300_u32, extinction(), any::<bool>());
    prop::collection::vec(node, 2..6).prop_map(|nodes| {
        let (mut positions, mut values) = (vec![0.0], vec![nodes[0].1]);
        let mut end = 0;
        for &(width, value, repeat) in &nodes[1..] {
            end += width;
            positions.push(f64::from(end) / 100.0);
            values.push(if repeat { values[values.len() - 1] } else { value });
        }
        PiecewiseLinear::new(positions, values).unwrap()
    })
}

/// Distances all over a profile, and those a rounding beside its tenths.
fn places(length: f64) -> impl Iterator<Item = f64> {
    let inside = (0..=500).map(move |i| length * f64::from(i) / 500.0);
    inside.chain((1..=10).flat_map(move |i| {
        let s = length * f64::from(i) / 10.0;
        [s.next_down(), s.next_up().min(length)]
    }))
}

fn admits<F: Extinction>(field: &F, estimator: &impl TransmittanceEstimator<F>) -> Result<(), TestCaseError> {
    for s in places(field.length()) {
        let sigma_t = field.sigma_t(s);
        prop_assert!(estimator.admits(field, s, sigma_t), "{sigma_t} at {s}");
    }
    Ok(())
}

fn single(version: Version, albedo: f64) -> SingleParticle {
    SingleParticle { version, albedo: Albedo::new(albedo).unwrap() }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn estimators_admit_what_their_bounds_bound(field in profile(), count in 1..40_usize, seed in any::<u64>()) {
        let bounded = Bounded::new(&field, field.majorant()).unwrap();
        admits(&bounded, &Woodcock)?;
        admits(&bounded, &LineIntegral::new(3).unwrap())?;
        admits(&bounded, &NextFlight::new(NextFlightVersion::Delta))?;
        let jittered = JitteredRatio::new(0.5).unwrap();
        admits(&bounded, &jittered)?;

        let cells = InCells::new(&field, field.equal_cells(count)).unwrap();
        let in_cells = JitteredRatioInCells::new(0.5).unwrap();
        admits(&cells, &in_cells)?;
        admits(&cells, &ResidualCells::default())?;
        if field.majorant() * field.length() < 1e4 {
            let (mut minorant_thickness, mut from) = (0.0, 0.0);
            for cell in cells.bound_cells() {
                minorant_thickness += cell.minorant * (cell.to - from);
                from = cell.to;
            }
            let mut source = Seeded::new(seed);
            let (estimate, most) = (in_cells.estimate(&cells, &mut source), (-minorant_thickness).exp());
            prop_assert!((0.0..=most * (1.0 + 1e-12)).contains(&estimate), "{estimate}, at most {most}");
            let estimate = jittered.estimate(&bounded, &mut source);
            prop_assert!((0.0..=1.0).contains(&estimate), "{estimate}");
        }
    }

    #[test]
    fn a_domain_holds_its_ends(
        main in 1..900_u32,
        difference in 1..300_u32,
        albedo in 0..=100_u32,
        length in 1..900_u32,
    ) {
        // σ_t, control and σ_samp as decimals, such that r is 2/(1 + a) but for rounding: the end of the terminating domain.
        let albedo = f64::from(albedo) / 100.0;
        let (sigma_t, main) = (f64::from(main + difference) / 100.0, f64::from(main) / 100.0);
        let sampling = f64::from(difference) / 200.0 * (1.0 + albedo);
        let length = f64::from(length) / 100.0;
        let constant = |sigma: f64| Constant::new(sigma, length).unwrap();
        let model = single(Version::Terminating, albedo);
        admits(&constant(sigma_t), &Tracking::new(model, constant(main), constant(sampling)))?;
        // No control: σ_samp = σ_t (1 + a)/2.
        let sampling = 0.5 * sigma_t * (1.0 + albedo);
        admits(&constant(sigma_t), &Tracking::new(model, Vacuum::new(length), constant(sampling)))?;
    }

    #[test]
    fn a_control_through_a_line_is_the_line(
        start in 1..900_u32,
        ratio in 0.25..4.0_f64,
        count in 2..30_usize,
        length in 1..900_u32,
    ) {
        // Not down to 0: there the rounding of the distance is larger than any multiple of the value.
        let start = f64::from(start) / 100.0;
        let values = vec![start, ratio * start];
        let field = PiecewiseLinear::new(vec![0.0, f64::from(length) / 100.0], values).unwrap();
        // r is 0 but for rounding, of either sign, with a σ_samp of its size or none.
        let explorers = Explorers::through(&field, count).unwrap();
        let model = single(Version::Terminating, 0.5);
        for sampling in [0.0, field.majorant()] {
            let tracking = Tracking::new(model, explorers.clone(), Constant::new(sampling, field.length()).unwrap());
            admits(&field, &tracking)?;
        }
    }
}
