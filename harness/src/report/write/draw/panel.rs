//! A rectangle with two axes, and curves clipped to it.

use super::canvas::{Canvas, Drawn, Horizontal, Point, Stroke, Text};
use super::marks::Fill;
use super::{Axis, FAINT, GRID, INK};
use crate::report::write::palette::{Marker, Rgb};
use plotters::backend::DrawingBackend;

/// A rectangle in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rect {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) right: f64,
    pub(crate) bottom: f64,
}

impl Rect {
    /// Around it, from the upper left.
    pub(crate) fn corners(&self) -> [Point; 4] {
        [(self.left, self.top), (self.right, self.top), (self.right, self.bottom), (self.left, self.bottom)]
    }

    /// Whether they have a point in common.
    pub(crate) fn touches(&self, other: &Self) -> bool {
        self.left <= other.right
            && other.left <= self.right
            && self.top <= other.bottom
            && other.top <= self.bottom
    }
}

/// `count` equal rectangles in one row, `gap` apart.
pub(crate) fn side_by_side(all: Rect, count: usize, gap: f64) -> Vec<Rect> {
    let width = (all.right - all.left - gap * (count - 1) as f64) / count as f64;
    (0..count)
        .map(|k| {
            let left = all.left + k as f64 * (width + gap);
            Rect { left, right: left + width, ..all }
        })
        .collect()
}

/// Which axes of a panel are written out; the others are those of its neighbour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Labels {
    Both,
    XOnly,
    YOnly,
    Neither,
}

impl Labels {
    fn x(self) -> bool {
        matches!(self, Self::Both | Self::XOnly)
    }

    fn y(self) -> bool {
        matches!(self, Self::Both | Self::YOnly)
    }
}

/// Where data is drawn.
pub(crate) struct Panel {
    pub(crate) rect: Rect,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
}

const TRIANGLE: f64 = 8.0;
/// How far the title of the x axis is below a panel.
pub(crate) const X_TITLE: f64 = 64.0;
/// How far the title of the y axis is left of a panel.
pub(crate) const Y_TITLE: f64 = 108.0;

