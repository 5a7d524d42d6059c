//! Plane-parallel slabs: all orders of scattering against the doubling method.

use super::{Check, LAWFUL, radiance, result};
use crate::checks::Law;
use crate::paths::doubling::{Lit, Slab};
use crate::paths::{check, judge_estimates, slab};
use fairflight_collision::Version;
use fairflight_laws::scores::NEVER_NEGATIVE;
use fairflight_laws::{CheckResult, Run};
use fairflight_media::phase::{HenyeyGreenstein, Isotropic, Rayleigh};
use fairflight_media::{Line, PhaseFunction};
use fairflight_paths::{Grid, Integrator, LineSplitting, ParticleTracer, SamplingExtinction, Uniform, Walk};
use fairflight_sources::Seeded;
use fairflight_stats::{Reference, Scores};
use fairflight_transmittance::{LineIntegral, Starts};
use glam::DVec3;

/// N of a quick run ([`super`]): more where light comes back rarely, or with many energies.
const SAMPLES: u64 = 200_000;
const MORE: u64 = 500_000;
const MOST: u64 = 1_000_000;

/// A slab, its light, and the side from which it is seen.
#[derive(Clone, Copy)]
struct View {
    optical_thickness: f64,
    albedo: f64,
    lit: Lit,
    reflected: bool,
}

impl View {
    fn new(optical_thickness: f64, albedo: f64, lit: Lit, reflected: bool) -> Self {
        Self { optical_thickness, albedo, lit, reflected }
    }

    fn line(&self) -> Line {
        slab::line(self.lit, self.reflected, self.optical_thickness)
    }

    /// Scores of a walk at a rate of at least `lowest` in the extinction 1 of a slab. From 1 on no energy is negative, and none
    /// exceeds that of before but by a gain: a walk that is lit or not, by a radiance of 1, scores between 0 and 1, and one of
    /// energy 1 has two values.
    fn scores(&self, version: Version, lowest: f64) -> Scores {
        let is_lit_or_not = self.lit == Lit::Diffusely && self.albedo <= 1.0;
        match version {
            _ if lowest < 1.0 => Scores::Unbounded,
            Version::Terminating if is_lit_or_not => Scores::TwoValued { high: 1.0 },
            _ if is_lit_or_not => Scores::Bounded { minimum: 0.0, maximum: 1.0 },
            _ => NEVER_NEGATIVE,
        }
    }

    /// The doubling method's answer, with its error and the bound of what the sides of the box change.
    fn reference<P: PhaseFunction>(&self, phase: &P, legendre: &[f64], scores: Scores) -> Reference {
        let Self { optical_thickness, albedo, lit, reflected } = *self;
        let response = Slab { optical_thickness, albedo, legendre: legendre.to_vec() }.respond(lit);
        let mean = if reflected { response.reflected } else { response.transmitted };
        let error = response.error + slab::sideways(optical_thickness, albedo, phase);
        Reference { error, scores, ..Reference::exact(mean) }
    }

    fn name(&self) -> String {
        let light = match self.lit {
            Lit::Diffusely => "diffuse",
            Lit::Normally => "normal",
        };
        let side = if self.reflected { "reflected" } else { "transmitted" };
        format!("tau {} albedo {} {light} {side}", self.optical_thickness, self.albedo)
    }
}

/// All slabs.
pub(super) fn checks() -> Vec<Check> {
    let isotropic = vec![1.0];
    let rayleigh = vec![1.0, 0.0, 0.5];
    // The terms that 16 nodes in either half space integrate exactly; the first one left out is 1e-8.
    let forward: Vec<f64> = (0..31).map(|l| f64::from(2 * l + 1) * 0.5_f64.powi(l)).collect();
    let henyey_greenstein = HenyeyGreenstein::new(0.5).expect(LAWFUL);
    let walk = |version, sigma_samp| Walk::new(version, Uniform::new(sigma_samp).expect(LAWFUL));
    use Lit::{Diffusely, Normally};
    use Version::{Adaptive, NonTerminating, Terminating};

    let mut checks = Vec::new();
    // r = 1, 1/2, and above 1 where the walk bears it: 2/(1 + 0.3) = 1.54.
    for (view, walk, samples) in [
        (View::new(1.0, 0.3, Diffusely, false), walk(Terminating, 1.0 / 1.5), SAMPLES),
        (View::new(1.0, 0.3, Normally, true), walk(NonTerminating, 1.0 / 1.5), 3 * SAMPLES),
        (View::new(1.0, 0.9, Diffusely, true), walk(Adaptive, 1.0 / 1.05), SAMPLES),
        (View::new(1.0, 0.9, Normally, false), walk(Terminating, 2.0), MORE),
        (View::new(1.0, 0.999, Diffusely, true), walk(NonTerminating, 2.0), SAMPLES),
        (View::new(5.0, 0.3, Diffusely, true), walk(NonTerminating, 2.0), MOST),
        (View::new(5.0, 0.9, Diffusely, true), walk(Adaptive, 1.0), SAMPLES),
        (View::new(5.0, 0.9, Normally, true), walk(NonTerminating, 1.0), SAMPLES),
        (View::new(5.0, 0.999, Diffusely, false), walk(Terminating, 1.0), SAMPLES),
    ] {
        checks.push(importons("isotropic", (view, samples), Isotropic, &isotropic, walk));
    }
    for (view, walk, samples) in [
        (View::new(1.0, 0.3, Normally, true), walk(Adaptive, 1.0 / 1.3), 2 * SAMPLES),
        (View::new(1.0, 0.9, Normally, true), walk(NonTerminating, 2.0), SAMPLES),
        (View::new(1.0, 0.999, Diffusely, false), walk(Terminating, 1.0), SAMPLES),
        (View::new(5.0, 0.9, Diffusely, true), walk(NonTerminating, 1.0), SAMPLES),
        (View::new(5.0, 0.999, Diffusely, true), walk(Adaptive, 2.0), SAMPLES),
    ] {
        checks.push(importons("rayleigh", (view, samples), Rayleigh, &rayleigh, walk));
    }
    for (view, walk, samples) in [
        (View::new(1.0, 0.9, Normally, true), walk(NonTerminating, 1.0), MOST),
        (View::new(1.0, 0.9, Diffusely, true), walk(Terminating, 2.0), 2 * SAMPLES),
    ] {
        checks.push(importons("henyey_greenstein", (view, samples), henyey_greenstein, &forward, walk));
    }
    checks.push(in_layers(View::new(1.0, 0.9, Diffusely, false)));
    // A gain: 1.2 is scattered for each 1 that is met, and no more than a share of it stays.
    let view = View::new(0.3, 1.2, Diffusely, true);
    checks.push(importons("isotropic gain", (view, MOST), Isotropic, &isotropic, walk(NonTerminating, 1.0)));
    for (starts, name) in [(Starts::Equidistant, "equidistant"), (Starts::Independent, "independent")] {
        checks.push(splitting(name, View::new(1.0, 0.9, Diffusely, true), starts));
        checks.push(splitting(name, View::new(5.0, 0.9, Diffusely, true), starts));
    }
    checks.push(coloured(Diffusely));
    checks.push(coloured(Normally));
    checks
}

