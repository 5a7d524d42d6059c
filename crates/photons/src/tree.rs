//! Points in space, found by place: a hierarchy of boxes.

use fairflight_media::Line;
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Something that lies at a point.
pub(crate) trait Placed {
    fn position(&self) -> DVec3;
}

/// A hierarchy of boxes over points, split in the middle along the longest edge of what they fill.
///
/// Building costs n log n, memory 64 bytes per [`LEAF`] points beside the points. What is found is told in an order that depends on the points alone.
#[derive(Clone, Debug)]
pub(crate) struct Tree<T> {
    points: Vec<T>,
    /// In the order of a walk from the root, the lower half first.
    nodes: Vec<Node>,
}

/// Points of a box that is not split.
const LEAF: usize = 8;

#[derive(Clone, Copy, Debug)]
struct Node {
    min: DVec3,
    max: DVec3,
    start: u32,
    end: u32,
    /// The upper half; the lower one is the next node. None of a leaf.
    upper: Option<u32>,
}

/// One of the nearest points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Near {
    squared: f64,
    index: u32,
}

impl Eq for Near {}

impl PartialOrd for Near {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Near {
    fn cmp(&self, other: &Self) -> Ordering {
        self.squared.total_cmp(&other.squared).then(self.index.cmp(&other.index))
    }
}

impl<T: Placed> Tree<T> {
    /// The hierarchy of these points.
    pub(crate) fn new(mut points: Vec<T>) -> Self {
        let mut nodes = Vec::with_capacity(4 * (points.len() / LEAF + 1));
        if !points.is_empty() {
            split(&mut points, 0, &mut nodes);
        }
        Self { points, nodes }
    }

    pub(crate) fn points(&self) -> &[T] {
        &self.points
    }

    /// The `count` nearest points, in place of what `found` holds: without an allocation where that has the room.
    pub(crate) fn nearest(&self, center: DVec3, count: usize, found: &mut BinaryHeap<Near>) {
        found.clear();
        if !self.nodes.is_empty() && count > 0 {
            self.nearest_below(0, center, count, found);
        }
    }

    pub(crate) fn at(&self, near: &Near) -> &T {
        &self.points[near.index as usize]
    }

    fn nearest_below(&self, node: u32, center: DVec3, count: usize, found: &mut BinaryHeap<Near>) {
        let Node { start, end, upper, .. } = self.nodes[node as usize];
        let Some(upper) = upper else {
            for index in start..end {
                let squared = self.points[index as usize].position().distance_squared(center);
                let near = Near { squared, index };
                if found.len() < count {
                    found.push(near);
                } else if let Some(mut furthest) = found.peek_mut()
                    && near < *furthest
                {
                    *furthest = near;
                }
            }
            return;
        };
        // The nearer half first, so that the other one may be out of reach.
        let halves = [node + 1, upper].map(|half| (self.nodes[half as usize].squared_distance(center), half));
        let ordered = if halves[1].0 < halves[0].0 { [halves[1], halves[0]] } else { halves };
        for (squared, half) in ordered {
            if found.len() < count || found.peek().is_some_and(|furthest| squared <= furthest.squared) {
                self.nearest_below(half, center, count, found);
            }
        }
    }

    /// Shows `each` every point nearer to a ray than `radius` whose projection lies on its first `length`, and where that is.
    pub(crate) fn along(&self, line: &Line, length: f64, radius: f64, each: &mut impl FnMut(&T, f64)) {
        if !self.nodes.is_empty() {
            self.along_below(0, (line, length), radius, each);
        }
    }

    fn along_below(
        &self,
        node: u32,
        (line, length): (&Line, f64),
        radius: f64,
        each: &mut impl FnMut(&T, f64),
    ) {
        let Node { min, max, start, end, upper } = self.nodes[node as usize];
        if !meets(line, length, (min - radius, max + radius)) {
            return;
        }
        if let Some(upper) = upper {
            self.along_below(node + 1, (line, length), radius, each);
            self.along_below(upper, (line, length), radius, each);
            return;
        }
        for point in &self.points[start as usize..end as usize] {
            let offset = point.position() - line.origin;
            let s = offset.dot(line.direction);
            let beside = offset - s * line.direction;
            if (0.0..=length).contains(&s) && beside.length_squared() < radius * radius {
                each(point, s);
            }
        }
    }

