//! Writers of reports: they read the data of a report and nothing else.
//!
//! A report is a folder: `results.json`, `tables.md`, `index.html`, and each figure as SVG, PNG and CSV. Call [`prepare`] before the
//! measurement and [`Prepared::commit`] after it. The standard report has figures of its own;
//! `document` writes all other reports. Both share the drawing, the tables, the page's parts and the folder.

mod colour_map;
mod document;
mod draw;
mod figure;
mod folder;
mod images;
mod json;
mod markdown;
mod median_cut;
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

#[cfg(test)]
pub(crate) use document::fixture::document as fixture_document;

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

/// What can be written as a folder of files.
pub trait Files {
    /// Writes all files into an existing folder.
    ///
    /// # Errors
    /// [`Failure::NotWritten`] at the first file that cannot be written; those before it remain.
    fn write(&self, folder: &Path) -> Result<(), Failure>;
}

impl Prepared {
    /// Writes the report, and puts it in place when it is complete.
    ///
    /// # Errors
    /// [`Failure::NotWritten`]; then nothing has changed.
    pub fn commit(self, report: &impl Files) -> Result<(), Failure> {
        report.write(self.partial())?;
        self.put()
    }
}

/// Prepares and commits in one.
#[cfg(test)]
fn write_all_or_nothing(report: &impl Files, folder: &Path) -> Result<(), Failure> {
    prepare(folder)?.commit(report)
}

impl Files for Report {
    fn write(&self, folder: &Path) -> Result<(), Failure> {
        write(self, folder)
    }
}

fn write(report: &Report, folder: &Path) -> Result<(), Failure> {
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
