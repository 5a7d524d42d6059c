//! The scattering medium of a scene.

use crate::{Connection, Spectrum};
use fairflight_elementary::lanes::{LANES, Lanes};
use fairflight_media::lanes::vector;
use fairflight_media::{Bounds, Clip, Clips, Line, Medium, Ray};
use glam::DVec3;

/// A medium in its bounds, with how much and whereto it scatters. Outside the bounds is vacuum.
#[derive(Clone, Copy, Debug)]
pub struct Volume<M, P, C> {
    /// The extinction, shared by all channels.
    pub medium: M,
    /// Bounds of the medium: it ends there.
    pub bounds: Bounds,
    /// σ_s/σ_t per channel \[1\]; above 1 only where the scene permits a gain.
    pub albedo: C,
    /// The phase function.
    pub phase: P,
}

impl<M: Medium, P, C: Spectrum> Volume<M, P, C> {
    /// The part of a ray inside the bounds as a profile; `None` where it misses them, or there is no medium at all.
    ///
    /// `length` ends the ray; `line.direction` is of unit length.
    #[inline]
    pub fn enter(&self, line: &Line, length: Option<f64>) -> Option<Ray<&M>> {
        // Known at compile time: a scene without a medium has no code for one.
        if M::IS_EMPTY {
            return None;
        }
        if self.bounds.contains(line.origin) {
            // Bounds are convex: where both ends are inside, so is all between them.
            let ends_inside = length.filter(|&length| self.bounds.contains(line.at(length)));
            let length = ends_inside.unwrap_or_else(|| {
                let exit = self.bounds.exit_distance(line.origin, line.direction);
                length.map_or(exit, |length| length.min(exit))
            });
            let clip = Clip { line: *line, entry_distance: 0.0, length };
            return (length > 0.0).then(|| Ray::new(&self.medium, &clip));
        }
        if self.bounds.certainly_misses(line.origin, line.direction) {
            return None;
        }
        // A line of finite numbers and of unit direction is what the constructors of cameras and lights guarantee.
        let clip = self.bounds.clip(line.origin, line.direction, length).ok().flatten()?;
        (clip.length > 0.0).then(|| Ray::new(&self.medium, &clip))
    }

    /// The parts inside the bounds of endless rays, those of [`enter`](Self::enter), in all lanes.
    #[inline(always)]
    pub fn enter_lanes(&self, origins: &[Lanes; 3], directions: &[Lanes; 3]) -> Clips {
        let misses = self.bounds.certainly_misses_lanes(origins, directions);
        if misses.iter().fold(true, |all, misses| all & misses) {
            return Clips::NONE;
        }
        let mut some_are_inside = false;
        for i in 0..LANES {
            some_are_inside |= self.bounds.contains(vector(origins, i));
        }
        let mut clips = self.bounds.clip_lanes(origins, directions);
        for (length, misses) in clips.lengths.iter_mut().zip(misses) {
            *length = if misses { 0.0 } else { *length };
        }
        if some_are_inside {
            self.begin_inside(origins, directions, &mut clips);
        }
        clips
    }

    /// Rays that begin inside go on as they are.
    #[cold]
    #[inline(never)]
    fn begin_inside(&self, origins: &[Lanes; 3], directions: &[Lanes; 3], clips: &mut Clips) {
        for i in 0..LANES {
            let (origin, direction) = (vector(origins, i), vector(directions, i));
            if self.bounds.contains(origin) {
                clips.set(i, &self.bounds.clip_inside(Line { origin, direction }));
            }
        }
    }

    /// The rest of a ray that starts inside the bounds, as a profile.
    #[inline]
    pub fn inside(&self, line: Line) -> Ray<&M> {
        Ray::new(&self.medium, &self.bounds.clip_inside(line))
    }

    /// The ray from a point in the volume to a light, up to the light or to the end of the bounds, as a profile.
    #[inline]
    pub fn towards(&self, point: DVec3, connection: &Connection<C>) -> Ray<&M> {
        let mut clip = self.bounds.clip_inside(Line { origin: point, direction: connection.towards });
        if let Some(distance) = connection.distance {
            clip.length = clip.length.min(distance);
        }
        Ray::new(&self.medium, &clip)
    }

    /// The same volume with another view of its medium (counted, observed), its phase function by reference.
    pub fn with_medium<N>(&self, medium: N) -> Volume<N, &P, C> {
        Volume { medium, bounds: self.bounds, albedo: self.albedo, phase: &self.phase }
    }
}
