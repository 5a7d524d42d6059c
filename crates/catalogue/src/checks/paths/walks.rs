//! Bounds of a walk: its greatest number of collisions, and the growth of its squared energy.

use super::{Check, LAWFUL, radiance};
use crate::checks::Law;
use crate::paths::{growth, judge_estimates};
use fairflight_collision::Version;
use fairflight_media::phase::Isotropic;
use fairflight_media::{Bounds, Homogeneous, Line};
use fairflight_paths::{Integrator, ParticleTracer, Uniform, Walk};
use fairflight_scene::{Background, Lights, Volume};
use fairflight_sources::Seeded;
use fairflight_stats::{Reference, Scores};
use glam::DVec3;

/// Both.
pub(super) fn checks() -> Vec<Check> {
    let mut checks = vec![truncation(true), truncation(false)];
    // Below, at and above 2/(1 + a) = 1.11, where the non-terminating version is critical.
    for r in [0.0, 0.4, 1.0, 1.05, 1.1, 1.15, 1.6, -0.5] {
        checks.push(growing(Version::NonTerminating, "non_terminating", 0.8, r));
        checks.push(growing(Version::Adaptive, "adaptive", 0.8, r));
    }
    for r in [0.0, 0.4, 1.0, 1.1] {
        checks.push(growing(Version::Terminating, "terminating", 0.8, r));
    }
    checks.push(growing(Version::NonTerminating, "non_terminating", 1.0, 0.7));
    checks.push(growing(Version::NonTerminating, "non_terminating", 1.3, 0.6));
    checks
}

fn growing(version: Version, name: &str, albedo: f64, r: f64) -> Check {
    let id = format!("paths/growth/{name} albedo {albedo} r {r}");
    Check::new(id, Law::Growth, format!("walks, {name}"), "endless", 0, move |run| {
        growth::check(version, albedo, r, run.seed)
    })
}

/// No collision is allowed: a walk along τ = 1.4 is cut with probability 1 − exp(−1.4 σ_samp/σ_t) and counted, else it sees the
/// background.
fn truncation(counted: bool) -> Check {
    let (name, rate, length) = (if counted { "counted" } else { "missing" }, 1.2, 1.4);
    radiance(format!("truncation/{name}"), "importons, cut", "homogeneous", 150_000, move |run| {
        let volume = Volume {
            medium: Homogeneous::new(1.0).expect(LAWFUL),
            bounds: Bounds::sphere(DVec3::ZERO, 0.5 * length).expect(LAWFUL),
            albedo: 0.8,
            phase: Isotropic,
        };
        let lights =
            Lights { background: Background { constant: 1.0, maps: Vec::new() }, sources: Vec::new() };
        let walk =
            Walk::new(Version::NonTerminating, Uniform::new(rate).expect(LAWFUL)).with_max_collisions(0);
        let mut tracer = ParticleTracer::new(&volume, &lights, walk);
        let line = Line { origin: DVec3::new(0.0, 0.0, -3.0), direction: DVec3::Z };
        let estimate = |source: &mut Seeded| {
            let before = tracer.truncated();
            let radiance: f64 = tracer.radiance(&line, source);
            if counted { (tracer.truncated() - before) as f64 } else { radiance }
        };
        let passes = (-rate * length).exp();
        let mean = if counted { 1.0 - passes } else { passes };
        let scores = Scores::TwoValued { high: 1.0 };
        judge_estimates(estimate, &Reference { scores, ..Reference::exact(mean) }, run)
    })
    .about(["particle_tracer"])
}