fn importons<P, R>(
    phase_name: &str,
    (view, samples): (View, u64),
    phase: P,
    legendre: &[f64],
    walk: Walk<R>,
) -> Check
where
    P: PhaseFunction + Copy + Send + Sync + 'static,
    R: SamplingExtinction + Clone + Send + Sync + 'static,
{
    let (version, rate) = (walk.version(), walk.sampling().highest());
    let id = format!("slab/{} {phase_name}, {version:?} at {rate:.2}", view.name());
    let legendre = legendre.to_vec();
    let scores = view.scores(version, walk.sampling().lowest());
    radiance(id, format!("importons, {version:?}"), "slab", samples, move |run| {
        let volume = slab::volume(view.optical_thickness, view.albedo, phase).expect(LAWFUL);
        let lights = slab::lights(view.lit).expect(LAWFUL);
        let mut tracer = ParticleTracer::new(&volume, &lights, walk.clone());
        check(&mut tracer, &[view.line()], &view.reference(&phase, &legendre, scores), run)
    })
    .about(["particle_tracer"])
}

/// Sampled at the rates of eight layers, some above and some below the extinction.
fn in_layers(view: View) -> Check {
    let volume = slab::volume(view.optical_thickness, view.albedo, Isotropic).expect(LAWFUL);
    let rates = vec![2.0, 0.95, 1.0, 1.7, 0.97, 3.0, 1.2, 0.95];
    let grid = Grid::new(&volume.bounds, [1, 8, 1], rates).expect(LAWFUL);
    let walk = Walk::new(Version::Adaptive, grid);
    importons("isotropic grid", (view, SAMPLES), Isotropic, &[1.0], walk)
}

fn splitting(name: &str, view: View, starts: Starts) -> Check {
    let id = format!("slab/{} splitting {name}", view.name());
    radiance(id, "splitting by algorithm 2", "slab", SAMPLES / 4, move |run| {
        let volume = slab::volume(view.optical_thickness, view.albedo, Isotropic).expect(LAWFUL);
        let lights = slab::lights(view.lit).expect(LAWFUL);
        let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).expect(LAWFUL));
        let line = LineIntegral::new(4).expect(LAWFUL);
        let mut tracer = LineSplitting::new(&volume, &lights, walk, (line, starts, 1.5));
        check(&mut tracer, &[view.line()], &view.reference(&Isotropic, &[1.0], NEVER_NEGATIVE), run)
    })
    .about(["line_splitting", "line_integral"])
}

/// Each channel of a colour is the gray slab of its own albedo. One run, three verdicts.
fn coloured(lit: Lit) -> Check {
    const ALBEDO: DVec3 = DVec3::new(0.9, 0.6, 0.999);
    let view = move |albedo| View::new(1.0, albedo, lit, true);
    let id = format!("paths/slab/{} coloured", view(0.999).name());
    Check::new(id, Law::Radiance, "importons in colour", "slab", MORE, move |run| {
        let volume = slab::volume(1.0, ALBEDO, Isotropic).expect(LAWFUL);
        let lights = slab::lights(lit).expect(LAWFUL);
        let walk = Walk::new(Version::NonTerminating, Uniform::new(1.5).expect(LAWFUL));
        let share = Run { alpha: run.alpha / 3.0, ..run };
        let channels = [(0, "first"), (1, "second"), (2, "third")].map(|(channel, name)| {
            let mut tracer = ParticleTracer::new(&volume, &lights, walk);
            let (view, line) = (view(ALBEDO[channel]), view(1.0).line());
            let estimate = |source: &mut Seeded| -> f64 { tracer.radiance(&line, source)[channel] };
            let verdict =
                judge_estimates(estimate, &view.reference(&Isotropic, &[1.0], NEVER_NEGATIVE), share);
            (name, result(&verdict, run))
        });
        CheckResult::of_all(channels)
    })
    .about(["particle_tracer"])
}
