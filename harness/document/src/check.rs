//! Laws of a document, checked before it is written. A violation is a mistake of the study, and is told as such.

use crate::{Axis, Block, Chart, Content, Document, Gallery, Grid, HeatMap, Pixels, Scale, Table};

/// Names that writers use themselves.
const RESERVED: [&str; 7] = ["index", "results", "tables", "summary", "soundness", "claims", "provenance"];

/// Names the first mistake.
pub(crate) fn check(document: &Document) -> Result<(), String> {
    let mut seen: Vec<&str> = RESERVED.to_vec();
    let mut ids: Vec<&str> = document.sections.iter().map(|section| &*section.id).collect();
    for block in document.blocks() {
        match block {
            Block::Text(_) | Block::Facts(_) => {}
            Block::Chart(chart) => {
                ids.push(&chart.id);
                panels(chart).map_err(|error| format!("chart {}: {error}", chart.id))?;
            }
            Block::HeatMap(map) => {
                ids.push(&map.id);
                heat_map(map).map_err(|error| format!("heat map {}: {error}", map.id))?;
            }
            Block::Table(table) => {
                ids.push(&table.id);
                rows(table).map_err(|error| format!("table {}: {error}", table.id))?;
            }
            Block::Gallery(gallery) => {
                ids.push(&gallery.id);
                ids.extend(gallery.rows.iter().flat_map(|row| &row.pictures).map(|picture| &*picture.id));
                pictures(gallery)?;
            }
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
    if let Some(hero) = &document.hero {
        let drawn = document.blocks().any(|block| match block {
            Block::Chart(chart) => chart.id == *hero,
            Block::HeatMap(map) => map.id == *hero,
            _ => false,
        });
        if !drawn {
            return Err(format!("there is no figure {hero} to stand beside the answer"));
        }
    }
    Ok(())
}

fn panels(chart: &Chart) -> Result<(), String> {
    if chart.panels.is_empty() {
        return Err("there is no panel".to_owned());
    }
    chart.panels.iter().flat_map(|panel| [&panel.x, &panel.y]).try_for_each(range)
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

fn heat_map(map: &HeatMap) -> Result<(), String> {
    [&map.x, &map.y].into_iter().try_for_each(range)?;
    let (axis, isolines) = match &map.content {
        Content::Values { colours, isolines, panels } => {
            some_panels(map, panels)?;
            (colours, isolines)
        }
        Content::Names { names, panels, numbers } => {
            some_panels(map, panels)?;
            let all = || panels.iter().flat_map(|panel| &panel.values);
            if let Some(place) = all().flatten().find(|place| **place >= names.len()) {
                return Err(format!("a cell has name {place} of {}", names.len()));
            }
            let Some(numbers) = numbers else { return Ok(()) };
            let counts = |lists: &mut dyn Iterator<Item = usize>| lists.collect::<Vec<_>>();
            let cells = counts(&mut panels.iter().map(|panel| panel.values.len()));
            let given = counts(&mut numbers.panels.iter().map(Vec::len));
            if given != cells {
                return Err(format!("{given:?} numbers for {cells:?} cells"));
            }
            (&numbers.axis, &numbers.isolines)
        }
    };
    range(axis)?;
    match isolines.iter().find(|level| !has_place(axis, **level)) {
        Some(level) => Err(format!("the axis \"{}\" has no place for a line at {level}", axis.title)),
        None => Ok(()),
    }
}

fn some_panels<T>(map: &HeatMap, panels: &[Grid<T>]) -> Result<(), String> {
    if panels.is_empty() {
        return Err("there is no panel".to_owned());
    }
    for panel in panels {
        let (columns, rows) = (panel.x.len(), panel.y.len());
        if columns * rows == 0 || panel.values.len() != columns * rows {
            let count = panel.values.len();
            return Err(format!("panel {:?} has {count} values for {columns} x {rows} cells", panel.label));
        }
        for (axis, centres) in [(&map.x, &panel.x), (&map.y, &panel.y)] {
            let increasing = centres.windows(2).all(|pair| pair[0] < pair[1]);
            if !(increasing && centres.iter().all(|&centre| has_place(axis, centre))) {
                return Err(format!(
                    "the axis \"{}\" needs increasing centres that it can show, not {centres:?}",
                    axis.title
                ));
            }
        }
    }
    Ok(())
}

/// Whether a value is finite, and positive on a logarithmic axis.
fn has_place(axis: &Axis, value: f64) -> bool {
    value.is_finite() && (axis.scale == Scale::Linear || value > 0.0)
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

    /// Spoils the blocks of one kind.
    macro_rules! spoil {
        ($kind:ident, $name:ident => $spoil:expr) => {
            refused(|document| {
                for block in document.sections.iter_mut().flat_map(|section| &mut section.blocks) {
                    if let Block::$kind($name) = block {
                        $spoil;
                    }
                }
            })
        };
    }

    #[test]
    fn mistakes_of_a_study_are_told() {
        assert!(spoil!(Chart, chart => chart.id = "measured".to_owned()).contains("twice"));
        assert!(refused(|document| document.sections[0].id = "claims".to_owned()).contains("itself"));
        assert!(refused(|document| document.sections[0].id = "../x".to_owned()).contains("lower case"));
        assert!(refused(|document| document.hero = Some("nobody".to_owned())).contains("nobody"));
        assert!(spoil!(Chart, chart => chart.panels[0].y.range = Some([f64::NAN, 1.0])).contains("axis"));
        assert!(spoil!(Chart, chart => chart.panels.clear()).contains("no panel"));
        assert!(spoil!(Table, table => _ = table.rows[1].pop()).contains("row 1"));
        let pixel = spoil!(Gallery, gallery => {
            let picture = &mut gallery.rows[0].pictures[0];
            let Pixels::Radiance { values, .. } = &mut picture.pixels else { panic!("a radiance") };
            values[picture.resolution[0] + 2][1] = f64::NAN;
        });
        assert!(pixel.contains("column 2, row 1"), "{pixel}");
    }

    #[test]
    fn mistakes_in_heat_maps_are_told() {
        let values = |spoil: fn(&mut Vec<Grid<Option<f64>>>, &mut Vec<f64>)| {
            spoil!(HeatMap, map => if let Content::Values { panels, isolines, .. } = &mut map.content {
                spoil(panels, isolines);
            })
        };
        let short = values(|panels, _| _ = panels[1].values.pop());
        assert!(short.contains("\"cos\" has 383 values for 24 x 16 cells"), "{short}");
        assert!(values(|panels, _| panels.clear()).contains("no panel"));
        assert!(values(|panels, _| panels[0].x.swap(0, 1)).contains("increasing"));
        assert!(values(|panels, _| panels[0].y[0] = -1.0).contains("tightness"));
        assert!(values(|_, isolines| isolines.push(0.0)).contains("line at 0"));

        type Names = Vec<Grid<Option<usize>>>;
        let names = |spoil: fn(&mut Names, &mut Vec<Vec<Option<f64>>>)| {
            spoil!(HeatMap, map => if let Content::Names { panels, numbers: Some(numbers), .. } = &mut map.content {
                spoil(panels, &mut numbers.panels);
            })
        };
        assert!(names(|panels, _| panels[0].values[7] = Some(6)).contains("name 6 of 6"));
        assert!(names(|_, numbers| _ = numbers.pop()).contains("numbers for"));
    }
}
