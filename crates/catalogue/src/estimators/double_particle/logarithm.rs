//! −log(u): infinite at u = 0 (raab-2008 algorithm 1 as printed).

use crate::profiles::constant;
use crate::twins::{Evident, Rejection, Twin};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::Vacuum;
use fairflight_sources::{Scripted, UniformSource};
use fairflight_transmittance::{Tracking, TransmittanceEstimator};

/// A source that takes the logarithm of the variate itself.
struct Printed<S>(S);

impl<S: UniformSource> UniformSource for Printed<S> {
    fn next_uniform(&mut self) -> f64 {
        self.0.next_uniform()
    }
    fn next_exponential(&mut self) -> f64 {
        -self.next_uniform().ln() // right: −ln(1 − u)
    }
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    vec![
        Twin::new(
            "woodcock",
            "logarithm_of_zero",
            "−log(rand()) for −ln(1 − rand()): infinite at the variate 0 (raab-2008 algorithm 1 as printed)",
            "sigma_t = sigma_samp = 1, length 1, variate 0",
            (0, Evident::Exactly),
            |_| {
                let field = constant(1.0, 1.0);
                let model = DoubleParticle { albedo: Albedo::default() };
                let estimator = Tracking::new(model, Vacuum::new(1.0), field);
                // The variate 0 is the shortest flight, which collides at once and absorbs all; printed, it is the longest.
                let ours = estimator.estimate(&field, &mut Scripted::new([0.0, 0.75]));
                let twin = estimator.estimate(&field, &mut Printed(Scripted::new([0.0])));
                let depth = Printed(Scripted::new([0.0])).next_exponential();
                let rejected = depth.is_infinite() && (ours, twin) == (0.0, 1.0);
                Rejection::exact(
                    rejected,
                    format!("an optical distance of {depth}; the walk scores {twin} for {ours}"),
                )
            },
        )
        .answers(|vector, source| {
            let (field, sampling, control) = vector.tracked("double_particle")?;
            let model = DoubleParticle { albedo: Albedo::default() };
            Some(Tracking::new(model, control, sampling).estimate(field, &mut Printed(source)).into())
        }),
    ]
}
