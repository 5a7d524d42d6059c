//! Mistakes in the weight of one collision, each in one line of a collision model or of the walk.

use super::trial::{LAWFUL, judged, theory_on};
use super::{Evident, Rejection, Twin};
use fairflight_collision::{Albedo, Branch, CollisionModel, DoubleParticle, SingleParticle, Version};
use fairflight_laws::{Run, collision};
use fairflight_media::{Constant, Extinction, Vacuum};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{SignedProduct, Tracking, TransmittanceEstimator};

fn right() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::default() }
}

/// A double particle model of which only the drawn weight is wrong.
#[derive(Clone, Copy)]
struct WrongWeight(fn(f64) -> f64);

impl CollisionModel for WrongWeight {
    fn admits(&self, r: f64) -> bool {
        right().admits(r)
    }
    fn scattered(&self, r: f64) -> Branch {
        right().scattered(r)
    }
    fn transmitted(&self, r: f64) -> Branch {
        right().transmitted(r)
    }
    fn transmit(&self, r: f64, _source: &mut impl UniformSource) -> Option<f64> {
        Some((self.0)(r)) // right: Some(1 − r)
    }
}

/// The loop runs while E > 0 instead of while |E| > 0.
struct StopsBelowZero {
    model: SingleParticle,
    sampling: Constant,
}

impl<F: Extinction> TransmittanceEstimator<F> for StopsBelowZero {
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        use fairflight_media::InvertOpticalThickness;
        let mut weight = SignedProduct::ONE;
        let mut s = 0.0;
        while let Some(next) = self.sampling.invert(s, source.next_exponential()) {
            s = next;
            let Some(energy) = self.model.transmit(field.sigma_t(s) / self.sampling.sigma_t(s), source)
            else {
                return 0.0;
            };
            weight.multiply(energy);
            if weight.sign() <= 0.0 {
                return 0.0; // right: go on with a negative weight
            }
        }
        weight.times_exp(0.0)
    }
    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

/// σ_t = 1 on a length of 2, as in hard case 3.
fn field() -> Constant {
    Constant::new(1.0, 2.0).expect(LAWFUL)
}

fn wrong_weight(weight: fn(f64) -> f64, sampling: f64, run: Run) -> Rejection {
    // r = 1/σ_samp: the exact law of collisions sees it too.
    let model = WrongWeight(weight);
    let exact = collision::check(&model, 0.0, &[1.0 / sampling]);
    let sampling = Constant::new(sampling, 2.0).expect(LAWFUL);
    let theory = theory_on(field(), &Tracking::new(right(), Vacuum::new(2.0), sampling), &[]);
    let rejection = judged(&field(), &Tracking::new(model, Vacuum::new(2.0), sampling), theory, run);
    Rejection { rejected: rejection.rejected && exact.is_err(), ..rejection }
}

fn single(version: Version, albedo: f64) -> SingleParticle {
    SingleParticle { version, albedo: Albedo::new(albedo).expect(LAWFUL) }
}

/// The terminating version judged as the non-terminating one, which admits every r.
fn outside_the_terminating_domain(sigma_t: f64, length: f64, sampling: f64, run: Run) -> Rejection {
    let field = Constant::new(sigma_t, length).expect(LAWFUL);
    let sampling = Constant::new(sampling, length).expect(LAWFUL);
    let of = |version| Tracking::new(single(version, 0.0), Vacuum::new(length), sampling);
    let theory = theory_on(field, &of(Version::NonTerminating), &[]);
    let refused = !TransmittanceEstimator::admits(&of(Version::Terminating), &field, 0.0, sigma_t);
    let rejection = judged(&field, &of(Version::Terminating), theory, run);
    // A watched run refuses it before any statistics.
    Rejection { rejected: rejection.rejected && refused, ..rejection }
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
        ).about(["double_particle"]),
        // E = exp(−σ_samp L) where r > 1: exp(−1.5) for exp(−2).
        Twin::new(
            "double particle",
            "clamped_weight",
            "weight max(0, 1 − r): a negative weight clamped (renderers that take sigma_samp for a majorant)",
            "sigma_t 1, length 2, sigma_samp 3/4",
            (50_000, Evident::Mean { z: 39.6 }),
            |run| wrong_weight(|r| (1.0 - r).max(0.0), 0.75, run),
        ).about(["double_particle"]),
        // |1 − r| = 1.5 is no probability: the weight is −1 for sure, E = exp(−2 · 0.2) for exp(−0.5). Judged with the
        // moments of the version that is defined there, Var/T² = exp(0.2 · 2.5²) − 1 = 2.49.
        Twin::new(
            "single particle",
            "terminating_above_its_domain",
            "the terminating version at r = 2.5 > 2/(1 + a): |1 − r| taken for a probability",
            "sigma_t 1, length 0.5, sigma_samp 0.4, albedo 0",
            (200_000, Evident::Mean { z: 29.8 }),
            |run| outside_the_terminating_domain(1.0, 0.5, 0.4, run),
        ).about(["single_particle"]),
        // E = 1, what a renderer makes of hard case 5, for e; Var/T² = exp(4 · 0.25²) − 1 = 0.284.
        Twin::new(
            "single particle",
            "terminating_below_its_domain",
            "the terminating version at r < 0: negative extinction ignored (hard case 5: 1.0 for 2.718)",
            "sigma_t −0.5, length 2, sigma_samp 2, albedo 0",
            (50_000, Evident::Mean { z: 265.0 }),
            |run| outside_the_terminating_domain(-0.5, 2.0, 2.0, run),
        ).about(["single_particle"]),
        // a = 0.5, r = 1.25: only walks without a collision survive, E = exp(−1.6) for exp(−2).
        Twin::new(
            "single particle",
            "stops_below_zero",
            "while E > 0 for while |E| > 0: the walk ends at a negative weight (bars lost in SimulateParticle, errata)",
            "sigma_t 1, length 2, sigma_samp 0.8, albedo 0.5",
            (50_000, Evident::Mean { z: 28.7 }),
            |run| {
                let sampling = Constant::new(0.8, 2.0).expect(LAWFUL);
                let model = single(Version::NonTerminating, 0.5);
                let theory = theory_on(field(), &Tracking::new(model, Vacuum::new(2.0), sampling), &[]);
                judged(&field(), &StopsBelowZero { model, sampling }, theory, run)
            },
        ).about(["single_particle"]),
    ]
}
