//! Expected look-ups of an image, before its first pixel.
//!
//! The rates of the integrator are asked where they tell: an estimator of transmittance looks up its rate
//! times the chord of the bounds, and where collisions end it, times the part of the chord that light passes.
//! Only walks tell how often they collide: a few of them are sent, each cut after so many collisions that all
//! together take a fraction of a second. A connection counts as a look-up.

use super::pilot::reduced;
use super::tile::Tile;
use super::{Moments, moments};
use crate::budget::{Budget, seconds_per_lookup};
use crate::estimator::{EstimatorSpec, Expected, RayKnown};
use crate::field::{AnyMedium, AnyProfile, MediumLibrary};
use crate::plan::{IntegratorPlan, ScenePlan, Spectra};
use crate::spec::{
    ExtensionSpec, IntegratorSpec, LineSplittingSpec, PathTracerSpec, SceneSpec, SingleScatteringSpec,
    TransmittanceSpec, VplSpec,
};
use crate::{Failure, interrupt};
use fairflight_media::{Bounds, Medium};
use fairflight_paths::SamplingExtinction;
use fairflight_photons::Photon;
use fairflight_vpl::Vpl;
use glam::DVec3;
use std::f64::consts::PI;

/// Columns and rows of the rays and walks that are sent.
const SIDE: u32 = 8;
const WALKS: f64 = (SIDE * SIDE) as f64;
/// The look-ups that all walks together may make: a fraction of a second.
const MOST: f64 = 1e7;
/// Light paths that stand for all of a set, and flights for those of a split.
const LIGHT_PATHS: u32 = 64;
const SPLITS: u32 = 4;
const MEAN_CELLS: u32 = 16;
const EYE_SAMPLES: u32 = 4;
/// Look-ups of a sample above which the rate is named as the reason, and below which the number of samples.
const MOST_ORDINARY: f64 = 1e3;
/// Memory for the pixels, and for virtual point lights \[bytes\].
const MOST_MEMORY: f64 = (1_u64 << 34) as f64;

/// Limit of the time that an image may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Length {
    /// All samples are drawn.
    Whole,
    /// It ends after a pass of one sample per pixel, or the first replica.
    Limited,
}

/// Work that is to be expected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Work {
    /// Look-ups.
    pub lookups: f64,
    /// Seconds of each.
    pub seconds: f64,
}

/// Checks that what is looked up before an image can be planned is within a budget.
///
/// # Errors
/// If it is not.
pub(super) fn before_planning(spec: &SceneSpec, budget: Budget) -> Result<(), Failure> {
    let IntegratorSpec::Vpl(vpl) = &spec.integrator else { return Ok(()) };
    vpl.means().map_or(Ok(()), |(lookups, how)| budget.check("integrator.local_mean_cells", lookups, &how))
}

