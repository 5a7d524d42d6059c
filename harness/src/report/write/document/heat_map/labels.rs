//! Where the labels of isolines are: on their line, and on nothing else if that can be.

use super::super::super::draw::{Point, Rect};

/// A shorter line has no label; nor has a ring of less than twice the length, which it would hide.
const SHORTEST: f64 = 80.0;
/// Between places that are tried, in pixels along the line.
const STEP: f64 = 4.0;
/// Between a label and what it must not touch.
const CLEARANCE: f64 = 5.0;
/// What a step of another line that is covered costs, in units of the whole way from the middle of the line to its end.
const COVERED: f64 = 0.5;

/// A line with its label.
pub(super) struct Labelled {
    pub(super) points: Vec<Point>,
    pub(super) text: String,
    /// Width and height of the plate.
    pub(super) size: [f64; 2],
}

impl Labelled {
    /// The plate around a point.
    pub(super) fn plate(&self, (x, y): Point) -> Rect {
        let [width, height] = self.size.map(|size| size / 2.0);
        Rect { left: x - width, top: y - height, right: x + width, bottom: y + height }
    }

    fn is_long(&self) -> bool {
        let ring = self.points.first() == self.points.last();
        let least = if ring { 2.0 * SHORTEST } else { SHORTEST };
        let length = |pair: &[Point]| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
        self.points.windows(2).map(length).sum::<f64>() >= least
    }

    /// Points a step apart.
    pub(super) fn steps(&self) -> Vec<Point> {
        let mut steps = Vec::new();
        for pair in self.points.windows(2) {
            let (dx, dy) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
            let count = (dx.hypot(dy) / STEP).ceil().max(1.0);
            steps.extend((0..count as u32).map(|k| {
                let t = f64::from(k) / count;
                (pair[0].0 + t * dx, pair[0].1 + t * dy)
            }));
        }
        steps.extend(self.points.last());
        steps
    }
}

/// A place for the label of every line that is long enough and has one: inside the frame, clear of what is taken and of other labels;
/// among these where it covers least of other lines, and near the middle. Long lines choose first.
pub(super) fn place(lines: &[Labelled], frame: Rect, mut taken: Vec<Rect>) -> Vec<(&Labelled, Point)> {
    let steps: Vec<Vec<Point>> = lines.iter().map(Labelled::steps).collect();
    let mut order: Vec<usize> = (0..lines.len()).filter(|&k| lines[k].is_long()).collect();
    order.sort_by_key(|&k| std::cmp::Reverse(steps[k].len()));
    let mut placed = Vec::new();
    for k in order {
        let clear = |plate: &Rect| {
            let plate = grown(*plate);
            let inside = plate.left > frame.left
                && plate.right < frame.right
                && plate.top > frame.top
                && plate.bottom < frame.bottom;
            inside && !taken.iter().any(|other| plate.touches(other))
        };
        let cost = |place: usize, plate: &Rect| {
            let plate = grown(*plate);
            let covers = |&(x, y): &Point| plate.touches(&Rect { left: x, top: y, right: x, bottom: y });
            let others = steps.iter().enumerate().filter(|&(other, _)| other != k);
            let covered = others.flat_map(|(_, points)| points).filter(|point| covers(point)).count();
            let fraction = place as f64 / steps[k].len() as f64;
            COVERED * covered as f64 + (2.0 * fraction - 1.0).abs()
        };
        let best = steps[k]
            .iter()
            .enumerate()
            .map(|(place, &at)| (place, at, lines[k].plate(at)))
            .filter(|(_, _, plate)| clear(plate))
            .map(|(place, at, plate)| (cost(place, &plate), at, plate))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, at, plate)) = best {
            taken.push(plate);
            placed.push((&lines[k], at));
        }
    }
    placed
}

fn grown(plate: Rect) -> Rect {
    Rect {
        left: plate.left - CLEARANCE,
        top: plate.top - CLEARANCE,
        right: plate.right + CLEARANCE,
        bottom: plate.bottom + CLEARANCE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect { left: 0.0, top: 0.0, right: 300.0, bottom: 200.0 };

    fn line(points: &[Point]) -> Labelled {
        Labelled { points: points.to_vec(), text: "1".to_owned(), size: [30.0, 20.0] }
    }

    #[test]
    fn a_lone_line_has_its_label_in_the_middle() {
        let lines = [line(&[(0.0, 100.0), (300.0, 100.0)])];
        let placed = place(&lines, FRAME, Vec::new());
        assert_eq!(placed.len(), 1);
        assert!((placed[0].1.0 - 150.0).abs() <= STEP && placed[0].1.1 == 100.0);
    }

    #[test]
    fn labels_keep_off_each_other_off_other_lines_and_off_what_is_taken() {
        let lines = [
            line(&[(0.0, 100.0), (300.0, 100.0)]),
            line(&[(0.0, 115.0), (300.0, 115.0)]),
            line(&[(150.0, 0.0), (150.0, 95.0)]),
        ];
        let taken = Rect { left: 120.0, top: 20.0, right: 180.0, bottom: 45.0 };
        let placed = place(&lines, FRAME, vec![taken]);
        assert_eq!(placed.len(), 3);
        for (k, (line, at)) in placed.iter().enumerate() {
            let plate = line.plate(*at);
            assert!(!plate.touches(&taken));
            assert!(placed[..k].iter().all(|(other, at)| !plate.touches(&other.plate(*at))));
            // The two parallel lines are too near to each other; the third is not.
            assert!(
                line.points[0].0 == 150.0
                    || !plate.touches(&Rect { left: 150.0, top: 0.0, right: 150.0, bottom: 95.0 })
            );
        }
    }

    #[test]
    fn short_lines_and_lines_without_room_have_none() {
        let lines = [
            line(&[(100.0, 100.0), (140.0, 100.0)]),
            line(&[(0.0, 3.0), (300.0, 3.0)]),
            line(&[(100.0, 100.0), (130.0, 100.0), (130.0, 130.0), (100.0, 130.0), (100.0, 100.0)]),
        ];
        assert!(place(&lines, FRAME, Vec::new()).is_empty());
    }
}
