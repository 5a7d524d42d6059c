//! Mistakes in the weight of one collision, each in one line of a collision model or of the walk.

use crate::profiles::constant;
use crate::twins::trial::{judged, theory_on};
use crate::twins::{Evident, Rejection, Twin};
use crate::vectors::{Answer, Variates, Vector};
use fairflight_collision::{Albedo, Branch, CollisionModel, DoubleParticle};
use fairflight_laws::{Run, collision};
use fairflight_media::{Constant, Vacuum};
use fairflight_transmittance::{Tracking, TransmittanceEstimator};

fn right() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::default() }
}

/// A double particle model of which only the drawn weight is wrong.
#[derive(Clone, Copy)]
struct WrongWeight(fn(f64) -> f64);

impl CollisionModel for WrongWeight {
    const DRAWS: bool = false;

    fn admits(&self, r: f64) -> bool {
        right().admits(r)
    }
    fn scattered(&self, r: f64) -> Branch {
        right().scattered(r)
    }
    fn transmitted(&self, r: f64) -> Branch {
        right().transmitted(r)
    }
    fn transmit_by(&self, r: f64, _u: f64) -> Option<f64> {
        Some((self.0)(r)) // right: Some(1 − r)
    }
}

/// σ_t = 1 on a length of 2, as in hard case 3.
fn field() -> Constant {
    constant(1.0, 2.0)
}

fn wrong_weight(weight: fn(f64) -> f64, sampling: f64, run: Run) -> Rejection {
    // r = 1/σ_samp: the exact law of collisions sees it too.
    let model = WrongWeight(weight);
    let exact = collision::check(&model, 0.0, &[1.0 / sampling]);
    let sampling = constant(sampling, 2.0);
    let theory = theory_on(field(), &Tracking::new(right(), Vacuum::new(2.0), sampling), &[]);
    let rejection = judged(&field(), &Tracking::new(model, Vacuum::new(2.0), sampling), theory, run);
    Rejection { rejected: rejection.rejected && exact.is_err(), ..rejection }
}

/// The same on a test vector.
fn answered(weight: fn(f64) -> f64, vector: &Vector<'_>, source: &mut Variates<'_>) -> Option<Answer> {
    let (field, sampling, control) = vector.tracked("double_particle")?;
    Some(Tracking::new(WrongWeight(weight), control, sampling).estimate(field, source).into())
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    vec![
        // r = 4/3: E = exp(σ_samp L (|1 − r| − 1)) = exp(−1) for exp(−2); Var/T² = exp(8/3) − 1 = 13.4.
        Twin::new(
            "double particle",
            "absolute_weight",
            "weight |1 − r| for 1 − r: the sign of E_tran lost (as in the extracted SimulateParticle, errata)",
            "sigma_t 1, length 2, sigma_samp 3/4",
            (50_000, Evident::Mean { z: 105.0 }),
            |run| wrong_weight(|r| (1.0 - r).abs(), 0.75, run),
        )
        .answers(|vector, source| answered(|r| (1.0 - r).abs(), vector, source)),
        // E = exp(−σ_samp L) where r > 1: exp(−1.5) for exp(−2).
        Twin::new(
            "double particle",
            "clamped_weight",
            "weight max(0, 1 − r): a negative weight clamped (renderers that take sigma_samp for a majorant)",
            "sigma_t 1, length 2, sigma_samp 3/4",
            (50_000, Evident::Mean { z: 39.6 }),
            |run| wrong_weight(|r| (1.0 - r).max(0.0), 0.75, run),
        )
        .answers(|vector, source| answered(|r| (1.0 - r).max(0.0), vector, source)),
    ]
}
