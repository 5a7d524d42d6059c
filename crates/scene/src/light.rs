//! Lights that a ray cannot hit by chance, and all lights together.

use crate::directions::{across, on_sphere};
use crate::{Background, SceneError, Spectrum};
use fairflight_elementary::sin_cos;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// A light of no extent, seen as a point or as a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source<C> {
    /// Shines into all directions alike.
    Point {
        /// Place of the light.
        position: DVec3,
        /// Φ \[power\].
        power: C,
    },
    /// Parallel light.
    Directional {
        /// The direction of travel of its light, of unit length.
        direction: DVec3,
        /// Power per area across that direction.
        irradiance: C,
    },
}

/// Connection of a point with a [`Source`], without what the medium between takes away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Connection<C> {
    /// The direction from the point to the light, of unit length.
    pub towards: DVec3,
    /// Distance to the light \[length\]; `None` if infinite.
    pub distance: Option<f64>,
    /// Power per area across that direction: Φ/(4π distance²) for a point.
    pub irradiance: C,
}

impl<C: Spectrum> Source<C> {
    /// A point light; it may lie in the medium or outside.
    ///
    /// # Errors
    /// If a number is not finite, or the power is negative.
    pub fn point(position: DVec3, power: C) -> Result<Self, SceneError> {
        SceneError::check_finite("position", position.is_finite())?;
        SceneError::check_strength("power", power)?;
        Ok(Self::Point { position, power })
    }

    /// Parallel light that travels along `direction`, of any length but 0.
    ///
    /// # Errors
    /// If a number is not finite, the direction is zero, or the irradiance is negative.
    pub fn directional(direction: DVec3, irradiance: C) -> Result<Self, SceneError> {
        SceneError::check_finite("direction", direction.is_finite())?;
        let zero = SceneError::Degenerate { what: "direction", because: "a vector of length 0" };
        SceneError::check_strength("irradiance", irradiance)?;
        Ok(Self::Directional { direction: direction.try_normalize().ok_or(zero)?, irradiance })
    }

    /// Connects `point` with this light; `None` at the position of a point light itself, a set of measure zero.
    #[inline]
    #[must_use]
    pub fn connect(&self, point: DVec3) -> Option<Connection<C>> {
        match *self {
            Self::Point { position, power } => {
                let offset = position - point;
                let squared = offset.length_squared();
                if squared == 0.0 {
                    return None;
                }
                let distance = squared.sqrt();
                Some(Connection {
                    towards: offset / distance,
                    distance: Some(distance),
                    irradiance: power * (1.0 / (4.0 * PI * squared)),
                })
            }
            Self::Directional { direction, irradiance } => {
                Some(Connection { towards: -direction, distance: None, irradiance })
            }
        }
    }
}

/// All lights of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Lights<C> {
    /// Radiance of rays that leave the scene.
    pub background: Background<C>,
    /// Lights that no ray meets by chance: points and directions.
    pub sources: Vec<Source<C>>,
}

/// A photon on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission<C> {
    /// Start of its path.
    pub origin: DVec3,
    /// Direction of travel, of unit length.
    pub direction: DVec3,
    /// The power that it carries: that of all its light, if one photon is emitted.
    pub power: C,
}

impl<C: Spectrum> Lights<C> {
    /// The number of lights that emit photons.
    #[must_use]
    pub fn emitters(&self) -> usize {
        usize::from(self.background.constant != C::ZERO) + self.background.maps.len() + self.sources.len()
    }

    /// The power of the light `index` < [`emitters`](Self::emitters) that may reach a ball of this radius.
    #[must_use]
    pub fn power(&self, index: usize, radius: f64) -> C {
        let disc = PI * radius * radius;
        let constant = usize::from(self.background.constant != C::ZERO);
        if index < constant {
            return self.background.constant * (4.0 * PI * disc);
        }
        if let Some(map) = self.background.maps.get(index - constant) {
            return C::splat(map.flux() * disc);
        }
        match self.sources[index - constant - self.background.maps.len()] {
            Source::Point { power, .. } => power,
            Source::Directional { irradiance, .. } => irradiance * disc,
        }
    }

