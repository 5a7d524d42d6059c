//! The part of a curve that can be seen.

use super::axis::{Stretch, on};
use crate::palette::Marker;
use crate::{Curve, Mark, Panel};

/// The place of a mark, and its shape: a triangle on the edge for one that lies beyond.
pub(super) fn placed(it: &Mark, panel: &Panel, [x, y]: [Stretch; 2], usual: Marker) -> ((f64, f64), Marker) {
    let at = (on(&panel.x, it.x), on(&panel.y, it.y));
    let inset = 0.012 * (y.high - y.low);
    let across = at.0.clamp(x.low, x.high);
    if at.1 > y.high {
        ((across, y.high - inset), Marker::TriangleUp)
    } else if at.1 >= y.low {
        ((across, at.1), usual)
    } else {
        // A negative value on a logarithmic axis, too: it is no number there.
        ((across, y.low + inset), Marker::TriangleDown)
    }
}

/// The parts of a line that can be seen.
pub(super) fn runs(curve: &Curve, panel: &Panel, [x, y]: [Stretch; 2]) -> Vec<Vec<(f64, f64)>> {
    let place = |k: usize| {
        let point = curve.line[k];
        // A value without a place is far below.
        let far = |end: f64| end.clamp(y.low - 50.0 * (y.high - y.low), y.high + 50.0 * (y.high - y.low));
        point
            .y
            .map(|height| (on(&panel.x, point.x), on(&panel.y, height)))
            .filter(|at| !at.1.is_nan())
            .map(|at| (at.0, far(at.1)))
    };
    let mut runs: Vec<Vec<(f64, f64)>> = Vec::new();
    for k in 1..curve.line.len() {
        let (Some(from), Some(to)) = (place(k - 1), place(k)) else { continue };
        let Some([start, end]) = clipped(from, to, [x, y]) else { continue };
        match runs.last_mut() {
            Some(run) if run.last() == Some(&start) => run.push(end),
            _ => runs.push(vec![start, end]),
        }
    }
    runs
}

/// The part of a segment inside a rectangle (Liang and Barsky 1984).
fn clipped(from: (f64, f64), to: (f64, f64), [x, y]: [Stretch; 2]) -> Option<[(f64, f64); 2]> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let [mut enter, mut leave] = [0.0_f64, 1.0_f64];
    for (step, room) in
        [(-dx, from.0 - x.low), (dx, x.high - from.0), (-dy, from.1 - y.low), (dy, y.high - from.1)]
    {
        if step == 0.0 && room < 0.0 {
            return None;
        }
        if step < 0.0 {
            enter = enter.max(room / step);
        } else if step > 0.0 {
            leave = leave.min(room / step);
        }
    }
    let at = |t: f64| match t {
        0.0 => from,
        1.0 => to,
        t => (from.0 + t * dx, from.1 + t * dy),
    };
    (enter <= leave).then(|| [at(enter), at(leave)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    fn square() -> [Stretch; 2] {
        [Stretch::of(&Axis::linear("").within(0.0, 1.0), []); 2]
    }

    #[test]
    fn segments_are_cut_at_the_frame() {
        assert_eq!(clipped((0.0, 0.5), (1.0, 0.5), square()), Some([(0.0, 0.5), (1.0, 0.5)]));
        assert_eq!(clipped((0.5, -1.0), (0.5, 3.0), square()), Some([(0.5, 0.0), (0.5, 1.0)]));
        assert_eq!(clipped((-1.0, 2.0), (2.0, 2.0), square()), None);
        assert_eq!(clipped((-0.5, 0.0), (0.0, -0.5), square()), None);
    }

    #[test]
    fn a_line_that_leaves_comes_back_as_another_run() {
        let panel = Panel::new("", Axis::linear(""), Axis::linear(""));
        let line = [(0.0, 0.5), (0.2, 2.0), (0.4, 0.5), (0.6, 0.5)];
        let curve = Curve::method("").with_line(line);
        let runs = runs(&curve, &panel, square());
        assert_eq!(runs.iter().map(Vec::len).collect::<Vec<_>>(), [2, 3]);
        let gap = curve.with_gaps([(0.0, Some(0.5)), (0.5, None), (1.0, Some(0.5))]);
        assert!(super::runs(&gap, &panel, square()).is_empty());
    }

    #[test]
    fn marks_beyond_the_frame_stand_on_its_edge() {
        let panel = Panel::new("", Axis::linear(""), Axis::logarithmic(""));
        let y = Stretch::of(&Axis::logarithmic("").within(1.0, 100.0), []);
        for (value, expected) in [
            (1e3, Marker::TriangleUp),
            (10.0, Marker::Star),
            (0.0, Marker::TriangleDown),
            (-1.0, Marker::TriangleDown),
        ] {
            let (at, marker) = placed(&Mark::at(0.5, value), &panel, [square()[0], y], Marker::Star);
            assert_eq!(marker, expected, "{value}");
            assert!(y.contains(at.1));
        }
    }
}
