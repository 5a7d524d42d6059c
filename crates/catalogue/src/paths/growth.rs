//! The growth of the squared energy per collision, where it has a closed form.

use fairflight_collision::Version;
use fairflight_laws::CheckResult;
use fairflight_media::phase::Isotropic;
use fairflight_media::{Bounds, Homogeneous};
use fairflight_paths::{Criticality, Uniform, Walk, second_moment_growth};
use fairflight_scene::Volume;
use fairflight_sources::Seeded;
use glam::DVec3;

/// E\[W²\] of all that leaves a collision at the ratio `r`, for the albedo `a`, above 1 for a gain: eq. 9 and 12 of szirmay-kalos-2017, and
/// the rule of SimulateParticle for the adaptive version, with a gain left to the energies.
#[must_use]
pub fn expected(version: Version, a: f64, r: f64) -> f64 {
    let (probability, gain) = (a.min(1.0), a.max(1.0));
    let (scattered, transmitted) = (probability * r.abs(), (1.0 - r).abs());
    let sum = scattered + transmitted;
    let kept = match version {
        Version::Terminating => 1.0,
        Version::NonTerminating => sum,
        Version::Adaptive => {
            if r < 1.0 || sum > 1.0 {
                sum
            } else {
                1.0
            }
        }
    };
    // Probability · energy²: (q/kept) · kept² for either branch, and the gain squared where light is scattered.
    kept * (gain * gain * scattered + transmitted)
}

/// **Law.** In an endless homogeneous medium every collision multiplies the expected squared energy by the same number: the measured
/// factor is that number, without a standard error, and the criticality follows from it.
///
/// **Premise.** Nobody leaves. The medium here ends after 1e30 mean free paths, where a flight of 40 is lost in the rounding of a
/// position: all collisions of a particle are where it starts. Only one that starts within a few roundings of the surface, a share
/// of 3 · 1e-14 of the ball, may be taken for gone: of 4096 particles any with a probability of 1.2e-10.
#[must_use]
pub fn check(version: Version, albedo: f64, r: f64, seed: u64) -> CheckResult {
    let (Ok(medium), Ok(bounds), Ok(sampling)) =
        (Homogeneous::new(r), Bounds::sphere(DVec3::ZERO, 1e30), Uniform::new(1.0))
    else {
        return CheckResult::exact(false, "refused: no number");
    };
    let volume = Volume { medium, bounds, albedo, phase: Isotropic };
    let Some(growth) = second_moment_growth(&volume, &Walk::new(version, sampling), &mut Seeded::new(seed))
    else {
        return CheckResult::exact(false, "no collision");
    };
    let expected = expected(version, albedo, r);
    let deviation = (growth.factor - expected).abs();
    // 512 sums of 512 terms round by less.
    let granted = 1e-12 * expected;
    let criticality = if expected < 1.0 { Criticality::Subcritical } else { Criticality::Supercritical };
    let judged = (expected - 1.0).abs() < granted || growth.criticality() == criticality;
    CheckResult {
        detectable_relative_bias: Some(2e-12),
        ..CheckResult::exact(
            deviation <= granted && judged,
            format!("factor {} for {expected}, {:?}", growth.factor, growth.criticality()),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_critical_sphere_is_critical() {
        // One-speed neutrons with 1.3 secondaries per collision are critical in a sphere of 2.42482 mean free paths (sood-2003,
        // problem Ua-1-0-SP): with one secondary, 1/1.3 of them meet another collision. r = 1 scatters without a weight.
        let volume = Volume {
            medium: Homogeneous::new(1.0).unwrap(),
            bounds: Bounds::sphere(DVec3::ZERO, 2.424_824_980_2).unwrap(),
            albedo: 1.0,
            phase: Isotropic,
        };
        let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap());
        let runs = 25;
        let factors: Vec<f64> = (0..runs)
            .map(|seed| second_moment_growth(&volume, &walk, &mut Seeded::new(seed)).unwrap().factor)
            .collect();
        let mean = factors.iter().sum::<f64>() / runs as f64;
        let variance = factors.iter().map(|f| (f - mean) * (f - mean)).sum::<f64>() / (runs - 1) as f64;
        let error = (variance / runs as f64).sqrt();
        // Student's t of 24 degrees of freedom at 1e-6, and the population's own bias of the order of its reciprocal.
        assert!((mean - 1.0 / 1.3).abs() < 6.5 * error + 1e-3, "{mean} +- {error} for {}", 1.0 / 1.3);
        assert!(error < 1e-3, "{error}");
    }
}