impl Panel {
    /// Grid, frame, ticks and titles.
    pub(crate) fn axes<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, labels: Labels) -> Drawn {
        let Rect { left, top, right, bottom } = self.rect;
        let columns = (((right - left) / 110.0) as usize).max(2);
        let rows = (((bottom - top) / 58.0) as usize).max(2);
        self.ticks(canvas, labels, [columns, rows])?;
        self.frame(canvas)?;
        if labels.x() {
            canvas.text(self.x.title(), (f64::midpoint(left, right), bottom + X_TITLE), Text::TITLE)?;
        }
        if labels.y() {
            let look = Text { upright: true, ..Text::TITLE };
            canvas.text(self.y.title(), (left - Y_TITLE, f64::midpoint(top, bottom)), look)?;
        }
        Ok(())
    }

    /// About so many ticks on each axis, their labels, and the grid.
    pub(crate) fn ticks<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        labels: Labels,
        [columns, rows]: [usize; 2],
    ) -> Drawn {
        let Rect { left, top, right, bottom } = self.rect;
        for tick in self.x.ticks(columns) {
            let x = left + self.x.fraction(tick.at) * (right - left);
            let major = !tick.label.is_empty();
            canvas
                .line(&[(x, bottom), (x, bottom + if major { 9.0 } else { 5.0 })], Stroke::solid(INK, 1.0))?;
            if major {
                canvas.line(&[(x, top), (x, bottom)], Stroke::solid(GRID, 1.0))?;
            }
            if major && labels.x() {
                let look = Text { anchor: Horizontal::Centre, ..Text::LABEL };
                canvas.text(&tick.label, (x, bottom + 26.0), look)?;
            }
        }
        for tick in self.y.ticks(rows) {
            let y = bottom - self.y.fraction(tick.at) * (bottom - top);
            let major = !tick.label.is_empty();
            canvas.line(&[(left - if major { 9.0 } else { 5.0 }, y), (left, y)], Stroke::solid(INK, 1.0))?;
            if major {
                canvas.line(&[(left, y), (right, y)], Stroke::solid(GRID, 1.0))?;
            }
            if major && labels.y() {
                let look = Text { anchor: Horizontal::Right, ..Text::LABEL };
                canvas.text(&tick.label, (left - 14.0, y), look)?;
            }
        }
        Ok(())
    }

    /// The edge.
    pub(crate) fn frame<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn {
        let Rect { left, top, right, bottom } = self.rect;
        let frame = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
        canvas.line(&frame, Stroke::solid(INK, 1.5))
    }

    /// A title above the panel.
    pub(crate) fn heading<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, text: &str) -> Drawn {
        let middle = f64::midpoint(self.rect.left, self.rect.right);
        canvas.text(text, (middle, self.rect.top - 24.0), Text { bold: true, ..Text::TITLE })
    }

    /// The place of a value, on the edge where the value is outside.
    pub(crate) fn place(&self, x: f64, y: f64) -> Point {
        let Rect { left, top, right, bottom } = self.rect;
        let (u, v) = (self.x.fraction(x).clamp(0.0, 1.0), self.y.fraction(y).clamp(0.0, 1.0));
        (left + u * (right - left), bottom - v * (bottom - top))
    }

    /// A curve; none is a gap. It is cut at the edge, and triangles show where it leaves upwards or downwards.
    pub(crate) fn curve<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        points: &[Option<(f64, f64)>],
        stroke: Stroke,
    ) -> Drawn {
        for run in points.split(Option::is_none) {
            let run: Vec<(f64, f64)> = run.iter().filter_map(|&point| point).collect();
            let (pieces, exits) = self.clipped(&run);
            for piece in pieces {
                canvas.line(&piece, stroke)?;
            }
            for (at, upwards) in exits {
                let (marker, y) = self.inside_edge(upwards);
                canvas.mark(marker, (at.0, y), 0.8 * TRIANGLE, stroke.colour, Fill::Solid)?;
            }
            match run[..] {
                [(x, y)] if self.y.shows(y) => {
                    canvas.mark(
                        Marker::Circle,
                        self.place(x, y),
                        stroke.width,
                        stroke.colour,
                        Fill::Solid,
                    )?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// A mark, with an interval if there is one. Outside the range it becomes a triangle on the edge.
    pub(crate) fn mark<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        (x, y): (f64, f64),
        interval: Option<[f64; 2]>,
        (marker, colour, fill): (Marker, Rgb, Fill),
    ) -> Drawn {
        if !self.x.shows(x) || y.is_nan() {
            return Ok(());
        }
        if let Some([low, high]) = interval {
            let (from, to) = (self.place(x, low), self.place(x, high));
            canvas.line(&[from, to], Stroke::solid(colour, 2.0))?;
            for end in [from, to] {
                canvas.line(&[(end.0 - 5.0, end.1), (end.0 + 5.0, end.1)], Stroke::solid(colour, 2.0))?;
            }
        }
        let at = self.place(x, y);
        if self.y.shows(y) {
            canvas.mark(marker, at, 7.5, colour, fill)
        } else {
            let (marker, edge) = self.inside_edge(y > self.y.range()[1]);
            canvas.mark(marker, (at.0, edge), TRIANGLE, colour, fill)
        }
    }

    /// A dashed vertical line; the legend says what it is.
    pub(crate) fn vertical<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, x: f64) -> Drawn {
        self.vertical_of(canvas, x, Stroke { colour: FAINT, width: 2.0, dash: &[6.0, 6.0] })
    }

    /// A vertical line of this look.
    pub(crate) fn vertical_of<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        x: f64,
        stroke: Stroke,
    ) -> Drawn {
        if !self.x.shows(x) {
            return Ok(());
        }
        let at = self.place(x, self.y.range()[0]).0;
        canvas.line(&[(at, self.rect.top), (at, self.rect.bottom)], stroke)
    }

    /// The parts of a curve that are inside, in pixels.
    pub(crate) fn visible(&self, run: &[(f64, f64)]) -> Vec<Vec<Point>> {
        self.clipped(run).0
    }

    fn inside_edge(&self, upwards: bool) -> (Marker, f64) {
        if upwards {
            (Marker::TriangleUp, self.rect.top + TRIANGLE + 3.0)
        } else {
            (Marker::TriangleDown, self.rect.bottom - TRIANGLE - 3.0)
        }
    }

    /// The parts inside, and where the curve goes through the upper (true) or lower edge.
    fn clipped(&self, run: &[(f64, f64)]) -> (Vec<Vec<Point>>, Vec<(Point, bool)>) {
        let [low, high] = self.y.range();
        let [left, right] = self.x.range();
        let (mut pieces, mut exits) = (Vec::new(), Vec::new());
        let mut piece: Vec<Point> = Vec::new();
        for pair in run.windows(2) {
            let Some([from, to]) = inside([pair[0], pair[1]], [left, right], [low, high]) else {
                continue;
            };
            let (entered, left_it) = (from != pair[0], to != pair[1]);
            if entered || piece.is_empty() {
                if piece.len() > 1 {
                    pieces.push(std::mem::take(&mut piece));
                }
                piece = vec![self.place(from.0, from.1)];
            }
            piece.push(self.place(to.0, to.1));
            for (crossed, beyond, at) in [(entered, pair[0], from), (left_it, pair[1], to)] {
                if crossed && !(low..=high).contains(&beyond.1) {
                    exits.push((self.place(at.0, at.1), beyond.1 > high));
                }
            }
            if left_it {
                pieces.push(std::mem::take(&mut piece));
            }
        }
        if piece.len() > 1 {
            pieces.push(piece);
        }
        (pieces, exits)
    }
}

