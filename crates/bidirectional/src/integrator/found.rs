//! Contributions of strategies, and the paths that they found.

use crate::{Place, Subpath};
use fairflight_paths::transport::Light;
use glam::DVec3;

/// Numbers of vertices of a path that come from its two ends, those ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Strategy {
    /// s: 0 if the light was met by chance, 1 if a point of it was drawn for the last eye vertex.
    pub light: u32,
    /// t: 1 for the light image.
    pub eye: u32,
}

/// Contribution of one strategy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found<C> {
    /// The strategy.
    pub strategy: Strategy,
    /// Its contribution, weighted.
    pub value: C,
    /// The weight in it.
    pub weight: f64,
    /// The emitter, and the place or the direction of the end of the path on it, where that does not come from a light subpath.
    pub end: Option<(Light, DVec3)>,
}

impl<C> Found<C> {
    /// Vertices x_1 … x_(k−1) of the path, as one comes to them from the camera, for the subpaths that it was found with.
    pub fn places<'p>(
        &self,
        eye: &'p Subpath<C>,
        light: &'p Subpath<C>,
    ) -> impl Iterator<Item = Place> + use<'p, C> {
        let (s, t) = (self.strategy.light as usize, self.strategy.eye as usize);
        // The last of the t eye vertices is the end itself where the light was met.
        let of_eye = eye.steps[..(t - 1).saturating_sub(usize::from(s == 0))].iter();
        let of_light = light.steps[..s.saturating_sub(1)].iter().rev();
        of_eye.map(|step| step.node.place).chain(of_light.map(|step| step.node.place.reversed()))
    }

    /// The emitter, and the place or the direction of x_k on it.
    ///
    /// # Panics
    /// If the strategy took vertices from a light subpath other than `light`, which has no start.
    pub fn light_end(&self, light: &Subpath<C>) -> (Light, DVec3) {
        self.end.unwrap_or_else(|| {
            let start = light.start.as_ref().expect("a light vertex comes from a light");
            let line = start.segment.line;
            (start.light, if start.segment.from.is_some() { line.origin } else { -line.direction })
        })
    }
}