    /// A photon of the light `index` < [`emitters`](Self::emitters) that may reach the ball (`center`, `radius`).
    ///
    /// Infinitely far light starts on the disc that covers the ball across its direction. `None` for a black light.
    #[must_use]
    pub fn emit(&self, index: usize, (center, radius): (DVec3, f64), u: [f64; 5]) -> Option<Emission<C>> {
        let disc = PI * radius * radius;
        let from = |towards: DVec3| {
            let (x, y) = across(towards);
            let (sin, cos) = sin_cos(TAU * u[4]);
            let off = radius * u[3].sqrt();
            center + towards * radius + off * (cos * x + sin * y)
        };
        let constant = usize::from(self.background.constant != C::ZERO);
        if index < constant {
            let towards = on_sphere(u[0], u[1]);
            let power = self.background.constant * (4.0 * PI * disc);
            return Some(Emission { origin: from(towards), direction: -towards, power });
        }
        if let Some(map) = self.background.maps.get(index - constant) {
            let (towards, radiance) = map.sample(u[2], u[0], u[1])?;
            let power = radiance * (map.flux() / radiance.max_channel() * disc);
            return Some(Emission { origin: from(towards), direction: -towards, power });
        }
        Some(match self.sources[index - constant - self.background.maps.len()] {
            Source::Point { position, power } => {
                Emission { origin: position, direction: on_sphere(u[0], u[1]), power }
            }
            Source::Directional { direction, irradiance } => {
                Emission { origin: from(-direction), direction, power: irradiance * disc }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::EnvironmentMap;
    use glam::dvec3;

    #[test]
    fn a_point_light_fades_with_the_square() {
        let light = Source::point(dvec3(0.0, 3.0, 0.0), 4.0 * PI).unwrap();
        let seen = light.connect(DVec3::ZERO).unwrap();
        assert_eq!((seen.towards, seen.distance), (DVec3::Y, Some(3.0)));
        assert!((seen.irradiance - 1.0 / 9.0).abs() < 1e-16);
        assert!(light.connect(dvec3(0.0, 3.0, 0.0)).is_none());
    }

    #[test]
    fn photons_of_far_light_cover_the_ball_and_no_more() {
        let lights = Lights {
            background: Background {
                constant: 1.0,
                maps: vec![EnvironmentMap::new(2, 2, vec![1.0; 4]).unwrap()],
            },
            sources: vec![Source::directional(dvec3(0.0, 0.0, 2.0), 3.0).unwrap()],
        };
        let ball = (dvec3(1.0, 2.0, 3.0), 2.0);
        assert_eq!(lights.emitters(), 3);
        for index in 0..3 {
            for i in 0..100 {
                let t = f64::from(i);
                let u = [0.13, 0.29, 0.41, 0.59, 0.83].map(|step| (step * t).fract());
                let photon = lights.emit(index, ball, u).unwrap();
                let offset = photon.origin - ball.0;
                assert!((photon.direction.length() - 1.0).abs() < 1e-14);
                assert!((offset.dot(photon.direction) + 2.0).abs() < 1e-13);
                let beside = offset - offset.dot(photon.direction) * photon.direction;
                assert!(beside.length() <= 2.0 + 1e-13);
                let power = [4.0 * PI, 4.0 * PI, 3.0][index] * PI * 4.0;
                assert!((photon.power - power).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn bad_lights_are_refused() {
        assert!(matches!(
            Source::point(DVec3::INFINITY, 1.0),
            Err(SceneError::NotFinite { what: "position" })
        ));
        assert!(matches!(Source::point(DVec3::ZERO, -1.0), Err(SceneError::Negative { what: "power", .. })));
        assert!(matches!(Source::directional(DVec3::ZERO, 1.0), Err(SceneError::Degenerate { .. })));
    }
}
