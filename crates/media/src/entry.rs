//! Rays that come from outside the bounds, in lanes.

use crate::bounds::{clip_to_sphere, direction_of};
use crate::inside::line_misses;
use crate::lanes::{set_vector, vector};
use crate::{Bounds, Clip, Line};
use fairflight_elementary::lanes::{LANES, Lanes};

/// Clips of the lines of all lanes.
#[derive(Clone, Copy, Debug)]
pub struct Clips {
    /// Entry points, and the directions from there.
    pub lines: [[Lanes; 3]; 2],
    /// Lengths \[length\]; 0 of a line that misses.
    pub lengths: Lanes,
}

impl Clips {
    /// Those of lines that miss.
    pub const NONE: Self = Self { lines: [[[0.0; LANES]; 3]; 2], lengths: [0.0; LANES] };

    /// The line of a lane.
    #[must_use]
    pub fn line(&self, lane: usize) -> Line {
        Line { origin: vector(&self.lines[0], lane), direction: vector(&self.lines[1], lane) }
    }

    /// Puts the clip of a line into a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, clip: &Clip) {
        set_vector(&mut self.lines[0], lane, clip.line.origin);
        set_vector(&mut self.lines[1], lane, clip.line.direction);
        self.lengths[lane] = clip.length;
    }
}

impl Bounds {
    /// [`certainly_misses`](Self::certainly_misses) of all lanes, by origins and directions.
    #[inline(always)]
    #[must_use]
    pub fn certainly_misses_lanes(&self, origins: &[Lanes; 3], directions: &[Lanes; 3]) -> [bool; LANES] {
        let ball = self.enclosing_ball();
        let mut misses = [false; LANES];
        for (i, misses) in misses.iter_mut().enumerate() {
            *misses = line_misses(ball, vector(origins, i), vector(directions, i));
        }
        misses
    }

    /// [`clip`](Self::clip) of endless lines in all lanes, by origins and directions: length 0 where there is none, or an error.
    #[inline(always)]
    #[must_use]
    pub fn clip_lanes(&self, origins: &[Lanes; 3], directions: &[Lanes; 3]) -> Clips {
        let mut clips = Clips::NONE;
        let Self::Sphere { center, radius } = *self else {
            self.clip_one_by_one(origins, directions, &mut clips);
            return clips;
        };
        for i in 0..LANES {
            let direction = direction_of(vector(directions, i));
            let (mut clip, meets) = clip_to_sphere(center, radius, vector(origins, i), direction);
            let is_finite = (clip.entry_distance.abs() < f64::INFINITY) & (clip.length.abs() < f64::INFINITY);
            clip.length = if meets & is_finite { clip.length } else { 0.0 };
            clips.set(i, &clip);
        }
        clips
    }

    #[inline(never)]
    fn clip_one_by_one(&self, origins: &[Lanes; 3], directions: &[Lanes; 3], clips: &mut Clips) {
        for i in 0..LANES {
            let (origin, direction) = (vector(origins, i), vector(directions, i));
            if let Ok(Some(clip)) = self.clip(origin, direction, None) {
                clips.set(i, &clip);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::random;
    use glam::{DVec3, dvec3};

    #[test]
    fn clips_of_lanes_are_those_of_one() {
        let mut next = random(5);
        let mut number = || 2.0 * next() - 1.0;
        let ball = Bounds::sphere(dvec3(0.0, 0.0, 1.0), 1.0).unwrap();
        let cube = Bounds::aligned_box(-DVec3::ONE, DVec3::ONE).unwrap();
        for bounds in [ball, cube] {
            for round in 0..200 {
                let mut lines = [[[0.0; LANES]; 3]; 2];
                for lane in 0..LANES {
                    let far = if lane == 3 && round % 10 == 0 { 1e300 } else { 2.0 };
                    set_vector(&mut lines[0], lane, far * dvec3(number(), number(), number()));
                    let direction = dvec3(number(), number(), number()).normalize();
                    set_vector(&mut lines[1], lane, if lane == 5 { DVec3::ZERO } else { direction });
                }
                let (clips, misses) = (
                    bounds.clip_lanes(&lines[0], &lines[1]),
                    bounds.certainly_misses_lanes(&lines[0], &lines[1]),
                );
                for (i, misses) in misses.into_iter().enumerate() {
                    let (origin, direction) = (vector(&lines[0], i), vector(&lines[1], i));
                    assert_eq!(misses, bounds.certainly_misses(origin, direction));
                    let clip = bounds.clip(origin, direction, None).ok().flatten();
                    assert_eq!(clips.lengths[i], clip.map_or(0.0, |clip| clip.length));
                    if let Some(clip) = clip.filter(|clip| clip.length > 0.0) {
                        assert_eq!(clips.line(i), clip.line);
                    }
                }
            }
        }
    }
}
