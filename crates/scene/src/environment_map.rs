//! A radiance for each direction, as a picture.

use crate::{SceneError, Spectrum};
use fairflight_elementary::{acos, atan2, cos, sin_cos};
use glam::{DVec3, dvec3};
use std::f64::consts::{PI, TAU};

/// A map of latitude and longitude; each pixel is a patch of constant radiance.
///
/// Row 0 looks up (+y), the last row down. Column 0 begins at +z and the columns turn over +x (seen from above against the
/// clock): with u = column/width and v = row/height the direction is
/// (sin πv · sin 2πu, cos πv, sin πv · cos 2πu). Patches are constant and not interpolated, so that integrals over the
/// map, and sampling by its radiance, are exact.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMap<C> {
    width: usize,
    height: usize,
    pixels: Vec<C>,
    /// Flux of the patches before each one, in the order of pixels, by the greatest channel; one entry more than pixels.
    cumulative: Vec<f64>,
}

impl<C: Spectrum> EnvironmentMap<C> {
    /// A map of `width` × `height` pixels, row by row from the top.
    ///
    /// # Errors
    /// If there are no pixels or not width × height of them, or one is negative or not finite.
    pub fn new(width: usize, height: usize, pixels: Vec<C>) -> Result<Self, SceneError> {
        if width == 0 || height == 0 {
            return Err(SceneError::NoPixels { what: "the environment map" });
        }
        if pixels.len() != width * height {
            return Err(SceneError::PixelCount { width, height, found: pixels.len() });
        }
        for pixel in &pixels {
            SceneError::check_strength("the environment map", *pixel)?;
        }
        let mut map = Self { width, height, pixels, cumulative: Vec::new() };
        let mut flux = 0.0;
        map.cumulative.push(0.0);
        for (i, pixel) in map.pixels.iter().enumerate() {
            flux += pixel.max_channel() * map.solid_angle(i / width);
            map.cumulative.push(flux);
        }
        Ok(map)
    }

