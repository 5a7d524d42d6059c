//! A ray through a medium, as a profile.

use crate::lanes::{points, splat};
use crate::{
    Breakpoints, Clip, Extinction, Line, LineThickness, Majorant, Medium, MediumBreakpoints, Minorant,
    OpticalThickness,
};
use fairflight_elementary::lanes::Lanes;
use glam::DVec3;

/// The part of a ray inside the bounds of a medium: s = 0 is where the ray enters.
///
/// The ray is clipped first and marched from its entry point, so that an origin far away costs no digits of the
/// extinction (hard case 11): what is left is the conditioning of the input itself.
#[derive(Clone, Copy, Debug)]
pub struct Ray<M> {
    medium: M,
    local: Line,
    length: f64,
    entry_distance: f64,
    world: Line,
}

impl<M: Medium> Ray<M> {
    /// The profile of a clipped ray in `medium`.
    pub fn new(medium: M, clip: &Clip) -> Self {
        let local = medium.local(clip.line);
        Self { medium, local, length: clip.length, entry_distance: clip.entry_distance, world: clip.line }
    }

    /// The distance from the ray's origin to the start of the profile \[length\].
    pub fn entry_distance(&self) -> f64 {
        self.entry_distance
    }

    /// The point in world space at the distance `s` from the start of the profile.
    pub fn world_point(&self, s: f64) -> DVec3 {
        self.world.at(s)
    }

    /// The ray in world space, from the start of the profile.
    pub fn world_line(&self) -> &Line {
        &self.world
    }

    /// The ray in the medium's own coordinates.
    pub fn local_line(&self) -> &Line {
        &self.local
    }

    /// The medium that the ray passes.
    pub fn medium(&self) -> &M {
        &self.medium
    }
}

impl<M: Medium> Extinction for Ray<M> {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        self.medium.sigma_t_local(self.local.at(s))
    }
    #[inline(always)]
    fn sigma_t_lanes(&self, s: &Lanes) -> Lanes {
        let Line { origin, direction } = self.local;
        let points = points(&splat(origin), &splat(direction), s);
        self.medium.sigma_t_local_lanes(&points)
    }
    #[inline]
    fn length(&self) -> f64 {
        self.length
    }
}

/// The bound of the whole medium, infinite where none is known.
impl<M: Medium> Majorant for Ray<M> {
    fn majorant(&self) -> f64 {
        self.medium.upper_bound().unwrap_or(f64::INFINITY)
    }
}

/// The bound of the whole medium, minus infinity where none is known.
impl<M: Medium> Minorant for Ray<M> {
    fn minorant(&self) -> f64 {
        self.medium.lower_bound().unwrap_or(f64::NEG_INFINITY)
    }
}

impl<M: LineThickness> OpticalThickness for Ray<M> {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        self.medium.line_thickness(&self.local, from, to)
    }
}

impl<M: MediumBreakpoints> Breakpoints for Ray<M> {
    fn breakpoints(&self) -> Vec<f64> {
        self.medium.line_breakpoints(&self.local, self.length)
    }
}
