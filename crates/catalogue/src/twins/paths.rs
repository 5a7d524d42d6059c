//! Mistakes in walks through space and in single scattering along a ray.
//!
//! The mean of each is derived: a twin counts as rejected if the law of the right one rejects it, and its own mean does not.
//! A walk in space has no closed variance, so that the z that a twin states is measured. What rejects a twin is the range of the right
//! estimates, derived beside each: it bounds what a sample can lack.

use super::trial::{LAWFUL, judged, theory_on};
use super::{Evident, Rejection, Twin};
use crate::paths::doubling::{Lit, Slab};
use crate::paths::{single_scattering, slab};
use crate::vectors::Answer;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_laws::{Run, measure};
use fairflight_media::phase::Isotropic;
use fairflight_media::{
    Bounds, Extinction, Homogeneous, Line, Medium, PhaseFunction, PiecewiseConstant, Ray, Tolerance,
    adaptive_integral,
};
use fairflight_paths::single_scattering::{
    Primary, Sampling, SharedExplorers, SingleScattering, SourceDriven, Technique, Tracked,
};
use fairflight_paths::{Integrator, Ratio, Uniform};
use fairflight_scene::{Background, Lights, Source, Volume};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_stats::{Reference, Scores, judge};
use fairflight_transmittance::{Explorers, Interaction, LineIntegral, TransmittanceEstimator};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

/// Judges estimates against the `right` reference, and against the mean that was derived for the twin.
fn tried(estimate: impl FnMut(&mut Seeded) -> f64, right: &Reference, derived: f64, run: Run) -> Rejection {
    let measured = match measure(run.seed, run.samples, estimate) {
        Ok(measured) => measured,
        Err(error) => return Rejection::exact(true, error.to_string()),
    };
    let right = right.with_mild_tails();
    let verdict = judge(&measured, &right, run.alpha);
    let own = judge(&measured, &Reference { mean: derived, ..right }, run.alpha);
    Rejection {
        rejected: verdict.sound == Some(false) && own.sound != Some(false),
        mean_z: verdict.mean_z,
        variance_z: None,
        reason: format!("{}; against its own mean {derived:.4}: {}", verdict.reason, own.reason),
    }
}

/// The weight of the walk behind each of its points, for that before.
#[derive(Clone)]
struct WeightBehind(Tracked<DoubleParticle>);

impl<M: Medium> Primary<M> for WeightBehind {
    fn trace(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource) {
        self.0.trace(ray, source);
    }
    fn transmittance(&self, ray: &Ray<&M>, s: f64) -> f64 {
        self.0.transmittance(ray, s)
    }
    fn interactions(&self) -> &[Interaction] {
        Primary::<M>::interactions(&self.0)
    }
    fn transmittance_before(&self, index: usize) -> f64 {
        Primary::<M>::interactions(&self.0)[index].weight // right: that of index − 1, or 1
    }
    fn intensity(&self) -> f64 {
        Primary::<M>::intensity(&self.0)
    }
    fn fitted(&self) -> Option<&Explorers> {
        Primary::<M>::fitted(&self.0)
    }
}

/// σ_t = 1 and a = 0.8 in a cube of 2 mean free paths, a point light beside the ray.
struct Cube {
    volume: Volume<Homogeneous, Isotropic, f64>,
    lights: Lights<f64>,
    line: Line,
}

const LENGTH: f64 = 2.0;
const LIGHT: DVec3 = dvec3(0.5, 0.4, 0.3);
const POWER: f64 = 4.0 * PI;

impl Cube {
    fn new() -> Self {
        Self {
            volume: Volume {
                medium: Homogeneous::new(1.0).expect(LAWFUL),
                bounds: Bounds::aligned_box(DVec3::splat(-1.0), DVec3::splat(1.0)).expect(LAWFUL),
                albedo: 0.8,
                phase: Isotropic,
            },
            lights: Lights {
                background: Background::dark(),
                sources: vec![Source::point(LIGHT, POWER).expect(LAWFUL)],
            },
            line: Line { origin: dvec3(0.1, 0.2, -1.0), direction: DVec3::Z },
        }
    }

    /// Reference of estimates that lie between 0 and `most`.
    fn reference(&self, most: f64) -> Reference {
        let scores = Scores::Bounded { minimum: 0.0, maximum: most };
        Reference { scores, ..single_scattering::reference(&self.volume, &self.lights, &[self.line]) }
    }

    /// D, the distance of the light from the line.
    fn aside(&self) -> f64 {
        (LIGHT - self.line.origin).truncate().length()
    }

    /// A bound of the integrand, any transmittance of the shadow ray up to 1 included.
    fn greatest(&self) -> f64 {
        let irradiance = POWER / (4.0 * PI * self.aside() * self.aside());
        self.volume.albedo * self.volume.phase.eval(0.0) * irradiance
    }

    /// Distance, extinction, and all of the integrand of eq. 22 but T(0, s), whose logarithm is −s.
    fn integrand(&self, s: f64) -> f64 {
        let distance = self.line.at(s).distance(LIGHT);
        let irradiance = POWER / (4.0 * PI * distance * distance);
        self.volume.albedo * self.volume.phase.eval(0.0) * irradiance * (-distance).exp()
    }

