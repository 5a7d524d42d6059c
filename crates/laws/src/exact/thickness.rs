//! Optical thickness in closed form, and its inverse.

use super::greatest;
use fairflight_freeflight::FreeFlight;
use fairflight_media::{Breakpoints, Majorant, OpticalThickness, Tolerance, adaptive_integral};
use fairflight_sources::Scripted;

/// Error of quadrature to 1e-13 and of the rounding of both sides, relative to 1 + the greatest thickness.
pub const GRANTED: f64 = 1e-11;

/// Fractions of the length between which the integral is taken: whole, halves, within a cell, across many.
const STRETCHES: [(f64, f64); 7] =
    [(0.0, 1.0), (0.0, 0.5), (0.5, 1.0), (0.123, 0.127), (0.31, 0.87), (0.0, 0.044), (0.9, 1.0)];

/// **Law.** A closed form is the integral of the look-ups: the greatest deviation over stretches of the field, relative to 1 + the
/// whole thickness.
///
/// The field's breakpoints must be all that it has; between them the quadrature meets a smooth function.
pub fn deviation_of_integral<F: OpticalThickness + Breakpoints>(field: &F) -> f64 {
    let length = field.length();
    let whole = field.optical_thickness(0.0, length).abs();
    greatest(STRETCHES.map(|(from, to)| {
        let (from, to) = (from * length, to * length);
        let breaks: Vec<f64> =
            field.breakpoints().into_iter().filter(|s| from < *s && *s < to).map(|s| s - from).collect();
        let integral = adaptive_integral(to - from, &breaks, Tolerance::TIGHT, |s| {
            [field.sigma_t((from + s).min(length))]
        });
        (field.optical_thickness(from, to) - integral.value[0]).abs() / (1.0 + whole)
    }))
}

/// The variates that are inverted.
const VARIATES: u32 = 1000;

/// **Law** (szirmay-kalos-2017 eq. 4). A flight without weights that inverts one variate ends where τ(0, s) = −ln(1 − u), and escapes
/// where the profile has no such place: the greatest deviation of τ, relative to 1 + the depth asked for.
///
/// Rounding of s moves τ by σ_t times that; `majorant` · length bounds what is granted for it.
pub fn deviation_of_inverse<F: OpticalThickness + Majorant, E: FreeFlight<F>>(field: &F, sampler: &E) -> f64 {
    let (length, total) = (field.length(), field.optical_thickness(0.0, field.length()));
    let at = |i: u32| {
        let u = (f64::from(i) + 0.5) / f64::from(VARIATES);
        let depth = -(-u).ln_1p();
        let flight = sampler.sample(field, &mut Scripted::new([u]));
        let unit = 1.0 + depth + field.majorant() * length;
        match flight.distance() {
            Some(s) if flight.weight() == 1.0 => (field.optical_thickness(0.0, s) - depth).abs() / unit,
            Some(_) => f64::NAN,
            // Beyond the end, but for rounding.
            None => (total - depth).max(0.0) / unit,
        }
    };
    greatest((0..VARIATES).map(at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_freeflight::{Flight, Inversion};
    use fairflight_media::{Extinction, InvertOpticalThickness, PiecewiseLinear};
    use fairflight_sources::UniformSource;

    fn tent() -> PiecewiseLinear {
        PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).unwrap()
    }

    /// A thickness, or a flight, that is off by a factor.
    struct Off(PiecewiseLinear, f64);

    impl Extinction for Off {
        fn sigma_t(&self, s: f64) -> f64 {
            self.0.sigma_t(s)
        }
        fn length(&self) -> f64 {
            self.0.length()
        }
    }
    impl OpticalThickness for Off {
        fn optical_thickness(&self, from: f64, to: f64) -> f64 {
            self.1 * self.0.optical_thickness(from, to)
        }
    }
    impl Breakpoints for Off {
        fn breakpoints(&self) -> Vec<f64> {
            self.0.breakpoints()
        }
    }
    impl FreeFlight<PiecewiseLinear> for Off {
        fn sample(&self, field: &PiecewiseLinear, source: &mut impl UniformSource) -> Flight {
            let depth = self.1 * source.next_exponential();
            match field.invert(0.0, depth) {
                Some(distance) => Flight::Collided { distance, weight: 1.0 },
                None => Flight::Escaped { weight: 1.0 },
            }
        }
        fn admits(&self, _field: &PiecewiseLinear, _s: f64, _sigma_t: f64) -> bool {
            true
        }
    }

    #[test]
    fn a_millionth_shows() {
        assert!(deviation_of_integral(&tent()) < GRANTED);
        assert!(deviation_of_inverse(&tent(), &Inversion) < GRANTED);
        let off = Off(tent(), 1.0 + 1e-6);
        assert!(deviation_of_integral(&off) > 1e-7);
        assert!(deviation_of_inverse(&tent(), &off) > 1e-8);
    }
}
