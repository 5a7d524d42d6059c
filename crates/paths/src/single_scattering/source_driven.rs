//! Distances along a ray that mimic the inverse square of a point light: the Cauchy distribution, also called equiangular.

use fairflight_elementary::{atan2, tan};
use fairflight_media::Line;
use glam::DVec3;

/// The density D/((θ_b − θ_a)(D² + (s − s_l)²)) on \[0, length\] (szirmay-kalos-2017 section 4.3, kulla-2012).
///
/// D is the distance of the light from the line, s_l where the line comes closest. The angle θ under which the light sees the
/// point, tan θ = (s − s_l)/D, is uniform; ds = D/cos²θ dθ is the Jacobian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SourceDriven {
    closest: f64,
    distance: f64,
    from: f64,
    angle: f64,
    length: f64,
}

impl SourceDriven {
    /// The distribution for a light at `position` and the first `length` > 0 of `line`.
    #[inline]
    #[must_use]
    pub fn new(line: &Line, length: f64, position: DVec3) -> Self {
        let offset = position - line.origin;
        let closest = offset.dot(line.direction);
        let distance = (offset - closest * line.direction).length();
        let from = atan2(-closest, distance);
        let to = atan2(length - closest, distance);
        Self { closest, distance, from, angle: to - from, length }
    }

    /// The distance of the variate `u` \[length\].
    #[inline]
    #[must_use]
    pub fn sample(&self, u: f64) -> f64 {
        let s = self.closest + self.distance * tan(self.from + u * self.angle);
        // Rounding may carry it over an end.
        s.clamp(0.0, self.length)
    }

    /// The density at `s` \[1/length\].
    #[inline]
    #[must_use]
    pub fn pdf_distance(&self, s: f64) -> f64 {
        let along = s - self.closest;
        self.distance / (self.angle * (self.distance * self.distance + along * along))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Tolerance, adaptive_integral};
    use glam::dvec3;

    #[test]
    fn samples_follow_the_density() {
        let line = Line { origin: dvec3(1.0, 2.0, 3.0), direction: DVec3::Z };
        for position in [dvec3(1.5, 2.0, 7.0), dvec3(1.0, 9.0, -4.0), dvec3(1.0 + 1e-6, 2.0, 5.0)] {
            let technique = SourceDriven::new(&line, 6.0, position);
            for i in 0..=20 {
                // The distribution function at the sample is the variate.
                let u = f64::from(i) / 20.0;
                let s = technique.sample(u);
                let integral = adaptive_integral(s, &[technique.closest], Tolerance::TIGHT, |s| {
                    [technique.pdf_distance(s)]
                });
                assert!((integral.value[0] - u).abs() < 1e-9, "{position} u = {u}: {integral:?}");
            }
        }
    }
}