    /// All pixels, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[C] {
        &self.pixels
    }

    /// The radiance from a direction of unit length.
    #[must_use]
    pub fn radiance(&self, towards: DVec3) -> C {
        let turn = atan2(towards.x, towards.z) / TAU;
        let u = if turn < 0.0 { turn + 1.0 } else { turn };
        let v = acos(towards.y.clamp(-1.0, 1.0)) / PI;
        let column = ((u * self.width as f64) as usize).min(self.width - 1);
        let row = ((v * self.height as f64) as usize).min(self.height - 1);
        self.pixels[row * self.width + column]
    }

    /// The density of [`sample`](Self::sample) at a direction of unit length \[1/sr\]: the greatest channel of its
    /// pixel/[`flux`](Self::flux); 0 for a black map.
    #[must_use]
    pub fn pdf_solid_angle(&self, towards: DVec3) -> f64 {
        if self.flux() > 0.0 { self.radiance(towards).max_channel() / self.flux() } else { 0.0 }
    }

    /// ∫ of the greatest channel over the sphere \[radiance · sr\].
    #[must_use]
    pub fn flux(&self) -> f64 {
        self.cumulative[self.pixels.len()]
    }

    /// A direction with the density greatest channel/[`flux`](Self::flux) per solid angle, from which light comes, and its
    /// radiance; `None` for a black map.
    #[must_use]
    pub fn sample(&self, choice: f64, u: f64, v: f64) -> Option<(DVec3, C)> {
        if self.flux() <= 0.0 {
            return None;
        }
        let target = choice * self.flux();
        let pixel = self.cumulative[1..].partition_point(|&flux| flux <= target).min(self.pixels.len() - 1);
        let (row, column) = (pixel / self.width, pixel % self.width);
        // Uniform in solid angle within the patch: uniform in the cosine and in the azimuth.
        let [above, below] = self.cosines(row);
        let y = above + v * (below - above);
        let azimuth = TAU * (column as f64 + u) / self.width as f64;
        let horizontal = ((1.0 - y) * (1.0 + y)).max(0.0).sqrt();
        let (sin, cos) = sin_cos(azimuth);
        Some((dvec3(horizontal * sin, y, horizontal * cos), self.pixels[pixel]))
    }

    /// The cosines of the upper and the lower edge of a row.
    fn cosines(&self, row: usize) -> [f64; 2] {
        [row, row + 1].map(|edge| cos(PI * edge as f64 / self.height as f64))
    }

    /// Solid angle of a pixel in this row \[sr\].
    fn solid_angle(&self, row: usize) -> f64 {
        let [above, below] = self.cosines(row);
        TAU / self.width as f64 * (above - below)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> EnvironmentMap<f64> {
        EnvironmentMap::new(4, 3, (0..12).map(f64::from).collect()).unwrap()
    }

    #[test]
    fn directions_meet_their_pixels() {
        let map = map();
        assert_eq!(map.radiance(DVec3::Y), 0.0);
        assert_eq!(map.radiance(dvec3(0.1, 0.0, 1.0).normalize()), 4.0);
        assert_eq!(map.radiance(dvec3(1.0, 0.0, -0.1).normalize()), 5.0);
        assert_eq!(map.radiance(dvec3(-0.1, 0.0, 1.0).normalize()), 7.0);
        assert_eq!(map.radiance(dvec3(0.01, -1.0, 0.01).normalize()), 8.0);
    }

    #[test]
    fn samples_lie_in_the_pixel_whose_radiance_they_carry() {
        let map = map();
        for i in 0..500 {
            let t = f64::from(i);
            let [c, u, v] = [0.37, 0.61, 0.83].map(|step| (step * t).fract());
            let (direction, radiance) = map.sample(c, 0.001 + 0.998 * u, 0.001 + 0.998 * v).unwrap();
            assert!((direction.length() - 1.0).abs() < 1e-14);
            assert_eq!(map.radiance(direction), radiance);
        }
        assert!(EnvironmentMap::new(1, 1, vec![0.0]).unwrap().sample(0.5, 0.5, 0.5).is_none());
    }

    #[test]
    fn samples_follow_the_density_that_is_told() {
        use crate::directions::on_sphere;
        use crate::variates::{Variates, mean_and_error};
        // The mean of g/pdf is the integral of g over the pixels that shine; of the twelve, only the first is black.
        let map = map();
        let first = 1.0 - (PI / 3.0).cos();
        let g = |d: DVec3| 1.0 + d.x * d.y + d.z * d.z;
        let mut next = Variates::new(5);
        let (mean, error) = mean_and_error(100_000, || {
            let (direction, radiance) = map.sample(next.draw(), next.draw(), next.draw()).unwrap();
            let pdf = map.pdf_solid_angle(direction);
            assert_eq!(pdf, radiance / map.flux());
            g(direction) / pdf
        });
        let (everywhere, its_error) = mean_and_error(400_000, || {
            let direction = on_sphere(next.draw(), next.draw());
            4.0 * PI * if map.radiance(direction) > 0.0 { g(direction) } else { 0.0 }
        });
        assert!((mean - everywhere).abs() < 5.0 * error.hypot(its_error), "{mean} {everywhere}");
        // The integral of the density is 1, and of 1 the solid angle.
        let (whole, error) =
            mean_and_error(100_000, || 4.0 * PI * map.pdf_solid_angle(on_sphere(next.draw(), next.draw())));
        assert!((whole - 1.0).abs() < 5.0 * error, "{whole}");
        let (angle, error) = mean_and_error(100_000, || {
            let (direction, _) = map.sample(next.draw(), next.draw(), next.draw()).unwrap();
            1.0 / map.pdf_solid_angle(direction)
        });
        assert!((angle - (4.0 * PI - TAU / 4.0 * first)).abs() < 5.0 * error, "{angle}");
        let black = EnvironmentMap::new(1, 1, vec![0.0]).unwrap();
        assert_eq!(black.pdf_solid_angle(DVec3::Z), 0.0);
    }

    #[test]
    fn the_flux_of_a_constant_map_is_that_of_the_sphere() {
        let map = EnvironmentMap::new(8, 5, vec![2.0; 40]).unwrap();
        assert!((map.flux() - 8.0 * PI).abs() < 1e-13);
    }

    #[test]
    fn bad_maps_are_refused() {
        assert!(matches!(EnvironmentMap::<f64>::new(0, 1, vec![]), Err(SceneError::NoPixels { .. })));
        assert!(matches!(EnvironmentMap::new(2, 1, vec![1.0]), Err(SceneError::PixelCount { .. })));
        assert!(matches!(EnvironmentMap::new(1, 1, vec![-1.0]), Err(SceneError::Negative { .. })));
        assert!(matches!(EnvironmentMap::new(1, 1, vec![f64::NAN]), Err(SceneError::NotFinite { .. })));
    }
}
