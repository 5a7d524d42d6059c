//! Pictures of a document, one image pixel per pixel.

use super::super::colour_map;
use super::super::number::short;
use super::super::png;
use crate::report::document::{Gallery, Picture, Pixels};
use rayon::prelude::*;

/// A gallery with its pictures encoded.
pub(super) struct Hung<'a> {
    pub(super) gallery: &'a Gallery,
    pub(super) rows: Vec<Vec<Exhibit<'a>>>,
}

/// An encoded picture.
pub(super) struct Exhibit<'a> {
    pub(super) picture: &'a Picture,
    pub(super) png: Vec<u8>,
    /// What the colours cannot show; empty if they show all.
    pub(super) remark: String,
}

impl<'a> Hung<'a> {
    pub(super) fn exhibits(&self) -> impl Iterator<Item = &Exhibit<'a>> {
        self.rows.iter().flatten()
    }

    /// The scales of its signed pictures, each once.
    pub(super) fn scales(&self) -> Vec<f64> {
        self.each(|pixels| match pixels {
            Pixels::Signed { scale, .. } => Some(*scale),
            Pixels::Radiance { .. } => None,
        })
    }

    /// The exposures of its pictures of radiance, each once.
    pub(super) fn exposures(&self) -> Vec<f64> {
        self.each(|pixels| match pixels {
            Pixels::Radiance { exposure, .. } => Some(*exposure),
            Pixels::Signed { .. } => None,
        })
    }

    fn each(&self, number: impl Fn(&Pixels) -> Option<f64>) -> Vec<f64> {
        let mut numbers: Vec<f64> =
            self.exhibits().filter_map(|exhibit| number(&exhibit.picture.pixels)).collect();
        numbers.sort_by(f64::total_cmp);
        numbers.dedup();
        numbers
    }

    /// How radiance becomes colour, if there is any.
    pub(super) fn tone_mapping(&self) -> String {
        match self.exposures()[..] {
            [] => String::new(),
            [1.0] => "Colours: sRGB encoding of the radiance L, clamped to [0, 1].".to_owned(),
            [exposure] => format!(
                "Colours: sRGB encoding of {} · L, clamped to [0, 1], where L is the radiance.",
                short(exposure)
            ),
            _ => "Colours: sRGB encoding of exposure · L, clamped to [0, 1], where L is the radiance and the exposure stands below \
                  each picture."
                .to_owned(),
        }
    }
}

/// Encodes the pictures of a gallery.
pub(super) fn hung(gallery: &Gallery) -> Result<Hung<'_>, String> {
    let rows = gallery.rows.par_iter().map(|row| row.pictures.par_iter().map(exhibit).collect());
    Ok(Hung { gallery, rows: rows.collect::<Result<_, String>>()? })
}

/// What a small picture may take however noisy it is: palette and headers are a good part of it.
const LEAST: f64 = 2048.0;
/// Bytes per pixel, beyond that, that a picture may take with all its levels. Noise does not compress, and it hides that levels are missing; a
/// smooth picture keeps them all.
const BUDGET: f64 = 0.75;
/// Levels per channel, or colours, of a picture that would take more.
const FEW: u8 = 63;

fn exhibit(picture: &Picture) -> Result<Exhibit<'_>, String> {
    let size = picture.resolution;
    let fits = |png: &[u8]| png.len() as f64 <= LEAST + BUDGET * (size[0] * size[1]) as f64;
    let (png, full, remark) = match &picture.pixels {
        Pixels::Radiance { values, exposure } => {
            let encode = |x: f64| colour_map::grey(exposure * x);
            let (full, few) = if values.iter().all(|[r, g, b]| r == g && g == b) {
                let levels: Vec<u8> = values.iter().map(|rgb| encode(rgb[0])).collect();
                let coarse: Vec<u8> = levels.iter().flat_map(|&level| [coarse(level); 3]).collect();
                (png::grey(&levels, size)?, png::indexed(&coarse, size, png::IMAGE)?)
            } else {
                let colours: Vec<u8> = values.iter().flat_map(|rgb| rgb.map(encode)).collect();
                (png::colour(&colours, size)?, png::few_colours(&colours, size, usize::from(FEW))?)
            };
            let all = fits(&full);
            (if all { full } else { few }, all, clipped(values, *exposure))
        }
        Pixels::Signed { values, scale } => {
            let coloured = |step: &dyn Fn(f64) -> f64| {
                let colours = values.iter().map(|x| colour_map::diverging(step(x / scale)));
                png::indexed(&colours.flat_map(<[u8; 3]>::from).collect::<Vec<_>>(), size, png::IMAGE)
            };
            let full = coloured(&|x| x)?;
            let half = f64::from(FEW / 2);
            let all = fits(&full);
            let png = if all { full } else { coloured(&|x| (x * half).round() / half)? };
            let beyond = values.iter().filter(|x| x.abs() > *scale).count();
            (png, all, told(beyond, values.len(), "beyond the scale"))
        }
    };
    let levels = if full { String::new() } else { format!("shown with {FEW} levels") };
    Ok(Exhibit { picture, png, remark: joined([remark, levels]) })
}

/// The nearest of few levels.
fn coarse(level: u8) -> u8 {
    let few = f64::from(FEW);
    // At most 255.
    ((f64::from(level) * few / 255.0).round() * 255.0 / few).round() as u8
}

/// What was clamped, in words.
fn clipped(values: &[[f64; 3]], exposure: f64) -> String {
    let above = values.iter().filter(|rgb| rgb.iter().any(|x| exposure * x > 1.0)).count();
    let below = values.iter().filter(|rgb| rgb.iter().any(|x| *x < 0.0)).count();
    let parts =
        [told(above, values.len(), "clipped to 1"), told(below, values.len(), "negative, clipped to 0")];
    joined(parts)
}

fn joined(parts: [String; 2]) -> String {
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("; ")
}

fn told(count: usize, all: usize, what: &str) -> String {
    if count == 0 {
        return String::new();
    }
    format!("{} % of the pixels {what}", short(100.0 * count as f64 / all as f64))
}
