//! Row 14: the variates 0 and 1 − 2^-53 in every sampler.

use super::{HardCase, LAWFUL, Outcome};
use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version, Woodcock as WoodcockModel};
use fairflight_freeflight::spectral::{
    AverageScheme, DecompositionTracking, HeroWavelength, MaxScheme, SeparateSolve, SharedDistance,
    SpectralFlight, SpectralFreeFlight, SpectralTracking,
};
use fairflight_freeflight::{
    Flight, FreeFlight, Inversion, JitteredFlight, Newton, Regular, Tracking as FlightTracking,
    Woodcock as WoodcockFlight,
};
use fairflight_media::{
    Bounded, Constant, Extinction, InCells, IntervalBounds, PiecewiseConstant, PiecewiseLinear, Scaled,
    SpectralExtinction, Vacuum,
};
use fairflight_sources::{LARGEST_VARIATE, UniformSource};
use fairflight_transmittance::{
    AdaptiveRatio, Bidirectional, Comb, CombShape, Experience, GeneralisedPoisson, Hybrid, Jackknife,
    JitteredRatio, JitteredRatioInCells, LineIntegral, NextFlight, NextFlightVersion, Offset, PSeries,
    PSeriesVersion, ProgressiveMajorant, RayMarching, Regular as ClosedForm, ResidualCells, Roulette,
    Telescoping, Tracking, TransmittanceEstimator, UnbiasedRayMarching, Unidirectional, Woodcock,
};
use std::collections::BTreeSet;

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

/// One estimate by every estimator, each with its kind, the first `left` variates of each being `variate`.
fn estimates(variate: f64, left: u32) -> Vec<(&'static str, f64)> {
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
    let marching = |steps| RayMarching::new(steps, Offset::Jittered).expect(LAWFUL);
    let source = || End { variate, left };
    let single = |version| Tracking::new(SingleParticle { version, albedo }, none, sampling);
    vec![
        (
            "double_particle",
            Tracking::new(DoubleParticle { albedo }, none, sampling).estimate(&field, &mut source()),
        ),
        (
            "double_particle",
            Tracking::new(DoubleParticle { albedo }, none, steps.clone()).estimate(&field, &mut source()),
        ),
        (
            "woodcock",
            Tracking::new(WoodcockModel { albedo }, none, Constant::new(1.0, 3.0).expect(LAWFUL))
                .estimate(&field, &mut source()),
        ),
        ("single_particle", single(Version::Terminating).estimate(&field, &mut source())),
        ("single_particle", single(Version::NonTerminating).estimate(&field, &mut source())),
        ("single_particle", single(Version::Adaptive).estimate(&field, &mut source())),
        ("woodcock", Woodcock.estimate(&bounded, &mut source())),
        ("line_integral", LineIntegral::new(1).expect(LAWFUL).estimate(&bounded, &mut source())),
        ("line_integral", LineIntegral::new(3).expect(LAWFUL).estimate(&bounded, &mut source())),
        ("ray_marching", marching(4).estimate(&field, &mut source())),
        ("naive", marching(7).estimate(&field, &mut source())),
        ("regular", ClosedForm.estimate(&field, &mut source())),
        (
            "progressive_majorant",
            ProgressiveMajorant::new(0.3).expect(LAWFUL).estimate(&field, &mut source()),
        ),
        ("next_flight", NextFlight::new(NextFlightVersion::Delta).estimate(&bounded, &mut source())),
        ("next_flight", NextFlight::new(NextFlightVersion::Ratio).estimate(&bounded, &mut source())),
        ("next_flight", Unidirectional.estimate(&bounded, &mut source())),
        ("next_flight", Bidirectional.estimate(&bounded, &mut source())),
        ("p_series", series(PSeriesVersion::Cmf).estimate(&bounded, &mut source())),
        ("p_series", series(PSeriesVersion::Cumulative).estimate(&bounded, &mut source())),
        ("p_series", series(PSeriesVersion::Ratio).estimate(&bounded, &mut source())),
        ("p_series", series(PSeriesVersion::NextFlight).estimate(&bounded, &mut source())),
        (
            "generalised_poisson",
            GeneralisedPoisson::new(3.6, 3.0).expect(LAWFUL).estimate(&bounded, &mut source()),
        ),
        ("adaptive_ratio", AdaptiveRatio::new(0.1).expect(LAWFUL).estimate(&bounded, &mut source())),
        (
            "unbiased_ray_marching",
            UnbiasedRayMarching::new(comb, Roulette::KETTUNEN).estimate(&tent, &mut source()),
        ),
        ("jackknife", Jackknife::new(comb).estimate(&tent, &mut source())),
        (
            "telescoping",
            Telescoping::new(4, 0.8, CombShape::EndpointMatched)
                .expect(LAWFUL)
                .estimate(&tent, &mut source()),
        ),
        ("jittered_ratio", JitteredRatio::new(0.5).expect(LAWFUL).estimate(&bounded, &mut source())),
        ("jittered_ratio", JitteredRatioInCells::new(0.5).expect(LAWFUL).estimate(&in_cells, &mut source())),
        ("residual_cells", ResidualCells::default().estimate(&in_cells, &mut source())),
        ("hybrid", hybrid.estimate(&bounded, &mut source())),
    ]
}

fn every_sampler(variate: f64) -> Outcome {
    let all = (1..5).flat_map(|left| estimates(variate, left));
    match all.into_iter().find(|(_, value)| !value.is_finite()) {
        Some((kind, value)) => Outcome::said(false, format!("{kind}: {value}")),
        None => Outcome::said(true, "finite in every sampler"),
    }
}

