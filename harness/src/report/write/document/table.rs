//! Tables, rounded for people and exact for machines.

use super::super::number::{measured, short};
use super::super::table;
use crate::report::document::{Cell, Column, Table};

/// A header for people.
pub(super) fn heading(column: &Column) -> String {
    if column.unit.is_empty() { column.title.clone() } else { format!("{} [{}]", column.title, column.unit) }
}

/// A cell for people: three digits, or as many as an interval allows.
pub(super) fn words(cell: &Cell) -> String {
    match cell {
        Cell::Text(text) => text.clone(),
        Cell::Number(x) => short(*x),
        Cell::Count(n) => n.to_string(),
        Cell::Measured { value, interval: Some(interval) } => measured(*value, *interval),
        Cell::Measured { value, interval: None } => short(*value),
        Cell::Flag(true) => "yes".to_owned(),
        Cell::Flag(false) => "no".to_owned(),
        Cell::Empty => "—".to_owned(),
    }
}

/// Whether a cell is a number, which stands on the right.
pub(super) fn is_number(cell: &Cell) -> bool {
    matches!(cell, Cell::Number(_) | Cell::Count(_) | Cell::Measured { .. })
}

/// The file: a column of intervals becomes three.
pub(super) fn csv(table: &Table) -> String {
    let spread: Vec<bool> = (0..table.columns.len())
        .map(|k| table.rows.iter().any(|row| matches!(row.get(k), Some(Cell::Measured { .. }))))
        .collect();
    let mut header = Vec::new();
    for (column, &spread) in table.columns.iter().zip(&spread) {
        header.push(heading(column));
        if spread {
            header.push(format!("lower end of 95 % interval of {}", heading(column)));
            header.push(format!("upper end of 95 % interval of {}", heading(column)));
        }
    }
    let mut file = table::Table::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for row in &table.rows {
        let mut cells = Vec::new();
        for (cell, &spread) in row.iter().zip(&spread) {
            let mut interval = None;
            cells.push(match cell {
                Cell::Text(text) => table::Cell::Text(text),
                Cell::Number(x) => table::Cell::Number(*x),
                Cell::Count(n) => table::Cell::Count(*n),
                Cell::Measured { value, interval: ends } => {
                    interval = *ends;
                    table::Cell::Number(*value)
                }
                Cell::Flag(flag) => table::Cell::Flag(*flag),
                Cell::Empty => table::Cell::Maybe(None),
            });
            if spread {
                cells.extend([0, 1].map(|k| table::Cell::Maybe(interval.map(|ends| ends[k]))));
            }
        }
        file.row(&cells);
    }
    file.into_csv()
}
