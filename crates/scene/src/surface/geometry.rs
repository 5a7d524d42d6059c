//! Queries of rays to the surfaces of a scene, and their answers where there are no surfaces.

use super::{Surface, TowardsSample};
use crate::Spectrum;
use fairflight_media::Line;
use glam::DVec3;

/// A piece of a straight line between two points that may lie on surfaces.
///
/// The surfaces of its ends are named by their index: their crossings at the ends are left out by algebra, so that no distance has
/// to be taken for zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Line from the start, of unit direction.
    pub line: Line,
    /// Distance to the end \[length\]; may be infinite.
    pub length: f64,
    /// The surface that it starts on.
    pub from: Option<usize>,
    /// The surface that it ends on.
    pub to: Option<usize>,
}

/// Intersection of a ray with a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<'s, C> {
    /// Distance from the start of the ray \[length\].
    pub distance: f64,
    /// The point.
    pub position: DVec3,
    /// Normal of unit length, on the side from where the ray comes.
    pub normal: DVec3,
    /// True if that is the outer side.
    pub outside: bool,
    /// The surface that was met.
    pub index: usize,
    /// The surface itself.
    pub surface: &'s Surface<C>,
}

/// The surfaces that a ray can meet.
///
/// A scene without surfaces has [`NoSurfaces`], and compiles to no surface code.
pub trait Geometry<C: Spectrum> {
    /// True if there are no surfaces, known at compile time.
    const IS_EMPTY: bool;

    /// All surfaces, in the order of their indices.
    fn surfaces(&self) -> &[Surface<C>];

    /// The indices of those that emit.
    fn emitters(&self) -> &[usize];

    /// True if a surface is specular.
    fn has_specular(&self) -> bool;

    /// The nearest surface on a segment; its end counts for nothing but its length.
    fn intersect(&self, segment: &Segment) -> Option<Hit<'_, C>>;

    /// The surfaces that come within `radius` of a point, one bit each; all from the 64th on share one.
    fn reaching(&self, center: DVec3, radius: f64) -> u64;

    /// The nearest of some surfaces, which [`reaching`](Self::reaching) names.
    fn intersect_among(&self, segment: &Segment, among: u64) -> Option<Hit<'_, C>>;

    /// True if a surface lies between the ends of a segment. A specular surface is in the way, too.
    fn is_occluded(&self, segment: &Segment) -> bool;

    /// A direction from `point` towards the surface `index`, on which the point must not lie; see [`Shape::sample_towards`](super::Shape::sample_towards).
    fn sample_towards(&self, index: usize, point: DVec3, u: f64, v: f64) -> Option<TowardsSample> {
        self.surfaces()[index].shape.sample_towards(point, u, v)
    }
}

/// A scene without surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoSurfaces;

impl<C: Spectrum> Geometry<C> for NoSurfaces {
    const IS_EMPTY: bool = true;

    #[inline]
    fn surfaces(&self) -> &[Surface<C>] {
        &[]
    }
    #[inline]
    fn emitters(&self) -> &[usize] {
        &[]
    }
    #[inline]
    fn has_specular(&self) -> bool {
        false
    }
    #[inline]
    fn intersect(&self, _segment: &Segment) -> Option<Hit<'_, C>> {
        None
    }
    #[inline]
    fn reaching(&self, _center: DVec3, _radius: f64) -> u64 {
        0
    }
    #[inline]
    fn intersect_among(&self, _segment: &Segment, _among: u64) -> Option<Hit<'_, C>> {
        None
    }
    #[inline]
    fn is_occluded(&self, _segment: &Segment) -> bool {
        false
    }
}