/// The part of a segment inside a rectangle (Liang and Barsky 1984). An infinite end counts as a very far one.
fn inside(segment: [(f64, f64); 2], x: [f64; 2], y: [f64; 2]) -> Option<[(f64, f64); 2]> {
    const FAR: f64 = 1e9;
    let [from, to] = segment.map(|(x, y)| (x, y.clamp(-FAR, FAR)));
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (step, room) in [(-dx, from.0 - x[0]), (dx, x[1] - from.0), (-dy, from.1 - y[0]), (dy, y[1] - from.1)]
    {
        if step == 0.0 && room < 0.0 {
            return None;
        } else if step < 0.0 {
            enter = enter.max(room / step);
        } else if step > 0.0 {
            leave = leave.min(room / step);
        }
    }
    if enter > leave {
        return None;
    }
    let at = |t: f64| (from.0 + t * dx, from.1 + t * dy);
    let start = if enter > 0.0 { at(enter) } else { segment[0] };
    let end = if leave < 1.0 { at(leave) } else { segment[1] };
    Some([start, end])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel() -> Panel {
        let rect = Rect { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };
        Panel { rect, x: Axis::exactly("", 0.0, 10.0), y: Axis::exactly("", 0.0, 10.0) }
    }

    #[test]
    fn a_curve_is_cut_where_it_leaves_and_comes_back() {
        let (pieces, exits) = panel().clipped(&[(0.0, 5.0), (2.0, 15.0), (4.0, 5.0), (5.0, 5.0)]);
        assert_eq!(pieces, [vec![(0.0, 50.0), (10.0, 0.0)], vec![(30.0, 0.0), (40.0, 50.0), (50.0, 50.0)]]);
        assert_eq!(exits, [((10.0, 0.0), true), ((30.0, 0.0), true)]);
    }

    #[test]
    fn zero_variance_goes_down_to_the_edge() {
        let (pieces, exits) = panel().clipped(&[(0.0, 5.0), (2.0, f64::NEG_INFINITY)]);
        assert_eq!(pieces.len(), 1);
        assert_eq!(exits.len(), 1);
        assert!(!exits[0].1);
    }

    #[test]
    fn what_is_outside_is_not_drawn() {
        let (pieces, exits) = panel().clipped(&[(0.0, 15.0), (2.0, 20.0)]);
        assert!(pieces.is_empty() && exits.is_empty());
    }
}
