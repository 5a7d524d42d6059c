//! Documents of measurements, and the writers that turn them into files.
//!
//! A [`Document`] is data: text, facts, charts, heat maps, tables, pictures, claims. [`files`] makes of it a page that opens without
//! network, each figure as SVG, PNG and CSV, each table as CSV, and all tables in Markdown. Writers compute nothing but places, colours and
//! roundings. This package knows no estimator, no file system and no clock.
//!
//! ```
//! use fairflight_document::{Axis, Chart, Curve, Document, Mark, Provenance, Script, Section, files};
//!
//! let mut chart = Chart::new("decay", "Decay", Axis::linear("s [length]"), Axis::logarithmic("T [1]"));
//! chart.panels[0].curves = vec![
//!     Curve::reference("exact", (0..9).map(|s| (f64::from(s), (-f64::from(s)).exp()))),
//!     Curve::method("measured").with_marks([Mark::measured(2.0, 0.14, [0.12, 0.16])]),
//! ];
//! let section = Section::new("decay-section", "Decay").with(chart);
//! let document = Document { sections: vec![section], ..Document::new("decays", "A decay", Provenance::default()) };
//! let names: Vec<String> = files(&document, Script::None)?.into_iter().map(|file| file.name).collect();
//! assert_eq!(names, ["index.html", "tables.md", "decay.svg", "decay.png", "decay.csv"]);
//! # Ok::<(), String>(())
//! ```

mod check;
mod colour_map;
mod csv;
mod figure;
mod interactive;
mod json;
mod markdown;
mod model;
mod number;
mod page;
mod palette;
mod picture;
mod png;
mod write;

#[cfg(test)]
mod browser;
#[cfg(test)]
mod fixture;
#[cfg(test)]
mod tests;

pub use json::json;
pub use model::*;
pub use number::{listed, measured, power_of_ten, short, short_of_log10};
pub use write::{File, Script, files};
