//! Fig. 13: backward, isotropic and forward scattering.

use super::reference::Reference;
use super::scenes::{self, BOUND, Choice};
use crate::Failure;
use crate::report::document::{
    Axis, Cell, Chart, Gallery, GalleryRow, Mark, Picture, Pixels, Section, Table,
};
use crate::report::replicas::{Measured, Replicas};
use crate::report::run::Run;
use crate::report::speed::curve as joined;

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
    for (k, g) in (0..).zip(COSINES) {
        let subject = scenes::haze(scenes::side(run), g)?;
        let reference = Reference::of(run, &subject, REFERENCE, run.seed(70, k))?;
        let choice = Choice { strategy: "one_to_one", placement: "locally_homogeneous", ..Choice::EXACT };
        let images = subject.with("integrator", choice.lights(PATHS, 4, BOUND)).measure(
            run.samples(SETS),
            (run.seed(71, k), REPLICAS),
            &run.media,
        )?;
        run.advance();
        let error = reference.rmse(&images).map(|rmse| rmse / reference.mean.0);
        points.push(Point { g, error, z: reference.z_of(&images), images, reference });
    }
    let mut table = Table::new(
        "anisotropy-table",
        "Error by mean cosine",
        "Relative to the mean radiance of the reference. z: in standard errors of both images.",
        &[("g", "1"), ("RMSE / mean radiance", "1"), ("z", "1")],
    );
    for point in &points {
        table.rows.push(vec![
            Cell::Number(point.g),
            Cell::measured(point.error.value, point.error.interval),
            Cell::Number(point.z),
        ]);
    }
    let mut chart = Chart::new(
        "anisotropy-error",
        "Error by mean cosine",
        Axis::linear("mean cosine g [1]"),
        Axis::linear("RMSE / mean radiance [1]"),
    );
    let marks = points.iter().map(|point| Mark::measured(point.g, point.error.value, point.error.interval));
    chart.curves = vec![joined("1-to-1, locally homogeneous", marks.collect())];
    let mut section = Section::new("anisotropy", "Fig. 13: backward, isotropic and forward scattering");
    section.text = vec![format!(
        "Spheres in even haze (σ_t = 0.35, albedo 0.98), {} sets of {PATHS} light paths, b = {BOUND}, 1-to-1 locally homogeneous with exact \
         transmittance, {REPLICAS} independent images; references of {REFERENCE} paths per pixel.",
        run.samples(SETS)
    )];
    section.tables.push(table);
    section.charts.push(chart);
    let picture = |k: usize, point: &Point, exact: bool| {
        let images = if exact { &point.reference.shown } else { &point.images };
        Picture {
            id: format!("anisotropy-{k}{}", if exact { "-reference" } else { "" }),
            label: format!("g = {}", point.g),
            lines: Vec::new(),
            resolution: images.first().resolution(),
            pixels: Pixels::Radiance { values: images.first().means().to_vec(), exposure: 1.5 },
        }
    };
    let row = |label: &str, exact: bool| GalleryRow {
        label: label.to_owned(),
        pictures: points.iter().enumerate().map(|(k, point)| picture(k, point, exact)).collect(),
    };
    section.galleries.push(Gallery {
        id: "anisotropy-images".to_owned(),
        title: "The images".to_owned(),
        caption: "One image of each measurement.".to_owned(),
        rows: vec![row("virtual point lights", false), row("path tracing", true)],
    });
    Ok(Anisotropy { points, section })
}
