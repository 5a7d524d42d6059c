//! What must hold of a document before it is written. A violation is a mistake of the study, and is told as such.

use crate::report::document::{Axis, Document, Gallery, Pixels, Scale, Table};

/// Names that writers use themselves.
const RESERVED: [&str; 7] = ["index", "results", "tables", "summary", "soundness", "claims", "provenance"];

/// Names the first thing that is wrong.
pub(super) fn check(document: &Document) -> Result<(), String> {
    let mut seen: Vec<&str> = RESERVED.to_vec();
    let mut ids: Vec<&str> = Vec::new();
    for section in &document.sections {
        ids.push(&section.id);
        for chart in &section.charts {
            ids.push(&chart.id);
            for axis in [&chart.x, &chart.y] {
                range(axis).map_err(|error| format!("chart {}: {error}", chart.id))?;
            }
        }
        for table in &section.tables {
            ids.push(&table.id);
            rows(table).map_err(|error| format!("table {}: {error}", table.id))?;
        }
        for gallery in &section.galleries {
            ids.push(&gallery.id);
            ids.extend(gallery.rows.iter().flat_map(|row| &row.pictures).map(|picture| &*picture.id));
            pictures(gallery)?;
        }
    }
    for &name in &ids {
        if !is_name(name) {
            return Err(format!("the id {name:?} is not lower case letters, digits, hyphens and points"));
        }
        if seen.contains(&name) {
            return Err(format!("the id {name} is used twice, or by the report itself"));
        }
        seen.push(name);
    }
    Ok(())
}

fn is_name(id: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '.';
    id.starts_with(|c: char| c.is_ascii_lowercase()) && id.chars().all(plain)
}

fn range(axis: &Axis) -> Result<(), String> {
    let Some([low, high]) = axis.range else { return Ok(()) };
    let least = if axis.scale == Scale::Logarithmic { 0.0 } else { f64::NEG_INFINITY };
    if low > least && high > low && high < f64::INFINITY {
        Ok(())
    } else {
        Err(format!("the axis \"{}\" cannot show {low} to {high}", axis.title))
    }
}

fn rows(table: &Table) -> Result<(), String> {
    match table.rows.iter().position(|row| row.len() != table.columns.len()) {
        None => Ok(()),
        Some(k) => {
            Err(format!("row {k} has {} cells for {} columns", table.rows[k].len(), table.columns.len()))
        }
    }
}

fn pictures(gallery: &Gallery) -> Result<(), String> {
    for picture in gallery.rows.iter().flat_map(|row| &row.pictures) {
        let failed = |what: String| Err(format!("picture {}: {what}", picture.id));
        let [width, height] = picture.resolution;
        let (pixels, factor, strange) = match &picture.pixels {
            Pixels::Radiance { values, exposure } => {
                (values.len(), *exposure, values.iter().position(|rgb| rgb.iter().any(|x| !x.is_finite())))
            }
            Pixels::Signed { values, scale } => {
                (values.len(), *scale, values.iter().position(|x| !x.is_finite()))
            }
        };
        if pixels == 0 || pixels != width * height {
            return failed(format!("{pixels} pixels for a resolution of {width} x {height}"));
        }
        if !(factor > 0.0 && factor.is_finite()) {
            return failed(format!("the exposure or scale {factor} is not positive"));
        }
        if let Some(k) = strange {
            return failed(format!("the pixel in column {}, row {} is not finite", k % width, k / width));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::fixture::document;
    use super::*;

    fn refused(spoil: impl FnOnce(&mut Document)) -> String {
        let mut document = document();
        assert_eq!(check(&document), Ok(()));
        spoil(&mut document);
        check(&document).unwrap_err()
    }

    #[test]
    fn mistakes_of_a_study_are_told() {
        let twice = refused(|document| document.sections[0].charts[0].id = document.sections[0].id.clone());
        assert!(twice.contains("twice"), "{twice}");
        assert!(refused(|document| document.sections[0].id = "claims".to_owned()).contains("itself"));
        assert!(refused(|document| document.sections[0].id = "../x".to_owned()).contains("lower case"));
        assert!(
            refused(|document| document.sections[0].charts[0].y.range = Some([0.0, 1.0])).contains("axis")
        );
        let short = refused(|document| {
            document.sections[0].tables[0].rows[1].pop();
        });
        assert!(short.contains("row 1"), "{short}");
        let pixel = refused(|document| {
            let picture = &mut document.sections[1].galleries[0].rows[0].pictures[0];
            let Pixels::Radiance { values, .. } = &mut picture.pixels else { panic!("a radiance") };
            values[picture.resolution[0] + 2][1] = f64::NAN;
        });
        assert!(pixel.contains("column 2, row 1"), "{pixel}");
    }
}