/// The work of an image that may be drawn within a budget, that of its preparation included.
///
/// # Errors
/// If more look-ups are to be expected, or an interrupt asked to stop.
pub(super) fn check(
    spec: &SceneSpec,
    plan: &ScenePlan,
    library: &MediumLibrary,
    (budget, length): (Budget, Length),
) -> Result<Work, Failure> {
    let [columns, rows] = plan.camera.resolution();
    let samples = match length {
        Length::Whole => spec.samples_per_pixel,
        Length::Limited => plan
            .integrator
            .replicas()
            .map_or(plan.pass_samples(), |count| spec.samples_per_pixel.div_ceil(count)),
    };
    let pixels = f64::from(columns) * f64::from(rows);
    let paths = pixels * f64::from(samples);
    let because = |each: f64| format!("{columns} x {rows} pixels, {samples} samples of {each:.3e} each");
    budget.check("samples_per_pixel", paths, &because(1.0))?;

    let bytes = match &plan.spectra {
        Spectra::Gray(_) => Tile::<f64>::BYTES_PER_PIXEL,
        Spectra::Colour(_) => Tile::<DVec3>::BYTES_PER_PIXEL,
        Spectra::Separate(_) => 3 * Tile::<f64>::BYTES_PER_PIXEL,
    };
    in_memory("camera.resolution", pixels, "pixels", bytes)?;
    let replicas = plan.integrator.replicas().map_or(0.0, f64::from);
    in_memory("integrator.replicas", replicas * pixels, "pixels of replicas", size_of::<DVec3>())?;

    let chords = Chords::of(plan)?;
    let (key, lookups) = match &spec.integrator {
        IntegratorSpec::Transmittance(TransmittanceSpec { estimator, .. }) => {
            ("integrator.estimator", paths * chords.estimate(estimator, 1.0))
        }
        IntegratorSpec::SingleScattering(single) => {
            ("integrator.estimator", paths * chords.single_scattering(single, spec.lights.len()))
        }
        integrator => {
            let shadow = chords.shadow(integrator, plan);
            let walks = Walks::of(spec, plan, library, &chords, shadow)?;
            match integrator {
                IntegratorSpec::Vpl(vpl) => {
                    let lookups = walks.virtual_lights(vpl, (f64::from(samples), paths), shadow)?;
                    ("integrator.light_paths", lookups)
                }
                IntegratorSpec::BeamRadiance(beam) => {
                    let near = walks.lights * f64::from(beam.photons) * chords.share_within(beam.radius);
                    let traced =
                        f64::from(samples) * walks.light_paths("integrator.photons", beam.photons)?;
                    ("integrator.photons", traced + paths * (walks.each + near * shadow.max(1.0)))
                }
                IntegratorSpec::PathTracer(PathTracerSpec {
                    extension: Some(ExtensionSpec::Guided(guided)),
                    ..
                }) => {
                    let traced = walks.light_paths("integrator.extension.photons", guided.photons)?;
                    ("integrator.extension.photons", traced + paths * walks.each)
                }
                IntegratorSpec::PathTracer(_) | IntegratorSpec::Bidirectional(_)
                    if shadow > MOST_ORDINARY =>
                {
                    ("integrator.estimator", paths * walks.each)
                }
                _ => ("integrator.sigma_samp", paths * walks.each),
            }
        }
    };
    let each = lookups / paths;
    let key = if each > MOST_ORDINARY { key } else { "samples_per_pixel" };
    let prepared: u64 = plan.integrator.preparations().map(|preparation| preparation.lookups).sum();
    let lookups = lookups.max(paths) + prepared as f64;
    let because = match prepared {
        0 => because(each),
        prepared => format!("{} and {prepared} before the first", because(each)),
    };
    budget.check(key, lookups, &because)?;
    Ok(Work { lookups, seconds: chords.profile.as_ref().map_or(0.0, seconds_per_lookup) })
}

/// Checks that so many of something, of so many bytes each, may be kept in memory.
fn in_memory(key: &str, count: f64, what: &str, bytes: usize) -> Result<(), Failure> {
    let needed = count * bytes as f64;
    if needed <= MOST_MEMORY {
        return Ok(());
    }
    let gib = |bytes: f64| bytes / f64::from(1_u32 << 30);
    Err(Failure::refused(format!(
        "{key}: {count:.1e} {what} take {:.0} GiB of memory, more than {:.0}",
        gib(needed),
        gib(MOST_MEMORY)
    )))
}

/// Camera rays in the bounds of the medium.
struct Chords {
    /// Mean length of the chords, a ray that misses counted as 0 \[length\].
    mean: f64,
    /// The share of it that light passes: ∫ T ds over the length.
    passed: f64,
    /// The greatest extent of the bounds \[length\].
    extent: f64,
    /// Volume of the bounds \[length³\].
    volume: f64,
    upper_bound: Option<f64>,
    /// One of the rays.
    profile: Option<AnyProfile>,
}

