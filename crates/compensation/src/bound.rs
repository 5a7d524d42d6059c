//! A bound from the scene (raab-2008 section 4.2).

use std::f64::consts::FRAC_1_PI;

/// Brightness of a scene, as far as the bound depends on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brightness {
    /// The greatest radiance that anything emits.
    pub radiance: f64,
    /// The power of all emitters.
    pub power: f64,
    /// Light paths that share it.
    pub paths: u64,
    /// The greatest reflectance of a surface.
    pub reflectance: f64,
    /// The greatest albedo · phase function of the medium \[1/sr\].
    pub scattering: f64,
}

impl Brightness {
    /// The b with which no connection adds more than the brightest emitter \[1/length²\]: one of a light with its share Φ/N of the power is at most
    /// f · f · Φ/N · b. Infinite where nothing scatters.
    ///
    /// raab-2008 section 4.2 suggests to bound point light contributions and bias compensation to the same maximum. The compensation
    /// is bounded by the brightest emitter; powers other than the average (roulette, weights of walks) may exceed Φ/N. The bound
    /// must not depend on the virtual point lights themselves, or bounding and compensation would no longer add up.
    #[must_use]
    pub fn bound(&self) -> f64 {
        let f = (self.reflectance * FRAC_1_PI).max(self.scattering);
        self.radiance * self.paths as f64 / (self.power * f * f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_connection_of_average_power_is_as_bright_as_the_emitter() {
        let scene =
            Brightness { radiance: 10.0, power: 40.0, paths: 100, reflectance: 0.5, scattering: 0.05 };
        let f = 0.5 * FRAC_1_PI;
        assert!((scene.bound() * f * f * 40.0 / 100.0 - 10.0).abs() < 1e-13);
        assert_eq!(Brightness { reflectance: 0.0, scattering: 0.0, ..scene }.bound(), f64::INFINITY);
    }
}
