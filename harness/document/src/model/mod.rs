//! Contents of a document: what was measured, in reading order.

mod chart;
mod claim;
mod gallery;
mod heat_map;
mod table;

pub use chart::{Area, Arrangement, Axis, Band, Chart, Curve, Mark, Panel, Point, Role, Scale, Vertical};
pub use claim::{Claim, ClaimVerdict};
pub use gallery::{Gallery, GalleryRow, Picture, Pixels};
pub use heat_map::{Content, Grid, HeatMap, Numbers};
pub use table::{Cell, Column, ColumnOf, Table};

use serde::{Serialize, Serializer};

/// A whole report. All its texts are plain: writers escape as their format asks, and typeset σ_t and its like.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Document {
    /// Origin of the numbers.
    pub provenance: Provenance,
    /// The name by which the report is asked for.
    pub name: String,
    /// Subject, in one line.
    pub title: String,
    /// The answer: findings of one sentence or two each, made of numbers of this document.
    pub summary: Vec<String>,
    /// Id of the chart or heat map that stands beside the answer; it leaves its section.
    pub hero: Option<String>,
    /// True for the quick version, with fewer samples.
    pub quick: bool,
    /// Wall-clock seconds of the whole measurement.
    pub seconds: f64,
    /// Threads that measured.
    pub threads: usize,
    /// Expectations of unbiased estimators that are not met, one sentence each; empty if all is sound.
    pub unsound: Vec<String>,
    /// The ledger of the papers' claims.
    pub claims: Vec<Claim>,
    /// The parts, in reading order.
    pub sections: Vec<Section>,
    /// Labels that look the same in every document, with the number of their look; all others get looks in order of appearance.
    #[serde(skip)]
    pub looks: Vec<(String, usize)>,
}

/// Origin of the numbers of a document.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// The seed of the variates.
    pub seed: u64,
    /// The revision of the program.
    pub revision: String,
    /// The command that made it.
    pub command: String,
}

impl Document {
    /// A document without contents.
    #[must_use]
    pub fn new(name: &str, title: &str, provenance: Provenance) -> Self {
        Self { provenance, name: name.to_owned(), title: title.to_owned(), threads: 1, ..Self::default() }
    }

    /// All blocks, in reading order.
    pub fn blocks(&self) -> impl Iterator<Item = &Block> {
        self.sections.iter().flat_map(|section| &section.blocks)
    }
}

/// A part of a document.
///
/// The ids of sections, charts, heat maps, tables, galleries and pictures are names of files and places in the page: lower case letters,
/// digits, hyphens and points, each once in a document.
#[derive(Clone, Debug, Serialize)]
pub struct Section {
    /// Its place in the page.
    pub id: String,
    /// Its heading.
    pub title: String,
    /// True where only few readers want the contents: the page folds them, with figures that are static files.
    pub folded: bool,
    /// Contents, in reading order.
    pub blocks: Vec<Block>,
}

impl Section {
    /// A section without contents.
    #[must_use]
    pub fn new(id: &str, title: &str) -> Self {
        Self { id: id.to_owned(), title: title.to_owned(), folded: false, blocks: Vec::new() }
    }

    /// The same section, folded in the page.
    #[must_use]
    pub fn folded(self) -> Self {
        Self { folded: true, ..self }
    }

    /// The same section with one more block at its end.
    #[must_use]
    pub fn with(mut self, block: impl Into<Block>) -> Self {
        self.blocks.push(block.into());
        self
    }

    /// The same section with more blocks at its end.
    #[must_use]
    pub fn with_all<B: Into<Block>>(mut self, blocks: impl IntoIterator<Item = B>) -> Self {
        self.blocks.extend(blocks.into_iter().map(Into::into));
        self
    }
}

/// A block of a section.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// Named numbers, in words.
    Facts(Vec<(String, String)>),
    /// A drawing.
    Chart(Chart),
    /// A drawing whose cells are coloured.
    HeatMap(HeatMap),
    /// Rows of numbers.
    Table(Table),
    /// Pictures.
    Gallery(Gallery),
}

/// A conversion from the content of a block.
macro_rules! block_of {
    ($($content:ident),*) => {
        $(impl From<$content> for Block {
            fn from(content: $content) -> Self {
                Self::$content(content)
            }
        })*
    };
}
block_of!(Chart, HeatMap, Table, Gallery);

impl From<&str> for Block {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Block {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

/// JSON has no infinity: it is written as a word, and null means that a quantity does not exist.
pub(crate) fn number<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    match value {
        Some(x) if x.is_infinite() => {
            serializer.serialize_str(if *x > 0.0 { "infinity" } else { "-infinity" })
        }
        Some(x) if !x.is_nan() => serializer.serialize_f64(*x),
        _ => serializer.serialize_none(),
    }
}

/// A number that exists, as [`number`].
pub(crate) fn always<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    number(&Some(*value), serializer)
}

/// Two numbers, either of which may be infinite.
pub(crate) fn ends<S: Serializer>(interval: &Option<[f64; 2]>, serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct End(#[serde(serialize_with = "always")] f64);
    interval.map(|ends| ends.map(End)).serialize(serializer)
}
