//! The analytic test medium of szirmay-kalos-2017.

use crate::{Bounds, FieldError, Line, LineThickness, Medium, MediumBreakpoints};
use fairflight_elementary::lanes::{LANES, Lanes, sin_cos};
use glam::{DVec3, dvec3};

/// σ_t(x, y, z) = scale · ((cos(3(x + y + z)/2) + 1)/2)⁵ · (sin(z/2) + 2)/3 (szirmay-kalos-2017 eq. 21).
///
/// The formula has no bounds of its own: it holds inside whichever are used. The paper's are
/// [`AnalyticCosine::default_bounds`]. Both factors lie in \[0, 1\] and reach 1, the first also reaches 0, so that the
/// bounds of the medium are tight in space (on a line they need not be).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnalyticCosine {
    scale: f64,
}

/// ((1 + cos u)/2)⁵ = cos¹⁰(u/2) = Σ_k HARMONICS\[k\] cos(k u): the binomials of 10, doubled except for k = 0, over 2¹⁰.
const HARMONICS: [f64; 6] =
    [252.0 / 1024.0, 420.0 / 1024.0, 240.0 / 1024.0, 90.0 / 1024.0, 20.0 / 1024.0, 2.0 / 1024.0];

/// The phase of the first factor is this times (x + y + z).
const DIAGONAL_FREQUENCY: f64 = 1.5;
/// The phase of the second factor is this times z.
const AXIAL_FREQUENCY: f64 = 0.5;

impl AnalyticCosine {
    /// The medium with the largest extinction `scale` \[1/length\]; a negative scale turns it upside down.
    ///
    /// # Errors
    /// If `scale` is not finite.
    pub fn new(scale: f64) -> Result<Self, FieldError> {
        FieldError::check_finite("scale", scale)?;
        Ok(Self { scale })
    }

    /// Eq. 21 by the cosine of its first phase and the sine of the second.
    #[inline(always)]
    fn of_phases(&self, cos: f64, sin: f64) -> f64 {
        let base = 0.5 * cos + 0.5;
        let square = base * base;
        let axial = sin + 2.0;
        self.scale * (square * square * base) * (axial / 3.0)
    }

    /// The sphere of the paper: center (0, 0, 10), radius 10.
    #[must_use]
    pub fn default_bounds() -> Bounds {
        Bounds::Sphere { center: dvec3(0.0, 0.0, 10.0), radius: 10.0 }
    }
}

impl Medium for AnalyticCosine {
    #[inline]
    fn sigma_t_local(&self, point: DVec3) -> f64 {
        let phases = [DIAGONAL_FREQUENCY * (point.x + point.y + point.z), AXIAL_FREQUENCY * point.z];
        // Both in one pair of lanes.
        let (sin, cos) = sin_cos(&phases);
        self.of_phases(cos[0], sin[1])
    }
    #[inline(always)]
    fn sigma_t_local_lanes(&self, [x, y, z]: &[Lanes; 3]) -> Lanes {
        let (mut diagonal, mut axial) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            diagonal[i] = DIAGONAL_FREQUENCY * (x[i] + y[i] + z[i]);
            axial[i] = AXIAL_FREQUENCY * z[i];
        }
        let ((_, cos), (sin, _)) = (sin_cos(&diagonal), sin_cos(&axial));
        let mut values = [0.0; LANES];
        for i in 0..LANES {
            values[i] = self.of_phases(cos[i], sin[i]);
        }
        values
    }
    fn upper_bound(&self) -> Option<f64> {
        Some(self.scale.max(0.0))
    }
    fn lower_bound(&self) -> Option<f64> {
        Some(self.scale.min(0.0))
    }
}

/// Exact to a few rounding errors of `scale · (to − from)`: an absolute error, since the harmonics cancel where the
/// extinction is small.
///
/// With u = 3(x + y + z)/2 and v = z/2 the field is scale/3 · Σ_k a_k cos(k u) (2 + sin v), and
/// cos(k u) sin v = (sin(k u + v) − sin(k u − v))/2. On a line each phase is linear in s, and the integral of its cosine
/// over a stretch is length · cos(phase at the middle) · sinc(half the change of phase): no division by a frequency, which
/// is zero along (1, −1, 0), and nearly zero near it. The same holds for the sine.
///
/// Sines and cosines of the multiples k u come from one of each by angle addition, so that an integral costs four pairs
/// (sin, cos) and not thirty.
impl LineThickness for AnalyticCosine {
    fn line_thickness(&self, local: &Line, from: f64, to: f64) -> f64 {
        let middle = local.at(0.5 * (from + to));
        let half = 0.5 * (to - from) * local.direction;
        let [u, half_u, v, half_v] = Phase::of([
            DIAGONAL_FREQUENCY * (middle.x + middle.y + middle.z),
            DIAGONAL_FREQUENCY * (half.x + half.y + half.z),
            AXIAL_FREQUENCY * middle.z,
            AXIAL_FREQUENCY * half.z,
        ]);

        let (mut ku, mut half_ku) = (Phase::ZERO, Phase::ZERO);
        let mut mean = 0.0;
        for harmonic in HARMONICS {
            let even = 2.0 * ku.cos * half_ku.sinc();
            let sum = ku.plus(&v).sin * half_ku.plus(&half_v).sinc();
            let difference = ku.minus(&v).sin * half_ku.minus(&half_v).sinc();
            mean += harmonic * (even + 0.5 * (sum - difference));
            (ku, half_ku) = (ku.plus(&u), half_ku.plus(&half_u));
        }
        self.scale / 3.0 * mean * (to - from)
    }
}

