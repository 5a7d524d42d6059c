//! Row 14: the variates 0 and 1 − 2^-53 in every sampler, all at once; of each kind by itself see [`super::by_kind`].

use super::{HardCase, LAWFUL, Outcome};
use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version, Woodcock as WoodcockModel};
use fairflight_freeflight::{
    Flight, FreeFlight, Inversion, Newton, Regular, Tracking as FlightTracking, Woodcock as WoodcockFlight,
};
use fairflight_media::{
    Bounded, Constant, Extinction, InCells, IntervalBounds, PiecewiseConstant, PiecewiseLinear, Vacuum,
};
use fairflight_sources::{LARGEST_VARIATE, UniformSource};
use fairflight_transmittance::{
    AdaptiveRatio, Bidirectional, Comb, CombShape, Experience, GeneralisedPoisson, Hybrid, Jackknife,
    JitteredRatio, JitteredRatioInCells, LineIntegral, NextFlight, NextFlightVersion, Offset, PSeries,
    PSeriesVersion, ProgressiveMajorant, RayMarching, Regular as ClosedForm, ResidualCells, Roulette,
    Telescoping, Tracking, TransmittanceEstimator, UnbiasedRayMarching, Unidirectional, Woodcock,
};

/// One end of the lattice for a while, then its middle: a walk of flights of length 0 would never end, nor would a roulette that
/// always goes on.
pub(super) struct End {
    pub(super) variate: f64,
    pub(super) left: u32,
}

impl UniformSource for End {
    fn next_uniform(&mut self) -> f64 {
        if self.left == 0 {
            return 0.5;
        }
        self.left -= 1;
        self.variate
    }
}

fn every_sampler(variate: f64) -> Outcome {
    let field = Constant::new(0.7, 3.0).expect(LAWFUL);
    let bounded = Bounded::new(field, 1.0).expect(LAWFUL);
    let steps = PiecewiseConstant::new(vec![0.0, 1.0, 3.0], vec![0.0, 0.5]).expect(LAWFUL);
    let albedo = Albedo::new(0.5).expect(LAWFUL);
    let sampling = Constant::new(0.5, 3.0).expect(LAWFUL);
    let none = Vacuum::new(3.0);
    let series = |version| PSeries::new(version, 3.0).expect(LAWFUL);
    let comb = Comb::new(4, CombShape::EndpointMatched).expect(LAWFUL);
    let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL);
    let in_cells = InCells::new(tent.clone(), tent.equal_cells(3)).expect(LAWFUL);
    let hybrid = Hybrid::choose(&Experience::default(), 3.0, 3.0, Hybrid::USUAL_BUDGET);
    for left in 1..5 {
        let source = || End { variate, left };
        let single = |version| Tracking::new(SingleParticle { version, albedo }, none, sampling);
        let values = [
            Tracking::new(DoubleParticle { albedo }, none, sampling).estimate(&field, &mut source()),
            Tracking::new(DoubleParticle { albedo }, none, steps.clone()).estimate(&field, &mut source()),
            Tracking::new(WoodcockModel { albedo }, none, Constant::new(1.0, 3.0).expect(LAWFUL))
                .estimate(&field, &mut source()),
            single(Version::Terminating).estimate(&field, &mut source()),
            single(Version::NonTerminating).estimate(&field, &mut source()),
            single(Version::Adaptive).estimate(&field, &mut source()),
            Woodcock.estimate(&bounded, &mut source()),
            LineIntegral::new(1).expect(LAWFUL).estimate(&bounded, &mut source()),
            LineIntegral::new(3).expect(LAWFUL).estimate(&bounded, &mut source()),
            RayMarching::new(4, Offset::Jittered).expect(LAWFUL).estimate(&field, &mut source()),
            ClosedForm.estimate(&field, &mut source()),
            ProgressiveMajorant::new(0.3).expect(LAWFUL).estimate(&field, &mut source()),
            NextFlight::new(NextFlightVersion::Delta).estimate(&bounded, &mut source()),
            NextFlight::new(NextFlightVersion::Ratio).estimate(&bounded, &mut source()),
            Unidirectional.estimate(&bounded, &mut source()),
            Bidirectional.estimate(&bounded, &mut source()),
            series(PSeriesVersion::Cmf).estimate(&bounded, &mut source()),
            series(PSeriesVersion::Cumulative).estimate(&bounded, &mut source()),
            series(PSeriesVersion::Ratio).estimate(&bounded, &mut source()),
            series(PSeriesVersion::NextFlight).estimate(&bounded, &mut source()),
            GeneralisedPoisson::new(3.6, 3.0).expect(LAWFUL).estimate(&bounded, &mut source()),
            AdaptiveRatio::new(0.1).expect(LAWFUL).estimate(&bounded, &mut source()),
            UnbiasedRayMarching::new(comb, Roulette::KETTUNEN).estimate(&tent, &mut source()),
            Jackknife::new(comb).estimate(&tent, &mut source()),
            Telescoping::new(4, 0.8, CombShape::EndpointMatched)
                .expect(LAWFUL)
                .estimate(&tent, &mut source()),
            JitteredRatio::new(0.5).expect(LAWFUL).estimate(&bounded, &mut source()),
            JitteredRatioInCells::new(0.5).expect(LAWFUL).estimate(&in_cells, &mut source()),
            ResidualCells::default().estimate(&in_cells, &mut source()),
            hybrid.estimate(&bounded, &mut source()),
        ];
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Outcome::said(false, format!("{value}"));
        }
    }
    Outcome::said(true, "finite in every sampler")
}

