//! Rays to compare estimators on.

use crate::field::{AnyMedium, AnyProfile};
use crate::parallel::try_in_parallel;
use crate::reference::Truth;
use crate::{Failure, interrupt};
use fairflight_media::{Bounds, Tolerance};
use fairflight_sources::{Seeded, UniformSource};
use glam::DVec3;

/// A profile with what is known of it.
#[derive(Clone, Debug)]
pub struct TestRay {
    /// σ_t along it.
    pub profile: AnyProfile,
    /// Optical thickness of the ray, and how well it is known.
    pub truth: Truth,
    /// The majorant that estimators are given \[1/length\].
    pub majorant: f64,
}

/// Rays of one medium.
#[derive(Clone, Debug)]
pub struct RaySet {
    /// The medium, in a word.
    pub name: String,
    /// The rays.
    pub rays: Vec<TestRay>,
    /// The mean of σ_t over all of them \[1/length\].
    pub mean: f64,
}

impl RaySet {
    /// The optical thickness of the majorant, summed over the rays, each counted as 1 at least: what an
    /// estimate on each of them looks up, to a small factor.
    #[must_use]
    pub fn depth(&self) -> f64 {
        self.depths().map(|depth| depth.max(1.0)).sum()
    }

    /// The pairs of points that a bidirectional estimate on each ray connects.
    #[must_use]
    pub fn pairs(&self) -> f64 {
        self.depths().map(|depth| 0.5 * depth * depth).sum()
    }

    fn depths(&self) -> impl Iterator<Item = f64> {
        self.rays.iter().map(|ray| ray.majorant * ray.profile.length())
    }

    /// The set of these profiles, all of them below `majorant`. Rays that meet practically nothing (∫σ_t²/majorant below a
    /// thousandth) are left out: there is nothing to compare on them.
    ///
    /// # Errors
    /// If σ_t cannot be integrated along one of them.
    pub fn of(
        name: &str,
        profiles: Vec<AnyProfile>,
        majorant: f64,
        tolerance: Tolerance,
    ) -> Result<Self, Failure> {
        const PRACTICALLY_EMPTY: f64 = 1e-3;
        let truths = try_in_parallel(profiles.len(), &|i| {
            interrupt::check()?;
            Truth::of(&profiles[i], tolerance)
        })?;
        let met = profiles.into_iter().zip(truths);
        let mut rays: Vec<TestRay> =
            met.map(|(profile, truth)| TestRay { profile, truth, majorant }).collect();
        rays.retain(|ray| {
            let mean = ray.truth.optical_thickness / ray.profile.length();
            ray.truth.optical_thickness * mean / majorant >= PRACTICALLY_EMPTY
        });
        let length: f64 = rays.iter().map(|ray| ray.profile.length()).sum();
        let thickness: f64 = rays.iter().map(|ray| ray.truth.optical_thickness).sum();
        Ok(Self { name: name.to_owned(), mean: if length > 0.0 { thickness / length } else { 0.0 }, rays })
    }
}

/// Chords of the bounds of a medium: from a uniform point on the sphere around them in a uniform direction into it, those kept that
/// stay in the bounds for more than `least` of their greatest extent.
///
/// # Errors
/// If a ray cannot be made a profile.
pub fn chords(
    medium: &AnyMedium,
    bounds: &Bounds,
    count: usize,
    least: f64,
    seed: u64,
) -> Result<Vec<AnyProfile>, Failure> {
    let (centre, radius) = bounds.enclosing_ball();
    let mut source = Seeded::new(seed);
    let mut chords = Vec::new();
    /// A medium whose bounds are missed by more rays than this in a row has none to speak of.
    const MOST_MISSES: usize = 100_000;
    let mut misses = 0;
    while chords.len() < count && misses < MOST_MISSES {
        let origin = centre + radius * sphere(&mut source);
        let mut direction = sphere(&mut source);
        if direction.dot(centre - origin) < 0.0 {
            direction = -direction;
        }
        let clip = bounds
            .clip(origin, direction, None)
            .map_err(|error| Failure::refused(format!("medium: {error}")))?;
        match clip.filter(|clip| clip.length > least * 2.0 * radius) {
            Some(clip) => {
                misses = 0;
                chords.push(AnyProfile::ray(medium, &clip)?);
            }
            None => misses += 1,
        }
    }
    Ok(chords)
}

/// A uniform point on the unit sphere.
fn sphere(source: &mut Seeded) -> DVec3 {
    let z = 1.0 - 2.0 * source.next_uniform();
    let phi = std::f64::consts::TAU * source.next_uniform();
    let radius = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(radius * phi.cos(), radius * phi.sin(), z)
}
