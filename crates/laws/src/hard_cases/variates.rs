//! Row 14: the variates 0 and 1 − 2^-53 in every sampler.

use super::{HardCase, LAWFUL, Outcome};
use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version, Woodcock as WoodcockModel};
use fairflight_media::{Bounded, Constant, PiecewiseConstant, Vacuum};
use fairflight_sources::{LARGEST_VARIATE, UniformSource};
use fairflight_transmittance::{
    LineIntegral, Offset, RayMarching, Tracking, TransmittanceEstimator, Woodcock,
};

/// One end of the lattice for a while, then the other: a walk of flights of length 0 would never end.
struct End {
    variate: f64,
    left: u32,
}

impl UniformSource for End {
    fn next_uniform(&mut self) -> f64 {
        if self.left == 0 {
            return LARGEST_VARIATE;
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
        ];
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Outcome::said(false, format!("{value}"));
        }
    }
    Outcome::said(true, "finite in every sampler")
}

pub(super) fn cases() -> Vec<HardCase> {
    [("0", 0.0), ("1 - 2^-53", LARGEST_VARIATE)]
        .into_iter()
        .map(|(name, variate)| {
            HardCase::deterministic(
                14,
                format!("the uniform variate {name}"),
                "every sampler",
                "finite",
                "finite",
                move || every_sampler(variate),
            )
        })
        .collect()
}
