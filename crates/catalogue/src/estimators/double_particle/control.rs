//! Mistakes with the control.

use crate::checks::LAWFUL;
use crate::profiles::constant;
use crate::twins::trial::{Misstated, Pretending, Wrong, judged, theory_on};
use crate::twins::{Evident, Twin};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::{
    Breakpoints, Constant, Extinction, InvertOpticalThickness, OpticalThickness, PiecewiseConstant,
    PiecewiseLinear,
};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{Explorers, Tracking, TransmittanceEstimator};

fn double_particle() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::default() }
}

/// Fits its control to the points of its own walk.
struct FitsItsOwnWalk {
    sampling: Constant,
}

impl<F: Extinction> Wrong<F> for FitsItsOwnWalk {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let mut points = vec![0.0];
        while let Some(s) = self.sampling.invert(points[points.len() - 1], source.next_exponential()) {
            points.push(s);
        }
        points.push(field.length());
        points.dedup();
        let values = points.iter().map(|&s| field.sigma_t(s)).collect();
        // right: points that know nothing of the walk
        let control = PiecewiseLinear::new(points.clone(), values).expect("increasing and finite");
        let walk = &points[1..points.len() - 1];
        let weights =
            walk.iter().map(|&s| 1.0 - (field.sigma_t(s) - control.sigma_t(s)) / self.sampling.sigma_t(s));
        weights.product::<f64>() * (-control.optical_thickness(0.0, field.length())).exp()
    }
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    vec![
        // E = T / T_main = e^{0.5·4} T on the steps below.
        Twin::new(
            "double particle",
            "without_the_control_s_transmittance",
            "T = 1 for T = T_main(S): the control subtracted but not multiplied",
            "sigma_t 1, 0.2, 0.6 (lengths 1, 1.5, 1.5), control 0.5, sigma_samp 2",
            (20_000, Evident::Mean { z: 1920.0 }),
            |run| {
                let field =
                    PiecewiseConstant::new(vec![0.0, 1.0, 2.5, 4.0], vec![1.0, 0.2, 0.6]).expect(LAWFUL);
                let control = constant(0.5, 4.0);
                let sampling = constant(2.0, 4.0);
                let right = Tracking::new(double_particle(), control, sampling);
                let theory = theory_on(&field, &right, &[]);
                // Right: the thickness of the control.
                let control = Misstated { field: control, thickness: |_, _, _| 0.0 };
                let twin = Tracking::new(double_particle(), control, sampling);
                judged(&field, &twin, theory, run)
            },
        )
        .answers(|vector, source| {
            let (field, sampling, control) = vector.tracked("double_particle")?;
            let control = Misstated { field: control, thickness: |_, _, _| 0.0 };
            Some(Tracking::new(double_particle(), control, sampling).estimate(field, source).into())
        }),
        // Every r is zero: the estimate is exp(−τ of the fit), wherever the points fell. The z is measured.
        Twin::new(
            "double particle, explorers",
            "fits_its_own_walk",
            "the interaction points of the walk used as its explorer points (warned of in errata)",
            "a tent from 0 over 2 to 0, length 3, sigma_samp 2",
            (50_000, Evident::Mean { z: 465.0 }),
            |run| {
                let field = PiecewiseLinear::new(vec![0.0, 1.5, 3.0], vec![0.0, 2.0, 0.0]).expect(LAWFUL);
                let sampling = constant(2.0, 3.0);
                let control = Explorers::through(&field, 4).expect(LAWFUL);
                let also = control.breakpoints();
                let right = Tracking::new(double_particle(), control, sampling);
                let theory = theory_on(&field, &right, &also);
                judged(&field, &Pretending(&FitsItsOwnWalk { sampling }), theory, run)
            },
        )
        .answers(|vector, source| {
            let (field, sampling, _) = vector.tracked("double_particle")?;
            Some(FitsItsOwnWalk { sampling }.draw(field, source).into())
        }),
    ]
}
