//! Regions of one name: their borders, and the number of the name where there is room for it.

use super::super::super::draw::{Canvas, Drawn, Panel, Point, Rect, Stroke, numbered};
use super::super::super::palette::Rgb;
use super::panels::{PanelOf, Shown};
use plotters::backend::DrawingBackend;

/// A region whose widest place is less from its middle to its border, in pixels, has no number.
const ROOM: f64 = 15.0;
/// Places whose room differs by less, in pixels, are equal.
const EQUAL: f64 = 2.0;
const BORDER: Stroke = Stroke::solid((255, 255, 255), 2.0);

/// Draws the borders, and the numbers where they cover no point of a line if that can be; returns where these are.
pub(super) fn draw<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    panel: &Panel,
    it: &PanelOf<'_>,
    lines: &[Point],
    colour: impl Fn(usize) -> Rgb,
) -> Result<Vec<Rect>, String> {
    borders(canvas, panel, it)?;
    let mut taken = Vec::new();
    for (kind, (x, y)) in numbers(panel, it, lines) {
        numbered(canvas, (x, y), kind + 1, colour(kind))?;
        taken.push(Rect { left: x - ROOM, top: y - ROOM, right: x + ROOM, bottom: y + ROOM });
    }
    Ok(taken)
}

fn borders<DB: DrawingBackend>(canvas: &Canvas<DB>, panel: &Panel, it: &PanelOf<'_>) -> Drawn {
    let columns = it.plane.columns();
    for (k, cell) in it.cells.iter().enumerate() {
        let (column, row) = (k % columns, k / columns);
        let Some(rect) = it.plane.rect(panel, [column, column + 1], row) else { continue };
        if column + 1 < columns && it.cells[k + 1] != *cell {
            canvas.line(&[(rect.right, rect.top), (rect.right, rect.bottom)], BORDER)?;
        }
        if it.cells.get(k + columns).is_some_and(|above| above != cell) {
            canvas.line(&[(rect.left, rect.top), (rect.right, rect.top)], BORDER)?;
        }
    }
    Ok(())
}

/// The number of each region that has room for it, and where: the place farthest from its border and from lines, and of equal ones the
/// nearest to its middle.
fn numbers(panel: &Panel, it: &PanelOf<'_>, lines: &[Point]) -> Vec<(usize, Point)> {
    let columns = it.plane.columns();
    let place = |k: usize| it.plane.rect(panel, [k % columns, k % columns + 1], k / columns);
    let rects: Vec<Option<Rect>> = (0..it.cells.len()).map(place).collect();
    let mut numbers = Vec::new();
    for region in regions(&it.cells, columns) {
        let Shown::Kind(kind) = it.cells[region[0]] else { continue };
        let mut inside = vec![false; it.cells.len()];
        region.iter().for_each(|&k| inside[k] = true);
        let outside =
            || rects.iter().zip(&inside).filter(|(_, inside)| !**inside).filter_map(|(rect, _)| *rect);
        let frame = panel.rect;
        let clearance = |(x, y): Point| {
            let edge = (x - frame.left).min(frame.right - x).min(y - frame.top).min(frame.bottom - y);
            outside().map(|rect| distance(rect, (x, y))).fold(edge, f64::min)
        };
        // Centres and upper right corners of cells.
        let candidates = region.iter().filter_map(|&k| rects[k]).flat_map(|rect| {
            let centre = (f64::midpoint(rect.left, rect.right), f64::midpoint(rect.top, rect.bottom));
            [centre, (rect.right, rect.top)]
        });
        let candidates: Vec<(f64, Point)> = candidates.map(|at| (clearance(at), at)).collect();
        let apart = |a: Point, b: Point| (a.0 - b.0).hypot(a.1 - b.1);
        let from_lines = |at: Point| lines.iter().map(|&line| apart(line, at)).fold(f64::INFINITY, f64::min);
        let off_lines: Vec<(f64, Point)> =
            candidates.iter().map(|&(room, at)| (room.min(from_lines(at)), at)).collect();
        let count = candidates.len() as f64;
        let middle = (
            candidates.iter().map(|(_, at)| at.0).sum::<f64>() / count,
            candidates.iter().map(|(_, at)| at.1).sum::<f64>() / count,
        );
        let best = [off_lines, candidates].iter().find_map(|candidates| {
            let most = candidates.iter().map(|(room, _)| *room).fold(0.0, f64::max);
            let widest = candidates.iter().filter(|(room, _)| *room >= most - EQUAL).map(|(_, at)| *at);
            let nearest = widest.min_by(|a, b| apart(*a, middle).total_cmp(&apart(*b, middle)));
            nearest.filter(|_| most >= ROOM)
        });
        numbers.extend(best.map(|at| (kind, at)));
    }
    numbers
}

