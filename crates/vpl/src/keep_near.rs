//! Thinning of virtual point lights where they count less (engelhardt-2013 section 7).

use glam::DVec3;

/// Keeps what is near to somebody, and of the rest as much as counts (engelhardt-2013 section 7).
///
/// The paper keeps the virtual point lights that are close to the camera, a bias. Here one at the distance r is kept with probability
/// min(1, (radius/r)²) and weighs as much more: as their number falls with 1/r², so does what one of them could add.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeepNear {
    /// Point near to which virtual point lights are kept.
    pub point: DVec3,
    /// Distance within which all are kept \[length\], positive.
    pub radius: f64,
}

impl KeepNear {
    /// The probability to keep what lies at `position`.
    #[must_use]
    pub fn probability(&self, position: DVec3) -> f64 {
        (self.radius * self.radius / (position - self.point).length_squared()).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_near_ones_and_the_square_of_far_ones() {
        let near = KeepNear { point: DVec3::Y, radius: 0.5 };
        // At the point itself, within the radius, on it, at twice and at four times as far.
        for (distance, probability) in [(0.0, 1.0), (0.25, 1.0), (0.5, 1.0), (1.0, 0.25), (2.0, 0.0625)] {
            assert_eq!(near.probability(DVec3::Y + distance * DVec3::X), probability);
        }
    }
}