    /// ∫ of the integrand, times T(0, s) and a factor.
    fn integral(&self, factor: impl Fn(f64) -> f64) -> f64 {
        let closest = (LIGHT - self.line.origin).z;
        adaptive_integral(LENGTH, &[closest], Tolerance::to(1e-9), |s| {
            [self.integrand(s) * (-s).exp() * factor(s)]
        })
        .value[0]
    }

    fn cauchy(&self) -> SourceDriven {
        SourceDriven::new(&self.line, LENGTH, LIGHT)
    }

    /// Source-driven sampling with a density of one's own.
    fn by_source(&self, pdf_distance: impl Fn(f64) -> f64, source: &mut Seeded) -> f64 {
        let s = self.cauchy().sample(source.next_uniform());
        self.integrand(s) * (-s).exp() / pdf_distance(s)
    }

    /// Attenuation- and source-driven sampling with `SAMPLES` of the latter, and the MIS weight of those.
    fn by_both(&self, source_weight: impl Fn(f64) -> f64, source: &mut Seeded) -> f64 {
        let cauchy = self.cauchy();
        let (mut sum, mut weight, mut s) = (0.0, 1.0, 0.0);
        loop {
            s += source.next_exponential() / SIGMA_SAMP;
            if s >= LENGTH {
                break;
            }
            sum += self.integrand(s) * weight / (SIGMA_SAMP + SAMPLES * cauchy.pdf_distance(s));
            weight *= 1.0 - 1.0 / SIGMA_SAMP;
        }
        for _ in 0..SAMPLES as u32 {
            let s = cauchy.sample(source.next_uniform());
            sum += self.integrand(s) * (-s).exp() * source_weight(s) / (SAMPLES * cauchy.pdf_distance(s));
        }
        sum
    }
}

const SIGMA_SAMP: f64 = 1.5;
const SAMPLES: f64 = 4.0;

/// SimulateParticle at r = 1, seen along the normal of a slab of τ = 1 and a = 0.9, of which the energy stays 1.
fn without_albedo(run: Run) -> Rejection {
    let (lit, tau, albedo) = (Lit::Diffusely, 1.0, 0.9);
    let volume = slab::volume(tau, albedo, Isotropic).expect(LAWFUL);
    let lights: Lights<f64> = slab::lights(lit).expect(LAWFUL);
    let estimate = |source: &mut Seeded| {
        let line = slab::line(lit, true, tau);
        let Some(mut ray) = volume.enter(&line, None) else { return 0.0 };
        let energy = 1.0;
        loop {
            let s = source.next_exponential();
            let incident = ray.world_line().direction;
            if s >= ray.length() {
                return energy * lights.background.radiance(incident);
            }
            // Right: energy *= albedo
            let direction =
                volume.phase.sample(incident, source.next_uniform(), source.next_uniform()).direction;
            ray = volume.inside(Line { origin: ray.world_point(s), direction });
        }
    };
    let of = |albedo| Slab { optical_thickness: tau, albedo, legendre: vec![1.0] }.respond(lit);
    let right = of(albedo);
    // The radiance 1 of the background, times an energy of at most 1.
    let scores = Scores::Bounded { minimum: 0.0, maximum: 1.0 };
    tried(
        estimate,
        &Reference { error: right.error, scores, ..Reference::exact(right.reflected) },
        of(1.0).reflected,
        run,
    )
}

/// Algorithm 2 of which all steps of a flight are of one variate.
struct StratifiesEveryStep {
    splits: u32,
    majorant: f64,
}