impl Chords {
    fn of(plan: &ScenePlan) -> Result<Self, Failure> {
        let camera = plan.camera.with_resolution([SIDE; 2]).map_err(Failure::refused)?;
        let (mut length, mut passed, mut longest) = (0.0, 0.0, None::<AnyProfile>);
        for pixel in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| [column, row])) {
            let line = camera.ray(pixel, [0.5; 2]);
            let clip = plan.bounds.clip(line.origin, line.direction, None).map_err(Failure::refused)?;
            let Some(clip) = clip.filter(|clip| clip.length > 0.0) else { continue };
            // A ray through more voxels than a profile may have is not needed here.
            let Ok(profile) = AnyProfile::ray(&plan.medium, &clip) else { continue };
            length += clip.length;
            passed += lit_length(&profile);
            if longest.as_ref().is_none_or(|longest| longest.length() < clip.length) {
                longest = Some(profile);
            }
        }
        let (extent, volume) = match plan.bounds {
            Bounds::Sphere { radius, .. } => (2.0 * radius, 4.0 / 3.0 * PI * radius.powi(3)),
            Bounds::Box { min, max } => ((max - min).length(), (max - min).element_product()),
        };
        let upper_bound = plan.medium.upper_bound();
        let passed = if length > 0.0 { passed / length } else { 1.0 };
        Ok(Self { mean: length / WALKS, passed, extent, volume, upper_bound, profile: longest })
    }

    /// Look-ups of an estimator of transmittance on a ray of so many chords, one at least.
    fn estimate(&self, estimator: &EstimatorSpec, chords: f64) -> f64 {
        if matches!(estimator, EstimatorSpec::Regular(_)) {
            return 1.0;
        }
        let (length, upper_bound) = (chords * self.mean, self.upper_bound);
        let work = estimator.kind().work(RayKnown { from: 0.0, length, upper_bound, breakpoints: 0 });
        let lookups = match work.estimate {
            Expected::Exactly(lookups) => lookups,
            Expected::Between(least, most) => least.max(most * self.passed),
        };
        (work.on_each_ray + lookups).max(1.0)
    }

    /// The share of the bounds that lies within a radius of a chord.
    fn share_within(&self, radius: f64) -> f64 {
        if self.mean > 0.0 { (PI * radius * radius * self.mean / self.volume).min(1.0) } else { 0.0 }
    }

    fn single_scattering(&self, spec: &SingleScatteringSpec, lights: usize) -> f64 {
        let shadow = self.estimate(spec.shadow.as_ref().unwrap_or(&spec.estimator), 0.5);
        let points = f64::from(spec.samples_per_ray) * lights.max(1) as f64;
        self.estimate(&spec.estimator, 1.0) + points * (1.0 + shadow)
    }

    /// Look-ups that no limit of collisions cuts: of a shadow ray or a connection, over half of the bounds; of the background behind
    /// photons, by ratio tracking; of the first flight of a split.
    fn shadow(&self, integrator: &IntegratorSpec, plan: &ScenePlan) -> f64 {
        if let IntegratorSpec::LineSplitting(LineSplittingSpec { majorant, .. }) = integrator {
            return (majorant * self.mean * self.passed).max(1.0);
        }
        let Some(transport) = integrator.kind().transport() else {
            let photons = matches!(plan.integrator, IntegratorPlan::PhotonTracer(_));
            return if photons { (rate(plan) * self.mean).max(1.0) } else { 1.0 };
        };
        let inside = Self { mean: self.extent, profile: None, ..*self };
        match &transport.estimator {
            Some(estimator) => inside.estimate(estimator, 0.5),
            None if matches!(plan.medium, AnyMedium::Homogeneous(_)) => 1.0,
            None => (0.5 * self.extent * self.upper_bound.unwrap_or(0.0)).max(1.0),
        }
    }
}

/// ∫ T(0, s) ds by the midpoint rule; where σ_t is negative light passes.
fn lit_length(profile: &AnyProfile) -> f64 {
    const STEPS: u32 = 64;
    let field = profile.field();
    let step = field.length() / f64::from(STEPS);
    let (mut thickness, mut passed) = (0.0_f64, 0.0);
    for i in 0..STEPS {
        let here = step * field.sigma_t((f64::from(i) + 0.5) * step).max(0.0);
        // Exact where σ_t is constant over a step.
        passed += (-thickness).exp() * if here > 0.0 { -(-here).exp_m1() / here } else { 1.0 };
        thickness += here;
    }
    step * passed
}

/// Look-ups and lights of a few walks.
struct Walks {
    /// Look-ups per camera path, with all that belongs to it.
    each: f64,
    /// Virtual point lights per light path.
    lights: f64,
}

