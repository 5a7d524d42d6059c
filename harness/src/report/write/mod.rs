//! Writers of the standard report: they read the [`Report`] and nothing else.
//!
//! A report is a folder: `results.json`, `tables.md`, `index.html`, and each figure as SVG, PNG and CSV. Call [`prepare`] before the
//! measurement and [`Prepared::commit`] after it, or [`write_all_or_nothing`] for both.

mod colour_map;
mod draw;
mod figure;
mod folder;
mod images;
mod json;
mod markdown;
mod number;
mod optimum;
mod page;
mod palette;
mod png;
mod table;

#[cfg(test)]
mod fixture;
#[cfg(test)]
mod tests;

pub use folder::Prepared;

use super::result::Report;
use crate::Failure;
use std::path::Path;

/// Makes sure that `folder` can be written, before anything is measured.
///
/// # Errors
/// [`Failure::NotWritten`] if there is something else than an older report, or no permission.
pub fn prepare(folder: &Path) -> Result<Prepared, Failure> {
    Prepared::new(folder)
}

impl Prepared {
    /// Writes the report, and puts it in place when it is complete.
    ///
    /// # Errors
    /// [`Failure::NotWritten`]; then nothing has changed.
    pub fn commit(self, report: &Report) -> Result<(), Failure> {
        write(report, self.partial())?;
        self.put()
    }
}

/// Prepares and commits in one.
///
/// # Errors
/// [`Failure::NotWritten`]; then nothing has changed.
pub fn write_all_or_nothing(report: &Report, folder: &Path) -> Result<(), Failure> {
    prepare(folder)?.commit(report)
}

/// Writes all files of a report into an existing folder.
///
/// # Errors
/// [`Failure::NotWritten`] at the first file that cannot be written; those before it remain.
pub fn write(report: &Report, folder: &Path) -> Result<(), Failure> {
    let failed = |reason: String| Failure::not_written(folder, reason);
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).map_err(|error| Failure::not_written(&path, error))
    };
    file(folder::RESULTS, &json::json(report).map_err(|error| failed(error.to_string()))?)?;
    file(markdown::FILE, markdown::tables(report).as_bytes())?;

    let figures = figure::all(report).map_err(failed)?;
    for figure in &figures {
        file(&format!("{}.svg", figure.id), figure.drawing.svg.as_bytes())?;
        file(&format!("{}.png", figure.id), &figure.drawing.png)?;
        file(&format!("{}.csv", figure.id), figure.csv.as_bytes())?;
    }
    let galleries =
        report.images.iter().map(images::gallery).collect::<Result<Vec<_>, _>>().map_err(failed)?;
    for gallery in &galleries {
        file(&format!("{}.csv", gallery.id()), gallery.csv.as_bytes())?;
        let panels = gallery.panels.iter().flat_map(|exhibit| [&exhibit.estimate, &exhibit.error]);
        for picture in std::iter::once(&gallery.exact).chain(panels) {
            file(&picture.file, &picture.png)?;
        }
    }
    let page = page::html(report, &figures, &galleries).map_err(failed)?;
    file("index.html", page.as_bytes())
}