impl<F: Extinction> TransmittanceEstimator<F> for StratifiesEveryStep {
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let p_volume = -(-self.majorant * field.length()).exp_m1();
        let n = f64::from(self.splits);
        let shift = source.next_uniform();
        let mut escaped = 0.0;
        for k in 0..self.splits {
            let u = (f64::from(k) + shift) / n;
            let mut s = -(-u * p_volume).ln_1p() / self.majorant;
            escaped += loop {
                if s >= field.length() {
                    break 1.0;
                }
                if source.next_uniform() * self.majorant < field.sigma_t(s) {
                    break 0.0;
                }
                s += -(-u).ln_1p() / self.majorant; // right: a variate of its own
            };
        }
        1.0 - p_volume + p_volume * escaped / n
    }
    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    let cube = "a cube of 2 mean free paths, albedo 0.8, point light inside";
    vec![
        // Every point's factor 1 − r = 1/3 is in its own score: a third of the radiance.
        Twin::new(
            "attenuation-driven sampling",
            "weight_behind_the_collision",
            "the walk's weight behind the point that scores, for that before it (0.6995 for 0.8186 in the errata's case)",
            cube,
            (300_000, Evident::Mean { z: 964.2 }),
            |run| {
                let cube = Cube::new();
                let model = DoubleParticle { albedo: Albedo::default() };
                let walk = WeightBehind(Tracked::new(model, SIGMA_SAMP, None).expect(LAWFUL));
                let explorers = SharedExplorers::new(2, 1).expect(LAWFUL);
                let shadow = Ratio(Uniform::new(1.0).expect(LAWFUL));
                let sampling = (Sampling::One(Technique::Attenuation), 1);
                let mut twin =
                    SingleScattering::new(&cube.volume, &cube.lights, sampling, walk, shadow, explorers)
                        .expect(LAWFUL);
                // Scores of at most greatest/σ_samp, 1/3 of that, 1/9 …: at most 3/2 · greatest/σ_samp.
                let right = cube.reference(1.5 * cube.greatest() / SIGMA_SAMP);
                let derived = right.mean * (1.0 - 1.0 / SIGMA_SAMP);
                tried(|source| twin.radiance(&cube.line, source), &right, derived, run)
            },
        ).about(["single_scattering"]).about(["double_particle"]),
        // dθ for ds: the integrand is weighted with D/(D² + (s − s_l)²).
        Twin::new(
            "source-driven sampling",
            "equiangular_density_per_angle",
            "the density per angle, 1/(θ_b − θ_a), for that per length: the Jacobian forgotten",
            cube,
            (20_000, Evident::Mean { z: 99.7 }),
            |run| {
                let cube = Cube::new();
                let offset = LIGHT - cube.line.origin;
                let (closest, distance) = (offset.z, offset.truncate().length());
                let angle = (LENGTH - closest).atan2(distance) - (-closest).atan2(distance);
                let jacobian = |s: f64| distance / (distance * distance + (s - closest) * (s - closest));
                let derived = cube.integral(jacobian);
                // 1/d² over D/(angle d²).
                let right = cube.reference(cube.greatest() * cube.aside() * angle);
                tried(|source| cube.by_source(|_s| 1.0 / angle, source), &right, derived, run)
            },
        )
        .about(["single_scattering"])
        .answers(|vector, source| {
            let length = vector.sampler("length").filter(|_| vector.kind == "equiangular")?;
            let [origin, direction, light] = ["origin", "direction", "light"]
                .map(|key| DVec3::from_slice(&vector.numbers(&format!("/sampler/{key}"))));
            let s = SourceDriven::new(&Line { origin, direction }, length, light).sample(source.next_uniform());
            let (offset, closest) = (light - origin, (light - origin).dot(direction));
            let distance = (offset - closest * direction).length();
            let angle = (length - closest).atan2(distance) - (-closest).atan2(distance);
            Some(Answer { values: vec![s, 1.0 / angle], collided: None })
        }),
        // The weights sum to σ/(σ + n p) + p/(p + σ).
        Twin::new(
            "MIS of attenuation and source",
            "weights_that_do_not_sum_to_one",
            "the number of samples in one technique's MIS weights and not in the other's",
            cube,
            (50_000, Evident::Mean { z: 310.1 }),
            |run| {
                let cube = Cube::new();
                let cauchy = cube.cauchy();
                let of_source = |s: f64| {
                    let pdf = cauchy.pdf_distance(s);
                    pdf / (pdf + SIGMA_SAMP) // right: SAMPLES * pdf for pdf
                };
                let of_attenuation = |s: f64| SIGMA_SAMP / (SIGMA_SAMP + SAMPLES * cauchy.pdf_distance(s));
                let derived = cube.integral(|s| of_attenuation(s) + of_source(s));
                // 3/2 · greatest/σ_samp from the walk, greatest/σ_samp from each sample of the source.
                let right = cube.reference((1.5 + SAMPLES) * cube.greatest() / SIGMA_SAMP);
                tried(|source| cube.by_both(of_source, source), &right, derived, run)
            },
        ).about(["single_scattering"]),
        // The radiance of a slab without absorption.
        Twin::new(
            "importons",
            "scattered_without_albedo",
            "the energy is not multiplied with the albedo where light is scattered",
            "a slab of tau 1, albedo 0.9, diffusely lit",
            (100_000, Evident::Mean { z: 49.7 }),
            without_albedo,
        ).about(["particle_tracer"]),
        // E = (1 − p_V) + p_V ∫ Π (1 − σ_t(s_j)/majorant) du over the steps s_j of one variate u: 0.367 for 0.423.
        Twin::new(
            "line integral",
            "every_step_stratified",
            "the later steps of a flight by the variate of the first (algorithm 2 stratifies that one alone)",
            "sigma_t 0.4 and 1 (length 1.9 and 0.1), majorant 1, 4 splits",
            (50_000, Evident::Mean { z: 64.1 }),
            |run| {
                let field = PiecewiseConstant::new(vec![0.0, 1.9, 2.0], vec![0.4, 1.0]).expect(LAWFUL);
                let theory = theory_on(&field, &LineIntegral::new(4).expect(LAWFUL), &[]);
                judged(&field, &StratifiesEveryStep { splits: 4, majorant: 1.0 }, theory, run)
            },
        )
        .about(["line_integral"])
        .answers(|vector, source| {
            let field = vector.of("line_integral")?;
            let (splits, majorant) = (vector.estimator("splits")? as u32, vector.estimator("majorant")?);
            Some(StratifiesEveryStep { splits, majorant }.estimate(&field, source).into())
        }),
    ]
}
