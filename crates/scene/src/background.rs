//! Light from infinitely far away in all directions.

use crate::{EnvironmentMap, Spectrum};
use glam::DVec3;

/// The radiance that a ray meets when it leaves everything.
#[derive(Clone, Debug, PartialEq)]
pub struct Background<C> {
    /// Radiance that is the same from every direction.
    pub constant: C,
    /// Environment maps on top of it.
    pub maps: Vec<EnvironmentMap<C>>,
}

impl<C: Spectrum> Background<C> {
    /// No light.
    #[must_use]
    pub fn dark() -> Self {
        Self { constant: C::ZERO, maps: Vec::new() }
    }

    /// The radiance that arrives from the direction `towards` in which a ray leaves, of unit length.
    #[inline]
    #[must_use]
    pub fn radiance(&self, towards: DVec3) -> C {
        let mut sum = self.constant;
        for map in &self.maps {
            sum += map.radiance(towards);
        }
        sum
    }

    /// A bound of the radiance from any direction, in the greatest channel.
    #[must_use]
    pub fn greatest(&self) -> f64 {
        let maps = self
            .maps
            .iter()
            .map(|map| map.pixels().iter().map(|pixel| pixel.max_channel()).fold(0.0, f64::max));
        self.constant.max_channel() + maps.sum::<f64>()
    }

    /// True if there is no light at all.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        self.constant == C::ZERO && self.maps.is_empty()
    }
}
