//! Images at equal look-ups: estimates in grey, exact first, and their errors in one scale.

use super::super::result::{ImagePanel, ImageStudy};
use fairflight_document::{Gallery, GalleryRow, Picture, Pixels, measured, short};

/// The images of a study.
pub(super) fn gallery(study: &ImageStudy) -> Gallery {
    let id = stem(study);
    let scale = scale(study);
    let exact = Picture {
        id: format!("{id}-exact"),
        label: "exact".to_owned(),
        lines: vec![format!("error at most {}", short(study.exact_error))],
        resolution: study.resolution,
        pixels: grey(&study.exact),
    };
    let numbered = || study.panels.iter().enumerate();
    let estimates = numbered().map(|(k, panel)| Picture {
        id: format!("{id}-{}", k + 1),
        label: panel.name.to_owned(),
        lines: vec![
            format!("RMSE {}", measured(panel.rmse, panel.rmse_interval)),
            format!("{} look-ups", short(panel.lookups_per_pixel)),
        ],
        resolution: study.resolution,
        pixels: grey(&panel.pixels),
    });
    let errors = numbered().map(|(k, panel)| Picture {
        id: format!("{id}-{}-error", k + 1),
        label: format!("error of {}", panel.name),
        lines: Vec::new(),
        resolution: study.resolution,
        pixels: Pixels::Signed {
            values: panel.pixels.iter().zip(&study.exact).map(|(x, exact)| x - exact).collect(),
            scale,
        },
    });
    let row = |pictures| GalleryRow { label: String::new(), pictures };
    Gallery {
        title: format!("Images at {} look-ups per pixel", study.budget),
        caption: caption(study),
        rows: vec![row(std::iter::once(exact).chain(estimates).collect()), row(errors.collect())],
        id,
    }
}

/// A medium may be studied with several budgets.
fn stem(study: &ImageStudy) -> String {
    format!("{}-images-{}", study.medium, study.budget)
}

fn grey(values: &[f64]) -> Pixels {
    Pixels::Radiance { values: values.iter().map(|&t| [t; 3]).collect(), exposure: 1.0 }
}

fn caption(study: &ImageStudy) -> String {
    let least = |is_asked: &dyn Fn(&ImagePanel) -> bool| {
        study.panels.iter().filter(|panel| is_asked(panel)).min_by(|a, b| a.rmse.total_cmp(&b.rmse))
    };
    let unbiased = least(&|panel| !panel.series.is_baseline());
    match (least(&|_| true), unbiased) {
        (Some(all), Some(unbiased)) if all.name == unbiased.name => {
            format!("{} has the least error, RMSE {}.", all.name, short(all.rmse))
        }
        (Some(all), Some(unbiased)) => format!(
            "{} has the least error, RMSE {}, but is biased; of the unbiased methods {} has, RMSE {}.",
            all.name,
            short(all.rmse),
            unbiased.name,
            short(unbiased.rmse)
        ),
        _ => String::new(),
    }
}

/// One scale for all methods of a study, so that their errors compare: twice the median error, rounded up to 1, 2 or 5 times a power of ten.
fn scale(study: &ImageStudy) -> f64 {
    let mut errors: Vec<f64> =
        study.panels.iter().map(|panel| panel.rmse).filter(|rmse| *rmse > 0.0).collect();
    errors.sort_by(f64::total_cmp);
    let Some(median) = errors.get(errors.len() / 2) else { return 1.0 };
    let power = 10_f64.powf((2.0 * median).log10().floor());
    let digits = [1.0, 2.0, 5.0].into_iter().find(|digit| digit * power >= 2.0 * median);
    digits.unwrap_or(10.0) * power
}