/// A flight that weighs something in a wavelength did so on the profile, and with a finite weight. Another wavelength may have decided
/// about the collision, where this one meets nothing.
fn is_lawful_of<F: SpectralExtinction<3>>(field: &F, flight: Flight, wave: usize) -> bool {
    let collides = |s: f64| {
        (0.0..=field.length()).contains(&s) && (flight.weight() == 0.0 || field.sigma_t(s)[wave] > 0.0)
    };
    flight.weight().is_finite() && flight.distance().is_none_or(collides)
}

/// A flight that collided did so on the profile, where there is matter, with a finite weight.
fn is_lawful<F: Extinction>(field: &F, flight: Flight) -> bool {
    let collides = |s: f64| (0.0..=field.length()).contains(&s) && field.sigma_t(s) > 0.0;
    flight.weight().is_finite() && flight.distance().is_none_or(collides)
}

/// One flight by every sampler, with its kind and whether it was lawful.
fn flights(variate: f64, left: u32) -> Vec<(&'static str, &'static str, bool)> {
    // Empty at first, and in the middle.
    let steps =
        PiecewiseConstant::new(vec![0.0, 1.0, 3.0, 4.0, 5.0], vec![0.0, 0.5, 0.0, 0.2]).expect(LAWFUL);
    let slopes = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.5, 1.5, 0.0]).expect(LAWFUL);
    let constant = |sigma| Constant::new(sigma, 5.0).expect(LAWFUL);
    let source = || End { variate, left };
    let tracking = |version, sigma| {
        let sampler = FlightTracking::new(version, constant(sigma));
        is_lawful(&steps, sampler.sample(&steps, &mut source()))
    };
    let decomposition = DecompositionTracking::new(Version::Terminating, constant(0.0), constant(0.5));
    let jittered = JitteredFlight::new(0.5).expect(LAWFUL);
    let tinted = Scaled::new(steps.clone(), [1.0, 0.8, 0.0]).expect(LAWFUL);
    let of_all = |flight: SpectralFlight<3>| (0..3).all(|wave| is_lawful_of(&tinted, flight.of(wave), wave));
    vec![
        ("inversion_flight", "inversion", is_lawful(&steps, Inversion.sample(&steps, &mut source()))),
        (
            "inversion_flight",
            "inversion of slopes",
            is_lawful(&slopes, Inversion.sample(&slopes, &mut source())),
        ),
        ("newton_flight", "newton", is_lawful(&steps, Newton.sample(&steps, &mut source()))),
        ("newton_flight", "newton on slopes", is_lawful(&slopes, Newton.sample(&slopes, &mut source()))),
        ("regular_flight", "regular", is_lawful(&steps, Regular.sample(&steps, &mut source()))),
        ("regular_flight", "regular on slopes", is_lawful(&slopes, Regular.sample(&slopes, &mut source()))),
        (
            "woodcock_flight",
            "woodcock",
            is_lawful(&steps, WoodcockFlight::new(constant(0.5)).sample(&steps, &mut source())),
        ),
        (
            "woodcock_flight",
            "woodcock in cells",
            is_lawful(&steps, WoodcockFlight::new(steps.clone()).sample(&steps, &mut source())),
        ),
        ("tracking_flight", "terminating", tracking(Version::Terminating, 0.5)),
        ("tracking_flight", "non-terminating", tracking(Version::NonTerminating, 0.3)),
        ("tracking_flight", "adaptive", tracking(Version::Adaptive, 0.3)),
        ("jittered_flight", "jittered", is_lawful(&steps, jittered.sample(&steps, &mut source()))),
        (
            "decomposition_tracking",
            "decomposition",
            is_lawful(&steps, decomposition.sample(&steps, &mut source())),
        ),
        (
            "spectral_tracking",
            "max scheme",
            of_all(SpectralTracking::new(MaxScheme, constant(0.5)).sample(&tinted, &mut source())),
        ),
        (
            "spectral_tracking",
            "average scheme",
            of_all(SpectralTracking::new(AverageScheme, constant(0.5)).sample(&tinted, &mut source())),
        ),
        (
            "hero_wavelength",
            "hero",
            of_all(HeroWavelength::new(constant(0.5)).sample(&tinted, &mut source())),
        ),
        (
            "separate_solve",
            "separate",
            of_all(SeparateSolve::new([0.5, 0.4, 0.1].map(constant)).sample(&tinted, &mut source())),
        ),
        (
            "shared_distance",
            "shared",
            of_all(SharedDistance::new(constant(0.5)).sample(&tinted, &mut source())),
        ),
    ]
}

fn every_flight(variate: f64) -> Outcome {
    let all = (1..5).flat_map(|left| flights(variate, left));
    match all.into_iter().find(|(.., lawful)| !lawful) {
        Some((_, name, _)) => {
            Outcome::said(false, format!("{name}: no weight, or a collision where no matter is"))
        }
        None => Outcome::said(true, "finite, and a collision only where matter is"),
    }
}

/// Each once.
fn kinds(all: impl Iterator<Item = &'static str>) -> BTreeSet<&'static str> {
    all.collect()
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
                )
                .about(kinds(estimates(0.5, 1).into_iter().map(|(kind, _)| kind))),
                HardCase::deterministic(
                    14,
                    format!("the uniform variate {name} in a free flight"),
                    "free flights",
                    "finite, where matter is",
                    "finite",
                    move || every_flight(variate),
                )
                .about(kinds(flights(0.5, 1).into_iter().map(|(kind, ..)| kind))),
            ]
        })
        .collect()
}