/// Connected cells of one kind, across sides.
fn regions(cells: &[Shown], columns: usize) -> Vec<Vec<usize>> {
    let mut seen = vec![false; cells.len()];
    let mut regions = Vec::new();
    for first in 0..cells.len() {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        let mut region = vec![first];
        let mut next = 0;
        while let Some(&k) = region.get(next) {
            next += 1;
            let column = k % columns;
            let left = (column > 0).then(|| k - 1);
            let right = (column + 1 < columns).then_some(k + 1);
            let below = k.checked_sub(columns);
            let above = (k + columns < cells.len()).then_some(k + columns);
            for other in [left, right, below, above].into_iter().flatten() {
                if !seen[other] && cells[other] == cells[k] {
                    seen[other] = true;
                    region.push(other);
                }
            }
        }
        regions.push(region);
    }
    regions
}

/// From a point to a rectangle.
fn distance(rect: Rect, (x, y): Point) -> f64 {
    let beyond = |low: f64, high: f64, x: f64| (low - x).max(x - high).max(0.0);
    beyond(rect.left, rect.right, x).hypot(beyond(rect.top, rect.bottom, y))
}

#[cfg(test)]
mod tests {
    use super::super::super::super::draw::Axis;
    use super::super::plane::Plane;
    use super::*;
    use crate::report::document;

    #[test]
    fn regions_are_connected_across_sides_not_corners() {
        let cells = [0, 0, 1, 0, 1, 1, 1, 0, 0].map(Shown::Kind);
        let mut regions = regions(&cells, 3);
        regions.iter_mut().for_each(|region| region.sort_unstable());
        assert_eq!(regions, [vec![0, 1, 3], vec![2, 4, 5], vec![6], vec![7, 8]]);
    }

    #[test]
    fn a_number_stands_where_its_region_is_widest() {
        let centres: Vec<f64> = (0..10).map(|k| 0.05 + 0.1 * f64::from(k)).collect();
        let axis = document::Axis::linear("");
        let plane = Plane::new((&axis, &centres), (&axis, &centres));
        // A block of 6 x 6 cells on the lower left, an arm to the right, a name around it.
        let kind = |k: usize| usize::from(!((k % 10 < 6 && k / 10 < 6) || k / 10 == 2));
        let cells = (0..100).map(|k| Shown::Kind(kind(k))).collect();
        let it = PanelOf { label: "", plane, numbers: Vec::new(), cells };
        let rect = Rect { left: 0.0, top: 0.0, right: 200.0, bottom: 200.0 };
        let panel = Panel { rect, x: Axis::exactly("", 0.0, 1.0), y: Axis::exactly("", 0.0, 1.0) };
        let first = |lines: &[Point]| {
            let numbers = numbers(&panel, &it, lines);
            numbers.iter().find(|number| number.0 == 0).unwrap().1
        };
        let at = first(&[]);
        assert!((at.0 - 60.0).abs() < 1e-9 && (at.1 - 140.0).abs() < 1e-9, "{at:?}");
        let line: Vec<Point> = (0..=20).map(|k| (62.0, 10.0 * f64::from(k))).collect();
        let off = first(&line);
        assert!((off.0 - 62.0).abs() >= ROOM && off.0 < 120.0 && off.1 > 80.0, "{off:?}");
        // The piece below the arm is 40 pixels high: wide enough for a number of its own.
        let others = numbers(&panel, &it, &[]);
        assert_eq!(others.iter().filter(|number| number.0 == 1).count(), 2);
    }
}
