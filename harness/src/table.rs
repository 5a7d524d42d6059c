//! Tables of text.

/// Text of a number to so many digits; as a power of ten where it is far from 1.
pub(crate) fn digits(value: f64, count: i32) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        let after = (count - 1).max(0) as usize;
        return format!("{value:.after$e}");
    }
    let magnitude = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    let after = (count - 1 - magnitude).clamp(0, count + 2) as usize;
    format!("{value:.after$}")
}

/// The rows with their columns aligned: the first to the left, the others to the right.
pub(crate) fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| match column {
            0 => format!("{cell:width$}"),
            _ => format!("{cell:>width$}"),
        });
        text += cells.collect::<Vec<_>>().join("  ").trim_end();
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits() {
        let found = [1.0, 12.34, 123.4, 0.012_34, 1.234e7, 0.0].map(|value| digits(value, 3));
        assert_eq!(found, ["1.00", "12.3", "123", "0.0123", "1.23e7", "0.00"]);
        assert_eq!(digits(0.032_853_9, 6), "0.0328539");
    }

    #[test]
    fn columns_are_aligned() {
        let row = |cells: [&str; 3]| cells.map(str::to_owned).to_vec();
        let text = aligned(&[row(["name", "x", "y"]), row(["a", "12.5", ""]), row(["longer", "1", "2"])]);
        assert_eq!(text, "name       x  y\na       12.5\nlonger     1  2\n");
    }
}
