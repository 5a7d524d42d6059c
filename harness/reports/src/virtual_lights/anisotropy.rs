//! Fig. 13: backward, isotropic and forward scattering.

use super::reference::Reference;
use super::scenes::{self, BOUND, Choice};
use crate::measured::Measured;
use crate::replicas::Replicas;
use crate::run::Run;
use fairflight_document::{Axis, Cell, Chart, Curve, Gallery, Section, Table};
use fairflight_harness::Failure;

/// Independent images per measurement.
const REPLICAS: u32 = 6;
/// Mean cosines of Henyey-Greenstein.
pub(super) const COSINES: [f64; 5] = [-0.8, -0.4, 0.0, 0.4, 0.8];
/// Light paths of a set.
const PATHS: u32 = 100;
/// Sets of an image.
const SETS: u32 = 32;
/// Paths per pixel of the references.
const REFERENCE: u32 = 2048;

pub(super) fn steps() -> u64 {
    2 * COSINES.len() as u64
}

/// One phase function.
pub(super) struct Point {
    pub(super) g: f64,
    /// RMSE over the mean radiance of the reference.
    pub(super) error: Measured,
    pub(super) z: f64,
    images: Replicas,
    reference: Reference,
}

pub(super) struct Anisotropy {
    pub(super) points: Vec<Point>,
    pub(super) section: Section,
}

pub(super) fn study(run: &Run<'_>) -> Result<Anisotropy, Failure> {
    let mut points = Vec::new();
    for g in COSINES {
        let seed = |what: &str| run.seed(format_args!("anisotropy/{g}/{what}"));
        let subject = scenes::haze(scenes::side(run), g)?;
        let reference = Reference::of(run, &subject, REFERENCE, seed("reference"))?;
        let choice = Choice { strategy: "one_to_one", placement: "locally_homogeneous", ..Choice::EXACT };
        let lit = subject.with("integrator", choice.lights(PATHS, 4, BOUND));
        let images = lit.measure(run.samples(SETS), (seed("images"), REPLICAS), &run.media)?;
        run.advance();
        let error = reference.rmse(&images).map(|rmse| rmse / reference.mean.0);
        points.push(Point { g, error, z: reference.z_of(&images), images, reference });
    }
    let section = section(run, &points);
    Ok(Anisotropy { points, section })
}

fn section(run: &Run<'_>, points: &[Point]) -> Section {
    let text = format!(
        "Spheres in even haze (σ_t = 0.35, albedo 0.98), {} sets of {PATHS} light paths, b = {BOUND}, 1-to-1 locally homogeneous with exact \
         transmittance, {REPLICAS} independent images; references of {REFERENCE} paths per pixel.",
        run.samples(SETS)
    );
    let table = Table::of(
        [
            "anisotropy-table",
            "Error by mean cosine",
            "Relative to the mean radiance of the reference. z: in standard errors of both images.",
        ],
        points,
        &[
            ("g", "1", &|point| Cell::Number(point.g)),
            ("RMSE / mean radiance", "1", &|point| point.error.cell()),
            ("z", "1", &|point| Cell::Number(point.z)),
        ],
    );
    let marks = points.iter().map(|point| point.error.mark(point.g));
    let chart = Chart::new(
        "anisotropy-error",
        "Error by mean cosine",
        Axis::linear("mean cosine g [1]"),
        Axis::linear("RMSE / mean radiance [1]"),
    )
    .with_curves(vec![Curve::joined("1-to-1, locally homogeneous", marks)]);
    let row = |label: &str, suffix: &str, images: fn(&Point) -> &Replicas| {
        let picture = |(k, point): (usize, &Point)| {
            let id = format!("anisotropy-{k}{suffix}");
            images(point).picture(id, format!("g = {}", point.g), Vec::new(), 1.5)
        };
        (label.to_owned(), points.iter().enumerate().map(picture).collect())
    };
    let rows = vec![
        row("virtual point lights", "", |point| &point.images),
        row("path tracing", "-reference", |point| &point.reference.shown),
    ];
    Section::new("anisotropy", "Fig. 13: backward, isotropic and forward scattering")
        .with(text)
        .with(chart)
        .with(table)
        .with(Gallery::of_images("anisotropy-images", "The images", rows))
}
