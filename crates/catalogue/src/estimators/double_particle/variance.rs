//! A wrong closed form: the estimator is right, its theory is not. The test of the variance must say so.

use crate::profiles::{constant, unit_cells};
use crate::twins::trial::{judged, theory_on};
use crate::twins::{Evident, Twin};
use fairflight_collision::{Albedo, CollisionModel, DoubleParticle};
use fairflight_media::{PiecewiseConstant, RayQuadrature, Tolerance};
use fairflight_transmittance::{ProductLaw, Theory, Tracking};

/// szirmay-kalos-2017 eq. 16 and 17 with σ_t in the place of σ_diff: w is made of the whole extinction although a control has taken its part.
fn of_the_whole_extinction(
    field: &PiecewiseConstant,
    model: DoubleParticle,
    sampling: f64,
    right: Theory,
) -> Theory {
    let mut quadrature = RayQuadrature::new(field, &[]);
    let collisions = quadrature.integrate(Tolerance::TIGHT, |_, sigma_t| {
        let branch = model.transmitted(sigma_t / sampling); // right: (sigma_t − sigma_main) / sigma_samp
        std::array::from_fn(|i| sampling * branch.moment_about_one(i as i32 + 2))
    });
    let law = ProductLaw::new(collisions.value);
    Theory {
        relative_central: law.relative_central(),
        log_relative_variance: law.log_relative_variance(),
        ..right
    }
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    vec![
        Twin::new(
            "double particle",
            "variance_of_the_whole_extinction",
            "eq. 16 with sigma_t for sigma_diff: the control forgotten in the variance",
            "sigma_t 1, 0.5 (length 1 each), control 0.5, sigma_samp 8",
            (400_000, Evident::Variance { z: 288.0 }),
            |run| {
                let field = unit_cells(&[1.0, 0.5]);
                let (control, sampling) =
                    (constant(0.5, 2.0), constant(8.0, 2.0));
                let model = DoubleParticle { albedo: Albedo::default() };
                let estimator = Tracking::new(model, control, sampling);
                let right = theory_on(&field, &estimator, &[]);
                let wrong = of_the_whole_extinction(&field, model, 8.0, right);
                judged(&field, &estimator, wrong, run)
            },
        ),
    ]
}
