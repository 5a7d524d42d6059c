//! Numbers behind figures, as tables.

use crate::number::drawn;
use crate::{Cell, Chart, Content, Grid, HeatMap, Mark, Panel, Table, short};

/// All points of a chart: lines, marks and areas.
pub(crate) fn of_chart(chart: &Chart) -> Table {
    let mut table = header(chart);
    for panel in &chart.panels {
        for curve in &panel.curves {
            let named =
                |part: &str| vec![Cell::text(&panel.heading), Cell::text(&curve.label), Cell::text(part)];
            for point in &curve.line {
                let cells = [Cell::Number(point.x), Cell::maybe(point.y), Cell::Empty];
                table.rows.push([named("line"), cells.to_vec()].concat());
            }
            for area in &curve.area {
                let cells = [Cell::Number(area.x), Cell::measured(f64::NAN, area.y), Cell::Empty];
                table.rows.push([named("area"), cells.to_vec()].concat());
            }
            table.rows.extend(curve.marks.iter().map(|mark| [named("mark"), cells(mark)].concat()));
        }
    }
    without_empty_headings(chart, table)
}

/// Measured values of a chart; where there are none, its lines.
pub(crate) fn measured(chart: &Chart) -> Table {
    let mut table = of_chart(chart);
    let is_mark = |row: &Vec<Cell>| row.contains(&Cell::text("mark"));
    if table.rows.iter().any(is_mark) {
        table.rows.retain(is_mark);
    }
    table
}

fn header(chart: &Chart) -> Table {
    let Panel { x, y, .. } = &chart.panels[0];
    let columns =
        [("panel", ""), ("curve", ""), ("part", ""), (&*x.title, ""), (&*y.title, ""), ("testable", "")];
    Table::new(&chart.id, &chart.title, "", &columns)
}

fn cells(mark: &Mark) -> Vec<Cell> {
    let value = Cell::Measured { value: mark.y, interval: mark.interval };
    vec![Cell::Number(mark.x), value, Cell::Flag(mark.solid)]
}

fn without_empty_headings(chart: &Chart, mut table: Table) -> Table {
    if chart.panels.iter().all(|panel| panel.heading.is_empty()) {
        table.columns.remove(0);
        table.rows.iter_mut().for_each(|row| _ = row.remove(0));
    }
    table
}

/// Table of a heat map: a row for each cell.
pub(crate) fn of_heat_map(map: &HeatMap) -> Table {
    let name = |k: &Option<usize>| match &map.content {
        Content::Names { names, .. } => k.map_or(Cell::Empty, |k| Cell::text(&names[k])),
        Content::Values { .. } => Cell::Empty,
    };
    let (x, y) = (&*map.x.title, &*map.y.title);
    let mut rows = Vec::new();
    let mut header = vec![("panel", ""), (x, ""), (y, "")];
    match &map.content {
        Content::Values { colours, panels, .. } => {
            header.push((&colours.title, ""));
            for panel in panels {
                rows.extend(places(panel).map(|(place, value)| [place, vec![Cell::maybe(*value)]].concat()));
            }
        }
        Content::Names { panels, numbers, .. } => {
            header.push(("name", ""));
            header.extend(numbers.iter().map(|numbers| (&*numbers.axis.title, "")));
            for (k, panel) in panels.iter().enumerate() {
                for (i, (place, value)) in places(panel).enumerate() {
                    let number = numbers.iter().map(|numbers| Cell::maybe(numbers.panels[k][i]));
                    rows.push([place, vec![name(value)], number.collect()].concat());
                }
            }
        }
    }
    Table { rows, ..Table::new(&map.id, &map.title, &map.caption, &header) }
}

/// The same table with as many digits as a figure shows.
pub(crate) fn rounded(mut table: Table) -> Table {
    for cell in table.rows.iter_mut().flatten() {
        match cell {
            Cell::Number(x) => *x = drawn(*x),
            Cell::Measured { value, interval } => {
                *value = drawn(*value);
                *interval = interval.map(|ends| ends.map(drawn));
            }
            _ => {}
        }
    }
    table
}

fn places<T>(panel: &Grid<T>) -> impl Iterator<Item = (Vec<Cell>, &T)> {
    panel
        .cells()
        .map(|(x, y, value)| (vec![Cell::text(&panel.label), Cell::Number(x), Cell::Number(y)], value))
}

/// A heat map in few numbers: the range of each panel, or the share of each name in each panel.
pub(crate) fn summary(map: &HeatMap) -> Table {
    let (header, rows): (Vec<(String, &str)>, Vec<Vec<Cell>>) = match &map.content {
        Content::Values { colours, panels, .. } => {
            let of = |which: &str| (format!("{which} {}", colours.title), "");
            let cells =
                [("panel", ""), ("cells without a value", "")].map(|(title, unit)| (title.to_owned(), unit));
            let [panel, without] = cells;
            (
                vec![panel, of("least"), of("median"), of("greatest"), without],
                panels.iter().map(range).collect(),
            )
        }
        Content::Names { names, panels, .. } => {
            let mut header = vec![("share of the cells [%]".to_owned(), "")];
            header.extend(panels.iter().map(|panel| (panel.label.clone(), "")));
            (header, shares(names, panels))
        }
    };
    let header: Vec<(&str, &str)> = header.iter().map(|(title, unit)| (&**title, *unit)).collect();
    Table { rows, ..Table::new(&map.id, &map.title, &map.caption, &header) }
}

fn range(panel: &Grid<Option<f64>>) -> Vec<Cell> {
    let mut values: Vec<f64> = panel.values.iter().copied().flatten().collect();
    values.sort_by(f64::total_cmp);
    let at = |place: usize| Cell::maybe(values.get(place).copied());
    let last = values.len().saturating_sub(1);
    vec![
        Cell::text(&panel.label),
        at(0),
        at(last / 2),
        at(last),
        Cell::Count((panel.values.len() - values.len()) as u64),
    ]
}

fn shares(names: &[String], panels: &[Grid<Option<usize>>]) -> Vec<Vec<Cell>> {
    let share = |k: Option<usize>, panel: &Grid<Option<usize>>| {
        100.0 * panel.values.iter().filter(|value| **value == k).count() as f64 / panel.values.len() as f64
    };
    let named = names.iter().enumerate().map(|(k, name)| (Some(k), &**name)).chain([(None, "no value")]);
    named
        .map(|(k, name)| (name, panels.iter().map(|panel| share(k, panel)).collect::<Vec<f64>>()))
        .filter(|(_, shares)| shares.iter().any(|share| *share > 0.0))
        .map(|(name, shares)| {
            let cells = shares.into_iter().map(|share| Cell::text(short(share)));
            std::iter::once(Cell::text(name)).chain(cells).collect()
        })
        .collect()
}
