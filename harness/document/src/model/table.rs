//! Rows of numbers, as numbers: each writer rounds for its readers.

use super::{always, ends};
use serde::Serialize;

/// A table.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// Name of its file without ending.
    pub id: String,
    /// One line.
    pub title: String,
    /// Contents.
    pub caption: String,
    /// Line under which the page folds a long table; without it the number of rows stands there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub folded: Option<String>,
    /// The header.
    pub columns: Vec<Column>,
    /// As many cells in each as there are columns.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table without rows; columns are titles and units, the unit empty where there is none.
    #[must_use]
    pub fn new(id: &str, title: &str, caption: &str, columns: &[(&str, &str)]) -> Self {
        let column =
            |&(title, unit): &(&str, &str)| Column { title: title.to_owned(), unit: unit.to_owned() };
        Self {
            id: id.to_owned(),
            title: title.to_owned(),
            caption: caption.to_owned(),
            folded: None,
            columns: columns.iter().map(column).collect(),
            rows: Vec::new(),
        }
    }
}

impl Table {
    /// The same table, folded in the page under this line.
    #[must_use]
    pub fn folded(self, line: String) -> Self {
        Self { folded: Some(line), ..self }
    }
}

/// A column of a table of T: title, unit, and cell of a row.
pub type ColumnOf<'a, T> = (&'a str, &'a str, &'a dyn Fn(&T) -> Cell);

impl Table {
    /// A table with a row for each of `rows`.
    #[must_use]
    pub fn of<T>(
        [id, title, caption]: [&str; 3],
        rows: impl IntoIterator<Item = T>,
        columns: &[ColumnOf<'_, T>],
    ) -> Self {
        let header: Vec<(&str, &str)> = columns.iter().map(|(title, unit, _)| (*title, *unit)).collect();
        let cells = |row: T| columns.iter().map(|(.., cell)| cell(&row)).collect();
        Self { rows: rows.into_iter().map(cells).collect(), ..Self::new(id, title, caption, &header) }
    }
}

/// A column.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Column {
    /// Quantity.
    pub title: String,
    /// Its unit, "1" for a pure number; empty where a unit makes no sense.
    pub unit: String,
}

/// A cell.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number without error.
    Number(#[serde(serialize_with = "always")] f64),
    /// A whole number, written with all its digits.
    Count(u64),
    /// A number with its 95 % interval.
    Measured {
        /// The number.
        #[serde(serialize_with = "always")]
        value: f64,
        /// The interval.
        #[serde(serialize_with = "ends")]
        interval: Option<[f64; 2]>,
    },
    /// Yes or no.
    Flag(bool),
    /// Nothing: the quantity does not exist.
    Empty,
}

impl Cell {
    /// Words.
    #[must_use]
    pub fn text(words: impl Into<String>) -> Self {
        Self::Text(words.into())
    }

    /// A number with its 95 % interval.
    #[must_use]
    pub fn measured(value: f64, interval: [f64; 2]) -> Self {
        Self::Measured { value, interval: Some(interval) }
    }

    /// A number if there is one.
    #[must_use]
    pub fn maybe(value: Option<f64>) -> Self {
        value.map_or(Self::Empty, Self::Number)
    }
}