/// An angle with its sine and cosine, to a few rounding errors of 1.
#[derive(Clone, Copy)]
struct Phase {
    angle: f64,
    sin: f64,
    cos: f64,
}

impl Phase {
    const ZERO: Self = Self { angle: 0.0, sin: 0.0, cos: 1.0 };

    #[inline]
    fn of(angles: [f64; 4]) -> [Self; 4] {
        let (sin, cos) = sin_cos(&angles);
        std::array::from_fn(|i| Self { angle: angles[i], sin: sin[i], cos: cos[i] })
    }

    #[inline]
    fn plus(&self, other: &Self) -> Self {
        Self {
            angle: self.angle + other.angle,
            sin: self.sin * other.cos + self.cos * other.sin,
            cos: self.cos * other.cos - self.sin * other.sin,
        }
    }

    #[inline]
    fn minus(&self, other: &Self) -> Self {
        self.plus(&Self { angle: -other.angle, sin: -other.sin, cos: other.cos })
    }

    /// sin(x)/x, and 1 at 0.
    ///
    /// A sine from angle addition is good to a rounding error of 1, not of itself: near 0 the quotient takes the series
    /// 1 − x²/3! + x⁴/5! − …, whose first term left out, x¹⁴/15!, is below 5e-17 for |x| ≤ 0.5.
    #[inline]
    fn sinc(&self) -> f64 {
        if self.angle.abs() > 0.5 {
            return self.sin / self.angle;
        }
        let x2 = self.angle * self.angle;
        let mut series = 1.0;
        for divisor in [156.0, 110.0, 72.0, 42.0, 20.0, 6.0] {
            series = 1.0 - x2 / divisor * series;
        }
        series
    }
}

impl MediumBreakpoints for AnalyticCosine {
    fn line_breakpoints(&self, _local: &Line, _length: f64) -> Vec<f64> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn medium() -> AnalyticCosine {
        AnalyticCosine::new(1.0).unwrap()
    }

