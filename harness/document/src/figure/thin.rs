//! Lines with no more points than a figure can show.

use super::axis::{Stretch, on};
use crate::{Area, Block, Chart, Document, Panel, Point};

/// Lines and areas of more points are thinned: those of fewer were chosen one by one.
const MANY: usize = 100;
/// Share of a panel's width and height within which a point lies on the line between its neighbours: half a pixel.
const SHARE: f64 = 1e-3;

/// The same document without points of lines and areas that no figure shows. Marks stay: they were measured.
pub(crate) fn thinned(document: &Document) -> Document {
    let mut document = document.clone();
    for block in document.sections.iter_mut().flat_map(|section| &mut section.blocks) {
        if let Block::Chart(Chart { panels, .. }) = block {
            panels.iter_mut().for_each(panel);
        }
    }
    document
}

fn panel(panel: &mut Panel) {
    let heights = |point: &Point| point.y.map_or([f64::NAN; 2], |y| [y; 2]);
    let lines = panel.curves.iter().flat_map(|curve| &curve.line);
    let areas = panel.curves.iter().flat_map(|curve| &curve.area);
    let all: Vec<(f64, [f64; 2])> =
        lines.map(|it| (it.x, heights(it))).chain(areas.map(|it| (it.x, it.y))).collect();
    let x = Stretch::of(&panel.x, all.iter().map(|it| it.0));
    let y = Stretch::of(&panel.y, all.iter().flat_map(|it| it.1));
    let place = |(at, ends): (f64, [f64; 2])| {
        let ends = ends.map(|end| (on(&panel.y, end) - y.low) / (y.high - y.low));
        ((on(&panel.x, at) - x.low) / (x.high - x.low), ends)
    };
    for curve in &mut panel.curves {
        let places: Vec<_> = curve.line.iter().map(|it| place((it.x, heights(it)))).collect();
        keep(&mut curve.line, &places);
        let places: Vec<_> = curve.area.iter().map(|it: &Area| place((it.x, it.y))).collect();
        keep(&mut curve.area, &places);
    }
}

/// Keeps the corners of many points, by their places.
fn keep<T>(points: &mut Vec<T>, places: &[(f64, [f64; 2])]) {
    if points.len() > MANY {
        let mut kept = vec![false; points.len()];
        // A point without a height is a gap: the points about it are ends.
        let is_shown = |k: usize| places[k].1.iter().all(|end| end.is_finite());
        let all: Vec<usize> = (0..places.len()).collect();
        for run in all.chunk_by(|&a, &b| is_shown(a) == is_shown(b)) {
            corners(places, [run[0], run[run.len() - 1]], &mut kept);
        }
        let mut kept = kept.into_iter();
        points.retain(|_| kept.next() == Some(true));
    }
}

/// Marks both ends of a run, and all between them that the line through its neighbours would miss (Douglas and Peucker 1973).
fn corners(places: &[(f64, [f64; 2])], [from, to]: [usize; 2], kept: &mut [bool]) {
    (kept[from], kept[to]) = (true, true);
    let (start, end) = (places[from], places[to]);
    let (dx, dy) = (end.0 - start.0, [0, 1].map(|k| end.1[k] - start.1[k]));
    let distance = |k: usize| {
        let (x, y) = (places[k].0 - start.0, [0, 1].map(|i| places[k].1[i] - start.1[i]));
        let off = |i: usize| (dx * y[i] - dy[i] * x).abs() / dx.hypot(dy[i]).max(f64::MIN_POSITIVE);
        off(0).max(off(1))
    };
    let farthest = (from + 1..to).map(|k| (k, distance(k))).max_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((k, _)) = farthest.filter(|farthest| farthest.1 > SHARE) {
        corners(places, [from, k], kept);
        corners(places, [k, to], kept);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Curve};

    fn line(points: impl Iterator<Item = (f64, Option<f64>)>) -> Vec<(f64, Option<f64>)> {
        let mut it = Panel::new("", Axis::linear(""), Axis::linear(""));
        it.curves = vec![Curve::method("").with_gaps(points)];
        panel(&mut it);
        it.curves[0].line.iter().map(|point| (point.x, point.y)).collect()
    }

    #[test]
    fn corners_and_gaps_stay_and_straight_parts_go() {
        let corner = |k: u32| Some(f64::from(k.abs_diff(150)));
        let x = |k: u32| f64::from(k);
        assert_eq!(line((0..=300).map(|k| (x(k), corner(k)))), [0, 150, 300].map(|k| (x(k), corner(k))));
        let gap = |k: u32| corner(k).filter(|_| k != 40);
        let kept = line((0..=300).map(|k| (x(k), gap(k))));
        assert_eq!(kept, [0, 39, 40, 41, 150, 300].map(|k| (x(k), gap(k))));
        assert_eq!(line((0..50).map(|k| (x(k), corner(k)))).len(), 50, "few points were chosen");
    }

    #[test]
    fn what_is_left_out_is_on_the_line() {
        let wave = |k: u32| (0.004 * f64::from(k)).sin();
        let kept = line((0..1000).map(|k| (f64::from(k), Some(wave(k)))));
        assert!((10..100).contains(&kept.len()), "{}", kept.len());
        for k in 0..1000 {
            let x = f64::from(k);
            let right = kept.iter().position(|point| point.0 >= x).unwrap().max(1);
            let [(a, low), (b, high)] = [kept[right - 1], kept[right]].map(|(x, y)| (x, y.unwrap()));
            let between = low + (high - low) * (x - a) / (b - a);
            // In heights of the panel, whose steepest part is the wave's twice: distances are across the line.
            assert!((between - wave(k)).abs() < 2.2 * 2.5 * SHARE, "{k}");
        }
    }
}
