//! Comma-separated values (RFC 4180): all digits, units in the header, empty cells for what does not exist.

use crate::{Cell, Column, Table};

/// A header for people.
pub(crate) fn heading(column: &Column) -> String {
    if column.unit.is_empty() { column.title.clone() } else { format!("{} [{}]", column.title, column.unit) }
}

/// The file of a table: a column of intervals becomes three.
pub(crate) fn csv(table: &Table) -> String {
    let spread: Vec<bool> = (0..table.columns.len())
        .map(|k| table.rows.iter().any(|row| matches!(row.get(k), Some(Cell::Measured { .. }))))
        .collect();
    let header = table.columns.iter().zip(&spread).flat_map(|(column, &spread)| {
        let heading = heading(column);
        let ends = ["lower", "upper"].map(|end| format!("{end} end of 95 % interval of {heading}"));
        let ends = if spread { ends.to_vec() } else { Vec::new() };
        std::iter::once(heading.clone()).chain(ends)
    });
    let mut file = line(header.map(|words| quoted(&words)));
    for row in &table.rows {
        file.push_str(&line(row.iter().zip(&spread).flat_map(|(cell, &spread)| written(cell, spread))));
    }
    file
}

fn line(cells: impl Iterator<Item = String>) -> String {
    cells.collect::<Vec<_>>().join(",") + "\n"
}

/// A cell; of a column of intervals the value and both ends.
fn written(cell: &Cell, spread: bool) -> Vec<String> {
    let mut cells = vec![match cell {
        Cell::Text(text) => quoted(text),
        Cell::Number(x) | Cell::Measured { value: x, .. } => number(*x),
        Cell::Count(n) => n.to_string(),
        Cell::Flag(flag) => flag.to_string(),
        Cell::Empty => String::new(),
    }];
    if spread {
        let ends = match cell {
            Cell::Measured { interval: Some(interval), .. } => interval.map(number),
            _ => [String::new(), String::new()],
        };
        cells.extend(ends);
    }
    cells
}

/// The shortest text that reads back as the same number; the words are those that most readers of CSV know.
fn number(x: f64) -> String {
    if x.is_nan() {
        String::new()
    } else if x.is_infinite() {
        if x > 0.0 { "inf" } else { "-inf" }.to_owned()
    } else if x == 0.0 || (1e-4..1e15).contains(&x.abs()) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_reads_back() {
        for x in [0.1, 1.0 / 3.0, 1e-300, 6.02e23, -0.0, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(number(x).parse::<f64>().unwrap(), x);
        }
    }

    #[test]
    fn commas_and_quotes_are_quoted_and_intervals_have_columns() {
        let mut table = Table::new("id", "", "", &[("a", ""), ("b, c", "1")]);
        table.rows.push(vec![Cell::text("say \"x\""), Cell::measured(1.0, [0.5, 2.0])]);
        table.rows.push(vec![Cell::Empty, Cell::Empty]);
        let file = csv(&table);
        let lines: Vec<&str> = file.lines().collect();
        let ends = "\"lower end of 95 % interval of b, c [1]\",\"upper end of 95 % interval of b, c [1]\"";
        assert_eq!(lines, [&*format!("a,\"b, c [1]\",{ends}"), "\"say \"\"x\"\"\",1,0.5,2", ",,,"]);
    }
}