    /// Shows `each` every point nearer to `center` than `radius`.
    pub(crate) fn within(&self, center: DVec3, radius: f64, each: &mut impl FnMut(&T)) {
        let mut open = 0;
        // Without a stack: a node out of reach is left out with all below, which end where the next one begins.
        while let Some(node) = self.nodes.get(open) {
            if node.squared_distance(center) < radius * radius {
                if node.upper.is_none() {
                    let points = &self.points[node.start as usize..node.end as usize];
                    points
                        .iter()
                        .filter(|point| point.position().distance_squared(center) < radius * radius)
                        .for_each(&mut *each);
                }
                open += 1;
            } else {
                let end = node.end;
                open += self.nodes[open..].iter().take_while(|below| below.end <= end).count();
            }
        }
    }
}

impl Node {
    fn squared_distance(&self, center: DVec3) -> f64 {
        center.clamp(self.min, self.max).distance_squared(center)
    }
}

/// True if a ray meets a box on its first `length`; rounding is left to `radius`, by which the box was enlarged.
fn meets(line: &Line, length: f64, (min, max): (DVec3, DVec3)) -> bool {
    let (mut enters, mut leaves) = (0.0_f64, length);
    for axis in 0..3 {
        let (origin, direction) = (line.origin[axis], line.direction[axis]);
        if direction == 0.0 {
            if !(min[axis]..=max[axis]).contains(&origin) {
                return false;
            }
            continue;
        }
        let (a, b) = ((min[axis] - origin) / direction, (max[axis] - origin) / direction);
        enters = enters.max(a.min(b));
        leaves = leaves.min(a.max(b));
    }
    enters <= leaves
}

fn split<T: Placed>(points: &mut [T], start: u32, nodes: &mut Vec<Node>) {
    let first = points[0].position();
    let (min, max) = points
        .iter()
        .fold((first, first), |(min, max), point| (min.min(point.position()), max.max(point.position())));
    let (node, end) = (nodes.len(), start + points.len() as u32);
    nodes.push(Node { min, max, start, end, upper: None });
    if points.len() <= LEAF {
        return;
    }
    let size = max - min;
    let axis = if size.x >= size.y.max(size.z) { 0 } else { 1 + usize::from(size.z > size.y) };
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| a.position()[axis].total_cmp(&b.position()[axis]));
    let (lower, upper) = points.split_at_mut(middle);
    split(lower, start, nodes);
    nodes[node].upper = Some(nodes.len() as u32);
    split(upper, start + middle as u32, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_sources::{Seeded, UniformSource};

    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Point(DVec3, u32);

    impl Placed for Point {
        fn position(&self) -> DVec3 {
            self.0
        }
    }

    /// Points in a flat box, some of them at one place.
    fn points(count: u32, source: &mut Seeded) -> Vec<Point> {
        (0..count)
            .map(|index| {
                let at = [4.0, 1.0, 0.2].map(|size| size * source.next_uniform());
                Point(if index % 7 == 0 { DVec3::splat(0.1) } else { DVec3::from(at) }, index)
            })
            .collect()
    }

    fn sorted(mut found: Vec<u32>) -> Vec<u32> {
        found.sort_unstable();
        found
    }

    #[test]
    fn what_is_found_is_what_a_look_at_all_points_finds() {
        let mut source = Seeded::new(1);
        for count in [0, 1, 8, 9, 100, 1000] {
            let all = points(count, &mut source);
            let tree = Tree::new(all.clone());
            assert_eq!(tree.points().len(), all.len());
            let mut heap = BinaryHeap::new();
            for turn in 0..30 {
                let center = DVec3::from(std::array::from_fn(|_| 4.0 * source.next_uniform() - 1.0));
                let wanted = [1, 5, 50][turn % 3];
                tree.nearest(center, wanted, &mut heap);
                let mut distances: Vec<f64> = all.iter().map(|point| point.0.distance(center)).collect();
                distances.sort_unstable_by(f64::total_cmp);
                distances.truncate(wanted);
                let mut found: Vec<f64> = heap.iter().map(|near| tree.at(near).0.distance(center)).collect();
                found.sort_unstable_by(f64::total_cmp);
                assert_eq!(found, distances);

                let radius = [0.01, 0.2, 3.0][turn % 3];
                let mut within = Vec::new();
                tree.within(center, radius, &mut |point| within.push(point.1));
                let inside = |point: &&Point| point.0.distance(center) < radius;
                let expected: Vec<u32> = all.iter().filter(inside).map(|point| point.1).collect();
                assert_eq!(sorted(within), expected);

                let towards = DVec3::from(std::array::from_fn(|_| source.next_uniform())) - center;
                let direction = if turn % 5 == 0 { DVec3::X } else { towards.normalize() };
                let (line, length) = (Line { origin: center, direction }, 2.0);
                let mut along = Vec::new();
                tree.along(&line, length, radius, &mut |point, s| {
                    assert!((line.at(s) - point.0).dot(direction).abs() < 1e-14);
                    along.push(point.1);
                });
                let near = |point: &&Point| {
                    let s = (point.0 - center).dot(direction);
                    (0.0..=length).contains(&s) && line.at(s).distance(point.0) < radius
                };
                let expected: Vec<u32> = all.iter().filter(near).map(|point| point.1).collect();
                assert_eq!(sorted(along), expected);
            }
        }
    }
}
