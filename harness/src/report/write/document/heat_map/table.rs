//! All cells as CSV, and a summary for people.

use super::super::super::number::short;
use super::super::super::table::{Cell, Table};
use super::names_in;
use crate::report::document::{Content, HeatMap, Panel};

/// One row per cell.
pub(super) fn csv(map: &HeatMap) -> String {
    let mut header = vec!["panel", &*map.x.title, &*map.y.title];
    match &map.content {
        Content::Values { colours, panels, .. } => {
            header.push(&colours.title);
            let mut table = Table::new(&header);
            for panel in panels {
                for (x, y, value) in panel.cells() {
                    table.row(&[
                        Cell::Text(&panel.label),
                        Cell::Number(x),
                        Cell::Number(y),
                        Cell::Maybe(*value),
                    ]);
                }
            }
            table.into_csv()
        }
        Content::Names { names, panels, numbers } => {
            header.push("name");
            header.extend(numbers.as_ref().map(|numbers| &*numbers.axis.title));
            let mut table = Table::new(&header);
            for (k, panel) in panels.iter().enumerate() {
                for (cell, (x, y, name)) in panel.cells().enumerate() {
                    let name = name.map_or("", |name| &*names[name]);
                    let mut row =
                        vec![Cell::Text(&panel.label), Cell::Number(x), Cell::Number(y), Cell::Text(name)];
                    row.extend(numbers.as_ref().map(|numbers| Cell::Maybe(numbers.panels[k][cell])));
                    table.row(&row);
                }
            }
            table.into_csv()
        }
    }
}

/// Header and rows: per panel the least, the median and the greatest value and where the extremes are; or per name its share of the cells.
pub(in super::super) fn summary(map: &HeatMap) -> (Vec<String>, Vec<Vec<String>>) {
    match &map.content {
        Content::Values { colours, panels, .. } => {
            let place = |end: &str| format!("at {}, {} ({end})", map.x.title, map.y.title);
            let header = vec![
                "panel".to_owned(),
                format!("least {}", colours.title),
                place("least"),
                "median".to_owned(),
                "greatest".to_owned(),
                place("greatest"),
                "cells without a value".to_owned(),
            ];
            (header, panels.iter().map(extremes).collect())
        }
        Content::Names { names, panels, .. } => {
            let mut header = vec!["share of the cells in %".to_owned()];
            header.extend(panels.iter().map(|panel| panel.label.clone()));
            let share = |panel: &Panel<Option<usize>>, which: Option<usize>| {
                let count = panel.values.iter().filter(|&&name| name == which).count();
                short(100.0 * count as f64 / panel.values.len() as f64)
            };
            let row = |label: &str, which: Option<usize>| {
                let shares = panels.iter().map(|panel| share(panel, which));
                std::iter::once(label.to_owned()).chain(shares).collect::<Vec<_>>()
            };
            let shown = names_in(map);
            let mut rows: Vec<_> = names
                .iter()
                .enumerate()
                .filter(|(_, name)| shown.contains(&&***name))
                .map(|(k, name)| row(name, Some(k)))
                .collect();
            if panels.iter().any(|panel| panel.values.contains(&None)) {
                rows.push(row("no value", None));
            }
            (header, rows)
        }
    }
}

fn extremes(panel: &Panel<Option<f64>>) -> Vec<String> {
    let mut cells: Vec<(f64, f64, f64)> = panel
        .cells()
        .filter_map(|(x, y, value)| Some((x, y, value.filter(|value| !value.is_nan())?)))
        .collect();
    cells.sort_by(|a, b| a.2.total_cmp(&b.2));
    let missing = (panel.values.len() - cells.len()).to_string();
    let (Some(least), Some(greatest)) = (cells.first(), cells.last()) else {
        return [&panel.label, "—", "—", "—", "—", "—", &*missing].map(str::to_owned).to_vec();
    };
    let place = |cell: &(f64, f64, f64)| format!("{}, {}", short(cell.0), short(cell.1));
    let middle = (cells[(cells.len() - 1) / 2].2, cells[cells.len() / 2].2);
    vec![
        panel.label.clone(),
        short(least.2),
        place(least),
        short(f64::midpoint(middle.0, middle.1)),
        short(greatest.2),
        place(greatest),
        missing,
    ]
}
