//! The rays that estimators are compared on.

use crate::run::Run;
use fairflight_harness::Failure;
use fairflight_harness::comparison::{Effort, RaySet, chords, entrants};
use fairflight_harness::field::AnyProfile;
use fairflight_harness::field::{AnalyticCosineSpec, MediumKind, PerlinSpec};
use fairflight_harness::volume::Volume;
use fairflight_media::{Bounds, Medium, PerlinParameters, PiecewiseConstant, Tolerance};
use fairflight_sources::{Seeded, UniformSource};
use glam::DVec3;

/// Rays of a set.
const RAYS: usize = 60;
/// Rays are kept from this share of the medium's extent on.
const LEAST: f64 = 0.2;

/// A set with how thoroughly it is measured.
pub(super) struct Arena {
    /// Names files.
    pub(super) id: &'static str,
    pub(super) set: RaySet,
    pub(super) effort: Effort,
    /// What it is, in words.
    pub(super) description: String,
}

/// The sets of the report: smooth, rough, Perlin, and a volume if one is given.
pub(super) fn arenas(run: &Run<'_>) -> Result<Vec<Arena>, Failure> {
    let mut arenas = vec![smooth(run)?, rough(run)?, perlin(run)?];
    if let Some(volume) = &run.options.vdb {
        arenas.push(vdb(run, volume)?);
    }
    Ok(arenas)
}

fn rays(run: &Run<'_>) -> usize {
    run.quick_or(3, RAYS)
}

fn effort(run: &Run<'_>, samples: u64, closed: bool) -> Effort {
    let samples = run.quick_or(samples / 8, samples).max(1024);
    Effort { samples, counted: samples.min(2048), closed }
}

/// Random chords of a medium, below `majorant` or else its upper bound.
fn of_chords(
    run: &Run<'_>,
    (id, name): (&str, &str),
    medium: &dyn MediumKind,
    majorant: Option<f64>,
    tolerance: f64,
) -> Result<RaySet, Failure> {
    let (medium, bounds) = medium.build(&run.media, "medium")?;
    let profiles = chords(&medium, &bounds, rays(run), LEAST, run.seed(format_args!("sets/{id}")))?;
    let majorant = majorant
        .or_else(|| medium.upper_bound())
        .ok_or_else(|| Failure::refused("medium: the volume declares no majorant"))?;
    RaySet::of(name, profiles, majorant, Tolerance::to(tolerance))
}

fn smooth(run: &Run<'_>) -> Result<Arena, Failure> {
    let medium = AnalyticCosineSpec { scale: 1.0, bounds: None };
    Ok(Arena {
        id: "smooth",
        set: of_chords(run, ("smooth", "smooth"), &medium, Some(1.0), 1e-11)?,
        effort: effort(run, 16_384, true),
        description: "Smooth: random chords of szirmay-kalos-2017 eq. 21, at least 4 long, majorant 1."
            .to_owned(),
    })
}

/// White noise: 400 log-normal cells along a ray of length 20, no greater than the majorant 1, of the optical thickness of the seed ray.
pub(super) fn rough_profile(source: &mut Seeded) -> Result<PiecewiseConstant, Failure> {
    const CELLS: usize = 400;
    const LENGTH: f64 = 20.0;
    const THICKNESS: f64 = 3.415_684;
    const DEVIATION: f64 = 1.3;
    let mut normal = || {
        // Box and Muller 1958.
        let radius = (2.0 * source.next_exponential()).sqrt();
        radius * (std::f64::consts::TAU * source.next_uniform()).cos()
    };
    let heights: Vec<f64> = (0..CELLS).map(|_| (DEVIATION * normal()).exp().min(9.0)).collect();
    let spacing = LENGTH / CELLS as f64;
    let scale = THICKNESS / (heights.iter().sum::<f64>() * spacing);
    let edges = (0..=CELLS).map(|i| if i == CELLS { LENGTH } else { i as f64 * spacing }).collect();
    let sigma_t = heights.iter().map(|height| (height * scale).min(1.0)).collect();
    PiecewiseConstant::new(edges, sigma_t)
        .map_err(|error| Failure::refused(format!("rough profile: {error}")))
}

fn rough(run: &Run<'_>) -> Result<Arena, Failure> {
    let mut source = Seeded::new(run.seed("sets/rough"));
    let profiles: Result<Vec<AnyProfile>, Failure> =
        (0..rays(run)).map(|_| Ok(AnyProfile::PiecewiseConstant(rough_profile(&mut source)?))).collect();
    Ok(Arena {
        id: "rough",
        set: RaySet::of("rough", profiles?, 1.0, Tolerance::to(1e-11))?,
        effort: effort(run, 16_384, true),
        description: "Rough: 400 cells of log-normal noise along each ray of length 20, optical thickness about 3.4, majorant 1: white \
                      noise below the spacing of any comb, the hardest case for it."
            .to_owned(),
    })
}

fn perlin(run: &Run<'_>) -> Result<Arena, Failure> {
    let parameters = PerlinParameters { offset: 0.25, scale: 0.75, ..PerlinParameters::default() };
    let bounds = Bounds::sphere(DVec3::ZERO, 10.0)
        .map_err(|error| Failure::refused(format!("medium.bounds: {error}")))?;
    let medium = PerlinSpec::of(parameters, bounds);
    Ok(Arena {
        id: "perlin",
        set: of_chords(run, ("perlin", "Perlin"), &medium, Some(1.0), 1e-7)?,
        effort: effort(run, 4096, false),
        description: "Perlin: random chords of a sphere of radius 10 in the noise of twelve octaves of the standard report, majorant 1."
            .to_owned(),
    })
}

fn vdb(run: &Run<'_>, volume: &Volume) -> Result<Arena, Failure> {
    let set = of_chords(run, ("vdb", "vdb"), volume.medium().kind(), None, 1e-11)?;
    let majorant = set.rays.first().map_or(0.0, |ray| ray.majorant);
    let effort = effort(run, 8192, false);
    let each = (effort.samples + effort.counted) as f64;
    let lookups = each * (set.depth() * entrants().len() as f64 + set.pairs());
    let because =
        format!("{each} estimates of each kind on {} rays, in the majorant {majorant:e}", set.rays.len());
    run.options.budget.check("medium", lookups, &because)?;
    let file = volume.file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let description =
        format!("Volume: random chords of the box of {file}, majorant {majorant:.4}, the greatest voxel.");
    Ok(Arena { id: "vdb", set, effort, description })
}
