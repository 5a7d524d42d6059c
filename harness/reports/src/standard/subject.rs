//! A medium and one ray through it: what the curves of the report are about.

use super::maximum::maximum;
use crate::standard::result::RayFacts;
use fairflight_harness::Failure;
use fairflight_harness::comparison::TestRay;
use fairflight_harness::field::{AnalyticCosineSpec, MediumKind, PerlinSpec};
use fairflight_harness::field::{AnyMedium, AnyProfile, MediumLibrary};
use fairflight_harness::reference::Truth;
use fairflight_harness::volume::Volume;
use fairflight_media::{AnalyticCosine, Bounds, PerlinParameters, Tolerance};
use glam::{DVec3, dvec3};

/// A medium with its studied ray.
#[derive(Debug)]
pub(super) struct Subject {
    pub(super) id: &'static str,
    pub(super) title: String,
    pub(super) description: String,
    pub(super) medium: AnyMedium,
    pub(super) bounds: Bounds,
    pub(super) profile: AnyProfile,
    pub(super) truth: Truth,
    pub(super) facts: RayFacts,
    /// The greatest extinction on the ray, rounded up to three digits: what a careful user would claim as a majorant.
    pub(super) majorant: f64,
    /// Cost of one look-up on an ordinary core \[ns\]. A constant, so that sample sizes do not depend on the machine.
    pub(super) lookup_nanoseconds: f64,
    /// The sampling extinction of the walks that are shown one by one (fig. 5 and 8) \[1/length\].
    pub(super) walk_sampling: f64,
}

/// The id of a volume that was given.
pub(super) const VOLUME: &str = "vdb";

/// The seed ray of the analytic medium runs through its center.
const AXIS: (DVec3, DVec3) = (DVec3::ZERO, DVec3::Z);

/// Off every lattice line and plane of the noise.
const OBLIQUE: (DVec3, DVec3) = (dvec3(2.3, 3.7, -5.0), dvec3(-0.21, -0.13, 1.0));

/// Tuned by the quantiles of σ_t in the sphere (50 %: 0.25, 99 %: 0.54, 99.9 %: 0.63): dense regions near 0.6, and a bound
/// offset + scale of 1, which is the paper's majorant.
fn perlin_parameters() -> PerlinParameters {
    PerlinParameters { offset: 0.25, scale: 0.75, ..PerlinParameters::default() }
}

pub(super) fn analytic(library: &MediumLibrary) -> Result<Subject, Failure> {
    let spec = AnalyticCosineSpec { scale: 1.0, bounds: None };
    Subject::new(
        Names {
            id: "eq21",
            title: "Analytic medium (eq. 21)".to_owned(),
            description:
                "szirmay-kalos-2017 eq. 21 in the sphere of radius 10 around (0, 0, 10); the ray runs along \
                          the z axis through the center"
                    .to_owned(),
        },
        Ranking { lookup_nanoseconds: 30.0, walk_sampling: Some(0.4) },
        &spec,
        library,
        |_| AXIS,
    )
}

pub(super) fn perlin(library: &MediumLibrary) -> Result<Subject, Failure> {
    let parameters = perlin_parameters();
    let spec = PerlinSpec::of(parameters, AnalyticCosine::default_bounds());
    let PerlinParameters { octaves, frequency, lacunarity, gain, scale, offset, seed } = parameters;
    Subject::new(
        Names {
            id: "perlin",
            title: format!("Perlin noise, {octaves} octaves"),
            description: format!(
                "max(0, {offset} + {scale} fBm) with {octaves} octaves of gradient noise (frequency {frequency}, \
                 lacunarity {lacunarity}, gain {gain}, seed {seed}) in the sphere of radius 10 around (0, 0, 10), after \
                 the medium of szirmay-kalos-2017 fig. 5, 7 and 9, whose parameters are not printed; an oblique ray, off \
                 every lattice line"
            ),
        },
        Ranking { lookup_nanoseconds: 420.0, walk_sampling: Some(0.4) },
        &spec,
        library,
        |_| OBLIQUE,
    )
}

pub(super) fn volume(volume: &Volume, library: &MediumLibrary) -> Result<Subject, Failure> {
    let Volume { file, grid, scale } = volume;
    let name =
        file.file_name().map_or_else(|| file.display().to_string(), |n| n.to_string_lossy().into_owned());
    let grid = grid
        .as_ref()
        .map_or_else(|| "the density, or the only float grid,".to_owned(), |grid| format!("grid {grid}"));
    Subject::new(
        Names {
            id: VOLUME,
            title: format!("OpenVDB volume {name}"),
            description: format!(
                "{grid} of {name}, trilinear, times {scale}; the ray runs through the middle of the bounds along their \
                 longest axis"
            ),
        },
        Ranking { lookup_nanoseconds: 60.0, walk_sampling: None },
        volume.medium().kind(),
        library,
        through_the_middle,
    )
}

