//! Pictures of a document, one image pixel per pixel.

use crate::{Gallery, Picture, Pixels, colour_map, png, short};

/// Encodes a picture.
pub(crate) fn encoded(picture: &Picture) -> Result<Vec<u8>, String> {
    let size = picture.resolution;
    match &picture.pixels {
        Pixels::Radiance { values, exposure } => {
            let encode = |x: f64| colour_map::grey(exposure * x);
            if values.iter().all(|[r, g, b]| r == g && g == b) {
                png::grey(&values.iter().map(|rgb| encode(rgb[0])).collect::<Vec<_>>(), size)
            } else {
                png::colour(&values.iter().flat_map(|rgb| rgb.map(encode)).collect::<Vec<_>>(), size)
            }
        }
        Pixels::Signed { values, scale } => {
            let colours = values.iter().map(|x| colour_map::diverging(x / scale));
            png::colour(&colours.flat_map(<[u8; 3]>::from).collect::<Vec<_>>(), size)
        }
    }
}

/// Remarks on a picture: the exposure where pictures of a gallery differ in it, and pixels that the colours cannot show.
pub(crate) fn remarks(gallery: &Gallery, picture: &Picture) -> Vec<String> {
    let mut remarks = Vec::new();
    let mut share = |count: usize, words: &str| {
        if count > 0 {
            let all = picture.resolution[0] * picture.resolution[1];
            remarks.push(format!("{} % of the pixels {words}", short(100.0 * count as f64 / all as f64)));
        }
    };
    match &picture.pixels {
        Pixels::Radiance { values, exposure } => {
            share(values.iter().filter(|rgb| rgb.iter().any(|x| exposure * x > 1.0)).count(), "clipped to 1");
            share(values.iter().filter(|rgb| rgb.iter().any(|x| *x < 0.0)).count(), "negative, clipped to 0");
            if exposures(gallery).len() > 1 {
                remarks.insert(0, format!("exposure {}", short(*exposure)));
            }
        }
        Pixels::Signed { values, scale } => {
            share(values.iter().filter(|x| x.abs() > *scale).count(), "beyond the scale");
        }
    }
    remarks
}

/// The scales of the signed pictures, each once.
pub(crate) fn scales(gallery: &Gallery) -> Vec<f64> {
    each(gallery, |pixels| match pixels {
        Pixels::Signed { scale, .. } => Some(*scale),
        Pixels::Radiance { .. } => None,
    })
}

fn exposures(gallery: &Gallery) -> Vec<f64> {
    each(gallery, |pixels| match pixels {
        Pixels::Radiance { exposure, .. } => Some(*exposure),
        Pixels::Signed { .. } => None,
    })
}

fn each(gallery: &Gallery, number: impl Fn(&Pixels) -> Option<f64>) -> Vec<f64> {
    let pictures = gallery.rows.iter().flat_map(|row| &row.pictures);
    let mut numbers: Vec<f64> = pictures.filter_map(|picture| number(&picture.pixels)).collect();
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
    numbers
}

/// Law by which radiance becomes colour, in words; empty where there is none.
pub(crate) fn tone_mapping(gallery: &Gallery) -> String {
    match exposures(gallery)[..] {
        [] => String::new(),
        [1.0] => "Colours: sRGB encoding of the value L, clamped to [0, 1].".to_owned(),
        [exposure] => format!("Colours: sRGB encoding of {} · L, clamped to [0, 1].", short(exposure)),
        _ => "Colours: sRGB encoding of exposure · L, clamped to [0, 1]; the exposure stands below each picture."
            .to_owned(),
    }
}
