//! Mistakes with the sampling extinction.

use crate::profiles::unit_cells;
use crate::twins::trial::{judged, theory_on};
use crate::twins::{Evident, Twin};
use crate::vectors::{Seen, Vector};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::{
    Breakpoints, Extinction, InvertOpticalThickness, OpticalThickness, PiecewiseConstant, Vacuum,
};
use fairflight_transmittance::{Tracking, TransmittanceEstimator};

/// A piecewise rate that draws as it is and divides by its mean.
struct DividesByItsMean(PiecewiseConstant);

impl Extinction for DividesByItsMean {
    fn sigma_t(&self, _s: f64) -> f64 {
        self.0.optical_thickness(0.0, self.0.length()) / self.0.length() // right: the rate at s
    }
    fn length(&self) -> f64 {
        self.0.length()
    }
}

impl OpticalThickness for DividesByItsMean {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        self.0.optical_thickness(from, to)
    }
}

impl InvertOpticalThickness for DividesByItsMean {
    fn invert(&self, from: f64, depth: f64) -> Option<f64> {
        self.0.invert(from, depth)
    }
}

/// A rate that vanishes where there is something to collide with: the rate itself is the wrong line.
fn with_a_hole() -> PiecewiseConstant {
    unit_cells(&[2.0, 0.0])
}

fn tracking<R: InvertOpticalThickness>(sampling: R) -> Tracking<DoubleParticle, Vacuum, R> {
    let length = sampling.length();
    Tracking::new(DoubleParticle { albedo: Albedo::default() }, Vacuum::new(length), sampling)
}

/// Profile and rates in cells of a test vector without a control.
fn in_cells<'v>(vector: &'v Vector<'_>) -> Option<(&'v Seen, PiecewiseConstant)> {
    let is_bare = vector.numbers("/estimator/control/positions").is_empty();
    Some((vector.of("double_particle").filter(|_| is_bare)?, vector.rates("/estimator/sigma_samp")?))
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    let field = || unit_cells(&[1.0, 0.25]);
    vec![
        // Rate 2 and 0.5, mean 1.25: E = exp(−(1·2 + 0.25·0.5)/1.25) = exp(−1.7) for exp(−1.25).
        Twin::new(
            "double particle",
            "divides_by_the_mean_rate",
            "r = sigma_diff over the mean of a piecewise sigma_samp, for its value at s",
            "sigma_t 1, 0.25 (length 1 each), sigma_samp 2, 0.5",
            (50_000, Evident::Mean { z: 87.0 }),
            move |run| {
                let rate = unit_cells(&[2.0, 0.5]);
                let theory = theory_on(field(), &tracking(rate.clone()), &rate.breakpoints());
                judged(&field(), &tracking(DividesByItsMean(rate)), theory, run)
            },
        )
        .answers(|vector, source| {
            let (field, rates) = in_cells(vector)?;
            Some(tracking(DividesByItsMean(rates)).estimate(field, source).into())
        }),
        // E = exp(−1) for exp(−1.25); its variance is that of the first cell, exp(0.5) − 1.
        Twin::new(
            "double particle",
            "rate_with_a_hole",
            "sigma_samp = 0 where sigma_t is not: silently no collision there",
            "sigma_t 1, 0.25 (length 1 each), sigma_samp 2, 0",
            (50_000, Evident::Mean { z: 78.8 }),
            move |run| {
                let twin = tracking(with_a_hole());
                let theory = theory_on(field(), &twin, &with_a_hole().breakpoints());
                judged(&field(), &twin, theory, run)
            },
        )
        .answers(|vector, source| {
            let (field, _) = in_cells(vector)?;
            let edges = vector.numbers("/estimator/sigma_samp/edges");
            let mut values = vector.numbers("/estimator/sigma_samp/values");
            *values.last_mut()? = 0.0;
            let hole = PiecewiseConstant::new(edges, values).ok()?;
            Some(tracking(hole).estimate(field, source).into())
        }),
    ]
}