/// A flight that collided did so on the profile, where there is matter, with a finite weight.
pub(super) fn is_lawful<F: Extinction>(field: &F, flight: Flight) -> bool {
    let collides = |s: f64| (0.0..=field.length()).contains(&s) && field.sigma_t(s) > 0.0;
    flight.weight().is_finite() && flight.distance().is_none_or(collides)
}

fn every_flight(variate: f64) -> Outcome {
    // Empty at first, and in the middle.
    let steps =
        PiecewiseConstant::new(vec![0.0, 1.0, 3.0, 4.0, 5.0], vec![0.0, 0.5, 0.0, 0.2]).expect(LAWFUL);
    let slopes = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.5, 1.5, 0.0]).expect(LAWFUL);
    let constant = |sigma| Constant::new(sigma, 5.0).expect(LAWFUL);
    for left in 1..5 {
        let source = || End { variate, left };
        let tracking = |version, sigma| {
            let sampler = FlightTracking::new(version, constant(sigma));
            is_lawful(&steps, sampler.sample(&steps, &mut source()))
        };
        let all = [
            ("inversion", is_lawful(&steps, Inversion.sample(&steps, &mut source()))),
            ("inversion of slopes", is_lawful(&slopes, Inversion.sample(&slopes, &mut source()))),
            ("newton", is_lawful(&steps, Newton.sample(&steps, &mut source()))),
            ("newton on slopes", is_lawful(&slopes, Newton.sample(&slopes, &mut source()))),
            ("regular", is_lawful(&steps, Regular.sample(&steps, &mut source()))),
            ("regular on slopes", is_lawful(&slopes, Regular.sample(&slopes, &mut source()))),
            ("woodcock", is_lawful(&steps, WoodcockFlight::new(constant(0.5)).sample(&steps, &mut source()))),
            (
                "woodcock in cells",
                is_lawful(&steps, WoodcockFlight::new(steps.clone()).sample(&steps, &mut source())),
            ),
            ("terminating", tracking(Version::Terminating, 0.5)),
            ("non-terminating", tracking(Version::NonTerminating, 0.3)),
            ("adaptive", tracking(Version::Adaptive, 0.3)),
        ];
        if let Some((name, _)) = all.iter().find(|(_, lawful)| !lawful) {
            return Outcome::said(false, format!("{name}: no weight, or a collision where no matter is"));
        }
    }
    Outcome::said(true, "finite, and a collision only where matter is")
}

pub(super) fn cases() -> Vec<HardCase> {
    [("0", 0.0), ("1 - 2^-53", LARGEST_VARIATE)]
        .into_iter()
        .flat_map(|(name, variate)| {
            [
                HardCase::deterministic(
                    14,
                    format!("the uniform variate {name}"),
                    "every sampler",
                    "finite",
                    "finite",
                    move || every_sampler(variate),
                ),
                HardCase::deterministic(
                    14,
                    format!("the uniform variate {name} in a free flight"),
                    "free flights",
                    "finite, where matter is",
                    "finite",
                    move || every_flight(variate),
                ),
            ]
        })
        .collect()
}
