//! Each decision of a walk has its probability, over all of its variate.

use super::{Check, LAWFUL, check};
use crate::checks::Law;
use fairflight_collision::{Albedo, SingleOutcome, SingleParticle, Version, Woodcock as WoodcockModel};
use fairflight_freeflight::{FreeFlight, JitteredFlight, Woodcock as WoodcockFlight};
use fairflight_laws::CheckResult;
use fairflight_laws::collision::{self, RATIOS};
use fairflight_laws::exact::decisions::expectation;
use fairflight_laws::exact::{agree, greatest};
use fairflight_media::{Bounded, Bounds, Constant, Homogeneous, Line, phase::Isotropic};
use fairflight_paths::{Uniform, Walk};
use fairflight_scene::Volume;
use fairflight_sources::{LARGEST_VARIATE, Scripted};
use fairflight_transmittance::{NextFlight, NextFlightVersion, TransmittanceEstimator, Woodcock};
use glam::DVec3;

/// Rounding of a probability, and of the sum over both sides of its border.
const GRANTED: f64 = 1e-13;

/// σ_t over the majorant.
const SHARES: [f64; 5] = [0.01, 0.1, 0.37, 0.5, 0.93];
const MAJORANT: f64 = 1.7;

pub(super) fn checks() -> Vec<Check> {
    let single = |version| move |albedo| SingleParticle { version, albedo };
    vec![
        outcomes("woodcock", |albedo| WoodcockModel { albedo }),
        outcomes("terminating", single(Version::Terminating)).about(["single_particle"]),
        outcomes("non-terminating", single(Version::NonTerminating)).about(["single_particle"]),
        outcomes("adaptive", single(Version::Adaptive)).about(["single_particle"]),
        check("decision/woodcock", "woodcock", "constant", || {
            one_collision(|share, source, field| {
                let scored = |estimate: f64| (estimate, 1.0 - share);
                scored(Woodcock.estimate(&field, source))
            })
        })
        .about(["woodcock"]),
        check("decision/next flight after delta tracking", "next flight", "constant", || {
            one_collision(|share, source, field| {
                let from = |distance: f64| (-MAJORANT * distance).exp();
                let estimate = NextFlight::new(NextFlightVersion::Delta).estimate(&field, source);
                (estimate, from(1.0) + (1.0 - share) * from(1.0 - COLLISION))
            })
        })
        .about(["next_flight"]),
        check("decision/free flight by woodcock", "free flight by woodcock", "constant", || {
            one_collision(|share, source, field| {
                let flight = WoodcockFlight::new(Constant::new(MAJORANT, 1.0).expect(LAWFUL));
                let collides = flight.sample(&field, source).distance().is_some();
                (if collides { 1.0 } else { 0.0 }, share)
            })
        })
        .about(["woodcock_flight"]),
        check("decision/free flight by jittered", "free flight by jittered", "constant", jittered_flight)
            .about(["jittered_flight"]),
        check("decision/roulette of a walk", "roulette of walks", "homogeneous", roulette_of_a_walk),
    ]
}

fn outcomes<M: SingleOutcome>(name: &str, of: impl Fn(Albedo) -> M + Send + Sync + 'static) -> Check {
    Check::new(format!("collision/outcomes of {name}"), Law::Collision, name, "any", 0, move |_| {
        for a in [0.0, 0.3, 0.5, 0.9, 1.0] {
            if let Err(broken) = collision::check_outcomes(&of(Albedo::new(a).expect(LAWFUL)), &RATIOS) {
                return CheckResult::exact(false, format!("albedo {a}: {broken}"));
            }
        }
        CheckResult::exact(true, "drawn as stated at every ratio and albedo tried")
    })
}

/// Distance of the only tentative collision of a walk of length 1.
const COLLISION: f64 = 0.4;

/// A walk with one tentative collision: what `walk` makes of it, averaged over the variate of its decision, against what it should
/// be. `walk` is given σ_t over the majorant, the source, and the field, and gives both.
fn one_collision(walk: impl Fn(f64, &mut Scripted, Bounded<Constant>) -> (f64, f64)) -> CheckResult {
    let there = -(-MAJORANT * COLLISION).exp_m1();
    let worst = SHARES.map(|share| {
        let field = Constant::new(share * MAJORANT, 1.0).expect(LAWFUL);
        let field = Bounded::new(field, MAJORANT).expect(LAWFUL);
        let mut expected = f64::NAN;
        let found = expectation(|u| {
            let mut source = Scripted::new([there, u, LARGEST_VARIATE]);
            let (found, right) = walk(share, &mut source, field);
            expected = right;
            found
        });
        (found / expected - 1.0).abs()
    });
    agree(greatest(worst), GRANTED)
}

/// A flight of one stratum, its candidate beyond the tentative collision on the way to it: either decision by itself. The candidate is
/// accepted with probability h σ_t, and the flight to it survives with probability 1 − σ_t over the majorant.
fn jittered_flight() -> CheckResult {
    let majorant = 0.9;
    let there = -(-majorant * COLLISION).exp_m1();
    let deviation = |share: f64| {
        let field = Constant::new(share * majorant, 1.0).expect(LAWFUL);
        let field = Bounded::new(field, majorant).expect(LAWFUL);
        let collides = |variates: [f64; 5]| {
            let flight = JitteredFlight::new(1.0).expect(LAWFUL).sample(&field, &mut Scripted::new(variates));
            if flight.distance().is_some() { 1.0 } else { 0.0 }
        };
        // Its place, its acceptance, the flight to it, the decision there, and the rest of the flight.
        let accepted = expectation(|u| collides([0.8, u, LARGEST_VARIATE, 0.0, 0.0]));
        let survives = expectation(|u| collides([0.8, 0.0, there, u, LARGEST_VARIATE]));
        (accepted / (share * majorant) - 1.0).abs().max((survives / (1.0 - share) - 1.0).abs())
    };
    agree(greatest(SHARES.map(deviation)), GRANTED)
}

/// **Law.** Roulette below an energy changes no expectation: a walk whose first collision scatters all that is left of it, the albedo
/// a, has the mean energy a behind it (szirmay-kalos-2017 eq. 8 at r = 1).
fn roulette_of_a_walk() -> CheckResult {
    let worst = [0.5, 1.0 / 255.0, 1.0 / 257.0, 1e-3, 1e-6].map(|albedo| {
        let volume: Volume<_, _, f64> = Volume {
            medium: Homogeneous::new(1.0).expect(LAWFUL),
            bounds: Bounds::sphere(DVec3::ZERO, 20.0).expect(LAWFUL),
            albedo,
            phase: Isotropic,
        };
        let walk =
            Walk::new(Version::NonTerminating, Uniform::new(1.0).expect(LAWFUL)).with_max_collisions(1);
        let line = Line { origin: DVec3::ZERO, direction: DVec3::X };
        let found = expectation(|u| {
            // Flight, collision, roulette; a direction, and a flight to the collision that is one too many.
            let mut source = Scripted::new([0.5, 0.5, u, 0.5, 0.5, 0.5]);
            let mut energy = 0.0;
            walk.simulate(&volume, volume.inside(line), &mut source, |event, _| energy = event.energy);
            energy
        });
        (found / albedo - 1.0).abs()
    });
    agree(greatest(worst), 1e-12)
}
