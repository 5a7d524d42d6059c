//! `results.json`: one line per point. Fully pretty JSON would put each of a hundred thousand numbers on a line of its own.

use serde::Serialize;
use serde_json::ser::Formatter;
use std::io::{Result, Write};

/// Objects down to this depth have a line per field: those that hold curves, but not the points of a curve.
const SPREAD: usize = 5;

/// A value as the file `results.json`.
///
/// # Errors
/// If the value cannot be written as JSON, such as a map whose keys are no words.
pub fn json(report: &impl Serialize) -> serde_json::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    report.serialize(&mut serde_json::Serializer::with_formatter(&mut bytes, Lines::default()))?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Fields of outer objects and objects in arrays begin a line; numbers in arrays do not.
#[derive(Default)]
struct Lines {
    depth: usize,
    /// An element of an array has begun, and it is not known yet whether it is a number or an object.
    element: bool,
}

impl Lines {
    fn line(&self, writer: &mut (impl Write + ?Sized), depth: usize) -> Result<()> {
        writer.write_all(b"\n")?;
        (0..depth).try_for_each(|_| writer.write_all(b" "))
    }

    fn open(&mut self, writer: &mut (impl Write + ?Sized), bracket: &[u8]) -> Result<()> {
        if std::mem::take(&mut self.element) {
            self.line(writer, self.depth)?;
        }
        self.depth += 1;
        writer.write_all(bracket)
    }
}

impl Formatter for Lines {
    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> Result<()> {
        self.open(writer, b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> Result<()> {
        self.depth -= 1;
        writer.write_all(b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> Result<()> {
        self.element = true;
        if first { Ok(()) } else { writer.write_all(b",") }
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, _: &mut W) -> Result<()> {
        self.element = false;
        Ok(())
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> Result<()> {
        self.open(writer, b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> Result<()> {
        self.depth -= 1;
        if self.depth < SPREAD {
            self.line(writer, self.depth)?;
        }
        writer.write_all(b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> Result<()> {
        if !first {
            writer.write_all(b",")?;
        }
        if self.depth <= SPREAD { self.line(writer, self.depth) } else { Ok(()) }
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> Result<()> {
        writer.write_all(if self.depth <= SPREAD { b": " } else { b":" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_of_a_curve_is_a_line() {
        let document = crate::fixture::document();
        let text = String::from_utf8(json(&document).unwrap()).unwrap();
        assert!(text.lines().any(|line| line.starts_with(" \"quick\": ")));
        let points = text.lines().filter(|line| line.trim_start().starts_with("{\"x\""));
        assert!(points.count() > 100);
        assert!(text.lines().count() < 3000);
    }
}