fn through_the_middle(bounds: &Bounds) -> (DVec3, DVec3) {
    let (middle, radius) = bounds.enclosing_ball();
    let extent = match *bounds {
        Bounds::Sphere { .. } => DVec3::Z,
        Bounds::Box { min, max } => max - min,
    };
    let axis = DVec3::AXES[extent.max_position()];
    (middle - 2.0 * radius * axis, axis)
}

struct Names {
    id: &'static str,
    title: String,
    description: String,
}

/// See [`Subject`].
#[derive(Clone, Copy)]
struct Ranking {
    lookup_nanoseconds: f64,
    /// By default 0.4 of the majorant.
    walk_sampling: Option<f64>,
}

impl Subject {
    /// The ray as the comparison of all estimators takes it, below a majorant \[1/length\].
    pub(super) fn ray(&self, majorant: f64) -> TestRay {
        TestRay { profile: self.profile.clone(), truth: self.truth, majorant }
    }

    fn new(
        names: Names,
        ranking: Ranking,
        spec: &dyn MediumKind,
        library: &MediumLibrary,
        ray: impl Fn(&Bounds) -> (DVec3, DVec3),
    ) -> Result<Self, Failure> {
        let Names { id, title, description } = names;
        let Ranking { lookup_nanoseconds, walk_sampling } = ranking;
        let (medium, bounds) = spec.build(library, "profile.medium")?;
        let (origin, direction) = ray(&bounds);
        let clip = bounds.clip(origin, direction, None).map_err(|error| in_subject(id, error))?;
        let clip = clip.ok_or_else(|| in_subject(id, "the studied ray misses the medium"))?;
        let profile = AnyProfile::ray(&medium, &clip)?;
        let truth = Truth::of(&profile, Tolerance::TIGHT)?;
        let maximum = maximum(&profile, truth.observed.1);
        let length = clip.length;
        let transmittance = truth.transmittance();
        if !(maximum > 0.0 && length > 0.0) {
            return Err(in_subject(id, "the studied ray meets no extinction"));
        }
        if transmittance < 1e-100 {
            let thickness = truth.optical_thickness;
            return Err(in_subject(
                id,
                format!("the studied ray has an optical thickness of {thickness}: a smaller scale is needed"),
            ));
        }
        let facts = RayFacts {
            entry: clip.line.origin.to_array(),
            direction: clip.line.direction.to_array(),
            length,
            optical_thickness: truth.optical_thickness,
            optical_thickness_error: truth.thickness_error,
            transmittance,
            maximum,
            mean: truth.optical_thickness / length,
        };
        let majorant = rounded_up(maximum);
        Ok(Self {
            id,
            title,
            description,
            medium,
            bounds,
            profile,
            truth,
            facts,
            majorant,
            lookup_nanoseconds,
            walk_sampling: walk_sampling.unwrap_or(0.4 * majorant),
        })
    }
}

fn in_subject(id: &str, reason: impl std::fmt::Display) -> Failure {
    Failure::refused(format!("report: {id}: {reason}"))
}

/// The number with three significant digits that is at least `x` and a ten-thousandth.
fn rounded_up(x: f64) -> f64 {
    let unit = 10f64.powf(x.log10().floor() - 2.0);
    let digits = (x * 1.0001 / unit).ceil();
    // 957 / 1000 is the nearest double to 0.957, 957 * 0.001 need not be.
    if unit < 1.0 { digits / (1.0 / unit).round() } else { digits * unit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_up_keeps_three_digits_and_leaves_room() {
        assert_eq!(rounded_up(0.9561), 0.957);
        assert_eq!(rounded_up(0.956), 0.957);
        assert_eq!(rounded_up(1.0), 1.01);
        assert_eq!(rounded_up(123.4), 124.0);
        assert!(rounded_up(3.3e-7) > 3.3e-7 * 1.0001 && rounded_up(3.3e-7) < 3.35e-7);
    }

    #[test]
    fn the_seed_ray_is_the_one_of_the_formula_sheet() {
        let subject = analytic(&MediumLibrary::default()).unwrap();
        assert!((subject.facts.optical_thickness - 3.41568).abs() < 5e-6);
        assert!((subject.facts.transmittance - 0.032_853_9).abs() < 5e-8);
        assert_eq!(subject.facts.length, 20.0);
        assert_eq!(subject.majorant, 0.957);
    }
}
