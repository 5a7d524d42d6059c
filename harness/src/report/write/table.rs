//! Comma-separated values (RFC 4180): full precision, units in the header, empty cells for what does not exist.

/// A table with one row per point.
pub(crate) struct Table {
    columns: usize,
    text: String,
}

/// One cell.
pub(crate) enum Cell<'a> {
    Text(&'a str),
    Number(f64),
    Maybe(Option<f64>),
    Count(u64),
    Flag(bool),
    MaybeFlag(Option<bool>),
}

impl Table {
    /// A table with these columns and no rows.
    pub(crate) fn new(header: &[&str]) -> Self {
        let mut table = Self { columns: header.len(), text: String::new() };
        table.row(&header.iter().map(|&name| Cell::Text(name)).collect::<Vec<_>>());
        table
    }

    /// Adds a row.
    pub(crate) fn row(&mut self, cells: &[Cell<'_>]) {
        debug_assert_eq!(cells.len(), self.columns, "a row has as many cells as the header");
        let words: Vec<String> = cells.iter().map(Cell::written).collect();
        self.text.push_str(&words.join(","));
        self.text.push('\n');
    }

    /// The file.
    pub(crate) fn into_csv(self) -> String {
        self.text
    }
}

impl Cell<'_> {
    fn written(&self) -> String {
        match *self {
            Self::Text(text) => quoted(text),
            Self::Number(x) | Self::Maybe(Some(x)) => number(x),
            Self::Count(n) => n.to_string(),
            Self::Flag(flag) | Self::MaybeFlag(Some(flag)) => flag.to_string(),
            Self::Maybe(None) | Self::MaybeFlag(None) => String::new(),
        }
    }
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
    fn commas_and_quotes_are_quoted() {
        let mut table = Table::new(&["a", "b, c"]);
        table.row(&[Cell::Text("say \"x\""), Cell::Maybe(None)]);
        assert_eq!(table.into_csv(), "a,\"b, c\"\n\"say \"\"x\"\"\",\n");
    }
}
