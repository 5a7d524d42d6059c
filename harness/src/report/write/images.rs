//! Equal look-up images: transmittance in grey, its error in a diverging map, both one image pixel per pixel.

use super::super::result::{ImagePanel, ImageStudy};
use super::colour_map;
use super::draw::nice_ceil;
use super::palette::{label, look};
use super::png;
use super::table::{Cell, Table};
use rayon::prelude::*;

/// The images of a study, encoded.
pub(crate) struct Gallery<'a> {
    pub(crate) study: &'a ImageStudy,
    /// Errors of this size and beyond have the end colours.
    pub(crate) scale: f64,
    pub(crate) exact: Picture,
    pub(crate) panels: Vec<Exhibit<'a>>,
    pub(crate) csv: String,
}

/// A method in a gallery.
pub(crate) struct Exhibit<'a> {
    pub(crate) panel: &'a ImagePanel,
    pub(crate) label: String,
    pub(crate) estimate: Picture,
    pub(crate) error: Picture,
    /// Share of the pixels whose error is beyond the scale.
    pub(crate) beyond: f64,
    /// Share of the pixels whose estimate is not in \[0, 1\]: the grey image cannot show them.
    pub(crate) outside: f64,
}

/// An encoded image.
pub(crate) struct Picture {
    pub(crate) file: String,
    pub(crate) png: Vec<u8>,
}

impl Gallery<'_> {
    /// File name of the table without ending.
    pub(crate) fn id(&self) -> String {
        stem(self.study)
    }
}

/// A medium may be studied with several budgets.
fn stem(study: &ImageStudy) -> String {
    format!("{}-images-{}", study.medium, study.budget)
}

/// Encodes the images of a study.
pub(crate) fn gallery(study: &ImageStudy) -> Result<Gallery<'_>, String> {
    let pixels = study.resolution[0] * study.resolution[1];
    let complete = study.panels.iter().all(|panel| panel.pixels.len() == pixels);
    if pixels == 0 || study.exact.len() != pixels || !complete {
        return Err(format!("images of {}: not as many pixels as the resolution says", study.medium));
    }
    let scale = scale(study);
    let grey = |values: &[f64]| -> Result<Vec<u8>, String> {
        let levels: Vec<u8> = values.iter().copied().map(colour_map::grey).collect();
        png::grey(&levels, study.resolution)
    };
    let exhibits = study.panels.par_iter().enumerate().map(|(k, panel)| {
        let errors: Vec<f64> = panel.pixels.iter().zip(&study.exact).map(|(x, t)| x - t).collect();
        let colours: Vec<u8> =
            errors.iter().map(|e| colour_map::diverging(e / scale)).flat_map(<[u8; 3]>::from).collect();
        let share = |count: usize| count as f64 / pixels as f64;
        let stem = format!("{}-{}", stem(study), k + 1);
        Ok(Exhibit {
            panel,
            label: label(panel.series, &panel.parameters),
            estimate: Picture { file: format!("{stem}.png"), png: grey(&panel.pixels)? },
            error: Picture {
                file: format!("{stem}-error.png"),
                png: png::indexed(&colours, study.resolution, png::IMAGE)?,
            },
            beyond: share(errors.iter().filter(|e| e.abs() > scale).count()),
            outside: share(panel.pixels.iter().filter(|x| !(0.0..=1.0).contains(*x)).count()),
        })
    });
    Ok(Gallery {
        study,
        scale,
        exact: Picture { file: format!("{}-exact.png", stem(study)), png: grey(&study.exact)? },
        panels: exhibits.collect::<Result<_, String>>()?,
        csv: table(study).into_csv(),
    })
}

/// One scale for all methods of a study, so that their error images compare: twice the median error, rounded up.
fn scale(study: &ImageStudy) -> f64 {
    let mut errors: Vec<f64> =
        study.panels.iter().map(|panel| panel.rmse).filter(|rmse| *rmse > 0.0).collect();
    errors.sort_by(f64::total_cmp);
    errors.get(errors.len() / 2).map_or(1.0, |median| nice_ceil(2.0 * median))
}

fn table(study: &ImageStudy) -> Table {
    let mut table = Table::new(&[
        "series",
        "parameters",
        "look-ups per pixel",
        "RMSE [1]",
        "lower end of 95 % interval [1]",
        "upper end of 95 % interval [1]",
        "CPU time of the image [s]",
    ]);
    for panel in &study.panels {
        table.row(&[
            Cell::Text(look(panel.series).name),
            Cell::Text(&panel.parameters),
            Cell::Number(panel.lookups_per_pixel),
            Cell::Number(panel.rmse),
            Cell::Number(panel.rmse_interval[0]),
            Cell::Number(panel.rmse_interval[1]),
            Cell::Number(panel.seconds),
        ]);
    }
    table
}
