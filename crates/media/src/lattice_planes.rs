//! Crossings of a line with the planes at integer coordinates of one axis.

/// 2⁵³, up to which every integer is a number of its own.
const LARGEST_PLANE: f64 = 9_007_199_254_740_992.0;

/// The distances strictly inside `(from, to)` at which `origin + s · direction` is an integer, in increasing order.
///
/// Each is computed from its own plane as (k − origin)/direction: no step is added up, so that the last crossing of a long
/// line is as exact as the first.
#[derive(Clone, Debug)]
pub(crate) struct PlaneCrossings {
    origin: f64,
    direction: f64,
    from: f64,
    to: f64,
    /// The next plane, and the one after the last that can lie inside.
    next: f64,
    end: f64,
}

impl PlaneCrossings {
    pub(crate) fn new(origin: f64, direction: f64, from: f64, to: f64) -> Self {
        // One plane more than needed at either end: the two positions are rounded, the crossings themselves decide.
        let (start, stop) = (origin + from * direction, origin + to * direction);
        let (next, end) = if direction > 0.0 {
            (start.floor(), stop.floor() + 2.0)
        } else if direction < 0.0 {
            (start.ceil(), stop.ceil() - 2.0)
        } else {
            // Parallel to the planes, negative zero included: also a line that runs in one of them crosses none.
            (0.0, 0.0)
        };
        // Beyond this size neighbouring integers are the same number, and counting would stand still.
        let countable = |plane: f64| plane.clamp(-LARGEST_PLANE, LARGEST_PLANE);
        Self { origin, direction, from, to, next: countable(next), end: countable(end) }
    }

    /// The number of planes between two positions on the axis, as a bound for whoever has to refuse too many.
    pub(crate) fn count(origin: f64, direction: f64, length: f64) -> f64 {
        if direction == 0.0 { 0.0 } else { ((origin + length * direction).floor() - origin.floor()).abs() }
    }
}

impl Iterator for PlaneCrossings {
    type Item = f64;

    #[inline]
    fn next(&mut self) -> Option<f64> {
        let step = 1f64.copysign(self.direction);
        while (self.end - self.next) * step > 0.0 {
            let s = (self.next - self.origin) / self.direction;
            self.next += step;
            if s >= self.to {
                break;
            }
            if s > self.from {
                return Some(s);
            }
        }
        // Nothing follows a crossing beyond the end.
        self.end = self.next;
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossings(origin: f64, direction: f64, from: f64, to: f64) -> Vec<f64> {
        PlaneCrossings::new(origin, direction, from, to).collect()
    }

    #[test]
    fn planes_in_both_directions() {
        assert_eq!(crossings(0.5, 1.0, 0.0, 3.0), [0.5, 1.5, 2.5]);
        assert_eq!(crossings(0.5, -1.0, 0.0, 3.0), [0.5, 1.5, 2.5]);
        assert_eq!(crossings(-0.5, 0.5, 0.0, 4.0), [1.0, 3.0]);
        assert_eq!(crossings(0.5, 1.0, 1.0, 2.0), [1.5]);
        assert_eq!(PlaneCrossings::count(0.5, -1.0, 3.0), 3.0);
    }

    #[test]
    fn the_ends_are_not_inside() {
        assert_eq!(crossings(0.0, 1.0, 0.0, 3.0), [1.0, 2.0]);
        assert_eq!(crossings(3.0, -1.0, 0.0, 3.0), [1.0, 2.0]);
        assert_eq!(crossings(-0.0, 1.0, 0.0, 1.0), []);
        assert_eq!(crossings(0.2, 1.0, 2.0, 2.0), []);
    }

    #[test]
    fn a_parallel_line_crosses_nothing() {
        for origin in [0.0, 2.0, 0.3] {
            for zero in [0.0, -0.0] {
                assert_eq!(crossings(origin, zero, 0.0, 10.0), []);
                assert_eq!(PlaneCrossings::count(origin, zero, 10.0), 0.0);
            }
        }
        assert_eq!(crossings(0.3, 1e-320, 0.0, 10.0), []);
        assert_eq!(crossings(1.0, 1e-320, 0.0, 10.0), []);
    }

    #[test]
    fn where_every_number_is_an_integer_the_walk_still_ends() {
        for far in [LARGEST_PLANE - 2.0, LARGEST_PLANE, LARGEST_PLANE + 8.0, 1e300] {
            for (origin, direction) in [(far, 1.0), (far, -1.0), (-far, 1.0), (-far, -1.0)] {
                assert!(crossings(origin, direction, 0.0, 9.0).len() <= 9);
            }
        }
        assert_eq!(crossings(LARGEST_PLANE - 2.0, 1.0, 0.0, 9.0), [1.0]);
    }
}
