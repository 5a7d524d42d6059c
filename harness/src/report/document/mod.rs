//! A report as a document: sections of text, charts, heat maps, tables and pictures, whatever was studied.
//!
//! A study fills a [`Document`]; one set of writers turns any of them into files. The standard report has a structure of its own,
//! because its figures share one sweep.

mod chart;
mod gallery;
mod heat_map;
mod table;

pub use chart::{Axis, Band, Chart, Curve, Mark, Point, Role, Scale, Vertical};
pub use gallery::{Gallery, GalleryRow, Picture, Pixels};
pub use heat_map::{Content, HeatMap, Numbers, Panel};
pub use table::{Cell, Column, Table};

use super::result::Claim;
use crate::budget::Budget;
use crate::field::{MediumSpec, VdbSpec};
use crate::result::Provenance;
use serde::Serialize;
use std::path::PathBuf;

/// An OpenVDB fog volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// The file.
    pub file: PathBuf,
    /// The grid; without it `density`, or else the only float grid.
    pub grid: Option<String>,
    /// A factor in front of the voxel values \[1/length\].
    pub scale: f64,
}

impl Volume {
    /// The medium that it is, its voxels nowhere below 0.
    #[must_use]
    pub fn medium(&self) -> MediumSpec {
        let Self { file, grid, scale } = self.clone();
        VdbSpec { file, grid, scale, allow_negative: false, bounds: None }.into()
    }
}

/// The choices of whoever asks for a document.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Fewer points and samples.
    pub quick: bool,
    /// The seed of all variates.
    pub seed: u64,
    /// The threads that measure, for the record: no number but a time depends on them.
    pub threads: usize,
    /// A volume to be studied as well; only some reports take one.
    pub vdb: Option<Volume>,
    /// Of the look-ups in that volume.
    pub budget: Budget,
}

/// A whole report. All its texts are plain: writers escape what their format needs, and typeset σ_t and its like.
#[derive(Clone, Debug, Serialize)]
pub struct Document {
    /// Where the numbers come from.
    pub provenance: Provenance,
    /// The name by which the report is asked for.
    pub name: String,
    /// What it is about, in one line.
    pub title: String,
    /// The findings, one paragraph each, made of numbers of this document.
    pub summary: Vec<String>,
    /// Whether this is the quick version, with fewer samples.
    pub quick: bool,
    /// Wall-clock seconds of the whole measurement.
    pub seconds: f64,
    /// Threads that measured.
    pub threads: usize,
    /// What was expected of unbiased estimators and is not so, one sentence each; empty if all is sound.
    pub unsound: Vec<String>,
    /// The ledger of the papers' claims.
    pub claims: Vec<Claim>,
    /// The parts, in reading order.
    pub sections: Vec<Section>,
}

/// A part of a document: its text first, then its charts, heat maps, tables and galleries.
///
/// The ids of sections, charts, heat maps, tables, galleries and pictures are names of files and places in the page: lower case letters,
/// digits, hyphens and points, each once in a document.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Section {
    /// Its place in the page.
    pub id: String,
    /// Its heading.
    pub title: String,
    /// Paragraphs.
    pub text: Vec<String>,
    /// Drawings.
    pub charts: Vec<Chart>,
    /// Drawings whose cells are coloured.
    pub heat_maps: Vec<HeatMap>,
    /// Tables.
    pub tables: Vec<Table>,
    /// Pictures.
    pub galleries: Vec<Gallery>,
}

impl Section {
    /// A section without contents.
    #[must_use]
    pub fn new(id: &str, title: &str) -> Self {
        Self { id: id.to_owned(), title: title.to_owned(), ..Self::default() }
    }
}