    /// Composite Gauss-Legendre quadrature with five points on each of `panels` panels.
    fn brute_force(medium: &AnalyticCosine, line: &Line, from: f64, to: f64, panels: u32) -> f64 {
        const NODES: [(f64, f64); 5] = [
            (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
            (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
            (0.0, 0.568_888_888_888_888_9),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
            (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        ];
        let half = 0.5 * (to - from) / f64::from(panels);
        let panel = |i: u32| {
            let middle = from + (2.0 * f64::from(i) + 1.0) * half;
            NODES.iter().map(|(x, w)| w * medium.sigma_t_local(line.at(middle + half * x))).sum::<f64>()
        };
        half * (0..panels).map(panel).sum::<f64>()
    }

    #[test]
    fn the_harmonics_are_the_fifth_power() {
        assert_eq!(HARMONICS.iter().sum::<f64>(), 1.0);
        for i in 0..100 {
            let u = 0.1 * f64::from(i) - 5.0;
            let series: f64 = (0u8..).zip(HARMONICS).map(|(k, a)| a * (f64::from(k) * u).cos()).sum();
            assert!((series - ((u.cos() + 1.0) / 2.0).powi(5)).abs() < 1e-15);
        }
    }

    #[test]
    fn the_value_is_the_formula() {
        let p = dvec3(0.3, -1.2, 2.5);
        let formula =
            ((1.5f64 * (0.3 - 1.2 + 2.5)).cos() / 2.0 + 0.5).powi(5) * ((1.25f64).sin() + 2.0) / 3.0;
        assert!((medium().sigma_t(p) - formula).abs() < 1e-15);
        assert!((AnalyticCosine::new(-3.0).unwrap().sigma_t(p) + 3.0 * formula).abs() < 1e-15);
        assert!(
            (medium().sigma_t(dvec3(0.0, -std::f64::consts::PI, std::f64::consts::PI)) - 1.0).abs() < 1e-15
        );
    }

    #[test]
    fn the_ray_along_z_through_the_whole_sphere() {
        let clip = AnalyticCosine::default_bounds().clip(DVec3::ZERO, DVec3::Z, None).unwrap().unwrap();
        assert_eq!(clip.length, 20.0);
        let tau = medium().line_thickness(&clip.line, 0.0, clip.length);
        assert!((tau - 3.41568).abs() < 5e-6, "{tau}");
        assert!(((-tau).exp() - 0.0328539).abs() < 5e-8);
        assert!((tau - brute_force(&medium(), &clip.line, 0.0, 20.0, 400)).abs() < 1e-14);
        let peak =
            (0..20_000).map(|i| medium().sigma_t(clip.line.at(1e-3 * f64::from(i)))).fold(0.0, f64::max);
        assert!((peak - 0.956).abs() < 5e-4, "{peak}");
    }

    #[test]
    fn the_closed_form_is_the_integral_on_many_lines() {
        let mut directions =
            vec![DVec3::X, DVec3::Y, -DVec3::Z, dvec3(1.0, -1.0, 0.0), dvec3(-1.0, -1.0, 2.0)];
        // Nearly no frequency along the line, and frequencies at which one of the two mixed phases stands still.
        for tiny in [1e-300, 1e-17, 1e-12, 1e-8, 1e-4] {
            directions.push(dvec3(1.0, -1.0 + tiny, tiny));
        }
        for k in 1..=5 {
            let z = 1.0;
            directions.push(dvec3(-z + z / (3.0 * f64::from(k)), 0.0, z));
            directions.push(dvec3(0.0, -z - z / (3.0 * f64::from(k)), z));
        }
        for i in 0..60 {
            let angle = f64::from(i);
            directions.push(dvec3(angle.sin(), (1.7 * angle).cos(), (2.3 * angle).sin()));
        }
        for (i, direction) in (0..).zip(directions) {
            let origin =
                dvec3((0.7 * f64::from(i)).sin(), (1.1 * f64::from(i)).cos(), 10.0 * f64::from(i).sin());
            let line = Line { origin, direction: direction.normalize() };
            let (from, to) = (0.3, 3.0 + 0.2 * f64::from(i));
            let expected = brute_force(&medium(), &line, from, to, 400);
            let found = medium().line_thickness(&line, from, to);
            assert!((found - expected).abs() < 1e-15 * (to + 4.0), "{direction}: {found} {expected}");
        }
    }

    #[test]
    fn no_stretch_no_thickness() {
        let line = Line { origin: DVec3::ONE, direction: DVec3::Z };
        assert_eq!(medium().line_thickness(&line, 2.0, 2.0), 0.0);
        let short = medium().line_thickness(&line, 2.0, 2.0 + 2f64.powi(-40));
        assert!((short * 2f64.powi(40) - medium().sigma_t(dvec3(1.0, 1.0, 3.0))).abs() < 1e-11);
    }

    #[test]
    fn no_rounding_carries_a_value_beyond_the_bounds() {
        // Around the greatest values (x + y + z a multiple of 4π/3, z = π + 4πm) and the least, a rounding apart.
        for scale in [1.0, 0.7, -0.3, 2000.0 / 3.0] {
            let medium = AnalyticCosine::new(scale).unwrap();
            let bounds = medium.lower_bound().unwrap()..=medium.upper_bound().unwrap();
            for (k, m) in (-40..40).flat_map(|k| (-3..3).map(move |m| (k, m))) {
                let z = std::f64::consts::PI * (1.0 + 4.0 * f64::from(m));
                let mut sum = std::f64::consts::PI * 2.0 / 3.0 * f64::from(k);
                for _ in 0..20 {
                    let value = medium.sigma_t(dvec3(sum - z, 0.0, z));
                    assert!(bounds.contains(&value), "{value} at {sum}, {z}");
                    sum = sum.next_up();
                }
            }
        }
    }

    #[test]
    fn the_bounds_follow_the_sign_of_the_scale() {
        let bounds = |scale| AnalyticCosine::new(scale).map(|m| (m.lower_bound(), m.upper_bound())).unwrap();
        assert_eq!(bounds(2.0), (Some(0.0), Some(2.0)));
        assert_eq!(bounds(-2.0), (Some(-2.0), Some(0.0)));
        assert!(matches!(AnalyticCosine::new(f64::INFINITY), Err(FieldError::NotFinite { .. })));
    }
}