impl Walks {
    fn of(
        spec: &SceneSpec,
        plan: &ScenePlan,
        library: &MediumLibrary,
        chords: &Chords,
        shadow: f64,
    ) -> Result<Self, Failure> {
        let rate = rate(plan);
        let most = (MOST / WALKS / shadow).clamp(16.0, 1e5) as u64;
        let mut pilot = reduced(spec, SIDE, 1)?;
        let steps = match &pilot.integrator {
            IntegratorSpec::Metropolis(chains) => Some((&chains.steps, 1.0)),
            IntegratorSpec::EnergyRedistribution(spec) => {
                Some((&spec.steps, 1.0 + spec.chain_length as f64 * spec.chains_per_sample))
            }
            _ => None,
        };
        let evaluations = steps.map_or(1.0, |(_, evaluations)| evaluations);
        if let Some((steps, _)) = steps {
            pilot.integrator = steps.independent();
        }
        let mut scale = evaluations;
        match &mut pilot.integrator {
            IntegratorSpec::PathTracer(tracer) => {
                tracer.max_vertices = tracer.max_vertices.min(most as u32);
                if let Some(ExtensionSpec::Guided(guided)) = &mut tracer.extension {
                    guided.photons = guided.photons.min(LIGHT_PATHS);
                }
            }
            IntegratorSpec::BeamRadiance(beam) => {
                beam.max_vertices = beam.max_vertices.min(most as u32);
                beam.photons = beam.photons.min(LIGHT_PATHS);
            }
            IntegratorSpec::Bidirectional(spec) => spec.max_vertices = spec.max_vertices.min(most as u32),
            IntegratorSpec::Vpl(vpl) => {
                vpl.light_paths = vpl.light_paths.min(LIGHT_PATHS);
                vpl.local_mean_cells = vpl.local_mean_cells.min(MEAN_CELLS);
                scale = f64::from(vpl.eye_samples) / f64::from(vpl.eye_samples.min(EYE_SAMPLES));
                vpl.eye_samples = vpl.eye_samples.min(EYE_SAMPLES);
            }
            IntegratorSpec::LineSplitting(LineSplittingSpec { splits, .. }) => {
                scale = f64::from(*splits) / f64::from((*splits).min(SPLITS));
                *splits = (*splits).min(SPLITS);
            }
            _ => {}
        }
        if let Some(walk) = pilot.integrator.walk_mut() {
            walk.max_collisions = walk.max_collisions.min(most);
        }
        // Where one shadow ray takes that long nobody waits for a pilot.
        let drawn = if shadow > MOST / WALKS { None } else { draw(&pilot, library).ok() };
        interrupt::check()?;
        let Some(drawn) = drawn else {
            // What is wrong with the scene, if anything is, the image itself will say.
            return Ok(Self { each: shadow.max(rate * chords.mean * chords.passed), lights: 1.0 });
        };
        let cut = drawn.truncated() as f64 / WALKS;
        let allowed = spec.integrator.walk().map_or(u64::MAX, |walk| walk.max_collisions) as f64;
        // One that was cut has the rest of the bounds before it, as far as it may go.
        let rest = (rate * chords.extent).min(allowed) - most as f64;
        let each = scale * (drawn.lookups() as f64 / WALKS + cut * rest.max(0.0));
        let light_paths = match &pilot.integrator {
            IntegratorSpec::Vpl(vpl) => vpl.light_paths,
            IntegratorSpec::BeamRadiance(beam) => beam.photons,
            IntegratorSpec::PathTracer(PathTracerSpec {
                extension: Some(ExtensionSpec::Guided(guided)),
                ..
            }) => guided.photons,
            _ => 1,
        };
        let lights = drawn.lights_per_set() / f64::from(light_paths);
        Ok(Self { each: each.max(1.0), lights })
    }

    /// Look-ups of the light paths of a map, whose photons have to fit into memory. The pilot's pixels were as many as its light paths.
    fn light_paths(&self, key: &str, paths: u32) -> Result<f64, Failure> {
        in_memory(key, self.lights * f64::from(paths), "photons", size_of::<Photon<DVec3>>())?;
        Ok(f64::from(paths) * self.each)
    }

    /// Look-ups and connections of an image of virtual point lights.
    fn virtual_lights(&self, vpl: &VplSpec, (sets, paths): (f64, f64), shadow: f64) -> Result<f64, Failure> {
        let light_paths = f64::from(vpl.light_paths);
        let lights = self.lights * light_paths;
        in_memory("integrator.light_paths", lights, "virtual point lights", size_of::<Vpl<DVec3>>())?;
        // The pilot's pixels were as many as its light paths: neither had more look-ups than both together.
        let traced = sets * light_paths * self.each;
        Ok(traced + paths * (self.each + f64::from(vpl.eye_samples) * lights * shadow.max(1.0)))
    }
}

/// The greatest sampling extinction of the walks; 0 without any.
fn rate(plan: &ScenePlan) -> f64 {
    plan.integrator.walk().map_or(0.0, |walk| walk.walk().sampling().highest())
}

fn draw(pilot: &SceneSpec, library: &MediumLibrary) -> Result<Moments, Failure> {
    moments(&ScenePlan::of(pilot, library)?, &|_| ())
}
