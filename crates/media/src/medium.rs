//! Fields in space, before a ray is chosen.

use fairflight_elementary::lanes::{LANES, Lanes};
use glam::DVec3;
use std::sync::Arc;

/// The straight line `origin + s · direction`; `s` is a distance in world space wherever the line is expressed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// The point at s = 0.
    pub origin: DVec3,
    /// The change of the point per unit of world distance; of unit length in world space.
    pub direction: DVec3,
}

impl Line {
    /// The point at the distance `s`.
    #[inline]
    #[must_use]
    pub fn at(&self, s: f64) -> DVec3 {
        self.origin + s * self.direction
    }
}

/// Extinction in space.
///
/// A medium may keep its data in coordinates of its own (the index space of voxels, the lattice of a noise). A line is
/// mapped there once per ray by [`Medium::local`], and each look-up then costs no transformation.
pub trait Medium {
    /// True if there is no extinction anywhere, known at compile time: code for a medium is then left out.
    const IS_EMPTY: bool = false;

    /// The line in the medium's own coordinates, still parametrised by world distance. The default is world space.
    fn local(&self, line: Line) -> Line {
        line
    }

    /// σ_t at a point in the medium's own coordinates \[1/length\].
    fn sigma_t_local(&self, point: DVec3) -> f64;

    /// σ_t at the points of all lanes, given by their coordinates: each with the bits of [`sigma_t_local`](Self::sigma_t_local).
    #[inline(always)]
    fn sigma_t_local_lanes(&self, [x, y, z]: &[Lanes; 3]) -> Lanes {
        std::array::from_fn(|lane| self.sigma_t_local(DVec3::new(x[lane], y[lane], z[lane])))
    }

    /// The same for those lanes that look the medium up: one look-up each. What stands in the places of the others is of no use.
    #[inline(always)]
    fn sigma_t_local_where(&self, points: &[Lanes; 3], _looks_up: &[bool; LANES]) -> Lanes {
        self.sigma_t_local_lanes(points)
    }

    /// σ_t at a point in world space \[1/length\].
    fn sigma_t(&self, point: DVec3) -> f64 {
        self.sigma_t_local(self.local(Line { origin: point, direction: DVec3::X }).origin)
    }

    /// An upper bound of σ_t everywhere, where one is known \[1/length\].
    fn upper_bound(&self) -> Option<f64>;

    /// A lower bound of σ_t everywhere, where one is known \[1/length\].
    fn lower_bound(&self) -> Option<f64>;
}

/// A medium whose optical thickness along any straight line has a closed form.
pub trait LineThickness: Medium {
    /// ∫ σ_t ds over `from ≤ s ≤ to` on a line in the medium's own coordinates \[1\].
    fn line_thickness(&self, local: &Line, from: f64, to: f64) -> f64;

    /// The extinction of a medium that has the same everywhere: then a line thickness is that times `to - from` \[1/length\].
    #[inline(always)]
    fn everywhere(&self) -> Option<f64> {
        None
    }
}

/// A medium that knows where it is not smooth along a line.
pub trait MediumBreakpoints: Medium {
    /// Distances in `(0, length)` on a line in the medium's own coordinates at which σ_t or a derivative of it jumps. In
    /// any order; empty if the medium is smooth or does not know.
    fn line_breakpoints(&self, local: &Line, length: f64) -> Vec<f64>;
}

/// A medium behind a pointer is the medium.
macro_rules! behind_a_pointer {
    ($($pointer:ty),*) => {$(
        impl<M: Medium + ?Sized> Medium for $pointer {
            const IS_EMPTY: bool = M::IS_EMPTY;

            fn local(&self, line: Line) -> Line {
                (**self).local(line)
            }
            #[inline]
            fn sigma_t_local(&self, point: DVec3) -> f64 {
                (**self).sigma_t_local(point)
            }
            #[inline(always)]
            fn sigma_t_local_lanes(&self, points: &[Lanes; 3]) -> Lanes {
                (**self).sigma_t_local_lanes(points)
            }
            #[inline(always)]
            fn sigma_t_local_where(&self, points: &[Lanes; 3], looks_up: &[bool; LANES]) -> Lanes {
                (**self).sigma_t_local_where(points, looks_up)
            }
            fn upper_bound(&self) -> Option<f64> {
                (**self).upper_bound()
            }
            fn lower_bound(&self) -> Option<f64> {
                (**self).lower_bound()
            }
        }

        impl<M: LineThickness + ?Sized> LineThickness for $pointer {
            fn line_thickness(&self, local: &Line, from: f64, to: f64) -> f64 {
                (**self).line_thickness(local, from, to)
            }
            #[inline(always)]
            fn everywhere(&self) -> Option<f64> {
                (**self).everywhere()
            }
        }

        impl<M: MediumBreakpoints + ?Sized> MediumBreakpoints for $pointer {
            fn line_breakpoints(&self, local: &Line, length: f64) -> Vec<f64> {
                (**self).line_breakpoints(local, length)
            }
        }
    )*};
}

behind_a_pointer!(&M, Arc<M>);
